"""Typed values and their arithmetic: quantities, points, orientations, colours, texts, frames."""

import math

from dqpaint.core import record
from dqpaint.diagnostics import Span, problem
from dqpaint.language.syntax.tree import Expression, Name, Statement, Word
from dqpaint.language.values import vectors
from dqpaint.language.vocabulary.units import (
    LARGEST_EXPONENT,
    LENGTH,
    PLAIN,
    Dimension,
    dimension_name,
)
from dqpaint.program import Colour, Profile, Quaternion, Taylor, taylor
from dqpaint.program import Value as Scalar


@record
class Quantity:
    """A number in SI units with its dimension; in a curve, a Taylor series."""

    value: Scalar
    dimension: Dimension


@record
class PointValue:
    """Three numbers of one dimension: a position, a shift, or without a unit a direction."""

    xyz: tuple[Scalar, Scalar, Scalar]
    dimension: Dimension


@record
class Orientation:
    """A unit quaternion, scalar first."""

    quaternion: Quaternion


@record
class ColourValue:
    """A colour: linear RGB."""

    rgb: Colour


@record
class TextValue:
    """A text in quotes."""

    text: str


@record
class FrameValue:
    """A named frame."""

    frame: vectors.Frame


@record
class Function:
    """A function of the file: its parameters, its formula, and the names in its scope.

    `size` and `depth` are those of the formula, as `syntax.size_of` counts them.
    """

    name: str
    params: tuple[str, ...]
    body: Expression
    known: dict[str, "Value | None"]
    size: int
    depth: int


@record
class Procedure:
    """A `def` of the file: its parameters, its lines, and the names in their scope.

    `size` is how many statements a call of it is at least.
    """

    name: str
    params: tuple[Word, ...]
    body: tuple[Statement, ...]
    known: dict[str, "Value | None"]
    size: int


Value = (
    Quantity
    | PointValue
    | Orientation
    | ColourValue
    | Profile
    | TextValue
    | FrameValue
    | Function
    | Procedure
)


def describe(value: Value) -> str:
    """The kind of a value with its article, for messages."""
    match value:
        case Quantity(_, dimension):
            return dimension_name(dimension)
        case PointValue(_, dimension):
            if dimension == LENGTH:
                return "a point"
            if dimension == PLAIN:
                return "a point without a unit"
            return f"a point whose numbers are each {dimension_name(dimension)}"
        case Orientation():
            return "an orientation"
        case ColourValue():
            return "a colour"
        case Profile():
            return "a profile"
        case TextValue():
            return "a text"
        case FrameValue():
            return "a frame"
        case Function():
            return "a function"
        case Procedure():
            return "a def"


def is_zero(value: Value) -> bool:
    """Whether a value is a plain 0 or a point of plain zeros, which need no unit."""
    if isinstance(value, Quantity):
        return value.dimension == PLAIN and _none(value.value)
    if isinstance(value, PointValue):
        return value.dimension == PLAIN and all(map(_none, value.xyz))
    return False


def _none(number: Scalar) -> bool:
    return not isinstance(number, Taylor) and number == 0.0


AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def axis_of(node: Expression, value: Value) -> Value:
    """The value of a direction: x, y and z are the axes, unless the file gives them another."""
    if isinstance(value, PointValue) or not isinstance(node, Name) or node.name not in AXES:
        return value
    return PointValue(AXES[node.name], PLAIN)


def finite(number: Scalar, span: Span) -> Scalar:
    """A number that is checked to be finite; a series is checked where it is used."""
    if isinstance(number, Taylor) or math.isfinite(number):
        return number
    if math.isnan(number):
        raise problem("E201", "this has no value", span)
    raise problem("E201", "this number is too large", span)


def checked_finite(value: Value, span: Span) -> Value:
    """A value all of whose numbers are checked to be finite."""
    if isinstance(value, Quantity):
        finite(value.value, span)
    elif isinstance(value, PointValue):
        for number in value.xyz:
            finite(number, span)
    return value


def sum_of(left: Value, right: Value, sign: str) -> Value | None:
    """The sum or difference; None if it is not defined."""
    if isinstance(left, Quantity) and isinstance(right, Quantity):
        if left.dimension != right.dimension:
            if is_zero(right):
                return left
            if not is_zero(left):
                return None
            return right if sign == "+" else negative(right)
        if sign == "+":
            return Quantity(left.value + right.value, left.dimension)
        return Quantity(left.value - right.value, left.dimension)
    if isinstance(left, PointValue) and isinstance(right, PointValue):
        if left.dimension != right.dimension:
            if is_zero(right):
                return left
            if not is_zero(left):
                return None
            return right if sign == "+" else negative(right)
        (a, b, c), (d, e, f) = left.xyz, right.xyz
        if sign == "+":
            return PointValue((a + d, b + e, c + f), left.dimension)
        return PointValue((a - d, b - e, c - f), left.dimension)
    return None


def product_of(left: Value, right: Value) -> Value | None:
    """The product; None if it is not defined."""
    if isinstance(left, Quantity):
        if isinstance(right, Quantity):
            return Quantity(left.value * right.value, _times(left.dimension, right.dimension, 1.0))
        if isinstance(right, PointValue):
            k, (a, b, c) = left.value, right.xyz
            return PointValue((k * a, k * b, k * c), _times(left.dimension, right.dimension, 1.0))
        return None
    if isinstance(left, PointValue) and isinstance(right, Quantity):
        return product_of(right, left)
    if isinstance(left, Orientation) and isinstance(right, Orientation):
        return Orientation(vectors.turn_product(left.quaternion, right.quaternion))
    return None


def quotient_of(left: Value, right: Value, span: Span) -> Value | None:
    """The quotient; None if it is not defined. `span` is that of the divisor."""
    if not isinstance(right, Quantity):
        return None
    k = right.value
    if not isinstance(k, Taylor) and k == 0.0:
        raise problem("E203", "division by zero", span, "this is 0")
    if isinstance(left, Quantity):
        return Quantity(left.value / k, _times(left.dimension, right.dimension, -1.0))
    if isinstance(left, PointValue):
        a, b, c = left.xyz
        return PointValue((a / k, b / k, c / k), _times(left.dimension, right.dimension, -1.0))
    return None


def negative(value: Value) -> Value | None:
    """The value with the opposite sign; None if it is not defined."""
    if isinstance(value, Quantity):
        return Quantity(-value.value, value.dimension)
    if isinstance(value, PointValue):
        a, b, c = value.xyz
        return PointValue((-a, -b, -c), value.dimension)
    return None


def power_of(base: Quantity, exponent: Quantity) -> Quantity | None:
    """A power; None if the base's unit does not allow it."""
    if base.dimension == PLAIN:
        return Quantity(taylor.power(base.value, exponent.value), PLAIN)
    if isinstance(exponent.value, Taylor):
        return None
    dimension = _times(PLAIN, base.dimension, exponent.value)
    if max(map(abs, dimension)) > LARGEST_EXPONENT:
        return None
    return Quantity(taylor.power(base.value, exponent.value), dimension)


def _times(left: Dimension, right: Dimension, exponent: float) -> Dimension:
    return (
        left[0] + exponent * right[0],
        left[1] + exponent * right[1],
        left[2] + exponent * right[2],
        left[3] + exponent * right[3],
    )
