"""Circles, ellipses, rectangles, polygons and stars -> closed strokes around their middle."""

import math

import numpy as np

from dqpaint.diagnostics import problem
from dqpaint.language.pen.pen import Pen
from dqpaint.language.strokes.fill import filled
from dqpaint.language.strokes.imported_strokes import draw_traces, placed
from dqpaint.language.syntax.tree import Statement
from dqpaint.language.values import typed_values, vectors
from dqpaint.language.values.scope import Scope
from dqpaint.program import Floats, PiecewiseCurve, piecewise

MOST_CORNERS = 1000


def shape(statement: Statement, pen: Pen, scope: Scope) -> None:
    """Draws a closed shape once round, against the clock, and ends where it began.

    Its middle is at `at`, or at the origin of the frame. A rectangle begins at its lower left
    corner, a polygon and a star at the top, what is round at the right. Where corners are blended
    it begins in the middle of its last side, so that all of them are.
    """
    if statement.word in ("circle", "ellipse"):
        curve = _round(statement, scope)
    else:
        corners = (_rectangle if statement.word == "rect" else _polygon)(statement, scope)
        first = corners[0]
        if pen.state.blend:
            first = 0.5 * (corners[0] + corners[-1])
            corners = np.concatenate([first[None], corners])
        curve = piecewise.straight(np.concatenate([corners, first[None]]))
    at = statement.value("at")
    middle = vectors.ZERO if at is None else typed_values.place(at, scope, "at")
    pen.lost = False
    lines = filled(statement, scope, [(curve, None)], 1.0)
    draw_traces(statement, pen, scope, placed(lines, pen, 1.0, pen.frame.point(middle)))


def _size(statement: Statement, scope: Scope, word: str) -> float:
    return typed_values.positive(statement.required(word), scope, word)


def _round(statement: Statement, scope: Scope) -> PiecewiseCurve:
    if statement.word == "circle":
        a = b = _size(statement, scope, "radius")
    else:
        a, b = (0.5 * _size(statement, scope, word) for word in ("width", "height"))
    u, v = np.array([a, 0.0, 0.0]), np.array([0.0, b, 0.0])
    return piecewise.arc(np.zeros(3), u, v, 0.0, 2.0 * math.pi)


def _rectangle(statement: Statement, scope: Scope) -> Floats:
    """The corners (4, 3) [m]."""
    x, y = (0.5 * _size(statement, scope, word) for word in ("width", "height"))
    return np.array([[-x, -y, 0.0], [x, -y, 0.0], [x, y, 0.0], [-x, y, 0.0]])


def _polygon(statement: Statement, scope: Scope) -> Floats:
    """The corners (N, 3) [m] of a polygon or, twice as many, of a star."""
    word, node = statement.word, statement.values[0]
    count = typed_values.count(node, scope, word, least=3)
    if count > MOST_CORNERS:
        message = f"a '{word}' has at most {MOST_CORNERS:,} corners"
        raise problem("E221", message, node.span, f"this is {count:,}", "write: circle radius …")
    radii = np.full(count, _size(statement, scope, "radius"))
    if word == "star":
        radii = np.stack([radii, np.full(count, _inner(statement, scope, count))], axis=1).ravel()
    angle = 0.5 * math.pi + 2.0 * math.pi * np.arange(len(radii)) / len(radii)
    return np.stack([radii * np.cos(angle), radii * np.sin(angle), 0.0 * angle], axis=1)


def _inner(statement: Statement, scope: Scope, count: int) -> float:
    """The radius [m] of the inner corners; by itself where each second side is one line."""
    if statement.part("inner") is not None:
        return _size(statement, scope, "inner")
    if count < 5:
        node = statement.values[0]
        message = f"a star with {count} points has no 'inner' of its own"
        help = "add how far in its inner corners lie: inner 10 mm"
        raise problem("E115", message, node.span, "", help)
    radius = _size(statement, scope, "radius")
    return radius * math.cos(2.0 * math.pi / count) / math.cos(math.pi / count)
