"""An arm in a posture -> the text that `dqpaint pose` prints."""

import math

import numpy as np

from dqpaint import dq
from dqpaint.cli.terminal import table
from dqpaint.dq import Floats
from dqpaint.robots import pose_query
from dqpaint.robots.kinematics import manipulability


def text(posed: pose_query.PoseReport) -> str:
    """A pose report as text: angles in degrees, six decimals."""
    screw = pose_query.screw_from_pose(posed.pose)
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
        ("matrix", _heads("x axis", "y axis", "z axis", "origin m")),
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
    return table(rows)


def _screw_rows(screw: pose_query.Screw) -> list[tuple[str, str]]:
    """The screw from the base frame to the pose."""
    if screw.point is None or screw.pitch is None:
        return [
            ("screw", "   a translation without rotation"),
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
