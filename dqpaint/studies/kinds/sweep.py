"""A drawing and one or two axes of values -> a table, and a curve or heat map of a figure."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from dqpaint.core import tables
from dqpaint.errors import UsageError
from dqpaint.settings import SMALLEST, Settings
from dqpaint.studies.experiment import cells
from dqpaint.studies.experiment.axes import (
    Axis,
    axis_description,
    axis_label,
    combinations,
    with_choice,
)
from dqpaint.studies.experiment.cells import TableFigure, find_figure, means_of
from dqpaint.studies.kinds.study_request import StudyRequest
from dqpaint.studies.kinds.study_result import ANY_WIDTH, StudyResult
from dqpaint.studies.report.charts import HeatMap, Line, Panel, wide
from dqpaint.studies.report.page import Block, Charts, Map, Pictured, Rows, Words, files_of
from dqpaint.studies.runner.run import Run, check_seeds

Scale = Literal["auto", "linear", "log"]
MOST_RUNS = 100_000
EFFORT = "command_integral_rad"  # of laws that command torque, theirs


@dataclass(frozen=True)
class SweepShape:
    """How a sweep is drawn.

    Attributes:
        x: the axis that figures are drawn over; of two axes None is a heat map.
        scale: of the figures.
        x_scale: of the axis.
    """

    x: str | None = None
    scale: Scale = "auto"
    x_scale: Scale = "auto"


AUTOMATIC = SweepShape()


@dataclass(frozen=True, kw_only=True)
class Sweep(StudyResult):
    """A finished sweep: one cell a combination of the axes' values, the last axis running fastest.

    `figure` is the name of the figure that is drawn.
    """

    settings: Settings
    axes: tuple[Axis, ...]
    figure: str
    shape: SweepShape = AUTOMATIC

    @property
    def stem(self) -> str:
        """The first part of the files' names."""
        return "-".join([super().stem, *(axis.name for axis in self.axes)])

    @property
    def title(self) -> str:
        """The heading of its pages."""
        return f"{self.name} over {' and '.join(axis.name for axis in self.axes)}"

    def table_text(self, width: int = ANY_WIDTH) -> str:
        """The table for a terminal, and why points are no results."""
        find_figure(self.figure, self.cells)
        if all(cell.status in ("failed", "died") for cell in self.cells):
            raise cells.every_run_failed(self.cells)
        rows = cells.rows(self.cells)
        lines = tables.align(rows)
        if max(map(len, lines)) > width:  # the columns that few characters have room for
            heads = [*(axis.name for axis in self.axes), *cells.error_headings(self.cells)]
            columns = [*map(rows[0].index, heads), len(rows[0]) - 1]
            lines = tables.align([[row[i] for i in columns] for row in rows])
        return "\n".join([*lines, *self.hidden])

    def files_and_blocks(self) -> tuple[dict[str, bytes], list[Block]]:
        """Chart and tables by the ends of their names, and the same for a page."""
        figure = find_figure(self.figure, self.cells)
        rows = cells.rows(self.cells)
        over = f"Over {' and '.join(axis.name for axis in self.axes)}"
        shown: Pictured = (
            Charts(over, curves(self, figure))
            if len(self.axes) == 1 or self.shape.x is not None
            else Map(over, surface(self, figure))
        )
        made = {
            **files_of({"": shown}, self.formats),
            "-table.csv": cells.csv(self.cells),
            "-table.md": tables.page(self.title, tables.markdown(rows), *self.hidden_block),
        }
        words = Words("\n".join([*self.hidden, *axis_descriptions(self)]))
        return made, [shown, words, Rows("All points", rows, note=cells.figure_meanings())]


def sweep(
    request: StudyRequest,
    axes: Sequence[Axis],
    base: Settings,
    count: int = 1,
    figure: str = "position_error_rms_m",
    shape: SweepShape = AUTOMATIC,
) -> Sweep:
    """Run a drawing with every combination of the axes' values; pictures are not kept.

    Args:
        request: the drawing, the folder and the workers.
        axes: one or two.
        base: all other settings.
        count: how many runs each, with the seeds that follow.
        figure: name of the figure that is drawn.
        shape: of the chart.

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    if not 1 <= len(axes) <= 2:
        raise UsageError(
            f"{len(axes)} axes; a sweep has one --vary or two, or --plants and the like"
        )
    if len({axis.name for axis in axes}) < len(axes):
        raise UsageError(f"'{axes[0].name}' is varied twice")
    if math.prod(len(axis.texts) for axis in axes) * max(count, 1) > MOST_RUNS:
        raise UsageError(f"these are more than {MOST_RUNS:,} runs; take fewer values")
    if shape.x not in (None, *(axis.name for axis in axes)):
        varied = ", ".join(axis.name for axis in axes)
        raise UsageError(f"x '{shape.x}' is not varied; it is {varied}")
    name, text = request.drawing
    small = base.model_copy(update={"width": SMALLEST, "height": SMALLEST})
    choices = combinations(axes)
    runs = [Run(name, text, with_choice(small, choice)) for choice in choices]
    if any(axis.name == "seed" for axis in axes):
        check_seeds(runs)
    return Sweep(
        name=Path(name).name, axes=tuple(axes), cells=request.cells(choices, runs, count),
        folder=request.folder, settings=base, text=text, figure=figure,
        shape=shape,
    )  # fmt: skip


def curves(swept: Sweep, figure: TableFigure) -> list[Panel]:
    """The figure, and the command beside it, over one axis; a line for each value of another."""
    shape = swept.shape
    axis = next((one for one in swept.axes if one.name == shape.x), swept.axes[0])
    others = [one for one in swept.axes if one is not axis]
    groups = combinations(others) if others else [{}]
    numbers = axis.numbers
    effort = find_figure(EFFORT, swept.cells)
    panels = []
    for one in dict.fromkeys((figure, effort)):
        name = one.heading.split(" [")[0]
        lines = [_line(swept, one, axis, group, name) for group in groups]
        shown = np.concatenate([line.y for line in lines])
        log_x = bool(numbers) and wide(np.array(numbers))
        panels.append(
            Panel(
                f"{name} over {axis.name}",
                axis_label(axis.name, swept.settings),
                one.heading,
                lines,
                log_x=log_x if shape.x_scale == "auto" else shape.x_scale == "log",
                log_y=wide(shown) if shape.scale == "auto" else shape.scale == "log",
                ticks=None if numbers else axis.texts,
            )
        )
    return panels


def _line(
    swept: Sweep, figure: TableFigure, axis: Axis, group: Mapping[str, str], name: str
) -> Line:
    """A figure of the cells of a group over an axis; where there is no number, at the top."""
    found = [cell for cell in swept.cells if group.items() <= cell.choice.items()]
    x = np.array(axis.numbers or range(len(axis.texts)), dtype=np.float64)
    order = np.argsort(x)
    chosen = [found[i] for i in order]
    marks = np.array([not cell.stable for cell in chosen])
    y = means_of(chosen, figure)
    top = np.nanmax(y) if np.isfinite(y).any() else 1.0
    shown = np.where(np.isfinite(y), y, top)
    bars = np.array([cell.spread(figure).std for cell in chosen])
    label = ", ".join(f"{key} {value}" for key, value in group.items()) or name
    width = 1.8 if axis.numbers else 0.0  # between names there is nothing
    return Line(x[order], shown, label, marks=marks, bars=bars, width=width)


def axis_descriptions(swept: Sweep) -> list[str]:
    """What is varied, a line an axis that has a description."""
    told = [(axis.name, axis_description(axis.name, swept.settings)) for axis in swept.axes]
    return [f"{name}: {text}." for name, text in told if text]


def surface(swept: Sweep, figure: TableFigure) -> HeatMap:
    """The figure as a heat map: the first axis upwards, the second to the right."""
    up, right = swept.axes
    shape = len(up.texts), len(right.texts)
    means = means_of(swept.cells, figure).reshape(shape)
    marked = np.array([not cell.stable for cell in swept.cells]).reshape(shape)
    good = means[~marked & np.isfinite(means)]
    title = f"{swept.name}: {figure.heading}"
    heads = axis_label(right.name, swept.settings), axis_label(up.name, swept.settings)
    return HeatMap(title, *heads, right.texts, up.texts, means, marked, wide(good))
