"""A letter as a pen draws it: its advance and its strokes."""

from typing import NamedTuple

from dqpaint.program import Floats


class Glyph(NamedTuple):
    """A letter: the advance to the next one, and its strokes, each (N, 2)."""

    width: float
    strokes: tuple[Floats, ...]
