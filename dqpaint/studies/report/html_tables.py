"""Rows of text -> a table in HTML, with bars beside numbers and marked verdicts."""

import math
import re
from collections.abc import Sequence
from typing import NamedTuple

from dqpaint.studies.report.templates import render

LONGEST = 36  # letters of a cell that stays on one line
# Of a row that is not as it should be.
BAD = "oscillates", "clipped", "astray", "diverged", "failed", "died", "differs", "fails"
VERDICTS = {"holds": "good", "fails": "wrong", "in part": "open", "not shown": "open",
            "no numbers": "open"}  # fmt: skip
VERDICT = re.compile(f"({'|'.join(VERDICTS)})(?:: (.*))?", re.DOTALL)
DIGITS = r"\d+(?:\.\d+)?(?:e[+-]?\d+)?"
NUMBER = re.compile(f"(-?{DIGITS})(?: ± ({DIGITS}))?")
WIDE = 20.0  # from the least to the largest: beyond, bars could not be told apart
LENGTH = 80  # of a bar [px]
LEAST = 3  # rows that can be sorted
Value = tuple[float, float]
"""A number of a table and its standard deviation."""


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
    """The number that a cell holds and its standard deviation; None if it is something else."""
    found = NUMBER.fullmatch(text)
    return None if found is None else (float(found[1]), float(found[2] or 0.0))


def _kind_of(row: Sequence[str]) -> str:
    if row[0] == "best":
        return "best"
    if any(VERDICT.fullmatch(word) for word in row):
        return ""
    words = row[-1].replace(",", " ").replace(":", " ").split()
    return "bad" if any(word in BAD for word in words) else ""


def _drawn(values: Sequence[Value | None]) -> list[Drawing | None]:
    """A small drawing a number, all to one scale; None where there is no number."""
    known = [value for value in values if value is not None]
    least, most = (end((mean for mean, _ in known), default=0.0) for end in (min, max))
    if len(known) < 2 or least < 0 or most == 0:
        return [None] * len(values)
    if least > 0 and most > WIDE * least:
        scale = (LENGTH - 8) / math.log(most / least)
        return [value and Drawing(dot=4 + scale * math.log(value[0] / least)) for value in values]
    scale = LENGTH / max(mean + std for mean, std in known)
    return [
        value and Drawing(scale * value[0], _ends(*value, scale) if value[1] else None)
        for value in values
    ]


def _ends(mean: float, std: float, scale: float) -> tuple[float, float]:
    return max(0.0, scale * (mean - std)), scale * (mean + std)
