"""Names -> values at one point of a file, and the budget of calls."""

import math
from collections.abc import Iterable

from dqpaint.diagnostics import Span
from dqpaint.language.syntax.tree import Expression
from dqpaint.language.values.values import ColourValue, PointValue, Quantity, Value
from dqpaint.language.vocabulary.units import PLAIN, UNITS
from dqpaint.language.vocabulary.words import PROFILES
from dqpaint.program import SMOOTH, Profile, colours


class UnknownError(Exception):
    """A name whose definition had an error, which was reported: this one is not."""


UNIT_VALUES = {unit: Quantity(factor, kind) for unit, (factor, kind, _) in UNITS.items()}

# What every file knows.
BUILTINS: dict[str, Value] = {
    **{name: ColourValue(colour) for name, colour in colours.NAMES.items()},
    **{name: Profile(name) for name in PROFILES},
    "smooth": SMOOTH,
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
    """The number of calls of the file's own functions that are left."""

    __slots__ = ("depth", "steps")

    def __init__(self, steps: int = MOST_STEPS) -> None:
        self.steps = steps
        self.depth = 0


class Scope:
    """The names with a value at one point of a file, and the source text.

    A value of None belongs to a name whose line had a mistake.
    """

    __slots__ = ("budget", "names", "places", "text")

    def __init__(self, text: str, budget: Budget | None = None) -> None:
        self.text = text
        self.budget = budget or Budget()
        self.names: dict[str, Value | None] = {}
        self.places: dict[str, Span] = {}

    def defines(self, name: str) -> bool:
        """Whether a name is defined here."""
        return name in self.names or name in BUILTINS

    def forget_all_but(self, count: int) -> None:
        """Keep the first `count` names only: names are never reordered."""
        while len(self.names) > count:
            name, _ = self.names.popitem()
            self.places.pop(name, None)

    def values_of(self, names: Iterable[str]) -> dict[str, Value | None]:
        """A copy of the values of these names, as far as they are defined."""
        return {name: self.names[name] for name in names if name in self.names}

    def with_names(self, names: dict[str, Value | None], budget: Budget | None = None) -> "Scope":
        """A new scope with these names only."""
        inner = Scope(self.text, budget or self.budget)
        inner.names = names
        return inner

    def written(self, node: Expression) -> str:
        """The source text of an expression, in one line."""
        return " ".join(node.span.text_in(self.text).split())
