"""The field types of cards: checked numbers, and a frame on a link."""

from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from dqpaint import dq
from dqpaint.dq import Floats

LARGEST, LEAST = 1e9, 1e-9  # in the units of a card
Finite = Annotated[float, Field(ge=-LARGEST, le=LARGEST, allow_inf_nan=False)]
Three = tuple[Finite, Finite, Finite]
Positive = Annotated[float, Field(ge=LEAST, le=LARGEST, allow_inf_nan=False)]


class Part(BaseModel):
    """One table of a card: unknown fields are rejected, and it is immutable."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


class Mount(Part):
    """A frame on a link: position [m] and fixed-axis roll, pitch, yaw [deg]."""

    at_m: Three = (0.0, 0.0, 0.0)
    rpy_deg: Three = (0.0, 0.0, 0.0)

    @property
    def pose(self) -> Floats:
        """The frame as a dual quaternion (8,)."""
        roll, pitch, yaw = np.radians(self.rpy_deg) / 2
        x = np.array([np.cos(roll), np.sin(roll), 0, 0])
        y = np.array([np.cos(pitch), 0, np.sin(pitch), 0])
        z = np.array([np.cos(yaw), 0, 0, np.sin(yaw)])
        return dq.pose_from(self.at_m, dq.quaternion_mul(dq.quaternion_mul(z, y), x))
