"""What runs did at steps of the set point -> step responses: x, y, z and angle over time."""

from collections.abc import Mapping, Sequence

import numpy as np

from dqpaint.studies.report.charts import Line, Panel
from dqpaint.studies.report.over_runs import SAID, Arrays, Band, averaged
from dqpaint.studies.report.page import Charts

MOST_STEPS = 3
SMALL = 0.05  # of the longest part of a step: a coordinate that moves less is not shown
BAND = 0.02  # of the step: as near as that it has arrived
AFTER = 2.5  # times the longest time to come so near is shown
LEAST_SHOWN = 0.05  # [s]
WIDTH = 2.0


def step_charts(
    drawn: Mapping[str, Sequence[Arrays]], colours: Mapping[str, str], band: Band
) -> Charts | None:
    """The responses of all, over each other; None where there was no step.

    Args:
        drawn: what was kept of the runs of each choice, by its label.
        colours: of the labels, for white paper.
        band: about the curve of several runs.
    """
    first = next(iter(drawn.values()))[0]
    count = min(int(first.get("steps", 0)), MOST_STEPS)
    panels = [panel for step in range(count) for panel in _panels(drawn, colours, step, band)]
    if not panels:
        return None
    many = any(len(runs) > 1 for runs in drawn.values()) and band != "none"
    told = f" ({SAID[band]})" if many else ""
    left = int(first["steps"]) - count
    more = f"; of the first {count} of {int(first['steps'])} steps" if left else ""
    title = f"Step responses{told}{more}"
    return Charts(title, panels, shared=True, note=title)


def _panels(
    drawn: Mapping[str, Sequence[Arrays]], colours: Mapping[str, str], step: int, band: Band
) -> list[Panel]:
    """A panel each coordinate that moves, and one for the angle."""
    first = next(iter(drawn.values()))[0]
    size, turn = first[f"step{step}_size"], float(first[f"step{step}_turn"])
    parts = [
        (name, "mm", f"step{step}_{name}", 1e3, float(size[i]))
        for i, name in enumerate("xyz")
        if np.abs(size).max() > 0 and abs(size[i]) > SMALL * np.abs(size).max()
    ]
    if turn:
        parts.append(("angle", "deg", f"step{step}_angle", float(np.degrees(1)), turn))
    end = max((_arrived(run, step) for runs in drawn.values() for run in runs), default=0.0)
    last = float(first[f"step{step}_t"][-1])
    span = 0.0, min(last, max(LEAST_SHOWN, AFTER * end))
    where = f" (line {first[f'step{step}_line']})" if int(first["steps"]) > 1 else ""
    panels = []
    for name, unit, key, scale, target in parts:
        lines = []
        for label, runs in drawn.items():
            y, low, high = (scale * part for part in averaged(runs, key, band))
            about = (low, high) if len(runs) > 1 and band != "none" else None
            t = runs[0][f"step{step}_t"]
            lines.append(Line(t, y, label, colours[label], band=about, width=WIDTH))
        head = "from the old orientation" if name == "angle" else "from the old set point"
        panels.append(
            Panel(f"{name}{where}", "time since the step [s]", f"{name}, {head} [{unit}]", lines,
                  bound=scale * target, limit="set point", x_span=span)
        )  # fmt: skip
    return panels


def _arrived(run: Arrays, step: int) -> float:
    """When a run first was near the set point in all parts [s]; the end where it never was."""
    t = run[f"step{step}_t"]
    moved = np.stack([run[f"step{step}_{axis}"] for axis in "xyz"], axis=1)
    size, turn = run[f"step{step}_size"], float(run[f"step{step}_turn"])
    off = np.linalg.norm(moved - size, axis=1) > BAND * (float(np.linalg.norm(size)) or 1.0)
    if turn:
        off |= np.abs(run[f"step{step}_angle"] - turn) > BAND * turn
    return float(t[-1] if off.all() else t[int(np.argmin(off))])
