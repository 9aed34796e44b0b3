"""Resolved acceleration on the screw from the measured to the desired pose, after Chandra."""

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import Gains
from dqpaint.controllers.base.matrices import Gain6, times
from dqpaint.controllers.base.pose_errors import spatial_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats


class SpringGains(Gains):
    """Spring and damper of the error: s^2 + Kv s + Kp.

    The paper tuned (190, 6) on Baxter: 13.8 rad/s damped to 0.22 of critical, so an error swings
    for a second. These have both roots at 20 1/s: as fast as the other laws, and without swinging.
    """

    Kp: Gain6 = Field(
        400.0,
        description="1/s^2, stiffness; the paper took 190. A number, a diagonal of 6, rotation "
        "first, or a symmetric matrix 6 x 6",
    )
    Kv: Gain6 = Field(
        40.0, description="1/s, damping, 2 sqrt(Kp) is critical; the paper took 6. Likewise"
    )


@controller(
    "accel", source="Chandra 2020, coupled [35]", gains=SpringGains, commands="acceleration",
    paper={"Kp": 190.0, "Kv": 6.0}, paper_source="section 4, on Baxter at 200 Hz",
)  # fmt: skip
def accel(seen: Seen, gains: SpringGains) -> Floats:
    """Resolved acceleration, position and orientation as one screw: torques; does not lag.

    Equation:
        tau = H J_w^+ (a - J_w_dot q_dot) + C q_dot + G
        a = Ad(x_e^*) xi_d_dot + xi cross Ad(x_e^*) xi_d + K_v xi_e + 2 K_p log(x_e)
        x_e = x_d x^*
        xi_e = Ad(x_e^*) xi_d - xi
    Idea:
        The arm's own dynamics are computed and taken out; what is left behaves as a damped
        spring along the screw of the error: xi_e_dot + K_v xi_e + 2 K_p log(x_e) = 0. The first
        two terms are the derivative of Ad(x_e^*) xi_d but for its part in xi_e.

    Error:
        the same wherever it is taken while Kp and Kv are numbers; as diagonals or matrices they
        weigh the screw's numbers about the base's origin.
    Stable:
        With the exact model and K_p, K_v > 0, from any error short of half a turn; as numbers
        they are critically damped at K_v = 2 sqrt(K_p).
    Fails:
        With a wrong model: a wrong weight leaves an error, and a payload, friction and springs do.
        It wants a period of 5 ms or less.
    Try:
        dqpaint draw quarter-turn --controller accel --disturb payload=1
    """
    home = spatial_error(seen.pose, seen.pose_d, seen.signed)  # x x_d* = x_e*
    xi = seen.twist
    carried = dq.adjoint(home, seen.twist_d)
    forward = dq.adjoint(home, seen.acceleration_d) + dq.spatial_cross(xi, carried)
    screw = dq.log(dq.conj(home), short=not seen.signed)
    back = times(gains.Kv, carried - xi) + times(gains.Kp, 2.0 * screw)
    return np.asarray(forward + back)
