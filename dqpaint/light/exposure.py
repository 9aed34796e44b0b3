"""Automatic exposure: how bright the picture must be for its lines to have white cores."""

from __future__ import annotations

import numpy as np

from dqpaint.light.arrays import Floats
from dqpaint.light.brushes import Light
from dqpaint.light.camera import Camera
from dqpaint.light.spread import PointSpread
from dqpaint.light.trail import bins, trace

CORE = 12.0
"""What the core of the median stroke is exposed to; 1 saturates the sensor. Photographers' usual
settings give 10 to 20 for a small LED."""


def automatic_exposure(light: Light, camera: Camera, psf: PointSpread) -> float:
    """The factor from lamp s / px^2 to sensor saturation that suits `light`.

    A stroke of energy lambda per pixel has a ridge of lambda psf.of_line. Of that, in its strongest
    channel, the median over the lit path length on the picture is put at `CORE`.

    A lamp that stands still has no path length. Its peak is energy x psf.of_point, which is that of
    a line when the energy is laid out over of_line / of_point, about the width of the core; so
    path is measured in pieces of this length, and a shorter stroke counts as one whole piece.

    Args:
        light: What was asked, so that an arm's faults do not change the exposure.
        camera: Where it is seen from.
        psf: How points are spread.

    Returns:
        The factor; 1 if nothing is lit on the picture, as any picture of nothing is black.
    """
    piece = psf.of_line / psf.of_point
    values, lengths = [np.empty(0)], [np.empty(0)]
    for trail in trace(light, camera, margin=0.0):
        for part in bins(trail, piece):
            length = np.where(part.alone, piece, part.length)
            values.append(part.energy.max(axis=0) / length * psf.of_line)
            lengths.append(length)
    ridge = _weighted_median(np.concatenate(values), np.concatenate(lengths))
    return CORE / ridge if ridge > 0.0 else 1.0


def _weighted_median(values: Floats, weights: Floats) -> float:
    """The value that has half of the weight at or below it; 0 if there is none."""
    if len(values) == 0:
        return 0.0
    order = np.argsort(values, kind="stable")
    below = np.cumsum(weights[order])
    return float(values[order[np.searchsorted(below, 0.5 * below[-1])]])
