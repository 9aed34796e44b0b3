"""Syntax tree: statements and expressions with their spans, before names are evaluated."""

from dataclasses import fields, is_dataclass

from dqpaint.core import record
from dqpaint.diagnostics import Span

# Expressions.


@record
class Literal:
    """A number, perhaps with a unit straight after it."""

    value: float
    unit: str
    span: Span


@record
class Name:
    """A name, a constant, a colour, a profile or a unit."""

    name: str
    span: Span


@record
class Quoted:
    """A text in quotes."""

    text: str
    span: Span


@record
class Bracket:
    """One value, or the two or three numbers of a point, in brackets, perhaps with a unit."""

    values: tuple["Expression", ...]
    unit: str
    span: Span


@record
class Call:
    """A function call with its arguments."""

    name: str
    values: tuple["Expression", ...]
    span: Span


@record
class Negation:
    """A negated value."""

    value: "Expression"
    span: Span


@record
class SumOrProduct:
    """A sum or a product of any length: a flat node, so that long ones are not deep."""

    first: "Expression"
    rest: tuple[tuple[str, "Expression"], ...]
    span: Span


@record
class Power:
    """A base and its exponent."""

    base: "Expression"
    exponent: "Expression"
    span: Span


Expression = Literal | Name | Quoted | Bracket | Call | Negation | SumOrProduct | Power


def names_in(tree: object) -> set[str]:
    """The names, functions and calls used by an expression, or by a statement with its block."""
    names, left = set(), [tree]
    while left:  # no recursion: a tree may be deep
        node = left.pop()
        if isinstance(node, tuple):
            left.extend(node)
        elif isinstance(node, Name | Call):
            names.add(node.name)
        elif isinstance(node, Statement) and node.word == "call" and node.name is not None:
            names.add(node.name.text)
        if is_dataclass(node):
            left.extend(getattr(node, field.name) for field in fields(node))
    return names


def size_of(node: Expression) -> tuple[int, int]:
    """The number of nodes of an expression, and their greatest depth."""
    size, deepest, left = 0, 0, [(node, 1)]
    while left:
        inner, depth = left.pop()
        size, deepest = size + 1, max(deepest, depth)
        left.extend((child, depth + 1) for child in _children(inner))
    return size, deepest


def _children(node: Expression) -> tuple[Expression, ...]:
    match node:
        case Bracket(values) | Call(_, values):
            return values
        case Negation(value):
            return (value,)
        case SumOrProduct(first, rest):
            return (first, *(value for _, value in rest))
        case Power(base, exponent):
            return base, exponent
    return ()


# The values after `tool`, `light`, `brush`, `strobe`, `blend` and `corner`.


@record
class Word:
    """A word that is a name: in `let`, `repeat`, `curve`, `robot`."""

    text: str
    span: Span


@record
class ToolWords:
    """`keep`, `follow`, `look` (point, up), `look line` (point, along) or `turn` (orientation)."""

    mode: str
    values: tuple[Expression, ...]
    span: Span


@record
class ColourWords:
    """`on`, `off` or a colour (`word` is empty then), and its brightness."""

    word: str
    value: Expression | None
    brightness: float
    span: Span


@record
class LightWords:
    """One shade, or a gradient through several; `even` for constant brightness.

    `way` is `hue` for one through the hues between, `hue long` for the long way round them.
    """

    first: ColourWords
    rest: tuple[ColourWords, ...]
    span: Span
    even: bool = False
    way: str = ""


@record
class BrushPart:
    """A value of a brush with its name; several expressions for a row of colours.

    The span of a value that was written without its name is its own.
    """

    key: Word
    values: tuple[Expression, ...]


@record
class BrushWords:
    """The name of a brush and its values."""

    name: Word
    parts: tuple[BrushPart, ...]
    span: Span


@record
class StrobeWords:
    """The flash rate, None for `off`, and the duty cycle, 0 to 1."""

    frequency: Expression | None
    duty: float
    span: Span


@record
class BlendWords:
    """The distance within which corners are rounded; None for `off`."""

    size: Expression | None
    span: Span


@record
class CornerWords:
    """How far the path may be from a corner; None for `jump`."""

    deviation: Expression | None
    span: Span


Words = ToolWords | LightWords | BrushWords | StrobeWords | BlendWords | CornerWords


# Statements.


@record
class Part:
    """A part of a statement: its word and its value."""

    word: str
    span: Span  # of the word alone
    value: Expression | Words

    @property
    def expression(self) -> Expression:
        """The value of a part without a clause of its own; a flag's value is its own word."""
        assert not isinstance(self.value, Words)
        return self.value


@record
class Statement:
    """A line.

    Attributes:
        word: its first word, as in `words.STATEMENTS`; `call` for the call of a `def`.
        span: all of it.
        name: what it gives a name to, or the robot's; the `def` that is called.
        values: the values before its parts: of a `let`, a `hold`; the formula and the two ends of
            a `curve`; the count of a `repeat`, or its two ends; what a call hands over; the file
            of an `include`.
        parts: the parts, as they come.
        body: the lines of a block, or of the file that is included.
        broken: a mistake in it was reported; only its name and its body are to be trusted.
        params: the names of what a function or a `def` is handed; None for a `let` of a value.
    """

    word: str
    span: Span
    name: Word | None = None
    values: tuple[Expression, ...] = ()
    parts: tuple[Part, ...] = ()
    body: tuple["Statement", ...] = ()
    broken: bool = False
    params: tuple[Word, ...] | None = None

    def part(self, word: str) -> Part | None:
        """The first part of this name, or None."""
        for part in self.parts:
            if part.word == word:
                return part
        return None

    def value(self, word: str) -> Expression | None:
        """The value of the first part of this name that takes a plain expression."""
        part = self.part(word)
        return part.expression if part is not None else None

    def required(self, word: str) -> Expression:
        """The value of a part whose presence `statement_rules` has checked."""
        value = self.value(word)
        assert value is not None, word
        return value
