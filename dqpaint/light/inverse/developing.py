"""Linear light <-> the developed picture as numbers: the curve of `film`, its slope, its inverse.

The same equations as `light.film.develop`, in sRGB values from 0 to 1, without rounding and dither.
"""

from __future__ import annotations

from typing import cast

import cv2
import numpy as np

from dqpaint.light.arrays import Floats
from dqpaint.light.film.develop import LEAK, SPILL, TOE

FILTERS = (1.0 - 3.0 * LEAK) * np.eye(3) + LEAK
SPILLS = SPILL * (1.0 - np.eye(3))
KNEE = 0.0031308
"""Display light below which sRGB is straight; IEC 61966-2-1."""


def developed(light: Floats) -> tuple[Floats, tuple[Floats, Floats]]:
    """The picture (H, W, 3) in sRGB, 0 to 1, of linear light in which 1 saturates the sensor.

    Returns:
        The picture, and the slopes that `slope_back` needs.
    """
    x = _mixed(light, FILTERS)
    empty = cast(Floats, cv2.exp(-x))
    u = x + _mixed(x - (1.0 - empty), SPILLS)
    dark = cast(Floats, cv2.exp(-u))
    y = 1.0 - dark
    over = 1.0 / (y + TOE)
    z = (1.0 + TOE) * y * y * over
    low = z <= KNEE
    safe = np.maximum(z, KNEE)
    root = cast(Floats, cv2.pow(safe, 1.0 / 2.4))  # OpenCV's is several times as fast as numpy's
    picture = np.where(low, 12.92 * z, 1.055 * root - 0.055)
    steep = np.where(low, 12.92, 1.055 / 2.4 * root / safe)
    toe = (1.0 + TOE) * y * (y + 2.0 * TOE) * over * over
    return picture, (np.asarray(steep * toe * dark), np.asarray(1.0 - empty))


def _mixed(light: Floats, matrix: Floats) -> Floats:
    """Channels (H, W, 3) mixed by a symmetric matrix."""
    return cast(Floats, cv2.transform(light, matrix))


def slope_back(slopes: tuple[Floats, Floats], change: Floats) -> Floats:
    """What a change (H, W, 3) of the picture asks of the light: the transposed slope."""
    own, rejected = slopes
    u = own * change
    x = u + rejected * (_mixed(u, SPILLS))
    return np.asarray(_mixed(x, FILTERS))


def own_slope(slopes: tuple[Floats, Floats]) -> Floats:
    """An upper bound (H, W, 3) of the squared slope with which each channel of the light acts.

    The absolute row sums of J' J, J the slope of `developed`: with it as weights, a step of the
    solver does not pass its aim (separable quadratic surrogates).
    """
    own, rejected = slopes
    one = np.ones_like(own)
    rows = own * (_mixed(one, FILTERS) + _mixed(rejected, SPILLS))
    return slope_back(slopes, rows)


def light_for(picture: Floats, white: float) -> Floats:
    """The linear light (H, W, 3) whose developed picture this is, at least 0.

    Args:
        picture: (H, W, 3) sRGB from 0 to 1.
        white: display light of the picture's white; 1 would take light without end.
    """
    z = white * linear(picture)
    half = 0.5 * z / (1.0 + TOE)
    y = half + np.sqrt(half * (half + 2.0 * TOE))
    u = -np.log1p(-np.minimum(y, 1.0 - 1e-6))
    x = u.copy()
    for _ in range(30):  # a contraction: 2 spill = 0.24 a step
        x = u - (x - 1.0 + np.exp(-x)) @ SPILLS
    return np.asarray(np.maximum(x @ np.linalg.inv(FILTERS), 0.0))


def linear(picture: Floats) -> Floats:
    """Display light of sRGB values from 0 to 1."""
    return np.where(picture <= 0.04045, picture / 12.92, ((picture + 0.055) / 1.055) ** 2.4)


def coded(light: Floats) -> Floats:
    """SRGB values of display light from 0 to 1."""
    safe = np.maximum(light, KNEE)
    return np.where(light <= KNEE, 12.92 * light, 1.055 * safe ** (1.0 / 2.4) - 0.055)
