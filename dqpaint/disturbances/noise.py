"""Noise and resolution -> encoders with errors."""

from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from dqpaint.disturbances.disturbance import DISTURBANCES, Disturbance, Encoder

Size = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]


@DISTURBANCES.add("noise")
class EncoderNoise(Disturbance):
    """The encoders read angles with noise, or in steps; speeds are read off them.

    Equation:
        q_m = "step" round((q + n) / "step")
        n ~ N(0, "rms"^2)
    Idea:
        The law answers what is not there. The tool shakes by about the noise times the root of
        k T / 2, the commands by k times the noise.
    Fails:
        Rates are differences of readings: laws of torque suffer far more than laws of rates.
    Try:
        dqpaint compare lag --controllers "p(k=10),p(k=80)" --disturb noise=0.001
    """

    random_fields: ClassVar[tuple[str, ...] | None] = ("rms",)

    rms: Size = Field(0.0, description="rad of white noise at each reading")
    step: Size = Field(0.0, description="rad, the smallest step an encoder tells apart")

    def encoder(self, rows: int, joints: int, rng: np.random.Generator) -> Encoder | None:
        """Independent noise for each measurement, then rounding."""
        return Encoder(self.rms * rng.standard_normal((rows, joints)), self.step)
