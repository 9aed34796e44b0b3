"""Proportional and integral law on the error that rides with the reference."""

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


class IntegralGains(Gains):
    """Proportional and integral action; K_I = K_P^2 / 4 is critically damped, 10 1/s twice here."""

    K_P: Gain = Field(20.0, description="1/s, proportional")
    K_I: Gain = Field(100.0, description="1/s^2, integral; K_P^2 / 4 does not overshoot")


@controller("pi", source="ours, linear theory", gains=IntegralGains)
class PI:
    """Proportional and integral: no error is left under a constant disturbance; does not lag.

    Equation:
        q_dot = J_w^+ (Ad(x_e) xi_d - Ad(x_d) (K_P e + K_I s))
        s_dot = e
        e = [2 Im(r_b); p_b]
        x_b = x_d^* x = r_b + eps 1/2 p_b r_b
        x_e = x x_d^*
    Idea:
        The error, seen from the reference, is added up, and what has been added is sent against
        it: it comes to rest only where there is no error. Seen from there, what comes with the
        tool, as a bent one, stays the same while the tool turns.

    Error:
        at the reference's tool, along its axes.
    Stable:
        Near zero s^2 + K_P s + K_I = 0 for each of the six numbers, for all K_P, K_I > 0. A twist
        that is constant at the reference leaves nothing; one with the slope a leaves a / K_I.
    Fails:
        Where disturbances are fast: at frequencies above sqrt(K_I) it is no better than p. It
        overshoots after a jump. It does not add up while a limit clips the command.
    Try:
        dqpaint compare lag --controllers pi,hinf --plants ideal --disturb twist=x=0.05,z=0.02
    """

    batched = True

    def start(self, _arm: Arm, _motion: Motion, _gains: Schedule[IntegralGains]) -> None:
        """Begin with nothing added up."""
        self._sum = np.zeros(6)

    def __call__(self, seen: Seen, gains: IntegralGains) -> Floats:
        """The twist (..., 6)."""
        e = body_error(seen)
        back = gains.K_P * e + gains.K_I * self._sum
        free = ~np.asarray(seen.clipped)[..., None]
        self._sum = self._sum + seen.period * np.where(free, e, 0.0)
        x_e = spatial_error(seen.pose, seen.pose_d, seen.signed)
        return np.asarray(dq.adjoint(x_e, seen.twist_d) - dq.adjoint(seen.pose_d, back))
