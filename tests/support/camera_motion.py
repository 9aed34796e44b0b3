"""Poses for brushes: never the identity, turning and moving at once."""

import numpy as np

from dqpaint import dq
from dqpaint.light.camera.camera import frame_points
from dqpaint.light.camera.views import parse_views
from dqpaint.light.sources.sweep import Sweep

ROTATION = np.linalg.qr(np.random.default_rng(11).normal(size=(3, 3)))[0]
ROTATION *= np.linalg.det(ROTATION)
FRONT = ROTATION


def turned(angle, axis):
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    half = 0.5 * np.asarray(angle, float)[..., None]
    return np.concatenate([np.cos(half), np.sin(half) * axis], axis=-1)


def screw(samples=400, turns=0.8, advance=0.2, radius=0.03):
    """A screw about a slanted line, away from the origin; a general start orientation."""
    u = np.linspace(0, 1, samples)
    start = dq.pose_from([radius, 0.0, 0.0], turned(0.7, [1, 2, -1]))
    step = dq.pose_from(
        np.column_stack([0 * u, 0 * u, advance * u]), turned(2 * np.pi * turns * u, [0, 0, 1])
    )
    place = dq.pose_from([0.5, -0.1, 0.4], turned(1.1, [0.3, -1, 0.5]))
    return dq.mul(dq.mul(place, step), start)


def swept(emitters, samples=400, period=0.01, colours=None, **how):
    pose = screw(samples)
    if colours is None:
        colours = np.tile([1.0, 0.6, 0.2], (samples - 1, 1))
    return Sweep(period, pose, colours, emitters, **how)


def camera_for(sweep, view="20,15", size=(320, 180)):
    return frame_points(sweep.lit_points, FRONT, parse_views(view)[0].view, size)
