"""Words and units of the language -> their meaning: tables that all other parts read."""

from dqpaint.language.vocabulary.units import UNITS
from dqpaint.language.vocabulary.words import (
    CONSTANTS, FREE, FUNCTIONS, LITTLE_WORDS, PARTS, PROFILES, RENAMED, STATEMENTS,
)

__all__ = [
    "CONSTANTS", "FREE", "FUNCTIONS", "LITTLE_WORDS", "PARTS", "PROFILES", "RENAMED", "STATEMENTS",
    "UNITS",
]
