"""Linear light and the name of a look -> a picture; `film` is the default.

A new look is a function here under `@_add(name)`: from light in which 1 saturates the sensor to
display values from 0 to 1 before the sRGB curve, both (H, W, 3) linear.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

import cv2
import numpy as np

from dqpaint.core import Registry
from dqpaint.errors import DqpaintError
from dqpaint.light.arrays import Image, Picture
from dqpaint.light.film.develop import STRIP_ROWS, develop, encode

Look = Callable[[Image], Image]
Develop = Callable[[Image, float, float], Picture]
LOOKS: Registry[Develop] = Registry("look")


def _add(name: str) -> Callable[[Look], Look]:
    def record(look: Look) -> Look:
        def whole(image: Image, exposure: float, ev: float = 0.0) -> Picture:
            return _developed(look, image, exposure, ev)

        whole.__doc__ = look.__doc__
        LOOKS.add(name)(whole)
        return look

    return record


@LOOKS.add("film")
def film(image: Image, exposure: float, ev: float = 0.0) -> Picture:
    """White cores, coloured halos, black background: channels leak and full pixels spill."""
    return develop(image, exposure, ev)


ACES_IN = np.array(
    [[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]]
)
ACES_OUT = np.array(
    [[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]]
)


@_add("aces")
def aces(light: Image) -> Image:
    """The cinema's tone curve: deep blacks and vivid halos.

    Hill's fit of the ACES reference and output transforms (in BakingLab, 2016).
    """
    x = cast(Image, cv2.transform(light, ACES_IN))
    y = (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081)
    return cast(Image, cv2.transform(y.astype(np.float32), ACES_OUT))


AGX_IN = np.array([
    [0.842479062253094, 0.0784335999999992, 0.0792237451477643],
    [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
    [0.0423756549057051, 0.0784336, 0.879142973793104],
])  # fmt: skip
AGX_OUT = np.linalg.inv(AGX_IN)
AGX_LOW, AGX_HIGH = -12.47393, 4.026069
"""Stops below and above middle grey, as powers of 2."""
AGX_CURVE = (15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232)
PUNCH = 1.35, 1.4
"""Power and saturation of the punchy variant."""


@_add("agx")
def agx(light: Image) -> Image:
    """The look of Blender: colours fade gently to white; the punchy variant.

    Sobotka's AgX (2022) with Wrensch's polynomial for its curve (Minimal AgX implementation, 2023).
    """
    x = cast(Image, cv2.transform(light, AGX_IN))
    stops = np.clip(np.log2(np.maximum(x, 1e-10)), AGX_LOW, AGX_HIGH)
    share = (stops - AGX_LOW) / (AGX_HIGH - AGX_LOW)
    y = np.full_like(share, AGX_CURVE[0])
    for coefficient in AGX_CURVE[1:]:
        y = y * share + coefficient
    y = np.maximum(y, 0.0) ** PUNCH[0]
    grey = (y @ np.array([0.2126, 0.7152, 0.0722], y.dtype))[..., None]
    y = grey + PUNCH[1] * (y - grey)
    shown = cast(Image, cv2.transform(np.maximum(y, 0.0).astype(np.float32), AGX_OUT))
    return np.maximum(shown, 0.0) ** np.float32(2.2)


@_add("clip")
def clip(light: Image) -> Image:
    """A plain sensor: each channel is clipped at 1, so pure colours never turn white."""
    return light


def _developed(look: Look, image: Image, exposure: float, ev: float) -> Picture:
    gain = exposure * 2.0**ev
    if not (np.isfinite(gain) and gain > 0.0):
        raise DqpaintError(f"exposure {exposure:g} at {ev:g} EV is not a positive number")
    if not np.isfinite(cv2.sumElems(image)).all():
        raise DqpaintError("the image has a value that is not finite")
    picture = np.empty(image.shape, dtype=np.uint8)
    for top in range(0, len(image), STRIP_ROWS):
        rows = slice(top, top + STRIP_ROWS)
        shown = look(image[rows] * np.float32(gain))
        shown = np.where(image[rows].any(axis=2, keepdims=True), shown, np.float32(0.0))
        picture[rows] = encode(np.clip(shown, 0.0, 1.0).astype(np.float32))
    return picture


def with_noise(image: Image, exposure: float, seed: int) -> Image:
    """The image with sensor noise: shot noise of the electrons and read noise.

    A pixel that is full holds 50,000 electrons; those that come are Poisson distributed (here: a
    Gaussian of the same variance), and reading adds 3.

    Args:
        image: (H, W, 3) linear RGB.
        exposure: Factor that makes 1 saturate the sensor.
        seed: Of the noise.
    """
    random = np.random.default_rng(seed)
    electrons = image * np.float32(exposure * FULL_WELL)
    spread = np.sqrt(electrons + np.float32(READ_NOISE * READ_NOISE))
    noisy = electrons + spread * random.standard_normal(image.shape, dtype=np.float32)
    return np.asarray(np.maximum(noisy, 0.0) / np.float32(exposure * FULL_WELL), dtype=np.float32)


FULL_WELL = 50_000.0
READ_NOISE = 3.0
