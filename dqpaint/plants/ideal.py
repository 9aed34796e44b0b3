"""The ideal arm: joints do exactly what they are told."""

import numpy as np

from dqpaint.dq import Floats
from dqpaint.plants.plant import PLANTS
from dqpaint.robots.card import Card


@PLANTS.add("ideal")
class Ideal:
    """Kinematic: q(k+1) = q(k) + T q_dot, no masses and no motors."""

    def __init__(self, card: Card, posture: Floats, period: float) -> None:
        self.posture = posture.copy()
        self.effort = np.zeros(card.joints)
        self._period = period

    def run(self, rates: Floats) -> None:
        """One period at the commanded rates (n,) [rad/s]."""
        self.posture = self.posture + self._period * rates

    def close(self) -> None:
        """Nothing to give back."""
