"""Linear quadratic law in the dual-quaternion group, after Pereira."""

from typing import ClassVar

import numpy as np

from dqpaint import dq
from dqpaint.controllers.base.arm import Arm
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gain_schedule import Schedule
from dqpaint.controllers.base.pose_errors import spatial_error
from dqpaint.controllers.base.riccati import solve_elements_backwards
from dqpaint.controllers.base.seen import Seen
from dqpaint.controllers.base.weights import Weights, weights_at_gauss_points
from dqpaint.dq import Floats
from dqpaint.motion import Motion

BLOCK = 4096  # intervals that are worked out at once


class SixWeights(Weights):
    """Weights of [Im r_e; 1/2 p_e]: three numbers of rotation, three of translation."""

    size: ClassVar[int] = 6


@controller("lqr", source="Pereira 2016, LQR in DQ [3.60]", gains=SixWeights)
class Lqr:
    """Optimal between error and correction, in the tangent space: does not lag.

    q_dot = J_w^+ (-2 R^-1 P e + Ad(x_e) xi_d), with e = [Im r_e; 1/2 p_e], x_e = x x_d* and
    P_dot = P R^-1 P - Q, backwards from P = S at the end.

    In the tangent space e_dot = w, half the twist, and w = -R^-1 P e is the optimum: hence the 2.
    P is positive, so each part of the error decays at (R^-1 P): sqrt(q / r) far from the end.
    """

    batched = True  # what it keeps holds for every arm

    def start(self, _arm: Arm, motion: Motion, gains: Schedule[SixWeights]) -> None:
        """Work out P at every row."""
        self._P = riccati(motion, gains)

    def __call__(self, seen: Seen, gains: SixWeights) -> Floats:
        """The twist (..., 6)."""
        x_e = spatial_error(seen.pose, seen.pose_d)
        e = np.concatenate([x_e[..., 1:4], 0.5 * dq.translation(x_e)], axis=-1)
        correction = -2.0 * self._P[seen.row] * e / np.asarray(gains.r)
        return np.asarray(correction + dq.adjoint(x_e, seen.twist_d))


def riccati(motion: Motion, gains: Schedule[SixWeights]) -> Floats:
    """The diagonal of P (N, 6) [s] at every row: with diagonal weights P stays diagonal."""
    rows = len(motion.t)
    P = np.empty((rows, 6))
    P[-1] = gains.at(1.0).end_diagonal()
    for last in range(rows - 1, 0, -BLOCK):
        first = max(0, last - BLOCK)
        inverse, q = weights_at_gauss_points(gains, first, last, rows)
        P[first : last + 1] = solve_elements_backwards(inverse, q, P[last], motion.period)
    return P
