"""A form and a size, or a file -> six signals over time: of a twist, or of a displacement."""

import math
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from dqpaint.core import NumberTable
from dqpaint.disturbances.disturbance import Disturbance
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError

NOISE_WAVES = 64  # of different frequencies in a noise
LEAST_SIZE = 1e-9  # below it a size is a slip, and its square soon no number
LARGEST_SIZE = 1e3
MOST_NAMED = 8  # columns of a file in a message
Number = Annotated[float, Field(ge=-LARGEST_SIZE, le=LARGEST_SIZE, allow_inf_nan=False)]


class FromFile(Disturbance):
    """A disturbance whose course may be in a CSV: `t_s` and some of `columns`, the others zero.

    Between two rows it goes straight from one to the next; before the first and after the last
    there is none. With a file its other values stay as they are.
    """

    columns: ClassVar[tuple[str, ...]]
    beside: ClassVar[tuple[str, ...]] = ()
    """Values that a file leaves open."""

    @property
    def path(self) -> str:
        """The file, which a kind of it declares as its last value; empty if there is none."""
        return str(getattr(self, "file", ""))

    @model_validator(mode="after")
    def _one_of_both(self) -> Self:
        others = self.model_fields_set - {"file", *self.beside}
        if self.path and others:
            raise ValueError(f"has a file, {self.path}: leave out {', '.join(sorted(others))}")
        return self

    def check(self, t: Floats) -> None:
        """Check that a file says something of the time of a run."""
        if self.path and not self.course(t).any():
            raise UsageError(
                f"{Path(self.path).name} says nothing but zeros from 0 s to the end of the "
                f"drawing ({t[-1]:.4g} s)"
            )

    def course(self, t: Floats) -> Floats:
        """The columns (N, k) at times (N,) [s].

        Raises:
            DqpaintError: the file cannot be read, or is no such table; it names row and column.
        """
        _, times, rows = self.rows
        each = [np.interp(t, times, column, left=0.0, right=0.0) for column in rows.T]
        return np.stack(each, axis=-1)

    @cached_property
    def rows(self) -> tuple[str, Floats, Floats]:
        """SHA-256 of the file, times (M,) [s] and columns (M, k); DqpaintError as in `course`."""
        table = NumberTable(self.path, "file of a disturbance")
        there = [name for name in self.columns if name in table.names]
        if not there:
            has = ", ".join(table.names[:MOST_NAMED])
            raise DqpaintError(
                f"{table.name} has none of the columns {', '.join(self.columns)}; it has: {has}"
            )
        times, values = table.times(), table.columns(there)
        far = np.argwhere(np.abs(values) > self.largest)
        if len(far):
            row, i = far[0]
            text = f"{values[row, i]:.6g} is more than a disturbance may be ({self.largest:g})"
            raise table.fault(table.rows[row], there[i], text)
        found = np.zeros((len(times), len(self.columns)))
        found[:, [self.columns.index(name) for name in there]] = values
        return table.sha256, times, found

    def summary(self) -> dict[str, Any]:
        """Its values, of a file its name and SHA-256."""
        found = super().summary()
        if self.path:
            found |= {"file": Path(self.path).name, "sha256": self.rows[0]}
        return found

    @property
    def largest(self) -> float:
        """The largest value of a column."""
        return LARGEST_SIZE


class SixSignals(FromFile):
    """Signals along and about the base's axes: constant, a sine, band-limited noise, or a file's.

    A kind of it declares `form`, `x` to `wz` and `frequency` with their units.
    """

    form: Literal["constant", "sine", "noise"] = "constant"
    x: Number = 0.0
    y: Number = 0.0
    z: Number = 0.0
    wx: Number = 0.0
    wy: Number = 0.0
    wz: Number = 0.0
    frequency: Annotated[float, Field(ge=1e-3, le=1e6, allow_inf_nan=False)] = 1.0
    kind: ClassVar[str]
    unit: ClassVar[str]

    @property
    def size(self) -> Floats:
        """The size (6,), angular, then linear."""
        return np.array([self.wx, self.wy, self.wz, self.x, self.y, self.z])

    @property
    def is_random(self) -> bool:
        """Whether it is noise of its own making."""
        return self.form == "noise" and not self.path

    @property
    def may_swing(self) -> bool:
        """Whether it is a sine, or comes from a file."""
        return bool(self.path) or self.form == "sine"

    @model_validator(mode="after")
    def _is_something(self) -> Self:
        if self.path:
            return self
        if not self.size.any():
            raise ValueError(f"it has no effect; give for example x=0.01, in {self.unit}")
        if ((self.size != 0) & (np.abs(self.size) < LEAST_SIZE)).any():
            raise ValueError(f"sizes must be 0, or +-({LEAST_SIZE:g} to 1000) {self.unit}")
        return self

    def signals(self, t: Floats, period: float, rng: np.random.Generator) -> Floats:
        """The six signals (N, 6), angular first; noise is independent for each axis.

        Raises:
            UsageError: a frequency that does not go with the period.
            DqpaintError: the file is at fault.
        """
        if self.path:
            return self.course(t)
        if self.form == "constant":
            return np.tile(self.size, (len(t), 1))
        half = 0.5 / period  # of a sine there, every row meets a zero
        if self.frequency > half or (self.form == "sine" and self.frequency > half * (1 - 1e-9)):
            raise UsageError(
                f"disturbance '{self.kind}': frequency {self.frequency:g} Hz is not below "
                f"{half:g} Hz, half the rate of a period of {period * 1e3:g} ms"
            )
        if self.form == "sine":
            return np.sin(2 * np.pi * self.frequency * t)[:, None] * self.size
        return _noise(t, self.frequency, rng) * self.size


def _noise(t: Floats, edge: float, rng: np.random.Generator) -> Floats:
    """Six signals (N, 6) of unit rms without any part above `edge` [Hz]: waves of random phase."""
    frequencies = edge * (np.arange(NOISE_WAVES) + 0.5) / NOISE_WAVES
    phases = rng.uniform(0, 2 * np.pi, (NOISE_WAVES, 6))
    out = np.zeros((len(t), 6))
    for frequency, phase in zip(frequencies, phases, strict=True):
        out += np.cos(2 * np.pi * frequency * t[:, None] + phase)
    return out * math.sqrt(2 / NOISE_WAVES)
