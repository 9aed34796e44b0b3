"""Values or categories -> colours on black, with perceptually equal steps.

The map of amounts is a path through OKLab (Ottosson, A perceptual color space for image
processing, 2020), from blue over magenta and orange to pale yellow, lightness 0.48 to 0.95 and
never falling, cut into pieces of equal length there. It starts bright enough to be seen on black,
and as lightness alone orders it, people who cannot distinguish red and green can read it.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from dqpaint.light.arrays import Floats

MAP_STEPS = 256
LIGHTNESS_RANGE = (0.48, 0.95)
HUE_STOPS = ((0.0, 264.0), (0.45, 350.0), (0.75, 410.0), (1.0, 465.0))
"""Positions along the path and their hues [deg]."""
MOST_CHROMA = 0.24
CATEGORY_LIGHTNESS, CATEGORY_CHROMA = 0.76, 0.15
GOLDEN_ANGLE = 180.0 * (3.0 - 5.0**0.5)
"""The golden angle: rotations by it never come close to each other [deg]."""

_TO_LMS = np.array([
    [1.0, 0.3963377774, 0.2158037573],
    [1.0, -0.1055613458, -0.0638541728],
    [1.0, -0.0894841775, -1.2914855480],
])  # fmt: skip
_TO_RGB = np.array([
    [4.0767416621, -3.3077115913, 0.2309699292],
    [-1.2684380046, 2.6097574011, -0.3413193965],
    [-0.0041960863, -0.7034186147, 1.7076147010],
])  # fmt: skip


def rgb_from_oklch(lightness: Floats, chroma: Floats, hue: Floats) -> Floats:
    """Linear RGB (..., 3) of lightness, chroma and hue [deg], each (...)."""
    h = np.radians(hue)
    lab = np.stack([lightness, chroma * np.cos(h), chroma * np.sin(h)], axis=-1)
    return np.asarray((lab @ _TO_LMS.T) ** 3 @ _TO_RGB.T)


def _largest_chroma(lightness: Floats, hue: Floats, most: float) -> Floats:
    """The largest chroma up to `most` that linear sRGB can represent, for each colour."""
    low, high = np.zeros_like(lightness), np.full_like(lightness, most)
    for _ in range(40):
        middle = 0.5 * (low + high)
        rgb = rgb_from_oklch(lightness, middle, hue)
        fits = ((rgb >= 0.0) & (rgb <= 1.0)).all(axis=-1)
        low, high = np.where(fits, middle, low), np.where(fits, high, middle)
    return low


@cache
def sequential_map() -> Floats:
    """The sequential colour map (MAP_STEPS, 3), linear RGB from low to high."""
    t = np.linspace(0.0, 1.0, 4001)
    lightness = LIGHTNESS_RANGE[0] + (LIGHTNESS_RANGE[1] - LIGHTNESS_RANGE[0]) * t
    at, turned = np.array(HUE_STOPS).T
    hue = np.interp(t, at, turned)
    chroma = _largest_chroma(lightness, hue, MOST_CHROMA)
    kernel = np.ones(401) / 401.0  # the border of what can be shown has edges that would be seen
    smooth = np.convolve(np.pad(chroma, 200, mode="edge"), kernel, mode="valid")
    chroma = np.minimum(chroma, smooth)
    h = np.radians(hue)
    lab = np.stack([lightness, chroma * np.cos(h), chroma * np.sin(h)], axis=1)
    walked = np.append(0.0, np.cumsum(np.sqrt((np.diff(lab, axis=0) ** 2).sum(axis=1))))
    even = np.interp(np.linspace(0.0, walked[-1], MAP_STEPS), walked, t)
    rgb = rgb_from_oklch(*(np.interp(even, t, v) for v in (lightness, chroma, hue)))
    return np.clip(rgb, 0.0, 1.0)


def sequential_colours(values: Floats) -> Floats:
    """Linear RGB (..., 3) of values from 0 to 1; values outside get the end colours."""
    at = np.clip(values, 0.0, 1.0) * (MAP_STEPS - 1)
    below = np.minimum(at.astype(np.int64), MAP_STEPS - 2)
    part = (at - below)[..., None]
    table = sequential_map()
    return np.asarray((1.0 - part) * table[below] + part * table[below + 1])


def categorical_colours(count: int) -> Floats:
    """Linear RGB (count, 3) of categories: equal lightness, distant hues."""
    hue: Floats = np.asarray((250.0 + GOLDEN_ANGLE * np.arange(count)) % 360.0, dtype=np.float64)
    lightness = np.full(count, CATEGORY_LIGHTNESS)
    return np.clip(
        rgb_from_oklch(lightness, _largest_chroma(lightness, hue, CATEGORY_CHROMA), hue), 0.0, 1.0
    )
