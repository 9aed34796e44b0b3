"""Posture, rates and accelerations -> joint torques: H q_ddot + C q_dot + G + friction = tau."""

from typing import TYPE_CHECKING

import numpy as np

from dqpaint.core import PINOCCHIO, Library
from dqpaint.dq import Floats
from dqpaint.robots.kinematics.kinematics import Kinematics

if TYPE_CHECKING:
    import pinocchio
else:
    pinocchio = Library("pinocchio", PINOCCHIO)


class Dynamics:
    """Inverse dynamics of a card's arm, with the file's inertias and viscous joint friction."""

    def __init__(self, kinematics: Kinematics) -> None:
        self._model = kinematics.model
        self._data = self._model.createData()
        self._friction: Floats = np.array(self._model.damping)

    def torque(
        self, posture: Floats, rates: Floats, acceleration: Floats, period: float = 0.0
    ) -> Floats:
        """The torques (n,) [Nm] for joint accelerations (n,) [rad/s^2], held for a period [s].

        Friction is that of the middle of the period: a light joint's takes effect within
        milliseconds, and with that of its beginning such a joint gains a third of what it should.
        """
        needed = pinocchio.rnea(self._model, self._data, posture, rates, acceleration)
        return np.asarray(needed + self._friction * (rates + 0.5 * period * acceleration))

    def weight(self, posture: Floats) -> Floats:
        """G (n,) [Nm], the torques that hold the arm still."""
        return np.array(pinocchio.computeGeneralizedGravity(self._model, self._data, posture))

    def inertia(self, posture: Floats) -> Floats:
        """H (n, n) [kg m^2]."""
        upper = np.triu(pinocchio.crba(self._model, self._data, posture))
        return np.asarray(upper + np.triu(upper, 1).T)

    def decay(self, posture: Floats, damping: Floats | float = 0.0) -> float:
        """The rate [1/s] of the quickest decay by dampers (n,) [Nm s/rad] and the friction."""
        loss = np.diag(np.broadcast_to(damping + self._friction, self._friction.shape))
        rates = np.linalg.eigvals(np.linalg.solve(self.inertia(posture), loss))
        return float(rates.real.max())

    def inertia_and_bias(self, posture: Floats, rates: Floats) -> tuple[Floats, Floats]:
        """H (n, n) [kg m^2], and C q_dot + G + friction (n,) [Nm]."""
        inertia = self.inertia(posture)
        bias = pinocchio.nle(self._model, self._data, posture, rates) + self._friction * rates
        return inertia, np.array(bias)
