"""A paper with gains that change at first -> errors integrated from a tenth of the run on."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from dqpaint.studies.experiment.cells import Cell
from dqpaint.studies.experiment.statistics import spread
from dqpaint.studies.replay.measure import MEASURES, MeasureRequest, MeasureResult
from dqpaint.studies.replay.measures.curves import curves
from dqpaint.studies.replay.measures.tracking import beside_published, carry_out, measured
from dqpaint.studies.replay.papers import Paper
from dqpaint.studies.report.page import Pictured
from dqpaint.studies.report.pictures import errors, read_first_runs, without_result
from dqpaint.studies.runner.run_arrays import read_arrays

LATE = 0.1  # of the run
FIGURE = "late_error_integral"


@MEASURES.add("late")
def late(paper: Paper, request: MeasureRequest) -> MeasureResult:
    """Every cell is run; the error integral is taken over the last nine tenths."""
    choices = {cell.name: cell.settings for cell in paper.cells}
    found = carry_out(paper, request, choices, ("curves",), always=("series",))
    period = _period(found, request.folder)
    made = measured(paper, request, found, {})
    numbers = {
        cell.label: {
            **made.numbers[cell.label],
            FIGURE: spread([late_integral(request.folder, r.key, period) for r in cell.done]),
        }
        for cell in found
        if cell.done
    }
    shown: dict[str, Pictured] = {
        **beside_published(paper, numbers),
        "-errors": errors(read_first_runs(found, request.folder), bad=without_result(found)),
        **curves(paper, found, request.folder),
    }
    return replace(made, numbers=numbers, shown=shown)


def late_integral(folder: Path, key: str, period: float) -> float:
    """The integral of the invariant error of a run that is kept, over its last nine tenths."""
    arrays = read_arrays(folder, key)
    t, error = arrays["t_s"][:-1], arrays["invariant_error"][:-1]
    return float(error[t > LATE * arrays["t_s"][-1]].sum() * period)


def _period(found: Sequence[Cell], folder: Path) -> float:
    kept = next(result for cell in found for result in cell.results if result.figures)
    return float(np.diff(read_arrays(folder, kept.key)["t_s"][:2])[0])
