"""Repeated runs of one choice -> one row of a table: mean and spread of every figure."""

import io
import math
import re
from collections.abc import Sequence
from csv import writer
from dataclasses import dataclass
from typing import NamedTuple

from dqpaint.errors import UsageError
from dqpaint.studies.experiment.statistics import Spread, spread
from dqpaint.studies.runner.run import Result


class Figure(NamedTuple):
    """A figure as tables show it: its names in a summary, a heading, and a scale to its unit."""

    names: tuple[str, ...]
    heading: str
    scale: float = 1.0


DEGREES = math.degrees(1.0)
SHOWN = (
    Figure(("error_integral",), "error integral"),
    Figure(("position_error_rms_m",), "position rms [mm]", 1e3),
    Figure(("position_error_max_m",), "position largest [mm]", 1e3),
    Figure(("orientation_error_rms_rad",), "orientation rms [deg]", DEGREES),
    Figure(("command_integral_rad", "torque_integral_Nm_s"), "command"),
    Figure(("effort_integral",), "effort [rad s]"),
    Figure(("speed_integral_m",), "way [m]"),
    Figure(("acceleration_integral",), "acceleration integral [m/s]"),
)
ERRORS = SHOWN[:4]
UNITS = {"command_integral_rad": "rad", "torque_integral_Nm_s": "Nm s"}  # of what a law commands
MEANING = """The first four are errors, of which less is better; the others are what it costs.
error integral: of the invariant error, the norm of 1 - x* x_d, over time
position, orientation: how far, and by which angle, the light is from what is asked at the time
command: the norm of what the joints are told, over time
effort: how far the joints move in a step, over time
way: how far the light goes
acceleration integral: of the light, over time"""
KNOWN = (
    "error_integral", "command_integral_rad", "torque_integral_Nm_s", "effort_integral",
    "speed_integral_m", "acceleration_integral", "position_error_rms_m", "position_error_std_m",
    "position_error_max_m", "orientation_error_rms_rad", "orientation_error_std_rad",
    "orientation_error_max_rad",
)  # fmt: skip
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

    def of(self, figure: Figure) -> Spread:
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
    if name not in KNOWN:
        raise UsageError(f"no figure named '{name}'; known: {', '.join(KNOWN)}")


def find_figure(name: str, cells: Sequence[Cell]) -> Figure:
    """A figure by its name in a summary.

    Raises:
        UsageError: no run has one of that name.
    """
    for figure in SHOWN:
        if name in figure.names:
            return fitted(figure, cells)
    known = names_of(cells)
    if known and name not in known:
        raise UsageError(f"no figure named '{name}'; known: {', '.join(known)}")
    return Figure((name,), name)


def fitted(figure: Figure, cells: Sequence[Cell]) -> Figure:
    """The figure with the unit it has in these cells: laws differ in what they command."""
    if not set(figure.names) & set(UNITS):
        return figure
    there = names_of(cells)
    units = ", ".join(unit for name, unit in UNITS.items() if name in there)
    return figure._replace(heading=f"{figure.heading} [{units}]") if units else figure


def names_of(cells: Sequence[Cell]) -> list[str]:
    """The names of every figure that some run has, in the order of its summary."""
    results = (result for cell in cells for result in cell.results)
    return list(dict.fromkeys(name for result in results for name in result.figures))


def rows(cells: Sequence[Cell], figures: Sequence[Figure] = SHOWN) -> list[list[str]]:
    """Headings and rows of text; what was not done says so."""
    axes = list(cells[0].choice)
    figures = [fitted(figure, cells) for figure in figures]
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
        spreads = [cell.of(Figure((name,), name)) for cell in cells]
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
