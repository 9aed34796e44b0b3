"""Resolved acceleration on position and orientation separately, after Caccavale."""

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import Gains
from dqpaint.controllers.base.matrices import Gain3, times
from dqpaint.controllers.base.pose_errors import spatial_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats


class ApartSpringGains(Gains):
    """Springs and dampers of position and orientation.

    Chandra 2020 tuned 270 and 7.5 for both. A small rotation by theta is only theta / 2 in
    Im(r_d r*), so its spring is KPo / 2: with twice the stiffness all four roots are at 20 1/s.
    """

    KPp: Gain3 = Field(
        400.0,
        description="1/s^2, stiffness of the position; the paper took 270. A number, a diagonal of "
        "3 or a symmetric matrix 3 x 3",
    )
    KVp: Gain3 = Field(
        40.0, description="1/s, damping of the position; the paper took 7.5. Likewise"
    )
    KPo: Gain3 = Field(
        800.0,
        description="1/s^2, twice the stiffness of the orientation; the paper took 270. Likewise",
    )
    KVo: Gain3 = Field(
        40.0, description="1/s, damping of the orientation; the paper took 7.5. Likewise"
    )


@controller(
    "accel-decoupled", source="Caccavale 1998, in Chandra 2020 [39]", gains=ApartSpringGains,
    commands="acceleration", paper={"KPp": 270.0, "KPo": 270.0, "KVp": 7.5, "KVo": 7.5},
    paper_source="Chandra 2020, section 4, on Baxter at 200 Hz",
)  # fmt: skip
def accel_decoupled(seen: Seen, gains: ApartSpringGains) -> Floats:
    """Resolved acceleration, position and orientation separately: torques; does not lag.

    Equation:
        tau = H J_w^+ (a - J_w_dot q_dot) + C q_dot + G
        p_ddot = p_d_ddot + K_Vp (p_d_dot - p_dot) + K_Pp (p_d - p)
        w_dot = w_d_dot + K_Vo (w_d - w) + K_Po Im(r_d r^*)
    Idea:
        As accel, with a spring for the position and another for the orientation; a is the spatial
        acceleration that p_ddot and w_dot make. The paper prints w_d for w_d_dot.

    Error:
        at the tool, that is its definition.
    Stable:
        With the exact model: p_d - p is a linear damped spring. A small rotation by theta is only
        theta / 2 in Im(r_d r^*): its spring is K_Po / 2, and stable from any angle.
    Fails:
        As accel. At equal gains the orientation is half as stiff as in accel, which is the
        advantage that Chandra 2020 measures for the coupled law.
    Try:
        dqpaint compare quarter-turn --controllers accel,accel-decoupled --disturb payload=1
    """
    p, p_d = dq.translation(seen.pose), dq.translation(seen.pose_d)
    xi, xi_d = seen.twist, seen.twist_d
    w, p_dot = xi[..., :3], dq.point_velocity(xi, p)
    r_home = spatial_error(seen.pose, seen.pose_d, seen.signed)[..., :4]  # r r_d*
    p_ddot = (
        dq.point_acceleration(xi_d, seen.acceleration_d, p_d)
        + times(gains.KVp, dq.point_velocity(xi_d, p_d) - p_dot)
        + times(gains.KPp, p_d - p)
    )
    w_dot = (
        seen.acceleration_d[..., :3]
        + times(gains.KVo, xi_d[..., :3] - w)
        - times(gains.KPo, r_home[..., 1:])
    )
    return np.asarray(dq.acceleration_from_point(w, w_dot, p_dot, p_ddot, p))
