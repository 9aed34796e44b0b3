"""Steps of a lamp on the picture plane -> the linear map of their energies to the image, and back.

The film's own deposit (`light.film.film`) and spread (`light.film.point_spread`) as one matrix and
its transpose, for one rectangle of the picture. The spread runs on the same pyramid; a rim of
zeros on each of its levels makes every part of it symmetric: pyrUp is then four times the transpose
of pyrDown, and a Gaussian with zeros around is its own. So <A w, f> = <w, A' f> to rounding.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, cast

import cv2
import numpy as np
from numpy.typing import NDArray

from dqpaint.light.arrays import Floats
from dqpaint.light.film.film import SPLINE_VARIANCE, spline_weights
from dqpaint.light.film.point_spread import BORDER, PointSpread, pyramid_level

RIM = 3
"""Pixels of zeros around each level of the pyramid: one more than its filters reach beyond it."""
GUARD = 12
"""Pixels around the box on each level: the rim, twice as wide on the next, and what light needs
that goes from level to level."""
WIDER = GUARD // 2
"""Pixels that are added on each side after a level was made half as large."""
LONGEST_PIECE = 1.0
"""Distance between the deposits of one step [px], as on the film."""


@dataclass(frozen=True)
class Box:
    """A rectangle of the picture: its first column and row, its width and height [px]."""

    left: int
    top: int
    width: int
    height: int


@dataclass(frozen=True, eq=False)
class Exposing:
    """The map A from the energies of K steps (K, C) to the image (H, W, C) in a box, and A'.

    Attributes:
        start: (K, 2) where each step begins in the picture, x and y [px].
        end: (K, 2) where it ends.
        box: the part of the picture.
        psf: how the lens spreads a point.
        dtype: float32 for speed, float64 for proofs.
    """

    start: Floats
    end: Floats
    box: Box
    psf: PointSpread
    dtype: type[np.floating] = np.float32
    _gather: Any = field(init=False, repr=False)
    _scatter: Any = field(init=False, repr=False)
    _levels: tuple[tuple[int, float, float], ...] = field(init=False, repr=False)
    _shape: tuple[int, int] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        sharp = (math.sqrt(s * s - SPLINE_VARIANCE) for s in self.psf.widths)
        levels = tuple(
            (*pyramid_level(s), weight) for s, weight in zip(sharp, self.psf.weights, strict=True)
        )
        object.__setattr__(self, "_levels", levels)
        object.__setattr__(
            self, "_shape", (self.box.height + 2 * GUARD, self.box.width + 2 * GUARD)
        )
        scatter = self._deposits()
        object.__setattr__(self, "_scatter", scatter)
        object.__setattr__(self, "_gather", scatter.T.tocsr())

    def expose(self, energy: Floats) -> Floats:
        """The image (H, W, C) of energies (K, C): A w."""
        film = (self._scatter @ energy.astype(self.dtype)).reshape(*self._shape, -1)
        return _inner(self._spread(film))

    def back(self, image: Floats) -> Floats:
        """What an image (H, W, C) means for each step (K, C): A' f."""
        film = np.zeros((*self._shape, image.shape[2]), self.dtype)
        _inner(film)[:] = image
        return np.asarray(self._gather @ self._spread(film).reshape(-1, image.shape[2]))

    def _deposits(self) -> Any:
        """The sparse matrix (pixels, K): each step in even pieces, each over 3x3 pixels."""
        from scipy import sparse

        way = self.end - self.start
        count = np.maximum(1, np.ceil(np.hypot(*way.T) / LONGEST_PIECE)).astype(np.int64)
        step = np.repeat(np.arange(len(count)), count)
        nth = np.arange(len(step)) - np.repeat(np.cumsum(count) - count, count)
        at = self.start[step] + ((nth + 0.5) / count[step])[:, None] * way[step]
        at += GUARD - np.array([self.box.left, self.box.top])
        column, row = np.rint(at).T
        across, down = spline_weights(at[:, 0] - column), spline_weights(at[:, 1] - row)
        high, wide = self._shape
        around = np.array([-1, 0, 1])
        rows = row.astype(np.int64) + around[:, None]
        columns = column.astype(np.int64) + around[:, None]
        pixel = rows[:, None] * wide + columns[None, :]
        weight = down[:, None] * across[None, :] / count[step]
        kept = ((rows >= RIM) & (rows < high - RIM))[:, None]
        kept = kept & ((columns >= RIM) & (columns < wide - RIM))[None, :]
        steps = np.broadcast_to(step, pixel.shape)
        return sparse.csr_matrix(
            (weight[kept].astype(self.dtype), (pixel[kept], steps[kept])),
            shape=(high * wide, len(count)),
        )

    def _spread(self, film: Floats) -> Floats:
        """The film spread by the lens; its own transpose."""
        pyramid = [_rimmed(film)]
        for _ in range(max(level for level, _, _ in self._levels)):
            pyramid.append(_widened(_rimmed(cast(Floats, cv2.pyrDown(pyramid[-1])))))
        total: Floats | None = None
        for level in reversed(range(len(pyramid))):
            image = pyramid[level]
            summed = np.zeros_like(image)
            if total is not None:
                high, wide = image.shape[:2]
                small = np.ascontiguousarray(total[WIDER:-WIDER, WIDER:-WIDER])
                summed += _rimmed(cast(Floats, cv2.pyrUp(_rimmed(small), dstsize=(wide, high))))
            for at, blur, weight in self._levels:
                if at == level:
                    blurred = cv2.GaussianBlur(image, (0, 0), blur, borderType=BORDER)
                    summed += self.dtype(weight) * blurred.reshape(image.shape)
            total = summed
        assert total is not None
        return total


def _widened(image: Floats) -> Floats:
    """The image with more zeros around it."""
    return np.pad(image, ((WIDER, WIDER), (WIDER, WIDER), (0, 0)))


def _inner(film: Floats) -> Floats:
    return film[GUARD:-GUARD, GUARD:-GUARD]


def _rimmed(image: Floats) -> Floats:
    """The image with zeros around, in place; (H, W, C) whatever OpenCV made of one channel."""
    image = image[..., None] if image.ndim == 2 else image
    image[:RIM] = image[-RIM:] = 0.0
    image[:, :RIM] = image[:, -RIM:] = 0.0
    return image


def boxed(points: NDArray[np.float64], size: tuple[int, int]) -> Box:
    """The smallest box round points (N, 2) [px] within a picture of (width, height)."""
    low = np.clip(np.floor(points.min(axis=0)).astype(int), 0, np.array(size) - 1)
    high = np.clip(np.ceil(points.max(axis=0)).astype(int), low, np.array(size) - 1)
    return Box(int(low[0]), int(low[1]), *(high - low + 1).tolist())
