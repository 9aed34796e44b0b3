"""H-infinity tracking law in the dual-quaternion group, after Pereira."""

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.pose_errors import spatial_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.controllers.laws.hinf_set import GammaGains, correction
from dqpaint.dq import Floats


@controller("hinf", source="Pereira 2016, HIRT [3.33]", gains=GammaGains)
def hinf(seen: Seen, gains: GammaGains) -> Floats:
    """H-infinity with feed-forward: bounds what disturbances do, does not lag.

    q_dot = J_w^+ ([-K_O Im(r_e); -K_T p_e] + Ad(x_e) xi_d), with x_e = x x_d*.

    As x_e_dot = 1/2 (xi - Ad(x_e) xi_d) x_e, the error obeys the set-point law's equation, and its
    bounds hold along the way.
    """
    x_e = spatial_error(seen.pose, seen.pose_d)
    return correction(x_e, gains) + dq.adjoint(x_e, seen.twist_d)
