"""What is true of the arm, and what the law is told of it."""

from collections import deque
from collections.abc import Mapping
from typing import NamedTuple
from zlib import crc32

import numpy as np

from dqpaint import dq
from dqpaint.disturbances import Disturbance
from dqpaint.dq import Floats
from dqpaint.plants.plant import Plant
from dqpaint.plants.world import UNDISTURBED
from dqpaint.robots.kinematics import Kinematics

Disturbances = Mapping[str, Disturbance]


class Told(NamedTuple):
    """What the law is told: encoder angles (n,) [rad], rates (n,) [rad/s], pose (8,), J (6, n)."""

    posture: Floats
    rates: Floats
    pose: Floats
    jacobian: Floats


class Senses:
    """Tells a law of the arm: by the encoders' readings and the model it believes in.

    Attributes:
        world: what the arm truly is under.
        believed: the law's model.
        honest: whether all that is told is true.
    """

    def __init__(
        self, kinematics: Kinematics, t: Floats, period: float, given: Disturbances, seed: int
    ) -> None:
        self.world, self.believed, self._true = UNDISTURBED, kinematics, kinematics
        self._period = period
        self._encoders = []
        for name, one in given.items():
            one.check(t)
            self.world = one.world(self.world)
            self.believed = one.belief(self.believed, chance(seed, name))
            encoder = one.encoder(len(t), kinematics.card.joints, chance(seed, name))
            if encoder is not None:
                self._encoders.append(encoder)
        self._error = np.zeros(kinematics.card.joints)
        self.honest = not self._encoders and self.believed is kinematics
        self._displaced = self.world.displaced

    def tell(self, row: int, plant: Plant) -> Told:
        """What the law is told at a row.

        Speeds are differences of readings: their error is the change of the angles' error in a
        period.
        """
        angles, rates = plant.encoder, plant.encoder_rates
        if self._encoders:
            read = angles
            for encoder in self._encoders:
                read = encoder(row, read)
            error = read - angles
            before, self._error = self._error if row else error, error
            angles, rates = read, rates + (error - before) / self._period
        return Told(angles, rates, *self.believed.pose_and_jacobian(angles))

    def truth(self, plant: Plant, told: Told) -> tuple[Floats, Floats]:
        """The light's true pose (8,) and Jacobian (6, n), in the frame the law takes for base."""
        if self.honest and not self._displaced and told.posture is plant.posture:
            return told.pose, told.jacobian
        x, J = self._true.pose_and_jacobian(plant.posture)
        if self._displaced:
            base = self.world.base
            x, J = dq.mul(base, x), dq.adjoint(base, J.T).T
        return x, J


class Late:
    """Passes commands on some periods late; before the first one comes what holds the arm."""

    def __init__(self, delay: int, hold: Floats) -> None:
        self._waiting = deque([hold] * delay)

    def __call__(self, command: Floats) -> Floats:
        """The command that arrives now."""
        self._waiting.append(command)
        return self._waiting.popleft()


def chance(seed: int, name: str) -> "np.random.Generator":
    """The random numbers of one disturbance: its own, whatever else disturbs."""
    return np.random.default_rng([seed, crc32(name.encode())])


def delay(given: Disturbances) -> int:
    """How many periods late commands come in all."""
    return sum(one.delay for one in given.values())
