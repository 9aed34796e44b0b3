"""Word -> whether it may be a new name, or its existing meaning."""

from dqpaint.diagnostics import Problem, problem
from dqpaint.language.syntax.cursor import Cursor, found
from dqpaint.language.syntax.lexer import Token
from dqpaint.language.syntax.tree import Word
from dqpaint.language.vocabulary.units import UNITS
from dqpaint.language.vocabulary.words import (
    CONSTANTS,
    FUNCTIONS,
    PROFILES,
    RESERVED,
    SHAPES,
    STATEMENTS,
)
from dqpaint.program import colours

WORD = "a word of the language"


def meaning(word: str) -> str:
    """The meaning of a word of the language: `the unit metre`; empty if it is free."""
    if word in UNITS:
        return f"the unit {UNITS[word][2]}"
    if word in RESERVED:
        return WORD
    if word in FUNCTIONS:
        return "a function"
    if word in PROFILES:
        return "a profile"
    if word in CONSTANTS:
        return "a number" if word == "pi" else f"the direction of the {word} axis"
    return "a colour" if word in colours.NAMES else ""


def new_name(cursor: Cursor, after: str, example: str) -> Word:
    """Reads a name that is being defined.

    A value may be called x, y or z: where a direction is needed these are still the axes.
    """
    token = cursor.token
    if token.kind != "name" or token.text == "°":
        raise problem(
            "E109",
            f"expected a name after '{after}' but found {found(token)}",
            token.span if token.kind != "end" else cursor.before.span,
            "",
            f"for example: {example}",
        )
    taken = meaning(token.text)
    own = token.text in STATEMENTS and token.text not in SHAPES  # some are free for values
    if after == "def" and own:
        taken = WORD
    if taken and not (after not in ("def", "frame") and token.text in ("x", "y", "z")):
        raise taken_name(token, taken)
    cursor.take()
    return Word(token.text, token.span)


def taken_name(token: Token, taken: str) -> Problem:
    """E114: the word already has a meaning."""
    return problem(
        "E114",
        f"'{token.text}' can't be used as a name",
        token.span,
        f"'{token.text}' is {taken}",
        f"choose another name, for example '{token.text}1'",
    )
