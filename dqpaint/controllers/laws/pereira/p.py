"""Proportional law on the invariant error, after Pereira."""

from typing import ClassVar

from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import WHOLE_RUN, Gains
from dqpaint.controllers.base.matrices import Gain8, times
from dqpaint.controllers.base.pose_errors import (
    POINT_HELP,
    Point,
    invariant_error,
    spatial_error,
    twist_of_invariant_rate,
    twist_of_pose_rate,
)
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats


class EightGains(Gains):
    """The gain of an error of eight numbers."""

    k: Gain8 = Field(
        20.0,
        description="1/s, the rate at which a small error decays: a number, a diagonal of 8 or a "
        "symmetric matrix 8 x 8",
    )


class RateGains(EightGains):
    """One rate for rotation and translation, or a matrix, and where the error is taken."""

    constant: ClassVar[dict[str, str]] = {"point": WHOLE_RUN}

    point: Point = Field("tool", description=POINT_HELP)


@controller(
    "p", source="Pereira 2016, K [3.8]", gains=RateGains,
    paper={"k": 125.0}, paper_source="the best gain of its section 5.7, at 8 ms",
)  # fmt: skip
def p(seen: Seen, gains: RateGains) -> Floats:
    """Proportional: lags behind a moving light by speed / k.

    Equation:
        q_dot = N^+ K e
        e = vec(1 - x^* x_d)
        N q_dot = vec(x_dot^* x_d)
    Idea:
        The error is what is left of the way, seen from the tool: 1 where the tool is,
        x^* x_d where it should be. Each of its eight numbers is asked to shrink at the rate k;
        N^+ finds the joint rates that come nearest to it.

    Error:
        at the tool, the same from whatever base frame; point=base takes 1 - x x_d^* instead.
    Stable:
        At a set point, for K = K' > 0: V = 1/2 e' K e falls, V_dot = -|P K e|^2, with P the
        projector on the range of N. That has rank 6 of 8: what is left over is of second order.
        Held for a period T a small error needs k T < 2.
    Fails:
        On a moving light: it lags by speed / k, and cuts corners. It knows no disturbance: a
        constant one v leaves v / k.
    Try:
        dqpaint draw lag --controller p --gain k=10
    """
    if gains.point == "base":
        x_e = spatial_error(seen.pose, seen.pose_d, seen.signed)
        return twist_of_pose_rate(x_e, times(gains.k, dq.IDENTITY - x_e))
    error = invariant_error(seen.pose, seen.pose_d, seen.signed)
    return twist_of_invariant_rate(seen.pose, seen.goal, times(gains.k, error))
