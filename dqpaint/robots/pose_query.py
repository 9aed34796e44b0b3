"""What `pose` says of an arm in one posture, for people and for programs."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from dqpaint import __version__, dq
from dqpaint.cli.terminal import table
from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.robots.kinematics.kinematics import Kinematics, manipulability
from dqpaint.robots.model.card import Card
from dqpaint.robots.model.fields import Mount

FARTHEST = 1e6  # [rad]; beyond it an angle is a slip, and its turns no longer exact
NO_TURN = 1e-9  # [rad] below which a screw is a translation


@dataclass(frozen=True)
class Screw:
    """The screw that carries the base frame to a pose, the short way.

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
        """The advance for each radian [m/rad]; None of a pure translation."""
        return None if self.point is None else self.advance / self.angle


@dataclass(frozen=True)
class Posed:
    """An arm in a posture: where its tool or flange is, and how it can move from there."""

    card: Card
    flange: bool
    posture: Floats
    pose: Floats
    jacobian: Floats
    notes: tuple[str, ...]

    @property
    def beyond(self) -> list[str]:
        """The joints beyond their limits, a sentence each."""
        limits = zip(*np.degrees([self.posture, self.card.lower, self.card.upper]), strict=True)
        return [
            f"joint {i} at {angle:.6g} deg is beyond its limits, {low:.6g} to {high:.6g} deg"
            for i, (angle, low, high) in enumerate(limits, 1)
            if not low - 1e-9 <= angle <= high + 1e-9
        ]


def pose_arm(card: Card, posture: Floats, flange: bool) -> Posed:
    """The pose and Jacobian of a card's tool, or of its bare last link, at a posture (n,) [rad]."""
    arm = Kinematics(card.model_copy(update={"tool": Mount()}) if flange else card)
    pose, jacobian = arm.pose_and_jacobian(posture)
    pose = dq.nearest(pose, dq.IDENTITY)
    return Posed(card, flange, posture, pose, jacobian, arm.notes)


def read_posture(card: Card, deg: str | None, rad: str | None) -> Floats:
    """The posture (n,) [rad] that was typed; the home posture where none was.

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
    if np.abs(posture).max(initial=0.0) > FARTHEST:
        raise UsageError(f"{option} '{text[:60]}': an angle is at most {FARTHEST:g} rad either way")
    return posture


def screw_of(pose: Floats) -> Screw:
    """The screw of a pose (8,): 2 log(x) = [theta l; d l + theta m], m = p x l."""
    displacement = 2.0 * dq.log(pose)
    angle = float(np.linalg.norm(displacement[:3]))
    if angle < NO_TURN:
        way = dq.translation(pose)
        length = float(np.linalg.norm(way))
        return Screw(way / length if length > 0 else np.array([0.0, 0, 1]), None, 0.0, length)
    axis = displacement[:3] / angle
    advance = float(axis @ displacement[3:])
    moment = (displacement[3:] - advance * axis) / angle
    return Screw(axis, dq.cross(axis, moment), angle, advance)


def as_json(posed: Posed) -> dict[str, Any]:
    """All of it, in SI units; what does not exist of a pure translation is null."""
    screw = screw_of(posed.pose)
    return {
        "version": 1,
        "tool": f"dqpaint {__version__}",
        "robot": posed.card.name,
        "frame": "flange" if posed.flange else "tool",
        "posture_rad": posed.posture.tolist(),
        "pose": posed.pose.tolist(),
        "matrix": dq.matrix_from_pose(posed.pose).tolist(),
        "screw": {
            "axis": screw.axis.tolist(),
            "point_m": None if screw.point is None else screw.point.tolist(),
            "angle_rad": screw.angle,
            "advance_m": screw.advance,
            "pitch_m_rad": screw.pitch,
        },
        "jacobian": posed.jacobian.tolist(),
        "manipulability": float(manipulability(posed.jacobian)),
        "warnings": posed.beyond,
        "notes": list(posed.notes),
    }


def text(posed: Posed) -> str:
    """As a person reads it: degrees, and six decimals."""
    screw = screw_of(posed.pose)
    joints = [f"q{i}" for i in range(1, len(posed.posture) + 1)]
    where = "flange" if posed.flange else "tool"
    rows = [
        ("arm", f"{posed.card.name}, its {where} in the base frame"),
        ("posture", "".join(f"{name:>11}" for name in joints)),
        ("deg", _numbers(np.degrees(posed.posture), 4)),
        ("", ""),
        ("pose", _heads("w", "x", "y", "z")),
        ("primary", _numbers(posed.pose[:4])),
        ("dual", _numbers(posed.pose[4:])),
        ("", ""),
        ("matrix", _heads("x axis", "y axis", "z axis", "place m")),
        *(("", _numbers(row)) for row in dq.matrix_from_pose(posed.pose)),
        ("", ""),
        *_screw_rows(screw),
        ("", ""),
        ("Jacobian", "   the twist (w, v0) for each joint rate, about the base's origin"),
        ("", _heads(*joints)),
    ]
    units = ("wx rad/s", "wy rad/s", "wz rad/s", "vx m/s", "vy m/s", "vz m/s")
    rows += [(unit, _numbers(row)) for unit, row in zip(units, posed.jacobian, strict=True)]
    measure = float(manipulability(posed.jacobian))
    rows += [("", ""), ("manipulability", f"{measure:11.6f}   sqrt(det(J J'))")]
    return "\n".join(line.rstrip() for line in table(rows).splitlines())


def _screw_rows(screw: Screw) -> list[tuple[str, str]]:
    """The screw from the base frame to the pose."""
    if screw.point is None or screw.pitch is None:
        return [
            ("screw", "   a translation, no turn"),
            ("direction", _numbers(screw.axis)),
            ("advance", f"{screw.advance:11.6f} m"),
        ]
    turn = 2 * math.pi * screw.pitch
    return [
        ("screw", "   from the base frame to the pose"),
        ("axis", _numbers(screw.axis)),
        ("through", f"{_numbers(screw.point)} m"),
        ("angle", f"{math.degrees(screw.angle):11.4f} deg"),
        ("advance", f"{screw.advance:11.6f} m along the axis"),
        ("pitch", f"{screw.pitch:11.6f} m/rad, {turn:.6f} m/turn"),
    ]


def _numbers(values: Floats, digits: int = 6) -> str:
    return "".join(f"{round(float(x), digits) + 0.0:11.{digits}f}" for x in values)  # no -0


def _heads(*names: str) -> str:
    return "".join(f"{name:>11}" for name in names)
