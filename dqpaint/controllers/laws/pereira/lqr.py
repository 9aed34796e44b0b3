"""Linear quadratic law in the dual-quaternion group, after Pereira."""

from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from dqpaint.controllers.base.arm import Arm
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gain_schedule import Schedule
from dqpaint.controllers.base.gains import WHOLE_RUN
from dqpaint.controllers.base.pose_errors import (
    POINT_HELP,
    Point,
    error_vector,
    spatial_error,
    tracking_command,
)
from dqpaint.controllers.base.riccati import scattering, solve_backwards, solve_elements_backwards
from dqpaint.controllers.base.seen import Seen
from dqpaint.controllers.base.weights import Weights, times_inverse, weights_at_gauss_points
from dqpaint.dq import Floats
from dqpaint.motion import Motion

BLOCK = 4096  # intervals that are worked out at once
ENDS = np.array([0.0, 1.0])  # of a drawing


class SixWeights(Weights):
    """Weights of [Im r_e; 1/2 p_e]: three numbers of rotation, three of translation."""

    size: ClassVar[int] = 6
    constant: ClassVar[dict[str, str]] = {**Weights.constant, "form": WHOLE_RUN, "point": WHOLE_RUN}

    form: Literal["derived", "printed"] = Field(
        "derived", description="-2 R^-1 P e as (3.57) has it, or -R^-1 P e as (3.60) is printed"
    )
    point: Point = Field("base", description=POINT_HELP)


@controller(
    "lqr", source="Pereira 2016, LQR in DQ [3.60]", gains=SixWeights,
    paper={"q": 270.0, "r": 0.01, "s": 0.0},
    paper_source="the best weights of its section 5.7, at 8 ms; (3.60) is form=printed",
)  # fmt: skip
class Lqr:
    """Optimal between error and correction, in the tangent space: does not lag.

    Equation:
        q_dot = J_w^+ (-2 R^-1 P e + Ad(x_e) xi_d)
        e = [Im(r_e); 1/2 p_e]
        x_e = x x_d^* = r_e + eps 1/2 p_e r_e
        P_dot = P R^-1 P - Q, P(t_f) = S
        min 1/2 e(t_f)' S e(t_f) + 1/2 int_0^t_f (e' Q e + w' R w) dt
    Idea:
        How fast an error should decay is a bargain between the error and the correction, weighed
        by Q and R. In the tangent space e_dot = w, half the twist, and w = -R^-1 P e is the
        optimum: hence the 2. (3.60) prints -R^-1 P e: form=printed is that, at half the rate.

    Error:
        about the base's origin: p_e = t - R_e t_d, with a bow on the way to a set point where the
        tool is turned wrongly, too; point=tool takes t - t_d and goes straight.
    Stable:
        P is positive definite while S is, so the error decays at the rates of R^-1 P; with numbers
        sqrt(q / r) far from the end, half of that as printed. Held for a period T it needs
        sqrt(q / r) T < 2.
    Fails:
        With s = 0, as the thesis has it, the gain dies away in the last moment, and what error is
        left then stays. Optimal for small rotations: Im(r_e) is the sine of half the angle.
    Try:
        dqpaint compare lag --controllers "lqr,lqr(form=printed)"
    """

    batched = True  # what it keeps holds for every arm

    def start(self, _arm: Arm, motion: Motion, gains: Schedule[SixWeights]) -> None:
        """Work out P at every row."""
        self._P = riccati(motion, gains)
        self._factor = -2.0 if gains.first.form == "derived" else -1.0

    def __call__(self, seen: Seen, gains: SixWeights) -> Floats:
        """The twist (..., 6)."""
        x_e = spatial_error(seen.pose, seen.pose_d, seen.signed)
        e = error_vector(x_e, seen, gains.point)
        e[..., 3:] *= 0.5
        P = self._P[seen.row]
        effect = P * e if self._P.ndim == 2 else np.matvec(P, e)
        correction = self._factor * times_inverse(gains.r, effect)
        return tracking_command(correction, x_e, seen, gains.point)


def riccati(motion: Motion, gains: Schedule[SixWeights]) -> Floats:
    """P [s] at every row: its diagonal (N, 6) while all weights are diagonal, else (N, 6, 6)."""
    rows = len(motion.t)
    whole = any(gains.column(name, ENDS).ndim == 3 for name in ("q", "r")) or (
        np.ndim(gains.at(1.0).end_weight) == 2
    )
    end = gains.at(1.0).end_matrix()
    P = np.empty((rows, 6, 6) if whole else (rows, 6))
    P[-1] = end if whole else end.diagonal()
    for last in range(rows - 1, 0, -BLOCK):
        first = max(0, last - BLOCK)
        inverse, q = weights_at_gauss_points(gains, first, last, rows)
        if whole:
            still = np.zeros((2, last - first, 6, 6))
            passing = scattering(still, inverse, q, still[..., 0], motion.period)
            P[first:last] = solve_backwards(passing, P[last], np.zeros(6))[0]
        else:
            inverse, q = (np.diagonal(one, axis1=-2, axis2=-1) for one in (inverse, q))
            P[first : last + 1] = solve_elements_backwards(inverse, q, P[last], motion.period)
    return P
