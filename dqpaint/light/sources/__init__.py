"""Poses, colours and a brush -> sweeps: light in time and space, cut where it changes.

A new brush is a model in `brushes` under `@BRUSHES.add(name)` that returns its `Emitters`.
"""

from dqpaint.light.sources.brushes import BRUSHES, Brush, describe_fields, read_brush
from dqpaint.light.sources.emission import inverse_square
from dqpaint.light.sources.emitters import Emitters
from dqpaint.light.sources.from_motion import even_by_length, sweeps, view_camera
from dqpaint.light.sources.occlusion import Occlusion, occlusion_by
from dqpaint.light.sources.sweep import ALL_SAMPLES, Sweep

__all__ = [
    "ALL_SAMPLES",
    "BRUSHES",
    "Brush",
    "Emitters",
    "Occlusion",
    "Sweep",
    "describe_fields",
    "even_by_length",
    "inverse_square",
    "occlusion_by",
    "read_brush",
    "sweeps",
    "view_camera",
]
