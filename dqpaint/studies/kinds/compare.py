"""A drawing, and several laws, plants or arms -> pictures at one exposure, errors, one table."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from dqpaint.core import tables
from dqpaint.errors import UsageError
from dqpaint.settings import Settings
from dqpaint.studies.experiment import cells, comparisons
from dqpaint.studies.experiment.axes import Axis, combinations, with_choice
from dqpaint.studies.experiment.cells import Cell, TableFigure, find_figure
from dqpaint.studies.experiment.comparisons import Chosen
from dqpaint.studies.kinds.study_request import StudyRequest
from dqpaint.studies.kinds.study_result import ANY_WIDTH, StudyResult
from dqpaint.studies.report.box_plots import LEAST_BOXED, box_plot
from dqpaint.studies.report.page import Block, Charts, Pictured, Rows, Words, files_of
from dqpaint.studies.report.pictures import MOST_TOGETHER, ChartChoice, pictures
from dqpaint.studies.runner.run import Run


@dataclass(frozen=True, kw_only=True)
class Comparison(StudyResult):
    """A finished comparison: `figure` is the name of the figure that is tested, in which pairs."""

    settings: Settings
    figure: str
    chosen: Chosen
    shape: ChartChoice

    @property
    def title(self) -> str:
        """The heading of its pages."""
        return f"{self.name}, compared"

    def table_text(self, width: int = ANY_WIDTH) -> str:
        """All figures and the differences, for a terminal."""
        figure = find_figure(self.figure, self.cells)
        if all(not cell.results[0].figures for cell in self.cells):
            raise cells.every_run_failed(self.cells)
        parts = ["\n".join([*tables.fit(cells.rows(self.cells), width), *self.hidden])]
        if tests := comparisons.differences(self.cells, figure, self.chosen):
            parts += [
                "\n".join(tables.align(cells.spread_rows(self.cells, figure))),
                comparisons.about(tests, figure.heading, self.chosen.method),
                "\n".join(comparisons.terminal_rows(tests, figure.unit)),
            ]
        return "\n\n".join(parts)

    def files_and_blocks(self) -> tuple[dict[str, bytes], list[Block]]:
        """Pictures and tables by the ends of their names, and the same for a page."""
        figure = find_figure(self.figure, self.cells)
        shown = pictures(self.cells, self.folder, self.settings, self.shape)
        shown |= boxes(self.cells, figure)
        rows = cells.rows(self.cells)
        tests = comparisons.differences(self.cells, figure, self.chosen)
        many = any(len(cell.results) > 1 for cell in self.cells)
        bars = tuple(rows[0].index(head) for head in cells.error_headings(self.cells))
        heading = "Means and standard deviations" if many else "Figures"
        blocks: list[Block] = [Rows(heading, rows, bars, cells.figure_meanings())]
        blocks.append(Words("\n".join(self.hidden)))
        parts = [tables.markdown(rows), *self.hidden_block]
        if tests:
            told = comparisons.about(tests, figure.heading, self.chosen.method)
            spreads = cells.spread_rows(self.cells, figure)
            differ = comparisons.difference_rows(tests, figure.unit)
            blocks += [Rows(f"Spread of {figure.heading}", spreads),
                       Rows("Differences", differ), Words(told)]  # fmt: skip
            parts += [tables.markdown(spreads), told, tables.markdown(differ)]
        made = {
            **files_of(shown, self.formats),
            **({"-tests.csv": comparisons.csv(tests, figure.heading)} if tests else {}),
            "-table.csv": cells.csv(self.cells),
            "-table.md": tables.page(self.title, *parts),
        }
        return made, [*blocks, *shown.values()]


def boxes(found: Sequence[Cell], figure: TableFigure) -> dict[str, Pictured]:
    """How the tested figure is distributed over the runs that are results, if they are enough."""
    groups = {cell.label: list(cell.by_seed(figure).values()) for cell in found}
    if max(map(len, groups.values())) < LEAST_BOXED:
        return {}
    title = "How the runs are distributed; those that are no result are left out"
    return {"-boxes": Charts(title, [box_plot(figure.heading, figure.heading, groups)])}


def compare(
    request: StudyRequest,
    axes: Sequence[Axis],
    base: Settings,
    count: int = 1,
    figure: str = "error_integral",
    chosen: Chosen | None = None,
    shape: ChartChoice | None = None,
) -> Comparison:
    """Paint a drawing with every combination of the axes' values.

    Args:
        request: the drawing, the folder and the workers.
        axes: what differs.
        base: all other settings; its seed is that of the first run.
        count: how many runs each, with the seeds that follow.
        figure: name of the figure that is tested for differences.
        chosen: in which pairs; None are those of all laws, or else of the first axis.
        shape: of the curves over time.

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    name, text = request.drawing
    choices = combinations(axes)
    keep = ("errors", "series", "steps", "light")
    runs = [Run(name, text, with_choice(base, one), keep) for one in choices]
    several = [axis.name for axis in axes if len(axis.texts) > 1] or [axes[0].name]
    found = request.cells([{n: choice[n] for n in several} for choice in choices], runs, count)
    return Comparison(
        name=Path(name).name, settings=base, cells=found, folder=request.folder, text=text,
        figure=figure,
        chosen=chosen or comparisons.choose([a for a in axes if a.name in several], None, None),
        shape=replace(shape or ChartChoice(), panels=_panels(shape, found)),
    )  # fmt: skip


def _panels(shape: ChartChoice | None, found: Sequence[Cell]) -> str | None:
    """The axis that has a panel a value; of many cells all but the laws if nobody says which.

    Raises:
        UsageError: it is no axis of these.
    """
    axes = list(found[0].choice)
    if shape is not None and shape.panels is not None:
        if shape.panels not in axes:
            raise UsageError(f"panels '{shape.panels}': what differs here is {', '.join(axes)}")
        return shape.panels
    others = [name for name in axes if name != "controller"]
    many = len(found) > MOST_TOGETHER and "controller" in axes
    return others[0] if many and others else None
