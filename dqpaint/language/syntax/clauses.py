"""Tokens after `tool`, `light`, `strobe`, `blend`, `corner`, `wall`, `keep`, `face` -> clauses."""

import re
from collections.abc import Callable

from dqpaint.diagnostics import Fix, Problem, Span, problem
from dqpaint.language.syntax import brush_clause
from dqpaint.language.syntax.cursor import Cursor, example_of, found, no_value, percent
from dqpaint.language.syntax.expressions import expression
from dqpaint.language.syntax.import_clauses import one_of
from dqpaint.language.syntax.tree import (
    BlendWords,
    ColourWords,
    CornerWords,
    Expression,
    LightWords,
    Quoted,
    StrobeWords,
    ToolWords,
    Word,
    Words,
)
from dqpaint.language.vocabulary.words import PARTS

# A colour that has become a comment for want of quotes.
_COMMENTED_COLOUR = re.compile(r"[^\S\n]*(#[0-9a-fA-F]{3,8})\b")


def _value(cursor: Cursor, after: str) -> Expression:
    if cursor.at_end or cursor.is_sign("="):
        part = PARTS.get("tool" if after.startswith("look") else after)
        raise no_value(cursor, after, part.example if part else "")
    return expression(cursor, after)


def _along(cursor: Cursor, example: str) -> None:
    if not cursor.is_word("along"):
        span = cursor.token.span if not cursor.at_end else cursor.before.span
        message = f"expected 'along' but found {found(cursor.token)}"
        raise problem("E116", message, span, "", f"write: {example}")
    cursor.take()


def _tool(cursor: Cursor) -> ToolWords:
    start = cursor.token.start
    values: tuple[Expression, ...] = ()
    if cursor.is_word("keep") or cursor.is_word("follow"):
        mode = cursor.take().text
    elif cursor.is_word("look"):
        cursor.take()
        if cursor.is_word("line"):
            cursor.take()
            mode = "look line"
            point = _value(cursor, "look line")
            _along(cursor, "tool look line POINT along DIRECTION")
            values = (point, _value(cursor, "along"))
        else:
            mode = "look"
            values = (_value(cursor, "look"),)
            if cursor.is_word("up"):
                cursor.take()
                values = (*values, _value(cursor, "up"))
    else:
        mode = "turn"
        values = (_value(cursor, "tool"),)
    return ToolWords(mode, values, cursor.span_from(start))


def _light(cursor: Cursor) -> LightWords:
    start = cursor.token.start
    first, rest, way = _shade(cursor), [], ""
    while cursor.is_word("to"):
        cursor.take()
        rest.append(_shade(cursor, "light … to"))
    if cursor.is_word("hue"):
        span = cursor.take().span
        if not rest:
            message, help = "a light of one colour has no way", "for example: light red to blue hue"
            raise problem("E109", message, span, "", help)
        way = "hue"
        if cursor.is_word("long"):
            cursor.take()
            way = "hue long"
    even = cursor.is_word("even")
    if even:
        cursor.take()
    return LightWords(first, tuple(rest), cursor.span_from(start), even, way)


def _shade(cursor: Cursor, after: str = "light") -> ColourWords:
    start, word, value = cursor.token.start, "", None
    share = cursor.peek().kind == "sign" and cursor.peek().text == "%"
    if cursor.is_word("on") or cursor.is_word("off"):
        word = cursor.take().text
    elif cursor.at_end or cursor.is_word("even") or (cursor.token.kind == "number" and share):
        raise _no_colour(cursor)
    else:
        value = expression(cursor, after)
    brightness = 1.0
    if cursor.token.kind == "number":
        at = cursor.token.start
        brightness = percent(cursor, "the brightness", "light red 40%")
        if brightness > 1.0:
            span = cursor.span_from(at)
            message = "the brightness goes from 0% to 100%"
            raise problem("E217", message, span, "", "for a brighter picture expose it longer")
    return ColourWords(word, value, brightness, cursor.span_from(start))


def _no_colour(cursor: Cursor) -> Problem:
    """E108: a comment swallowed `#ff8800`, or a brightness has no colour."""
    help = 'for example: light red, light hsv(30 deg), light "#ff8800", light off'
    span, fix = cursor.before.span, None
    if cursor.is_word("even"):
        span, help = cursor.token.span, "the colour comes before it: light white even"
        fix = Fix("write white even", span, "white even")
    elif cursor.token.kind == "number":
        help = f"the brightness follows the colour: light white {cursor.token.text}%"
        span = cursor.token.span
    elif comment := _COMMENTED_COLOUR.match(cursor.text, span.end):
        help = f'a # starts a comment; put the colour in quotes: light "{comment[1]}"'
        fix = Fix("put the colour in quotes", Span(*comment.span(1)), f'"{comment[1]}"')
    return problem("E108", "'light' needs a colour", span, "", help, fix)


def _strobe(cursor: Cursor) -> StrobeWords:
    start = cursor.token.start
    if cursor.is_word("off"):
        return StrobeWords(None, 1.0, cursor.take().span)
    frequency, duty = _value(cursor, "strobe"), 0.5
    if cursor.token.kind == "number":
        at = cursor.token.start
        duty = percent(cursor, "the part of the time", PARTS["strobe"].example)
        if not 0.0 < duty <= 1.0:
            message = "a strobe shines for more than 0% and at most 100% of the time"
            help = "to turn the light off, write: light off"
            if duty > 0.0:
                help = f"for a steady light write: strobe off; else {PARTS['strobe'].example}"
            raise problem("E217", message, cursor.span_from(at), "", help)
    return StrobeWords(frequency, duty, cursor.span_from(start))


def _blend(cursor: Cursor) -> BlendWords:
    start = cursor.token.start
    if cursor.is_word("off"):
        return BlendWords(None, cursor.take().span)
    return BlendWords(_value(cursor, "blend"), cursor.span_from(start))


def _corner(cursor: Cursor) -> CornerWords:
    start = cursor.token.start
    if cursor.is_word("jump"):
        return CornerWords(None, cursor.take().span)
    return CornerWords(_value(cursor, "corner"), cursor.span_from(start))


# Between `wall`, `keep` or `face` and the parts.

Head = tuple[Word | None, tuple[Expression, ...]]
OBSTACLES = ("sphere", "box", "capsule", "cylinder", "mesh")


def wall(cursor: Cursor) -> Head:
    """`below z = -50 mm`."""
    start = cursor.token.start
    side = _one(cursor, ("below", "above"), "wall")
    axis = _one(cursor, ("x", "y", "z"), "wall")
    name = Word(f"{side} {axis}", cursor.span_from(start))
    if not cursor.is_sign("="):
        raise _expected(cursor, "'='", "wall")
    cursor.take()
    return name, (expression(cursor, "="),)


def keep(cursor: Cursor) -> Head:
    """`inside box P`, `away from sphere`, `links apart D` and so on."""
    start = cursor.token.start
    way = _one(cursor, ("inside", "away", "links"), "keep")
    if way == "links":
        _one(cursor, ("apart",), "keep links")
        return Word("apart", cursor.span_from(start)), (expression(cursor, "apart"),)
    if way == "away":
        _one(cursor, ("from",), "keep away")
    kind = _one(cursor, OBSTACLES if way == "away" else ("box",), f"keep {way}")
    name = Word("inside box" if way == "inside" else kind, cursor.span_from(start))
    if kind == "mesh":
        if cursor.token.kind != "text":
            raise _expected(cursor, "a file in quotes", "keep away from mesh")
        token = cursor.take()
        return name, (Quoted(token.text, token.span),)
    return name, (expression(cursor, kind),) if kind in ("box", "capsule") else ()


def face(cursor: Cursor) -> Head:
    """`viewer`, or a direction."""
    if cursor.is_word("viewer"):
        token = cursor.take()
        return Word(token.text, token.span), ()
    return None, (expression(cursor, "face"),)


def _one(cursor: Cursor, words: tuple[str, ...], after: str) -> str:
    if cursor.token.text not in words:
        raise _expected(cursor, " or ".join(words), after)
    return cursor.take().text


def _expected(cursor: Cursor, what: str, after: str) -> Problem:
    span = cursor.token.span if not cursor.at_end else cursor.before.span
    message = f"expected {what} after '{after}' but found {found(cursor.token)}"
    return problem("E109", message, span, "", f"for example: {example_of(after.split()[0])}")


READERS: dict[str, Callable[[Cursor], Expression | Words]] = {
    "holder": one_of(("tool", "beam"), "for", {}),
    "tool": _tool,
    "light": _light,
    "brush": brush_clause.brush,
    "strobe": _strobe,
    "blend": _blend,
    "corner": _corner,
}
