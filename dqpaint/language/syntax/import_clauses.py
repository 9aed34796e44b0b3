"""Tokens of `text`, `path`, `svg`, `photo` -> clauses: texts, fonts, units, alignment, styles.

Each becomes a plain expression: a text `Quoted`, a word `Name`.
"""

from collections.abc import Callable

from dqpaint.diagnostics import Fix, Span, closest, did_you_mean, problem
from dqpaint.language.syntax.cursor import Cursor, example_of, found, percent
from dqpaint.language.syntax.tree import Expression, Literal, Name, Quoted
from dqpaint.language.vocabulary.units import FOREIGN_UNITS, LENGTH, UNITS
from dqpaint.language.vocabulary.words import PARTS
from dqpaint.photo import STYLE_WORDS

ALIGNMENTS = ("left", "centre", "right")
LENGTHS = tuple(unit for unit, (_, kind, _) in UNITS.items() if kind == LENGTH)


def texts(cursor: Cursor, word: str) -> tuple[Expression, ...]:
    """One or more texts in quotes after the first word of a line."""
    found_texts: list[Expression] = []
    while cursor.token.kind == "text":
        token = cursor.take()
        found_texts.append(Quoted(token.text, token.span))
    if not found_texts:
        token = cursor.token if not cursor.at_end else cursor.before
        message = f"expected a text in quotes after '{word}' but found {found(cursor.token)}"
        help, fix = f"for example: {example_of(word)}", None
        if cursor.token.kind == "name":
            end = token.end
            while cursor.token.kind == "name" and cursor.token.text not in PARTS:
                end = cursor.take().end
            written = cursor.text[token.start : end]
            help = f'put it in quotes: {word} "{written}"'
            fix = Fix("put it in quotes", Span(token.start, end), f'"{written}"')
        raise problem("E109", message, token.span, "", help, fix)
    return tuple(found_texts)


def _font(cursor: Cursor) -> Expression:
    token = cursor.token
    if token.kind != "text":
        message = f"expected a name in quotes after 'font' but found {found(token)}"
        span = token.span if not cursor.at_end else cursor.before.span
        fix, written = None, 'font "scripts"'
        if token.kind == "name":
            written = f'font "{token.text}"'
            fix = Fix("put it in quotes", span, f'"{token.text}"')
        raise problem("E109", message, span, "", f"write: {written}", fix)
    cursor.take()
    return Quoted(token.text, token.span)


def one_of(words: tuple[str, ...], after: str, aliases: dict[str, str]) -> "Reader":
    """A reader of one of some words."""

    def read(cursor: Cursor) -> Expression:
        token = cursor.token
        word = {"center": "centre"}.get(token.text, token.text)
        if token.kind != "name" or word not in words:
            meant = closest(token.text, words, aliases) if token.kind == "name" else ""
            meant = meant if meant in words else ""  # as an alias for a second
            span = token.span if not cursor.at_end else cursor.before.span
            message = f"expected {', '.join(words[:-1])} or {words[-1]} after '{after}'"
            fix = Fix(f"write {meant}", span, meant) if meant else None
            help = did_you_mean(meant) or f"for example: {after} {words[0]}"
            raise problem("E109", f"{message} but found {found(token)}", span, "", help, fix)
        cursor.take()
        return Name(word, token.span)

    return read


def _order(cursor: Cursor) -> Expression:
    span = cursor.token.span if not cursor.at_end else cursor.before.span
    if not (cursor.is_word("as") and cursor.peek().text == "drawn"):
        message = f"expected 'as drawn' after 'order' but found {found(cursor.token)}"
        cure = "write: order as drawn; without it the dark ways are made short"
        raise problem("E109", message, span, "", cure)
    start = cursor.take().start
    cursor.take()
    return Name("as drawn", cursor.span_from(start))


def _colours(cursor: Cursor) -> Expression:
    if cursor.is_word("full"):
        return Name("full", cursor.take().span)
    token = cursor.token
    if token.kind != "number":
        span = token.span if not cursor.at_end else cursor.before.span
        message = f"expected a number or full after 'colours' but found {found(token)}"
        raise problem("E109", message, span, "", "for example: colours 1, or: colours full")
    cursor.take()
    return Literal(float(token.text), "", token.span)


def _share(cursor: Cursor) -> Expression:
    token = cursor.token
    if token.kind != "number":
        span = token.span if not cursor.at_end else cursor.before.span
        message = f"expected a number and % after 'dark' but found {found(token)}"
        raise problem("E109", message, span, "", "for example: dark 5%")
    return Literal(percent(cursor, "dark", "dark 5%"), "", token.span)


Reader = Callable[[Cursor], Expression]

# By the kind of value, as in `words.PARTS`.
READERS: dict[str, Reader] = {
    "font": _font,
    "unit": one_of(LENGTHS, "unit", FOREIGN_UNITS),
    "alignment": one_of(ALIGNMENTS, "align", {"middle": "centre"}),
    "order": _order,
    "style": one_of(STYLE_WORDS, "as", {}),
    "colours": _colours,
    "share": _share,
    "flag": lambda cursor: Name(cursor.before.text, cursor.before.span),
}
