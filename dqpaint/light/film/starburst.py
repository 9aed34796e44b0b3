"""An image and a number of aperture blades -> the image with rays around its bright lights."""

from __future__ import annotations

import math
from typing import cast

import cv2
import numpy as np

from dqpaint.light.arrays import Floats, Image

RAY_ENERGY = 0.05
"""Share of the light that goes into the rays."""
RAY_LENGTH = 0.16
"""Length of a ray over the height of the picture."""
BLADE_RANGE = (3, 24)
"""Least and greatest number of blades."""


def with_starburst(image: Image, blades: int) -> Image:
    """The image with part of its light in the rays of an aperture with `blades` blades.

    Each edge of the aperture diffracts light along the line across it, with r^-2 from the core
    (the far field of a straight edge); so an even number of blades makes as many rays, an odd one
    twice as many. Rays of the points of a line merge: only isolated lights show them.
    Rays are computed at half the size. Light beyond the picture's edge is lost.

    Args:
        image: (H, W, 3) linear RGB.
        blades: Of the aperture.
    """
    height, width = image.shape[:2]
    half = cast(
        Image,
        cv2.resize(image, ((width + 1) // 2, (height + 1) // 2), interpolation=cv2.INTER_AREA),
    )
    kernel = _rays(blades, max(8, round(0.5 * RAY_LENGTH * height)))
    reach = kernel.shape[0] // 2
    size = (half.shape[0] + 2 * reach, half.shape[1] + 2 * reach)
    rows, columns = (cv2.getOptimalDFTSize(n) for n in size)
    spectrum = np.fft.rfft2(kernel, (rows, columns))
    rays = np.empty_like(half)
    for channel in range(3):
        wave = np.fft.rfft2(half[..., channel].astype(np.float64), (rows, columns)) * spectrum
        whole = np.fft.irfft2(wave, (rows, columns))
        rays[..., channel] = whole[reach : reach + half.shape[0], reach : reach + half.shape[1]]
    np.maximum(rays, 0.0, out=rays)
    full = cast(Image, cv2.resize(rays, (width, height), interpolation=cv2.INTER_LINEAR))
    return np.asarray((1.0 - RAY_ENERGY) * image + RAY_ENERGY * full, dtype=np.float32)


def _rays(blades: int, reach: int) -> Floats:
    """The rays of a point, (2 reach + 1, 2 reach + 1); they sum to 1."""
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1].astype(np.float64)
    radius = np.sqrt(x * x + y * y)
    total = np.zeros_like(radius)
    for k in range(blades):
        turn = 2.0 * math.pi * (k + 0.25) / blades
        along, across = (
            x * math.cos(turn) + y * math.sin(turn),
            y * math.cos(turn) - x * math.sin(turn),
        )
        width = 0.55 + 0.008 * np.abs(along)
        total += (
            np.exp(-0.5 * (across / width) ** 2) / width / (1.0 + (along / (0.035 * reach)) ** 2)
        )
    fade = np.clip(1.0 - radius / reach, 0.0, 1.0)
    total *= fade * fade
    return np.asarray(total / total.sum())
