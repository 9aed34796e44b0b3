"""Cells -> one tidy table, a row a run: what was chosen, how it ended, every figure.

`pandas.read_csv("lag-runs.csv")` or `pandas.DataFrame(study.runs)` has it as a frame.
"""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from dqpaint.controllers import find_controller
from dqpaint.core import tables
from dqpaint.plants import choose_plant
from dqpaint.robots.model import DEFAULT_ROBOT
from dqpaint.settings import Settings
from dqpaint.studies.experiment.cells import Cell, figure_names
from dqpaint.studies.runner.run import Run

OWN = ("controller", "gains", "plant", "robot", "disturb", "seed")
"""Settings that have columns of their own, whether they vary or not."""
NONE = "none"

Columns = dict[str, list[Any]]


def columns(found: Sequence[Cell]) -> Columns:
    """A row a run: choices as texts, the seed as a number, figures in SI units, nan where none.

    Every figure's name has its unit. A run that is no result has its figures, too: `status` is
    `done` for those that count.
    """
    several = [(cell, i) for cell in found for i in range(len(cell.results))]
    names = figure_names(found)
    varied = _varied([run for cell in found for run in cell.runs])
    lines = [_row(cell, i, names, varied) for cell, i in several]
    heads = dict.fromkeys(name for line in lines for name in line)
    return {head: [line.get(head, "") for line in lines] for head in heads}


def csv(found: Sequence[Cell]) -> bytes:
    """The table as a file; all digits of a number, and nothing where there is none."""
    table = columns(found)
    return tables.encode_csv([table, *zip(*table.values(), strict=True)])


def _row(cell: Cell, i: int, names: Sequence[str], varied: Sequence[str]) -> dict[str, Any]:
    result = cell.results[i]
    run = cell.runs[i] if cell.runs else None
    line = _of_run(run) if run else {}
    line.update({name: text for name, text in cell.choice.items() if name not in line})
    if run:
        line.update({name: _said(getattr(run.settings, name)) for name in varied})
    line["status"] = result.status
    line["reason"] = result.message.splitlines()[0] if result.message else ""
    line["limits"] = result.limits
    return {**line, **{name: result.figures.get(name, math.nan) for name in names}}


def _of_run(run: Run) -> dict[str, Any]:
    settings = run.settings
    return {
        "drawing": Path(run.name).stem,
        "law": settings.controller,
        "gains": gains_text(settings),
        "plant": _plant(settings),
        "robot": settings.robot or run.program().robot or DEFAULT_ROBOT,
        "disturb": _said(settings.disturb) or NONE,
        "seed": settings.seed,
    }


def gains_text(settings: Settings) -> str:
    """All gains of the law, those that nobody chose, too."""
    schedule = find_controller(settings.controller).read_gains(settings.gains)
    return _said(schedule.as_dict())


def _plant(settings: Settings) -> str:
    torque = find_controller(settings.controller).drives_torque
    return choose_plant(settings.plant, "torque" if torque else "rates").name


def _varied(runs: Sequence[Run]) -> list[str]:
    """The settings in which runs differ and that have no column of their own."""
    fields = [name for name in Settings.model_fields if name not in OWN]
    return [n for n in fields if len({repr(getattr(run.settings, n)) for run in runs}) > 1]


def _said(value: object) -> str:
    """A value about as an option has it: `k=20 c=3`, `twist:form=sine,x=0.02`."""
    if isinstance(value, Mapping):
        if any(isinstance(one, Mapping) for one in value.values()):
            return " ".join(f"{n}:{','.join(_pairs(one))}" for n, one in value.items())
        return " ".join(_pairs(value))
    if isinstance(value, tuple | list):
        return f"[{','.join(map(_said, value))}]"
    return f"{value:g}" if isinstance(value, float) else "" if value is None else str(value)


def _pairs(values: Mapping[str, object]) -> list[str]:
    return [f"{name}={_said(one)}" if name else _said(one) for name, one in values.items()]
