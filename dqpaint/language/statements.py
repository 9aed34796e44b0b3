"""One line of tokens -> one statement, as the tables of `words` say it is made."""

import re

from dqpaint.language import forms
from dqpaint.language.cursor import Cursor, example_of, found, no_value
from dqpaint.language.diagnostics import Fix, Problem, Span, problem
from dqpaint.language.expressions import expression
from dqpaint.language.lexer import Token, number_value
from dqpaint.language.names import new_name
from dqpaint.language.suggestions import closest, did_you_mean, listed
from dqpaint.language.syntax import (
    Expression,
    LightWords,
    Part,
    Shade,
    Statement,
    ToolWords,
    Word,
)
from dqpaint.language.units import FOREIGN_UNITS, UNITS
from dqpaint.language.words import NOT_YET, PART_ALIASES, PARTS, SETTINGS, STATEMENTS

VERSION = 1  # of the language, for `traj 1`

# A colour that has become a comment for want of quotes.
_COMMENTED_COLOUR = re.compile(r"[^\S\n]*(#[0-9a-fA-F]{3,8})\b")

_Head = tuple[Word | None, tuple[Expression, ...]]


def statement(cursor: Cursor) -> Statement:
    """Reads a line whose first word is a statement's; raises a `Problem` at its first mistake."""
    first = cursor.take()
    known = STATEMENTS[first.text]
    name: Word | None = None
    values: tuple[Expression, ...] = ()
    if first.text in SETTINGS:  # a setting's line is the clause alone
        parts = [_part(cursor, first.text, first.span)]
    else:
        name, values = _head(cursor, first.text, known.head)
        parts = _parts(cursor, first.text)
    if not cursor.at_end:
        raise _left_over(cursor, first.text)
    whole = Statement(first.text, cursor.span_from(first.start), name, values, tuple(parts))
    forms.check(whole, cursor.text)
    return whole


# What stands between the first word and the parts.


def _head(cursor: Cursor, word: str, head: str) -> _Head:
    match head:
        case "":
            return None, ()
        case "value":
            return None, (_expression(cursor, word),)
        case "let":
            return _let(cursor)
        case "formula":
            return _formula(cursor)
        case "repeat":
            return _repeat(cursor)
        case "robot":
            return _robot(cursor), ()
        case "place":
            return (_word(cursor) if cursor.is_word("auto") else None), ()
        case "brush":
            return _brush(cursor), ()
        case _:
            assert head == "version", head
            _version(cursor)
            return None, ()


def _expression(cursor: Cursor, after: str) -> Expression:
    if cursor.at_end or cursor.is_sign("="):
        part = PARTS.get(after)
        raise no_value(cursor, after, part.example if part else example_of(after))
    return expression(cursor, after)


def _let(cursor: Cursor) -> _Head:
    name = new_name(cursor, "let", example_of("let"))
    if cursor.is_sign("("):
        raise problem(
            "E122",
            "functions of your own are not in this version of dqpaint yet",
            cursor.token.span,
        )
    if not cursor.is_sign("="):
        message = f"expected '=' but found {found(cursor.token)}"
        raise problem("E109", message, cursor.token.span, "", f"write: let {name.text} = …")
    cursor.take()
    return name, (_expression(cursor, "="),)


def _formula(cursor: Cursor) -> _Head:
    formula = _expression(cursor, "curve")
    example = "curve … for t from 0 to 360 deg"
    _expect(cursor, "for", example)
    name = new_name(cursor, "for", example)
    _expect(cursor, "from", example)
    lower = _expression(cursor, "from")
    _expect(cursor, "to", example)
    return name, (formula, lower, _expression(cursor, "to"))


def _repeat(cursor: Cursor) -> _Head:
    after = cursor.peek()
    if cursor.token.kind != "name" or after.kind != "name" or after.text != "from":
        count = _expression(cursor, "repeat")
        if cursor.is_word("from"):
            message = "expected a name before 'from'"
            raise problem("E109", message, count.span, "", "for example: repeat i from 1 to 5")
        return None, (count,)
    name = new_name(cursor, "repeat", example_of("repeat"))
    cursor.take()
    lower = _expression(cursor, "from")
    written = cursor.text[lower.span.start : lower.span.end]
    upper = cursor.token.text if cursor.token.kind == "number" else "5"
    example = f"repeat {name.text} from {written} to {upper}"
    _expect(cursor, "to", example)
    return name, (lower, _expression(cursor, "to"))


def _expect(cursor: Cursor, word: str, example: str) -> None:
    if not cursor.is_word(word):
        span = cursor.token.span if not cursor.at_end else cursor.before.span
        message = f"expected '{word}' but found {found(cursor.token)}"
        raise problem("E116", message, span, "", f"write: {example}")
    cursor.take()


def _word(cursor: Cursor) -> Word:
    token = cursor.take()
    return Word(token.text, token.span)


def _robot(cursor: Cursor) -> Word:
    token = cursor.take()
    if token.kind not in ("name", "text") or not token.text.strip():
        message = f"expected the name of a robot but found {found(token)}"
        raise problem("E109", message, token.span, "", "for example: robot iiwa")
    if token.kind == "name" and not cursor.at_end:
        message = f"expected the end of the line but found {found(cursor.token)}"
        cure = 'a name with other signs than letters, digits and _ stands in quotes: robot "…"'
        raise problem("E112", message, cursor.token.span, "", cure)
    return Word(token.text, token.span)


def _brush(cursor: Cursor) -> Word:
    token = cursor.take()
    if token.text == "bar":
        raise problem("E122", "'brush bar' is not in this version of dqpaint yet", token.span)
    if token.kind != "name" or token.text != "point":
        message = f"expected a kind of brush but found {found(token)}"
        raise problem("E109", message, token.span, "", "write: brush point")
    return Word(token.text, token.span)


def _version(cursor: Cursor) -> None:
    token = cursor.take()
    if token.kind != "number":
        message = f"expected a number after 'traj' but found {found(token)}"
        raise problem("E109", message, token.span, "", f"write: traj {VERSION}")
    if number_value(token.text) != VERSION:
        message = f"this file is written in traj {token.text}, which this dqpaint does not know"
        raise problem("E118", message, token.span, "", f"it knows: traj {VERSION}")


# Parts.


def _parts(cursor: Cursor, word: str) -> list[Part]:
    known = STATEMENTS[word]
    parts: list[Part] = []
    while cursor.token.kind == "name":
        token = cursor.token
        if token.text not in known.parts:
            if not known.parts:
                break
            raise _unknown_part(cursor, word)
        cursor.take()
        parts.append(_part(cursor, token.text, token.span))
    return parts


def _part(cursor: Cursor, word: str, span: Span) -> Part:
    takes = PARTS[word].takes
    if takes == "tool":
        return Part(word, span, _tool(cursor))
    if takes == "light":
        return Part(word, span, _light(cursor))
    return Part(word, span, _expression(cursor, word))


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
            point = _expression(cursor, "look line")
            _expect(cursor, "along", "tool look line POINT along DIRECTION")
            values = (point, _expression(cursor, "along"))
        else:
            mode = "look"
            values = (_expression(cursor, "look"),)
            if cursor.is_word("up"):
                cursor.take()
                values = (*values, _expression(cursor, "up"))
    else:
        mode = "turn"
        values = (_expression(cursor, "tool"),)
    return ToolWords(mode, values, cursor.span_from(start))


def _light(cursor: Cursor) -> LightWords:
    start = cursor.token.start
    first = _shade(cursor)
    last = None
    if cursor.is_word("to"):
        cursor.take()
        last = _shade(cursor, "light … to")
    return LightWords(first, last, cursor.span_from(start))


def _shade(cursor: Cursor, after: str = "light") -> Shade:
    start, word, value = cursor.token.start, "", None
    percent = cursor.peek().kind == "sign" and cursor.peek().text == "%"
    if cursor.is_word("on") or cursor.is_word("off"):
        word = cursor.take().text
    elif cursor.at_end or (cursor.token.kind == "number" and percent):
        raise _no_colour(cursor)
    else:
        value = expression(cursor, after)
    brightness = 1.0
    if cursor.token.kind == "number":
        brightness = number_value(cursor.take().text) / 100.0
        if not cursor.is_sign("%"):
            message = f"expected '%' after the brightness but found {found(cursor.token)}"
            raise problem("E109", message, cursor.before.span, "", "for example: light red 40%")
        cursor.take()
        if brightness > 1.0:
            span = Span(start, cursor.before.end)
            message = "the brightness goes from 0% to 100%"
            raise problem("E217", message, span, "", "for a brighter picture expose it longer")
    return Shade(word, value, brightness, cursor.span_from(start))


def _no_colour(cursor: Cursor) -> Problem:
    """E108. A comment swallowed `#ff8800`, or the brightness stands without its colour."""
    cure = 'for example: light red, light hsv(30 deg), light "#ff8800", light off'
    span = cursor.before.span
    if cursor.token.kind == "number":
        cure = f"the brightness follows the colour: light white {cursor.token.text}%"
        span = cursor.token.span
    elif comment := _COMMENTED_COLOUR.match(cursor.text, span.end):
        cure = f'a # starts a comment; put the colour in quotes: light "{comment[1]}"'
    return problem("E108", "'light' needs a colour", span, "", cure)


ROUND = ("radius", "r", "diameter")  # what people give an arc besides its centre


def _unknown_part(cursor: Cursor, word: str) -> Problem:
    token, known = cursor.token, STATEMENTS[word]
    if token.text in NOT_YET:
        return problem("E122", f"'{token.text}' is not in this version of dqpaint yet", token.span)
    after_number = cursor.before.kind == "number" or cursor.before.text == ")"
    if token.text in FOREIGN_UNITS and after_number:
        return _foreign_unit(token)
    special = forms.misplaced(word, token)
    if special is not None:
        return special
    if word == "arc" and token.text in ROUND:
        cure = "the radius is the distance from here to the centre: first move to the circle"
        message = f"'arc' has no part called '{token.text}'"
        return problem("E110", message, token.span, "", cure)
    meant = closest(token.text, known.parts, PART_ALIASES)
    if meant not in known.parts:
        meant = closest(token.text, known.parts)
    if not meant and after_number:
        meant = closest(token.text, UNITS)
    cure = did_you_mean(meant) or f"its parts are: {listed(known.parts)}"
    fix = Fix(f"write {meant}", token.span, meant) if meant else None
    message = f"'{word}' has no part called '{token.text}'"
    return problem("E110", message, token.span, "", cure, fix)


def _foreign_unit(token: Token) -> Problem:
    unit = FOREIGN_UNITS[token.text]
    cure = f"did you mean '{unit}'? units are {', '.join(UNITS)}"
    return problem("E102", f"'{token.text}' is not a unit of this language", token.span, "", cure)


def _left_over(cursor: Cursor, word: str) -> Problem:
    token = cursor.token
    if token.text in FOREIGN_UNITS and cursor.before.kind == "number":
        return _foreign_unit(token)
    special = forms.unexpected(word, cursor)
    if special is not None:
        return special
    if token.kind == "sign" and token.text == "=":
        cure = "only 'let' has a '='"
    elif token.kind == "sign" and token.text == ",":
        cure = "a point stands in brackets: (50, 0) mm; parts of a line need no commas"
    elif token.kind == "sign" and token.text == "%":
        cure = "only the brightness of a light is written in %"
    elif token.kind == "name" and token.text in STATEMENTS:
        cure = "one statement per line"
    else:
        cure = ""
    message = f"expected the end of the line but found {found(token)}"
    return problem("E112", message, token.span, "", cure)
