"""Measured and desired pose -> the errors of the papers, always the short way round.

x and -x are one pose: the desired one is taken on the side of the measured one before an error is
formed, or the arm might turn the long way. The sign is decided by the error itself, never by the
scalar part of a pose, which changes along a smooth path.
"""

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.robots.kinematics import inverse, pose_map


def invariant_error(pose: Floats, pose_d: Floats) -> Floats:
    """The error e = vec(1 - x* x_d) (..., 8), the same from whatever base frame it is seen."""
    return dq.IDENTITY - dq.mul(dq.conj(pose), dq.nearest(pose_d, pose))


def difference_error(pose: Floats, pose_d: Floats) -> Floats:
    """The error e = vec(x_d - x) (..., 8), the plain difference of the eight numbers."""
    return np.asarray(dq.nearest(pose_d, pose) - pose)


def spatial_error(pose: Floats, pose_d: Floats) -> Floats:
    """x_e = x x_d* (..., 8), seen from the base."""
    return dq.mul(pose, dq.conj(dq.nearest(pose_d, pose)))


def twist_of_invariant_rate(pose: Floats, pose_d: Floats, rate: Floats) -> Floats:
    """The twist u (..., 6) with vec(x_dot* x_d) = rate as nearly as can be.

    x_dot* = -1/2 x* u gives M u = rate with M = -1/2 H+(x*) H-(x_d) E6, 8 x 6 of full column
    rank, and u = M^+ rate. N = M J_w is the papers' 8 x n matrix, so N^+ = J_w^+ M^+.
    """
    back: Floats = np.dot(pose, _BACK).reshape(*pose.shape[:-1], 8, 8)
    return _least_squares(back @ pose_map(dq.nearest(pose_d, pose)), rate)


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
