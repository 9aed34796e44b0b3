"""Noise and resolution -> encoders with errors."""

from typing import Annotated

import numpy as np
from pydantic import Field

from dqpaint.disturbances.disturbance import DISTURBANCES, Disturbance, Encoder

Size = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]


@DISTURBANCES.add("noise")
class EncoderNoise(Disturbance):
    """The encoders read angles with noise, or in steps; speeds are read off them."""

    rms: Size = Field(0.0, description="rad of white noise at each reading")
    step: Size = Field(0.0, description="rad, the smallest step an encoder tells apart")

    def encoder(self, rows: int, joints: int, rng: np.random.Generator) -> Encoder | None:
        """Independent noise for each measurement, then rounding."""
        return Encoder(self.rms * rng.standard_normal((rows, joints)), self.step)
