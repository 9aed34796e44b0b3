"""Repeated runs of one choice -> one row of a table: mean and spread of every figure."""

import io
import math
import re
from collections.abc import Sequence
from csv import writer
from dataclasses import dataclass
from typing import NamedTuple

from dqpaint import metrics
from dqpaint.errors import UsageError
from dqpaint.studies.experiment.statistics import Spread, spread
from dqpaint.studies.runner.run import Result


class TableFigure(NamedTuple):
    """A figure as tables show it: its names in a summary, a heading, and a scale to its unit."""

    names: tuple[str, ...]
    heading: str
    scale: float = 1.0


KINDS = {"error": "Errors, of which less is better:", "cost": "What it costs:"}


def listed_figures(*kinds: str) -> tuple[TableFigure, ...]:
    """The figures of some kinds, or all, that tables show; those of one title are one of them."""
    by_title: dict[str, list[metrics.Figure]] = {}
    for kind in kinds or KINDS:
        for one in _listed(kind):
            by_title.setdefault(one.title, []).append(one)
    return tuple(map(_together, by_title.values()))


def _listed(kind: str) -> list[metrics.Figure]:
    return [one for one in metrics.all_figures().values() if one.listed and one.kind == kind]


def _together(figures: Sequence[metrics.Figure]) -> TableFigure:
    first, *others = figures
    heading = first.title if others else first.heading
    return TableFigure(tuple(one.name for one in figures), heading, first.scale)


def error_headings(cells: Sequence["Cell"]) -> list[str]:
    """The headings of the errors in a table of cells."""
    return [fitted(figure, cells).heading for figure in listed_figures("error")]


def meaning() -> str:
    """What the figures of tables are, a line each; those of one meaning share it."""
    lines = []
    for kind, heading in KINDS.items():
        titles: dict[str, dict[str, None]] = {}
        for one in _listed(kind):
            titles.setdefault(one.meaning, {})[one.title] = None
        lines += [heading, *(f"{', '.join(these)}: {text}" for text, these in titles.items())]
    return "\n".join(lines)


FAMILY = re.compile(r"(.*?)(?:(, |: )(.*))?$", re.DOTALL)
ROUNDING = 1e-13  # of a figure's own unit: what is smaller is shown as 0


@dataclass(frozen=True)
class Cell:
    """One choice and what came of its runs.

    Attributes:
        choice: what was chosen, by the names of the axes, as it was written.
        results: of its runs, one a seed.
    """

    choice: dict[str, str]
    results: tuple[Result, ...]

    @property
    def label(self) -> str:
        """The choice in a few words."""
        return ", ".join(self.choice.values())

    @property
    def done(self) -> list[Result]:
        """The runs that figures are taken from."""
        return [result for result in self.results if result.status == "done"]

    @property
    def stable(self) -> bool:
        """Whether every run came to its end as it should."""
        return len(self.done) == len(self.results)

    @property
    def status(self) -> str:
        """`done`, or what became of how many runs."""
        counts: dict[str, int] = {}
        for result in self.results:
            counts[result.status] = counts.get(result.status, 0) + 1
        if len(counts) == 1:
            return next(iter(counts))
        return ", ".join(f"{count} {status}" for status, count in counts.items())

    @property
    def why(self) -> str:
        """The first line of the first fault."""
        faults = [result.message for result in self.results if result.status != "done"]
        return faults[0].splitlines()[0] if faults else ""

    def of(self, figure: TableFigure) -> Spread:
        """Mean and spread of a figure; of unstable runs only where all are."""
        chosen = self.done or [result for result in self.results if result.figures]
        rows = (result.figures for result in chosen)
        return spread([row[n] * figure.scale for row in rows for n in figure.names if n in row])


def family(label: str) -> tuple[str, str]:
    """The first part of a cell's name, and what tells it from others of its kind.

    Of `HIR, 20 %` these are `HIR` and `20 %`; of a name of one part it and nothing.
    """
    first, _, rest = FAMILY.match(label).groups("")  # type: ignore[union-attr]
    return first, rest


def check_figure(name: str) -> None:
    """Refuse a figure that no run can have, before the first begins.

    Raises:
        UsageError: there is none of that name.
    """
    known = metrics.all_figures()
    if name not in known:
        raise UsageError(f"no figure named '{name}'; known: {', '.join(known)}")


def find_figure(name: str, cells: Sequence[Cell]) -> TableFigure:
    """A figure by its name in a summary.

    Raises:
        UsageError: no run has one of that name.
    """
    for figure in listed_figures():
        if name in figure.names:
            return fitted(figure, cells)
    there = names_of(cells)
    if there and name not in there:
        raise UsageError(f"no figure named '{name}'; known: {', '.join(there)}")
    known = metrics.all_figures()
    return _together([known[name]]) if name in known else TableFigure((name,), name)


def fitted(figure: TableFigure, cells: Sequence[Cell]) -> TableFigure:
    """The figure with the unit it has in these cells: laws differ in what they command."""
    if len(figure.names) == 1:
        return figure
    there, known = names_of(cells), metrics.all_figures()
    units = ", ".join(known[name].shown for name in figure.names if name in there)
    return figure._replace(heading=f"{figure.heading} [{units}]") if units else figure


def names_of(cells: Sequence[Cell]) -> list[str]:
    """The names of every figure that some run has, in the order of its summary."""
    results = (result for cell in cells for result in cell.results)
    return list(dict.fromkeys(name for result in results for name in result.figures))


def rows(cells: Sequence[Cell]) -> list[list[str]]:
    """Headings and rows of text; what was not done says so."""
    axes = list(cells[0].choice)
    figures = [fitted(figure, cells) for figure in listed_figures()]
    found = [[*axes, *(figure.heading for figure in figures), "runs", "status"]]
    for cell in cells:
        texts = [said(cell.of(figure)) for figure in figures]
        runs = str(len(cell.results))
        found.append([*(cell.choice[axis] for axis in axes), *texts, runs, cell.status])
    return found


def said(value: Spread) -> str:
    """A mean with its spread, four digits."""
    if not value.n:
        return "-"
    mean = 0.0 if abs(value.mean) < ROUNDING else value.mean
    return f"{mean:.4g}" if value.n < 2 else f"{mean:.4g} ± {value.std:.2g}"


def text(lines: Sequence[Sequence[str]]) -> str:
    """Rows below each other, for a terminal."""
    widths = [max(len(line[i]) for line in lines) for i in range(len(lines[0]))]
    return "\n".join(
        "  ".join(f"{word:<{width}}" for word, width in zip(line, widths, strict=True)).rstrip()
        for line in lines
    )


def narrow(lines: Sequence[Sequence[str]], columns: int) -> str:
    """The same turned round, one row a figure, where it would be wider than the terminal."""
    wide = text(lines)
    if max(len(line) for line in wide.splitlines()) <= columns:
        return wide
    return text([list(column) for column in zip(*lines, strict=True)])


def markdown(lines: Sequence[Sequence[str]]) -> str:
    """Rows as a table in Markdown."""
    made = ["| " + " | ".join(word.replace("|", "\\|") for word in line) + " |" for line in lines]
    return "\n".join([made[0], "|" + "---|" * len(lines[0]), *made[1:]])


Columns = dict[str, list[str] | list[int] | list[float]]


def columns(cells: Sequence[Cell]) -> Columns:
    """Every figure of every cell in SI units, mean and spread; nan where there is none."""
    found: Columns = {axis: [cell.choice[axis] for cell in cells] for axis in cells[0].choice}
    found["runs"] = [len(cell.results) for cell in cells]
    found["done"] = [len(cell.done) for cell in cells]
    found["status"] = [cell.status for cell in cells]
    found["message"] = [cell.why for cell in cells]
    for name in names_of(cells):
        spreads = [cell.of(TableFigure((name,), name)) for cell in cells]
        found[f"{name}_mean"] = [one.mean for one in spreads]
        found[f"{name}_std"] = [one.std for one in spreads]
    return found


def csv(cells: Sequence[Cell]) -> bytes:
    """The columns as a file; all digits of a number, and nothing where there is none."""
    table = columns(cells)
    file = io.StringIO()
    out = writer(file, lineterminator="\n")
    out.writerow(table)
    for row in zip(*table.values(), strict=True):
        out.writerow(["" if isinstance(v, float) and math.isnan(v) else v for v in row])
    return file.getvalue().encode()
