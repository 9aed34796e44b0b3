"""Measured and desired pose -> the errors of the papers, and commands about the same point.

x and -x are one pose: the desired one is taken on the side of the measured one before an error is
formed, or the arm might turn the long way. The sign is decided by the error itself, never by the
scalar part of a pose, which changes along a smooth path. Where a rule has chosen it already
(`signs`) the desired pose is `signed` and stays as it is.
"""

from typing import Literal

import numpy as np

from dqpaint import dq
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats
from dqpaint.robots.kinematics import inverse, pose_map

Point = Literal["base", "tool"]
POINT_HELP = "point of the body at which the error is taken: that at the base's origin, or the tool"


def _goal(pose: Floats, pose_d: Floats, signed: bool) -> Floats:
    return pose_d if signed else dq.nearest(pose_d, pose)


def invariant_error(pose: Floats, pose_d: Floats, signed: bool = False) -> Floats:
    """The error e = vec(1 - x* x_d) (..., 8), the same from whatever base frame; not tool frame."""
    return dq.IDENTITY - dq.mul(dq.conj(pose), _goal(pose, pose_d, signed))


def difference_error(pose: Floats, pose_d: Floats, signed: bool = False) -> Floats:
    """The error e = vec(x_d - x) (..., 8), the plain difference of the eight numbers."""
    return np.asarray(_goal(pose, pose_d, signed) - pose)


def spatial_error(pose: Floats, pose_d: Floats, signed: bool = False) -> Floats:
    """x_e = x x_d* (..., 8), seen from the base."""
    return dq.mul(pose, dq.conj(_goal(pose, pose_d, signed)))


def body_error(seen: Seen) -> Floats:
    """[2 Im r_b; p_b] (..., 6) of x_b = x_d* x: the error along the axes of the reference."""
    x_b = dq.mul(dq.conj(seen.goal), seen.pose)
    return np.concatenate([2.0 * x_b[..., 1:4], dq.translation(x_b)], axis=-1)


def error_vector(x_e: Floats, seen: Seen, point: Point) -> Floats:
    """[Im r_e; p] (..., 6): how far the tool is turned, and how far a point of it is away [m].

    Args:
        x_e: the spatial error.
        seen: the input of the law.
        point: `base`: the point of the tool's body that should be at the base's origin: p is p_e of
            x_e = r_e + eps 1/2 p_e r_e, which is t - R_e t_d. `tool`: the tool's own, t - t_d.
    """
    p = dq.translation(x_e) if point == "base" else _tool(seen.pose) - _tool(seen.pose_d)
    return np.concatenate([x_e[..., 1:4], p], axis=-1)


def command_about(u: Floats, seen: Seen, point: Point) -> Floats:
    """The spatial twist (..., 6) of [w; the point's velocity]; arguments as of `error_vector`."""
    return u if point == "base" else dq.twist_from_point(u[..., :3], u[..., 3:], _tool(seen.pose))


def tracking_command(u: Floats, x_e: Floats, seen: Seen, point: Point) -> Floats:
    """The same with feed-forward, after which the error obeys the law of a set point.

    About the base's origin it is Ad(x_e) xi_d. At the tool it is the turning R_e w_d and the
    reference point's own velocity: there Ad(x_e) xi_d would leave (R_e - I) t_d_dot.
    """
    if point == "base":
        return u + dq.adjoint(x_e, seen.twist_d)
    w_d = dq.rotate(dq.rotation(x_e), seen.twist_d[..., :3])
    t_d_dot = dq.point_velocity(seen.twist_d, _tool(seen.pose_d))
    return command_about(u + np.concatenate([w_d, t_d_dot], axis=-1), seen, point)


_tool = dq.translation


def twist_of_invariant_rate(pose: Floats, goal: Floats, rate: Floats) -> Floats:
    """The twist u (..., 6) with vec(x_dot* x_d) = rate as nearly as can be; x_d on its side.

    x_dot* = -1/2 x* u gives M u = rate with M = -1/2 H+(x*) H-(x_d) E6, 8 x 6 of full column
    rank, and u = M^+ rate. N = M J_w is the papers' 8 x n matrix, so N^+ = J_w^+ M^+.
    """
    back: Floats = np.dot(pose, _BACK).reshape(*pose.shape[:-1], 8, 8)
    return _least_squares(back @ pose_map(goal), rate)


def twist_of_pose_rate(pose: Floats, rate: Floats) -> Floats:
    """The twist u (..., 6) with vec(x_dot) = rate as nearly as can be: M^+ rate, see `pose_map`."""
    return _least_squares(pose_map(pose), rate)


def _least_squares(M: Floats, rate: Floats) -> Floats:
    """M^+ rate (..., 6) for matrices (..., 8, 6) of full column rank."""
    square, right = M.mT @ M, np.vecmat(rate, M)
    if M.ndim > 2:
        return np.asarray(np.linalg.solve(square, right[..., None])[..., 0])
    return np.asarray(np.matvec(inverse(square), right))


_BACK = -dq.hamilton_plus(np.diag(dq.C8)).reshape(8, 64)  # x -> -H+(x*), which is linear in x
