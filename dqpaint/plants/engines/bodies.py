"""Torques or rates of motors -> rigid bodies on joints: what every physics engine does for a plant.

Masses, inertias and viscous friction of joints are those of the arm's prepared description. Shapes
are left out: nothing touches anything in a light painting, and loading meshes costs twenty times
the rest. Integration is semi-implicit Euler, friction taken at the beginning of a step.
"""

from typing import Protocol

from dqpaint.dq import Floats
from dqpaint.plants.world import World
from dqpaint.robots.model import Card

STOP_DISTANCE = 0.02  # [rad] from a joint's limit to its mechanical stop; commands end at the limit


class Bodies(Protocol):
    """The bodies of a card's arm in a world of their own, with pushes at their times."""

    def state(self) -> tuple[list[float], list[float]]:
        """Angles [rad] and rates [rad/s] of the joints."""

    def place(self, angles: Floats, rates: Floats) -> None:
        """Put the joints at angles (n,) [rad], moving at rates (n,) [rad/s]."""

    def turn(self, rates: Floats, steps: int) -> Floats:
        """Physics steps under velocity motors that give at most the card's torques.

        A motor gives what its rate needs at the end of each step, or its largest torque.

        Args:
            rates: of the joints (n,) [rad/s].
            steps: of physics.

        Returns:
            The larger of the torques (n,) [Nm] of the first step and of the last.
        """

    def apply(self, torques: list[float]) -> None:
        """One physics step at joint torques [Nm]."""

    def weight(self, posture: Floats) -> Floats:
        """Gravity torques (n,) [Nm] of the arm and its load in a posture (n,) [rad]."""

    def close(self) -> None:
        """Release what is held."""


class BodiesMaker(Protocol):
    """What builds the bodies of an arm."""

    def __call__(
        self, card: Card, posture: Floats, step: float, world: World, driven: bool
    ) -> Bodies:
        """The bodies at rest.

        Args:
            card: of the arm.
            posture: to begin in (n,) [rad].
            step: of physics [s].
            world: around the arm.
            driven: whether velocity motors turn the joints; else torques alone do.
        """
