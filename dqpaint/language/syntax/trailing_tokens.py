"""Tokens after the last part of a line -> diagnostic with advice on the likely intent."""

import re
from collections.abc import Callable, Iterator

from dqpaint.diagnostics import Fix, Problem, Span, problem
from dqpaint.language.syntax.cursor import Cursor, found
from dqpaint.language.syntax.lexer import NUMBER
from dqpaint.language.vocabulary.units import ANGLE, SAME_UNITS, UNITS
from dqpaint.language.vocabulary.words import STATEMENTS
from dqpaint.program import colours

Advice = tuple[str, Fix | None]

_COORDINATE = rf"(-?{NUMBER})[ \t]*(mm|cm|m)?"
_FIRST_COORDINATE = re.compile(rf"(?<![\w.)-]){_COORDINATE}[ \t]*$", re.ASCII)
_FURTHER = re.compile(rf"[ \t]*,[ \t]*{_COORDINATE}(?![\w.*/^])", re.ASCII)


def advice_for(word: str, cursor: Cursor) -> Problem | None:
    """E112 with advice for the tokens left on a line of this word; None without advice."""
    for advise in _ADVISERS:
        for help, fix in advise(word, cursor):
            message = f"expected the end of the line but found {found(cursor.token)}"
            return problem("E112", message, cursor.token.span, "", help, fix)
    return None


def _repeat(word: str, cursor: Cursor) -> Iterator[Advice]:
    if word == "repeat" and cursor.is_sign("=") and cursor.before.kind == "name":
        yield f"write: repeat {cursor.before.text} from 1 to 5", None


def _let(word: str, cursor: Cursor) -> Iterator[Advice]:
    if word == "let" and cursor.is_sign(","):
        yield "each value has a 'let' and a line of its own", None


def _strobe(_word: str, cursor: Cursor) -> Iterator[Advice]:
    if cursor.is_sign("%") and cursor.before_is(2, "strobe"):
        yield "the frequency comes first: strobe 10 Hz 30%", None


def _colour(_word: str, cursor: Cursor) -> Iterator[Advice]:
    before, token = cursor.before, cursor.token
    if token.kind != "name":
        return
    both = (before.text + token.text).lower()
    if before.kind == "name" and both in colours.NAMES:
        fix = Fix(f"write {both}", Span(before.start, token.end), both)
        yield f"did you mean '{both}'?", fix
    elif before.kind == "number" and token.text in colours.NAMES:
        share = float(before.text) * (100.0 if float(before.text) <= 1.0 else 1.0)
        yield f"the brightness follows the colour: light {token.text} {share:g}%", None


def _text(word: str, cursor: Cursor) -> Iterator[Advice]:
    if word == "text" and cursor.before.kind == "text" and cursor.token.kind == "number":
        yield "say what the number is: height 20 mm", None


def _point(word: str, cursor: Cursor) -> Iterator[Advice]:
    moves = word in STATEMENTS and (STATEMENTS[word].moves or word in ("start", "place"))
    if moves and cursor.before.kind == "number" and cursor.token.kind == "number":
        yield "a point stands in brackets, with commas: (50, 0, 30) mm", None


def _bare_point(word: str, cursor: Cursor) -> Iterator[Advice]:
    """`line to 100, 0`: a point without its brackets."""
    if word not in STATEMENTS or not STATEMENTS[word].moves or not cursor.is_sign(","):
        return
    text, end = cursor.text, cursor.token.start
    first = _FIRST_COORDINATE.search(text, cursor.first.end, end)
    given = [first] if first else []
    while given and (further := _FURTHER.match(text, end)):
        given.append(further)
        end = further.end()
    units = {coordinate[2] for coordinate in given if coordinate[2]}
    if first and len(given) in (2, 3) and len(units) <= 1:
        written = f"({', '.join(one[1] for one in given)}) {''.join(units) or 'mm'}"
        fix = Fix(f"write {written}", Span(first.start(), end), written)
        yield f"a point stands in brackets: {written}", fix


def _rate(_word: str, cursor: Cursor) -> Iterator[Advice]:
    """`10 cm per second`."""
    before, unit = cursor.before, cursor.peek().text
    if cursor.is_word("per") and before.text in UNITS:
        unit = SAME_UNITS.get(unit, unit if unit in UNITS else "s")
        fix = Fix(f"write /{unit}", Span(before.end, cursor.peek().end), f"/{unit}")
        number = cursor.text[: before.start].split()[-1]
        yield f"a rate is written with a slash: {number} {before.text}/{unit}", fix


def _angle(word: str, cursor: Cursor) -> Iterator[Advice]:
    """`arc centre (0, 0) 360 deg`, `screw about (0, 0) along z 360 deg`."""
    if word in ("arc", "screw") and cursor.token.kind == "number":
        unit = cursor.peek().text
        if unit in UNITS and UNITS[unit][1] == ANGLE:
            at = cursor.token.start
            fix = Fix("write angle", Span(at, at), "angle ")
            yield f"write: angle {cursor.token.text} {unit}", fix


def _until(word: str, cursor: Cursor) -> Iterator[Advice]:
    """`hold until 3 s`."""
    if word == "hold" and cursor.before.text == "until" and cursor.token.kind == "number":
        fix = Fix("take it away", Span(cursor.before.start, cursor.token.start), "")
        yield f"it says how long: hold {cursor.token.text} {cursor.peek().text}", fix


def _product(word: str, cursor: Cursor) -> Iterator[Advice]:
    before, token = cursor.before, cursor.token
    if word == "repeat" or token.text in STATEMENTS:
        return
    if before.kind == "number" and token.kind == "name":
        written = f"{before.text}*{token.text}"
        fix = Fix(f"write {written}", Span(before.start, token.end), written)
        yield f"a product is written {written}", fix


_ADVISERS: tuple[Callable[[str, Cursor], Iterator[Advice]], ...] = (
    *(_repeat, _let, _strobe, _colour, _text, _point, _bare_point, _rate, _angle, _until, _product),
)
