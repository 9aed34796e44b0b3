"""Joint-rate commands -> joints that follow them exactly."""

from typing import ClassVar

import numpy as np

from dqpaint.dq import Floats
from dqpaint.plants.plant import PLANTS, Options, Takes, Trait
from dqpaint.plants.world import UNDISTURBED, World
from dqpaint.robots.model import Card


@PLANTS.add("ideal")
class Ideal:
    """Kinematic: q(k+1) = q(k) + T q_dot, no masses and no motors."""

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
