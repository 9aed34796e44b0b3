"""First runs of a paper's cells -> what its figures show of them over time."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np

from dqpaint.dq import Floats
from dqpaint.studies.experiment.cells import Cell
from dqpaint.studies.replay.papers import Paper
from dqpaint.studies.report.charts import Line, Panel
from dqpaint.studies.report.page import Charts, Pictured
from dqpaint.studies.report.pictures import line_name, without_result
from dqpaint.studies.runner.run_arrays import Arrays, read_arrays

MOST_POINTS = 900  # of a curve: of more every second, third ... one is shown
Curve = Callable[[Arrays], Floats | None]


def _column(name: str) -> Curve:
    return lambda run: run.get(name)


def _norm(*ends: str) -> Curve:
    """The norm over the joints of the columns `ends[0]` 1, 2, ... `ends[1]`."""

    def norm(run: Arrays) -> Floats | None:
        first, last = ends
        names = [n for n in run if n.startswith(first) and n.endswith(last)]
        return np.sqrt(sum(run[name] ** 2 for name in names)) if names else None

    return norm


SHOWN: dict[str, tuple[str, Curve]] = {
    **{f"place {axis}": ("m", _column(f"{axis}_m")) for axis in "xyz"},
    **{f"quaternion {part}": ("", _column(f"q{part}")) for part in "wxyz"},
    "invariant error": ("", _column("invariant_error")),
    "commanded rates, norm": ("rad/s", _norm("command", "_rad_s")),
    "effort": ("rad", _column("effort_rad")),
    "speed of the tool": ("m/s", _column("speed_m_s")),
    "acceleration of the tool": ("m/s^2", _column("acceleration_m_s2")),
    **{f"twist error w{axis}": ("rad/s", _column(f"twist_error_w{axis}_rad_s")) for axis in "xyz"},
    **{f"twist error v{axis}": ("m/s", _column(f"twist_error_v{axis}_m_s")) for axis in "xyz"},
    **{f"torque {joint}": ("Nm", _column(f"torque{joint}_Nm")) for joint in range(1, 8)},
}
OF_TORQUES = "twist error", "torque"


def curves(paper: Paper, found: Sequence[Cell], folder: Path) -> dict[str, Pictured]:
    """Charts over time by the ends of their names, one for each figure that the paper names.

    A run that is no result is shown as well, and named so: how it swings is what is to be seen.
    """
    by_label = {cell.label: cell for cell in found if cell.results and cell.results[0].figures}
    bad = without_result(found)
    shown: dict[str, Pictured] = {}
    for number, (title, labels) in enumerate(paper.curves.items(), 1):
        runs = {
            line_name(label, label in bad): read_arrays(folder, by_label[label].results[0].key)
            for label in labels
            if label in by_label
        }
        panels = list(filter(None, (panel(name, runs) for name in SHOWN)))
        if panels:
            shown[f"-curves-{number}"] = Charts(title, panels, shared=True)
    return shown


def panel(name: str, runs: Mapping[str, Mapping[str, Floats]]) -> Panel | None:
    """One curve of every run; None where no run has it, or torques say more."""
    unit, curve = SHOWN[name]
    lines = []
    for label, run in runs.items():
        values = curve(dict(run))
        if values is not None:
            stride = -(-len(values) // MOST_POINTS)
            lines.append(Line(run["t_s"][::stride], values[::stride], label))
    driven = any("torque1_Nm" in run for run in runs.values())
    if not lines or (name.startswith(OF_TORQUES) and not driven):
        return None
    return Panel(name, "time [s]", f"{name} [{unit}]" if unit else name, lines)
