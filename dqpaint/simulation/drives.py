"""A law's command -> the plant's command, clipped to the arm's limits."""

from typing import Any, Protocol

import numpy as np

from dqpaint import dq
from dqpaint.controllers import Controller, Law, Seen
from dqpaint.dq import Floats
from dqpaint.robots.kinematics import (
    START_GAIN,
    Damping,
    Dynamics,
    Kinematics,
    RateBounds,
    SecondaryTask,
    damped_inverse,
    drift_acceleration,
    resolve,
)

NO_TWIST = np.zeros(6)  # the twist of a tool that stays


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
    law: Law[Any],
    kinematics: Kinematics,
    wish: SecondaryTask,
    period: float,
    damping: Damping = damped_inverse,
) -> Drive:
    """The drive a law needs.

    Args:
        controller: the law's own.
        law: of this run, as `controller.start` gave it.
        kinematics: of the arm, as the law's model has it.
        wish: the secondary task in the null space of a redundant arm.
        period: of the control [s].
        damping: of the pseudo-inverse.
    """
    drive = TorqueDrive if controller.drives_torque else RateDrive
    return drive(controller, law, kinematics, wish, period, damping)


class RateDrive:
    """For laws that command a twist or joint rates.

    q_dot = J^+ u + (I - J^+ J) z, with z the secondary task. Joint rates pass unchanged, but
    (I - J^+ J) z is added to those of a law that leaves the null space free.
    """

    def __init__(
        self,
        controller: Controller[Any],
        law: Law[Any],
        kinematics: Kinematics,
        wish: SecondaryTask,
        period: float,
        damping: Damping,
    ) -> None:
        self._damping = damping
        self._law = law
        self._resolved = controller.commands == "twist"
        self._leaves_null = controller.leaves_null
        self._wish = wish
        self._bounds = RateBounds(kinematics.card, period)

    def command(self, seen: Seen, gains: Any) -> Floats:
        """Joint rates (n,) [rad/s]."""
        answer: Floats = self._law(seen, gains)
        if not (self._resolved or self._leaves_null):
            return answer
        point = dq.translation(seen.pose)
        wish = self._wish(seen.posture, seen.jacobian, point)
        if self._resolved:
            return resolve(seen.jacobian, point, answer, wish, self._damping)
        return answer + resolve(seen.jacobian, point, NO_TWIST, wish, self._damping)

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
        law: Law[Any],
        kinematics: Kinematics,
        wish: SecondaryTask,
        period: float,
        damping: Damping,
    ) -> None:
        self._damping = damping
        self._law = law
        self._resolved = controller.commands == "acceleration"
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
        wanted = self._law(seen, gains) - drift_acceleration(seen.jacobian, rates)
        point = dq.translation(seen.pose)
        wish = START_GAIN * self._wish(q, seen.jacobian, point) - 2 * START_GAIN * rates
        bend = resolve(seen.jacobian, point, wanted, wish, self._damping)
        return self._dynamics.torque(q, rates, bend, self._period)

    def hold(self, posture: Floats) -> Floats:
        """The gravity torques (n,) [Nm] of the law's model."""
        return self.clip(self._dynamics.weight(posture), posture)

    def clip(self, wanted: Floats, posture: Floats) -> Floats:
        """Within the motors' torques."""
        return np.asarray(np.clip(wanted, -self._effort, self._effort))
