"""Texts of gains -> their values over a drawing: constant, or changing on the way.

    20                     a number
    1,1,1,4,4,4            a diagonal, where the law takes one
    2,1,0; 1,2,0; 0,0,3    a matrix, where the law takes one
    tool                   a word, where the law has a choice
    2.8..5.3@10%           from 2.8 evenly to 5.3 over the first 10 % of the drawing, then 5.3
    220..220@30%..270@30%  220 for the first 30 %, then 270: two values at one time are a jump

In general VALUE@PERCENT are points joined by straight lines; before the first and after the last
point the gain stays. Pereira 2016, (5.9) and Tables 5.11 and 5.12, are of this kind.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Generic, NamedTuple

import numpy as np
from pydantic import ValidationError

from dqpaint.controllers.base.gains import G, choices_of, list_gains
from dqpaint.controllers.base.matrices import Value, as_value, gain_text, parse_value, widened
from dqpaint.core import pydantic_reason
from dqpaint.dq import Floats
from dqpaint.errors import UsageError

GainText = Value | str
MOST_KNOTS = 1000
RAMP_HELP = (
    "write a number without a unit, or a ramp such as 5..20@10% (from 5 to 20 over the first 10 %)"
)

MATRIX_HELP = "write a matrix row by row, such as 2,1;1,2, its rows of one length"


class Knot(NamedTuple):
    """A value of a gain at a part of the drawing, 0 at its start and 1 at its end."""

    part: float
    value: Value


@dataclass(frozen=True)
class Schedule(Generic[G]):
    """The gains of a law over a drawing.

    Attributes:
        first: the gains at the start, checked.
        knots: of the gains that change, by name, in the order of time; every value was checked.
        texts: how these were written.
    """

    first: G
    knots: Mapping[str, tuple[Knot, ...]] = field(default_factory=dict)
    texts: Mapping[str, str] = field(default_factory=dict)

    def at(self, part: float) -> G:
        """The gains at a part of the drawing, 0 to 1."""
        return self.over(np.array([part]))[0]

    def over(self, parts: Floats) -> list[G]:
        """The gains at parts (N,) of the drawing, each from 0 to 1."""
        if not self.knots:
            return [self.first] * len(parts)
        columns = {name: self._rows(name, parts) for name in self.knots}
        model, fixed = type(self.first), dict(self.first)
        return [  # between values that are allowed all are: nothing to check again
            model.model_construct(**{**fixed, **dict(zip(columns, row, strict=True))})
            for row in zip(*columns.values(), strict=True)
        ]

    @property
    def bounded_in_steps(self) -> bool:
        """Whether the bounds are known in steps, too: of gains that do not change."""
        return self.first.bounded_in_steps and not self.knots

    def disturbance_bounds(self) -> tuple[float, float] | None:
        """The bounds on disturbances [s] that hold over the whole drawing: the weakest of all."""
        ends = [self.first.disturbance_bounds(), self.at(1.0).disturbance_bounds()]
        for name, knots in self.knots.items():
            rows = self.over(np.array([knot.part for knot in knots]))
            for knot, row in zip(knots, rows, strict=True):  # at a jump both values count
                ends.append(row.model_copy(update={name: knot.value}).disturbance_bounds())
        bounds = [end for end in ends if end is not None]
        return (max(b[0] for b in bounds), max(b[1] for b in bounds)) if bounds else None

    def column(self, name: str, parts: Floats) -> Floats:
        """One gain at parts (N,) of the drawing: numbers (N,), diagonals or matrices (N, m, m)."""
        if name in self.knots:
            return _interpolated(self.knots[name], parts)
        value = np.asarray(getattr(self.first, name), dtype=np.float64)
        return np.broadcast_to(value, (len(parts), *value.shape))

    def _rows(self, name: str, parts: Floats) -> list[Value]:
        return [as_value(row) for row in _interpolated(self.knots[name], parts)]

    def as_dict(self) -> dict[str, Any]:
        """The gains as a summary shows them: one that changes as it was written."""
        parts = sorted({0.0, *(knot.part for knots in self.knots.values() for knot in knots)})
        rows = [gains.as_dict() for gains in self.over(np.array(parts))]
        shown: dict[str, Any] = dict(rows[0])
        for name in shown:
            values: list[Any] = [row[name] for row in rows]
            if name in self.texts:
                shown[name] = self.texts[name]
            elif any(value != values[0] for value in values):  # it follows from one that changes
                later = zip(parts[1:], values[1:], strict=True)
                points = (f"{gain_text(value)}@{100 * part:g}%" for part, value in later)
                shown[name] = "..".join([gain_text(values[0]), *points])
        return shown


def _interpolated(knots: tuple[Knot, ...], parts: Floats) -> Floats:
    """The values at parts (N,): straight from knot to knot, the later one where two coincide."""
    at = np.array([knot.part for knot in knots])
    values = np.array([knot.value for knot in knots], dtype=np.float64)
    if at[0] > 0:  # before its first point a gain is what it is there
        at, values = np.append(0.0, at), np.concatenate([values[:1], values])
    inside = np.clip(parts, at[0], at[-1])
    i = np.clip(np.searchsorted(at, inside, side="right") - 1, 0, len(at) - 2)
    width = at[i + 1] - at[i]
    share = np.where(width > 0, (inside - at[i]) / np.where(width > 0, width, 1.0), 1.0)
    share = share.reshape(-1, *[1] * (values.ndim - 1))
    return np.asarray((1 - share) * values[i] + share * values[i + 1])


def read_schedule(model: type[G], given: Mapping[str, GainText], whose: str) -> Schedule[G]:
    """The gains of a model with the given ones replaced, each checked at every knot.

    Args:
        model: of the gains.
        given: numbers, diagonals or texts (see above) by the names of the gains.
        whose: how messages name the law.

    Raises:
        UsageError: an unknown name, no value, or one outside its range; lists the law's own.
    """
    fixed: dict[str, Any] = {}
    knots: dict[str, tuple[Knot, ...]] = {}
    texts: dict[str, str] = {}
    for name, value in given.items():
        if name not in model.model_fields:
            raise UsageError(f"{whose} has no gain named '{name}'; its gains: {list_gains(model)}")
        if not isinstance(value, str) or choices_of(model, name):
            fixed[name] = value
            continue
        points = _read_knots(name, value, whose, model)
        fixed[name] = points[0].value
        if len(points) > 1 and name in model.constant:
            raise UsageError(
                f"gain '{name}' of {whose} is '{value[:60]}', but can't change on the way: "
                f"{model.constant[name]}; its gains: {list_gains(model)}"
            )
        if len(points) > 1:
            knots[name], texts[name] = points, value
    first = _checked(model, fixed, whose)
    for name, points in knots.items():
        for knot in points[1:]:
            _checked(model, {**fixed, name: knot.value}, whose)
    return Schedule(first, knots, texts)


def _checked(model: type[G], values: Mapping[str, Any], whose: str) -> G:
    try:
        return model(**dict(values))
    except ValidationError as problem:
        first = problem.errors()[0]
        if not first["loc"]:  # a rule of the model for several gains together
            text = f"{whose}: {pydantic_reason(first)}"
        elif first["type"] == "value_error":
            text = f"gain '{first['loc'][0]}' of {whose} {pydantic_reason(first)}"
        else:
            shown = values[str(first["loc"][0])]
            said = gain_text(shown) if isinstance(shown, float | int) else str(shown)[:60]
            text = (
                f"gain '{first['loc'][0]}' of {whose} is {said}; {_range(model, first['loc'][0])}"
            )
        raise UsageError(f"{text}; its gains: {list_gains(model)}") from None


def _range(model: type[G], name: Any) -> str:
    """The range of a gain, from its model."""
    if words := choices_of(model, str(name)):
        return f"it is {' or '.join(words)}"
    limits = model.model_fields[str(name)].metadata
    low = next((limit.ge for limit in limits if hasattr(limit, "ge")), None)
    high = next((limit.le for limit in limits if hasattr(limit, "le")), None)
    if low is None or high is None:
        return "a gain is a finite number"
    return f"a gain is a number from {low:g} to {high:g}"


def _read_knots(name: str, text: str, whose: str, model: type[G]) -> tuple[Knot, ...]:
    """The knots of a text; one alone is a value that does not change."""
    pieces = text.split("..")
    if len(pieces) > MOST_KNOTS:
        raise UsageError(
            f"gain '{name}' of {whose} has {len(pieces)} points; a ramp has at most {MOST_KNOTS}"
        )
    try:
        points = [_knot(piece, i, len(pieces)) for i, piece in enumerate(pieces)]
        parts = [point.part for point in points]
        if parts != sorted(parts):
            raise ValueError
        values = widened([point.value for point in points])
        return tuple(map(Knot, parts, values))
    except ValueError:
        help_ = MATRIX_HELP if ";" in text else RAMP_HELP
        raise UsageError(
            f"gain '{name}' of {whose} is '{text[:60]}'; {help_}; its gains: {list_gains(model)}"
        ) from None


def _knot(text: str, i: int, count: int) -> Knot:
    value, sign, percent = text.partition("@")
    found = parse_value(value)
    if not sign:
        if 0 < i < count - 1:
            raise ValueError
        return Knot(float(i > 0), found)
    part = float(percent.strip().removesuffix("%")) / 100
    if not (percent.strip().endswith("%") and 0 <= part <= 1 and count > 1):
        raise ValueError
    return Knot(part, found)
