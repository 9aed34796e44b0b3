"""The words and units of the language -> what each means; all other parts read these tables."""

from dqpaint.language.vocabulary.units import UNITS
from dqpaint.language.vocabulary.words import (
    CONSTANTS,
    FUNCTIONS,
    LAWS,
    LITTLE_WORDS,
    PARTS,
    STATEMENTS,
)

__all__ = ["CONSTANTS", "FUNCTIONS", "LAWS", "LITTLE_WORDS", "PARTS", "STATEMENTS", "UNITS"]
