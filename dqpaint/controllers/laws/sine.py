"""Dual-sine law: a screw motion to the reference without a logarithm."""

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import Gain, Gains
from dqpaint.controllers.base.pose_errors import spatial_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats


class SineGains(Gains):
    """One rate."""

    k: Gain = Field(20.0, description="1/s, the rate at which a small error decays")


@controller("sine", source="Sjoberg & Egeland, dual sine; feed-forward ours", gains=SineGains)
def sine(seen: Seen, gains: SineGains) -> Floats:
    """Along the screw to the reference by its dual sine: no logarithm; does not lag.

    Equation:
        q_dot = J_w^+ (-2 k vec(Im(x_e)) + Ad(x_e) xi_d)
        x_e = x x_d^*
        Im(x_e) = sin(1/2 theta + eps 1/2 d) (l + eps m)
    Idea:
        The imaginary part of x_e, dual and all, is a twist about the screw axis of the error: the
        sine of half the dual angle, where log has the angle itself. So the tool screws home along
        the same axis, for a product and a sign.

    Error:
        the same wherever it is taken, as log.
    Stable:
        From any error short of half a turn; V = 2 (1 - eta): V_dot = -2 k |Im(r_e)|^2. The screw's
        axis stays, theta_dot = -2 k sin(theta / 2) and d_dot = -k d cos(theta / 2).
    Fails:
        Far away: near half a turn the advance d stands still, and theta decays at two thirds of
        the rate of log.
    Try:
        dqpaint compare step --controllers sine,log,hinf --plants ideal
    """
    x_e = spatial_error(seen.pose, seen.pose_d, seen.signed)
    return np.asarray(-2.0 * gains.k * dq.vector(x_e) + dq.adjoint(x_e, seen.twist_d))
