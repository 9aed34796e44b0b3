"""Positions and orientations of a stroke -> pose and twist over its parameter, closed form.

Every stroke is one screw (Chasles) where the tool goes along rigidly: a line is a screw of infinite
pitch, an arc one of none. There the twist per unit of path is constant. Where the tool does
something else meanwhile, place and orientation are two functions of the same parameter.
"""

from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Protocol, Self

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.motion.geometry.orientations import Spin, Turning
from dqpaint.motion.geometry.paths import BatchedParameters, Indices, Lines, Positions
from dqpaint.motion.geometry.piecewise_paths import Pieces
from dqpaint.program import Pose


@dataclass(frozen=True)
class Flow:
    """Poses (N, 8) along a path, the twist (N, 6) per unit of its parameter, and its derivative."""

    pose: Floats
    twist: Floats
    slope: Floats

    def reparametrised(self, rate: Floats, slope: Floats) -> "Flow":
        """The same poses over a new parameter, from its first and second derivatives (N,)."""
        twist = self.twist * rate[:, None]
        return Flow(self.pose, twist, self.slope * rate[:, None] ** 2 + self.twist * slope[:, None])

    def bends(self, length: Floats) -> "Bends":
        """The same of paths with lengths (N,) [m] that are run through evenly."""
        point, length = dq.translation(self.pose), length[:, None]
        tangent = dq.point_velocity(self.twist, point) / length
        bend = dq.point_acceleration(self.twist, self.slope, point) / length**2
        tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
        bend -= (bend * tangent).sum(1, keepdims=True) * tangent
        return Bends(
            point, tangent, bend, self.twist[:, :3] / length, self.slope[:, :3] / length**2
        )


class Bends(NamedTuple):
    """At places on a path: point (N, 3) [m], and by the length [m] how path and tool turn.

    That is the tangent, the curvature across it [1/m], the turning [rad/m] and its derivative.
    """

    point: Floats
    tangent: Floats
    curvature: Floats
    turn: Floats
    turn_slope: Floats


class Shape(Protocol):
    """Strokes of one kind, as functions of the fraction f in [0, 1] of their own parameter.

    The parameters belong to one stroke, or there is one row per stroke, as in `paths`.
    """

    @property
    def uniform(self) -> bool:
        """Whether the point's speed and the angular speed over f are constant."""

    @property
    def uniform_position(self) -> bool:
        """Whether the point's speed over f is constant, for any rotation."""

    @property
    def straight(self) -> bool:
        """Whether the point moves straight from the first position to the last."""

    def select(self, rows: Indices | int) -> Self:
        """The parameters of some strokes, one row of f each, or of one stroke."""

    def largest_parameter(self) -> Floats:
        """As in `Positions`, (K,)."""

    def flow(self, f: Floats) -> Flow:
        """Pose, twist per unit of f and its derivative at f (N,), in the drawing frame."""

    def speed(self, f: Floats) -> Floats:
        """The speed of the point only [m] (N,), which is faster to compute."""

    def speeds(self, f: Floats) -> tuple[Floats, Floats]:
        """Speed of the point [m] and angular speed [rad] per unit of f (N,)."""

    def points(self, f: Floats) -> Floats:
        """The positions (N, 3) only."""


@dataclass(frozen=True)
class Rigid(BatchedParameters):
    """One screw each: the displacement (K, 6) moves the start pose (K, 8)."""

    start: Floats
    displacement: Floats
    uniform: ClassVar[bool] = True
    uniform_position: ClassVar[bool] = True

    @property
    def straight(self) -> bool:
        """Whether there is no rotation."""
        return not self.displacement[..., :3].any()

    def flow(self, f: Floats) -> Flow:
        """With x = exp(f d / 2) x0 the twist per unit of f is d itself."""
        pose = dq.mul(dq.exp(0.5 * f[:, None] * self.displacement), self.start)
        twist = np.broadcast_to(self.displacement, (len(f), 6))
        return Flow(pose, twist, np.zeros((len(f), 6)))

    def speed(self, f: Floats) -> Floats:
        """The speed of the point [m]."""
        return self.speeds(f)[0]

    def speeds(self, f: Floats) -> tuple[Floats, Floats]:
        """The constant speeds of a screw."""
        velocity = dq.point_velocity(self.displacement, dq.translation(self.start))
        speed, turning = _size(velocity), _size(self.displacement[..., :3])
        return np.broadcast_to(speed, f.shape), np.broadcast_to(turning, f.shape)

    def points(self, f: Floats) -> Floats:
        """The positions, without computing rotations where there are none."""
        if self.straight:
            by = f[:, None] * self.displacement[..., 3:]
            return np.asarray(dq.translation(self.start) + by)
        return dq.translation(self.flow(f).pose)


@dataclass(frozen=True)
class Jump(BatchedParameters):
    """A reference at one pose until the end, then at another; there is no impulse between."""

    start: Floats
    end: Floats
    uniform: ClassVar[bool] = True
    uniform_position: ClassVar[bool] = True
    straight: ClassVar[bool] = True

    def flow(self, f: Floats) -> Flow:
        """The end pose at f = 1 only, and zero twist."""
        still = np.zeros((len(f), 6))
        return Flow(np.where(f[:, None] < 1, self.start, self.end), still, still)

    def speed(self, f: Floats) -> Floats:
        """Zero."""
        return self.speeds(f)[0]

    def speeds(self, f: Floats) -> tuple[Floats, Floats]:
        """Zero."""
        return np.zeros_like(f), np.zeros_like(f)

    def points(self, f: Floats) -> Floats:
        """The two positions."""
        return dq.translation(self.flow(f).pose)


@dataclass(frozen=True)
class PositionAndOrientation:
    """Position and orientation as separate functions."""

    positions: Positions
    orientations: Spin

    @property
    def uniform(self) -> bool:
        """Whether both are uniform."""
        return self.positions.uniform and self.orientations.uniform

    @property
    def uniform_position(self) -> bool:
        """Whether the position is uniform."""
        return self.positions.uniform

    @property
    def straight(self) -> bool:
        """Whether the positions are straight lines."""
        return isinstance(self.positions, Lines)

    def largest_parameter(self) -> Floats:
        """The larger of both."""
        return np.maximum(
            self.positions.largest_parameter(),
            self.orientations.largest_parameter_along(self.positions),
        )

    def select(self, rows: Indices | int) -> Self:
        """A selection of rows of both."""
        return type(self)(self.positions.select(rows), self.orientations.select(rows))

    def flow(self, f: Floats) -> Flow:
        """The spatial twist, from the derivatives of position and orientation."""
        p = self.positions(f)
        r, w, w_slope = self.orientations(f, p)
        twist = dq.twist_from_point(w, p[1], p[0])
        slope = dq.acceleration_from_point(w, w_slope, p[1], p[2], p[0])
        return Flow(dq.pose_from(p[0], r), twist, slope)

    def bends(self, piece: Indices, g: Floats) -> Bends:
        """Of pieces (N,) of piecewise curves at their parameters (N,); each row is a curve."""
        assert isinstance(self.positions, Pieces)
        p = self.positions.by_length(piece, g)
        if isinstance(self.orientations, Turning):
            turn = self.orientations.turn / self.positions.lengths[:, None]
            slope = np.zeros_like(turn)
        else:
            _, turn, slope = self.orientations(g, p)
        return Bends(p[0], p[1], p[2], turn, slope)

    def speed(self, f: Floats) -> Floats:
        """The speed of the point only, which is faster to compute."""
        return _size(self.positions.velocity(f))

    def speeds(self, f: Floats) -> tuple[Floats, Floats]:
        """The speeds of both functions."""
        if isinstance(self.orientations, Turning):
            return self.speed(f), _size(np.broadcast_to(self.orientations.turn, (len(f), 3)))
        p = self.positions(f)
        return _size(p[1]), _size(self.orientations(f, p)[1])

    def points(self, f: Floats) -> Floats:
        """The positions, without the orientation."""
        return self.positions.point(f)


def pose_array(pose: Pose) -> Floats:
    """A pose of the program as a dual quaternion (8,)."""
    return dq.pose_from(pose.position, pose.orientation)


def _size(vectors: Floats) -> Floats:
    return np.asarray(np.sqrt((vectors**2).sum(-1)))
