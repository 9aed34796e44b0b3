"""Linear quadratic law on the invariant error in R8, after Pereira."""

from typing import ClassVar

import numpy as np

from dqpaint import dq
from dqpaint.controllers.base.arm import Arm
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gain_schedule import Schedule
from dqpaint.controllers.base.pose_errors import invariant_error, twist_of_invariant_rate
from dqpaint.controllers.base.riccati import GAUSS, scattering, solve_backwards
from dqpaint.controllers.base.seen import Seen
from dqpaint.controllers.base.weights import Weights, weights_at_gauss_points
from dqpaint.dq import Floats
from dqpaint.motion import Motion

BLOCK = 128  # intervals that are worked out at once
UPPER = np.triu_indices(8)
PLACES = np.zeros((8, 8), dtype=np.int64)  # of the elements of P among the 36 that are kept
PLACES[UPPER] = np.arange(36)
PLACES = np.maximum(PLACES, PLACES.T)


class EightWeights(Weights):
    """Weights of vec(1 - x* x_d): scalar first, the primary part first."""

    size: ClassVar[int] = 8


@controller("lqr8", source="Pereira 2016, LQR in R8 [3.45]", gains=EightWeights)
class Lqr8:
    """Optimal between error and correction, on the eight numbers: knows the whole way ahead.

    q_dot = N^+ R^-1 (P e + g), with e = vec(1 - x* x_d), A = H-(x_d* x_d_dot),
    c = -vec(x_d* x_d_dot) (the thesis prints x_dot) and, backwards from P = S and g = 0,
    P_dot = -P A - A'P + P R^-1 P - Q and g_dot = -A'g + P R^-1 g - P c.

    e_dot = A e + u + c, u = -N q_dot: the optimum of this model while all of u is in the range of
    N, that is for small errors. g is the price of what is still to come: the feed-forward.
    """

    batched = True  # what it keeps holds for every arm

    def start(self, _arm: Arm, motion: Motion, gains: Schedule[EightWeights]) -> None:
        """Work out P and g at every row."""
        self._P, self._g = riccati(motion, gains)

    def __call__(self, seen: Seen, gains: EightWeights) -> Floats:
        """The twist (..., 6)."""
        e = invariant_error(seen.pose, seen.pose_d)
        P, g = self._P[seen.row][..., PLACES], self._g[seen.row]
        wanted = (np.matvec(P, e) + g) / np.asarray(gains.r)
        return twist_of_invariant_rate(seen.pose, seen.pose_d, wanted)


def riccati(motion: Motion, gains: Schedule[EightWeights]) -> tuple[Floats, Floats]:
    """P, as its upper triangle (N, 36) row by row, and g (N, 8) at every row [s]."""
    rows = len(motion.t)
    triangles, costs = np.empty((rows, 36)), np.empty((rows, 8))
    P, g = np.diag(gains.at(1.0).end_diagonal()), np.zeros(8)
    triangles[-1], costs[-1] = P[UPPER], g
    for last in range(rows - 1, 0, -BLOCK):
        first = max(0, last - BLOCK)
        y = body_rates(motion, first, last)
        inverse, q = weights_at_gauss_points(gains, first, last, rows)
        passing = scattering(dq.hamilton_minus(y), inverse, q, -y, motion.period)
        Ps, gs = solve_backwards(passing, P, g)
        P, g = Ps[0], gs[0]
        triangles[first:last] = Ps[:, UPPER[0], UPPER[1]]
        costs[first:last] = gs
    return triangles, costs


def body_rates(motion: Motion, first: int, last: int) -> Floats:
    """x_d* x_d_dot (2, n, 8) [1/s, m/s] at the Gauss points of the intervals between two rows.

    Within a stroke by Hermite's cubic from the twists and accelerations at both ends. The row at a
    stroke's end has the twist of the next one: there a parabola, from the stroke's own beginning
    and how far it carries the pose. A `step` jumps: on its way nothing moves.
    """
    rows = slice(first, last + 1)
    home = dq.conj(motion.pose[rows])
    rate = 0.5 * dq.adjoint(home, motion.twist[rows])
    slope = 0.5 * motion.period * dq.adjoint(home, motion.acceleration[rows])  # an interval is 1
    y0, y1, s0, s1 = rate[:-1], rate[1:], slope[:-1], slope[1:]
    moved = dq.log(dq.mul(home[:-1], dq.conj(home[1:]))) / motion.period  # the mean of y
    t = GAUSS[:, None, None]
    cubic = y0 + t * s0 + t**2 * (3 * (y1 - y0) - 2 * s0 - s1) + t**3 * (2 * (y0 - y1) + s0 + s1)
    parabola = y0 + t * s0 + t**2 * 3 * (moved - y0 - s0 / 2)
    ends = motion.stroke[first:last] != motion.stroke[first + 1 : last + 1]
    y = np.where(ends[:, None], parabola, cubic)
    return dq.pure(np.where(motion.jump[first:last, None], 0.0, y))
