"""The names that have a value at one place of a file."""

import math

from dqpaint.language import colours
from dqpaint.language.diagnostics import Span
from dqpaint.language.syntax import Expression
from dqpaint.language.units import PLAIN, UNITS
from dqpaint.language.values import Point, Quantity, TimeLaw, Tint, Value
from dqpaint.language.words import LAWS


class UnknownError(Exception):
    """A name whose own line had a mistake: that was reported, this is silent."""


UNIT_VALUES = {unit: Quantity(factor, kind) for unit, (factor, kind, _) in UNITS.items()}

# What every file knows.
BUILTINS: dict[str, Value] = {
    **{name: Tint(colour) for name, colour in colours.NAMES.items()},
    **{name: TimeLaw(name, (), False) for name in LAWS},
    **UNIT_VALUES,
    "pi": Quantity(math.pi, PLAIN),
    "x": Point((1.0, 0.0, 0.0), PLAIN),
    "y": Point((0.0, 1.0, 0.0), PLAIN),
    "z": Point((0.0, 0.0, 1.0), PLAIN),
}


class Scope:
    """The names that have a value at one place, and the text they were written in.

    A value of None belongs to a name whose line had a mistake.
    """

    __slots__ = ("names", "places", "text")

    def __init__(self, text: str) -> None:
        self.text = text
        self.names: dict[str, Value | None] = {}
        self.places: dict[str, Span] = {}

    def knows(self, name: str) -> bool:
        """Whether a name means something here."""
        return name in self.names or name in BUILTINS

    def with_name(self, name: str, value: Value) -> "Scope":
        """A copy that knows one name more."""
        inner = Scope(self.text)
        inner.names = {**self.names, name: value}
        return inner

    def written(self, node: Expression) -> str:
        """An expression as it stands in the text, in one line."""
        return " ".join(self.text[node.span.start : node.span.end].split())
