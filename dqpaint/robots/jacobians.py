"""What follows from a spatial Jacobian J_w (..., 6, n) by algebra alone, for any leading shape.

Column i is the unit twist s_i of joint i as it stands now, seen from the base: xi = J_w q_dot.
"""

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats


def _operator() -> Floats:
    """(6, 36): [w; v] x = [[w^, 0], [v^, w^]], linear in the twist."""
    out = np.zeros((6, 6, 6))
    for i, unit in enumerate(np.eye(3)):
        hat = np.stack([dq.cross(unit, e) for e in np.eye(3)], axis=1)
        out[i, :3, :3] = out[i, 3:, 3:] = out[i + 3, 3:, :3] = hat
    return out.reshape(6, 36)


_OPERATOR = _operator()


def jacobian8(jacobian: Floats, pose: Floats) -> Floats:
    """J8 = H-(x) E6 J_w / 2 (..., 8, n), with vec(x_dot) = J8 q_dot, at poses x (..., 8)."""
    left = 0.5 * dq.hamilton_minus(pose)[..., [1, 2, 3, 5, 6, 7]]
    J8: Floats = left @ jacobian
    return J8


def jacobian_rate(jacobian: Floats, rates: Floats) -> Floats:
    """The time derivative of J_w (..., 6, n) at joint rates (..., n) [rad/s].

    Column i is xi_i x s_i: the twist of link i carries the axis s_i along (Ozgur and Mezouar 2016;
    Chandra 2020 [38]). J_w_dot q_dot is the drift: the spatial acceleration at constant rates.
    """
    twists = np.cumsum(jacobian * rates[..., None, :], axis=-1).swapaxes(-1, -2)
    carried = np.dot(twists, _OPERATOR).reshape(*twists.shape, 6)
    out: Floats = np.matvec(carried, jacobian.swapaxes(-1, -2)).swapaxes(-1, -2)
    return out


def jacobian8_rate(jacobian: Floats, pose: Floats, rates: Floats) -> Floats:
    """The time derivative of J8 (..., 8, n): H-(x_dot) E6 J_w / 2 + H-(x) E6 J_w_dot / 2."""
    twist = np.matvec(jacobian, rates)
    moving = 0.5 * dq.mul(dq.pure(twist), pose)
    return jacobian8(jacobian, moving) + jacobian8(jacobian_rate(jacobian, rates), pose)
