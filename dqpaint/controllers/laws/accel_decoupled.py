"""Resolved acceleration on position and orientation separately, after Caccavale."""

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import Gain, Gains
from dqpaint.controllers.base.pose_errors import spatial_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats


class ApartSpringGains(Gains):
    """Springs and dampers of position and orientation.

    Chandra 2020 tuned 270 and 7.5 for both. A small rotation by theta is only theta / 2 in
    Im(r_d r*), so its spring is KPo / 2: with twice the stiffness all four roots are at 20 1/s.
    """

    KPp: Gain = Field(400.0, description="1/s^2, stiffness of the position; the paper took 270")
    KVp: Gain = Field(40.0, description="1/s, damping of the position; the paper took 7.5")
    KPo: Gain = Field(
        800.0, description="1/s^2, twice the stiffness of the orientation; the paper took 270"
    )
    KVo: Gain = Field(40.0, description="1/s, damping of the orientation; the paper took 7.5")


@controller(
    "accel-decoupled",
    source="Caccavale 1998, in Chandra 2020 [39]",
    gains=ApartSpringGains,
    commands="acceleration",
)
def accel_decoupled(seen: Seen, gains: ApartSpringGains) -> Floats:
    """Resolved acceleration, position and orientation separately: torques; does not lag.

    tau = H J_w^+ (a - J_w_dot q_dot) + C q_dot + G, with a made of
    p_ddot = p_ddot_d + KVp (p_dot_d - p_dot) + KPp (p_d - p) and
    w_dot = w_dot_d + KVo (w_d - w) + KPo Im(r_d r*); the paper prints w_d for w_dot_d.

    Each error is a damped spring of its own: p_d - p a linear one, the other one linear while the
    angle is small and stable from any.
    """
    p, p_d = dq.translation(seen.pose), dq.translation(seen.pose_d)
    xi, xi_d = seen.twist, seen.twist_d
    w, p_dot = xi[..., :3], dq.point_velocity(xi, p)
    r_home = spatial_error(seen.pose, seen.pose_d)[..., :4]  # r r_d*
    p_ddot = (
        dq.point_acceleration(xi_d, seen.acceleration_d, p_d)
        + gains.KVp * (dq.point_velocity(xi_d, p_d) - p_dot)
        + gains.KPp * (p_d - p)
    )
    w_dot = (
        seen.acceleration_d[..., :3] + gains.KVo * (xi_d[..., :3] - w) - gains.KPo * r_home[..., 1:]
    )
    return np.asarray(dq.acceleration_from_point(w, w_dot, p_dot, p_ddot, p))
