"""Many short steps -> fewer steps that the camera cannot distinguish from them."""

from __future__ import annotations

import numpy as np

from dqpaint.light.arrays import Floats
from dqpaint.light.camera.camera import NEAREST_DEPTH, Camera

LONGEST_MERGED = 0.25
"""Largest length of merged steps, as the camera sees it [px]: light may move by half of it along
its own path, much less than the spreading."""
MOST_MERGED = 64
"""Largest number of steps merged into one."""


def merge_short_steps(
    points: Floats, energy: Floats, camera: Camera, margin: float
) -> tuple[Floats, Floats]:
    """The same light in fewer steps, if all steps are short.

    Every so many steps become one straight step with their energy, added up.

    Args:
        points: (N+1, 3) where the lamp is, base frame [m].
        energy: (N, 3) of the steps between.
        camera: Where it is seen from.
        margin: How far outside the picture light still counts [px].

    Returns:
        Points (M+1, 3) and energies (M, 3), M <= N.
    """
    many = _mergeable_steps(points, camera, margin)
    if many < 2:
        return points, energy
    whole = len(energy) - len(energy) % many
    fold = np.tile(np.eye(3), (many, 1))  # a product with ones: a tenth of the time of a sum
    sums = energy[:whole].reshape(-1, 3 * many) @ fold
    if whole < len(energy):
        sums = np.vstack([sums, energy[whole:].sum(axis=0)])
    return np.concatenate([points[:-1:many], points[-1:]]), sums


def _mergeable_steps(points: Floats, camera: Camera, margin: float) -> int:
    """The number of consecutive steps that always stay shorter than `LONGEST_MERGED`.

    A step dp at a depth Z and a slope s = (X, Y) / Z is seen as f / Z |dX, dY - s dZ|, which is at
    most f / Z |dp| sqrt(1 + s^2).
    """
    import cv2  # a third of numpy's time; late, as a forecast reads this and takes no picture

    step = np.sqrt(3.0) * cv2.norm(points[1:], points[:-1], cv2.NORM_INF)
    depth = (camera.position - points[::MOST_MERGED]) @ camera.rotation[2]
    nearest = float(depth.min()) - MOST_MERGED * step
    if nearest <= NEAREST_DEPTH:
        return 1
    size = np.array([camera.width, camera.height])
    corner = np.maximum(camera.centre, size - camera.centre) + margin
    slope = float(np.sqrt((corner**2).sum())) / camera.focal
    seen = camera.focal / nearest * step * np.sqrt(1.0 + slope * slope)
    most = min(MOST_MERGED, len(points) - 1)
    return min(int(LONGEST_MERGED / seen), most) if seen > 0.0 else most
