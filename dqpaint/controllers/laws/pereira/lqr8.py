"""Linear quadratic law on the invariant error in R8, after Pereira."""

from typing import ClassVar

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.arm import Arm
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gain_schedule import Schedule
from dqpaint.controllers.base.gains import WHOLE_RUN
from dqpaint.controllers.base.pose_errors import (
    POINT_HELP,
    Point,
    invariant_error,
    spatial_error,
    twist_of_invariant_rate,
    twist_of_pose_rate,
)
from dqpaint.controllers.base.riccati import GAUSS, scattering, solve_backwards
from dqpaint.controllers.base.seen import Seen
from dqpaint.controllers.base.weights import Weights, times_inverse, weights_at_gauss_points
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
    constant: ClassVar[dict[str, str]] = {**Weights.constant, "point": WHOLE_RUN}

    point: Point = Field("tool", description=POINT_HELP)


@controller(
    "lqr8", source="Pereira 2016, LQR in R8 [3.45]", gains=EightWeights,
    paper={"q": "220..220@30%..270@30%", "r": 0.01, "s": 0.0},
    paper_source="the best weights of its Table 5.11, at 8 ms",
)  # fmt: skip
class Lqr8:
    """Optimal between error and correction, on all eight components: it knows the motion ahead.

    Equation:
        q_dot = N^+ R^-1 (P e + g)
        e = vec(1 - x^* x_d)
        P_dot = -P A - A' P + P R^-1 P - Q, P(t_f) = S
        g_dot = -A' g + P R^-1 g - P c, g(t_f) = 0
        A = H_minus(x_d^* x_d_dot), c = -vec(x_d^* x_d_dot)
    Idea:
        e_dot = A e + u + c with u = -N q_dot is linear, so the best correction over the whole
        drawing can be computed beforehand. g is the price of what is still to come: the
        feed-forward. The thesis prints x_dot for x_d_dot in c.

    Error:
        at the tool, the same from whatever base frame; point=base takes 1 - x x_d^* instead, with
        A = -H_minus(1/2 xi_d) and c = vec(1/2 xi_d).
    Stable:
        P is positive definite while S is; far from the end a small error decays at sqrt(q / r).
        Held for a period T it needs sqrt(q / r) T < 2.
    Fails:
        Optimal for small errors alone: u is a point of R^8, N has rank 6, and N N^+ u is not u. It
        rounds every start and stop a little, and with s = 0 its gain dies away at the end.
    Try:
        dqpaint compare lag --controllers lqr8,pff --overlay
    """

    batched = True  # what it keeps holds for every arm

    def start(self, _arm: Arm, motion: Motion, gains: Schedule[EightWeights]) -> None:
        """Work out P and g at every row."""
        self._P, self._g = riccati(motion, gains)

    def __call__(self, seen: Seen, gains: EightWeights) -> Floats:
        """The twist (..., 6)."""
        P, g = self._P[seen.row][..., PLACES], self._g[seen.row]
        if gains.point == "base":
            x_e = spatial_error(seen.pose, seen.pose_d, seen.signed)
            wanted = np.matvec(P, dq.IDENTITY - x_e) + g
            return twist_of_pose_rate(x_e, times_inverse(gains.r, wanted))
        e = invariant_error(seen.pose, seen.pose_d, seen.signed)
        wanted = times_inverse(gains.r, np.matvec(P, e) + g)
        return twist_of_invariant_rate(seen.pose, seen.goal, wanted)


def riccati(motion: Motion, gains: Schedule[EightWeights]) -> tuple[Floats, Floats]:
    """P, as its upper triangle (N, 36) row by row, and g (N, 8) at every row [s]."""
    rows = len(motion.t)
    triangles, costs = np.empty((rows, 36)), np.empty((rows, 8))
    P, g = gains.at(1.0).end_matrix(), np.zeros(8)
    triangles[-1], costs[-1] = P[UPPER], g
    for last in range(rows - 1, 0, -BLOCK):
        first = max(0, last - BLOCK)
        y = error_rates(motion, first, last, gains.first.point)
        inverse, q = weights_at_gauss_points(gains, first, last, rows)
        passing = scattering(dq.hamilton_minus(y), inverse, q, -y, motion.period)
        Ps, gs = solve_backwards(passing, P, g)
        P, g = Ps[0], gs[0]
        triangles[first:last] = Ps[:, UPPER[0], UPPER[1]]
        costs[first:last] = gs
    return triangles, costs


def error_rates(motion: Motion, first: int, last: int, point: Point) -> Floats:
    """Y (2, n, 8) at the Gauss points of the intervals between two rows: A = H-(y), c = -y.

    At the tool x_d* x_d_dot; about the base's origin -1/2 xi_d.
    """
    if point == "tool":
        return body_rates(motion, first, last)
    still = np.broadcast_to(dq.IDENTITY, motion.pose[first : last + 1].shape)
    return -_rates(motion, first, last, still)


def body_rates(motion: Motion, first: int, last: int) -> Floats:
    """x_d* x_d_dot (2, n, 8) [1/s, m/s] at the Gauss points of the intervals between two rows."""
    return _rates(motion, first, last, dq.conj(motion.pose[first : last + 1]))


def _rates(motion: Motion, first: int, last: int, frame: Floats) -> Floats:
    """Half the twist (2, n, 8) at the Gauss points, as seen from frames (n + 1, 8) of the rows.

    Within a stroke by Hermite's cubic from the twists and accelerations at both ends. The row at a
    stroke's end has the twist of the next one: there a parabola, from the stroke's own beginning
    and how far it carries the pose. A `step` jumps: on its way nothing moves.
    """
    rows = slice(first, last + 1)
    home = dq.conj(motion.pose[rows])
    rate = 0.5 * dq.adjoint(frame, motion.twist[rows])
    slope = 0.5 * motion.period * dq.adjoint(frame, motion.acceleration[rows])  # an interval is 1
    y0, y1, s0, s1 = rate[:-1], rate[1:], slope[:-1], slope[1:]
    moved = dq.adjoint(  # the mean of y
        frame[:-1], dq.log(dq.mul(dq.conj(home[1:]), home[:-1])) / motion.period
    )
    t = GAUSS[:, None, None]
    cubic = y0 + t * s0 + t**2 * (3 * (y1 - y0) - 2 * s0 - s1) + t**3 * (2 * (y0 - y1) + s0 + s1)
    parabola = y0 + t * s0 + t**2 * 3 * (moved - y0 - s0 / 2)
    ends = motion.stroke[first:last] != motion.stroke[first + 1 : last + 1]
    y = np.where(ends[:, None], parabola, cubic)
    return dq.pure(np.where(motion.jump[first:last, None], 0.0, y))
