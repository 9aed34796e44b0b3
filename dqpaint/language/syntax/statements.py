"""Tokens of one line -> statement, by the tables of `vocabulary.words`."""

from dqpaint.core import record
from dqpaint.diagnostics import Fix, Problem, Span, closest, did_you_mean, join_words, problem
from dqpaint.language.syntax import clauses, import_clauses, statement_rules
from dqpaint.language.syntax.cursor import Cursor, example_of, found, no_value
from dqpaint.language.syntax.expressions import bracket, expression, foreign_unit
from dqpaint.language.syntax.identifiers import new_name
from dqpaint.language.syntax.tree import Expression, Part, Quoted, Statement, Word
from dqpaint.language.vocabulary.aliases import PART_ALIASES
from dqpaint.language.vocabulary.units import FOREIGN_UNITS, UNITS
from dqpaint.language.vocabulary.words import MODAL, PARTS, RENAMED, STATEMENTS
from dqpaint.program import colours

VERSION = 1  # of the language, for `traj 1`


@record
class _Head:
    """The values between the first word of a line and its parts."""

    name: Word | None = None
    values: tuple[Expression, ...] = ()
    params: tuple[Word, ...] | None = None


_NOTHING = _Head()


def statement(cursor: Cursor) -> Statement:
    """Reads a line with a statement's word; raises a `Problem` at its first error."""
    first = cursor.take()
    known = STATEMENTS[first.text]
    head = _NOTHING
    if first.text in MODAL:  # a modal word's line is the clause alone
        parts = [_part(cursor, first.text, first.span)]
    else:
        head = _head(cursor, first.text, known.head)
        parts = _parts(cursor, first.text)
    if not cursor.at_end:
        raise _trailing(cursor, first.text)
    span = cursor.span_from(first.start)
    whole = Statement(first.text, span, head.name, head.values, tuple(parts), params=head.params)
    statement_rules.check(whole, cursor.text)
    return whole


def call(cursor: Cursor) -> Statement:
    """Reads a line that calls a `def`: `star(20 mm)`."""
    name = cursor.take()
    values = bracket(cursor, of=name.text)
    if not cursor.at_end:
        raise _trailing(cursor, name.text)
    return Statement("call", cursor.span_from(name.start), Word(name.text, name.span), values)


# The values between the first word and the parts.


def _head(cursor: Cursor, word: str, head: str) -> _Head:
    match head:
        case "":
            return _NOTHING
        case "value":
            return _Head(values=(_expression(cursor, word),))
        case "let":
            return _let(cursor)
        case "formula":
            return _formula(cursor)
        case "repeat":
            return _repeat(cursor)
        case "robot":
            return _Head(_robot(cursor))
        case "wall":
            return _Head(*clauses.wall(cursor))
        case "keep":
            return _Head(*clauses.keep(cursor))
        case "face":
            return _Head(*clauses.face(cursor))
        case "task":
            return _Head(_task(cursor))
        case "place":
            return _Head(_word(cursor) if cursor.is_word("auto") else None)
        case "include":
            return _include(cursor)
        case "def":
            return _def(cursor)
        case "frame":
            return _Head(new_name(cursor, "frame", example_of("frame")))
        case "texts":
            return _Head(values=import_clauses.texts(cursor, word))
        case _:
            assert head == "version", head
            _version(cursor)
            return _NOTHING


def _expression(cursor: Cursor, after: str) -> Expression:
    token = cursor.token
    if token.kind == "end" or (token.kind == "sign" and token.text == "="):
        part = PARTS.get(after)
        raise no_value(cursor, after, part.example if part else example_of(after))
    return expression(cursor, after)


def _let(cursor: Cursor) -> _Head:
    name = new_name(cursor, "let", example_of("let"))
    params = _params(cursor, "let") if cursor.is_sign("(") else None
    if not cursor.is_sign("="):
        message = f"expected '=' but found {found(cursor.token)}"
        raise problem("E109", message, cursor.token.span, "", f"write: let {name.text} = …")
    cursor.take()
    return _Head(name, (_expression(cursor, "="),), params)


def _formula(cursor: Cursor) -> _Head:
    formula = _expression(cursor, "curve")
    example = "curve … for t from 0 to 360 deg"
    _expect(cursor, "for", example)
    name = new_name(cursor, "for", example)
    _expect(cursor, "from", example)
    lower = _expression(cursor, "from")
    _expect(cursor, "to", example)
    return _Head(name, (formula, lower, _expression(cursor, "to")))


def _repeat(cursor: Cursor) -> _Head:
    after = cursor.peek()
    if cursor.token.kind != "name" or after.kind != "name" or after.text != "from":
        count = _expression(cursor, "repeat")
        if cursor.is_word("from"):
            message = "expected a name before 'from'"
            raise problem("E109", message, count.span, "", "for example: repeat i from 1 to 5")
        return _Head(values=(count,))
    name = new_name(cursor, "repeat", example_of("repeat"))
    cursor.take()
    lower = _expression(cursor, "from")
    written = lower.span.text_in(cursor.text)
    upper = cursor.token.text if cursor.token.kind == "number" else "5"
    example = f"repeat {name.text} from {written} to {upper}"
    _expect(cursor, "to", example)
    return _Head(name, (lower, _expression(cursor, "to")))


def _expect(cursor: Cursor, word: str, example: str) -> None:
    if not cursor.is_word(word):
        span = cursor.token.span if not cursor.at_end else cursor.before.span
        message = f"expected '{word}' but found {found(cursor.token)}"
        at = cursor.token.start if not cursor.at_end else cursor.before.end
        opens = cursor.token.kind == "number" or cursor.is_sign("(")
        fix = Fix(f"write {word}", Span(at, at), f"{word} ") if opens else None
        raise problem("E116", message, span, "", f"write: {example}", fix)
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
        help = 'a name with other signs than letters, digits and _ stands in quotes: robot "…"'
        raise problem("E112", message, cursor.token.span, "", help)
    return Word(token.text, token.span)


def _task(cursor: Cursor) -> Word:
    first = cursor.take()
    if first.kind == "name" and cursor.is_word("first"):
        return Word(f"{first.text}-{cursor.take().text}", cursor.span_from(first.start))
    return Word(first.text, first.span)


def _include(cursor: Cursor) -> _Head:
    token = cursor.take()  # a text, as the parser saw to
    if not token.text.strip():
        message = "this text has no name of a file in it"
        raise problem("E109", message, token.span, "", f"write: {example_of('include')}")
    return _Head(values=(Quoted(token.text, token.span),))


def _def(cursor: Cursor) -> _Head:
    name = new_name(cursor, "def", example_of("def"))
    return _Head(name, params=_params(cursor, "def") if cursor.is_sign("(") else ())


def _params(cursor: Cursor, after: str) -> tuple[Word, ...]:
    """The parameter names in brackets after the name of a function or a `def`."""
    cursor.take()
    example = "let f(x) = 2*x" if after == "let" else example_of(after)
    params: dict[str, Word] = {}
    while not (cursor.is_sign(")") and not params):
        name = new_name(cursor, "(" if not params else ",", example)
        if name.text in params:
            message = f"'{name.text}' comes twice in these brackets"
            raise problem("E230", message, name.span, "second", "choose another name")
        params[name.text] = name
        if not cursor.is_sign(","):
            break
        cursor.take()
    if not cursor.is_sign(")"):
        message = f"expected ',' or ')' but found {found(cursor.token)}"
        help = "in these brackets stand names alone; values follow where it is called"
        raise problem("E109", message, cursor.token.span, "", help)
    cursor.take()
    return tuple(params.values())


def _version(cursor: Cursor) -> None:
    token = cursor.take()
    if token.kind != "number":
        message = f"expected a number after 'traj' but found {found(token)}"
        raise problem("E109", message, token.span, "", f"write: traj {VERSION}")
    if float(token.text) != VERSION:
        message = f"this file is written in traj {token.text}, which this dqpaint does not know"
        raise problem("E118", message, token.span, "", f"it knows: traj {VERSION}")


# Parts.


def _parts(cursor: Cursor, word: str) -> list[Part]:
    known = STATEMENTS[word]
    parts: list[Part] = []
    while cursor.token.kind == "name":
        token = cursor.token
        part = RENAMED.get(token.text, token.text)
        if part == "in" and cursor.peek().text == "base" and "base" in known.parts:
            cursor.take()  # in base
            continue
        if part not in known.parts:
            if not known.parts:
                break
            raise _unknown_part(cursor, word)
        cursor.take()
        parts.append(_part(cursor, part, token.span))
    return parts


_READERS = {**clauses.READERS, **import_clauses.READERS}


def _part(cursor: Cursor, word: str, span: Span) -> Part:
    read = _READERS.get(PARTS[word].takes)
    return Part(word, span, read(cursor) if read else _expression(cursor, word))


ROUND = ("r", "diameter")  # what people give an arc besides its centre


def _unknown_part(cursor: Cursor, word: str) -> Problem:
    token, known = cursor.token, STATEMENTS[word]
    after_number = cursor.before.kind == "number" or cursor.before.text == ")"
    if token.text in FOREIGN_UNITS and after_number:
        return foreign_unit(token)
    special = statement_rules.misplaced(word, token)
    if special is not None:
        return special
    if token.text == "even" and "light" in known.parts:
        message = "'even' belongs to a light, behind its colour"
        return problem("E110", message, token.span, "", "write: light white even")
    if word == "arc" and token.text in ROUND:
        help = "the radius is the distance from here to the centre: first move to the circle"
        message = f"'arc' has no part called '{token.text}'"
        return problem("E110", message, token.span, "", help)
    message = f"'{word}' has no part called '{token.text}'"
    begins = token.text in STATEMENTS and token.text not in PARTS
    if begins and PART_ALIASES.get(token.text) not in known.parts:
        return problem("E110", message, token.span, "", "one statement per line")
    if token.text.lower() in colours.NAMES:
        help = "a colour stands behind 'light', two of them as: light red to blue"
        return problem("E110", message, token.span, "", help)
    meant = closest(token.text, known.parts, PART_ALIASES)
    if meant not in known.parts:
        meant = closest(token.text, known.parts)
    if not meant and after_number and len(token.text) > 1:  # one letter is like any other
        meant = closest(token.text, UNITS)
    help = did_you_mean(meant) or f"its parts are: {join_words(known.parts)}"
    fix = Fix(f"write {meant}", token.span, meant) if meant else None
    return problem("E110", message, token.span, "", help, fix)


def _trailing(cursor: Cursor, word: str) -> Problem:
    token = cursor.token
    if token.text in FOREIGN_UNITS and cursor.before.kind == "number":
        return foreign_unit(token)
    special = statement_rules.unexpected(word, cursor)
    if special is not None:
        return special
    if token.kind == "sign" and token.text == "=":
        help = "only 'let' has a '='"
    elif token.kind == "sign" and token.text == ",":
        help = "parts of a line need no commas; a point stands in brackets: (50, 0) mm"
    elif token.kind == "sign" and token.text == "%":
        help = "only the brightness of a light is written in %, and it is no less than 0%"
    elif word == "repeat" and token.text in ("step", "by"):
        help = "it counts by 1: repeat i from 0 to 5, and write 2*i"
    elif token.kind == "name" and token.text in STATEMENTS:
        help = "one statement per line"
    elif word == "repeat":
        help = "write: repeat 5, or: repeat i from 1 to 5"
    elif word == "def" and token.kind == "name":
        help = f"the names it is handed stand in brackets: {example_of(word)}"
    else:
        help = ""
    message = f"expected the end of the line but found {found(token)}"
    return problem("E112", message, token.span, "", help)
