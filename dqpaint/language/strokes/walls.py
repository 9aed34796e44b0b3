"""`wall`, `keep` and `face` -> the walls of a drawing."""

import math

from dqpaint.diagnostics import Problem, problem
from dqpaint.language.imports import file_access
from dqpaint.language.pen.pen import Pen
from dqpaint.language.syntax.tree import Expression, Name, Quoted, Statement
from dqpaint.language.values import typed_values, vectors
from dqpaint.language.values.scope import Scope
from dqpaint.program import Vector, walls

LARGEST_MESH = 20_000_000  # bytes
LEAST_SIDE = 1e-6  # [m] of a box


def wall(statement: Statement, pen: Pen, scope: Scope) -> walls.Wall:
    """The wall of a statement.

    Raises:
        Problem: a value that cannot be.
    """
    shape: walls.WallShape
    if statement.word == "keep":
        shape = _keep(statement, pen, scope)
    elif statement.word == "face":
        shape = _cone(statement, scope)
    else:
        shape = _half_space(statement, scope)
    still: Vector = (0.0, 0.0, 0.0)
    by, seconds = statement.value("by"), statement.value("in")
    if (by is None) != (seconds is None):
        given = by or seconds
        assert given is not None
        help = "a wall that moves goes by a shift in a time: by (0, 100) mm in 4 s"
        raise problem("E268", "a wall moves by a shift in a time", given.span, "", help)
    holder = statement.value("for")
    return walls.Wall(
        shape,
        "arm" if not isinstance(holder, Name) else _HOLDERS[holder.name],
        statement.part("base") is not None,
        typed_values.place(by, scope, "by") if by else still,
        typed_values.positive(seconds, scope, "in") if seconds else 0.0,
        " ".join(statement.span.text_in(pen.text).split()),
        pen.line_of(statement.span),
        statement.span,
    )


_HOLDERS: dict[str, walls.Holder] = {"tool": "tool", "beam": "beam"}


def _half_space(statement: Statement, scope: Scope) -> walls.HalfSpace:
    assert statement.name is not None
    side, axis = statement.name.text.split()
    offset = typed_values.number(statement.values[0], scope, "wall")
    sign = 1.0 if side == "below" else -1.0
    x, y, z = (sign * (axis == one) for one in "xyz")
    return walls.HalfSpace((x, y, z), sign * offset)


def _cone(statement: Statement, scope: Scope) -> walls.Cone:
    node = statement.required("within")
    angle = typed_values.number(node, scope, "within")
    if not 0.0 < angle < math.pi:
        help = "for example: face viewer within 50 deg"
        raise problem("E268", "an angle here is above 0 and below 180 deg", node.span, "", help)
    axis = typed_values.direction(statement.values[0], scope, "axis") if statement.values else None
    return walls.Cone(axis or vectors.Z, angle)


def _keep(statement: Statement, pen: Pen, scope: Scope) -> walls.WallShape:
    assert statement.name is not None
    kind = statement.name.text
    if kind == "apart":
        return walls.Apart(typed_values.positive(statement.values[0], scope, "keep"))
    _needs(statement, kind)
    if kind in ("inside box", "box"):
        corners = _corners(statement, scope)
        return walls.Room(*corners) if kind == "inside box" else walls.Block(*corners)
    if kind == "mesh":
        node = statement.values[0]
        assert isinstance(node, Quoted)
        at, scale = statement.value("at"), statement.value("scale")
        return walls.Hull(
            file_access.readable(node, pen, LARGEST_MESH).absolute(),
            typed_values.place(at, scope, "at") if at else (0.0, 0.0, 0.0),
            typed_values.positive(scale, scope, "scale") if scale else 1.0,
        )
    radius = typed_values.positive(statement.required("radius"), scope, "radius")
    if kind == "capsule":
        start = typed_values.place(statement.values[0], scope, "at")
        return walls.Rod(start, typed_values.place(statement.required("to"), scope, "to"), radius)
    place = typed_values.place(statement.required("at"), scope, "at")
    if kind == "sphere":
        return walls.Ball(place, radius)
    along = statement.value("along")
    axis = typed_values.direction(along, scope, "along") if along else vectors.Z
    return walls.Pillar(place, axis, radius)


NEEDS = {
    "inside box": ("to",), "box": ("to",), "sphere": ("at", "radius"), "capsule": ("to", "radius"),
    "cylinder": ("at", "radius"), "mesh": (),
}  # fmt: skip
EXAMPLES = {
    "inside box": "keep inside box (-200, -200, -100) mm to (200, 200, 100) mm",
    "box": "keep away from box (20, 20, -50) mm to (60, 60, 50) mm",
    "sphere": "keep away from sphere at (0, 0, 80) mm radius 30 mm",
    "capsule": "keep away from capsule (0, 0, 0) mm to (0, 90, 0) mm radius 20 mm",
    "cylinder": "keep away from cylinder at (50, 0) mm along y radius 20 mm",
}


def _needs(statement: Statement, kind: str) -> None:
    for part in NEEDS[kind]:
        if statement.part(part) is None:
            message = f"this {kind} has no '{part}'"
            raise problem("E115", message, statement.span, "", f"for example: {EXAMPLES[kind]}")


def _corners(statement: Statement, scope: Scope) -> tuple[Vector, Vector]:
    node = statement.required("to")
    first = typed_values.place(statement.values[0], scope, "at")
    last = typed_values.place(node, scope, "to")
    low = tuple(map(min, first, last))
    high = tuple(map(max, first, last))
    if min(b - a for a, b in zip(low, high, strict=True)) < LEAST_SIDE:
        raise _flat(node)
    return (low[0], low[1], low[2]), (high[0], high[1], high[2])


def _flat(node: Expression) -> Problem:
    help = "two opposite corners, with three numbers each: box (0, 0, 0) mm to (60, 40, 50) mm"
    return problem("E268", "this box is flat", node.span, "", help)
