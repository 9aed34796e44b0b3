"""The names that have a value at one place of a file."""

import math
from collections.abc import Iterable

from dqpaint.diagnostics import Span
from dqpaint.language.syntax.tree import Expression
from dqpaint.language.values.values import ColourValue, PointValue, Quantity, Value
from dqpaint.language.vocabulary.units import PLAIN, UNITS
from dqpaint.language.vocabulary.words import PROFILES
from dqpaint.program import Profile, colours


class UnknownError(Exception):
    """A name whose own line had a mistake: that was reported, this is silent."""


UNIT_VALUES = {unit: Quantity(factor, kind) for unit, (factor, kind, _) in UNITS.items()}

# What every file knows.
BUILTINS: dict[str, Value] = {
    **{name: ColourValue(colour) for name, colour in colours.NAMES.items()},
    **{name: Profile(name) for name in PROFILES},
    **UNIT_VALUES,
    "pi": Quantity(math.pi, PLAIN),
    "x": PointValue((1.0, 0.0, 0.0), PLAIN),
    "y": PointValue((0.0, 1.0, 0.0), PLAIN),
    "z": PointValue((0.0, 0.0, 1.0), PLAIN),
}


MOST_STEPS = 1_000_000  # of all calls of a file's functions, a step for each part of a formula
MOST_CURVE_STEPS = 10_000  # of those in one formula of a curve, which works on whole series
DEEPEST_CALLS = 100  # parts of formulas within each other


class Budget:
    """What may still be spent on calls of the file's own functions."""

    __slots__ = ("depth", "steps")

    def __init__(self, steps: int = MOST_STEPS) -> None:
        self.steps = steps
        self.depth = 0


class Scope:
    """The names that have a value at one place, and the text they were written in.

    A value of None belongs to a name whose line had a mistake.
    """

    __slots__ = ("budget", "names", "places", "text")

    def __init__(self, text: str, budget: Budget | None = None) -> None:
        self.text = text
        self.budget = budget or Budget()
        self.names: dict[str, Value | None] = {}
        self.places: dict[str, Span] = {}

    def knows(self, name: str) -> bool:
        """Whether a name means something here."""
        return name in self.names or name in BUILTINS

    def forget_all_but(self, count: int) -> None:
        """Keeps only so many names, those that came first: a name never changes its place."""
        while len(self.names) > count:
            name, _ = self.names.popitem()
            self.places.pop(name, None)

    def known(self, names: Iterable[str]) -> dict[str, Value | None]:
        """Those of the names that have a value; it stays as it is when this scope goes on."""
        return {name: self.names[name] for name in names if name in self.names}

    def within(self, names: dict[str, Value | None], budget: Budget | None = None) -> "Scope":
        """Another scope, which knows these names alone."""
        inner = Scope(self.text, budget or self.budget)
        inner.names = names
        return inner

    def written(self, node: Expression) -> str:
        """An expression as it stands in the text, in one line."""
        return " ".join(node.span.text_in(self.text).split())
