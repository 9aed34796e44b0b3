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
    """Along the one screw that leads home: the error decays evenly; does not lag.

    q_dot = J_w^+ (-k 2 log x_e + Ad(x_e) xi_d), with x_e = x x_d*.

    x_e_dot = 1/2 (xi - Ad(x_e) xi_d) x_e, so x_e turns back along its own screw, and
    d(log x_e)/dt = -k log x_e holds exactly: one rate for every error short of half a turn.
    """
    x_e = spatial_error(seen.pose, seen.pose_d)
    ahead = gains.feed_forward * dq.adjoint(x_e, seen.twist_d)
    return np.asarray(-2.0 * gains.k * dq.log(x_e) + ahead)
