"""Gains that were tried -> the best ones, the trade-off of error and effort, tables and charts."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dqpaint.core import tables
from dqpaint.dq import Floats
from dqpaint.settings import Settings
from dqpaint.studies.experiment import cells
from dqpaint.studies.experiment.axes import axis_label
from dqpaint.studies.experiment.cells import Cell, TableFigure
from dqpaint.studies.experiment.gain_range import Range
from dqpaint.studies.kinds.study_result import ANY_WIDTH, StudyResult
from dqpaint.studies.report.charts import COLOURS, Line, Panel, wide
from dqpaint.studies.report.page import Block, Charts, Rows, Words, files_of

MOST_ROWS = 12  # of the trade-off in a table; the CSV has all
TRIED = "#9aa5b1"
FRONT, USUAL, BEST = COLOURS[:3]


@dataclass(frozen=True, kw_only=True)
class Tuning(StudyResult):
    """A finished search for gains; its cells are what was tried, in order, one a choice of gains.

    Attributes:
        ranges: where the gains were sought.
        usual: the law's own gains, if they lie within the ranges.
        error: the figure that was to be small.
        effort: the figure that was bounded.
        needed: effort that the drawing itself needs.
        factor: how many times that was allowed.
        settled: whether the search came to its end; else the budget was spent.
    """

    settings: Settings
    ranges: tuple[Range, ...]
    usual: Cell | None
    error: TableFigure
    effort: TableFigure
    needed: float
    factor: float
    settled: bool

    @property
    def bound(self) -> float:
        """The most effort, in the figure's unit."""
        return self.factor * self.needed

    @property
    def best(self) -> Cell | None:
        """The least error within the bound; None if nothing keeps it."""
        within = [c for c in self.cells if c.stable and c.spread(self.effort).mean <= self.bound]
        return min(within, key=lambda cell: cell.spread(self.error).mean, default=None)

    @property
    def front(self) -> list[Cell]:
        """The trade-off: cells than which none has both less error and less effort."""
        good = [cell for cell in self.cells if cell.stable]
        front: list[Cell] = []
        for cell in sorted(
            good, key=lambda c: (c.spread(self.effort).mean, c.spread(self.error).mean)
        ):
            if not front or cell.spread(self.error).mean < front[-1].spread(self.error).mean:
                front.append(cell)
        return front

    @property
    def stem(self) -> str:
        """The first part of the files' names."""
        return f"{super().stem}-{'-'.join(one.name for one in self.ranges)}-tuned"

    @property
    def passed(self) -> bool:
        """Whether any gains keep the bound."""
        return self.best is not None

    @property
    def title(self) -> str:
        """The heading of its pages."""
        return f"{self.name}, tuned"

    def table_text(self, width: int = ANY_WIDTH) -> str:
        """The outcome for a terminal."""
        if all(cell.status in ("failed", "died") for cell in self.cells):
            raise cells.every_run_failed(self.cells)
        return "\n".join([*tables.fit(rows(self), width), *self.hidden, "", answer(self)])

    @property
    def hidden(self) -> list[str]:
        """How many were tried in vain, and what the means of those that are shown do not show."""
        out = Counter(
            one.status for cell in self.cells for one in cell.results if one.status != "done"
        )
        lines = cells.what_means_hide([cell for cell in (self.usual, self.best) if cell])
        if out:
            kinds = ", ".join(f"{count} {status}" for status, count in out.items())
            lines.insert(0, f"Runs without a result, left out of the search: {kinds}.")
        return lines

    def files_and_blocks(self) -> tuple[dict[str, bytes], list[Block]]:
        """The chart, the trade-off and all that was tried, and the same for a page."""
        table, words = rows(self), answer(self)
        shown = Charts("What less error costs in effort", panels(self))
        made = {
            **files_of({"": shown}, self.formats),
            "-tradeoff.csv": cells.csv(self.front or self.cells[:1]),
            "-table.csv": cells.csv(self.cells),
            "-table.md": tables.page(self.title, tables.markdown(table), *self.hidden_block, words),
        }
        heading = "The best, the usual, and the trade-off"
        return made, [Words("\n".join([words, *self.hidden])), shown, Rows(heading, table)]


def answer(tuned: Tuning) -> str:
    """The outcome in a few sentences."""
    sentences = [
        f"{tuned.effort.heading}: the drawing itself needs {tuned.needed:.4g}; "
        f"{tuned.factor:g} times that, {tuned.bound:.4g}, was allowed."
    ]
    best = tuned.best
    if best is None:
        known = [cell.spread(tuned.effort).mean for cell in tuned.cells if cell.stable]
        least = f"the least was {min(known):.4g}" if known else "none has a result"
        sentences.append(f"No gains that were tried keep to it: {least}.")
    else:
        gains = " ".join(f"--gain {name}={value}" for name, value in best.choice.items())
        sentences.append(f"Best: {gains}")
        sentences += _edges(tuned, best)
    if not tuned.settled:
        sentences.append(
            "The budget was spent before the search settled; the same with a larger --budget "
            "goes on from there."
        )
    return "\n".join(sentences)


def _edges(tuned: Tuning, best: Cell) -> list[str]:
    """A best value at an end of its range may not be the best there is."""
    found = []
    for one in tuned.ranges:
        part = one.part(float(best.choice[one.name]))
        if min(part, 1 - part) < 0.01:
            end = one.low if part < 0.5 else one.high
            found.append(f"{one.name} lies at the end of its range, {end:g}: try a wider one.")
    return found


def rows(tuned: Tuning) -> list[list[str]]:
    """Headings and rows: the usual gains, the best ones, and the trade-off between."""
    front = tuned.front
    picked = sorted(set(np.linspace(0, len(front) - 1, min(MOST_ROWS, len(front))).astype(int)))
    named = [("usual", tuned.usual), ("best", tuned.best)]
    named += [("trade-off", front[i]) for i in picked if front[i] is not tuned.best]
    figures = tuned.error, tuned.effort
    names = [one.name for one in tuned.ranges]
    heads = ["", *names, *(f.heading for f in figures), "of what is needed", "status"]
    lines = [heads]
    for what, cell in named:
        if cell is None:
            continue
        values = [cells.spread_text(cell.spread(figure)) for figure in figures]
        effort = cell.spread(tuned.effort).mean
        share = f"{effort / tuned.needed:.4g}" if np.isfinite(effort) else "-"
        status = cell.status + (", beyond the bound" if effort > tuned.bound else "")
        lines.append([what, *(cell.choice[n] for n in names), *values, share, status])
    return lines


def panels(tuned: Tuning) -> list[Panel]:
    """Error over effort, and error over each gain."""
    shown = np.isfinite(cells.means_of(tuned.cells, tuned.error)).tolist()
    tried = [cell for cell, known in zip(tuned.cells, shown, strict=True) if known]
    stable = [cell for cell in tried if cell.stable]  # of the others effort says nothing
    error = tuned.error.heading
    effort, least = (cells.means_of(tuned.front, x) for x in (tuned.effort, tuned.error))
    made = [
        Panel(
            "the trade-off", tuned.effort.heading, error,
            [
                _dots(tuned, stable, "tried", tuned.effort, TRIED),
                Line(effort, least, "least error for an effort", FRONT),
                *_named(tuned, tuned.effort),
            ],
            wall=tuned.bound, limit="most allowed", log_x=wide(_values(stable, tuned.effort)),
            log_y=wide(_values(stable, tuned.error)),
        )
    ]  # fmt: skip
    for one in tuned.ranges:
        made.append(
            Panel(
                f"over {one.name}", axis_label(one.name, tuned.settings), error,
                [_dots(tuned, tried, "tried", one.name, TRIED), *_named(tuned, one.name)],
                log_x=one.log, log_y=wide(_values(tried, tuned.error)),
            )
        )  # fmt: skip
    return made


def _values(found: Sequence[Cell], of: TableFigure | str) -> Floats:
    if isinstance(of, str):
        return np.array([float(cell.choice[of]) for cell in found])
    return cells.means_of(found, of)


def _dots(
    tuned: Tuning, found: Sequence[Cell], name: str, x: TableFigure | str, colour: str
) -> Line:
    marks = np.array([not cell.stable for cell in found], dtype=bool)
    return Line(_values(found, x), _values(found, tuned.error), name, colour, marks, width=0.0)


def _named(tuned: Tuning, x: TableFigure | str) -> list[Line]:
    """The usual gains and the best ones."""
    return [
        _dots(tuned, [cell], name, x, colour)
        for name, cell, colour in (("usual", tuned.usual, USUAL), ("best", tuned.best, BEST))
        if cell is not None and cell.stable
    ]
