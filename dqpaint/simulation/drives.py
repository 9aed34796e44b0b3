"""A law's command -> the plant's command, clipped to the arm's limits."""

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np

from dqpaint import dq
from dqpaint.controllers import Controller, Law, Seen
from dqpaint.dq import Floats
from dqpaint.robots.kinematics import (
    START_GAIN,
    Dynamics,
    Kinematics,
    RateBounds,
    SecondaryTask,
    drift_acceleration,
)
from dqpaint.robots.resolvers import DEFAULT_RESOLVER, Resolver, Setup, State, make_resolver


class Drive(Protocol):
    """The conversion of a law's command into that of a plant."""

    def command(self, seen: Seen, gains: Any) -> Floats:
        """Joint rates (n,) [rad/s] or torques (n,) [Nm], before any limit."""

    def hold(self, posture: Floats) -> Floats:
        """The command that holds the arm still in a posture (n,) [rad]."""

    def clip(self, wanted: Floats, posture: Floats) -> Floats:
        """The same within the limits, in a posture (n,) [rad]."""


def make_drive(
    controller: Controller[Any],
    laws: Sequence[Law[Any]],
    kinematics: Kinematics,
    wish: SecondaryTask,
    period: float,
    resolver: Resolver | None = None,
) -> Drive:
    """The drive a law needs.

    Args:
        controller: the law's own.
        laws: of this run, as `controller.start` gave them, one for each part of the task.
        kinematics: of the arm, as the law's model has it.
        wish: the secondary task in the null space of a redundant arm.
        period: of the control [s].
        resolver: of this run; None is the default one.
    """
    if resolver is None:
        resolver = make_resolver(DEFAULT_RESOLVER, Setup(kinematics, period, kinematics.task))
    drive = TorqueDrive if controller.drives_torque else RateDrive
    return drive(controller, laws, kinematics, wish, period, resolver)


class _Tasked:
    """Laws, one for each part of the task, each with the reference of its part."""

    def __init__(self, laws: Sequence[Law[Any]], kinematics: Kinematics) -> None:
        self._laws = list(zip(laws, kinematics.task.parts, strict=False))

    def answers(self, seen: Seen, gains: Any) -> list[Floats]:
        """The commands (..., 6) of the laws.

        What a task leaves free is no error: each law sees the reference that is nearest to where
        the tool is among all that are as good.
        """
        return [
            law(seen._replace(pose_d=part.near(seen.pose_d, seen.pose)), gains)
            for law, part in self._laws
        ]


class RateDrive:
    """For laws that command a twist or joint rates.

    A resolver finds q_dot = J^+ u + (I - J^+ J) z, with z the secondary task. Joint rates pass as
    the resolver allows, but (I - J^+ J) z is added to those of a law that leaves the null space
    free.
    """

    def __init__(
        self,
        controller: Controller[Any],
        laws: Sequence[Law[Any]],
        kinematics: Kinematics,
        wish: SecondaryTask,
        period: float,
        resolver: Resolver,
    ) -> None:
        self._resolver = resolver
        self._law, self._tasked = laws[0], _Tasked(laws, kinematics)
        self._resolved = controller.is_resolved
        self._leaves_null = controller.leaves_null
        self._wish = wish
        self._bounds = RateBounds(kinematics.card, period)

    def command(self, seen: Seen, gains: Any) -> Floats:
        """Joint rates (n,) [rad/s]."""
        state = State(seen.pose, seen.jacobian, seen.posture, seen.time)
        if self._resolved:
            answers = self._tasked.answers(seen, gains)
            return self._resolver.rates(state, answers, self._null(seen))
        answer: Floats = self._law(seen, gains)
        if self._leaves_null:
            answer = answer + self._resolver.null_motion(state, self._null(seen))
        return self._resolver.allowed(state, answer)

    def _null(self, seen: Seen) -> Floats:
        return self._wish(seen.posture, seen.jacobian, dq.translation(seen.pose))

    def hold(self, posture: Floats) -> Floats:
        """No rates (n,)."""
        return np.zeros_like(posture)

    def clip(self, wanted: Floats, posture: Floats) -> Floats:
        """Within the speed limits, and ending within the position limits."""
        return self._bounds.clip(wanted, posture)


class TorqueDrive:
    """For laws that command a spatial acceleration or joint torques.

    An acceleration a becomes tau = H q_ddot + C q_dot + G + friction with
    q_ddot = J^+ (a - J_dot q_dot) + (I - J^+ J) z (Chandra 2020 [35]). In the null space
    z = PULL (wish - 2 q_dot): damped, or a redundant arm would drift; critically where the wish is
    PULL (start - q).
    """

    def __init__(
        self,
        controller: Controller[Any],
        laws: Sequence[Law[Any]],
        kinematics: Kinematics,
        wish: SecondaryTask,
        period: float,
        resolver: Resolver,
    ) -> None:
        self._resolver = resolver
        self._law, self._tasked = laws[0], _Tasked(laws, kinematics)
        self._resolved = controller.is_resolved
        self._period = period
        self._wish = wish
        self._dynamics = Dynamics(kinematics)
        self._effort = kinematics.card.effort

    def command(self, seen: Seen, gains: Any) -> Floats:
        """Joint torques (n,) [Nm]."""
        q, rates = seen.posture, seen.rates
        if not self._resolved:
            inertia, bias = self._dynamics.inertia_and_bias(q, rates)
            torque: Floats = self._law(seen._replace(inertia=inertia, bias=bias), gains)
            return torque
        drift = drift_acceleration(seen.jacobian, rates)
        wanted = [answer - drift for answer in self._tasked.answers(seen, gains)]
        point = dq.translation(seen.pose)
        wish = START_GAIN * self._wish(q, seen.jacobian, point) - 2 * START_GAIN * rates
        bend = self._resolver.rates(State(seen.pose, seen.jacobian, q, seen.time), wanted, wish)
        return self._dynamics.torque(q, rates, bend, self._period)

    def hold(self, posture: Floats) -> Floats:
        """The gravity torques (n,) [Nm] of the law's model."""
        return self.clip(self._dynamics.weight(posture), posture)

    def clip(self, wanted: Floats, posture: Floats) -> Floats:
        """Within the motors' torques."""
        return np.asarray(np.clip(wanted, -self._effort, self._effort))
