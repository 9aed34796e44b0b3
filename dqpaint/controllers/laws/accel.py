"""Resolved acceleration on the screw from the measured to the desired pose, after Chandra."""

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import Gain, Gains
from dqpaint.controllers.base.pose_errors import spatial_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats


class SpringGains(Gains):
    """Spring and damper of the error: s^2 + Kv s + Kp.

    The paper tuned (190, 6) on Baxter: 13.8 rad/s damped to 0.22 of critical, so an error swings
    for a second. These have both roots at 20 1/s: as fast as the other laws, and without swinging.
    """

    Kp: Gain = Field(400.0, description="1/s^2, stiffness; the paper took 190")
    Kv: Gain = Field(40.0, description="1/s, damping, 2 sqrt(Kp) is critical; the paper took 6")


@controller(
    "accel", source="Chandra 2020, coupled [35]", gains=SpringGains, commands="acceleration"
)
def accel(seen: Seen, gains: SpringGains) -> Floats:
    """Resolved acceleration, position and orientation as one screw: torques; does not lag.

    tau = H J_w^+ (a - J_w_dot q_dot) + C q_dot + G, with x_e = x_d x*,
    xi_e = Ad(x_e*) xi_d - xi, a = Ad(x_e*) xi_d_dot + xi x Ad(x_e*) xi_d + Kv xi_e + 2 Kp log x_e.

    The first two terms are the derivative of Ad(x_e*) xi_d but for xi_e's own part, so that
    xi_e_dot + Kv xi_e + 2 Kp log x_e = 0: a damped spring along the screw of the error.
    """
    home = spatial_error(seen.pose, seen.pose_d)  # x x_d* = x_e*
    xi = seen.twist
    carried = dq.adjoint(home, seen.twist_d)
    forward = dq.adjoint(home, seen.acceleration_d) + dq.spatial_cross(xi, carried)
    back = gains.Kv * (carried - xi) + 2.0 * gains.Kp * dq.log(dq.conj(home))
    return np.asarray(forward + back)
