"""What a plant is: an arm that is given joint rates for one period and answers with a posture."""

from typing import Protocol

from dqpaint.dq import Floats
from dqpaint.registry import Registry
from dqpaint.robots.card import Card


class Plant(Protocol):
    """One arm under control, from its start posture on.

    Attributes:
        posture: measured joint angles (n,) [rad].
        effort: motor torques (n,) [Nm], the largest seen in the last period; zeros without motors.
    """

    posture: Floats
    effort: Floats

    def run(self, rates: Floats) -> None:
        """Hold the commanded joint rates (n,) [rad/s] for one control period."""

    def close(self) -> None:
        """Give back what the plant holds."""


class PlantMaker(Protocol):
    """How a plant is built."""

    def __call__(self, card: Card, posture: Floats, period: float) -> Plant:
        """The arm of a card at rest in a posture (n,) [rad], controlled every `period` [s]."""


PLANTS: Registry[PlantMaker] = Registry("plant")
