"""Predictive law: joint rates of the next steps, within limits, from the reference ahead."""

from typing import Annotated, ClassVar

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.arm import Arm
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gain_schedule import Schedule
from dqpaint.controllers.base.gains import WHOLE_RUN, Gain, Gains
from dqpaint.controllers.base.pose_errors import spatial_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats
from dqpaint.motion import Motion
from dqpaint.robots.kinematics import resolve, tool_jacobian_map
from dqpaint.robots.resolvers import USUAL_APPROACH, Bounds, Qp


class HorizonGains(Gains):
    """A rate, how far the law looks ahead, and the acceleration that it keeps to."""

    constant: ClassVar[dict[str, str]] = {"steps": WHOLE_RUN}

    k: Gain = Field(20.0, description="1/s, the rate at which an error decays within limits")
    steps: Annotated[int, Field(ge=1, le=40)] = Field(
        10, description="N, a whole number, of periods that are looked ahead"
    )
    acceleration: Gain = Field(20.0, description="rad/s^2, the largest of every joint")


@controller(
    "mpc", source="receding horizon; error and resolver ours", gains=HorizonGains, commands="rates",
)  # fmt: skip
class Mpc:
    """Looks N steps ahead within limits of rate and acceleration: rounds a corner before it.

    Equation:
        min sum_i |e_i - (1 - k T)^i e_0|^2 + l |q_dot_i - q_dot_i0|^2
        e_i = e_(i-1) + T (J_w q_dot_i - Ad(x_e) xi_di)
        |q_dot_i - q_dot_(i-1)| <= a T, "lower" <= q_dot_i <= "upper"
        q_dot = q_dot_1
        e_0 = 2 log(x_e), x_e = x x_d^*
    Idea:
        All rates of the next N periods are chosen together, and the first ones are sent. Where the
        line turns sharper than the joints can, the error is shared between before and after the
        corner. Without a limit in the way every step is that of log.

    Error:
        of log, weighed at the tool; J_w and x_e stay as they are over the horizon.
    Stable:
        As log while no limit is met. At one it is a convex program with the limits as they are:
        the rates of the last step, held, always keep them, so there is always an answer.
    Fails:
        N = 1 is log with the resolver qp: it sees no corner. A horizon shorter than it takes to
        turn, speed / a, sees it too late. What it costs grows with
        the cube of N.
    Try:
        dqpaint draw corner --controller mpc --gain acceleration=3 --gain steps=20 --plant ideal
    """

    def start(self, arm: Arm, _motion: Motion, gains: Schedule[HorizonGains]) -> None:
        """Begin at rest."""
        self._limits, self._steps = arm.limits, gains.first.steps
        self._last = np.zeros(arm.joints)

    def __call__(self, seen: Seen, gains: HorizonGains) -> Floats:
        """The joint rates (n,)."""
        wanted = self._wanted(seen, gains)
        n, count = len(self._last), self._steps
        J = tool_jacobian_map(dq.translation(seen.pose)) @ seen.jacobian
        sums = np.tril(np.ones((count, count)))
        weight = np.kron(sums.T @ sums, J.T @ J).astype(np.float64)  # of all errors, by T^2
        rates = Qp.nearest(
            wanted.ravel(),
            lambda: weight,
            self._bounds(seen, gains.acceleration * seen.period),
        ).rates
        self._last = np.asarray(rates[:n], dtype=np.float64)
        return self._last

    def _wanted(self, seen: Seen, gains: HorizonGains) -> Floats:
        """The rates (N, n) of the horizon, were there no limits."""
        x_e = spatial_error(seen.pose, seen.pose_d, seen.signed)
        back = -2.0 * gains.k * dq.log(x_e, short=not seen.signed)
        ahead = np.zeros((self._steps, 6))
        if seen.motion is not None:
            found = seen.ahead(self._steps - 1).twist
            ahead[: len(found)] = found
        ahead[0] = seen.twist_d
        left = (1.0 - gains.k * seen.period) ** np.arange(self._steps)
        u = left[:, None] * back + dq.adjoint(np.broadcast_to(x_e, (self._steps, 8)), ahead)
        point = dq.translation(seen.pose)
        return np.array([resolve(seen.jacobian, point, one, None) for one in u])

    def _bounds(self, seen: Seen, change: float) -> Bounds:
        """Rates between the joints' limits, each at most `change` [rad/s] from the one before."""
        lower, upper, speed, _ = self._limits
        nearing = USUAL_APPROACH / seen.period
        low = np.clip(nearing * (lower - seen.posture), -speed, speed)
        high = np.clip(nearing * (upper - seen.posture), -speed, speed)
        n, count = len(self._last), self._steps
        lows, highs = np.tile(low, count), np.tile(high, count)
        lows[:n] = np.clip(self._last - change, low, high)
        highs[:n] = np.clip(self._last + change, low, high)
        steps = (np.eye(count) - np.eye(count, k=-1))[1:]
        rows = np.kron(steps, np.eye(n))
        return Bounds(lows, highs, np.vstack([rows, -rows]), np.full(2 * len(rows), change))
