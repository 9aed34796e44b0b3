"""Lines of a text -> what the editor shows over them: colours, underlines, marked lines."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple

from dqpaint.diagnostics import Span
from dqpaint.editors import vocabulary
from dqpaint.language.syntax import TOKEN
from dqpaint.language.vocabulary import UNITS
from dqpaint.studio.work.messages import Finding

Mark = dict[str, Any]


class Number(NamedTuple):
    """A number with its unit in a text."""

    span: Span  # of the number alone
    value: float
    unit: str
    name: str = ""  # where it is the value of a `let`


@cache
def _kinds() -> Mapping[str, str]:
    """The kind of each word; that of a statement last, as it is one at a line's begin alone."""
    found: dict[str, str] = {}
    for entry in vocabulary.vocabulary():
        found.setdefault(entry.word, "part" if entry.kind == "renamed" else entry.kind)
    return found


def marks(text: str, first: int, last: int) -> Iterator[Mark]:
    """The coloured stretches of some lines.

    Args:
        text: of the drawing.
        first: line, from 1.
        last: line, included.
    """
    lines = text.split("\n")
    offset = sum(len(line) + 1 for line in lines[: first - 1])
    for line in lines[first - 1 : last]:
        at_begin = True
        for kind, start, end in _tokens(line):
            word = line[start:end]
            shown = kind
            if kind == "name":
                known = _kinds().get(word)
                shown = known or "own"
                if known == "statement" and not at_begin:
                    shown = "part"
            at_begin = False
            if shown != "sign" and end > start:
                yield mark(offset + start, offset + end, f"t-{shown}")
        offset += len(line) + 1


def _tokens(line: str) -> Iterator[tuple[str, int, int]]:
    position = 0
    while position < len(line):
        match = TOKEN.match(line, position)
        if match is None or match.lastgroup is None:
            return
        kind = "number" if match.lastgroup == "glued" else match.lastgroup
        start, end = match.span(kind)
        yield kind, start, end
        if match.lastgroup == "glued":
            unit, until = match.span("glued")
            yield "name", unit, until
        position = match.end()


def mark(start: int, end: int, name: str, title: str = "") -> Mark:
    """A stretch of text with a class, and a title where the mouse rests on it."""
    found: Mark = {"kind": "mark", "from": start, "to": end, "class": name}
    return {**found, "attributes": {"title": title}} if title else found


def line_mark(line: int, name: str) -> Mark:
    """A whole line with a class."""
    return {"kind": "line", "line": line, "class": name}


def underlines(findings: Sequence[Finding], text: str) -> Iterator[Mark]:
    """The stretches that diagnostics are about."""
    for finding in findings:
        if not finding.here:
            continue
        start, end = min(finding.start, len(text)), min(finding.end, len(text))
        if end <= start:  # at the end of a line: the character before it
            start, end = max(0, start - 1), start
        name = "f-error" if finding.is_error else "f-warning"
        if end > start:
            yield mark(start, end, name, f"{finding.code}: {finding.message}")


def numbers(text: str, lines: Iterable[int] | None = None) -> Iterator[Number]:
    """The numbers of a text, of all lines or of some."""
    chosen = None if lines is None else set(lines)
    offset = 0
    for index, line in enumerate(text.split("\n"), 1):
        if chosen is None or index in chosen:
            yield from _numbers(line, offset)
        offset += len(line) + 1


def _numbers(line: str, offset: int) -> Iterator[Number]:
    tokens = [(kind, line[start:end], start, end) for kind, start, end in _tokens(line)]
    for i, (kind, word, start, end) in enumerate(tokens):
        if kind != "number":
            continue
        following = tokens[i + 1][1] if i + 1 < len(tokens) else ""
        unit = following if following in UNITS or following == "%" else ""
        named = [one[1] for one in tokens[:3]]
        name = named[1] if i == 3 and named[0] == "let" and named[2] == "=" else ""
        try:
            value = float(word)
        except ValueError:
            continue
        yield Number(Span(offset + start, offset + end), value, unit, name)


def number_at(text: str, offset: int) -> Number | None:
    """The number at an offset."""
    line = text.count("\n", 0, offset) + 1
    found = numbers(text, [line])
    return next((one for one in found if one.span.start <= offset <= one.span.end), None)


def spelled(value: float, like: str) -> str:
    """A number as the text had it: as many decimals, at least."""
    decimals = len(like.partition(".")[2]) if "e" not in like.lower() else 3
    text = f"{value:.{min(decimals, 9)}f}"
    return "0" if float(text) == 0 and decimals == 0 else text


def step_of(like: str) -> float:
    """By how much a number changes for a pixel: its last digit, or a hundredth of it."""
    decimals = len(like.partition(".")[2])
    digits = len(like.replace(".", ""))
    return float(10.0 ** (max(0, digits - 3) - decimals))
