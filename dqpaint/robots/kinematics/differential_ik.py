"""A commanded twist -> joint rates, in the same way for every law and arm.

q_dot = J^+ u + (I - J^+ J) z, with J^+ damped near singularities alone, or as a resolver says.
Works on arrays of any leading shape: one state of a run, or a thousand of a batch.
"""

from collections.abc import Callable, Sequence

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.robots.kinematics.small_matrices import inverse
from dqpaint.robots.model.task import Part

CHARACTERISTIC_LENGTH = 0.3  # [m] weighs metres against radians where singular values are compared
DAMPING_THRESHOLD = 0.04  # singular values [rad/rad] below it are damped
START_GAIN = 2.0  # [1/s] towards the start posture, in the null space

Damping = Callable[[Floats], Floats]
"""What stands for 1 / s^2, for squared singular values s^2 (..., m) in ascending order."""


def damped_inverse(squares: Floats) -> Floats:
    """1 / (s^2 + l^2) for squared singular values s^2 (..., 6).

    l^2 = (t / 2)^2 (1 - (s / t)^2) below the threshold t and 0 above it: the joint rate for a unit
    twist never exceeds about 1 / t, and is continuous in s.
    """
    limit = DAMPING_THRESHOLD**2
    if squares.min() >= limit:
        return np.asarray(1.0 / squares)
    squares = np.maximum(squares, 0.0)
    damping = 0.25 * np.maximum(limit - squares, 0.0)
    return np.asarray(1.0 / (squares + damping))


def resolve(
    jacobian: Floats,
    point: Floats,
    twist: Floats,
    secondary: Floats | None,
    damping: Damping = damped_inverse,
    rows: Floats | None = None,
) -> Floats:
    """The joint rates (..., n) [rad/s] for a commanded twist.

    Args:
        jacobian: J_w (..., 6, n), spatial.
        point: the tool's place (..., 3) [m]. Nearness to a singularity is measured there: about the
            base origin a healthy posture far out looks ill.
        twist: u (..., 6), spatial [rad/s, m/s].
        secondary: z (..., n) [rad/s], projected into the null space; None gives the least motion.
        damping: of the singular directions.
        rows: of the tool's twist that count (..., m, 6), see `model.task`; None is all of it.

    By default each singular direction of the Jacobian is damped by itself and only below THRESHOLD,
    so that the other directions stay exact (after Chiaverini, "Singularity-robust task-priority
    redundancy resolution", 1997).
    """
    shift = tool_jacobian_map(point)
    one = shift.ndim == jacobian.ndim == 2 and twist.ndim == 1 and rows is None
    if one and secondary is not None and secondary.ndim == 1:
        return _resolve_one(shift, jacobian, twist, secondary, damping)
    shift = shift if rows is None else rows @ shift
    J = shift @ jacobian
    square = J @ J.mT
    left = np.matvec(shift, twist)
    if secondary is not None:
        left = left - np.matvec(J, secondary)
    rates: Floats = np.vecmat(damped_force(square, left, damping), J)
    return rates if secondary is None else rates + secondary


def resolve_parts(
    jacobian: Floats,
    pose: Floats,
    twists: Sequence[Floats],
    parts: Sequence[Part],
    secondary: Floats | None,
    inverse_times: Callable[[Floats, Floats], Floats],
) -> Floats:
    """The joint rates (..., n) [rad/s] for a twist for each part of a task, in their order.

    q_dot_i = q_dot_(i-1) + (J_i N_(i-1))^# (u_i - J_i q_dot_(i-1)), from the secondary q_dot_0;
    N is what the parts before leave free (Siciliano and Slotine 1991).

    Args:
        jacobian: J_w (..., 6, n), spatial.
        pose: of the tool (..., 8).
        twists: u_i (..., 6), spatial.
        parts: of the task.
        secondary: as of `resolve`.
        inverse_times: of J (..., m, n) and v (..., m), J^# v (..., n).
    """
    shift = tool_jacobian_map(dq.translation(pose))
    J = shift @ jacobian
    found = np.zeros(J.shape[:-2] + J.shape[-1:]) if secondary is None else secondary
    free: Floats | None = None
    for part, twist in zip(parts, twists, strict=True):
        rows, left = part.rows(pose), np.matvec(shift, twist)
        mine = J if rows is None else rows @ J
        left = left if rows is None else np.matvec(rows, left)
        within = mine if free is None else mine @ free
        found = found + inverse_times(within, left - np.matvec(mine, found))
        if part is not parts[-1]:
            taken = np.linalg.pinv(within) @ within
            free = (np.eye(J.shape[-1]) if free is None else free) - taken
    return found


def damped_inverse_times(J: Floats, left: Floats) -> Floats:
    """J^# v (..., n), damped as `resolve` does by itself."""
    return np.asarray(np.vecmat(damped_force(J @ J.mT, left, damped_inverse), J))


def _resolve_one(
    shift: Floats, jacobian: Floats, twist: Floats, secondary: Floats, damping: Damping
) -> Floats:
    """The same for one state, a control step: np.dot halves the time of small products."""
    J = np.dot(shift, jacobian)
    force = damped_force(np.dot(J, J.T), np.dot(shift, twist) - np.dot(J, secondary), damping)
    return np.asarray(np.dot(force, J) + secondary)


def damped_force(square: Floats, left: Floats, damping: Damping) -> Floats:
    """(J J')^+ left (..., m), damped.

    The default first looks whether there is anything to damp: the trace of an inverse is the sum of
    1 / s^2, and up to 1 / THRESHOLD^2 no s is below THRESHOLD. An inverse costs a fifth of what the
    singular directions do. Each of many is treated separately: the result of one does not depend on
    the others.
    """
    if damping is not damped_inverse:
        return _damped(square, left, damping)
    try:
        found = inverse(square)
    except np.linalg.LinAlgError:
        return _damped(square, left)
    plain = found.trace(axis1=-2, axis2=-1) <= 1.0 / DAMPING_THRESHOLD**2
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


def _damped(square: Floats, left: Floats, damping: Damping = damped_inverse) -> Floats:
    """The same in singular directions, each with its own damping."""
    squares, axes = np.linalg.eigh(square)
    return np.asarray(np.matvec(axes, damping(squares) * np.vecmat(left, axes)))


def tool_jacobian_map(point: Floats) -> Floats:
    """The matrix (..., 6, 6) from a spatial twist to [w; (v0 + w x p) / L] at a point p.

    L is `CHARACTERISTIC_LENGTH`.
    """
    return np.asarray(_AT_ORIGIN + np.dot(point, _PER_METRE).reshape(*point.shape[:-1], 6, 6))


def _per_metre() -> Floats:
    """(3, 36): change of `tool_jacobian_map` with the point, w x p as a function of w."""
    grows = np.zeros((3, 6, 6))
    for i in range(3):
        for j in range(3):
            grows[i, 3:, j] = dq.cross(np.eye(3)[j], np.eye(3)[i]) / CHARACTERISTIC_LENGTH
    return grows.reshape(3, 36)


_AT_ORIGIN = np.diag(
    [1.0, 1.0, 1.0, 1 / CHARACTERISTIC_LENGTH, 1 / CHARACTERISTIC_LENGTH, 1 / CHARACTERISTIC_LENGTH]
)
_PER_METRE = _per_metre()
