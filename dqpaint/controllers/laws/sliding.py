"""Sliding mode on the screw from the measured to the desired pose, at the level of torques."""

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import Gain, Gains
from dqpaint.controllers.base.pose_errors import spatial_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats


class SlidingGains(Gains):
    """The rate on the surface, the way to it, and what is pushed against; both roots at 20 1/s."""

    lam: Gain = Field(20.0, description="1/s, the rate lambda at which an error decays")
    k: Gain = Field(20.0, description="1/s, the rate at which the surface is reached")
    rho: float = Field(
        10.0, ge=0.0, le=1e6, allow_inf_nan=False,
        description="1/s^2 (rad and m), the largest disturbance that is held; 0 is accel",
    )  # fmt: skip
    phi: Gain = Field(
        0.1, description="1/s, width of the layer about the surface in which rho grows from 0"
    )


@controller("sliding", source="ours, after accel", gains=SlidingGains, commands="acceleration")
def sliding(seen: Seen, gains: SlidingGains) -> Floats:
    """Sliding mode on the screw of the error: torques, against bounded disturbances; does not lag.

    Equation:
        tau = H J_w^+ (a - J_w_dot q_dot) + C q_dot + G
        a = a_d + lambda J_r(z)^-1 xi_e + k s + rho s / (|s| + phi)
        a_d = Ad(x_e^*) xi_d_dot + xi cross Ad(x_e^*) xi_d
        s = xi_e + lambda z
        z = 2 log(x_e)
        x_e = x_d x^*
        xi_e = Ad(x_e^*) xi_d - xi
    Idea:
        Where s = 0 the error runs home along its own screw at the rate lambda, whatever its size;
        everything else is there to keep s at 0. J_r makes xi_e of z_dot: without it the screw
        would bend. With rho = 0, near zero, it is accel with K_v = k + lambda and K_p = k lambda.

    Error:
        the same wherever it is taken up to rho, which weighs s about the base's origin.
    Stable:
        V = 1/2 |s|^2: V_dot <= -k |s|^2 - |s| (rho |s| / (|s| + phi) - |d|), so a disturbance d
        below rho leaves |s| < phi |d| / (rho - |d|), and |z| < |s| / lambda. On s = 0 z decays at
        lambda.
    Fails:
        Where (k + rho / phi) T passes 1 it chatters: a thin layer needs a short period. A wrong
        model of the masses is no bounded disturbance.
    Try:
        dqpaint compare quarter-turn --controllers accel,sliding --disturb payload=0.1
    """
    home = spatial_error(seen.pose, seen.pose_d, seen.signed)  # x x_d* = x_e*
    xi = seen.twist
    carried = dq.adjoint(home, seen.twist_d)
    forward = dq.adjoint(home, seen.acceleration_d) + dq.spatial_cross(xi, carried)
    z, xi_e = 2.0 * dq.log(dq.conj(home), short=not seen.signed), carried - xi
    Jr = np.apply_along_axis(dq.left_jacobian, -1, -z)
    z_dot = np.linalg.solve(Jr, xi_e[..., None])[..., 0]
    s = xi_e + gains.lam * z
    size = np.sqrt((s * s).sum(-1, keepdims=True))
    reach = gains.k * s + gains.rho * s / (size + gains.phi)
    return np.asarray(forward + gains.lam * z_dot + reach)
