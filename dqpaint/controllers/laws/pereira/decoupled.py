"""Proportional law on position and orientation separately, after Pereira."""

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import Gain, Gains
from dqpaint.controllers.base.pose_errors import spatial_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats


class ApartGains(Gains):
    """A rate for translation and one for rotation."""

    k_t: Gain = Field(20.0, description="1/s, the rate at which a translation error decays")
    k_r: Gain = Field(20.0, description="1/s, the rate at which a small rotation error decays")


@controller("decoupled", source="Pereira 2016, section 3.1.1", gains=ApartGains)
def decoupled(seen: Seen, gains: ApartGains) -> Floats:
    """Proportional, position and orientation separately, each on its own path; lags when moving.

    Equation:
        q_dot = [J_t; N_r]^+ [k_t (t_d - t); k_r vec(1 - r^* r_d)]
        t_dot = J_t q_dot
        N_r q_dot = vec(r_dot^* r_d)
    Idea:
        The tool goes straight to its place, and turns on its own axis meanwhile. J_t and N_r are
        linear in the twist: the first line is met exactly, and the nearest angular velocity
        for the second is -2 k_r Im(r r_d^*).

    Error:
        at the tool, that is its definition; about the base's origin it would be hinf-set with
        K_O = 2 k_r and K_T = k_t, and hinf-set with point=tool is this law.
    Stable:
        At a set point t_d - t decays at k_t, and with eta the scalar part of r_e = r r_d^*, 1 - eta
        falls at k_r |Im(r_e)|^2: neither needs the other.
    Fails:
        On a moving light it lags by speed / k_t. The two paths are not one screw: the tool may
        arrive before it is turned.
    Try:
        dqpaint compare step --controllers decoupled,log,hinf-set --plants ideal
    """
    r_e = spatial_error(seen.pose, seen.pose_d, seen.signed)[..., :4]
    t = dq.translation(seen.pose)
    w = -2.0 * gains.k_r * r_e[..., 1:]
    t_dot = gains.k_t * (dq.translation(seen.pose_d) - t)
    return np.asarray(dq.twist_from_point(w, t_dot, t))
