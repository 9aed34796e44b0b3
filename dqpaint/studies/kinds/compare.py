"""One drawing, several laws, plants or arms: pictures alike, their overlay, errors, one table."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations as pairs
from pathlib import Path

import numpy as np

from dqpaint.errors import DqpaintError
from dqpaint.language.writing import builder
from dqpaint.outputs import files
from dqpaint.settings import Settings
from dqpaint.studies.experiment import cells
from dqpaint.studies.experiment.axes import Axis, combinations, settings_of
from dqpaint.studies.experiment.cells import Cell, TableFigure, find_figure
from dqpaint.studies.experiment.statistics import LEVEL, holm, welch
from dqpaint.studies.report.page import Block, Page, Pictured, Rows, Words, files_of, html
from dqpaint.studies.report.pictures import pictures
from dqpaint.studies.runner.engine import Workers, carry_out_study
from dqpaint.studies.runner.reporter import SILENT, Reporter
from dqpaint.studies.runner.run import Run, drawing_text, repeated

SIZE = (640, 360)  # of its pictures, if nothing else is said


@dataclass(frozen=True)
class Comparison:
    """What came of a comparison.

    Attributes:
        name: of the drawing.
        settings: what all have in common.
        cells: one a choice.
        folder: where record and pictures lie.
        text: of the drawing.
    """

    name: str
    settings: Settings
    cells: tuple[Cell, ...]
    folder: Path
    text: str = ""


def compare(
    drawing: str | builder.Drawing,
    axes: Sequence[Axis],
    base: Settings,
    folder: Path,
    count: int,
    jobs: Workers,
    reporter: Reporter = SILENT,
) -> Comparison:
    """Paint a drawing with every combination of the axes' values.

    Args:
        drawing: a file, an example's name, or one made by calls.
        axes: what differs.
        base: all other settings; its seed is that of the first run.
        folder: of the study.
        count: how many runs each, with the seeds that follow.
        jobs: how many processes, None is one a core; or the address of a Dask cluster.
        reporter: is told how far it is.

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    name, text = drawing_text(drawing)
    choices = combinations(axes)
    keep = ("series", "light")
    runs = repeated([Run(name, text, settings_of(base, one), keep) for one in choices], count)
    several = [axis.name for axis in axes if len(axis.texts) > 1] or [axes[0].name]
    whole = [run for row in runs for run in row]
    results = iter(carry_out_study(whole, folder, jobs, "compare", reporter))
    found = tuple(
        Cell({n: choice[n] for n in several}, tuple(next(results) for _ in row))
        for choice, row in zip(choices, runs, strict=True)
    )
    return Comparison(Path(name).name, base, found, folder, text)


def save(compared: Comparison, measure: str, again: str | None = None) -> list[Path]:
    """Write the files; returns their paths. Arguments as those of `contents`."""
    return files.write(compared.folder / stem(compared), contents(compared, measure, again))


def stem(compared: Comparison) -> str:
    """What the files of a comparison begin with."""
    return Path(compared.name).stem


def contents(compared: Comparison, measure: str, again: str | None = None) -> dict[str, bytes]:
    """Pictures and tables by the ends of their names.

    Args:
        compared: from `compare`.
        measure: name of the figure that is tested.
        again: the command that does it again, for a report; None for no report.
    """
    figure = find_figure(measure, compared.cells)
    title = f"# {compared.name}, compared\n\n"
    shown = pictures(compared.cells, compared.folder, compared.settings)
    parts = [cells.markdown(cells.rows(compared.cells))]
    if differences(compared.cells, figure):
        parts += [about_test(figure), cells.markdown(differences(compared.cells, figure))]
    made = {
        **files_of(shown),
        "-table.csv": cells.csv(compared.cells),
        "-table.md": (title + "\n\n".join(parts) + "\n").encode(),
    }
    if again is not None:
        made["-report.html"] = html(page(compared, figure, shown, again))
    return made


def page(
    compared: Comparison, figure: TableFigure, shown: Mapping[str, Pictured], again: str
) -> Page:
    """The comparison as a report."""
    many = any(len(cell.results) > 1 for cell in compared.cells)
    title = "Means and standard deviations" if many else "Figures"
    rows = cells.rows(compared.cells)
    bars = tuple(rows[0].index(head) for head in cells.error_headings(compared.cells))
    blocks: list[Block] = [Rows(title, rows, bars, cells.meaning())]
    tests = differences(compared.cells, figure)
    if tests:
        blocks += [Rows("Differences", tests), Words(about_test(figure))]
    blocks += shown.values()
    return Page(f"{compared.name}, compared", blocks, compared.settings, compared.text, again)


def differences(found: Sequence[Cell], figure: TableFigure) -> list[list[str]]:
    """Whether means differ by more than chance: rows of text, the best first; none without runs."""
    ranked = sorted((c for c in found if len(c.done) > 1), key=lambda cell: cell.of(figure).mean)
    tests = [
        (a, b, test)
        for a, b in pairs(ranked, 2)
        if (test := welch(a.of(figure), b.of(figure))) is not None
    ]
    if not tests:
        return []
    chances = holm([test.p for _, _, test in tests])
    lines = [["smaller", "larger", "ratio", "t", "degrees of freedom", "p (Holm)", "differ"]]
    for (a, b, test), p in zip(tests, chances, strict=True):
        small, large = a.of(figure).mean, b.of(figure).mean
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


def told(compared: Comparison, measure: str, columns: int) -> str:
    """The tables for a terminal.

    Raises:
        UsageError: no figure of that name.
        DqpaintError: every run failed.
    """
    figure = find_figure(measure, compared.cells)
    if all(not cell.results[0].figures for cell in compared.cells):
        raise DqpaintError(f"every run failed; the first: {compared.cells[0].results[0].message}")
    parts = [cells.narrow(cells.rows(compared.cells), columns)]
    tests = differences(compared.cells, figure)
    if tests:
        parts += [about_test(figure), cells.text(tests)]
    return "\n\n".join(parts)
