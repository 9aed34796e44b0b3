"""Weights of the LQR laws -> their diagonals within the intervals of a drawing."""

from typing import ClassVar, TypeVar

import numpy as np
from pydantic import Field, ValidationInfo, field_validator

from dqpaint.controllers.base.gain_schedule import Schedule
from dqpaint.controllers.base.gains import LARGEST_GAIN, LEAST_GAIN, Gains, Value
from dqpaint.controllers.base.riccati import GAUSS
from dqpaint.dq import Floats


class Weights(Gains):
    """The weights of an LQR cost: 1/2 e's e at the end + 1/2 integral of e'q e + u'r u.

    Each is one number or a whole diagonal. Far from the end the rate of the error is sqrt(q / r);
    towards it the gain goes to s / r. With s = sqrt(q r) it stays as it is, and that is what an
    s not given is; the thesis has s = 0, which lets the gain die away in the last moment.
    """

    size: ClassVar[int]
    constant: ClassVar[dict[str, str]] = {"s": "only its value at the end of the drawing counts"}

    q: Value = Field(
        4.0, description="weight of the error, a number or a diagonal; it decays at sqrt(q / r) 1/s"
    )
    r: Value = Field(0.01, description="s^2, weight of the correction")
    s: Value | None = Field(
        None, description="s, weight of the error at the end; if not given sqrt(q r)"
    )

    @field_validator("q", "r", "s")
    @classmethod
    def _one_or_all(cls, value: Value | None, info: ValidationInfo) -> Value | None:
        numbers = value if isinstance(value, tuple) else () if value is None else (value,)
        if isinstance(value, tuple) and len(value) != cls.size:
            raise ValueError(f"has {len(value)} numbers; it is one number or {cls.size}")
        least = 0.0 if info.field_name == "s" else LEAST_GAIN
        for number in numbers:
            if not least <= number <= LARGEST_GAIN:
                raise ValueError(f"is {number:g}; a weight is from {least:g} to {LARGEST_GAIN:g}")
        return value

    @property
    def end_weight(self) -> Value:
        """The weight s of the error at the end, given or not."""
        if self.s is not None:
            return self.s
        product = np.sqrt(np.multiply(self.q, self.r)).tolist()
        return tuple(product) if isinstance(product, list) else float(product)

    def as_dict(self) -> dict[str, Value]:
        """The weights, s also where it is not given."""
        return {**super().as_dict(), "s": self.end_weight}

    def end_diagonal(self) -> Floats:
        """The diagonal of S (size,)."""
        return np.broadcast_to(np.asarray(self.end_weight, dtype=np.float64), (self.size,))


W = TypeVar("W", bound=Weights)


def weights_at_gauss_points(
    gains: Schedule[W], first: int, last: int, rows: int
) -> tuple[Floats, Floats]:
    """The diagonals of R^-1 and Q (2, n, size) at the Gauss points of n intervals.

    Args:
        gains: over the drawing.
        first: the row at which the first interval begins.
        last: the row at which the last one ends.
        rows: of the whole drawing.
    """
    parts = (np.arange(first, last) + GAUSS[:, None]) / max(rows - 1, 1)
    q, r = (_diagonals(gains, name, parts) for name in ("q", "r"))
    return 1.0 / r, q


def _diagonals(gains: Schedule[W], name: str, parts: Floats) -> Floats:
    values = gains.column(name, parts.ravel()).reshape(*parts.shape, -1)
    return np.broadcast_to(values, (*parts.shape, type(gains.first).size))
