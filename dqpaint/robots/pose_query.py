"""An arm and a posture -> its pose, screw, Jacobian and manipulability, also as JSON."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from dqpaint import __version__, dq
from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.robots.kinematics.kinematics import Kinematics, manipulability
from dqpaint.robots.model.card import Card
from dqpaint.robots.model.fields import Mount

LARGEST_ANGLE = 1e6  # [rad]; beyond it an angle is a slip, and its turns no longer exact
LEAST_TURN = 1e-9  # [rad] below which a screw is a translation


@dataclass(frozen=True)
class Screw:
    """The screw motion from the base frame to a pose, the short way.

    Attributes:
        axis: unit direction (3,); of a pure translation the way it goes.
        point: of the axis the nearest to the origin (3,) [m]; None of a pure translation.
        angle: [rad], 0 to pi.
        advance: along the axis [m].
    """

    axis: Floats
    point: Floats | None
    angle: float
    advance: float

    @property
    def pitch(self) -> float | None:
        """The advance per radian [m/rad]; None for a pure translation."""
        return None if self.point is None else self.advance / self.angle


@dataclass(frozen=True)
class PoseReport:
    """An arm in a posture: the pose of its tool or flange, and its mobility there."""

    card: Card
    flange: bool
    posture: Floats
    pose: Floats
    jacobian: Floats
    notes: tuple[str, ...]

    @property
    def limit_violations(self) -> list[str]:
        """The joints beyond their limits, one sentence each."""
        limits = zip(*np.degrees([self.posture, self.card.lower, self.card.upper]), strict=True)
        return [
            f"joint {i} at {angle:.6g} deg is beyond its limits, {low:.6g} to {high:.6g} deg"
            for i, (angle, low, high) in enumerate(limits, 1)
            if not low - 1e-9 <= angle <= high + 1e-9
        ]


def pose_arm(card: Card, posture: Floats, flange: bool) -> PoseReport:
    """The pose and Jacobian of a card's tool, or of its bare last link, at a posture (n,) [rad]."""
    arm = Kinematics(card.model_copy(update={"tool": Mount()}) if flange else card)
    pose, jacobian = arm.pose_and_jacobian(posture)
    pose = dq.nearest(pose, dq.IDENTITY)
    return PoseReport(card, flange, posture, pose, jacobian, arm.notes)


def read_posture(card: Card, deg: str | None, rad: str | None) -> Floats:
    """The posture (n,) [rad] of the given angles; by default the home posture.

    Raises:
        UsageError: both are given, something is no number, or the count is wrong.
    """
    if deg is not None and rad is not None:
        raise UsageError("give the joints with --deg or with --rad, not with both")
    text, option = (deg, "--deg") if deg is not None else (rad, "--rad")
    if text is None:
        return card.home
    angles = []
    for word in text.replace(",", " ").split():
        try:
            angles.append(float(word))
        except ValueError:
            raise UsageError(f"{option}: '{word}' is not a number") from None
        if not math.isfinite(angles[-1]):
            raise UsageError(f"{option}: '{word}' is not an angle")
    if len(angles) != card.joints:
        count = "1 angle" if len(angles) == 1 else f"{len(angles)} angles"
        raise UsageError(f"{card.name} has {card.joints} joints, but {option} gives {count}")
    posture = np.radians(angles) if deg is not None else np.array(angles)
    if np.abs(posture).max(initial=0.0) > LARGEST_ANGLE:
        raise UsageError(f"{option} '{text[:60]}': angles must be within +-{LARGEST_ANGLE:g} rad")
    return posture


def screw_from_pose(pose: Floats) -> Screw:
    """The screw of a pose (8,): 2 log(x) = [theta l; d l + theta m], m = p x l."""
    displacement = 2.0 * dq.log(pose)
    angle = float(np.linalg.norm(displacement[:3]))
    if angle < LEAST_TURN:
        way = dq.translation(pose)
        length = float(np.linalg.norm(way))
        return Screw(way / length if length > 0 else np.array([0.0, 0, 1]), None, 0.0, length)
    axis = displacement[:3] / angle
    advance = float(axis @ displacement[3:])
    moment = (displacement[3:] - advance * axis) / angle
    return Screw(axis, dq.cross(axis, moment), angle, advance)


def as_json(report: PoseReport) -> dict[str, Any]:
    """The whole report in SI units; null for values that a pure translation does not have."""
    screw = screw_from_pose(report.pose)
    return {
        "version": 1,
        "tool": f"dqpaint {__version__}",
        "robot": report.card.name,
        "frame": "flange" if report.flange else "tool",
        "posture_rad": report.posture.tolist(),
        "pose": report.pose.tolist(),
        "matrix": dq.matrix_from_pose(report.pose).tolist(),
        "screw": {
            "axis": screw.axis.tolist(),
            "point_m": None if screw.point is None else screw.point.tolist(),
            "angle_rad": screw.angle,
            "advance_m": screw.advance,
            "pitch_m_rad": screw.pitch,
        },
        "jacobian": report.jacobian.tolist(),
        "manipulability": float(manipulability(report.jacobian)),
        "warnings": report.limit_violations,
        "notes": list(report.notes),
    }
