"""Spatial Jacobians J_w (..., 6, n) -> J8, time derivatives and drift, by algebra alone.

Column i is the unit twist s_i of joint i at the posture, in the base frame: xi = J_w q_dot.
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
_IMAGINARY = [1, 2, 3, 5, 6, 7]  # the columns that E6 keeps
_POSE_MAP = 0.5 * dq.hamilton_minus(np.eye(8))[..., _IMAGINARY].reshape(8, 48)


def pose_map(pose: Floats) -> Floats:
    """M = 1/2 H-(x) E6 (..., 8, 6), with vec(x_dot) = M xi.

    J8 = M J_w is the papers' 8 x n Jacobian, so J8^+ = J_w^+ M^+ and J8' = J_w' M'.
    """
    M: Floats = np.dot(pose, _POSE_MAP).reshape(*pose.shape[:-1], 8, 6)
    return M


def jacobian_rate(jacobian: Floats, rates: Floats) -> Floats:
    """The time derivative of J_w (..., 6, n) at joint rates (..., n) [rad/s].

    Column i is xi_i x s_i: the twist of link i carries the axis s_i along (Ozgur and Mezouar 2016;
    Chandra 2020 [38]).
    """
    twists = np.cumsum(jacobian * rates[..., None, :], axis=-1).swapaxes(-1, -2)
    carried = np.dot(twists, _OPERATOR).reshape(*twists.shape, 6)
    out: Floats = np.matvec(carried, jacobian.swapaxes(-1, -2)).swapaxes(-1, -2)
    return out


def drift_acceleration(jacobian: Floats, rates: Floats) -> Floats:
    """J_w_dot q_dot (..., 6): the tool's acceleration at constant joint rates (..., n)."""
    return np.asarray(np.matvec(jacobian_rate(jacobian, rates), rates))
