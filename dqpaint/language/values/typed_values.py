"""Expression of a part -> value of the part's kind: a length after `rise`, a point after `to`."""

import math

from dqpaint.diagnostics import Fix, Problem, closest, did_you_mean, problem
from dqpaint.language.syntax.tree import Call, Expression, Literal, Name
from dqpaint.language.values import vectors
from dqpaint.language.values.evaluate import evaluate
from dqpaint.language.values.expression_errors import with_unit
from dqpaint.language.values.scope import Scope
from dqpaint.language.values.values import (
    ColourValue,
    FrameValue,
    Orientation,
    PointValue,
    Quantity,
    TextValue,
    Value,
    axis_of,
    describe,
    is_zero,
)
from dqpaint.language.values.vectors import Frame
from dqpaint.language.vocabulary.units import (
    ANGLE,
    FREQUENCY,
    LENGTH,
    PITCH,
    PLAIN,
    SPEED,
    TEMPERATURE,
    TIME,
    TURNSPEED,
    Dimension,
    dimension_name,
)
from dqpaint.language.vocabulary.words import PARTS, PROFILES, STATEMENTS
from dqpaint.program import Colour, Profile, Quaternion, Taylor, Vector, colours

# The dimension of each part that takes one number.
_DIMENSIONS = {
    "length": LENGTH,
    "angle": ANGLE,
    "rotation": ANGLE,
    "time": TIME,
    "speed": SPEED,
    "turnspeed": TURNSPEED,
    "pitch": PITCH,
    "number": PLAIN,
}
_OTHERS = {
    "period": TIME,
    "hold": TIME,
    "strobe": FREQUENCY,
    "blend": LENGTH,
    "corner": LENGTH,
    "wall": LENGTH,
    "keep": LENGTH,
}
# Of lengths [m], angles [rad] and times [s]: far above any drawing, and the fourth power of it,
# scaled as much again, is still a computer's number.
LARGEST = 1e9
_LARGEST_COUNT = 10**15  # of samples; far above what is ever allowed, far below what overflows


def dimension_of(word: str) -> Dimension:
    """The dimension of the number after a part's word."""
    if word in _OTHERS:
        return _OTHERS[word]
    return _DIMENSIONS[PARTS[word].takes]


def number(node: Expression, scope: Scope, word: str) -> float:
    """The number after `word`, in SI units."""
    return quantity(evaluate(node, scope), node, scope, word, dimension_of(word))


def quantity(
    value: Value, node: Expression, scope: Scope, word: str, dimension: Dimension
) -> float:
    """A number of this dimension; a plain 0 fits any."""
    if isinstance(value, Quantity) and (value.dimension == dimension or is_zero(value)):
        assert not isinstance(value.value, Taylor)
        if dimension != PLAIN and abs(value.value) > LARGEST:
            raise problem("E201", "this number is too large", node.span)
        return value.value
    raise needs(node, value, scope, word, dimension)


def positive(node: Expression, scope: Scope, word: str) -> float:
    """The number after `word`, which must be positive."""
    size = number(node, scope, word)
    if size > 0.0:
        return size
    kind = dimension_name(dimension_of(word))
    label = "this is 0" if size == 0.0 else "this is less than 0"
    message = f"'{word}' needs {kind} greater than 0"
    raise problem("E220", message, node.span, label)


def not_negative(node: Expression, scope: Scope, word: str) -> float:
    """The number after `word`, which may be 0."""
    return 0.0 if number(node, scope, word) == 0.0 else positive(node, scope, word)


def count(node: Expression, scope: Scope, word: str, least: int) -> int:
    """A whole number after `word`."""
    value = evaluate(node, scope)
    size = quantity(value, node, scope, word, PLAIN)
    if abs(size) > _LARGEST_COUNT:
        raise problem("E201", "this number is too large", node.span)
    if abs(size - round(size)) > 1e-9:
        message = f"'{word}' needs a whole number, this is {size:g}"
        raise problem("E221", message, node.span)
    if round(size) < least:
        message = f"'{word}' needs a whole number from {least} on, this is {round(size)}"
        raise problem("E221", message, node.span)
    return round(size)


def place(node: Expression, scope: Scope, word: str) -> Vector:
    """The point after `word`: its three lengths."""
    value = evaluate(node, scope)
    if isinstance(value, PointValue):
        if value.dimension == LENGTH or is_zero(value):
            at = floats(value)
            if max(map(abs, at)) > LARGEST:
                raise problem("E201", "this point is too far away", node.span)
            return at
        raise needs(node, value, scope, word, LENGTH)
    message = f"'{word}' needs a point, but this is {describe(value)}"
    help = "a point has 2 or 3 numbers in brackets: (10, 20) mm"
    if isinstance(value, Quantity) and value.dimension == LENGTH:
        help = f"a point has 2 or 3 numbers in brackets: ({scope.written(node)}, 0)"
    raise problem("E218", message, node.span, "", help)


def direction(node: Expression, scope: Scope, word: str) -> Vector:
    """The unit vector after `word`, from a point with or without a unit."""
    value = axis_of(node, evaluate(node, scope))
    if not isinstance(value, PointValue) or value.dimension not in (PLAIN, LENGTH):
        message = f"'{word}' needs a direction, but this is {describe(value)}"
        help = f"for example: {word} z, or {word} (0, 1, 1)"
        raise problem("E218", message, node.span, "", help)
    if not any(floats(value)):
        raise problem("E215", "a direction can't be (0, 0, 0)", node.span)
    return vectors.unit(floats(value))


def frame(node: Expression, scope: Scope) -> Frame:
    """The frame of this name."""
    if isinstance(node, Name) and not scope.defines(node.name):
        frames = [name for name, value in scope.names.items() if isinstance(value, FrameValue)]
        help = did_you_mean(closest(node.name, frames))
        help = help or f"name it first: frame {node.name} at (30, 0) mm"
        raise problem("E205", f"'{node.name}' is not known", node.span, "", help)
    value = evaluate(node, scope)
    if isinstance(value, FrameValue):
        return value.frame
    message = f"'frame' needs a frame, but this is {describe(value)}"
    help = "name one first: frame leaf at (30, 0) mm turned 45 deg"
    raise problem("E218", message, node.span, "", help)


def rotation(node: Expression, scope: Scope, word: str) -> Quaternion:
    """An orientation, or an angle about z."""
    value = evaluate(node, scope)
    if isinstance(value, Orientation):
        return value.quaternion
    return vectors.turn_about(vectors.Z, quantity(value, node, scope, word, ANGLE))


def orientation(node: Expression, scope: Scope, word: str) -> Quaternion:
    """The orientation after `word`."""
    value = evaluate(node, scope, ("keep", "follow", "look"))
    if isinstance(value, Orientation):
        return value.quaternion
    message = f"'{word}' needs an orientation, but this is {describe(value)}"
    help = "for example: rpy(0 deg, 0 deg, 90 deg), rot(z, 90 deg), look (0, 0, 0)"
    raise problem("E218", message, node.span, "", help)


def profile(node: Expression, scope: Scope) -> Profile:
    """The name and the boundary rates after `profile`."""
    value = evaluate(node, scope, PROFILES)
    if isinstance(value, Profile):
        return value
    message = f"'profile' needs a profile, but this is {describe(value)}"
    raise problem("E218", message, node.span, "", f"one of: {', '.join(PROFILES)}")


def colour(node: Expression, scope: Scope, after_to: bool = False, word: str = "light") -> Colour:
    """The colour after a word: a colour, a text with one, or a temperature."""
    value = evaluate(node, scope, colours.NAMES)
    if isinstance(value, ColourValue):
        return value.rgb
    if isinstance(value, TextValue):
        return _colour_of_text(node, value.text)
    if isinstance(value, Quantity) and value.dimension == TEMPERATURE:
        kelvin = float(value.value) if not isinstance(value.value, Taylor) else math.nan
        if not colours.COLDEST <= kelvin <= colours.HOTTEST:
            message = "a colour temperature goes from 1000 K to 15000 K"
            raise problem("E217", message, node.span, f"this is {kelvin:g} K")
        return colours.from_temperature(kelvin)
    message = f"'{word}' needs a colour, but this is {describe(value)}"
    help = f'for example: {word} red, {word} hsv(30 deg), {word} "#ff8800", {word} 5600 K'
    if after_to and isinstance(value, PointValue):
        help = "after a colour, 'to' says which colour comes next; write 'light' after the point"
    raise problem("E218", message, node.span, "", help)


def _colour_of_text(node: Expression, text: str) -> Colour:
    rgb = colours.from_hex(text[1:]) if text.startswith("#") else colours.NAMES.get(text.lower())
    if rgb is not None:
        return rgb
    if text.startswith("#") or colours.from_hex(text) is not None:
        message = f'"{text}" is not a colour'
        raise problem(
            "E216", message, node.span, "", 'a # and 3 or 6 digits from 0 to f: "#ff8800"'
        )
    meant = closest(text, colours.NAMES)
    help = did_you_mean(meant) or 'for example: red, hsv(30 deg), "#ff8800"'
    fix = Fix(f"write {meant}", node.span, f'"{meant}"') if meant else None
    raise problem("E216", f'there is no colour "{text}"', node.span, "", help, fix)


def floats(value: PointValue) -> Vector:
    """The numbers of a point outside a curve."""
    x, y, z = value.xyz
    assert not isinstance(x, Taylor)
    assert not isinstance(y, Taylor)
    assert not isinstance(z, Taylor)
    return x, y, z


def needs(node: Expression, value: Value, scope: Scope, word: str, dimension: Dimension) -> Problem:
    """E218: the value has another kind than the part takes."""
    needed = dimension_name(dimension)
    if word in ("repeat", "samples", "scale"):
        needed = "a plain number"
    if isinstance(value, Quantity | PointValue) and value.dimension == PLAIN and dimension != PLAIN:
        written = with_unit(node, value, dimension, scope, word)
        message = f"'{word}' needs {needed}, but this has no unit"
        help = f"write {written}" if written else f"for example: {_example(word)}"
        fix = Fix(help, node.span, written) if written else None
        return problem("E218", message, node.span, "no unit", help, fix)
    help, fix = (f"for example: {_example(word)}" if _example(word) else ""), None
    if isinstance(value, Quantity | PointValue):
        kind = value.dimension
        per_time = tuple(a - b for a, b in zip(kind, TIME, strict=True))
        per_angle = tuple(a - b for a, b in zip(kind, ANGLE, strict=True))
        per = ""
        if dimension == per_time and dimension in (SPEED, TURNSPEED):
            per = "/s"
        elif dimension == per_angle == PITCH:
            per = "/turn"
        elif kind == tuple(-n for n in dimension) and "/" in scope.written(node):
            help = "a unit belongs to the number before it: half of it is (1/2) mm, or 0.5 mm"
        elif kind == (1.0, 0.0, 1.0, 0.0) and dimension == LENGTH:
            help = "an angle becomes a plain number when it is divided by rad"
        if per:
            help = f"write {scope.written(node)}{per}"
            if isinstance(node, Literal | Name | Call):
                fix = Fix(help, node.span, f"{scope.written(node)}{per}")
    shown = describe(value)
    if isinstance(value, PointValue) and word in ("to", "by") and value.dimension != PLAIN:
        shown = dimension_name(value.dimension)
    message = f"'{word}' needs {needed}, but this is {shown}"
    return problem("E218", message, node.span, "", help, fix)


def _example(word: str) -> str:
    word = word.partition(" ")[0]
    if word in PARTS:
        return PARTS[word].example
    return STATEMENTS[word].example if word in STATEMENTS else ""
