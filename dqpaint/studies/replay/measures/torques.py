"""A paper's torque laws -> figures of its tables, deviations of torques, twist errors in time."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from dqpaint.dq import Floats
from dqpaint.studies.experiment.statistics import spread
from dqpaint.studies.replay.measure import MEASURES, MeasureRequest, MeasureResult
from dqpaint.studies.replay.measures.curves import curves
from dqpaint.studies.replay.measures.tracking import (
    KEPT,
    beside_published,
    carry_out,
    measured,
    settings_of,
)
from dqpaint.studies.replay.papers import Paper
from dqpaint.studies.report.pictures import pictures
from dqpaint.studies.runner.run_arrays import Arrays, read_arrays


@MEASURES.add("torques")
def torques(paper: Paper, request: MeasureRequest) -> MeasureResult:
    """Every cell is run; of each run the torques and twist errors are looked at as well."""
    choices = {cell.name: cell.settings for cell in paper.cells}
    found = carry_out(paper, request, choices, KEPT, always=("curves",))
    made = measured(paper, request, found, {})
    numbers = dict(made.numbers)
    for cell in found:
        runs = [seen_in(read_arrays(request.folder, one.key)) for one in cell.done]
        more = {name: spread([run[name] for run in runs]) for name in (runs[0] if runs else ())}
        if runs:
            numbers[cell.label] = {**made.numbers[cell.label], **more}
    shown = {
        **beside_published(paper, numbers),
        **pictures(found, request.folder, settings_of(paper, request, {})),
        **curves(paper, found, request.folder),
    }
    return replace(made, numbers=numbers, shown=shown)


def seen_in(run: Mapping[str, Floats] | Arrays) -> dict[str, float]:
    """Deviations of each torque [Nm] over a run, and the rms of both halves of its twist error."""
    found = {}
    joint = 1
    while f"torque{joint}_Nm" in run:
        found[f"torque{joint}_std_Nm"] = float(np.std(run[f"torque{joint}_Nm"]))
        joint += 1
    for name, unit in (("w", "rad_s"), ("v", "m_s")):
        parts = [run[f"twist_error_{name}{axis}_{unit}"] for axis in "xyz"]
        found[f"twist_error_{name}_rms_{unit}"] = float(
            np.sqrt((np.array(parts) ** 2).sum(0).mean())
        )
    return found
