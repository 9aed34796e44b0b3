"""Super-twisting law: second-order sliding on the error that rides with the reference."""

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.arm import Arm
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gain_schedule import Schedule
from dqpaint.controllers.base.gains import Gain, Gains
from dqpaint.controllers.base.pose_errors import body_error, spatial_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats
from dqpaint.motion import Motion

LEAST = 1e-12  # of an error, so that none divides by nothing


class SlopeGains(Gains):
    """The largest slopes of a disturbance that leave nothing."""

    L_O: Gain = Field(0.4, description="rad/s^2, the steepest change of an unknown rotation rate")
    L_T: Gain = Field(0.15, description="m/s^2, the steepest change of an unknown velocity")


@controller("super-twisting", source="Levant 1993, on this error ours", gains=SlopeGains)
class SuperTwisting:
    """Second-order sliding: exact under disturbances of bounded slope, and chatters.

    Equation:
        q_dot = J_w^+ (Ad(x_e) xi_d + Ad(x_d) u)
        u = -1.5 sqrt(L) e / sqrt(|e|) + z
        z_dot = -1.1 L e / |e|
        e = [2 Im(r_b); p_b]
        x_b = x_d^* x = r_b + eps 1/2 p_b r_b
    Idea:
        Near zero the root pulls harder than any linear gain, and z learns the disturbance: a
        steady error would make it grow without end. Rotation and translation each have their e,
        z and L.

    Error:
        at the reference's tool, along its axes, as pi.
    Stable:
        In finite time, to exactly nothing, for every disturbance whose slope stays below L
        (Levant's gains 1.5 and 1.1). Held for a period T an error of about L T^2 is left.
    Fails:
        It never rests: the command goes to and fro at every step, by about sqrt(L |e|), and noise
        in the measurement goes straight into it. From far away it is slow: 2 sqrt(|e|) / (1.5
        sqrt(L)) seconds.
    Try:
        dqpaint compare drift --controllers super-twisting,pi,hinf --plants ideal
    """

    batched = True

    def start(self, _arm: Arm, _motion: Motion, _gains: Schedule[SlopeGains]) -> None:
        """Begin with no disturbance known."""
        self._known = np.zeros(6)

    def __call__(self, seen: Seen, gains: SlopeGains) -> Floats:
        """The twist (..., 6)."""
        e = body_error(seen)
        free = ~np.asarray(seen.clipped)[..., None]
        pull, learned = np.empty_like(e), np.empty_like(e)
        for part, L in ((slice(0, 3), gains.L_O), (slice(3, 6), gains.L_T)):
            size = np.sqrt((e[..., part] ** 2).sum(-1, keepdims=True)) + LEAST
            pull[..., part] = -1.5 * np.sqrt(L / size) * e[..., part]
            learned[..., part] = -1.1 * L * np.where(free, e[..., part] / size, 0.0)
        u = pull + self._known
        self._known = self._known + seen.period * learned
        x_e = spatial_error(seen.pose, seen.pose_d, seen.signed)
        return np.asarray(dq.adjoint(x_e, seen.twist_d) + dq.adjoint(seen.pose_d, u))
