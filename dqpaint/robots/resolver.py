"""One way from a commanded twist to joint rates, for every law and arm.

q_dot = J^+ u + (I - J^+ J) z, with J^+ damped near singularities alone. Works on arrays of any
leading shape: one state of a run, or a thousand of a batch.
"""

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats

LENGTH = 0.3  # [m] weighs metres against radians where singular values are compared
THRESHOLD = 0.04  # singular values [rad/rad] below it are damped
PULL = 2.0  # [1/s] towards the start posture, in the null space


def resolve(jacobian: Floats, point: Floats, twist: Floats, wish: Floats) -> Floats:
    """The joint rates (..., n) [rad/s] for a commanded twist.

    Args:
        jacobian: J_w (..., 6, n), spatial.
        point: the tool's place (..., 3) [m]. Nearness to a singularity is measured there: about the
            base origin a healthy posture far out looks ill.
        twist: u (..., 6), spatial [rad/s, m/s].
        wish: z (..., n) [rad/s], granted as far as it does not move the tool.

    Each singular direction of the Jacobian is damped by itself and only below THRESHOLD, so that
    the other directions stay exact (after Chiaverini, "Singularity-robust task-priority redundancy
    resolution", 1997).
    """
    J = np.empty_like(jacobian)
    J[..., :3, :] = jacobian[..., :3, :]
    p = point[..., None, :]
    columns = jacobian.swapaxes(-1, -2)
    at_tool = columns[..., 3:] + dq.cross(columns[..., :3], p)
    J[..., 3:, :] = at_tool.swapaxes(-1, -2) / LENGTH
    u = np.empty_like(twist)
    u[..., :3] = twist[..., :3]
    u[..., 3:] = dq.point_velocity(twist, point) / LENGTH
    transposed = J.swapaxes(-1, -2)
    squares, axes = np.linalg.eigh(J @ transposed)
    inverse = damped_inverse(squares)
    left = u[..., None] - J @ wish[..., None]
    rates: Floats = (transposed @ (axes @ (inverse[..., None] * (axes.swapaxes(-1, -2) @ left))))[
        ..., 0
    ]
    return rates + wish


def damped_inverse(squares: Floats) -> Floats:
    """1 / (s^2 + l^2) for squared singular values s^2 (..., 6).

    l^2 = (t / 2)^2 (1 - (s / t)^2) below the threshold t and 0 above it: the joint rate for a unit
    twist never exceeds about 1 / t, and is continuous in s.
    """
    squares = np.maximum(squares, 0.0)
    limit = THRESHOLD**2
    damping = 0.25 * np.maximum(limit - squares, 0.0)
    return np.asarray(1.0 / (squares + damping))
