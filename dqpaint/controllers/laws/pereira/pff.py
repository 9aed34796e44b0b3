"""Proportional law with feed-forward on the invariant error, after Pereira."""

import numpy as np

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.matrices import times
from dqpaint.controllers.base.pose_errors import (
    spatial_error,
    twist_of_invariant_rate,
    twist_of_pose_rate,
)
from dqpaint.controllers.base.seen import Seen
from dqpaint.controllers.laws.pereira.p import RateGains
from dqpaint.dq import Floats
from dqpaint.robots.kinematics import pose_map


@controller(
    "pff", source="Pereira 2016, K+FF [3.12]", gains=RateGains,
    paper={"k": 125.0}, paper_source="the best gain of its section 5.7, at 8 ms",
)  # fmt: skip
def pff(seen: Seen, gains: RateGains) -> Floats:
    """Proportional with feed-forward: does not lag.

    Equation:
        q_dot = N^+ (K e - vec(x^* x_d_dot))
        e = vec(1 - x^* x_d)
        x_d_dot = 1/2 xi_d x_d
    Idea:
        The proportional law, and on top of it the motion that the reference makes anyway:
        as e_dot = -N q_dot - vec(x^* x_d_dot), what is left of the error is e_dot = -K e
        in the range of N.

    Error:
        at the tool, the same from whatever base frame; point=base takes 1 - x x_d^* instead.
    Stable:
        As p, and along a moving reference, too: for K = K' > 0 a small error decays at k.
        Held for a period T it needs k T < 2.
    Fails:
        Where the arm lags by itself: springs and delays turn a high k into oscillation. A
        constant disturbance v leaves v / k.
    Try:
        dqpaint compare lag --controllers p,pff
    """
    if gains.point == "base":
        x_e = spatial_error(seen.pose, seen.pose_d, seen.signed)
        back = twist_of_pose_rate(x_e, times(gains.k, dq.IDENTITY - x_e))
        return back + dq.adjoint(x_e, seen.twist_d)
    back, x_d = dq.conj(seen.pose), seen.goal
    x_d_dot = np.matvec(pose_map(x_d), seen.twist_d)
    e = dq.IDENTITY - dq.mul(back, x_d)
    rate = times(gains.k, e) - dq.mul(back, x_d_dot)
    return twist_of_invariant_rate(seen.pose, x_d, rate)
