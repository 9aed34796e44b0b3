"""Repeated runs of one choice -> one row of a table: mean and spread of every figure."""

import math
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from dqpaint import metrics
from dqpaint.core import tables
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UnknownNameError
from dqpaint.studies.experiment.statistics import Spread, spread
from dqpaint.studies.runner.run import Result, Run


class TableFigure(NamedTuple):
    """A figure as tables show it: its names in a summary, a heading, and a scale to its unit."""

    names: tuple[str, ...]
    heading: str
    scale: float = 1.0

    @property
    def unit(self) -> str:
        """The unit that its heading names."""
        return self.heading.rpartition(" [")[2].removesuffix("]") if "[" in self.heading else ""


KINDS = {
    "error": "Errors, of which less is better:",
    "step": "Response to steps of the set point:",
    "cost": "What it costs:",
}


def listed_figures(*kinds: str) -> tuple[TableFigure, ...]:
    """The figures of some kinds, or all, that tables show; those of one title are one of them."""
    by_title = defaultdict(list)
    for one in _listed(*kinds):
        by_title[one.title].append(one)
    return tuple(map(_together, by_title.values()))


def _listed(*kinds: str) -> list[metrics.Figure]:
    listed = [one for one in metrics.all_figures().values() if one.listed]
    return [one for kind in kinds or KINDS for one in listed if one.kind == kind]


def _together(figures: Sequence[metrics.Figure]) -> TableFigure:
    first, *others = figures
    heading = first.title if others else first.heading
    return TableFigure(tuple(one.name for one in figures), heading, first.scale)


def error_headings(cells: Sequence["Cell"]) -> list[str]:
    """The headings of the errors in a table of cells."""
    return [with_units(figure, cells).heading for figure in listed_figures("error")]


def figure_meanings() -> str:
    """What the figures of tables are, a line each; those of one meaning share it."""
    lines = []
    for kind, heading in KINDS.items():
        titles: dict[str, dict[str, None]] = {}
        for one in _listed(kind):
            titles.setdefault(one.meaning, {})[one.title] = None
        lines += [heading, *(f"{', '.join(these)}: {text}" for text, these in titles.items())]
    return "\n".join(lines)


FAMILY = re.compile(r"(.*?)(?:(, |: )(.*))?$", re.DOTALL)
MOST_LINES = 12  # of remarks of one kind; the CSV has them all
NO_EFFECT = "which moved the tool by less than 1 um and 0.001 deg"
ROUNDING = 1e-13  # of a figure's own unit: what is smaller is shown as 0


@dataclass(frozen=True)
class Cell:
    """One choice and what came of its runs.

    Attributes:
        choice: what was chosen, by the names of the axes, as it was written.
        results: of its runs, one a seed.
        runs: the runs, in the same order; none of a cell whose figures are no run's.
    """

    choice: dict[str, str]
    results: tuple[Result, ...]
    runs: tuple[Run, ...] = ()

    @property
    def label(self) -> str:
        """The choice in a few words."""
        return ", ".join(self.choice.values())

    @property
    def done(self) -> list[Result]:
        """The runs that are results: figures are taken from these alone."""
        return [result for result in self.results if result.status == "done"]

    @property
    def stable(self) -> bool:
        """Whether every run is a result."""
        return len(self.done) == len(self.results)

    @property
    def status(self) -> str:
        """`done`, or what became of how many runs."""
        counts = Counter(result.status for result in self.results)
        if len(counts) == 1:
            return self.results[0].status
        return ", ".join(f"{count} {status}" for status, count in counts.items())

    @property
    def why(self) -> str:
        """The first line of the first fault."""
        faults = [result.message for result in self.results if result.status != "done"]
        return faults[0].splitlines()[0] if faults else ""

    def spread(self, figure: TableFigure) -> Spread:
        """Mean and spread of a figure over the runs that are results."""
        rows = (result.figures for result in self.done)
        return spread([row[n] * figure.scale for row in rows for n in figure.names if n in row])

    def by_seed(self, figure: TableFigure) -> dict[int, float]:
        """A figure of each run that is a result, by its seed, or its place where it has none."""
        seeds = [run.settings.seed for run in self.runs] or range(len(self.results))
        return {
            seed: result.figures[name] * figure.scale
            for seed, result in zip(seeds, self.results, strict=True)
            for name in figure.names
            if result.status == "done" and name in result.figures
        }


def run_cells(
    choices: Sequence[dict[str, str]],
    runs: Sequence[Sequence[Run]],
    carry_out: Callable[[list[Run]], Sequence[Result]],
) -> tuple[Cell, ...]:
    """One cell a choice, from the results of its runs; all runs are carried out together."""
    results = iter(carry_out([run for row in runs for run in row]))
    return tuple(
        Cell(choice, tuple(next(results) for _ in row), tuple(row))
        for choice, row in zip(choices, runs, strict=True)
    )


def what_means_hide(cells: Sequence[Cell]) -> list[str]:
    """Runs that are left out of means, and limits that clipped others: lines of text."""
    runs = [result for cell in cells for result in cell.results]
    out = [result for result in runs if result.status != "done"]
    lines = []
    if out:
        are = "is no result and is" if len(out) == 1 else "are no results and are"
        noun = "run" if len(runs) == 1 else "runs"
        lines.append(f"{len(out)} of {len(runs)} {noun} {are} left out of means, tests and orders:")
        lines += _few([f"{cell.label}: {cell.status}: {cell.why}" for cell in cells if cell.why])
    idle = {
        f"{cell.label}: {name}: {why}": None
        for cell in cells
        for one in cell.done
        for name, why in one.without_effect.items()
    }
    if idle:
        lines.append(f"Disturbances without effect, {NO_EFFECT}:")
        lines += _few(list(idle))
    clipped = {
        cell.label: next(one.limits for one in cell.done if one.limits)
        for cell in cells
        if any(one.limits for one in cell.done)
    }
    if clipped:
        lines.append("Limits clipped commands in results, too:")
        lines += _few([f"{label}: {limits}" for label, limits in clipped.items()])
    return lines


def _few(lines: Sequence[str]) -> list[str]:
    more = [f"and {len(lines) - MOST_LINES} more"] if len(lines) > MOST_LINES else []
    return [f"  {line}" for line in (*lines[:MOST_LINES], *more)]


def every_run_failed(cells: Sequence[Cell]) -> DqpaintError:
    """The fault of a study without any figure."""
    return DqpaintError(f"every run failed; the first: {cells[0].results[0].message}")


def split_label(label: str) -> tuple[str, str]:
    """The first part of a cell's name, and what tells it from others of its kind.

    Of `HIR, 20 %` these are `HIR` and `20 %`; of a name of one part it and nothing.
    """
    first, _, rest = FAMILY.match(label).groups("")  # type: ignore[union-attr]
    return first, rest


def means_of(cells: Sequence[Cell], figure: TableFigure) -> Floats:
    """Where a chart shows cells (N,): means of results, else of the runs that it marks; or nan."""
    return np.array([_shown(cell, figure).mean for cell in cells])


def _shown(cell: Cell, figure: TableFigure) -> Spread:
    if cell.done:
        return cell.spread(figure)
    marked = (replace(result, status="done") for result in cell.results if result.figures)
    return replace(cell, results=tuple(marked)).spread(figure)


def check_figure(name: str) -> None:
    """Refuse a figure that no run can have, before the first begins.

    Raises:
        UsageError: there is none of that name.
    """
    known = metrics.all_figures()
    if name not in known:
        raise UnknownNameError("figure", name, known)


def find_figure(name: str, cells: Sequence[Cell]) -> TableFigure:
    """A figure by its name in a summary.

    Raises:
        UsageError: no run has one of that name.
    """
    for figure in listed_figures():
        if name in figure.names:
            return with_units(figure, cells)
    there = figure_names(cells)
    if there and name not in there:
        raise UnknownNameError("figure", name, there)
    known = metrics.all_figures()
    return _together([known[name]]) if name in known else TableFigure((name,), name)


def with_units(figure: TableFigure, cells: Sequence[Cell]) -> TableFigure:
    """The figure with the unit it has in these cells: laws differ in what they command."""
    if len(figure.names) == 1:
        return figure
    there, known = figure_names(cells), metrics.all_figures()
    units = ", ".join(known[name].display_unit for name in figure.names if name in there)
    return figure._replace(heading=f"{figure.heading} [{units}]") if units else figure


def figure_names(cells: Sequence[Cell]) -> list[str]:
    """The names of every figure that some run has, in the order of its summary."""
    results = (result for cell in cells for result in cell.results)
    return list(dict.fromkeys(name for result in results for name in result.figures))


def rows(cells: Sequence[Cell]) -> list[list[str]]:
    """Headings and rows of text; what was not done says so."""
    axes = list(cells[0].choice)
    there = set(figure_names(cells))
    listed = [one for one in listed_figures() if there & {*one.names}]
    figures = [with_units(figure, cells) for figure in listed]
    found = [[*axes, *(figure.heading for figure in figures), "runs", "status"]]
    for cell in cells:
        texts = [_said(cell, figure) for figure in figures]
        runs = str(len(cell.results))
        found.append([*(cell.choice[axis] for axis in axes), *texts, runs, cell.status])
    return found


def _said(cell: Cell, figure: TableFigure) -> str:
    """A figure of a cell, and of how many of its runs it is, where some have none."""
    value = cell.spread(figure)
    some = 0 < value.n < len(cell.done)
    return spread_text(value) + (f" (of {value.n})" if some else "")


def spread_text(value: Spread) -> str:
    """A mean with its spread; alone, with four digits."""
    if not value.n:
        return "-"
    mean = 0.0 if abs(value.mean) < ROUNDING else value.mean
    return f"{mean:.4g}" if value.n < 2 else " ± ".join(rounded(mean, value.std))


def rounded(value: float, spread: float, *more: float) -> list[str]:
    """A number, its spread and others of its kind, with the digits that fit the spread.

    These are one or two of the spread, by the rule of the Particle Data Group (Rev. Part. Phys.,
    5.3): 0.0074 is 0.007, and 0.0024 stays. Where nothing spreads there are four of the number.
    """
    all_ = (value, spread, *more)
    largest = max((abs(v) for v in all_ if math.isfinite(v)), default=0.0)
    if not (math.isfinite(spread) and spread > 1e-9 * largest):
        return [f"{v:.4g}" for v in all_]
    power = math.floor(math.log10(spread))
    two = round(spread / 10.0**power, 2) < 3.55  # digits; else one
    last = power - two  # the decade of the last digit
    if last >= -7 and largest < 1e5:
        return [f"{round(v, -last):.{max(0, -last)}f}" for v in all_]
    top = math.floor(math.log10(largest))
    scaled = (f"{v / 10.0**top:.{max(0, top - last)}f}" for v in all_)
    return [f"{text}e{top:+03d}" for text in scaled]


def spread_rows(found: Sequence[Cell], figure: TableFigure) -> list[list[str]]:
    """Mean, its 95 % interval, median, least and most of one figure: headings and rows of text."""
    lines = [["", f"mean of {figure.heading}", "95 %", "median", "least", "most", "runs",
              "left out"]]  # fmt: skip
    for cell in found:
        values = list(cell.by_seed(figure).values())
        if not values:
            lines.append([cell.label, *"-----", "0", str(len(cell.results))])
            continue
        of = spread(values)
        low, high = of.interval
        mean, _, *others = rounded(of.mean, of.std, low, high, of.median, min(values), max(values))
        ends = f"{others[0]} to {others[1]}" if math.isfinite(low) else "-"
        out = len(cell.results) - len(values)
        lines.append([cell.label, mean, ends, *others[2:], str(len(values)), str(out or "")])
    return lines


Columns = dict[str, list[str] | list[int] | list[float]]


def columns(cells: Sequence[Cell]) -> Columns:
    """Every figure of every cell in SI units; nan where there is none.

    A figure has its mean, standard deviation, median, and the 95 % interval of the mean.
    """
    found: Columns = {axis: [cell.choice[axis] for cell in cells] for axis in cells[0].choice}
    found["runs"] = [len(cell.results) for cell in cells]
    found["done"] = [len(cell.done) for cell in cells]
    found["status"] = [cell.status for cell in cells]
    found["message"] = [cell.why for cell in cells]
    for name in figure_names(cells):
        spreads = [cell.spread(TableFigure((name,), name)) for cell in cells]
        found[f"{name}_mean"] = [one.mean for one in spreads]
        found[f"{name}_std"] = [one.std for one in spreads]
        found[f"{name}_median"] = [one.median for one in spreads]
        for end, place in (("low", 0), ("high", 1)):
            found[f"{name}_95_{end}"] = [one.interval[place] for one in spreads]
    return found


def csv(cells: Sequence[Cell]) -> bytes:
    """The columns as a file; all digits of a number, and nothing where there is none."""
    table = columns(cells)
    return tables.encode_csv([table, *zip(*table.values(), strict=True)])
