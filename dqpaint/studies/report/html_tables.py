"""Rows of text -> a table in HTML: numbers drawn as bars beside them, verdicts as what they are."""

import math
import re
from collections.abc import Sequence
from typing import NamedTuple

from dqpaint.studies.report.templates import render

LONGEST = 36  # letters of a cell that stays on one line
BAD = "unstable", "failed", "died", "differs", "fails"  # of a row that is not as it should be
VERDICTS = {"holds": "good", "fails": "wrong", "in part": "open", "not shown": "open",
            "no numbers": "open"}  # fmt: skip
VERDICT = re.compile(f"({'|'.join(VERDICTS)})(?:: (.*))?", re.DOTALL)
DIGITS = r"\d+(?:\.\d+)?(?:e[+-]?\d+)?"
NUMBER = re.compile(f"(-?{DIGITS})(?: ± ({DIGITS}))?")
WIDE = 20.0  # from the least to the largest: beyond, bars could not be told apart
LENGTH = 80  # of a bar [px]
LEAST = 3  # rows that can be sorted


class Value(NamedTuple):
    """A number of a table, and its spread."""

    mean: float
    std: float


class Drawing(NamedTuple):
    """A number as a bar and its spread, or as a dot on a line [px]."""

    length: float = 0.0
    spread: tuple[float, float] | None = None
    dot: float | None = None


def table(lines: Sequence[Sequence[str]], bars: Sequence[int] = ()) -> str:
    """A table in HTML.

    Args:
        lines: headings, which may all be empty, and rows.
        bars: columns whose numbers are drawn beside them: a bar from 0, or, where they are more
            than 20 times apart, a dot on a logarithmic line from the least to the largest.
    """
    head, *rows = lines
    named = any(head)
    return render(
        "table.html",
        head=head if named else (), rows=rows,
        drawn={column: _drawn([value_of(row[column]) for row in rows]) for column in bars},
        kind="settings" if not named else "sorted" if len(rows) >= LEAST else "",
        kind_of=_kind_of, verdict=VERDICT.fullmatch, verdicts=VERDICTS, longest=LONGEST,
        width=LENGTH,
    )  # fmt: skip


def value_of(text: str) -> Value | None:
    """The number that a cell holds, and its spread; None if it holds something else."""
    found = NUMBER.fullmatch(text)
    return None if found is None else Value(float(found[1]), float(found[2] or 0.0))


def _kind_of(row: Sequence[str]) -> str:
    if row[0] == "best":
        return "best"
    if any(VERDICT.fullmatch(word) for word in row):
        return ""
    words = row[-1].replace(",", " ").replace(":", " ").split()
    return "bad" if any(word in BAD for word in words) else ""


def _drawn(values: Sequence[Value | None]) -> list[Drawing | None]:
    """A small drawing a number, all to one scale; nothing where there is no number."""
    known = [value.mean for value in values if value is not None]
    if len(known) < 2 or min(known) < 0 or max(known) == 0:
        return [None] * len(values)
    least, most = min(known), max(known)
    reach = max(value.mean + value.std for value in values if value is not None)
    apart = least > 0 and most > WIDE * least
    return [
        None if value is None
        else _dot(value.mean, least, most) if apart
        else _bar(value, reach)
        for value in values
    ]  # fmt: skip


def _bar(value: Value, reach: float) -> Drawing:
    ends = [LENGTH * (value.mean + sign * value.std) / reach for sign in (-1, 1)]
    spread = (max(0.0, ends[0]), ends[1]) if value.std else None
    return Drawing(LENGTH * value.mean / reach, spread)


def _dot(value: float, least: float, most: float) -> Drawing:
    return Drawing(dot=4 + (LENGTH - 8) * math.log(value / least) / math.log(most / least))
