"""Where the light is seen -> a better model of the arm, and a law that follows by that model."""

from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from dqpaint import dq
from dqpaint.controllers.base.arm import Arm
from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gain_schedule import Schedule
from dqpaint.controllers.base.gains import WHOLE_RUN, Gain, Gains
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats
from dqpaint.motion import Motion
from dqpaint.robots.kinematics import resolve

Learned = Literal["all", "base", "tool", "links"]
USUAL = {"base": (0.35, 0.1), "tool": (0.1, 0.03)}  # how far off a model may be [rad, m]
USUAL_LENGTH = 0.01  # of a link [m]
LEAST = 1e-6  # m^2, of what is minimised: how dear a change of the model is


class AdaptiveGains(Gains):
    """How fast the law goes and learns, and what."""

    constant: ClassVar[dict[str, str]] = {"learn": WHOLE_RUN}

    k: Gain = Field(20.0, description="1/s, the rate at which the estimated error decays")
    eta: Gain = Field(5.0, description="1/s, the rate at which the model comes to what is seen")
    learn: Learned = Field("all", description="what of the model is learned")


@controller(
    "adaptive", source="after Marinho & Adorno 2022", gains=AdaptiveGains, commands="rates",
    leaves_null=True, senses=("light",),
)  # fmt: skip
class Adaptive:
    """Learns base, tool and link lengths from where the light is seen; follows as log by them.

    Equation:
        q_dot = J_a^+ (-2 k log(x_e) + Ad(x_e) xi_d)
        x_e = x_a x_d^*
        x_a = x_b x_l(q) x_t
        a_dot = "argmin" 1/mu |J_p a_dot + eta (p_a - y)|^2 + |S^-1 a_dot|^2
        J_r a_dot = 0
    Idea:
        A bent arm is sure to be right: it measures its joints alone. Here a camera sees the light
        at y, and of all changes a_dot of the model, each as dear as it is unlikely, S, the
        cheapest is made that brings the estimated place p_a there at the rate eta.

    Error:
        of log, of the estimated pose.
    Stable:
        A cascade: p_a - y decays at eta where the parameters reach it, and p_a - p_d at k but for
        what is learned meanwhile. So y comes to p_d. The parameters need not become the true ones:
        only what the motion excites is learned.
    Fails:
        A place says nothing about the orientation: J_r a_dot = 0 keeps the estimated one, and
        a turned tool stays turned. It learns while there is light, and keeps what it has. The
        paper's bound, that learning must not raise the estimated error, is for set points: along
        a drawing it would end the learning.
    Try:
        dqpaint draw bent-arm --controller adaptive --disturb links=part=0.03 --overlay
    """

    def start(self, arm: Arm, _motion: Motion, gains: Schedule[AdaptiveGains]) -> None:
        """Begin with the model as it is."""
        self._model = arm.kinematics
        self._base, self._tool = dq.IDENTITY, dq.IDENTITY
        self._lengths = np.zeros((arm.joints + 1, 3))
        learn = gains.first.learn
        parts = [np.repeat(USUAL[part], 3) * (learn in ("all", part)) for part in ("base", "tool")]
        links = np.full(self._lengths.size, USUAL_LENGTH * (learn in ("all", "links")))
        self._usual = np.concatenate([*parts, links])

    def __call__(self, seen: Seen, gains: AdaptiveGains) -> Floats:
        """The joint rates (n,)."""
        axes = self._model.link_axes(seen.posture)
        x_a, J_a = self.estimate(seen, axes)
        goal = seen.pose_d if seen.signed else dq.nearest(seen.pose_d, x_a)
        x_e = dq.mul(x_a, dq.conj(goal))
        u = -2.0 * gains.k * dq.log(x_e, short=not seen.signed) + dq.adjoint(x_e, seen.twist_d)
        rates = resolve(J_a, dq.translation(x_a), u, None)
        if len(seen.light) and np.isfinite(seen.light).all():
            self._learn(seen, gains, x_a, axes)
        return rates

    def estimate(self, seen: Seen, axes: Floats) -> tuple[Floats, Floats]:
        """The pose (8,) and the Jacobian (6, n) of the learned model.

        Offsets on links before a joint move its axis and the tool, and turn nothing.
        """
        ways = np.cumsum(np.matvec(axes, self._lengths), axis=0)
        J = seen.jacobian.copy()
        J[3:] += dq.cross(ways[:-1], J[:3].T).T
        moved = dq.exp(0.5 * np.r_[np.zeros(3), ways[-1]])
        x = dq.mul(dq.mul(self._base, dq.mul(moved, seen.pose)), self._tool)
        return x, dq.adjoint(self._base, J.T).T

    def _learn(self, seen: Seen, gains: AdaptiveGains, x_a: Floats, axes: Floats) -> None:
        """A step of the model's parameters."""
        place, turn = parameter_jacobians(x_a, self._base, axes)
        rows = [*place, *(row for row in turn if (row * self._usual).any())]
        wanted = np.zeros(len(rows))
        wanted[:3] = -gains.eta * (dq.translation(x_a) - seen.light)
        step = seen.period * cheapest(np.array(rows), wanted, self._usual)
        self._base = dq.mul(dq.exp(0.5 * step[:6]), self._base)
        self._tool = dq.mul(self._tool, dq.exp(0.5 * step[6:12]))
        self._lengths += step[12:].reshape(-1, 3)


def parameter_jacobians(x_a: Floats, base: Floats, axes: Floats) -> tuple[Floats, Floats]:
    """How the estimated place (3, m) and orientation (3, m) change with the m parameters.

    A twist of the base, in its frame; one of the tool, in its own; an offset on each link.
    """
    R = dq.matrix_from_quaternion(x_a[:4])
    p = dq.translation(x_a)
    on_links = dq.matrix_from_quaternion(base[:4]) @ axes
    none, one = np.zeros((3, 3)), np.eye(3)
    turned = dq.cross(one, p).T  # column by column: e_i x p
    place = np.hstack([turned, one, none, R, *on_links])
    turn = np.hstack([one, none, R, none, *np.zeros_like(on_links)])
    return place, turn


def cheapest(A: Floats, b: Floats, usual: Floats) -> Floats:
    """Argmin |S^-1 u|^2 + |A_p u - b_p|^2 / mu with the rows after the first three exact."""
    weighted = A * usual
    soft = np.diag(np.where(np.arange(len(A)) < 3, LEAST, 0.0))
    y = np.linalg.lstsq(weighted @ weighted.T + soft, b, rcond=None)[0]
    return np.asarray(usual * (weighted.T @ y))
