"""A Jacobian of part of the tool's motion and its wanted value -> the least joint rates."""

import numpy as np

from dqpaint.dq import Floats
from dqpaint.robots.kinematics.differential_ik import damped_inverse


def resolve_part(jacobian: Floats, wanted: Floats) -> Floats:
    """J^+ v (..., n) [rad/s], damped near a singularity as `resolve` is.

    Args:
        jacobian: (..., m, n), m at most n, in rad or in characteristic lengths a rad.
        wanted: v (..., m).
    """
    squares, axes = np.linalg.eigh(jacobian @ jacobian.mT)
    force = np.matvec(axes, damped_inverse(squares) * np.vecmat(wanted, axes))
    return np.asarray(np.vecmat(force, jacobian))
