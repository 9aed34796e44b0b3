"""Film -> image: the lens spreads every point of light into a core with halos.

The point spread is a sum of five Gaussians. Real lenses have a sharp core on wings that fall with
r^-2 to r^-3 (Spencer et al., Physically-based glare effects for digital images, SIGGRAPH 1995), and
Gaussians whose widths grow threefold follow such wings closely. They are blurred on a pyramid of
pictures, each half as large as the one before, because there the wide ones are narrow.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import cast

import cv2
import numpy as np

from dqpaint.light.arrays import Floats, Image
from dqpaint.light.film.film import PAD, SPLINE_VARIANCE, Film

REFERENCE_HEIGHT = 1080
"""Rows of the picture for which the widths and energies below are given."""
CORE_AND_HALO_WIDTHS = (1.35, 4.0, 12.0, 36.0, 108.0)
"""Standard deviations of the core and of the halos [px]."""
HALO_ENERGIES = (0.15, 0.065, 0.04, 0.03)
"""Energy in each halo; the core has the rest. Chosen by eye."""
NARROWEST_CORE = 1.35
"""Least standard deviation of the core: at this width the ridge of a slanted line ripples by 0.9 %,
at 1.25 by 1.3 % [px]."""
WIDEST_LEVEL_BLUR = 2.5
"""Widest blur on one level of the pyramid [px there]; wider blurs are done on a lower level."""
BORDER = cv2.BORDER_CONSTANT
"""OpenCV's border mode: light that leaves the film does not come back."""


@dataclass(frozen=True)
class PointSpread:
    """Point spread function: sum_i w_i exp(-r^2 / 2 s_i^2) / (2 pi s_i^2).

    Attributes:
        widths: s_i, the film's own B-spline included [px].
        weights: w_i, energy in each; they add up to 1.
    """

    widths: tuple[float, ...]
    weights: tuple[float, ...]

    @property
    def point_peak(self) -> float:
        """Peak value of a unit of energy at one point [1/px^2]."""
        pairs = zip(self.widths, self.weights, strict=True)
        return sum(w / (2.0 * math.pi * s * s) for s, w in pairs)

    @property
    def line_peak(self) -> float:
        """Peak value across a long straight line of one unit of energy per pixel [1/px].

        The integral of the point's image along a line through it: sum_i w_i / (s_i sqrt(2 pi)).
        """
        pairs = zip(self.widths, self.weights, strict=True)
        return sum(w / (s * math.sqrt(2.0 * math.pi)) for s, w in pairs)


def point_spread(height: int) -> PointSpread:
    """The point spread for a picture of `height` rows; it scales with the picture.

    A small picture cannot have a core as narrow as its size asks for. Its lines are then wider
    and, exposed to the same ridge, would have stronger halos. So halos give part of their energy,
    1 - a, to the core, such that each keeps its height beside the ridge of a line:

        (a w_i / k s_i) / ((1 - a h) / core) = (w_i / s_i) / ((1 - h) / s_0),  h = sum of halos w_i
    """
    scale = height / REFERENCE_HEIGHT
    core = max(NARROWEST_CORE, CORE_AND_HALO_WIDTHS[0] * scale)
    sharp, h = CORE_AND_HALO_WIDTHS[0] * scale / core, sum(HALO_ENERGIES)
    a = sharp / (1.0 - h + sharp * h)
    halos = tuple(a * w for w in HALO_ENERGIES)
    widths = tuple(max(core, s * scale) for s in CORE_AND_HALO_WIDTHS)
    return PointSpread(widths, (1.0 - sum(halos), *halos))


def spread(film: Film, psf: PointSpread) -> Image:
    """Spread a film to an image (H, W, 3), linear RGB without the guard band [lamp s / px^2].

    pyrDown's [1 4 6 4 1]/16 falls evenly on both phases, so that energy and centroid survive
    exactly and each way adds a variance of 1 px^2 a level; at level L the Gaussian that is left to
    do has the width sqrt(s^2 - 2 (4^L - 1) / 3) / 2^L.
    """
    sharp = [math.sqrt(s * s - SPLINE_VARIANCE) for s in psf.widths]
    levels = [pyramid_level(s)[0] for s in sharp]
    pyramid = [_interleaved(film.planes)]
    for _ in range(max(levels)):
        pyramid.append(cast(Image, cv2.pyrDown(pyramid[-1])))

    total: Image | None = None
    for level in reversed(range(len(pyramid))):
        image = pyramid[level]
        halos = [
            (weight, cv2.GaussianBlur(image, (0, 0), _level_blur(s, level), borderType=BORDER))
            for s, weight, at in zip(sharp, psf.weights, levels, strict=True)
            if at == level
        ]
        if total is None:
            image.fill(0.0)
        else:  # in place of what is blurred by now: fresh memory costs more than arithmetic
            cv2.pyrUp(total, image, dstsize=(image.shape[1], image.shape[0]))
        for weight, halo in halos:
            cv2.scaleAdd(halo, weight, image, image)
        total = image
    assert total is not None
    return total[PAD:-PAD, PAD:-PAD]


def _level_blur(width: float, level: int) -> float:
    """Blur left for a level of the pyramid, for a Gaussian of `width` in total [px there].

    NaN where the pyramid alone is already wider.
    """
    left = width * width - 2.0 * (4.0**level - 1.0) / 3.0
    return math.sqrt(left) / 2.0**level if left >= 0.0 else math.nan


def pyramid_level(width: float) -> tuple[int, float]:
    """The level of the pyramid on which a Gaussian of `width` is applied, and its blur there."""
    blurs = ((level, _level_blur(width, level)) for level in range(32))
    return next((level, blur) for level, blur in blurs if blur <= WIDEST_LEVEL_BLUR)


def _interleaved(planes: Floats) -> Image:
    """Planes (3, H, W) float64 as (H, W, 3) float32, the layout of OpenCV."""
    image = np.empty((*planes.shape[1:], 3), dtype=np.float32)
    for channel, plane in enumerate(planes):
        image[..., channel] = plane
    return image
