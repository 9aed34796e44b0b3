"""An angle -> measured poses that show the tool beyond half a turn when it is just before it."""

from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.disturbances.disturbance import DISTURBANCES, Disturbance
from dqpaint.dq import Floats


@DISTURBANCES.add("adversary")
class Adversary(Disturbance):
    """The measured tool is turned on to the other side of half a turn, wherever it is near it.

    Equation:
        x_m = x exp(1/2 "angle" l) "where" theta > pi - "angle"
        r_d^* r = cos(theta / 2) + l sin(theta / 2)
    Idea:
        The worst that a small error of measurement can do to a law that takes the shorter of two
        ways anew at each step: it shows the other one, always. Real noise does it now and then.
    Fails:
        Away from half a turn it does nothing.
    Try:
        dqpaint compare half-turn --controllers hinf,hybrid --disturb adversary=0.05
    """

    random_fields: ClassVar[tuple[str, ...] | None] = ()

    angle: Annotated[float, Field(ge=0, le=1.5, allow_inf_nan=False)] = Field(
        0.0, description="rad by which the measured tool is turned on"
    )

    def misread(self, pose: Floats, pose_d: Floats) -> Floats:
        """Turned on about the axis of the error, at the tool."""
        goal = dq.nearest(pose_d, pose)
        turn = dq.quaternion_mul(goal[..., :4] * dq.C4, pose[..., :4])  # r_d* r
        sine = np.sqrt((turn[..., 1:] ** 2).sum(-1, keepdims=True))
        near = np.pi - 2.0 * np.arctan2(sine, turn[..., :1]) < self.angle
        axis = turn[..., 1:] / np.where(sine > 0, sine, 1.0)
        half = np.where(near, 0.5 * self.angle, 0.0) * axis
        return dq.mul(pose, dq.exp(np.concatenate([half, np.zeros_like(half)], axis=-1)))
