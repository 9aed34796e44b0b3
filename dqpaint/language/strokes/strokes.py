"""Movement statements -> segments, one function for each statement."""

from dqpaint.core import replaced
from dqpaint.diagnostics import problem
from dqpaint.language.pen import tool_orientation
from dqpaint.language.pen.durations import timing
from dqpaint.language.pen.pen import SAME_PLACE, SAME_TURN, Pen
from dqpaint.language.pen.stroke_state import StrokeState
from dqpaint.language.strokes import arcs, curves, imported_strokes, lines, photos, shapes
from dqpaint.language.strokes.modal_words import apply_clause, light_of, pause_light
from dqpaint.language.syntax.tree import Expression, LightWords, Statement
from dqpaint.language.values import typed_values, vectors
from dqpaint.language.values.scope import Scope
from dqpaint.language.vocabulary.words import MODAL, SHAPES
from dqpaint.program import (
    LOOK_MODES,
    Arc,
    Duration,
    Dwell,
    FixedOrientation,
    FollowHeading,
    Light,
    Pose,
    Samples,
    Screw,
    ScrewTo,
    SlerpOrientation,
    Step,
    Vector,
)


def draw(statement: Statement, pen: Pen, scope: Scope) -> None:
    """Adds the strokes of a movement; its clauses hold for it alone."""
    outside = pen.state
    if pen.stroke is not None:
        for part in statement.parts:
            pen.check_no_time(part)
    if not lines.sets_start(statement, pen):
        pen.begin(statement.span)
    try:
        pen.state = _with_clauses(statement, outside, pen, scope)
        _DRAW[statement.word](statement, pen, scope)
    finally:
        # What shone last is remembered, so that `light on` finds it.
        shone = pen.state.shone
        pen.state = outside if shone is outside.shone else replaced(outside, shone=shone)


def _with_clauses(statement: Statement, state: StrokeState, pen: Pen, scope: Scope) -> StrokeState:
    for part in statement.parts:
        own_light = part.word == "light" and statement.word in ("hold", "step")
        if part.word in MODAL and not own_light and not curves.sets_colour(statement, part):
            state = apply_clause(state, part, scope, pen, pen.frame)
    return state


def _place(node: Expression, pen: Pen, scope: Scope, word: str) -> Vector:
    return pen.frame.point(typed_values.place(node, scope, word))


# Round.


def _arc(statement: Statement, pen: Pen, scope: Scope) -> None:
    start = pen.pose.position
    if statement.part("via") is not None:
        via, to = statement.required("via"), statement.required("to")
        through, end = _place(via, pen, scope, "via"), _place(to, pen, scope, "to")
        if pen.lost:
            pen.pose, pen.lost = Pose(end, pen.pose.orientation), False
            return
        arc = arcs.through(start, through, end, via.span, to.span)
    elif statement.part("radius") is not None:
        to = statement.required("to")
        end = _place(to, pen, scope, "to")
        radius = pen.frame.scale * typed_values.positive(
            statement.required("radius"), scope, "radius"
        )
        axis = _axis(statement, pen, scope)
        if pen.lost:
            pen.pose, pen.lost = Pose(end, pen.pose.orientation), False
            return
        side = pen.frame.hand * (1.0 if statement.part("left") else -1.0)
        long, spans = (
            statement.part("long") is not None,
            (statement.required("radius").span, to.span),
        )
        arc = arcs.of_radius(start, end, radius, vectors.times(side, axis), long, *spans)
    else:
        arc = _turn_about_centre(statement, pen, scope)
        end = arcs.end_of(arc, start)
    _draw_arc(statement, pen, scope, arc, end)


def _turn_about_centre(statement: Statement, pen: Pen, scope: Scope) -> Arc:
    node = statement.value("centre") or statement.required("center")
    frame = pen.frame
    centre = _place(node, pen, scope, "centre")
    axis = _axis(statement, pen, scope)
    angle_node = statement.required("angle")
    angle = typed_values.number(angle_node, scope, "angle")
    if angle == 0.0:
        message = "an arc of 0 deg goes nowhere"
        raise problem(
            "E244", message, angle_node.span, "", "for a full circle write: angle 360 deg"
        )
    rise, grow = (
        frame.scale * typed_values.number(part, scope, word) if part else 0.0
        for word in ("rise", "grow")
        for part in (statement.value(word),)
    )
    arc = Arc(centre, axis, frame.hand * angle, rise, grow)
    if not pen.lost:
        grow_node = statement.value("grow")
        arcs.check(arc, pen.pose.position, node.span, grow_node.span if grow_node else node.span)
    return arc


def _axis(statement: Statement, pen: Pen, scope: Scope) -> Vector:
    """The axis of an arc, in the drawing frame."""
    node = statement.value("axis")
    return pen.frame.direction(typed_values.direction(node, scope, "axis") if node else vectors.Z)


def _draw_arc(statement: Statement, pen: Pen, scope: Scope, arc: Arc, end: Vector) -> None:
    mode, span = pen.state.tool, statement.span
    tool_orientation.look_at_start(pen, mode, span)
    if isinstance(mode, LOOK_MODES) and not pen.lost:
        tool_orientation.check_orientations(mode, arcs.points_along(arc, pen.pose.position), span)
    tool, orientation = tool_orientation.orientation_at_end(
        pen, mode, end, span, arc.axis, arc.angle
    )
    whole = timing(statement, pen.state, scope)
    pen.draw(arc, tool, whole, pen.state.light, Pose(end, orientation), span)


def _screw(statement: Statement, pen: Pen, scope: Scope) -> None:
    if statement.part("to") is not None:
        _screw_to(statement, pen, scope)
        return
    frame = pen.frame
    point = _place(statement.required("about"), pen, scope, "about")
    axis = frame.direction(typed_values.direction(statement.required("along"), scope, "along"))
    angle_node, pitch = statement.required("angle"), statement.value("pitch")
    angle = typed_values.number(angle_node, scope, "angle")
    if angle == 0.0:
        message = "a screw of 0 deg goes nowhere"
        raise problem("E244", message, angle_node.span, "", "to go straight, use: line by")
    advance = frame.scale * typed_values.number(pitch, scope, "pitch") * angle if pitch else 0.0
    angle *= frame.hand
    mode = pen.state.tool
    if isinstance(mode, LOOK_MODES) and not pen.oriented:
        tool_orientation.look_at_start(pen, mode, statement.span)
    end = vectors.screw_moved(pen.pose, point, axis, angle, advance)
    whole = timing(statement, pen.state, scope)
    path = Screw(point, axis, angle, advance)
    pen.draw(path, FollowHeading(axis), whole, pen.state.light, end, statement.span)


def _screw_to(statement: Statement, pen: Pen, scope: Scope) -> None:
    node = statement.required("to")
    end = _place(node, pen, scope, "to")
    pen.lost = False
    orientation = tool_orientation.orientation_of_mode(pen.state.tool, end, statement.span)
    if orientation is None:
        message = "'screw to' needs to know how the tool is held at the end"
        help = "add: tool rpy(0 deg, 0 deg, 90 deg); to keep the tool as it is, use: line to"
        raise problem("E255", message, node.span, "", help)
    way = vectors.length(vectors.minus(end, pen.pose.position))
    if way <= SAME_PLACE and vectors.turn_between(pen.pose.orientation, orientation) <= SAME_TURN:
        pen.warn(
            "W401", "this screw has no length", node.span, "already here", "to wait, use: hold 1 s"
        )
        return
    whole = timing(statement, pen.state, scope)
    light, span = pen.state.light, statement.span
    pen.draw(ScrewTo(), FollowHeading(), whole, light, Pose(end, orientation), span)


# Formulas.


def _curve(statement: Statement, pen: Pen, scope: Scope) -> None:
    curve, places = curves.curve(statement, pen.frame, scope, pen)
    span, start, end = statement.values[0].span, places[0], places[-1]
    gap = vectors.length(vectors.minus(start, pen.pose.position))
    if all(vectors.length(vectors.minus(p, start)) <= SAME_PLACE for p in places):
        pen.warn("W401", "this curve has no length", span, "", "to wait, use: hold 1 s")
        return
    if pen.lost:
        pen.pose, pen.lost = Pose(start, pen.pose.orientation), False
    elif gap > curves.GAP:
        pen.check_no_stop(statement.span)
        message = f"the curve starts {_millimetres(gap)} away from where the tool is"
        help = "a light-off move is added; write a move to choose its speed"
        pen.warn("W402", message, span, "", help)
        pen.travel(start, statement.span)
    mode, turn = pen.state.tool, 0.0
    axis = pen.frame.direction(vectors.Z)
    tool_orientation.look_at_start(pen, mode, statement.span)
    if isinstance(mode, LOOK_MODES):
        tool_orientation.check_orientations(mode, places, statement.span)
    if isinstance(mode, FollowHeading):
        turn = curves.heading_change(curve, axis, span)
    tool, orientation = tool_orientation.orientation_at_end(
        pen, mode, end, statement.span, axis, turn
    )
    part = statement.part("light")
    if part is not None and curves.sets_colour(statement, part):
        light = curves.light_along(statement, part, curve, pen, scope)
        pen.state = replaced(pen.state, light=light, shone=light)
    whole = timing(statement, pen.state, scope)
    pen.draw(curve, tool, whole, pen.state.light, Pose(end, orientation), statement.span)


def _millimetres(size: float) -> str:
    return f"{1e3 * size:.3g} mm" if size < 1e3 else f"{size:.3g} m"


# At one place.


def _step(statement: Statement, pen: Pen, scope: Scope) -> None:
    to = statement.required("to")
    end = _place(to, pen, scope, "to")
    pen.lost = False
    wanted = tool_orientation.orientation_of_mode(pen.state.tool, end, statement.span)
    now = pen.pose.orientation
    tool, orientation = tool_orientation.rotation_between(
        now, wanted if wanted is not None else now
    )
    way = vectors.length(vectors.minus(end, pen.pose.position))
    if way <= SAME_PLACE and not isinstance(tool, SlerpOrientation):
        pen.warn(
            "W401", "this step goes nowhere", to.span, "already here", "to wait, use: hold 1 s"
        )
        return
    light = _pause_light(statement, pen, scope)
    pen.draw(Step(), tool, Samples(1), light, Pose(end, orientation), statement.span)


def _hold(statement: Statement, pen: Pen, scope: Scope) -> None:
    seconds = typed_values.positive(statement.values[0], scope, "hold")
    light = _pause_light(statement, pen, scope)
    pen.draw(Dwell(), FixedOrientation(), Duration(seconds), light, pen.pose, statement.span)


def _pause_light(statement: Statement, pen: Pen, scope: Scope) -> Light | None:
    """The light of a pause: only its own light may be a gradient over its time."""
    part = statement.part("light")
    if part is None:
        return pause_light(pen.state.light)
    assert isinstance(part.value, LightWords)
    return light_of(part.value, pen.state, scope)


_DRAW = {
    "line": lines.line,
    "move": lines.move,
    "arc": _arc,
    "screw": _screw,
    "curve": _curve,
    "step": _step,
    "hold": _hold,
    "text": imported_strokes.text,
    "path": imported_strokes.path,
    "svg": imported_strokes.svg,
    "photo": photos.photo,
    **dict.fromkeys(SHAPES, shapes.shape),
}
