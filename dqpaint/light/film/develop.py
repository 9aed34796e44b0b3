"""Linear light -> an 8-bit sRGB picture with white cores and coloured halos.

A pure blue LED alone would never turn white, however bright. On sensors and on film it does, for
two reasons: each colour's filter lets a little of the others through, and what a full pixel cannot
hold spills into its neighbours, which sit behind the other filters. So cores go white, halos keep
their colour and the ground stays black.
"""

from __future__ import annotations

from functools import cache
from typing import cast

import cv2
import numpy as np
from numpy.typing import NDArray

from dqpaint.errors import DqpaintError
from dqpaint.light.arrays import Image, Picture

LEAK = 0.018
"""Share of each channel that leaks into each of the other two."""
SPILL = 0.12
"""Share of a full channel's excess that spills into each of the other two."""
TOE = 0.008
"""Brightness under which the response bends down to black."""
STRIP_ROWS = 64
"""Rows of one batch, so that they stay in the processor's cache."""


def develop(image: Image, exposure: float, ev: float = 0.0) -> Picture:
    """Develop a linear image to an sRGB picture.

        x = 2^ev exposure F image      F: 1 - 2 leak on the diagonal, leak beside it
        r = x - (1 - exp(-x))          what does not fit into a sensor that fills up
        y = 1 - exp(-x - S r)          S: 0 on the diagonal, spill beside it
        z = y^2 (1 + toe) / (y + toe)  a little less of the faintest light
        picture = sRGB(z)              IEC 61966-2-1

    The last bit is dithered, as wide halos on black would otherwise show their contours. The
    pattern is fixed, and black stays black.

    Args:
        image: (H, W, 3) linear RGB.
        exposure: Factor that makes 1 saturate the sensor.
        ev: Stops brighter, chosen by the photographer.
    """
    gain = exposure * 2.0**ev
    if not (np.isfinite(gain) and gain > 0.0):
        raise DqpaintError(f"exposure {exposure:g} at {ev:g} EV is not a positive number")
    if not np.isfinite(cv2.sumElems(image)).all():
        raise DqpaintError("the image has a value that is not finite")
    own, others = np.eye(3), 1.0 - np.eye(3)
    filters = gain * ((1.0 - 2.0 * LEAK) * own + LEAK * others)
    curve = _response_curve()
    picture = np.empty(image.shape, dtype=np.uint8)
    for top in range(0, len(image), STRIP_ROWS):
        rows = slice(top, top + STRIP_ROWS)
        light = cast(Image, cv2.transform(image[rows], filters))
        rejected = light - _saturated(light)
        light += cast(Image, cv2.transform(rejected, SPILL * others))
        index = cast(Image, cv2.sqrt(_saturated(light)))
        index *= len(curve) - 1
        level = curve[index.astype(np.uint16)]
        level += _dither_thresholds(level.shape)
        picture[rows] = level >> 8
    return picture


def _saturated(light: Image) -> Image:
    """1 - exp(-light), at least 0."""
    empty = cv2.exp(-light)
    return cast(Image, np.maximum(np.subtract(np.float32(1.0), empty, out=empty), 0.0, out=empty))


def encode(display: Image) -> Picture:
    """Encode rows (H, W, 3) of display light from 0 to 1 as dithered 8-bit sRGB."""
    srgb = np.where(display <= 0.0031308, 12.92 * display, 1.055 * display ** (1.0 / 2.4) - 0.055)
    level = np.floor(255.0 * 256.0 * srgb + 0.5).astype(np.uint16)
    level += _dither_thresholds((STRIP_ROWS, *display.shape[1:]))[: len(display)]
    return np.asarray(level >> 8, dtype=np.uint8)


@cache
def _response_curve() -> NDArray[np.uint16]:
    """Toe and sRGB curve in 8.8 bits over the square root of y, which resolves the darks."""
    y = np.linspace(0.0, 1.0, 1 << 16) ** 2
    z = y * y * (1.0 + TOE) / (y + TOE)
    srgb = np.where(z <= 0.0031308, 12.92 * z, 1.055 * z ** (1.0 / 2.4) - 0.055)
    return np.floor(255.0 * 256.0 * srgb + 0.5).astype(np.uint16)


@cache
def _dither_thresholds(shape: tuple[int, int, int]) -> NDArray[np.uint16]:
    """Thresholds (H, W, 3) from 0 to 255 for the eight bits that are dropped.

    The R2 sequence: multiples of the inverse powers of the plastic number p are spread evenly over
    the plane (Roberts, The unreasonable effectiveness of quasirandom sequences, 2018). Instead of
    1/p^2 = 0.570 a row takes 37/64, so that the strips join. The channels are a third apart, so
    that they do not step together.
    """
    y, x, channel = np.ogrid[: shape[0], : shape[1], : shape[2]]
    phase = x / 1.324717957244746 + y * (37.0 / STRIP_ROWS) + channel / 3.0
    return (256.0 * (phase % 1.0)).astype(np.uint16)
