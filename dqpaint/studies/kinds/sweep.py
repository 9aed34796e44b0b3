"""A drawing over one or two axes of values: table, curve or heat map, unstable points marked."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.language.writing import builder
from dqpaint.outputs import files
from dqpaint.settings import SMALLEST, Settings
from dqpaint.studies.experiment import cells
from dqpaint.studies.experiment.axes import Axis, about, combinations, label, settings_of
from dqpaint.studies.experiment.cells import Cell, TableFigure, find_figure
from dqpaint.studies.report.charts import HeatMap, Line, Panel
from dqpaint.studies.report.page import (
    Block,
    Charts,
    Map,
    Page,
    Pictured,
    Rows,
    Words,
    files_of,
    html,
)
from dqpaint.studies.runner.engine import Workers, carry_out_study
from dqpaint.studies.runner.reporter import SILENT, Reporter
from dqpaint.studies.runner.run import Run, drawing_text, repeated

MOST_RUNS = 100_000
EFFORT = "command_integral_rad"  # of laws that command torque, theirs


@dataclass(frozen=True)
class Sweep:
    """What came of a sweep: one cell a combination, the last axis running fastest."""

    name: str
    axes: tuple[Axis, ...]
    cells: tuple[Cell, ...]
    folder: Path
    settings: Settings | None = None
    text: str = ""


def sweep(
    drawing: str | builder.Drawing,
    axes: Sequence[Axis],
    base: Settings,
    folder: Path,
    count: int,
    jobs: Workers,
    reporter: Reporter = SILENT,
) -> Sweep:
    """Run a drawing with every combination of the axes' values; pictures are not kept.

    Args:
        drawing: a file, an example's name, or one made by calls.
        axes: one or two.
        base: all other settings.
        folder: of the study.
        count: how many runs each, with the seeds that follow.
        jobs: how many processes, None is one a core; or the address of a Dask cluster.
        reporter: is told how far it is.

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
    name, text = drawing_text(drawing)
    small = base.model_copy(update={"width": SMALLEST, "height": SMALLEST})
    choices = combinations(axes)
    runs = repeated([Run(name, text, settings_of(small, choice)) for choice in choices], count)
    whole = [run for row in runs for run in row]
    results = iter(carry_out_study(whole, folder, jobs, "sweep", reporter))
    found = tuple(
        Cell(choice, tuple(next(results) for _ in row))
        for choice, row in zip(choices, runs, strict=True)
    )
    return Sweep(Path(name).name, tuple(axes), found, folder, base, text)


def save(swept: Sweep, measure: str, again: str | None = None) -> list[Path]:
    """Write the files; returns their paths. Arguments as those of `contents`."""
    return files.write(swept.folder / stem(swept), contents(swept, measure, again))


def stem(swept: Sweep) -> str:
    """What the files of a sweep begin with."""
    return f"{Path(swept.name).stem}-{'-'.join(axis.name for axis in swept.axes)}"


def contents(swept: Sweep, measure: str, again: str | None = None) -> dict[str, bytes]:
    """Chart and tables by the ends of their names.

    Args:
        swept: from `sweep`.
        measure: name of the figure that is drawn.
        again: the command that does it again, for a report; None for no report.

    Raises:
        UsageError: no figure of that name.
    """
    figure = find_figure(measure, swept.cells)
    title = f"{swept.name} over {' and '.join(axis.name for axis in swept.axes)}"
    rows = cells.rows(swept.cells)
    shown: Pictured = (
        Charts(f"Over {swept.axes[0].name}", curves(swept, figure))
        if len(swept.axes) == 1
        else Map(f"Over {swept.axes[0].name} and {swept.axes[1].name}", surface(swept, figure))
    )
    made = {
        **files_of({"": shown}),
        "-table.csv": cells.csv(swept.cells),
        "-table.md": f"# {title}\n\n{cells.markdown(rows)}\n".encode(),
    }
    if again is not None:
        said = Words("\n".join([*whys(swept), *meanings(swept)]))
        blocks: list[Block] = [shown, said, Rows("All points", rows, note=cells.meaning())]
        made["-report.html"] = html(Page(title, blocks, swept.settings, swept.text, again))
    return made


def values(found: Sequence[Cell], figure: TableFigure) -> Floats:
    """The means (N,) of a figure; nan where no run came to one."""
    return np.array([cell.of(figure).mean for cell in found])


def curves(swept: Sweep, figure: TableFigure) -> list[Panel]:
    """The figure, and the command beside it, over one axis."""
    axis = swept.axes[0]
    numbers = axis.numbers
    x = np.array(numbers or range(len(axis.texts)), dtype=np.float64)
    order = np.argsort(x)
    chosen = [swept.cells[i] for i in order]
    marks = np.array([not cell.stable for cell in chosen])
    effort = find_figure(EFFORT, swept.cells)
    panels = []
    for one in dict.fromkeys((figure, effort)):
        y = values(chosen, one)
        # where there is no number the mark stands at the top
        top = np.nanmax(y) if np.isfinite(y).any() else 1.0
        shown = np.where(np.isfinite(y), y, top)
        bars = np.array([cell.of(one).std for cell in chosen])
        name = one.heading.split(" [")[0]
        width = 1.8 if numbers else 0.0  # between names there is nothing
        line = Line(x[order], shown, name, marks=marks, bars=bars, width=width)
        panels.append(
            Panel(
                f"{name} over {axis.name}",
                _named(axis, swept),
                one.heading,
                [line],
                log_x=bool(numbers) and _spans(x),
                log_y=bool((shown > 0).all()) and _spans(shown),
                ticks=None if numbers else axis.texts,
            )
        )
    return panels


def _named(axis: Axis, swept: Sweep) -> str:
    return axis.name if swept.settings is None else label(axis.name, swept.settings)


def meanings(swept: Sweep) -> list[str]:
    """What is varied, a line an axis that has a description."""
    if swept.settings is None:
        return []
    told = [(axis.name, about(axis.name, swept.settings)) for axis in swept.axes]
    return [f"{name}: {text}." for name, text in told if text]


def surface(swept: Sweep, figure: TableFigure) -> HeatMap:
    """The figure as a heat map: the first axis upwards, the second to the right."""
    up, right = swept.axes
    shape = len(up.texts), len(right.texts)
    means = values(swept.cells, figure).reshape(shape)
    marked = np.array([not cell.stable for cell in swept.cells]).reshape(shape)
    good = means[~marked & np.isfinite(means)]
    log = good.size > 0 and bool((good > 0).all()) and _spans(good)
    title = f"{swept.name}: {figure.heading}"
    names = _named(right, swept), _named(up, swept)
    return HeatMap(title, *names, right.texts, up.texts, means, marked, log)


def _spans(these: Floats) -> bool:
    """Whether values, all positive, are far enough apart for a logarithmic axis."""
    return bool(these.min() > 0) and bool(these.max() >= 20 * these.min())


def told(swept: Sweep, measure: str, columns: int) -> str:
    """The table for a terminal, and why points are unstable.

    Raises:
        UsageError: no figure of that name.
        DqpaintError: every run failed.
    """
    find_figure(measure, swept.cells)
    if all(cell.status in ("failed", "died") for cell in swept.cells):
        raise DqpaintError(f"every run failed; the first: {swept.cells[0].results[0].message}")
    table = cells.rows(swept.cells)
    text = cells.text(table)
    if max(map(len, text.splitlines())) > columns:  # what few columns can say of many rows
        kept = [table[0].index(axis.name) for axis in swept.axes]
        kept += [table[0].index(head) for head in cells.error_headings(swept.cells)]
        kept.append(len(table[0]) - 1)
        text = cells.text([[row[i] for i in kept] for row in table])
    return "\n".join([text, *whys(swept)])


def whys(swept: Sweep) -> list[str]:
    """Why points are not as they should be, each reason once."""
    bad = (cell for cell in swept.cells if not cell.stable)
    return list(dict.fromkeys(f"{cell.status}: {cell.why}" for cell in bad))
