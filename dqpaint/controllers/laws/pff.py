"""Proportional law with feed-forward on the invariant error, after Pereira."""

import numpy as np

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.pose_errors import twist_of_invariant_rate
from dqpaint.controllers.base.seen import Seen
from dqpaint.controllers.laws.p import RateGains
from dqpaint.dq import Floats
from dqpaint.robots.kinematics import pose_map


@controller("pff", source="Pereira 2016, K+FF [3.12]", gains=RateGains)
def pff(seen: Seen, gains: RateGains) -> Floats:
    """Proportional with feed-forward: does not lag.

    q_dot = N^+ (k e - vec(x* x_d_dot)), with x_d_dot = 1/2 xi_d x_d.

    As e_dot = -N q_dot - vec(x* x_d_dot), what is left is e_dot = -k e in the range of N.
    """
    back, x_d = dq.conj(seen.pose), dq.nearest(seen.pose_d, seen.pose)
    x_d_dot = np.matvec(pose_map(x_d), seen.twist_d)
    e = dq.IDENTITY - dq.mul(back, x_d)
    return twist_of_invariant_rate(seen.pose, x_d, gains.k * e - dq.mul(back, x_d_dot))
