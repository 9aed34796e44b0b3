"""Lamps with a size -> layers of discs: a diffuse ball appears as an even disc.

The light is sorted into layers by the diameter of its disc on the picture, and each layer is
spread at once: a point of it becomes a disc with the same energy.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING, cast

import cv2
import numpy as np

from dqpaint.light.arrays import Floats
from dqpaint.light.camera.camera import NEAREST_DEPTH, Camera

if TYPE_CHECKING:
    from dqpaint.light.sources.emission import Light

DIAMETER_RATIO = 1.15
"""Ratio between the diameters of adjacent layers."""
SMALLEST_DISC = 1.0
"""A smaller disc is drawn as a point [px]."""
LARGEST_DISC = 2000.0
"""Largest diameter of a disc [px]."""
RIM_SUBPIXELS = 8
"""Subpixels along each axis for the rim of a disc."""


def disc_layers(light: Light, camera: Camera) -> Iterator[tuple[int | None, Floats]]:
    """The layers of a light (None for points), each with its share (N-1,) of each step.

    A step between two layers goes to both, such that the mean diameter is its own.
    """
    _, depth = camera.project(0.5 * (light.points[1:] + light.points[:-1]))
    diameter = light.size * camera.focal / np.maximum(depth, NEAREST_DEPTH)
    diameter = np.minimum(diameter, LARGEST_DISC)
    small = diameter < SMALLEST_DISC
    nearest = np.floor(np.log(np.maximum(diameter, SMALLEST_DISC)) / math.log(DIAMETER_RATIO))
    lower = nearest.astype(np.int64)
    above = (diameter / DIAMETER_RATIO**nearest - 1.0) / (DIAMETER_RATIO - 1.0)
    above = np.clip(above, 0.0, 1.0)
    if small.any():
        yield None, small.astype(np.float64)
    for layer in np.unique(np.concatenate([lower[~small], lower[~small] + 1])):
        share = np.where(lower == layer, 1.0 - above, np.where(lower == layer - 1, above, 0.0))
        share[small] = 0.0
        if share.any():
            yield int(layer), share


def spread_discs(planes: Floats, layer: int) -> Floats:
    """Planes (3, H, W) with every point replaced by a disc of the layer's diameter."""
    kernel = _disc(layer)
    spread = [
        cv2.filter2D(plane, cv2.CV_64F, kernel, borderType=cv2.BORDER_CONSTANT) for plane in planes
    ]
    return np.maximum(np.stack(cast(list[Floats], spread)), 0.0)  # a transform leaves -1e-20


@cache
def _disc(layer: int) -> Floats:
    """An even disc with its rim weighted by pixel coverage; it sums to 1."""
    radius = 0.5 * DIAMETER_RATIO**layer
    half = math.ceil(radius)
    side = 2 * half + 1
    fine = (np.arange(side * RIM_SUBPIXELS) + 0.5) / RIM_SUBPIXELS - (half + 0.5)
    kernel = np.empty((side, side))
    for row, across in zip(kernel, fine.reshape(side, RIM_SUBPIXELS), strict=True):
        inside = across[:, None] ** 2 + fine[None, :] ** 2 <= radius**2  # all at once: gigabytes
        row[:] = inside.reshape(RIM_SUBPIXELS, side, RIM_SUBPIXELS).mean(axis=(0, 2))
    return np.asarray(kernel / kernel.sum())
