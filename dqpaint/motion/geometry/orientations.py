"""Positions along a stroke -> orientation, angular velocity and its derivative."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol, Self

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.motion.geometry.paths import (
    BatchedParameters,
    Indices,
    Lines,
    Positions,
    column,
    paths_of,
)
from dqpaint.program import (
    Arc,
    FixedOrientation,
    FollowHeading,
    Look,
    LookLine,
    Segment,
    SlerpOrientation,
)

Turns = tuple[Floats, Floats, Floats]  # r (N, 4), w (N, 3) [rad per f], its derivative (N, 3)


class Spin(Protocol):
    """The orientation over f (N,), at positions (4, N, 3)."""

    @property
    def uniform(self) -> bool:
        """Whether the angular speed over f is constant."""

    def select(self, rows: Indices | int) -> Self:
        """The parameters of some strokes, one row each, or of one stroke."""

    def largest_parameter_along(self, places: Positions, /) -> Floats:
        """The largest number along positions (K,), as in `Positions.largest_parameter`."""

    def __call__(self, f: Floats, at: Floats, /) -> Turns:
        """Orientation, angular velocity, and its derivative."""


def orientation_along(segments: Sequence[Segment], places: Positions) -> Spin:
    """The orientation of segments of one kind along their positions, if not a single screw."""
    first = segments[0].tool
    r0 = column([segment.start.orientation for segment in segments])
    if isinstance(first, FixedOrientation):
        return Turning(r0, np.zeros((len(segments), 3)))
    if isinstance(first, SlerpOrientation):
        r1 = column([segment.end.orientation for segment in segments])
        step = dq.quaternion_mul(r1, r0 * dq.C4)
        return Turning(r0, 2 * dq.log(dq.pose_from(np.zeros((len(segments), 3)), step))[:, :3])
    if isinstance(first, Look):
        looks = [s.tool for s in segments if isinstance(s.tool, Look)]
        return LookAtPoint(column([t.point for t in looks]), column([t.up for t in looks]))
    if isinstance(first, LookLine):
        at = [s.tool for s in segments if isinstance(s.tool, LookLine)]
        return LookAtLine(column([t.point for t in at]), column([t.along for t in at]))
    arcs = paths_of(segments, Arc)
    if arcs:
        return Turning(r0, column([[a.angle] for a in arcs]) * column([a.axis for a in arcs]))
    assert isinstance(first, FollowHeading)
    return heading(r0[0], np.array(first.axis), places)


@dataclass(frozen=True)
class Turning(BatchedParameters):
    """A constant rotation [rad], axis times angle, over the whole stroke."""

    r0: Floats
    turn: Floats
    uniform: ClassVar[bool] = True

    def largest_parameter_along(self, _places: Positions) -> Floats:
        """The largest of its own parameters."""
        return self.largest_parameter()

    def __call__(self, f: Floats, _at: Floats) -> Turns:
        """The rotation from the first orientation."""
        half = np.concatenate([0.5 * f[:, None] * self.turn, np.zeros((len(f), 3))], axis=1)
        w = np.broadcast_to(self.turn, (len(f), 3))
        return dq.quaternion_mul(dq.exp(half)[:, :4], self.r0), w, np.zeros((len(f), 3))


def heading(r0: Floats, axis: Floats, places: Positions) -> "Heading":
    """The heading of a curve that begins with the orientation r0 (4,)."""
    e1 = _across(axis)
    e2 = dq.cross(axis, e1)
    tangent = places(np.zeros(1))[1, 0]
    return Heading(r0, axis, e1, e2, float(np.arctan2(tangent @ e2, tangent @ e1)))


@dataclass(frozen=True)
class Heading:
    """The rotation about `axis` that follows the tangent's component across it."""

    r0: Floats
    axis: Floats
    e1: Floats
    e2: Floats
    start: float
    uniform: ClassVar[bool] = False

    def select(self, _rows: Indices | int) -> Self:
        """Returns itself: it belongs to a single stroke."""
        return self

    def largest_parameter_along(self, _places: Positions) -> Floats:
        """Infinite: its values have no bound."""
        return np.full(1, np.inf)

    def __call__(self, _f: Floats, at: Floats) -> Turns:
        """From the tangent and its derivatives; FloatingPointError if there is no tangent."""
        x, y = at[1:] @ self.e1, at[1:] @ self.e2  # (3, N): of the place's derivatives
        square = x[0] ** 2 + y[0] ** 2
        if not np.isfinite(at[3]).all() or not (square > 0).all():
            raise FloatingPointError("a heading or one of its derivatives is not finite")
        turning = x[0] * y[1] - y[0] * x[1]
        rate = turning / square
        spread = 2 * (x[0] * x[1] + y[0] * y[1])
        slope = (x[0] * y[2] - y[0] * x[2] - rate * spread) / square
        half = 0.5 * (np.arctan2(y[0], x[0]) - self.start)
        q = np.concatenate([np.cos(half)[:, None], np.sin(half)[:, None] * self.axis], axis=1)
        turned = dq.quaternion_mul(q, self.r0)
        return turned, rate[:, None] * self.axis, slope[:, None] * self.axis


def _across(axis: Floats) -> Floats:
    """A unit vector perpendicular to `axis`."""
    least = np.eye(3)[np.argmin(np.abs(axis))]
    across = dq.cross(axis, least)
    return np.asarray(across / np.linalg.norm(across))


@dataclass(frozen=True)
class LookAtPoint(BatchedParameters):
    """Tool z towards `point`, x = up x z made a unit vector, y = z x x."""

    point: Floats
    up: Floats
    uniform: ClassVar[bool] = False

    def largest_parameter_along(self, places: Positions) -> Floats:
        """A bound that grows near the point, and near its line along `up`."""
        if not isinstance(places, Lines):
            return np.full(1, np.inf)
        start, way = self.point - places.start, -places.by
        lean = _least_distance(dq.cross(self.up, start), dq.cross(self.up, way))
        far = np.sqrt((start**2).sum(1)) + np.sqrt((way**2).sum(1))
        with np.errstate(all="ignore"):  # where it goes through one of them
            steep = (1.0 + far) ** 2 / (lean * np.minimum(1.0, _least_distance(start, way)))
        return np.asarray(np.maximum(self.largest_parameter(), steep**3))

    def __call__(self, _f: Floats, at: Floats) -> Turns:
        """From the position and velocity of the point."""
        z = _unit(np.stack([self.point - at[0], -at[1], -at[2]]))
        x = _unit(_cross(_fixed(self.up, z), z))
        return _frame_rates(x, _cross(z, x), z)


@dataclass(frozen=True)
class LookAtLine(BatchedParameters):
    """Tool z perpendicular to the line and towards it, x along the line, y = z x x."""

    point: Floats
    along: Floats
    uniform: ClassVar[bool] = False

    def largest_parameter_along(self, places: Positions) -> Floats:
        """A bound that grows near the line."""
        if not isinstance(places, Lines):
            return np.full(1, np.inf)
        start, way = (dq.cross(self.along, v) for v in (self.point - places.start, -places.by))
        with np.errstate(all="ignore"):  # where it goes through it
            steep = (1.0 + np.sqrt((way**2).sum(1))) / np.minimum(1.0, _least_distance(start, way))
        return np.asarray(np.maximum(self.largest_parameter(), steep**3))

    def __call__(self, _f: Floats, at: Floats) -> Turns:
        """From the position and velocity of the point."""
        towards = np.stack([self.point - at[0], -at[1], -at[2]])
        z = _unit(towards - (towards * self.along).sum(-1, keepdims=True) * self.along)
        x = _fixed(self.along, z)
        return _frame_rates(x, _cross(z, x), z)


def _least_distance(start: Floats, way: Floats) -> Floats:
    """The least length (K,) of vectors start + f way, 0 <= f <= 1."""
    size = (way**2).sum(1)
    f = np.divide(-(start * way).sum(1), size, out=np.zeros_like(size), where=size > 0.0)
    nearest = start + np.clip(f, 0.0, 1.0)[:, None] * way
    return np.asarray(np.sqrt((nearest**2).sum(1)))


# Vectors that move: (3, N, 3), value and first two derivatives.


def _fixed(vector: Floats, like: Floats) -> Floats:
    """Constant vectors (3,) or (N, 3), with zero derivatives."""
    out = np.zeros_like(like)
    out[0] = vector
    return out


def _unit(a: Floats) -> Floats:
    """The direction of a moving vector: from a = r n, a' = r' n + r n', and its derivative."""
    r = np.sqrt((a[0] ** 2).sum(-1, keepdims=True))
    n = a[0] / r
    r1 = (n * a[1]).sum(-1, keepdims=True)
    n1 = (a[1] - r1 * n) / r
    r2 = (n1 * a[1] + n * a[2]).sum(-1, keepdims=True)
    n2 = (a[2] - r2 * n - 2 * r1 * n1) / r
    return np.stack([n, n1, n2])


def _cross(a: Floats, b: Floats) -> Floats:
    """The vector product of moving vectors, by the product rule."""
    first = dq.cross(a[1], b[0]) + dq.cross(a[0], b[1])
    second = dq.cross(a[2], b[0]) + 2 * dq.cross(a[1], b[1]) + dq.cross(a[0], b[2])
    return np.stack([dq.cross(a[0], b[0]), first, second])


def _frame_rates(x: Floats, y: Floats, z: Floats) -> tuple[Floats, Floats, Floats]:
    """Rates of a moving frame: w = 1/2 sum e x e', and w' = 1/2 sum e x e'' as e' x e' = 0."""
    r = dq.quaternion_from_matrix(np.stack([x[0], y[0], z[0]], axis=-1))
    axes = (x, y, z)
    w = 0.5 * sum(dq.cross(e[0], e[1]) for e in axes)
    w_slope = 0.5 * sum(dq.cross(e[0], e[2]) for e in axes)
    return r, np.asarray(w), np.asarray(w_slope)
