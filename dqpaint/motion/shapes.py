"""What a stroke is as a motion: pose and twist over the fraction of its path, in closed form.

Every stroke is one screw (Chasles) where the tool goes along rigidly: a line is a screw of infinite
pitch, an arc one of none. There the twist per unit of path is constant. Where the tool does
something else meanwhile, place and orientation are two functions of the same parameter.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.language.program import (
    Arc,
    Chain,
    Curve,
    Follow,
    Keep,
    Pose,
    Screw,
    ScrewTo,
    Segment,
    Step,
    Still,
    Straight,
)
from dqpaint.motion.chains import place_chain
from dqpaint.motion.orientations import Spin, orientation
from dqpaint.motion.places import Places, place_arc, place_curve, place_straight


@dataclass(frozen=True)
class Flow:
    """Poses (N, 8) along a path, the twist (N, 6) per unit of its parameter, and its derivative."""

    pose: Floats
    twist: Floats
    slope: Floats

    def at_rates(self, rate: Floats, slope: Floats) -> "Flow":
        """The same poses over another parameter, given its first and second derivative (N,)."""
        twist = self.twist * rate[:, None]
        return Flow(self.pose, twist, self.slope * rate[:, None] ** 2 + self.twist * slope[:, None])


class Shape(Protocol):
    """A stroke as a function of the fraction f in [0, 1] of its own parameter."""

    def flow(self, f: Floats) -> Flow:
        """Pose, twist per unit of f and its derivative at f (N,), in the drawing frame."""

    def speeds(self, f: Floats) -> tuple[Floats, Floats]:
        """Speed of the point [m] and of the tool's turning [rad] per unit of f (N,)."""


@dataclass(frozen=True)
class Rigid:
    """One screw: the displacement (6,) carries the start pose (8,) along."""

    start: Floats
    displacement: Floats

    def flow(self, f: Floats) -> Flow:
        """With x = exp(f d / 2) x0 the twist per f is d itself."""
        pose = dq.mul(dq.exp(0.5 * f[:, None] * self.displacement), self.start)
        twist = np.tile(self.displacement, (len(f), 1))
        return Flow(pose, twist, np.zeros_like(twist))

    def speeds(self, f: Floats) -> tuple[Floats, Floats]:
        """A screw runs evenly."""
        velocity = dq.point_velocity(self.displacement, dq.translation(self.start))
        speeds = np.linalg.norm(velocity), np.linalg.norm(self.displacement[:3])
        return np.full(len(f), speeds[0]), np.full(len(f), speeds[1])


@dataclass(frozen=True)
class Jump:
    """A set point that is at one pose until the end, then at another; no impulse is invented."""

    start: Floats
    end: Floats

    def flow(self, f: Floats) -> Flow:
        """The end pose at f = 1 alone, and no twist."""
        still = np.zeros((len(f), 6))
        return Flow(np.where(f[:, None] < 1, self.start, self.end), still, still)

    def speeds(self, f: Floats) -> tuple[Floats, Floats]:
        """None."""
        return np.zeros_like(f), np.zeros_like(f)


@dataclass(frozen=True)
class Loose:
    """Place and orientation apart."""

    places: Places
    spin: Spin

    def flow(self, f: Floats) -> Flow:
        """The spatial twist from the point's and the orientation's own derivatives."""
        p = self.places(f)
        r, w, w_slope = self.spin(f, p)
        twist = dq.twist_from_point(w, p[1], p[0])
        slope = dq.acceleration_from_point(w, w_slope, p[1], p[2], p[0])
        return Flow(dq.pose_from(p[0], r), twist, slope)

    def speeds(self, f: Floats) -> tuple[Floats, Floats]:
        """Of the two functions."""
        p = self.places(f)
        w = self.spin(f, p)[1]
        return np.sqrt((p[1] ** 2).sum(1)), np.sqrt((w**2).sum(1))


def pose_array(pose: Pose) -> Floats:
    """The language's pose as a dual quaternion (8,)."""
    return dq.pose_from(pose.position, pose.orientation)


def shape(segment: Segment) -> Shape:
    """The stroke of one segment."""
    start = pose_array(segment.start)
    path, tool = segment.path, segment.tool
    if isinstance(path, Screw):
        return Rigid(start, _screw(path.point, path.axis, path.angle, path.advance))
    if isinstance(path, ScrewTo):
        return Rigid(start, 2 * dq.log(dq.mul(pose_array(segment.end), dq.conj(start))))
    if isinstance(path, Still):
        return Rigid(start, np.zeros(6))
    if isinstance(path, Step):
        return Jump(start, pose_array(segment.end))
    if isinstance(path, Straight) and isinstance(tool, Keep | Follow):
        return Rigid(start, np.concatenate([np.zeros(3), path.by]))
    if isinstance(path, Arc) and isinstance(tool, Follow) and path.grow == 0:
        return Rigid(start, _screw(path.centre, path.axis, path.angle, path.rise))
    places = _places(segment)
    return Loose(places, orientation(segment, places))


def _screw(
    point: tuple[float, ...], axis: tuple[float, ...], angle: float, advance: float
) -> Floats:
    """The displacement (6,) of a turn and an advance along one line; the angle may be zero."""
    turn = angle * dq.twist_from_screw(axis, point)
    return turn + advance * np.concatenate([np.zeros(3), axis])


def _places(segment: Segment) -> Places:
    path = segment.path
    if isinstance(path, Arc):
        return place_arc(path, segment.start.position)
    if isinstance(path, Curve):
        return place_curve(path)
    if isinstance(path, Chain):
        return place_chain(path)
    assert isinstance(path, Straight)
    return place_straight(path, segment.start.position)
