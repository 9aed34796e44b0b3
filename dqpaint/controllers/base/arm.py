"""A law's model of its arm -> joint limits, kinematics and link distances for the law."""

from functools import cached_property
from typing import NamedTuple

import numpy as np

from dqpaint.dq import Floats
from dqpaint.robots.kinematics import CollisionShapes, Kinematics


class JointLimits(NamedTuple):
    """The limits of an arm's joints, one number a joint; the arrays are read-only.

    Attributes:
        lower: least angles (n,) [rad].
        upper: largest angles (n,) [rad].
        speed: largest rates (n,) [rad/s], either way.
        effort: largest torques (n,) [Nm], either way.
    """

    lower: Floats
    upper: Floats
    speed: Floats
    effort: Floats


INFINITE = np.array(np.inf)
NO_LIMITS = JointLimits(-INFINITE, INFINITE, INFINITE, INFINITE)


class Arm:
    """The arm as a law's model has it, which disturbances of the model may have changed.

    Attributes:
        limits: of its joints.
    """

    def __init__(self, kinematics: Kinematics) -> None:
        self._model = kinematics
        card = kinematics.card
        self.limits = JointLimits(card.lower, card.upper, card.speed, card.effort)
        for array in self.limits:
            array.setflags(write=False)

    @property
    def joints(self) -> int:
        """How many joints move."""
        return self._model.card.joints

    @cached_property
    def kinematics(self) -> Kinematics:
        """Pose and Jacobian at any posture: a copy, which a law may change without effect."""
        return self._model.with_model_error()

    @cached_property
    def collisions(self) -> CollisionShapes:
        """The distance between links at any posture: `nearest(postures)`."""
        return CollisionShapes(self.kinematics)
