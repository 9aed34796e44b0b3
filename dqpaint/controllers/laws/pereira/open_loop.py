"""The reference's own twist and nothing else, after Pereira."""

from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import Gains
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats


class NoGains(Gains):
    """A law without feedback has no gains."""


@controller(
    "open-loop", source="Pereira 2016, [2.10] to [2.14]", gains=NoGains, controls="nothing"
)  # fmt: skip
def open_loop(seen: Seen, _gains: NoGains) -> Floats:
    """Open loop, the reference's twist alone: drifts away, whatever error there is stays.

    Equation:
        q_dot = J_w^+ xi_d
        q_k = q_0 + T sum_l J_w^+(q_l) xi_d(t_l) + sum_l b_l
    Idea:
        The rates that would follow the reference if nothing were ever wrong, one after the other.
        No error is looked at. What each step does wrong, b_l, adds up: the change of J_w within
        a period, a disturbance, a limit. This is what feedback is for.

    Error:
        none is taken; xi_d is a twist of space, the same for every reference point.
    Stable:
        Not at all: an error neither grows nor shrinks by itself, it is carried along.
    Fails:
        From the first step on: after a drawing of N steps the drift is of the order of the period,
        and a start off the reference stays off it.
    Try:
        dqpaint compare lag --controllers open-loop,pff --plants ideal --overlay
    """
    return seen.twist_d
