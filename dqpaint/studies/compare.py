"""One drawing, several laws, plants or arms: pictures alike, their overlay, errors, one table."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations as pairs
from pathlib import Path

import numpy as np

from dqpaint.build import Drawing
from dqpaint.charts import Line, Panel, chart
from dqpaint.errors import DqpaintError
from dqpaint.light import contact
from dqpaint.light.legend import Legend, with_legend
from dqpaint.light.looks import LOOKS
from dqpaint.outputs import write
from dqpaint.settings import Settings
from dqpaint.studies import cells
from dqpaint.studies.axes import Axis, combinations, settings_of
from dqpaint.studies.cells import Cell, Figure, find_figure
from dqpaint.studies.engine import Workers, carry_out_study
from dqpaint.studies.keeping import kept
from dqpaint.studies.page import Block, Charts, Page, Rows, Shot, Words, html
from dqpaint.studies.runs import Run, drawing_text, seeded
from dqpaint.studies.statistics import LEVEL, holm, welch

DIM = 0.72  # of a hue on white paper
DARKER = -2.0  # stops, so that a hue is seen and not burnt out
DECADES = 5  # of error: one that begins at 0 would take the whole chart
THICK, THIN = 3.6, 1.2  # lines of the chart: the last do not hide the first


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
    drawing: str | Drawing,
    axes: Sequence[Axis],
    base: Settings,
    folder: Path,
    count: int,
    jobs: Workers,
) -> Comparison:
    """Paint a drawing with every combination of the axes' values.

    Args:
        drawing: a file, an example's name, or one made by calls.
        axes: what differs.
        base: all other settings; its seed is that of the first run.
        folder: of the study.
        count: how many runs each, with the seeds that follow.
        jobs: how many processes, None is one a core; or the address of a Dask cluster.

    Raises:
        DqpaintError: a fault in the drawing, the choices or the folder.
    """
    name, text = drawing_text(drawing)
    choices = combinations(axes)
    runs = [
        seeded(Run(name, text, settings_of(base, choice), ("series", "light")), count)
        for choice in choices
    ]
    several = [axis.name for axis in axes if len(axis.texts) > 1] or [axes[0].name]
    results = iter(carry_out_study([run for row in runs for run in row], folder, jobs, "compare"))
    found = tuple(
        Cell({n: choice[n] for n in several}, tuple(next(results) for _ in row))
        for choice, row in zip(choices, runs, strict=True)
    )
    return Comparison(Path(name).name, base, found, folder, text)


def save(compared: Comparison, measure: str, again: str | None = None) -> list[Path]:
    """Write the files; returns their paths. Arguments as those of `contents`."""
    return write(compared.folder / stem(compared), contents(compared, measure, again))


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
    shown = pictures(compared)
    parts = [cells.markdown(cells.rows(compared.cells))]
    if differences(compared.cells, figure):
        parts += [about_test(figure), cells.markdown(differences(compared.cells, figure))]
    made = {
        **({} if shown is None else shown.files),
        "-table.csv": cells.csv(compared.cells),
        "-table.md": (title + "\n\n".join(parts) + "\n").encode(),
    }
    if again is not None:
        made["-report.html"] = html(page(compared, figure, shown, again))
    return made


@dataclass(frozen=True)
class Pictures:
    """What a comparison shows of the first run of each choice: PNG files, and errors over time."""

    sheet: bytes
    overlay: bytes
    panels: tuple[Panel, ...]

    @property
    def files(self) -> dict[str, bytes]:
        """The pictures by the ends of their names."""
        errors = chart(self.panels, width=12, height=4.5)
        return {"-sheet.png": self.sheet, "-overlay.png": self.overlay, "-errors.png": errors}


def page(compared: Comparison, figure: Figure, shown: Pictures | None, again: str) -> Page:
    """The comparison as a report."""
    blocks: list[Block] = [Rows("Means and standard deviations", cells.rows(compared.cells))]
    tests = differences(compared.cells, figure)
    if tests:
        blocks += [Rows("Differences", tests), Words(about_test(figure))]
    if shown is not None:
        blocks += [
            Shot("One exposure for all", shown.sheet),
            Shot("Laid over each other: what all drew alike is white", shown.overlay),
            Charts("Errors over time, of the first run of each", shown.panels),
        ]
    return Page(f"{compared.name}, compared", blocks, compared.settings, compared.text, again)


def pictures(compared: Comparison) -> Pictures | None:
    """Contact sheet, overlay and errors over time; None if no run came to a picture."""
    settings = compared.settings
    arrays = [
        kept(compared.folder, cell.results[0].key) if cell.results[0].figures else None
        for cell in compared.cells
    ]
    there = [one for one in arrays if one is not None]
    if not there:
        return None
    exposure = float(there[0]["exposure"])  # one for all, or they could not be compared
    develop = LOOKS[settings.look]
    images = [
        contact.note(cell.why, settings.height, settings.width)
        if one is None
        else develop(one["light"], exposure, settings.ev)
        for one, cell in zip(arrays, compared.cells, strict=True)
    ]
    labels = [_label(cell) for cell in compared.cells]
    colours = contact.hues(len(there))
    names = tuple(n for n, one in zip(labels, arrays, strict=True) if one is not None)
    over = develop(contact.overlay([one["light"] for one in there]), exposure, settings.ev + DARKER)
    over = with_legend(
        over, Legend("laid over each other", names, tuple(colours), False), settings.look
    )
    widths = np.geomspace(THICK, THIN, len(there)).tolist()
    lines = [
        Line(one["t_s"], 1e3 * one["position_error_m"], label, _on_paper(colour), width=width)
        for one, label, colour, width in zip(there, names, colours, widths, strict=True)
    ]
    turned = [
        replace(line, y=np.degrees(one["orientation_error_rad"]))
        for line, one in zip(lines, there, strict=True)
    ]
    panels = (
        Panel("position error", "time [s]", "mm", lines, log_y=_wide(lines), decades=DECADES),
        Panel("orientation error", "time [s]", "deg", turned, log_y=_wide(turned), decades=DECADES),
    )
    sheet = contact.sheet(images, labels)
    return Pictures(contact.png(sheet), contact.png(over), panels)


def _label(cell: Cell) -> str:
    status = cell.results[0].status
    return cell.label if status == "done" else f"{cell.label}: {status}"


def _on_paper(colour: contact.Colour) -> str:
    """A hue as it can be read on white."""
    return "#" + "".join(f"{round(255 * DIM * part**0.6):02x}" for part in colour)


def _wide(lines: Sequence[Line]) -> bool:
    """Whether largest errors are so far apart that only a logarithmic axis shows all."""
    most = [float(line.y.max()) for line in lines]
    return min(most) > 0 and max(most) > 20 * min(most)


def differences(found: Sequence[Cell], figure: Figure) -> list[list[str]]:
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


def about_test(figure: Figure) -> str:
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
