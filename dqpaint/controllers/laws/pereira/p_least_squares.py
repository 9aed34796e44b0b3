"""Least squares of the invariant error against the analytic Jacobian, after Pereira."""

from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import WHOLE_RUN, Gain, Gains
from dqpaint.controllers.base.pose_errors import invariant_error, twist_of_pose_rate
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats


class LeastSquaresGains(Gains):
    """One rate, and the sign of the law."""

    constant: ClassVar[dict[str, str]] = {"form": WHOLE_RUN}

    k: Gain = Field(
        20.0,
        description="1/s; a small error decays at k cos(phi / 2) at most, phi the tool's angle",
    )
    form: Literal["derived", "printed"] = Field(
        "derived", description="-k J8^+ e, which comes home, or +k J8^+ e as (3.2) is printed"
    )


@controller("p-least-squares", source="Pereira 2016, [3.2]", gains=LeastSquaresGains)
def p_least_squares(seen: Seen, gains: LeastSquaresGains) -> Floats:
    """The least squares of the invariant error against J8: a step on the way to p; for study.

    Equation:
        q_dot = -k J_8^+ e
        e = vec(1 - x^* x_d)
        vec(x_dot) = J_8 q_dot
    Idea:
        The thesis asks for the joint rates that make |e - J_8 q_dot| least, before it
        differentiates e and gets p. But e is seen from the tool, near 1, and J_8 q_dot from the
        base, at x: they fit together only as far as the tool is turned like the base.

    Error:
        e at the tool, J_8 about the base's origin: mixed, which is what is wrong with it.
    Stable:
        Near a set point where the tool is turned by less than half a turn, with the sign of x
        whose scalar is positive: a small error decays at k cos(phi / 2) or slower, the farther from
        the base the slower, with phi the angle of the tool's orientation.
    Fails:
        As printed, form=printed, with +k: it runs away from every set point. At phi = 180 deg it
        stands still, and an error of more than about 120 deg may turn the long way. It lags.
    Try:
        dqpaint compare step --controllers p-least-squares,p --plants ideal
    """
    upright = np.where(seen.pose[..., :1] < 0, -seen.pose, seen.pose)
    rate = gains.k * invariant_error(seen.pose, seen.pose_d, seen.signed)
    return twist_of_pose_rate(upright, rate if gains.form == "printed" else -rate)
