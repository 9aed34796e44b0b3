"""Points, radius or angle -> arcs, and positions along them."""

import math
from collections.abc import Iterator

from dqpaint.diagnostics import Span
from dqpaint.language.pen.pen import SAME_PLACE, pose_problem
from dqpaint.language.values import vectors
from dqpaint.program import Arc, Vector

# Both are relative to the size of the arc, so that one of a millimetre is as good as one of a
# metre. A flatter arc than this has its centre too far away to be found with enough digits.
CLOSED = 1e-9
FLAT = 1e-6
RADIUS_ZERO = 1e-9

_LINES = "start, via and end lie on one straight line; no circle goes through them"


def through(start: Vector, via: Vector, end: Vector, via_span: Span, end_span: Span) -> Arc:
    """The arc from `start` through `via` to `end`."""
    a, b = vectors.minus(via, start), vectors.minus(end, start)
    to_via, to_end = vectors.length(a), vectors.length(b)
    if to_end <= CLOSED * to_via + SAME_PLACE:
        raise pose_problem(
            "E245",
            "this arc ends where it starts, so 'via' does not say in which plane it lies",
            end_span,
            "same as the start point",
            "for a full circle write: arc centre POINT angle 360 deg",
        )
    normal = vectors.cross(a, b)
    to_last = vectors.length(vectors.minus(b, a))
    smallest, *_, largest = sorted((to_via, to_end, to_last))
    if smallest <= CLOSED * largest + SAME_PLACE or (
        vectors.length(normal) <= FLAT * to_via * to_end
        or vectors.length(normal) <= FLAT * to_via * to_last
    ):
        raise pose_problem(
            "E246", _LINES, via_span, "", "use line to, or move the via point sideways"
        )
    # The circumcentre, seen from `start`.
    weights = vectors.minus(vectors.times(to_via * to_via, b), vectors.times(to_end * to_end, a))
    way = vectors.times(0.5 / vectors.dot(normal, normal), vectors.cross(weights, normal))
    centre, axis = vectors.plus(start, way), vectors.unit(normal)
    first, last = vectors.times(-1.0, way), vectors.minus(b, way)
    sine = vectors.dot(axis, vectors.cross(first, last))
    angle = math.atan2(sine, vectors.dot(first, last)) % (2.0 * math.pi)
    return Arc(centre, axis, angle)


def of_radius(
    start: Vector,
    end: Vector,
    radius: float,
    axis: Vector,
    long: bool,
    radius_span: Span,
    end_span: Span,
) -> Arc:
    """The arc of a radius [m] from `start` to `end`, right-handed about `axis`.

    With the chord d: the centre lies square to it, on the left of the way, by
    sqrt(radius^2 - d^2 / 4); a `long` arc has it on the right.
    """
    chord = vectors.minus(end, start)
    size = vectors.length(chord)
    if size <= CLOSED * radius + SAME_PLACE:
        raise pose_problem(
            "E245",
            "this arc ends where it starts, so nothing says where its centre is",
            end_span,
            "same as the start point",
            "for a full circle write: arc centre POINT angle 360 deg",
        )
    height = vectors.dot(chord, axis)
    if abs(height) > CLOSED * size + SAME_PLACE:
        raise pose_problem(
            "E290",
            f"the end lies {1e3 * abs(height):.4g} mm outside of the plane of this arc",
            end_span,
            "",
            "say what it turns about with axis, or use: arc via POINT to POINT",
        )
    square = radius * radius - 0.25 * size * size
    if square < -CLOSED * radius * radius:
        raise pose_problem(
            "E291",
            f"no circle of radius {1e3 * radius:.4g} mm goes through both points",
            radius_span,
            f"they are {1e3 * size:.4g} mm apart",
            f"the least is: radius {math.ceil(5e5 * size - 1e-6) / 1e3:g} mm",
        )
    left = vectors.unit(vectors.cross(axis, chord))
    side = math.sqrt(max(0.0, square)) * (-1.0 if long else 1.0)
    middle = vectors.plus(start, vectors.times(0.5, chord))
    angle = 2.0 * math.atan2(0.5 * size, side)
    return Arc(vectors.plus(middle, vectors.times(side, left)), axis, angle)


def check(arc: Arc, start: Vector, centre_span: Span, grow_span: Span) -> None:
    """Raises if the arc has no radius, or ends with a negative one."""
    way = vectors.minus(start, arc.centre)
    radius = vectors.length(vectors.across(way, arc.axis))
    if radius <= SAME_PLACE + RADIUS_ZERO * vectors.length(way):
        message = "the centre of this arc is where the tool is now: the radius is 0"
        if vectors.length(way) > SAME_PLACE:
            message = "the tool is on the axis of this arc: the radius is 0"
        raise pose_problem("E249", message, centre_span, "", "move to a point of the circle first")
    if radius + arc.grow < -1e-9 * radius:
        raise pose_problem(
            "E250",
            "the radius of this arc would become less than 0",
            grow_span,
            f"the radius is {1e3 * radius:.4g} mm at the start",
            f"the least is: grow -{1e3 * radius:.4g} mm",
        )


def point_at(arc: Arc, start: Vector, share: float) -> Vector:
    """The point at a fraction, 0 to 1, of an arc that begins at `start`."""
    way = vectors.minus(start, arc.centre)
    across = vectors.across(way, arc.axis)
    foot = vectors.plus(arc.centre, vectors.minus(way, across))
    radius = vectors.length(across)
    if radius == 0.0:
        return start
    angle = arc.angle * share
    u, v = across, vectors.cross(arc.axis, across)
    stretch = (radius + arc.grow * share) / radius
    round_ = vectors.plus(
        vectors.times(stretch * math.cos(angle), u), vectors.times(stretch * math.sin(angle), v)
    )
    return vectors.plus(vectors.plus(foot, round_), vectors.times(arc.rise * share, arc.axis))


def end_of(arc: Arc, start: Vector) -> Vector:
    """The end of an arc that begins at `start`."""
    return point_at(arc, start, 1.0)


def points_along(arc: Arc, start: Vector, pieces: int = 64) -> Iterator[Vector]:
    """Points along a whole arc."""
    for i in range(pieces + 1):
        yield point_at(arc, start, i / pieces)
