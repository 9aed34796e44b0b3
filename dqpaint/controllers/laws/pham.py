"""Proportional law on the difference of dual quaternions, after Pham."""

from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.pose_errors import difference_error, twist_of_pose_rate
from dqpaint.controllers.base.seen import Seen
from dqpaint.controllers.laws.p import RateGains
from dqpaint.dq import Floats


@controller("pham", source="Pham 2010, pseudo-inverse [25]", gains=RateGains)
def pham(seen: Seen, gains: RateGains) -> Floats:
    """Proportional on the plain difference x_d - x: lags when moving.

    q_dot = J8^+ k e, with e = vec(x_d - x) and vec(x_dot) = J8 q_dot.

    At a set point e_dot = -J8 q_dot = -k P e, where P projects on the range of J8: the part of e in
    that range decays at the rate k; what is left of it is of second order in the error.
    """
    error = difference_error(seen.pose, seen.pose_d)
    return twist_of_pose_rate(seen.pose, gains.k * error)
