"""Tool mode and position -> orientation of the tool, or an error where it is undefined.

The tool's z axis looks; see `program.Look` and `program.LookLine` for the other two.
"""

import math
from collections.abc import Iterable

from dqpaint.diagnostics import Span
from dqpaint.language.pen.pen import SAME_PLACE, SAME_TURN, Pen, pose_problem
from dqpaint.language.pen.stroke_state import ToolMode, TurnTo
from dqpaint.language.values import vectors
from dqpaint.program import (
    LOOK_MODES,
    FixedOrientation,
    FollowHeading,
    Look,
    LookLine,
    Quaternion,
    SlerpOrientation,
    Tool,
    Vector,
)

LEAST_LEAN = math.radians(1.0)  # between the direction of a look and `up`


def orientation_at(mode: Look | LookLine, position: Vector, span: Span) -> Quaternion:
    """The orientation at `position` of a tool that looks."""
    if isinstance(mode, Look):
        return _look(mode, position, span)
    return _look_line(mode, position, span)


def _look(mode: Look, position: Vector, span: Span) -> Quaternion:
    way = vectors.minus(mode.point, position)
    if vectors.length(way) <= SAME_PLACE:
        help = "look at a point the tool does not go through"
        raise pose_problem("E251", "the tool can't look at the point where it is", span, "", help)
    z = vectors.unit(way)
    lean = vectors.angle_between(z, mode.up)
    if min(lean, math.pi - lean) < LEAST_LEAN:
        message = "the tool looks along 'up' here, so nothing says how it is turned about that"
        other = "y" if abs(mode.up[2]) > 0.9 else "z"
        help = f"say another direction: tool look POINT up {other}"
        raise pose_problem("E252", message, span, "", help)
    x = vectors.unit(vectors.cross(mode.up, z))
    return vectors.turn_of_axes(x, vectors.cross(z, x), z)


def _look_line(mode: LookLine, position: Vector, span: Span) -> Quaternion:
    x = mode.along
    way = vectors.minus(mode.point, position)
    across = vectors.across(way, x)
    if vectors.length(across) <= SAME_PLACE + 1e-12 * vectors.length(way):
        help = "look at a line the tool does not go through"
        raise pose_problem("E253", "the tool can't look at the line it is on", span, "", help)
    z = vectors.unit(across)
    return vectors.turn_of_axes(x, vectors.cross(z, x), z)


def orientation_of_mode(mode: ToolMode, position: Vector, span: Span) -> Quaternion | None:
    """The orientation at a position if the mode alone determines it, else None."""
    if isinstance(mode, TurnTo):
        return mode.orientation
    if isinstance(mode, LOOK_MODES):
        return orientation_at(mode, position, span)
    return None


def look_at_start(pen: Pen, mode: ToolMode, span: Span) -> None:
    """Before a stroke: a tool that looks has to have its orientation already."""
    if isinstance(mode, LOOK_MODES):
        pen.look(mode, orientation_at(mode, pen.pose.position, span), span)


def orientation_at_end(
    pen: Pen, mode: ToolMode, position: Vector, span: Span, axis: Vector, turn: float
) -> tuple[Tool, Quaternion]:
    """The tool's rotation on a stroke to `position`, and its orientation there.

    `axis` and `turn` [rad] are the rotation of a tool that follows the heading.
    """
    now = pen.pose.orientation
    if isinstance(mode, FollowHeading):
        return FollowHeading(axis), vectors.turn_product(vectors.turn_about(axis, turn), now)
    if isinstance(mode, LOOK_MODES):
        return mode, orientation_at(mode, position, span)
    return rotation_between(now, mode.orientation if isinstance(mode, TurnTo) else now)


def rotation_between(now: Quaternion, end: Quaternion) -> tuple[Tool, Quaternion]:
    """Slerp to `end`, or a fixed orientation if both are equal within SAME_TURN."""
    if end == now or vectors.turn_between(now, end) <= SAME_TURN:
        return FixedOrientation(), now
    return SlerpOrientation(), end


def closest_to_up(mode: Look | LookLine, start: Vector, way: Vector) -> tuple[Vector, ...]:
    """The point on a straight path where the looking direction is closest to +-'up'.

    The looks lie in one plane; there the closest is square to n x up, n being the plane's normal.
    """
    if not isinstance(mode, Look):
        return ()
    to = vectors.minus(mode.point, start)
    across = vectors.cross(vectors.cross(to, way), mode.up)
    speed = vectors.dot(way, across)
    share = vectors.dot(to, across) / speed if speed else 0.0
    return (vectors.plus(start, vectors.times(share, way)),) if 0.0 < share < 1.0 else ()


def check_orientations(mode: Look | LookLine, places: Iterable[Vector], span: Span) -> None:
    """Raises if the tool's orientation is undefined at one of these positions."""
    for position in places:
        orientation_at(mode, position, span)
