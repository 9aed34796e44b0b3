"""Text -> the same text in the standard layout, tokens and comments unchanged (`dqpaint fmt`).

Words of earlier versions become today's: `law` is written `profile`.
Two blanks a block, `a, b`, `90 deg`, blanks round + - and =, none round * / ^, two blanks before a
comment that follows something, one empty line at most. Lines are neither joined, broken nor moved.
"""

from collections.abc import Iterator
from contextlib import suppress
from typing import NamedTuple

from dqpaint.diagnostics import DiagnosticCollector, ErrorLimitError, ScriptError
from dqpaint.language.syntax.brush_clause import is_key
from dqpaint.language.syntax.lexer import TOKEN, Token, lines
from dqpaint.language.syntax.parser import parse_statements
from dqpaint.language.vocabulary.words import RENAMED, RESERVED, STATEMENTS

STEP = "  "  # of a block, and of a bracket that goes on over lines
BEFORE_COMMENT = "  "
_TIGHT = ("*", "/", "^")
_SUMS = ("+", "-")


class _Row(NamedTuple):
    """One line of the file."""

    tokens: list[Token]
    comment: str
    begins: bool  # a statement, not what is left of an open bracket


class _State(NamedTuple):
    """The state of the formatter within a line."""

    statement: str  # its first word
    brush: str  # in whose clause it is
    before: Token | None
    is_word: bool  # of the language, not a name in a formula
    unary: bool  # the sign of a number, not of a sum
    ends_value: bool  # so that a + or - which follows is one of a sum


_NOTHING = _State("", "", None, False, False, False)


def formatted(text: str, name: str = "<text>") -> str:
    """A drawing's text in the standard layout; formatting it again changes nothing.

    Raises:
        ScriptError: with its mistakes, if the text does not parse.
    """
    _check(text, name)
    made = "".join(_formatted_lines(text))
    if _words(made) != _words(text):
        raise AssertionError("the layout would change what is written")
    return made


def _check(text: str, name: str) -> None:
    findings = DiagnosticCollector()
    with suppress(ErrorLimitError):
        parse_statements(text, findings)
    if findings.errors:
        raise ScriptError(name, text, findings.ordered())


def _words(text: str) -> list[list[tuple[str, str]]]:
    return [[(t.kind, _current_word(t.kind, t.text)) for t in line.tokens] for line in lines(text)]


def _current_word(kind: str, word: str) -> str:
    return RENAMED.get(word, word) if kind == "name" else word


def _formatted_lines(text: str) -> Iterator[str]:
    """The lines of the new text."""
    blocks = brackets = 0
    state = _NOTHING
    empty = started = False
    for row in _rows(text):
        if not row.tokens and not row.comment:
            empty = started
            continue
        if row.begins:
            state = _NOTHING
            blocks -= row.tokens[0].text == "end"
        yield ("\n" if empty else "") + STEP * (blocks + brackets - _closing(row.tokens))
        written, state = _joined(row.tokens, state)
        brackets += sum((t.text == "(") - (t.text == ")") for t in row.tokens if t.kind == "sign")
        gap = BEFORE_COMMENT if row.tokens and row.comment else ""
        yield f"{written}{gap}{row.comment}\n"
        empty, started = False, True
        if row.begins:
            known = STATEMENTS.get(row.tokens[0].text)
            blocks += known is not None and known.block


def _rows(text: str) -> Iterator[_Row]:
    """The lines of the file, empty ones included."""
    tokens: list[Token] = []
    comment, brackets, begins = "", 0, True
    position, size = (1 if text.startswith("\ufeff") else 0), len(text)
    while position < size:
        match = TOKEN.match(text, position)
        assert match is not None
        kind = match.lastgroup
        position = match.end()
        if kind is None:
            break
        word, start = match[kind], match.start(kind)
        if kind == "newline":
            yield _Row(tokens, comment, begins and bool(tokens))
            begins = brackets == 0
            tokens, comment = [], ""
        elif kind == "comment":
            comment = word.rstrip()
        elif kind == "glued":  # a number and its unit, as the parser has seen
            number = match["number"]
            tokens += [
                Token("number", number, start - len(number), start),
                Token("name", word, start, position),
            ]
        elif kind != "bad":  # a blank that only Unicode calls one
            tokens.append(Token(kind, _current_word(kind, word), start, position))
            brackets += (word == "(") - (word == ")")
    if tokens or comment:
        yield _Row(tokens, comment, begins and bool(tokens))


def _closing(tokens: list[Token]) -> int:
    """The number of brackets a line closes before any other token."""
    count = 0
    for token in tokens:
        if token.text != ")" or token.kind != "sign":
            break
        count += 1
    return count


def _joined(tokens: list[Token], state: _State) -> tuple[str, _State]:
    """The tokens of a line, joined by the standard blanks."""
    parts: list[str] = []
    for token in tokens:
        if parts:
            parts.append(_gap(state, token))
        parts.append(token.text)
        state = _after(state, token)
    return "".join(parts), state


def _after(state: _State, token: Token) -> _State:
    """The state after a token."""
    statement, brush = state.statement or token.text, state.brush
    is_word = is_sum = False
    if token.kind == "name":
        known = STATEMENTS.get(statement)
        part = known is not None and token.text in known.parts  # but it may be a name in a formula
        opens = state.before is not None and (state.before.text == statement or state.ends_value)
        kind = statement == "keep" and state.before and state.before.text in ("inside", "from")
        is_word = token.text in RESERVED or (part and opens) or bool(kind)
        if state.before is not None and state.before.text == "brush":
            brush, is_word = token.text, True
        elif brush and is_key(brush, token.text):
            is_word = is_word or opens or state.before is None or state.before.text == brush
        elif token.text in RESERVED and token.text != "to":
            brush = ""  # another part
    elif token.kind == "sign":
        is_sum = token.text in _SUMS
    ends_value = token.text in (")", "%") if token.kind == "sign" else not is_word
    return _State(statement, brush, token, is_word, is_sum and not state.ends_value, ends_value)


def _gap(state: _State, token: Token) -> str:
    """The blanks before a token that is not the first of its line."""
    before = state.before
    assert before is not None
    first = before.text if before.kind == "sign" else ""
    second = token.text if token.kind == "sign" else ""
    if first == "(" or second in (")", ",", "%") or token.text == "°":
        return ""
    if first == "," or "=" in (first, second):
        return " "
    if first in _TIGHT or second in _TIGHT or state.unary:
        return ""
    return "" if second == "(" and before.kind == "name" and not state.is_word else " "
