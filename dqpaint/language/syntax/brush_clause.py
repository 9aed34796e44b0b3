"""Tokens after `brush` -> its name and values, by the registry of brushes.

`brush NAME [VALUE] KEY VALUE ...`: the value without a name is the brush's first. Which words are
keys is for the brush to say; a word that is none of its keys belongs to the statement.
"""

from dqpaint.diagnostics import Fix, Problem, closest, did_you_mean, join_words, problem
from dqpaint.errors import UsageError
from dqpaint.language.syntax.cursor import Cursor, found, no_value
from dqpaint.language.syntax.expressions import expression
from dqpaint.language.syntax.lexer import Token
from dqpaint.language.syntax.tree import BrushPart, BrushWords, Expression, Word
from dqpaint.language.vocabulary.words import PARTS, RESERVED, STATEMENTS

SIZED = {"point": "ball"}  # a point with a size is a ball of that size
_EXAMPLE = PARTS["brush"].example


def brush(cursor: Cursor) -> BrushWords:
    """Reads the name of a brush and its values."""
    token = cursor.take()
    takes, first = _values_of(token)
    name, parts = token.text, []
    if not _is_key(cursor, takes, first is not None) and not _ends_here(cursor, takes):
        if cursor.token.kind == "name" and cursor.peek().kind in ("number", "text"):
            raise _unknown(cursor.token, name, takes)  # no value: a key, and what it should be
        if name in SIZED:
            name = SIZED[name]
            takes, first = _values_of(Token("name", name, token.start, token.end))
        if first is None:
            raise _no_value(name, takes, cursor)
        value = expression(cursor, f"brush {token.text}")
        parts.append(BrushPart(Word(first, value.span), (value,)))
    of_statement = STATEMENTS[cursor.first.text].parts
    while cursor.token.kind == "name" and cursor.token.text in takes:
        known = {part.key.text for part in parts}
        if cursor.token.text in known and cursor.token.text in of_statement:
            break  # `along` of a bar, and then that of its screw
        parts.append(_part(cursor, takes))
    _check_next(cursor, token, takes)
    _check_once(parts)
    return BrushWords(Word(name, token.span), tuple(parts), cursor.span_from(token.start))


def is_key(name: str, word: str) -> bool:
    """Whether a word names a value of a brush."""
    from dqpaint.brushes import BRUSHES, takes

    return name in BRUSHES and word in takes(BRUSHES[name])


def _values_of(token: Token) -> tuple[dict[str, str], str | None]:
    """The type of each value of a brush, and the value that may be written without its name."""
    from dqpaint.brushes import BRUSHES, first_value, takes  # who writes no `brush` needs none

    if token.kind not in ("name", "text"):
        message = f"expected the name of a brush but found {found(token)}"
        raise problem("E109", message, token.span, "", f"write: brush point, or {_EXAMPLE}")
    try:
        if token.text in BRUSHES:
            return takes(BRUSHES[token.text]), first_value(BRUSHES[token.text])
    except UsageError as fault:  # a plugin that cannot be loaded
        raise problem("E264", str(fault), token.span) from None
    meant = closest(token.text, BRUSHES)
    help = did_you_mean(meant) or f"the brushes are: {join_words(BRUSHES)}"
    fix = Fix(f"write {meant}", token.span, meant) if meant else None
    raise problem("E264", f"there is no brush '{token.text}'", token.span, "", help, fix)


def _is_key(cursor: Cursor, takes: dict[str, str], head: bool) -> bool:
    """Whether a key comes next, and not a name of the file as the unnamed value."""
    token, after = cursor.token, cursor.peek()
    if token.kind != "name" or token.text not in takes:
        return False
    names = after.kind == "name" and after.text not in RESERVED
    return not head or token.text in RESERVED or names or _begins_value(after)


def _begins_value(token: Token) -> bool:
    return token.kind in ("number", "text") or (token.kind == "sign" and token.text == "(")


def _ends_here(cursor: Cursor, takes: dict[str, str]) -> bool:
    """Whether the line ends, or another part of the statement begins."""
    token = cursor.token
    if token.kind != "name":
        return cursor.at_end
    if token.text in RESERVED:
        return token.text not in takes
    return token.text in STATEMENTS[cursor.first.text].parts and _begins_value(cursor.peek())


def _part(cursor: Cursor, takes: dict[str, str]) -> BrushPart:
    key = cursor.take()
    values = [_value(cursor, key.text)]
    while takes[key.text] == "colours" and cursor.is_word("to"):
        cursor.take()
        values.append(_value(cursor, "to"))
    return BrushPart(Word(key.text, key.span), tuple(values))


def _value(cursor: Cursor, after: str) -> Expression:
    if cursor.at_end or cursor.is_sign("="):
        raise no_value(cursor, after)
    return expression(cursor, after)


def _check_next(cursor: Cursor, name: Token, takes: dict[str, str]) -> None:
    """Raises at an unknown word that resembles a word of the brush."""
    token, statement = cursor.token, STATEMENTS[cursor.first.text]
    if token.kind != "name" or token.text in RESERVED or token.text in statement.parts:
        return
    if closest(token.text, takes) or not statement.parts:
        raise _unknown(token, name.text, takes)


def _unknown(token: Token, name: str, takes: dict[str, str]) -> Problem:
    """The error of a word that is no value of a brush."""
    meant = closest(token.text, takes)
    message = f"brush '{name}' has no value called '{token.text}'"
    help = did_you_mean(meant) or f"its values are: {join_words(takes)}"
    fix = Fix(f"write {meant}", token.span, meant) if meant else None
    return problem("E265", message, token.span, "", help, fix)


def _check_once(parts: list[BrushPart]) -> None:
    seen = set()
    for part in parts:
        if part.key.text in seen:
            message = f"the {part.key.text} of this brush is given twice"
            raise problem("E113", message, part.key.span, "second", "keep one of them")
        seen.add(part.key.text)


def _no_value(name: str, takes: dict[str, str], cursor: Cursor) -> Problem:
    message = f"a value of brush '{name}' stands behind its name"
    help = f"its values are: {join_words(takes)}"
    return problem("E265", message, cursor.token.span, "", help)
