"""A drawing, and several laws, plants or arms -> pictures at one exposure, errors, one table."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations as pairs
from pathlib import Path

import numpy as np

from dqpaint.core import tables
from dqpaint.settings import Settings
from dqpaint.studies.experiment import cells
from dqpaint.studies.experiment.axes import Axis, combinations, with_choice
from dqpaint.studies.experiment.cells import Cell, TableFigure, find_figure
from dqpaint.studies.experiment.statistics import LEVEL, holm, welch
from dqpaint.studies.kinds.study_request import StudyRequest
from dqpaint.studies.kinds.study_result import ANY_WIDTH, StudyResult
from dqpaint.studies.report.page import Block, Rows, Words, files_of
from dqpaint.studies.report.pictures import pictures
from dqpaint.studies.runner.run import Run


@dataclass(frozen=True, kw_only=True)
class Comparison(StudyResult):
    """A finished comparison; `figure` is the name of the figure that is tested."""

    settings: Settings
    figure: str

    @property
    def title(self) -> str:
        """The heading of its pages."""
        return f"{self.name}, compared"

    def table_text(self, width: int = ANY_WIDTH) -> str:
        """All figures and the differences, for a terminal."""
        figure = find_figure(self.figure, self.cells)
        if all(not cell.results[0].figures for cell in self.cells):
            raise cells.every_run_failed(self.cells)
        parts = ["\n".join(tables.fit(cells.rows(self.cells), width))]
        if tests := differences(self.cells, figure):
            parts += [about_test(figure), "\n".join(tables.align(tests))]
        return "\n\n".join(parts)

    def files_and_blocks(self) -> tuple[dict[str, bytes], list[Block]]:
        """Pictures and tables by the ends of their names, and the same for a page."""
        figure = find_figure(self.figure, self.cells)
        shown = pictures(self.cells, self.folder, self.settings)
        rows, tests = cells.rows(self.cells), differences(self.cells, figure)
        many = any(len(cell.results) > 1 for cell in self.cells)
        bars = tuple(rows[0].index(head) for head in cells.error_headings(self.cells))
        heading = "Means and standard deviations" if many else "Figures"
        blocks: list[Block] = [Rows(heading, rows, bars, cells.figure_meanings())]
        parts = [f"# {self.title}", tables.markdown(rows)]
        if tests:
            blocks += [Rows("Differences", tests), Words(about_test(figure))]
            parts += [about_test(figure), tables.markdown(tests)]
        made = {
            **files_of(shown),
            "-table.csv": cells.csv(self.cells),
            "-table.md": ("\n\n".join(parts) + "\n").encode(),
        }
        return made, [*blocks, *shown.values()]


def compare(
    request: StudyRequest,
    axes: Sequence[Axis],
    base: Settings,
    count: int = 1,
    figure: str = "error_integral",
) -> Comparison:
    """Paint a drawing with every combination of the axes' values.

    Args:
        request: of which drawing, where and by whom.
        axes: what differs.
        base: all other settings; its seed is that of the first run.
        count: how many runs each, with the seeds that follow.
        figure: name of the figure that is tested for differences.

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    name, text = request.drawing
    choices = combinations(axes)
    keep = ("series", "light")
    runs = [Run(name, text, with_choice(base, one), keep) for one in choices]
    several = [axis.name for axis in axes if len(axis.texts) > 1] or [axes[0].name]
    found = request.cells([{n: choice[n] for n in several} for choice in choices], runs, count)
    return Comparison(
        name=Path(name).name, settings=base, cells=found, folder=request.folder, text=text,
        figure=figure,
    )  # fmt: skip


def differences(found: Sequence[Cell], figure: TableFigure) -> list[list[str]]:
    """Whether means differ by more than chance: rows of text, the best first; none without runs."""
    ranked = sorted(
        (c for c in found if len(c.done) > 1), key=lambda cell: cell.spread(figure).mean
    )
    tests = [
        (a, b, test)
        for a, b in pairs(ranked, 2)
        if (test := welch(a.spread(figure), b.spread(figure))) is not None
    ]
    if not tests:
        return []
    chances = holm([test.p for _, _, test in tests])
    lines = [["smaller", "larger", "ratio", "t", "degrees of freedom", "p (Holm)", "differ"]]
    for (a, b, test), p in zip(tests, chances, strict=True):
        small, large = a.spread(figure).mean, b.spread(figure).mean
        ratio = f"{large / small:.3g}" if small > 0 else "-"
        verdict = "yes" if p < LEVEL else "not shown"
        freedom = f"{test.freedom:.1f}" if np.isfinite(test.freedom) else "-"
        lines.append([a.label, b.label, ratio, f"{abs(test.t):.3g}", freedom, f"{p:.2g}", verdict])
    return lines


def about_test(figure: TableFigure) -> str:
    """What the table of differences says."""
    return (
        f"Whether the mean of {figure.heading} differs by more than its spread explains: Welch's "
        f"t-test, two-sided, corrected for all pairs after Holm, at {LEVEL:.0%}. The runs of all "
        "have the same seeds, which makes the test cautious."
    )
