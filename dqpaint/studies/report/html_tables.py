"""Rows of text -> a table in HTML: numbers drawn as bars beside them, verdicts as what they are."""

import math
import re
from collections.abc import Sequence
from html import escape
from typing import NamedTuple

LONGEST = 36  # letters of a cell that stays on one line
LONG, TWO = ' class="long"', ' colspan="2"'
BAD = "unstable", "failed", "died", "differs", "fails"  # of a row that is not as it should be
VERDICTS = {"holds": "good", "fails": "wrong", "in part": "open", "not shown": "open",
            "no numbers": "open"}  # fmt: skip
VERDICT = re.compile(f"({'|'.join(VERDICTS)})(?:: (.*))?", re.DOTALL)
DIGITS = r"\d+(?:\.\d+)?(?:e[+-]?\d+)?"
NUMBER = re.compile(f"(-?{DIGITS})(?: ± ({DIGITS}))?")
WIDE = 20.0  # from the least to the largest: beyond, bars could not be told apart
LENGTH, HIGH = 80, 12  # of a bar [px]
LEAST = 3  # rows that can be sorted


class Value(NamedTuple):
    """A number of a table, and its spread."""

    mean: float
    std: float


def table(lines: Sequence[Sequence[str]], bars: Sequence[int] = ()) -> str:
    """A table in HTML.

    Args:
        lines: headings, which may all be empty, and rows.
        bars: columns whose numbers are drawn beside them: a bar from 0, or, where they are more
            than 20 times apart, a dot on a logarithmic line from the least to the largest.
    """
    head, *rows = lines
    drawn = {column: _drawn([value_of(row[column]) for row in rows]) for column in bars}
    kinds = ["settings"] if not any(head) else ["sorted"] if len(rows) >= LEAST else []
    made = [f'<div class="wide"><table class="{" ".join(kinds)}">']
    if any(head):
        cells = "".join(
            f"<th{TWO if i in drawn else ''}>{escape(word)}</th>" for i, word in enumerate(head)
        )
        made.append(f"<thead><tr>{cells}</tr></thead>")
    made.append("<tbody>")
    for i, row in enumerate(rows):
        cells = "".join(
            _cell(word) + (f'<td class="bar">{drawn[j][i]}</td>' if j in drawn else "")
            for j, word in enumerate(row)
        )
        made.append(f"<tr{_class(row)}>{cells}</tr>")
    return "\n".join([*made, "</tbody></table></div>\n"])


def value_of(text: str) -> Value | None:
    """The number that a cell holds, and its spread; None if it holds something else."""
    found = NUMBER.fullmatch(text)
    return None if found is None else Value(float(found[1]), float(found[2] or 0.0))


def _cell(word: str) -> str:
    if found := VERDICT.fullmatch(word):
        why = f" <span>{escape(found[2])}</span>" if found[2] else ""
        return f'<td class="verdict {VERDICTS[found[1]]}"><b>{found[1]}</b>{why}</td>'
    return f"<td{LONG if len(word) > LONGEST else ''}>{escape(word)}</td>"


def _class(row: Sequence[str]) -> str:
    if row[0] == "best":
        return ' class="best"'
    if any(VERDICT.fullmatch(word) for word in row):
        return ""
    words = row[-1].replace(",", " ").replace(":", " ").split()
    return ' class="bad"' if any(word in BAD for word in words) else ""


def _drawn(values: Sequence[Value | None]) -> list[str]:
    """A small drawing a number, all to one scale; nothing where there is no number."""
    known = [value.mean for value in values if value is not None]
    if len(known) < 2 or min(known) < 0 or max(known) == 0:
        return [""] * len(values)
    least, most = min(known), max(known)
    if least > 0 and most > WIDE * least:
        return ["" if value is None else _dot(value.mean, least, most) for value in values]
    reach = max(value.mean + value.std for value in values if value is not None)
    return ["" if value is None else _bar(value, reach) for value in values]


def _bar(value: Value, reach: float) -> str:
    length = LENGTH * value.mean / reach
    ends = [LENGTH * (value.mean + sign * value.std) / reach for sign in (-1, 1)]
    spread = f'<path d="M{max(0, ends[0]):.1f},6H{ends[1]:.1f}"/>' if value.std else ""
    return _svg(f'<rect y="2" width="{length:.1f}" height="8"/>{spread}')


def _dot(value: float, least: float, most: float) -> str:
    at = 4 + (LENGTH - 8) * math.log(value / least) / math.log(most / least)
    return _svg(f'<path d="M4,6H{LENGTH - 4}"/><circle cx="{at:.1f}" cy="6" r="4"/>')


def _svg(inside: str) -> str:
    return (
        f'<svg width="{LENGTH}" height="{HIGH}" viewBox="0 0 {LENGTH} {HIGH}" aria-hidden="true">'
        f"{inside}</svg>"
    )
