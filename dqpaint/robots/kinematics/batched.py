"""Many postures of one arm -> poses and Jacobians in one numpy computation.

The product of exponentials, T = E_1(q_1) ... E_n(q_n) T_0, with matrices: for a joint about the
line of direction l through p, with K = l^ (so K^3 = -K),

    E(q) = I + sin q [K, -K p; 0, 0] + (1 - cos q) [K K, -K K p; 0, 0],

so a joint is one product of T with constants. The screws come from pinocchio's model at q = 0.
"""

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import Card


class ManyKinematics:
    """Forward kinematics of a card's tool for postures (B, n).

    Attributes:
        card: of the arm.
    """

    def __init__(self, kinematics: Kinematics) -> None:
        self.card: Card = kinematics.card
        screws = kinematics.screws()
        self._turns, self._lines = map(np.stack, zip(*map(_constants, screws.axes), strict=True))
        self._home = np.ascontiguousarray(dq.matrix_from_pose(screws.home).T)

    def pose_and_jacobian(self, posture: Floats) -> tuple[Floats, Floats]:
        """Poses (B, 8), their signs arbitrary, and J_w (B, 6, n) at postures (B, n) [rad].

        The postures run along the last axis of every array within: (column, row, B).
        """
        count, joints = posture.shape
        factors = np.ones((joints, 3, 1, count))
        factors[:, 1, 0], factors[:, 2, 0] = np.sin(posture.T), 1.0 - np.cos(posture.T)
        Ts, scaled = np.empty((joints + 1, 4, 3 * count)), np.empty((12, 3 * count))
        Ts[0] = np.repeat(_EYE, count, axis=1)
        parts = scaled.reshape(3, 12, count)
        for i, turn in enumerate(self._turns):
            np.multiply(factors[i], Ts[i].reshape(12, count), out=parts)
            np.dot(turn, scaled, out=Ts[i + 1])
        lines = np.matmul(self._lines, Ts[:-1]).reshape(joints, 2, 3, count)
        axes, points = lines[:, 0], lines[:, 1]
        J = np.empty((6, joints, count))
        J[:3] = axes.swapaxes(0, 1)
        for a, b, d in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            J[3 + a] = points[:, b] * axes[:, d] - points[:, d] * axes[:, b]
        T = np.dot(self._home, Ts[-1])
        return _pose(T.reshape(4, 3, count)), np.ascontiguousarray(J.transpose(2, 0, 1))


_EYE = np.eye(4)[:, :3]  # the transposed upper rows of T = I


def _constants(axis: Floats) -> tuple[Floats, Floats]:
    """The constants (4, 12) of a joint that multiply T', sin q T' and (1 - cos q) T', stacked.

    And (2, 4), which takes l and p from T'.
    """
    direction, moment = axis[:3], axis[3:]
    point = dq.cross(direction, moment)
    K = np.array([dq.cross(direction, e) for e in np.eye(3)]).T
    E = np.zeros((3, 4, 4))
    E[0] = np.eye(4)
    for i, turn in ((1, K), (2, K @ K)):
        E[i, :3, :3], E[i, :3, 3] = turn, -turn @ point
    return np.concatenate(list(E.mT), axis=1), np.array([[*direction, 0.0], [*point, 1.0]])


def _products() -> tuple[Floats, Floats]:
    """(16, 9) and (16, 1): 4 q q' of a unit quaternion, linear in its matrix, by columns."""
    linear, constant = np.zeros((4, 4, 3, 3)), np.diag([1.0, 1.0, 1.0, 1.0])
    linear[0, 0] = np.eye(3)
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        linear[i + 1, i + 1] = -np.eye(3)
        linear[i + 1, i + 1, i, i] = 1.0
        for a, b in ((0, i + 1), (i + 1, 0)):
            linear[a, b, k, j], linear[a, b, j, k] = 1.0, -1.0
        for a, b in ((i + 1, j + 1), (j + 1, i + 1)):
            linear[a, b, i, j] = linear[a, b, j, i] = 1.0
    by_columns = linear.swapaxes(2, 3).reshape(16, 9)
    return np.ascontiguousarray(by_columns), constant.reshape(16, 1)


_LINEAR, _CONSTANT = _products()
# the dual part t r / 2 from the twelve products t_i r_j
_DUAL = 0.5 * np.stack([dq.hamilton_plus(e)[:4, :4].T for e in np.eye(8)[1:4]]).reshape(12, 4)


def _pose(T: Floats) -> Floats:
    """Poses (B, 8) of matrices (4, 3, B); the quaternion from its best row, as in `dq`."""
    count = T.shape[-1]
    K = (np.dot(_LINEAR, T[:3].reshape(9, count)) + _CONSTANT).reshape(4, 4, count)
    best = K[[0, 1, 2, 3], [0, 1, 2, 3]].argmax(axis=0)
    q = K[best, :, np.arange(count)]
    q /= np.sqrt((q * q).sum(axis=1, keepdims=True))
    products = T[3].T[:, :, None] * q[:, None, :]
    return np.concatenate([q, np.dot(products.reshape(count, 12), _DUAL)], axis=1)
