"""The paths of segments -> positions and derivatives over the fraction of their parameter.

The parameters belong to one stroke, or there is one row per stroke: then each row of the result
uses its own, and the strokes of a whole drawing are computed at once.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol, Self, TypeVar

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.program import Arc, Curve, PiecewiseCurve, Screw, Segment, Straight, Taylor
from dqpaint.program import Indices as Indices


class Positions(Protocol):
    """The position over the fraction f (N,) of its parameter."""

    @property
    def uniform(self) -> bool:
        """Whether the speed over f is constant."""

    def select(self, rows: Indices | int) -> Self:
        """The parameters of some strokes, one row each, or of one stroke."""

    def largest_parameter(self) -> Floats:
        """The largest absolute number of each row (K,).

        As long as it is small nothing that comes out leaves the numbers; infinite where that may
        happen anywhere.
        """

    def point(self, f: Floats) -> Floats:
        """The position (N, 3) [m]."""

    def velocity(self, f: Floats) -> Floats:
        """The first derivative (N, 3) [m] only."""

    def __call__(self, f: Floats) -> Floats:
        """The position and three derivatives (4, N, 3)."""


class BatchedParameters:
    """A formula with arrays as parameters, one row per stroke."""

    def select(self, rows: Indices | int) -> Self:
        """The same formula with some of its rows; a single row applies to every f."""
        return type(self)(*(parameter[rows] for parameter in vars(self).values()))

    def largest_parameter(self) -> Floats:
        """The largest absolute number of each row (K,)."""
        rows = [np.abs(parameter).max(axis=1) for parameter in vars(self).values()]
        return np.asarray(np.max(rows, axis=0))


P = TypeVar("P", Straight, Arc, Curve, Screw, PiecewiseCurve)


def paths_of(segments: Sequence[Segment], kind: type[P]) -> list[P]:
    """The paths of segments that have all this kind of path."""
    return [segment.path for segment in segments if isinstance(segment.path, kind)]


def column(values: Sequence[object]) -> Floats:
    """Numbers, or tuples of equal length, as a column (K, ...)."""
    return np.array(values, dtype=np.float64)


@dataclass(frozen=True)
class Lines(BatchedParameters):
    """Straight lines: p = p0 + f b."""

    start: Floats
    by: Floats
    uniform: ClassVar[bool] = True

    def point(self, f: Floats) -> Floats:
        """The position."""
        return np.asarray(self.start + f[:, None] * self.by)

    def velocity(self, f: Floats) -> Floats:
        """The first derivative."""
        return np.asarray(self(f)[1])

    def __call__(self, f: Floats) -> Floats:
        """The position and its derivatives."""
        out = np.zeros((4, len(f), 3))
        out[0] = self.point(f)
        out[1] = self.by
        return out


@dataclass(frozen=True)
class Arcs(BatchedParameters):
    """Circle and helix: p = c + f rise + r (cos(f A) e1 + sin(f A) e2), r = r0 + f grow.

    c is the foot of the start on the axis, e1 points from there to the start, e2 = axis x e1.
    Vectors are (K, 3), numbers (K, 1).
    """

    foot: Floats
    rise: Floats
    e1: Floats
    e2: Floats
    radius: Floats
    angle: Floats
    grow: Floats
    uniform: ClassVar[bool] = True

    def bounds(self) -> tuple[Floats, Floats]:
        """The least and the greatest coordinates (K, 3) of the arcs' whole circles."""
        way = np.stack([self.foot, self.foot + self.rise])
        size = np.maximum(np.abs(self.radius), np.abs(self.radius + self.grow))
        reach = size * np.sqrt(self.e1**2 + self.e2**2)
        return way.min(axis=0) - reach, way.max(axis=0) + reach

    def point(self, f: Floats) -> Floats:
        """The position."""
        f = f[:, None]
        outward = np.cos(f * self.angle) * self.e1 + np.sin(f * self.angle) * self.e2
        return np.asarray(self.foot + f * self.rise + (self.radius + f * self.grow) * outward)

    def velocity(self, f: Floats) -> Floats:
        """The first derivative."""
        return np.asarray(self(f)[1])

    def __call__(self, f: Floats) -> Floats:
        """The position and its derivatives."""
        f, angle, grow = f[:, None], self.angle, self.grow
        c, s = np.cos(f * angle), np.sin(f * angle)
        outward, along = c * self.e1 + s * self.e2, c * self.e2 - s * self.e1
        r = self.radius + f * grow
        return np.stack([
            self.foot + f * self.rise + r * outward,
            self.rise + grow * outward + angle * r * along,
            2 * angle * grow * along - angle**2 * r * outward,
            -3 * angle**2 * grow * outward - angle**3 * r * along,
        ])  # fmt: skip


@dataclass(frozen=True)
class Spirals(Arcs):
    """Arcs whose radius grows: flat spiral and cone."""

    uniform: ClassVar[bool] = False

    def largest_parameter(self) -> Floats:
        """Infinite: its values have no bound."""
        return np.full(1, np.inf)


def straight_positions(segments: Sequence[Segment]) -> Lines:
    """The positions of straight lines."""
    ways = [path.by for path in paths_of(segments, Straight)]
    return Lines(column([s.start.position for s in segments]), column(ways))


def arc_positions(segments: Sequence[Segment]) -> Arcs:
    """The positions of arcs; all of them have a constant radius, or none."""
    paths = paths_of(segments, Arc)
    p0 = column([s.start.position for s in segments])
    axis = column([path.axis for path in paths])
    arm = p0 - column([path.centre for path in paths])
    foot = p0 - (arm - axis * (arm * axis).sum(-1, keepdims=True))
    radius = np.sqrt(((p0 - foot) ** 2).sum(-1, keepdims=True))
    e1 = (p0 - foot) / radius
    angle = column([path.angle for path in paths])[:, None]
    rise = column([path.rise for path in paths])[:, None]
    grow = column([path.grow for path in paths])[:, None]
    made = Spirals if grow.any() else Arcs
    return made(foot, rise * axis, e1, dq.cross(axis, e1), radius, angle, grow)


@dataclass(frozen=True)
class Formula:
    """The value and exact derivatives of a formula, scaled from its parameter to f.

    It raises FloatingPointError where place, velocity or acceleration is not finite.
    """

    path: Curve
    uniform: ClassVar[bool] = False

    def select(self, _rows: Indices | int) -> Self:
        """Returns itself: it belongs to a single stroke."""
        return self

    def largest_parameter(self) -> Floats:
        """Infinite: its values have no bound."""
        return np.full(1, np.inf)

    def point(self, f: Floats) -> Floats:
        """The position."""
        return np.asarray(self(f)[0])

    def velocity(self, f: Floats) -> Floats:
        """The first derivative, without computing the others."""
        return np.asarray(self._derivatives(f, 1)[1])

    def __call__(self, f: Floats) -> Floats:
        """The position and its derivatives."""
        return self._derivatives(f, 3)

    def _derivatives(self, f: Floats, order: int) -> Floats:
        """The position and its derivatives up to an order (order + 1, N, 3)."""
        path = self.path
        span = path.upper - path.lower
        scale = np.array([1.0, span, span**2, span**3])[: order + 1, None, None]
        with np.errstate(all="ignore"):
            point = path.formula(Taylor.variable(path.lower + f * span, order))
            derivatives: Floats = np.stack([c.derivatives for c in point], axis=-1) * scale
        if not np.isfinite(derivatives[:3]).all():
            raise FloatingPointError("a formula or one of its derivatives is not finite")
        return derivatives
