"""One way from a commanded twist to joint rates, for every law and arm.

q_dot = J^+ u + (I - J^+ J) z, with J^+ damped near singularities alone. Works on arrays of any
leading shape: one state of a run, or a thousand of a batch.
"""

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.robots.kinematics.small_matrices import inverse

LENGTH = 0.3  # [m] weighs metres against radians where singular values are compared
THRESHOLD = 0.04  # singular values [rad/rad] below it are damped
PULL = 2.0  # [1/s] towards the start posture, in the null space


def resolve(jacobian: Floats, point: Floats, twist: Floats, wish: Floats | None) -> Floats:
    """The joint rates (..., n) [rad/s] for a commanded twist.

    Args:
        jacobian: J_w (..., 6, n), spatial.
        point: the tool's place (..., 3) [m]. Nearness to a singularity is measured there: about the
            base origin a healthy posture far out looks ill.
        twist: u (..., 6), spatial [rad/s, m/s].
        wish: z (..., n) [rad/s], granted as far as it does not move the tool; None is the least
            motion.

    Each singular direction of the Jacobian is damped by itself and only below THRESHOLD, so that
    the other directions stay exact (after Chiaverini, "Singularity-robust task-priority redundancy
    resolution", 1997).
    """
    shift = to_tool(point)
    one = shift.ndim == jacobian.ndim == 2 and twist.ndim == 1
    if one and wish is not None and wish.ndim == 1:
        return _resolve_one(shift, jacobian, twist, wish)
    J = shift @ jacobian
    square = J @ J.mT
    left = np.matvec(shift, twist)
    if wish is not None:
        left = left - np.matvec(J, wish)
    rates: Floats = np.vecmat(_force(square, left), J)
    return rates if wish is None else rates + wish


def _resolve_one(shift: Floats, jacobian: Floats, twist: Floats, wish: Floats) -> Floats:
    """The same of one state, a control step: small products by np.dot take half the time."""
    J = np.dot(shift, jacobian)
    force = _force(np.dot(J, J.T), np.dot(shift, twist) - np.dot(J, wish))
    return np.asarray(np.dot(force, J) + wish)


def _force(square: Floats, left: Floats) -> Floats:
    """(J J')^+ left (..., 6), damped where it is near a singularity.

    The trace of an inverse is the sum of 1 / s^2: up to 1 / THRESHOLD^2 no s is below THRESHOLD.
    An inverse costs a fifth of what the singular directions do. Of many, each is looked at by
    itself: what one needs does not depend on the others.
    """
    try:
        found = inverse(square)
    except np.linalg.LinAlgError:
        return _damped(square, left)
    plain = found.trace(axis1=-2, axis2=-1) <= 1.0 / THRESHOLD**2
    if left.ndim == 1:
        return np.asarray(np.dot(found, left)) if plain else _damped(square, left)
    if plain.all():
        return np.asarray(np.matvec(found, left))
    if square.ndim == 2:
        return _damped(square, left)
    force: Floats = np.matvec(found, left)
    near = ~plain
    force[near] = _damped(square[near], np.broadcast_to(left, force.shape)[near])
    return force


def _damped(square: Floats, left: Floats) -> Floats:
    """By the singular directions, each damped by itself."""
    squares, axes = np.linalg.eigh(square)
    return np.asarray(np.matvec(axes, damped_inverse(squares) * np.vecmat(left, axes)))


def to_tool(point: Floats) -> Floats:
    """The matrix (..., 6, 6) from a spatial twist to [w; (v0 + w x p) / LENGTH] at a point p."""
    return np.asarray(_AT_ORIGIN + np.dot(point, _PER_METRE).reshape(*point.shape[:-1], 6, 6))


def _per_metre() -> Floats:
    """(3, 36): how the matrix of `to_tool` grows with the point, w x p as a function of w."""
    grows = np.zeros((3, 6, 6))
    for i in range(3):
        for j in range(3):
            grows[i, 3:, j] = dq.cross(np.eye(3)[j], np.eye(3)[i]) / LENGTH
    return grows.reshape(3, 36)


_AT_ORIGIN = np.diag([1.0, 1.0, 1.0, 1 / LENGTH, 1 / LENGTH, 1 / LENGTH])
_PER_METRE = _per_metre()


def damped_inverse(squares: Floats) -> Floats:
    """1 / (s^2 + l^2) for squared singular values s^2 (..., 6).

    l^2 = (t / 2)^2 (1 - (s / t)^2) below the threshold t and 0 above it: the joint rate for a unit
    twist never exceeds about 1 / t, and is continuous in s.
    """
    limit = THRESHOLD**2
    if squares.min() >= limit:
        return np.asarray(1.0 / squares)
    squares = np.maximum(squares, 0.0)
    damping = 0.25 * np.maximum(limit - squares, 0.0)
    return np.asarray(1.0 / (squares + damping))
