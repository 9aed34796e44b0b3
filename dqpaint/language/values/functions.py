"""Checked arguments of the language's functions -> values."""

import math
from collections.abc import Callable

from dqpaint.diagnostics import Fix, Problem, Span, problem
from dqpaint.language.syntax.tree import Expression, Literal
from dqpaint.language.values import vectors
from dqpaint.language.values.values import (
    ColourValue,
    Orientation,
    PointValue,
    Quantity,
    Value,
    axis_of,
    describe,
    is_zero,
)
from dqpaint.language.vocabulary.units import (
    ACCELERATION,
    ANGLE,
    JERK,
    PLAIN,
    SPEED,
    TURN_ACCELERATION,
    TURNSPEED,
    Dimension,
    dimension_name,
    plausible_unit,
)
from dqpaint.language.vocabulary.words import FUNCTIONS
from dqpaint.program import Profile, Taylor, colours, taylor
from dqpaint.program import Value as Scalar


class Arguments:
    """The arguments of a function call, with their source text."""

    __slots__ = ("_text", "function", "nodes", "span", "values")

    def __init__(
        self,
        function: str,
        values: list[Value],
        nodes: tuple[Expression, ...],
        span: Span,
        text: str,
    ) -> None:
        self.function = function
        self.values = values
        self.nodes = nodes
        self.span = span
        self._text = text

    def written(self, i: int) -> str:
        """The source text of an argument."""
        span = self.nodes[i].span
        return span.text_in(self._text)

    def number(self, i: int, dimension: Dimension = PLAIN) -> Scalar:
        """A number of this dimension."""
        value = self.values[i]
        if isinstance(value, Quantity) and (value.dimension == dimension or is_zero(value)):
            return value.value
        raise self._mismatch(i, dimension)

    def constant(self, i: int, dimension: Dimension = PLAIN) -> float:
        """A number of this dimension that does not depend on a curve's parameter."""
        number = self.number(i, dimension)
        if isinstance(number, Taylor):
            message = f"{self.function} can't change along a curve"
            help = "for a tool that turns on the way, use: tool follow, or tool look"
            raise problem("E231", message, self.nodes[i].span, "", help)
        return number

    def _mismatch(self, i: int, dimension: Dimension) -> Problem:
        value, span, written = self.values[i], self.nodes[i].span, self.written(i)
        help = f"write: {FUNCTIONS.get(self.function) or PROFILE_CALLS[self.function]}"
        plain = isinstance(value, Quantity) and value.dimension == PLAIN
        if plain and len(self.nodes) == 1 and dimension == ANGLE:
            join = " " if isinstance(self.nodes[i], Literal) else "*"  # `30 deg`, but `a*deg`
            ways = (f"{self.function}({written}{join}{unit})" for unit in ("deg", "rad"))
            help = f"say which: {' or '.join(ways)}"
        elif plain and isinstance(value, Quantity) and not isinstance(value.value, Taylor):
            unit = plausible_unit(value.value, dimension)
            help = f"did you mean {written} {unit}?" if unit else help
        elif dimension == PLAIN and isinstance(value, Quantity):
            help = "divide it by a unit to get a plain number"
        needed = dimension_name(dimension)
        message = f"{self.function} needs {needed}, this is {describe(value)}"
        return problem("E213", message, span, "", help)


def _angle_function(f: Callable[[Scalar], Scalar]) -> Callable[[Arguments], Value]:
    return lambda given: Quantity(f(given.number(0, ANGLE)), PLAIN)


def _inverse(f: Callable[[Scalar], Scalar]) -> Callable[[Arguments], Value]:
    return lambda given: Quantity(f(given.number(0)), ANGLE)


def _plain_function(f: Callable[[Scalar], Scalar]) -> Callable[[Arguments], Value]:
    return lambda given: Quantity(f(given.number(0)), PLAIN)


def _sqrt(given: Arguments) -> Value:
    a, b, c, d = _quantity(given, 0).dimension
    root = taylor.sqrt(_quantity(given, 0).value)
    return Quantity(root, (a / 2, b / 2, c / 2, d / 2))


def _abs(given: Arguments) -> Value:
    value = _quantity(given, 0)
    return Quantity(taylor.absolute(value.value), value.dimension)


def _extreme(f: Callable[[Scalar, Scalar], Scalar]) -> Callable[[Arguments], Value]:
    def extreme(given: Arguments) -> Value:
        first = _quantity(given, 0)
        dimension = next(
            (q.dimension for q in given.values if isinstance(q, Quantity) and not is_zero(q)), PLAIN
        )
        result = given.number(0, dimension) if is_zero(first) else first.value
        for i in range(1, len(given.values)):
            result = f(result, given.number(i, dimension))
        return Quantity(result, dimension)

    return extreme


def _quantity(given: Arguments, i: int) -> Quantity:
    value = given.values[i]
    if not isinstance(value, Quantity):
        message = f"{given.function} needs a number, this is {describe(value)}"
        raise problem("E213", message, given.nodes[i].span)
    return value


def _polar(given: Arguments) -> Value:
    radius, angle = _quantity(given, 0), given.number(1, ANGLE)
    x, y = radius.value * taylor.cos(angle), radius.value * taylor.sin(angle)
    return PointValue((x, y, 0.0), radius.dimension)


def _rgb(given: Arguments) -> Value:
    """Red, green and blue of sRGB from 0 to 1, as in CSS."""
    shares = [given.constant(i) for i in range(3)]
    for share, node in zip(shares, given.nodes, strict=True):
        if not 0.0 <= share <= 1.0:
            message = f"red, green and blue of rgb go from 0 to 1, this is {share:g}"
            written = f"rgb({', '.join(f'{x:g}/255' for x in shares)})"
            fits = all(0.0 <= x <= 255.0 for x in shares)
            fix = Fix(f"write {written}", given.span, written) if fits else None
            help = f"of 255: {written}" if fits else ""
            raise problem("E217", message, node.span, "", help, fix)
    red, green, blue = map(colours.linear, shares)
    return ColourValue((red, green, blue))


def _hsv(given: Arguments) -> Value:
    hue = given.constant(0, ANGLE)
    rest = []
    for i in range(1, len(given.values)):
        share = given.constant(i)
        if not 0.0 <= share <= 1.0:
            message = f"saturation and value of hsv go from 0 to 1, this is {share:g}"
            raise problem("E217", message, given.nodes[i].span)
        rest.append(share)
    saturation, value = [*rest, 1.0, 1.0][:2]
    return ColourValue(colours.from_hsv(hue / (2.0 * math.pi), saturation, value))


def _rpy(given: Arguments) -> Value:
    roll, pitch, yaw = (given.constant(i, ANGLE) for i in range(3))
    return Orientation(vectors.turn_of_rpy(roll, pitch, yaw))


def _rot(given: Arguments) -> Value:
    axis = axis_of(given.nodes[0], given.values[0])
    if not isinstance(axis, PointValue):
        message = f"rot needs a direction, this is {describe(axis)}"
        help = "for example: rot(z, 30 deg) or rot((1, 1, 0), 30 deg)"
        raise problem("E213", message, given.nodes[0].span, "", help)
    if any(isinstance(number, Taylor) for number in axis.xyz):
        given.constant(1, ANGLE)
        message, help = "rot can't change along a curve", "use: tool follow, or tool look"
        raise problem("E231", message, given.nodes[0].span, "", help)
    x, y, z = (float(number) for number in axis.xyz if not isinstance(number, Taylor))
    angle = given.constant(1, ANGLE)
    if x == y == z == 0.0:
        raise problem("E215", "a direction can't be (0, 0, 0)", given.nodes[0].span)
    return Orientation(vectors.turn_about(vectors.unit((x, y, z)), angle))


UNIT_LENGTH_TOLERANCE = 1e-3  # of a quaternion: three digits written by hand


def _quat(given: Arguments) -> Value:
    w, x, y, z = (given.constant(i) for i in range(4))
    size = math.hypot(w, x, y, z)
    if abs(size - 1.0) > UNIT_LENGTH_TOLERANCE:
        message = f"this quaternion has length {size:.4g}; an orientation needs length 1"
        raise problem("E214", message, given.span, "", "the order is quat(w, x, y, z)")
    return Orientation((w / size, x / size, y / size, z / size))


def _profile(given: Arguments) -> Value:
    """Boundary rates: speeds, then accelerations, all of the point or all of the orientation."""
    values = given.values
    angular = any(
        isinstance(v, Quantity) and v.dimension in (TURNSPEED, TURN_ACCELERATION) for v in values
    )
    speed, acceleration = (TURNSPEED, TURN_ACCELERATION) if angular else (SPEED, ACCELERATION)
    rates = [given.constant(i, speed if i < 2 else acceleration) for i in range(len(values))]
    for rate, node in zip(rates, given.nodes, strict=True):
        if abs(rate) > LARGEST_RATE:
            raise problem("E201", "this number is too large", node.span)
    return Profile(given.function, tuple(rates), angular)


def _smooth(given: Arguments) -> Value:
    """The largest acceleration and jerk along the path."""
    acceleration, jerk = given.constant(0, ACCELERATION), given.constant(1, JERK)
    for value, node, kind in zip((acceleration, jerk), given.nodes, NAMES_OF_BOTH, strict=True):
        if not value > 0.0:
            raise problem("E220", f"smooth needs {kind} greater than 0", node.span)
        size = "large" if value > 1.0 else "small"
        if not 1 / LARGEST_RATE < value < LARGEST_RATE:
            raise problem("E201", f"this number is too {size}", node.span)
    return Profile("smooth", (), False, acceleration, jerk)


NAMES_OF_BOTH = ("an acceleration", "a jerk")
LARGEST_RATE = 1e9  # of a profile, in SI units

_Function = Callable[[Arguments], Value]

# Each function and how many values it takes, at least and at most.
TABLE: dict[str, tuple[_Function, int, int]] = {
    "sin": (_angle_function(taylor.sin), 1, 1),
    "cos": (_angle_function(taylor.cos), 1, 1),
    "tan": (_angle_function(taylor.tan), 1, 1),
    "asin": (_inverse(taylor.asin), 1, 1),
    "acos": (_inverse(taylor.acos), 1, 1),
    "atan": (_inverse(taylor.atan), 1, 1),
    "sqrt": (_sqrt, 1, 1),
    "abs": (_abs, 1, 1),
    "min": (_extreme(taylor.minimum), 2, 64),
    "max": (_extreme(taylor.maximum), 2, 64),
    "exp": (_plain_function(taylor.exp), 1, 1),
    "ln": (_plain_function(taylor.ln), 1, 1),
    "polar": (_polar, 2, 2),
    "rgb": (_rgb, 3, 3),
    "hsv": (_hsv, 1, 3),
    "rpy": (_rpy, 3, 3),
    "rot": (_rot, 2, 2),
    "quat": (_quat, 4, 4),
    "constant": (_profile, 0, 0),
    "trapezoid": (_profile, 0, 0),
    "cubic": (_profile, 2, 2),
    "quintic": (_profile, 4, 4),
    "smooth": (_smooth, 2, 2),
}
PROFILE_CALLS = {
    "constant": "constant",
    "trapezoid": "trapezoid",
    "cubic": "cubic(V0, V1)",
    "quintic": "quintic(V0, V1, A0, A1)",
    "smooth": "smooth(ACCELERATION, JERK)",
}

_DOMAINS = {
    "sqrt": "the square root of a negative number does not exist",
    "ln": "the logarithm of zero or a negative number does not exist",
    "asin": "no angle has a sine beyond -1 and 1",
    "acos": "no angle has a cosine beyond -1 and 1",
}


def call(given: Arguments) -> Value:
    """The value of a function call."""
    function, least, most = TABLE[given.function]
    count = len(given.values)
    if not least <= count <= most:
        needed = (
            str(least)
            if least == most
            else f"{least} to {most}"
            if most < 64
            else f"{least} or more"
        )
        noun = "value" if needed == "1" else "values"
        message = f"{given.function} takes {needed if needed != '0' else 'no'} {noun}, not {count}"
        help = f"write: {FUNCTIONS.get(given.function) or PROFILE_CALLS[given.function]}"
        raise problem("E207", message, given.span, "", help)
    try:
        return function(given)
    except ValueError:
        message = _DOMAINS.get(given.function, f"{given.function} has no value here")
        shown = f"this is {_shown(given.values[0])}"
        raise problem("E212", message, given.nodes[0].span, shown) from None
    except OverflowError:
        raise problem("E201", "this number is too large", given.span) from None


def _shown(value: Value) -> str:
    if isinstance(value, Quantity) and not isinstance(value.value, Taylor):
        return f"{value.value:g}" if value.dimension == PLAIN else describe(value)
    return describe(value)
