"""Joint-rate commands -> joints that follow them exactly."""

from typing import ClassVar

import numpy as np

from dqpaint.dq import Floats
from dqpaint.plants.plant import PLANTS, Options, Takes, Trait
from dqpaint.plants.world import UNDISTURBED, World
from dqpaint.robots.model import Card


@PLANTS.add("ideal")
class Ideal:
    """Kinematic: q(k+1) = q(k) + T q_dot, no masses and no motors.

    Equation:
        q_(k+1) = q_k + T q_dot
    Idea:
        The joints do exactly what they are told. What is seen is the law alone: its lag, its
        rounding, what it makes of a disturbance of its own kind.
    Stable:
        As the law in steps of T: a rate k needs k T < 2.
    Fails:
        To show anything that has to do with masses, motors or springs: payloads and pushes are
        refused here.
    Try:
        dqpaint compare lag --controllers p,hinf --plants ideal
    """

    takes: ClassVar[Takes] = "rates"
    traits: ClassVar[frozenset[Trait]] = frozenset()
    options: ClassVar[Options] = None

    def __init__(
        self,
        card: Card,
        posture: Floats,
        period: float,
        world: World = UNDISTURBED,
        options: None = None,
    ) -> None:
        self.posture = posture.copy()
        self.rates = np.zeros(card.joints)
        self.effort = np.zeros(card.joints)
        self._period = period

    @property
    def encoder(self) -> Floats:
        """Joint angles (n,) [rad]."""
        return self.posture

    @property
    def encoder_rates(self) -> Floats:
        """Joint rates (n,) [rad/s]."""
        return self.rates

    def run(self, command: Floats, drift: Floats | None = None) -> None:
        """One period at joint rates (n,) [rad/s]."""
        self.rates = command if drift is None else command + drift
        self.posture = self.posture + self._period * self.rates

    def close(self) -> None:
        """Does nothing: there is nothing to release."""
