"""Proportional law on the invariant error, after Pereira."""

from pydantic import Field

from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import Gain, Gains
from dqpaint.controllers.base.pose_errors import invariant_error, twist_of_invariant_rate
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats


class RateGains(Gains):
    """One rate for rotation and translation."""

    k: Gain = Field(20.0, description="1/s, the rate at which a small error decays")


@controller("p", source="Pereira 2016, K [3.8]", gains=RateGains)
def p(seen: Seen, gains: RateGains) -> Floats:
    """Proportional: lags behind a moving light by speed / k.

    q_dot = N^+ k e, with e = vec(1 - x* x_d) and N q_dot = vec(x_dot* x_d).

    At a set point e_dot = -N q_dot = -k P e, where P projects on the range of N: the part of e in
    that range decays at the rate k; what is left of it is of second order in the error.
    """
    error = invariant_error(seen.pose, seen.pose_d)
    return twist_of_invariant_rate(seen.pose, seen.pose_d, gains.k * error)
