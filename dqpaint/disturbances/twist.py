"""A size and a form -> an unmodelled twist of the tool, as in the H-infinity bound.

Pereira 2016, 3.3: x_dot = 1/2 (xi + v) x with v = [v_w; v_t] of bounded energy.
"""

import math
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from dqpaint.disturbances.disturbance import DISTURBANCES, Disturbance
from dqpaint.dq import Floats
from dqpaint.errors import UsageError

NOISE_WAVES = 64  # of different frequencies in a noise
LEAST_SIZE = 1e-9  # below it a size is a slip, and its square soon no number
Number = Annotated[float, Field(ge=-1e3, le=1e3, allow_inf_nan=False)]


@DISTURBANCES.add("twist")
class UnmodelledTwist(Disturbance):
    """The tool is carried along: constant, a sine, or band-limited noise."""

    form: Literal["constant", "sine", "noise"] = Field(
        "constant", description="constant, sine or noise"
    )
    x: Number = Field(0.0, description="m/s along the base's x; a sine's amplitude, a noise's rms")
    y: Number = Field(0.0, description="m/s along y")
    z: Number = Field(0.0, description="m/s along z")
    wx: Number = Field(0.0, description="rad/s about x, likewise")
    wy: Number = Field(0.0, description="rad/s about y")
    wz: Number = Field(0.0, description="rad/s about z")
    frequency: Annotated[float, Field(ge=1e-3, le=1e6, allow_inf_nan=False)] = Field(
        1.0, description="Hz of a sine; the upper edge of a noise's band"
    )

    @property
    def size(self) -> Floats:
        """The size (6,), angular [rad/s], then linear [m/s]."""
        return np.array([self.wx, self.wy, self.wz, self.x, self.y, self.z])

    @model_validator(mode="after")
    def _is_something(self) -> Self:
        if not self.size.any():
            raise ValueError("it has no effect; give for example x=0.01, in m/s")
        if ((self.size != 0) & (np.abs(self.size) < LEAST_SIZE)).any():
            raise ValueError(f"sizes must be 0, or +-({LEAST_SIZE:g} to 1000) m/s or rad/s")
        return self

    def twist(self, t: Floats, period: float, rng: np.random.Generator) -> Floats:
        """The velocity (N, 6) of the tool, angular first; noise is independent for each axis."""
        if self.form == "constant":
            return np.tile(self.size, (len(t), 1))
        half = 0.5 / period  # of a sine there, every row meets a zero
        if self.frequency > half or (self.form == "sine" and self.frequency > half * (1 - 1e-9)):
            raise UsageError(
                f"disturbance 'twist': frequency {self.frequency:g} Hz is not below {half:g} "
                f"Hz, half the rate of a period of {period * 1e3:g} ms"
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
