"""Formula of a curve -> function of a Taylor series, in the drawing frame."""

import numpy as np

from dqpaint.diagnostics import Problem, ScriptError, Span, problem
from dqpaint.language.pen.pen import Pen, pose_problem
from dqpaint.language.strokes.modal_words import light_of
from dqpaint.language.syntax.tree import (
    Expression,
    LightWords,
    Part,
    Statement,
    names_in,
    size_of,
)
from dqpaint.language.values import typed_values, vectors
from dqpaint.language.values.evaluate import evaluate
from dqpaint.language.values.scope import MOST_CURVE_STEPS, Budget, Scope
from dqpaint.language.values.values import PointValue, Quantity, Value, describe, is_zero
from dqpaint.language.values.vectors import Frame
from dqpaint.language.vocabulary.units import ANGLE, LENGTH, TIME, Dimension
from dqpaint.program import Colour, Curve, Floats, Formula, Light, Taylor, Vector, colours

GAP = 1e-9  # [m] within which a curve starts where the tool is
PIECES = 64  # a curve is looked at in so many places before it is believed
MOST_PIECES = 1 << 16  # of a curve whose heading changes fast
LARGEST = 1e30  # of its series: squares of it are still a computer's numbers
LEAST_COLOURS, MOST_COLOURS = 64, 4096  # of a light that changes with a curve's parameter
FINE = 1 / 512  # of full brightness
UPRIGHT = 1e-6  # sine of the least angle between a heading and the axis it turns about


def curve(statement: Statement, frame: Frame, scope: Scope, pen: Pen) -> tuple[Curve, list[Vector]]:
    """A curve, and points along all of it."""
    node, lower_node, upper_node = statement.values
    assert statement.name is not None
    lower, upper, dimension = _ends(lower_node, upper_node, scope)
    formula = _formula(node, statement.name.text, dimension, frame, scope, pen.file)
    at = np.linspace(lower, upper, PIECES + 1)
    try:
        xyz = np.array([series.coefficients[0] for series in formula(Taylor.variable(at))])
    except ScriptError as error:
        raise Problem(error.diagnostics[0]) from None
    x, y, z = xyz.tolist()
    return Curve(formula, lower, upper), list(zip(x, y, z, strict=True))


def sets_colour(statement: Statement, part: Part) -> bool:
    """Whether a part is a light that changes with the parameter of a curve."""
    name = statement.name if statement.word == "curve" else None
    return part.word == "light" and name is not None and name.text in names_in(part.value)


def light_along(statement: Statement, part: Part, curve: Curve, pen: Pen, scope: Scope) -> Light:
    """The light of a curve whose colour is a formula of its parameter.

    It is mixed between colours so close that half-way it is off by no more than `FINE`.
    """
    assert statement.name is not None
    assert isinstance(part.value, LightWords)
    words, name = part.value, statement.name.text
    if words.rest:
        message = f"a colour that changes with '{name}' is one formula, without 'to'"
        raise problem("E109", message, words.span, "", f"for example: light hsv({name})")
    _, _, dimension = _ends(statement.values[1], statement.values[2], scope)
    known = scope.values_of(names_in(words))

    def colour(t: float) -> Colour:
        names = {**known, name: Quantity(t, dimension)}
        light = light_of(words, pen.state, scope.with_names(names, Budget(MOST_CURVE_STEPS)))
        return colours.DARK if light is None else light.first

    at = np.linspace(curve.lower, curve.upper, LEAST_COLOURS + 1)
    shades = np.array([colour(t) for t in at.tolist()])
    while True:
        between = np.array([colour(t) for t in (0.5 * (at[1:] + at[:-1])).tolist()])
        off = np.abs(between - 0.5 * (shades[1:] + shades[:-1])).max()
        if off <= FINE or len(at) > MOST_COLOURS:
            break
        shades = np.insert(shades, np.arange(1, len(at)), between, axis=0)
        at = np.linspace(curve.lower, curve.upper, 2 * len(at) - 1)
    share = _length_shares(curve, len(at) - 1)
    new = np.append(True, np.diff(share) > 0.0)
    inside = new & (share > 0.0) & (share < 1.0)
    stops = zip(share[inside].tolist(), map(tuple, shades[inside].tolist()), strict=True)
    first, last = (tuple(shade) for shade in shades[[0, -1]].tolist())
    return Light(first, last, words.even, between=tuple(stops))


def _length_shares(curve: Curve, pieces: int) -> Floats:
    """The share of its length at the ends of even pieces of a curve's parameter (N + 1,)."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    at = np.linspace(curve.lower, curve.upper, pieces + 1)
    u = (0.5 * (at[1:] + at[:-1]) + 0.5 * np.diff(at) * nodes[:, None]).ravel()
    series = curve.formula(Taylor.variable(u))
    speed = np.linalg.norm([one.coefficients[1] for one in series], axis=0)
    lengths = weights @ speed.reshape(len(nodes), pieces)
    return np.asarray(np.append(0.0, np.cumsum(lengths)) / lengths.sum())


def outside_of_formula(mistake: Problem, statement: Statement, text: str) -> Problem:
    """Adds to an error that the parameter has no value outside the formula."""
    found, name = mistake.diagnostic, statement.name
    if found.code != "E205" or found.span is None or name is None:
        return mistake
    if text[found.span.start : found.span.end] != name.text:
        return mistake
    before = [part.word for part in statement.parts if part.span.start <= found.span.start]
    message = f"'{name.text}' has a value in the formula of the curve alone"
    help = "what stands behind the formula holds for the whole curve"
    if before and before[-1] == "light":
        help += "; to change on the way, write: light red to blue"
    return problem("E205", message, found.span, "", help)


def _ends(
    lower_node: Expression, upper_node: Expression, scope: Scope
) -> tuple[float, float, Dimension]:
    """The limits of the parameter, and its dimension."""
    lower, upper = evaluate(lower_node, scope), evaluate(upper_node, scope)
    for value, node, word in ((lower, lower_node, "from"), (upper, upper_node, "to")):
        if not isinstance(value, Quantity):
            message = f"'{word}' needs a number, but this is {describe(value)}"
            raise problem("E218", message, node.span)
    assert isinstance(lower, Quantity)
    assert isinstance(upper, Quantity)
    dimension = upper.dimension if is_zero(lower) else lower.dimension
    start = typed_values.quantity(lower, lower_node, scope, "from", dimension)
    end = typed_values.quantity(upper, upper_node, scope, "to", dimension)
    if start == end:
        message = "this curve ends at the same value where it starts"
        raise problem("E242", message, upper_node.span)
    if not np.isfinite(end - start):
        raise problem("E201", "this number is too large", upper_node.span)
    return start, end, dimension


def _formula(
    node: Expression,
    name: str,
    dimension: Dimension,
    frame: Frame,
    scope: Scope,
    file: tuple[str, str],
) -> Formula:
    size, _ = size_of(node)
    if size > MOST_CURVE_STEPS:
        message = f"a formula of more than {MOST_CURVE_STEPS:,} numbers and signs"
        raise problem("E309", message, node.span, "", "use several curves")
    known = scope.values_of(names_in(node))
    columns = tuple(frame.vector(axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), vectors.Z))

    def formula(t: Taylor) -> tuple[Taylor, Taylor, Taylor]:
        try:
            # What is not finite is found and reported afterwards.
            with np.errstate(all="ignore"):
                names = {**known, name: Quantity(t, dimension)}
                point = _point(node, scope.with_names(names, Budget(MOST_CURVE_STEPS)))
                x, y, z = (0.0 * t + number for number in point.xyz)
                series = (_row(0, x, y, z), _row(1, x, y, z), _row(2, x, y, z))
            _check_finite(series, t, name, dimension, node.span)
        except Problem as mistake:
            raise ScriptError(*file, (mistake.diagnostic,)) from None
        return series

    def _row(i: int, x: Taylor, y: Taylor, z: Taylor) -> Taylor:
        a, b, c = columns[0][i], columns[1][i], columns[2][i]
        return a * x + b * y + c * z + frame.shift[i]

    return formula


def _point(node: Expression, scope: Scope) -> PointValue:
    value = evaluate(node, scope)
    if isinstance(value, PointValue) and (value.dimension == LENGTH or is_zero(value)):
        return value
    raise _no_point(value, node, scope)


def _no_point(value: Value, node: Expression, scope: Scope) -> Problem:
    if isinstance(value, PointValue):
        return typed_values.needs(node, value, scope, "curve", LENGTH)
    message = f"'curve' needs a point, but this is {describe(value)}"
    help = "for example: curve (r*cos(t), r*sin(t)) for t from 0 to 360 deg"
    return problem("E218", message, node.span, "", help)


def _check_finite(
    series: tuple[Taylor, ...], t: Taylor, name: str, dimension: Dimension, span: Span
) -> None:
    coefficients = np.array([one.coefficients for one in series])
    finite = (np.abs(coefficients) < LARGEST).all(axis=(0, 1))  # false for what is no number, too
    if finite.all():
        return
    first = int(np.argmin(finite))
    value = _shown(float(t.coefficients[0, first]), dimension)
    values_only = (np.abs(coefficients[:, 0, first]) < LARGEST).all()
    what = "speed" if values_only else "place"
    help = "choose the ends so that they leave this value out"
    raise problem("E243", f"the curve has no {what} at {name} = {value}", span, "", help)


def _shown(value: float, dimension: Dimension) -> str:
    if dimension == ANGLE:
        return f"{np.degrees(value):.6g} deg"
    if dimension == LENGTH:
        return f"{1e3 * value:.6g} mm"
    return f"{value:.6g}{' s' if dimension == TIME else ''}"


def heading_change(curve: Curve, axis: Vector, span: Span) -> float:
    """The angle [rad] by which a curve's direction rotates about a unit vector."""
    pieces = PIECES
    while True:
        turns = _turns(curve, axis, pieces, span)
        if np.abs(turns).max() < 0.5 or pieces >= MOST_PIECES:
            break
        pieces *= 4
    if np.abs(turns).max() > 0.5 * np.pi:
        message = "the curve turns back at one point, where a tool that follows would have to jump"
        raise pose_problem("E254", message, span, "", "draw two curves, or use: tool keep")
    return float(turns.sum())


def _turns(curve: Curve, axis: Vector, pieces: int, span: Span) -> Floats:
    """The rotation between each two neighbours of many points on a curve."""
    at = np.linspace(curve.lower, curve.upper, pieces + 1)
    try:
        series = curve.formula(Taylor.variable(at))
    except ScriptError as error:
        raise Problem(error.diagnostics[0]) from None
    tangent = np.array([one.coefficients[1] for one in series])  # (3, N); all may be backwards
    normal = np.array(axis)
    speed = np.linalg.norm(tangent, axis=0)
    flat = tangent - normal[:, None] * (normal @ tangent)
    if (np.linalg.norm(flat, axis=0) <= UPRIGHT * speed + 1e-12 * speed.max()).any():
        message = "the curve stands still or goes along the axis, so it has no heading to follow"
        raise pose_problem("E254", message, span, "", "use: tool keep, or tool look")
    sine = normal @ np.cross(flat[:, :-1], flat[:, 1:], axis=0)
    cosine = (flat[:, :-1] * flat[:, 1:]).sum(axis=0)
    turns: Floats = np.arctan2(sine, cosine)
    return turns
