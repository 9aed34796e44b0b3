"""A paper's drawing and laws -> runs, their figures beside the printed ones, pictures."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import cycle
from typing import Any

import numpy as np

from dqpaint.settings import Settings, make_settings
from dqpaint.studies.experiment.cells import (
    Cell,
    TableFigure,
    every_run_failed,
    run_cells,
    split_label,
)
from dqpaint.studies.replay.claims import Numbers, published
from dqpaint.studies.replay.conditions import conditions, departures
from dqpaint.studies.replay.measure import MEASURES, MeasureRequest, MeasureResult
from dqpaint.studies.replay.measures.curves import curves
from dqpaint.studies.replay.papers import Paper, find_paper_drawing
from dqpaint.studies.report.charts import COLOURS, Line, Panel, wide
from dqpaint.studies.report.page import Charts, Pictured
from dqpaint.studies.report.pictures import pictures
from dqpaint.studies.runner.engine import carry_out_study
from dqpaint.studies.runner.run import Run, drawing_text, seeded

SIZE = {"width": 480, "height": 270}
WIDE = 2.0  # from the smallest to the largest: a logarithmic axis shows ratios
KEPT = ("series", "light")  # of the first run of each cell


@MEASURES.add("tracking")
def tracking(paper: Paper, request: MeasureRequest) -> MeasureResult:
    """Every cell of the paper's tables is run as its settings say."""
    choices = {cell.name: cell.settings for cell in paper.cells}
    found = carry_out(paper, request, choices, (*KEPT, *(["curves"] if paper.curves else [])))
    beside = beside_published(paper, numbers_of(paper, found))
    shown = pictures(found, request.folder, settings_of(paper, request, {}))
    if any(cell.drawing for cell in paper.cells):  # nothing is to be seen of them over each other
        shown.pop("-overlay", None)
    over_time = curves(paper, found, request.folder)
    return measured(paper, request, found, {**beside, **shown, **over_time})


def carry_out(
    paper: Paper,
    request: MeasureRequest,
    choices: dict[str, dict[str, Any]],
    keep: tuple[str, ...],
    drawing: str = "",
    always: tuple[str, ...] = (),
) -> tuple[Cell, ...]:
    """Run a drawing with each of some choices of settings.

    Args:
        paper: the experiment.
        request: what a person asked for.
        choices: settings by the names of the cells.
        keep: what is kept of the first run of each.
        drawing: its name, if it is not the paper's; that of a cell goes before.
        always: what is kept of every run.

    Raises:
        DqpaintError: every run failed.
    """
    own = {cell.name: cell.drawing for cell in paper.cells}
    rows = []
    for label, choice in choices.items():
        drawn = own.get(label) or drawing or paper.drawing
        name, text = drawing_text(str(find_paper_drawing(drawn)))
        settings = settings_of(paper, request, choice)
        count = (request.runs or 1) if settings.disturb else 1
        row = seeded(Run(name, text, settings, (*always, *keep)), count)
        rows.append([replace(run, keep=run.keep or always) for run in row])
    found = run_cells(
        [{"cell": name} for name in choices], rows,
        lambda runs: carry_out_study(
            runs, request.folder, request.jobs, paper.name, request.reporter
        ),
    )  # fmt: skip
    if all(not result.figures for cell in found for result in cell.results):
        raise every_run_failed(found)
    return found


def settings_of(paper: Paper, request: MeasureRequest, choice: dict[str, Any]) -> Settings:
    """What all runs have in common, then what a cell says, then what a person asked for."""
    return make_settings(**{**SIZE, **paper.settings, **choice, **request.settings})


def measured(
    paper: Paper, request: MeasureRequest, found: Sequence[Cell], shown: Mapping[str, Pictured]
) -> MeasureResult:
    """What cells say, in the paper's figures."""
    count = request.runs or 1
    settings = {
        cell.name: settings_of(paper, request, cell.settings)
        for cell in paper.cells
        if cell.settings or not paper.axes
    }
    if paper.axes:
        settings["the grid"] = settings_of(paper, request, paper.grid_settings)
    ours = conditions(settings, {cell.name: cell.group for cell in paper.cells})
    ours[0] = f"{count} run{'s' if count > 1 else ''} each, {ours[0]}"
    return MeasureResult(
        numbers_of(paper, found), "\n".join(ours), {}, shown, tuple(found),
        tuple(departures(paper, request.settings)),
    )  # fmt: skip


def numbers_of(paper: Paper, found: Sequence[Cell]) -> Numbers:
    """Mean and spread of the paper's figures, of the runs that were done as they should."""
    return {
        cell.label: {f.name: cell.spread(TableFigure((f.name,), f.name)) for f in paper.figures}
        for cell in found
        if cell.done
    }


def beside_published(paper: Paper, ours: Numbers) -> dict[str, Charts]:
    """Ours over the paper's, a panel a figure: equal ratios lie along a diagonal.

    None where no run is a result.
    """
    theirs = published(paper)
    panels = []
    for figure in paper.figures:
        known = [n for n in theirs if figure.name in theirs[n]]
        names = [n for n in known if figure.name in ours.get(n, {})]
        families = dict.fromkeys(split_label(name)[0] for name in names)
        lines = []
        for first, colour in zip(families, cycle(COLOURS), strict=False):
            these = [name for name in names if split_label(name)[0] == first]
            x, y = (np.array([t[n][figure.name].mean for n in these]) for t in (theirs, ours))
            lines.append(Line(x, y, first, colour, marks=np.zeros(len(x), dtype=bool)))
        if lines:
            log_x, log_y = (wide(np.concatenate([getattr(line, axis) for line in lines]), WIDE)
                            for axis in "xy")  # fmt: skip
            heads = f"the paper's {figure.says}", f"{figure.says} here"
            panels.append(Panel(figure.says, *heads, lines, log_x=log_x, log_y=log_y))
    title = "Ours over the paper's: what stands in the same order rises"
    return {"-published": Charts(title, panels, True)} if panels else {}
