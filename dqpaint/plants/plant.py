"""What a plant is: an arm that is given commands, each for one period, and answers by moving."""

from typing import Literal, Protocol

from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.registry import Registry
from dqpaint.robots.card import Card

Takes = Literal["rates", "torque"]
DEFAULT_PLANTS: dict[Takes, str] = {"rates": "stiff", "torque": "torque"}


class Plant(Protocol):
    """One arm under control, from its start posture on.

    Attributes:
        posture: measured joint angles (n,) [rad].
        rates: measured joint rates (n,) [rad/s].
        effort: motor torques (n,) [Nm], the largest seen in the last period; zeros without motors.
    """

    posture: Floats
    rates: Floats
    effort: Floats

    def run(self, command: Floats, drift: Floats | None = None) -> None:
        """Hold a command for one control period.

        Args:
            command: joint rates (n,) [rad/s] or torques (n,) [Nm], as the plant takes them.
            drift: joint rates (n,) [rad/s] that come on top, from a motion no model knows of.
        """

    def close(self) -> None:
        """Give back what the plant holds."""


class PlantMaker(Protocol):
    """How a plant is built."""

    @property
    def takes(self) -> Takes:
        """What its commands are."""

    def __call__(self, card: Card, posture: Floats, period: float) -> Plant:
        """The arm of a card at rest in a posture (n,) [rad], controlled every `period` [s]."""


PLANTS: Registry[PlantMaker] = Registry("plant")


def choose_plant(name: str | None, takes: Takes) -> str:
    """The name of a plant that takes such commands: the one asked for, or the usual one.

    Raises:
        UsageError: an unknown plant, or one that takes other commands.
    """
    if name is None:
        return DEFAULT_PLANTS[takes]
    if PLANTS[name].takes != takes:
        suited = [other for other, plant in PLANTS.items() if plant.takes == takes]
        words = {"rates": "joint rates", "torque": "torques"}
        raise UsageError(
            f"plant '{name}' takes {words[PLANTS[name].takes]}, but this controller commands "
            f"{words[takes]}; plants for it: {', '.join(suited)}"
        )
    return name
