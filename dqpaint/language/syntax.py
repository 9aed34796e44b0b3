"""The syntax tree: what was written, with its place, before anything is known about its meaning."""

from dataclasses import dataclass

from dqpaint.language.diagnostics import Span

# Expressions.


@dataclass(frozen=True, slots=True)
class Literal:
    """A number, perhaps with a unit straight after it."""

    value: float
    unit: str
    span: Span


@dataclass(frozen=True, slots=True)
class Name:
    """A name, a constant, a colour, a law or a unit."""

    name: str
    span: Span


@dataclass(frozen=True, slots=True)
class Quoted:
    """A text in quotes."""

    text: str
    span: Span


@dataclass(frozen=True, slots=True)
class Bracket:
    """One value, or the two or three numbers of a point, in brackets, perhaps with a unit."""

    values: tuple["Expression", ...]
    unit: str
    span: Span


@dataclass(frozen=True, slots=True)
class Call:
    """A function with its values."""

    name: str
    values: tuple["Expression", ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Sign:
    """A value with its sign changed."""

    value: "Expression"
    span: Span


@dataclass(frozen=True, slots=True)
class Chain:
    """A sum or a product of any length, so that a long one is not a deep one."""

    first: "Expression"
    rest: tuple[tuple[str, "Expression"], ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Power:
    """A base and its exponent."""

    base: "Expression"
    exponent: "Expression"
    span: Span


Expression = Literal | Name | Quoted | Bracket | Call | Sign | Chain | Power


def names_in(node: Expression) -> set[str]:
    """The names an expression uses."""
    match node:
        case Name(name):
            return {name}
        case Bracket(values) | Call(_, values):
            return set().union(*map(names_in, values))
        case Sign(value):
            return names_in(value)
        case Chain(first, rest):
            return names_in(first).union(*(names_in(value) for _, value in rest))
        case Power(base, exponent):
            return names_in(base) | names_in(exponent)
    return set()


# What stands after `tool` and `light`.


@dataclass(frozen=True, slots=True)
class ToolWords:
    """`keep`, `follow`, `look` (point, up), `look line` (point, along) or `turn` (orientation)."""

    mode: str
    values: tuple[Expression, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Shade:
    """`on`, `off` or a colour (`word` is empty then), and its brightness."""

    word: str
    value: Expression | None
    brightness: float
    span: Span


@dataclass(frozen=True, slots=True)
class LightWords:
    """One shade, or one that goes over into another."""

    first: Shade
    last: Shade | None
    span: Span


# Statements.


@dataclass(frozen=True, slots=True)
class Word:
    """A word that names something: in `let`, `repeat`, `curve`, `robot`."""

    text: str
    span: Span


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a statement: its word and its value."""

    word: str
    span: Span  # of the word alone
    value: Expression | ToolWords | LightWords

    @property
    def expression(self) -> Expression:
        """The value of a part that takes neither tool nor light."""
        assert not isinstance(self.value, ToolWords | LightWords)
        return self.value


@dataclass(frozen=True, slots=True)
class Statement:
    """A line.

    Attributes:
        word: its first word, as in `words.STATEMENTS`.
        span: all of it.
        name: what it gives a name to, or the robot's.
        values: the values before its parts: of a `let`, a `hold`; the formula and the two ends of
            a `curve`; the count of a `repeat`, or its two ends.
        parts: the parts, as they come.
        body: the lines of a block.
        broken: a mistake in it was reported; only its name and its body are to be trusted.
    """

    word: str
    span: Span
    name: Word | None = None
    values: tuple[Expression, ...] = ()
    parts: tuple[Part, ...] = ()
    body: tuple["Statement", ...] = ()
    broken: bool = False

    def part(self, word: str) -> Part | None:
        """The first part of this name."""
        for part in self.parts:
            if part.word == word:
                return part
        return None

    def value(self, word: str) -> Expression | None:
        """The value of the part of this name, one that takes a plain expression."""
        part = self.part(word)
        return part.expression if part is not None else None

    def given(self, word: str) -> Expression:
        """The value of a part that is there, as `forms` saw to."""
        value = self.value(word)
        assert value is not None, word
        return value
