"""The words and units of the language -> what each means; all other parts read these tables."""

from dqpaint.language.vocabulary.units import UNITS
from dqpaint.language.vocabulary.words import (
    CONSTANTS,
    FUNCTIONS,
    LITTLE_WORDS,
    PARTS,
    PROFILES,
    RENAMED,
    STATEMENTS,
)

__all__ = [
    "CONSTANTS",
    "FUNCTIONS",
    "LITTLE_WORDS",
    "PARTS",
    "PROFILES",
    "RENAMED",
    "STATEMENTS",
    "UNITS",
]
