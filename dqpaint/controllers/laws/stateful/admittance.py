"""A push on the light -> a reference that yields to it as a mass on a damped spring."""

from typing import ClassVar

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


class YieldingGains(Gains):
    """Mass, damping and stiffness that a push meets, and the rate of the law within."""

    constant: ClassVar[dict[str, str]] = dict.fromkeys(
        ("mass", "inertia", "stiffness", "turning_stiffness", "damping"), WHOLE_RUN
    )

    mass: Gain = Field(2.0, description="kg, that a push has to move")
    stiffness: Gain = Field(200.0, description="N/m, that brings the light back")
    inertia: Gain = Field(0.1, description="kg m^2, that a moment has to turn")
    turning_stiffness: Gain = Field(10.0, description="Nm/rad, that turns the tool back")
    damping: Gain = Field(1.0, description="as a part of critical damping, 2 sqrt(K M)")
    k: Gain = Field(20.0, description="1/s, the rate of the log law that follows")


@controller(
    "admittance", source="after Fonseca, Adorno & Fraisse 2021", gains=YieldingGains,
    senses=("push",),
)  # fmt: skip
class Admittance:
    """Yields to a push as a mass on a spring, and comes back; follows as log; does not lag.

    Equation:
        q_dot = J_w^+ (-2 k log(x_e) + Ad(x_e) xi_c)
        x_e = x x_c^*
        x_c = x_d exp(1/2 z)
        xi_c = xi_d + Ad(x_d) J_l(z) z_dot
        M z_ddot + D z_dot + K z = J_l(z)' W
        W = [R_d' ((p - p_d) cross f); R_d' f]
    Idea:
        The drives hold an arm stiffly: leaning against it changes nothing. A sensor at the light
        measures the push f, and the reference itself gives way, as if the light hung on a spring.

    Error:
        of log, to the reference that has given way.
    Stable:
        The spring is linear and passive for M, D, K > 0: from the push to the twist, about a
        reference at rest, no energy is made. What follows is log.
    Fails:
        Where nothing pushes it is log. The plant has to hold against the push by itself: on
        compliant its springs give way besides.
    Try:
        dqpaint draw push --controller admittance --disturb push=y=15,start=0.1,seconds=1
    """

    def start(self, _arm: Arm, motion: Motion, gains: Schedule[YieldingGains]) -> None:
        """Solve the spring's equation over a period, for a push that stays as it is."""
        g = gains.first
        self._z, self._rate = np.zeros(6), np.zeros(6)
        self._steps = np.array([
            spring_step(m, 2.0 * g.damping * np.sqrt(stiffness * m), stiffness, motion.period)
            for m, stiffness in ((g.inertia, g.turning_stiffness), (g.mass, g.stiffness))
        ])  # fmt: skip

    def __call__(self, seen: Seen, gains: YieldingGains) -> Floats:
        """The twist (6,)."""
        goal = seen.goal
        Jl = dq.left_jacobian(self._z)
        x_c = dq.mul(goal, dq.exp(0.5 * self._z))
        xi_c = seen.twist_d + dq.adjoint(goal, Jl @ self._rate)
        x_e = spatial_error(seen.pose, x_c, signed=True)
        short = not seen.signed
        if len(seen.push):
            self._give_way(seen, Jl)
        return -2.0 * gains.k * dq.log(x_e, short=short) + dq.adjoint(x_e, xi_c)

    def _give_way(self, seen: Seen, Jl: Floats) -> None:
        """The spring's state at the next row."""
        home = dq.conj(seen.goal)[:4]
        arm = dq.translation(seen.pose) - dq.translation(seen.goal)
        wrench = np.concatenate([
            dq.rotate(home, dq.cross(arm, seen.push)), dq.rotate(home, seen.push)
        ])  # fmt: skip
        state = np.stack([self._z, self._rate, Jl.T @ wrench]).reshape(3, 2, 3)
        self._z, self._rate = np.einsum("pij,jpk->ipk", self._steps, state).reshape(2, 6)


def spring_step(mass: float, damping: float, stiffness: float, period: float) -> Floats:
    """The matrix (2, 3) from [z, z_dot, force] to [z, z_dot] a period later, the force constant."""
    from scipy.linalg import expm

    flow = np.zeros((3, 3))
    flow[0, 1] = 1.0
    flow[1] = [-stiffness / mass, -damping / mass, 1.0 / mass]
    return np.asarray(expm(period * flow)[:2])
