"""Lines and moves -> segments: one for each leg, or a rotation in place."""

from dqpaint.diagnostics import Span
from dqpaint.language.pen import tool_orientation
from dqpaint.language.pen.durations import divide_timing, timing
from dqpaint.language.pen.pen import SAME_PLACE, Pen
from dqpaint.language.pen.stroke_state import TurnTo
from dqpaint.language.syntax.tree import Statement
from dqpaint.language.values import typed_values, vectors
from dqpaint.language.values.scope import Scope
from dqpaint.language.vocabulary.words import SHAPES
from dqpaint.program import (
    LOOK_MODES,
    FixedOrientation,
    FollowHeading,
    Light,
    Look,
    LookLine,
    Pose,
    Quaternion,
    Straight,
    Timing,
    Tool,
    Vector,
)


def sets_start(statement: Statement, pen: Pen) -> bool:
    """Whether a movement defines the start of the drawing by its own first point."""
    own = ("move", "text", "path", "svg", "photo", *SHAPES)
    return statement.word in own and not (pen.started or pen.placed)


def _stops(statement: Statement, pen: Pen, scope: Scope) -> list[tuple[Vector, Span]]:
    """The points of a line with their spans."""
    at, stops = pen.pose.position, []
    for part in statement.parts:
        if part.word in ("to", "by"):
            given = typed_values.place(part.expression, scope, part.word)
            if part.word == "to":
                at, pen.lost = pen.frame.point(given), False
            else:
                at = vectors.plus(at, pen.frame.vector(given))
            stops.append((at, part.value.span))
    return stops


def move(statement: Statement, pen: Pen, scope: Scope) -> None:
    """`move`: a dark line; the first one defines the start of the drawing."""
    if not sets_start(statement, pen):
        legs(statement, _stops(statement, pen, scope), pen, scope, light=None)
        return
    pen.started, pen.moved = True, statement.span
    (first, span), *rest = _stops(statement, pen, scope)
    mode = pen.state.tool
    pen.start_at(first, tool_orientation.orientation_of_mode(mode, first, span))
    if rest:
        legs(statement, rest, pen, scope, light=None)
        return
    timing(statement, pen.state, scope)
    for part in statement.parts:
        if part.word not in ("to", "by", "tool"):
            message = (
                f"the first 'move' only says where the drawing starts; '{part.word}' does nothing"
            )
            pen.warn("W405", message, part.span, "", "take it away")
            break


def line(statement: Statement, pen: Pen, scope: Scope) -> None:
    """`line`: one stroke, or several."""
    legs(statement, _stops(statement, pen, scope), pen, scope, pen.state.light)


def legs(
    statement: Statement,
    stops: list[tuple[Vector, Span]],
    pen: Pen,
    scope: Scope,
    light: Light | None,
) -> None:
    """One segment for each leg; rotation, light and time are divided by the legs' lengths.

    Args:
        statement: whose clauses hold for all of them.
        stops: the end [m] of each leg in the drawing frame, and where it is written.
        pen: begins where the tool is.
        scope: of the values.
        light: None is dark.
    """
    found, at = [], pen.pose.position
    for stop, span in stops:
        size = vectors.length(vectors.minus(stop, at))
        if size > SAME_PLACE:
            found.append((stop, size))
            at = stop
        elif len(stops) > 1:
            _no_length(statement.word, span, pen)
    whole = timing(statement, pen.state, scope)
    if not found:
        _rotation_in_place(statement, stops[0][1], pen, whole, light)
        return
    mode = pen.state.tool
    sizes = [size for _, size in found]
    times = divide_timing(whole, sizes, statement.span)
    for (stop, _), leg_time, (first, last) in zip(found, times, _shares(sizes), strict=True):
        tool_orientation.look_at_start(pen, mode, statement.span)
        start = pen.pose.position
        tool, orientation = _tool_of_leg(pen, stop, statement.span, first, last)
        way = vectors.minus(stop, start)
        if isinstance(mode, LOOK_MODES):
            places = (_nearest(mode, start, way), *tool_orientation.closest_to_up(mode, start, way))
            tool_orientation.check_orientations(mode, places, statement.span)
        glow = light
        if light is not None and not _spans_stroke(pen, light):
            glow = light.part(first, last)
        pen.draw(Straight(way), tool, leg_time, glow, Pose(stop, orientation), statement.span)


def _spans_stroke(pen: Pen, light: Light) -> bool:
    """Whether a gradient extends over a whole `stroke`."""
    return pen.stroke is not None and light is pen.stroke.light


def _shares(sizes: list[float]) -> list[tuple[float, float]]:
    """Start and end of each leg, as fractions of the total; the last ends at 1 exactly."""
    if len(sizes) == 1:
        return [(0.0, 1.0)]
    total, ends = sum(sizes), [0.0]
    for size in sizes[:-1]:
        ends.append(ends[-1] + size / total)
    return list(zip(ends, [*ends[1:], 1.0], strict=True))


def _tool_of_leg(
    pen: Pen, stop: Vector, span: Span, first: float, last: float
) -> tuple[Tool, Quaternion]:
    """The rotation on a leg between two fractions of the whole path."""
    mode, now = pen.state.tool, pen.pose.orientation
    if isinstance(mode, FollowHeading):
        return FixedOrientation(), now
    if isinstance(mode, TurnTo) and last < 1.0:
        share = (last - first) / (1.0 - first)  # of what is left to turn
        return tool_orientation.rotation_between(
            now, vectors.part_of_turn(now, mode.orientation, share)
        )
    return tool_orientation.orientation_at_end(pen, mode, stop, span, vectors.Z, 0.0)


def _nearest(mode: Look | LookLine, start: Vector, way: Vector) -> Vector:
    """The point on a straight path that is nearest to the point the tool looks at."""
    to, along = vectors.minus(mode.point, start), way
    if isinstance(mode, LookLine):
        to, along = vectors.across(to, mode.along), vectors.across(way, mode.along)
    size = vectors.dot(along, along)
    share = min(1.0, max(0.0, vectors.dot(to, along) / size)) if size > 0.0 else 0.0
    return vectors.plus(start, vectors.times(share, way))


def _rotation_in_place(
    statement: Statement, span: Span, pen: Pen, whole: Timing, light: Light | None
) -> None:
    """A line without length: a rotation in place, if its tool needs one."""
    mode, now = pen.state.tool, pen.pose.orientation
    wanted = tool_orientation.orientation_of_mode(mode, pen.pose.position, span)
    tool, orientation = tool_orientation.rotation_between(
        now, wanted if wanted is not None else now
    )
    if isinstance(tool, FixedOrientation):
        _no_length(statement.word, span, pen)
        return
    end = Pose(pen.pose.position, orientation)
    pen.draw(Straight(vectors.ZERO), tool, whole, light, end, statement.span)


def _no_length(word: str, span: Span, pen: Pen) -> None:
    if word == "line":  # a `move` to where one is harms nobody, as in a loop
        message = "this line has no length"
        pen.warn("W401", message, span, "already here", "to wait, use: hold 1 s")
