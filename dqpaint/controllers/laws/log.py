"""Logarithmic law in the dual-quaternion group, after Ozgur and Mezouar."""

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import Gain, Gains
from dqpaint.controllers.base.pose_errors import spatial_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats


class LogGains(Gains):
    """One rate, and whether the law looks ahead."""

    k: Gain = Field(20.0, description="1/s, the rate at which the error decays, however large")
    feed_forward: float = Field(
        1.0, ge=0.0, le=1.0, allow_inf_nan=False,
        description="share of Ad(x_e) xi_d that is added; 0 is the paper's own set-point law",
    )  # fmt: skip


@controller("log", source="Ozgur & Mezouar 2016, feed-forward ours", gains=LogGains)
def log(seen: Seen, gains: LogGains) -> Floats:
    """Along the screw to the reference: the error decays evenly; does not lag.

    Equation:
        q_dot = J_w^+ (-2 k log(x_e) + "feed_forward" Ad(x_e) xi_d)
        x_e = x x_d^*
        x_e_dot = 1/2 (xi - Ad(x_e) xi_d) x_e
    Idea:
        Between two poses there is one screw motion. The tool goes back along it, turning and
        advancing in step, as a nut on its bolt: log(x_e) is the half of that screw.

    Error:
        the same wherever it is taken: a screw is a thing of space, so every reference point and
        every frame give the same joint rates.
    Stable:
        From any error short of half a turn: d/dt log(x_e) = -k log(x_e) holds exactly, one rate
        however large the error is. Held for a period T it needs k T < 2.
    Fails:
        At half a turn, where two screws are equally short. feed_forward=0, the paper's own law,
        is one for set points and lags by speed / k.
    Try:
        dqpaint compare step --controllers log,hinf-set,p --plants ideal
    """
    x_e = spatial_error(seen.pose, seen.pose_d, seen.signed)
    ahead = gains.feed_forward * dq.adjoint(x_e, seen.twist_d)
    return np.asarray(-2.0 * gains.k * dq.log(x_e, short=not seen.signed) + ahead)
