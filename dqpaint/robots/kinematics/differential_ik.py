"""A commanded twist -> joint rates, in the same way for every law and arm.

q_dot = J^+ u + (I - J^+ J) z, with J^+ damped as `--damping` says: near singularities alone,
nowhere, or everywhere. Works on arrays of any leading shape: one state of a run, or a thousand of a
batch.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from dqpaint import dq
from dqpaint.core import make_choice, read_choice
from dqpaint.dq import Floats
from dqpaint.errors import UnknownNameError, UsageError
from dqpaint.robots.kinematics.small_matrices import inverse

CHARACTERISTIC_LENGTH = 0.3  # [m] weighs metres against radians where singular values are compared
DAMPING_THRESHOLD = 0.04  # singular values [rad/rad] below it are damped
START_GAIN = 2.0  # [1/s] towards the start posture, in the null space
DEFAULT_DAMPING = "selective"

Damping = Callable[[Floats], Floats]
"""What stands for 1 / s^2, for squared singular values s^2 (..., 6) in ascending order."""


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


def plain_inverse(squares: Floats) -> Floats:
    """1 / s^2, and 0 where s^2 is rounding beside the largest: Moore and Penrose's."""
    rounding = 6 * np.finfo(np.float64).eps * squares[..., -1:]
    known = squares > rounding
    return np.where(known, 1.0 / np.where(known, squares, 1.0), 0.0)


def wampler_inverse(factor: float, squares: Floats) -> Floats:
    """1 / (s^2 + l^2) with one l everywhere (Wampler 1986, damped least squares)."""
    return np.asarray(1.0 / (np.maximum(squares, 0.0) + factor * factor))


class _Wampler(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)
    factor: float = Field(
        0.01, ge=1e-6, le=1, description="rad/rad, lengths in units of 0.3 m, 0.000001 to 1"
    )


def read_damping(text: str) -> Damping:
    """Parse a text like `selective`, `none` or `wampler,factor=0.05`.

    Raises:
        UsageError: an unknown way, or no such value.
    """
    name, values = read_choice("damping", text, "wampler,factor=0.05")
    if name == "wampler":
        return partial(wampler_inverse, make_choice("damping", name, _Wampler, values).factor)
    fixed = {"selective": damped_inverse, "none": plain_inverse}
    if name not in fixed:
        raise UnknownNameError("damping", name, [*fixed, "wampler"])
    if values:
        raise UsageError(f"damping '{name}' takes no values")
    return fixed[name]


def resolve(
    jacobian: Floats,
    point: Floats,
    twist: Floats,
    secondary: Floats | None,
    damping: Damping = damped_inverse,
) -> Floats:
    """The joint rates (..., n) [rad/s] for a commanded twist.

    Args:
        jacobian: J_w (..., 6, n), spatial.
        point: the tool's place (..., 3) [m]. Nearness to a singularity is measured there: about the
            base origin a healthy posture far out looks ill.
        twist: u (..., 6), spatial [rad/s, m/s].
        secondary: z (..., n) [rad/s], projected into the null space; None gives the least motion.
        damping: of the singular directions.

    By default each singular direction of the Jacobian is damped by itself and only below THRESHOLD,
    so that the other directions stay exact (after Chiaverini, "Singularity-robust task-priority
    redundancy resolution", 1997).
    """
    shift = tool_jacobian_map(point)
    one = shift.ndim == jacobian.ndim == 2 and twist.ndim == 1
    if one and secondary is not None and secondary.ndim == 1:
        return _resolve_one(shift, jacobian, twist, secondary, damping)
    J = shift @ jacobian
    square = J @ J.mT
    left = np.matvec(shift, twist)
    if secondary is not None:
        left = left - np.matvec(J, secondary)
    rates: Floats = np.vecmat(_force(square, left, damping), J)
    return rates if secondary is None else rates + secondary


def _resolve_one(
    shift: Floats, jacobian: Floats, twist: Floats, secondary: Floats, damping: Damping
) -> Floats:
    """The same for one state, a control step: np.dot halves the time of small products."""
    J = np.dot(shift, jacobian)
    force = _force(np.dot(J, J.T), np.dot(shift, twist) - np.dot(J, secondary), damping)
    return np.asarray(np.dot(force, J) + secondary)


def _force(square: Floats, left: Floats, damping: Damping) -> Floats:
    """(J J')^+ left (..., 6), damped.

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
