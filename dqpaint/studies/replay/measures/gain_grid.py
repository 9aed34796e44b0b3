"""A paper with a grid of two gains -> the figures of its tables, and heat maps of the grid."""

from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from dqpaint.studies.replay.claims import Numbers, cell_name
from dqpaint.studies.replay.measure import MEASURES, MeasureRequest, MeasureResult
from dqpaint.studies.replay.measures.tracking import carry_out, numbers_of, tracking
from dqpaint.studies.replay.papers import Paper
from dqpaint.studies.report.charts import HeatMap
from dqpaint.studies.report.page import Map

SURFACES = ("effort_integral", "speed_integral_m", "error_integral")


@MEASURES.add("surfaces")
def surfaces(paper: Paper, request: MeasureRequest) -> MeasureResult:
    """The cells of the tables, then every combination of the axes' values."""
    tables = tracking(paper, request)
    choices = grid(paper)
    found = carry_out(paper, request, choices, (), paper.grid_drawing)
    numbers = {**tables.numbers, **numbers_of(paper, found)}
    shown = {**tables.shown, **maps(paper, numbers)}
    return replace(tables, numbers=numbers, shown=shown, cells=(*tables.cells, *found))


def grid(paper: Paper) -> dict[str, dict[str, Any]]:
    """Settings by the names of the grid's cells."""
    found = {}
    for values in product(*paper.axes.values()):
        place = dict(zip(paper.axes, values, strict=True))
        common = paper.grid_settings
        gains = {**common.get("gains", {}), **place}
        found[cell_name(place)] = {**common, "gains": gains}
    return found


def maps(paper: Paper, numbers: Numbers) -> dict[str, Map]:
    """A heat map a figure, the first axis upwards; what has no number stays empty."""
    (up, ups), (right, rights) = paper.axes.items()
    says = {figure.name: figure.says for figure in paper.figures}
    found = {}
    for name in SURFACES:
        values = np.full((len(ups), len(rights)), np.nan)
        for (i, a), (j, b) in product(enumerate(ups), enumerate(rights)):
            cell = numbers.get(cell_name({up: a, right: b}), {})
            values[i, j] = cell[name].mean if name in cell else np.nan
        x, y = ([f"{value:g}" for value in axis] for axis in (rights, ups))
        given = HeatMap(says[name], right, up, x, y, values, ~np.isfinite(values), log=True)
        found[f"-{name.split('_')[0]}"] = Map(
            f"The surface over {up} and {right}: {says[name]}", given
        )
    return found
