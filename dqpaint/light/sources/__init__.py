"""Poses, colours and a brush -> sweeps: light in time and space, cut where it changes."""

from dqpaint.light.sources.emission import inverse_square
from dqpaint.light.sources.from_motion import even_by_length, sweeps, view_camera
from dqpaint.light.sources.occlusion import Occlusion, occlusion_by
from dqpaint.light.sources.sweep import ALL_SAMPLES, Sweep

__all__ = [
    "ALL_SAMPLES", "Occlusion", "Sweep", "even_by_length", "inverse_square", "occlusion_by",
    "sweeps", "view_camera",
]
