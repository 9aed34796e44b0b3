"""Points in the base frame -> pixels and depths; points to frame -> a camera."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from dqpaint.errors import DqpaintError, UsageError
from dqpaint.light.arrays import Floats, checked_array

NEAREST_DEPTH = 1e-3
"""A point nearer to the pinhole's plane than this is not visible [m]."""
FRAME_FILL = 0.72
"""Share of the picture's limiting dimension that a framed drawing fills."""
DEFAULT_LENS = 40.0 / 36.0
"""Focal length over the long side of the sensor: a 40 mm lens on full frame. It neither flattens a
drawing nor exaggerates its near parts."""
SMALLEST_DRAWING = 0.04
"""A smaller drawing is framed as if it had this size [m]."""
LEAST_SEEN_SHARE = 0.25
"""A drawing whose visible size is a smaller share of its true size is framed as if it had this
share; for example a line that points at the camera."""


class View(NamedTuple):
    """Direction from which the canvas is viewed; (0, 0) is square on.

    Attributes:
        azimuth: How far the viewer has walked to the right round the canvas' y [deg].
        elevation: How far above the canvas' x-z plane, -90 to 90 [deg].
    """

    azimuth: float
    elevation: float


VIEWS = {
    "front": View(0.0, 0.0),
    "iso": View(45.0, float(np.degrees(np.arctan(np.sqrt(0.5))))),
    "side": View(90.0, 0.0),
    "top": View(0.0, 90.0),
}


@dataclass(frozen=True, eq=False)
class Camera:
    """A pinhole camera that looks along -z of its own axes.

    Attributes:
        position: (3,) of the pinhole, base frame [m].
        rotation: (3, 3) rows: the picture's right, its up, and back towards the viewer, as unit
            vectors of the base frame.
        focal: Distance from pinhole to picture [px].
        centre: (2,) pixel that the axis of the lens meets, x right, y down [px].
        width: Columns of the picture.
        height: Rows of the picture.
    """

    position: Floats
    rotation: Floats
    focal: float
    centre: Floats
    width: int
    height: int

    def __post_init__(self) -> None:
        for name, shape in (("position", (3,)), ("rotation", (3, 3)), ("centre", (2,))):
            values = checked_array(f"camera {name}", getattr(self, name), shape)
            object.__setattr__(self, name, values)
        if not np.allclose(self.rotation @ self.rotation.T, np.eye(3), atol=1e-6):
            raise ValueError("the rows of the camera rotation are not orthonormal")
        if np.linalg.det(self.rotation) < 0.0:
            raise ValueError("the camera rotation contains a reflection")
        if not (np.isfinite(self.focal) and self.focal > 0.0):
            raise ValueError(f"camera focal length {self.focal} px must be positive")
        if self.width < 1 or self.height < 1:
            raise UsageError(f"picture size {self.width}x{self.height} must be at least 1x1")

    def scaled(self, scale: float) -> Camera:
        """The same camera with its resolution multiplied by `scale`, rounded up to whole pixels."""
        size = (math.ceil(self.width * scale), math.ceil(self.height * scale))
        centre = (self.centre + 0.5) * scale - 0.5
        return Camera(self.position, self.rotation, self.focal * scale, centre, *size)

    def project(self, points: ArrayLike) -> tuple[Floats, Floats]:
        """Project points to pixels and depths.

            [X Y Z] = rotation (p - position),  x = c_x + f X / -Z,  y = c_y - f Y / -Z

        Args:
            points: (N, 3) base frame [m].

        Returns:
            (N, 2) pixels, x right and y down, pixel centres at integers, and (N,) depths -Z in
            front of the pinhole [m]. Where the depth is not above `NEAREST_DEPTH`, the
            pixel is NaN.
        """
        seen = self.rotation @ np.asarray(points, dtype=np.float64).T
        seen -= (self.rotation @ self.position)[:, None]
        depth = -seen[2]
        pixels = seen[:2]  # in place: of a million points a copy takes longer than the arithmetic
        pixels *= self.focal / np.where(depth > NEAREST_DEPTH, depth, np.nan)
        pixels[0] += self.centre[0]
        np.subtract(self.centre[1], pixels[1], out=pixels[1])
        return pixels.T, depth


def frame_points(
    points: ArrayLike,
    canvas_rotation: ArrayLike,
    view: View,
    size: tuple[int, int],
    lens: float = DEFAULT_LENS,
    distance: float | None = None,
    fill: float = FRAME_FILL,
) -> Camera:
    """The camera that shows all `points` from `view`, centred and as large as `fill` allows.

    Args:
        points: (N, 3) the points to show, base frame [m]: the lit points of the reference, so that
            the picture of the measured motion has the same camera.
        canvas_rotation: (3, 3) columns: the canvas' x (right), y (up) and z (towards the viewer)
            as unit vectors of the base frame.
        view: From where, such as one of `VIEWS`.
        size: Columns and rows of the picture.
        lens: Focal length over the long side of the sensor.
        distance: From the pinhole to the middle of the points [m]; None fills the picture.
        fill: Share of the limiting dimension that they take then.

    Raises:
        DqpaintError: If there is no point, or one is not finite.
    """
    cloud = checked_array("framed point", points, (None, 3))
    if len(cloud) == 0:
        raise DqpaintError("nothing is lit, so there is nothing to frame")
    width, height = size
    if width < 1 or height < 1:
        raise UsageError(f"picture size {width}x{height} must be at least 1x1")
    focal = lens * max(width, height)
    rotation = view_axes(view) @ checked_array("canvas rotation", canvas_rotation, (3, 3)).T

    right, up, back = rotation @ cloud.T
    centre = 0.5 * np.array([width - 1.0, height - 1.0])
    if distance is not None:
        place = np.array([0.5 * float(axis.min() + axis.max()) for axis in (right, up, back)])
        place[2] += distance
        return Camera(place @ rotation, rotation, focal, centre, width, height)
    slopes = fill * 0.5 * np.array([width, height]) / focal  # half the field that is to be filled
    nearest = float(back.max())
    diameter = float(np.linalg.norm([np.ptp(axis) for axis in (right, up, back)]))
    extent = max(SMALLEST_DRAWING, LEAST_SEEN_SHARE * diameter)
    away = max(
        _tightest(right, back, float(slopes[0])),
        _tightest(up, back, float(slopes[1])),
        nearest + 0.5 * extent / float(slopes.min()),
    )
    place = np.array([_middle(right, back, away), _middle(up, back, away), away])
    return Camera(place @ rotation, rotation, focal, centre, width, height)


def view_axes(view: View) -> Floats:
    """The axes (3, 3) of a view, in rows: right, up and back, as unit vectors of the canvas."""
    a, e = np.radians(view)
    right = np.array([np.cos(a), 0.0, -np.sin(a)])  # level at any elevation, so the pole is no case
    back = np.array([np.sin(a) * np.cos(e), np.sin(e), np.cos(a) * np.cos(e)])
    return np.stack([right, np.cross(back, right), back])


def _tightest(across: Floats, back: Floats, slope: float) -> float:
    """The least distance [m] at which a pinhole has all points within +-slope of its axis.

    Point i is inside if |x_i - c| <= slope (d - z_i), which for all i is

        c + slope d >= max(x + slope z),  -c + slope d >= max(-x + slope z);

    the smallest d meets both with equality, so that the points touch both edges.
    """
    return float((across + slope * back).max() + (slope * back - across).max()) / (2.0 * slope)


def _middle(across: Floats, back: Floats, distance: float) -> float:
    """The position across [m] of a pinhole at `distance` that centres the points in the picture.

    The two equations of `_tightest` with d given and the slope unknown: Newton's method on a
    convex function made of straight pieces, which ends after a few steps, on the root's own piece.
    """
    slope, touching = 0.0, (-1, -1)
    for _ in range(50):  # two or three do; points that tie to the last bit must not go on for ever
        high, low = int((across + slope * back).argmax()), int((across - slope * back).argmin())
        if (high, low) == touching:
            break
        touching = (high, low)
        slope = (across[high] - across[low]) / (2.0 * distance - back[high] - back[low])
    return float(across[high] - slope * (distance - back[high]))
