"""Weights of the LQR laws -> their matrices within the intervals of a drawing."""

from typing import Any, ClassVar, TypeVar

import numpy as np
from pydantic import Field, ValidationInfo, field_validator

from dqpaint.controllers.base.gain_schedule import Schedule
from dqpaint.controllers.base.gains import Gains
from dqpaint.controllers.base.matrices import LEAST_GAIN, Value, as_value, matrix, read_value
from dqpaint.controllers.base.riccati import GAUSS
from dqpaint.dq import Floats


class Weights(Gains):
    """The weights of an LQR cost: 1/2 e's e at the end + 1/2 integral of e'q e + u'r u.

    Each is one number, a diagonal or a symmetric matrix. Far from the end the rate of the error is
    sqrt(q / r); towards it the gain goes to s / r. With s = sqrt(q r) it stays as it is, and that
    is what an s not given is; the thesis has s = 0, which lets the gain die away in the last
    moment.
    """

    size: ClassVar[int]
    constant: ClassVar[dict[str, str]] = {"s": "only its value at the end of the drawing counts"}

    q: Value = Field(
        4.0,
        description="weight of the error: a number, a diagonal or a symmetric matrix; it decays at "
        "sqrt(q / r) 1/s",
    )
    r: Value = Field(0.01, description="s^2, weight of the correction, likewise")
    s: Value | None = Field(
        None, description="s, weight of the error at the end; if not given sqrt(q r)"
    )

    @field_validator("q", "r", "s", mode="plain")
    @classmethod
    def _one_or_all(cls, value: Any, info: ValidationInfo) -> Value | None:
        if value is None and info.field_name == "s":
            return None
        return read_value(value, cls.size, 0.0 if info.field_name == "s" else LEAST_GAIN)

    @property
    def end_weight(self) -> Value:
        """The weight s of the error at the end, given or not: what P is far from the end."""
        if self.s is not None:
            return self.s
        if np.ndim(self.q) < 2 and np.ndim(self.r) < 2:
            return as_value(np.sqrt(np.multiply(self.q, self.r)))
        root = _root(matrix(self.r, self.size))  # P R^-1 P = Q with P = r^1/2 (..)^1/2 r^1/2
        back = np.linalg.inv(root)
        return as_value(root @ _root(back @ matrix(self.q, self.size) @ back) @ root)

    def as_dict(self) -> dict[str, Value | str]:
        """The weights, s also where it is not given."""
        return {**super().as_dict(), "s": self.end_weight}

    def end_matrix(self) -> Floats:
        """S (size, size)."""
        return matrix(self.end_weight, self.size)


def _root(square: Floats) -> Floats:
    """The symmetric square root of a symmetric positive definite matrix."""
    values, axes = np.linalg.eigh((square + square.T) / 2)
    root = (axes * np.sqrt(values)) @ axes.T
    return np.asarray((root + root.T) / 2)


W = TypeVar("W", bound=Weights)


def times_inverse(weight: Value, cost: Floats) -> Floats:
    """R^-1 p (..., m) of costs (..., m)."""
    R = np.asarray(weight)
    return np.asarray(
        cost / R if R.ndim < 2 else np.linalg.solve(R, np.asarray(cost)[..., None])[..., 0]
    )


def weights_at_gauss_points(
    gains: Schedule[W], first: int, last: int, rows: int
) -> tuple[Floats, Floats]:
    """R^-1 and Q (2, n, size, size) at the Gauss points of n intervals.

    Args:
        gains: over the drawing.
        first: the row at which the first interval begins.
        last: the row at which the last one ends.
        rows: of the whole drawing.
    """
    parts = (np.arange(first, last) + GAUSS[:, None]) / max(rows - 1, 1)
    return _matrices(gains, "r", parts, inverted=True), _matrices(gains, "q", parts)


def _matrices(gains: Schedule[W], name: str, parts: Floats, inverted: bool = False) -> Floats:
    size = type(gains.first).size
    if name in gains.knots:
        values = gains.column(name, parts.ravel())
        values = values.reshape(*parts.shape, *values.shape[1:])
    else:
        values = np.asarray(getattr(gains.first, name))[None, None]  # one for all
    if values.ndim < 4:
        values = values[..., None] if values.ndim == 2 else values
        values = np.broadcast_to(values, (*values.shape[:2], size))
        values = (1.0 / values if inverted else values)[..., None] * np.eye(size)
    elif inverted:
        inverse = np.linalg.inv(values)
        values = np.asarray((inverse + inverse.mT) / 2, dtype=np.float64)
    return np.broadcast_to(values, (*parts.shape, size, size))
