"""The language's tables -> its words by kind, as editors colour and explain them."""

from functools import cache
from typing import NamedTuple

from dqpaint.language.vocabulary import (
    CONSTANTS,
    FUNCTIONS,
    LITTLE_WORDS,
    PARTS,
    PROFILES,
    RENAMED,
    STATEMENTS,
    UNITS,
)
from dqpaint.program import colours


class Entry(NamedTuple):
    """A word: its kind, its meaning in a line, how it is written."""

    word: str
    kind: str  # statement, part, word, unit, function, profile, constant, colour, renamed
    meaning: str
    example: str


@cache
def vocabulary() -> tuple[Entry, ...]:
    """All words; one that is a statement and a part comes twice, the statement first."""
    return (
        *(Entry(s.word, "statement", s.meaning, s.example) for s in STATEMENTS.values()),
        *(Entry(p.word, "part", p.meaning, p.example) for p in PARTS.values()),
        *(Entry(word, "word", "a little word of the language", word) for word in LITTLE_WORDS),
        *(Entry(unit, "unit", f"the unit {name}", unit) for unit, (_, _, name) in UNITS.items()),
        *(Entry(name, "function", "a function", call) for name, call in FUNCTIONS.items()),
        *(
            Entry(profile, "profile", "a profile", f"{profile}{ends[-1]}")
            for profile, ends in PROFILES.items()
        ),
        *(Entry(name, "constant", _constant(name), name) for name in CONSTANTS),
        *(Entry(name, "colour", "a colour", name) for name in colours.NAMES),
        *(
            Entry(old, "renamed", f"the same as {new}", PARTS[new].example)
            for old, new in RENAMED.items()
        ),
    )


def words(*kinds: str) -> list[str]:
    """The words of some kinds, each once, the longest first, so that none hides another."""
    found = {entry.word for entry in vocabulary() if entry.kind in kinds}
    return sorted(found, key=lambda word: (-len(word), word))


def _constant(name: str) -> str:
    return "the number pi" if name == "pi" else f"the direction of the {name} axis"
