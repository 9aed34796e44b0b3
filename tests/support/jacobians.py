"""The papers' 8 x n Jacobian, by the package's 6 x n one, and its rate."""

import numpy as np

from dqpaint import dq
from dqpaint.robots.kinematics.jacobians import jacobian_rate, pose_map


def jacobian8(jacobian, pose):
    """J8 = H-(x) E6 J_w / 2 (..., 8, n), with vec(x_dot) = J8 q_dot, at poses x (..., 8)."""
    return pose_map(pose) @ jacobian


def jacobian8_rate(jacobian, pose, rates):
    """The time derivative of J8 (..., 8, n): H-(x_dot) E6 J_w / 2 + H-(x) E6 J_w_dot / 2."""
    moving = 0.5 * dq.mul(dq.pure(np.matvec(jacobian, rates)), pose)
    return jacobian8(jacobian, moving) + jacobian8(jacobian_rate(jacobian, rates), pose)
