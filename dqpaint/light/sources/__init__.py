"""Poses, colours and a brush -> sweeps: light in time and space, cut where it changes.

A new brush is a model in `brushes` under `@BRUSHES.add(name)` that returns its `Emitters`.
"""

from dqpaint.light.sources.brushes import BRUSHES, Brush, choices_of, read_brush
from dqpaint.light.sources.emission import inverse_square
from dqpaint.light.sources.emitters import Emitters
from dqpaint.light.sources.from_motion import evened, stand, sweeps
from dqpaint.light.sources.occlusion import Shade, shade_of
from dqpaint.light.sources.sweep import ALL, Sweep

__all__ = [
    "ALL",
    "BRUSHES",
    "Brush",
    "Emitters",
    "Shade",
    "Sweep",
    "choices_of",
    "evened",
    "inverse_square",
    "read_brush",
    "shade_of",
    "stand",
    "sweeps",
]
