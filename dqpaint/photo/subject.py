"""A picture, its size and a style's parameters -> the subject that styles draw."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dqpaint.core import Registry
from dqpaint.core.arrays import Floats
from dqpaint.program import Colour, PiecewiseCurve

LUMINANCE = np.array([0.2126, 0.7152, 0.0722], dtype=np.float32)
"""Of linear sRGB; ITU-R BT.709."""
Style = Callable[["Subject"], list[PiecewiseCurve]]
STYLES: Registry[Style] = Registry("style")


def in_one_colour(picture: Floats, colour: Colour) -> Floats:
    """The greys of a picture (H, W, 3), sRGB, in shades of a linear colour."""
    shade = np.array(colour) / max(colour)
    return coded((decoded(picture) @ LUMINANCE)[..., None] * shade)


def decoded(picture: Floats) -> Floats:
    """Linear light of sRGB values from 0 to 1."""
    return np.where(picture <= 0.04045, picture / 12.92, ((picture + 0.055) / 1.055) ** 2.4)


def coded(light: Floats) -> Floats:
    """SRGB values of linear light from 0 to 1."""
    safe = np.maximum(light, 0.0031308)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * safe ** (1.0 / 2.4) - 0.055)


@dataclass(frozen=True, eq=False)
class Subject:
    """What a style draws.

    Attributes:
        picture: (H, W, 3) sRGB from 0 to 1.
        width: of the picture on the canvas [m].
        height: [m].
        detail: the distance between neighbouring ways of the light [m].
        dark: sRGB tone below which the picture stays black, 0 to 1.
        angle: direction of what has one [rad], from the canvas' x.
        cross: whether it is drawn a second time, across.
    """

    picture: Floats
    width: float
    height: float
    detail: float
    dark: float = 0.05
    angle: float = 0.0
    cross: bool = False

    @cached_property
    def tone(self) -> Floats:
        """The grey (H, W) of the picture, as sRGB from 0 to 1."""
        return coded(decoded(self.picture) @ LUMINANCE)

    @cached_property
    def lit(self) -> NDArray[np.bool_]:
        """Where any light is wanted (H, W): the brightest channel is not dark."""
        return np.asarray(self.picture.max(axis=2) > self.dark)

    def pixels(self, points: Floats) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Rows and columns of points (N, 2) about the middle [m], y up; the nearest inside."""
        high, wide = self.picture.shape[:2]
        column = np.floor((points[:, 0] / self.width + 0.5) * wide)
        row = np.floor((0.5 - points[:, 1] / self.height) * high)
        return (
            np.clip(row, 0, high - 1).astype(np.int64),
            np.clip(column, 0, wide - 1).astype(np.int64),
        )

    def is_lit(self, points: Floats) -> NDArray[np.bool_]:
        """Whether light is wanted at points (N, 2) about the middle [m]."""
        return np.asarray(self.lit[self.pixels(points)])
