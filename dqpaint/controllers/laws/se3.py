"""Trace error of rotation matrices, and position: the law of geometric control on SE(3)."""

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import Gain, Gains
from dqpaint.controllers.base.pose_errors import spatial_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats


class TraceGains(Gains):
    """A rate for rotation and one for translation."""

    k_R: Gain = Field(20.0, description="1/s, the rate at which a small rotation error decays")
    k_p: Gain = Field(20.0, description="1/s, the rate at which a position error decays")


@controller(
    "se3", source="Bullo & Murray 1995, Lee, Leok & McClamroch 2010", gains=TraceGains,
    heeds_sign=False,
)  # fmt: skip
def se3(seen: Seen, gains: TraceGains) -> Floats:
    """The trace error of rotation matrices: needs no sign rule, is slow far away; does not lag.

    Equation:
        q_dot = J_w^+ [w; p_dot + p cross w]
        w = -k_R e_R + R_e w_d
        e_R = 1/2 vee(R_e - R_e') = sin(theta) l
        R_e = R R_d'
        p_dot = -k_p (p - p_d) + p_d_dot
    Idea:
        Rotation matrices have no double cover: no sign to choose. The error is the slope of
        tr(1 - R_e) / 2 = 1 - cos(theta), which is zero where the tool is home, and also
        half a turn away, about every axis.

    Error:
        at the tool: p - p_d.
    Stable:
        V = 1 - cos(theta): V_dot = -k_R sin(theta)^2, from almost every error:
        tan(theta / 2) decays at k_R exactly. p - p_d decays at k_p.
    Fails:
        Half a turn away it stands still, and near there it leaves slowly: from 179 deg it takes
        4.7 / k_R to come to 90 deg, where log takes 0.7 / k.
    Try:
        dqpaint compare half-turn --controllers se3,hinf,log --plants ideal
    """
    r_e = spatial_error(seen.pose, seen.pose_d)[..., :4]
    e_R = 2.0 * r_e[..., :1] * r_e[..., 1:]  # sin(theta) l, whatever the sign of r_e
    p, p_d = dq.translation(seen.pose), dq.translation(seen.pose_d)
    w = -gains.k_R * e_R + dq.rotate(r_e, seen.twist_d[..., :3])
    p_dot = gains.k_p * (p_d - p) + dq.point_velocity(seen.twist_d, p_d)
    return np.asarray(dq.twist_from_point(w, p_dot, p))
