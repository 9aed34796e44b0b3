"""What is true of the arm, and what the law is told of it."""

from collections import deque
from collections.abc import Mapping, Sequence
from typing import NamedTuple
from zlib import crc32

import numpy as np
from typing_extensions import override

from dqpaint import dq
from dqpaint.disturbances import Disturbance, Encoder
from dqpaint.dq import Floats
from dqpaint.plants import UNDISTURBED, Plant
from dqpaint.robots.kinematics import Kinematics, ManyKinematics

Disturbances = Mapping[str, Disturbance]


class Measurement(NamedTuple):
    """What the law is told: encoder angles (n,) [rad], rates (n,) [rad/s], pose (8,), J (6, n)."""

    posture: Floats
    rates: Floats
    pose: Floats
    jacobian: Floats


class ModelsDifferError(ValueError):
    """Arms cannot go as one batch: the law's model of each is another."""


class Sensors:
    """Tells a law of the arm: by the encoders' readings and the model it believes in.

    Attributes:
        world: what the arm truly is under.
        believed: the law's model.
        honest: whether all that is told is true.
    """

    def __init__(
        self, kinematics: Kinematics, t: Floats, period: float, given: Disturbances, seed: int
    ) -> None:
        self.world, self.believed = UNDISTURBED, kinematics
        self._period = period
        self._encoders: list[Encoder] = []
        for name, one in given.items():
            one.check(t)
            self.world = one.world(self.world)
            self.believed = one.belief(self.believed, chance(seed, name))
            encoder = one.encoder(len(t), kinematics.card.joints, chance(seed, name))
            if encoder is not None:
                self._encoders.append(encoder)
        self._error = np.zeros(kinematics.card.joints)
        self.honest = not self._encoders and self.believed is kinematics
        self._model, self._true = self.believed, kinematics

    def tell(self, row: int, plant: Plant) -> Measurement:
        """What the law is told at a row.

        Speeds are differences of readings: their error is the change of the angles' error in a
        period.
        """
        angles, rates = self._read(row, plant)
        return Measurement(angles, rates, *self._model.pose_and_jacobian(angles))

    def _read(self, row: int, plant: Plant) -> tuple[Floats, Floats]:
        angles, rates = plant.encoder, plant.encoder_rates
        if self._encoders:
            read = angles
            for encoder in self._encoders:
                read = encoder.read(row, read)
            error = read - angles
            before, self._error = self._error if row else error, error
            angles, rates = read, rates + (error - before) / self._period
        return angles, rates

    def truth(self, plant: Plant, told: Measurement) -> tuple[Floats, Floats]:
        """The light's true pose (8,) and Jacobian (6, n), in the frame the law takes for base."""
        displaced = self.world.displaced
        if self.honest and not displaced and told.posture is plant.posture:
            return told.pose, told.jacobian
        x, J = self._truth(plant)
        if displaced:
            base = self.world.base
            x, J = dq.mul(base, x), dq.adjoint(base, J.mT).mT
        return x, J

    def _truth(self, plant: Plant) -> tuple[Floats, Floats]:
        return self._true.pose_and_jacobian(plant.posture)


class BatchedSensors(Sensors):
    """The same of many arms at once, which differ in their random numbers alone; arrays (B, ...).

    Raises:
        ModelsDifferError: their models differ, too.
    """

    def __init__(
        self,
        kinematics: Kinematics,
        t: Floats,
        period: float,
        given: Disturbances,
        seeds: Sequence[int],
    ) -> None:
        each = [Sensors(kinematics, t, period, given, seed) for seed in seeds]
        if any(one.believed is not kinematics for one in each):
            raise ModelsDifferError("the law's models of the arms differ")
        self.world, self._period = each[0].world, period
        self.believed = kinematics
        self._arms = ManyKinematics(kinematics)
        self._encoders = [
            Encoder(np.stack([one.errors for one in alike], axis=1), alike[0].step)
            for alike in zip(*(one._encoders for one in each), strict=True)
        ]
        self._error = np.zeros((len(each), kinematics.card.joints))
        self.honest = not self._encoders

    @override
    def tell(self, row: int, plant: Plant) -> Measurement:
        angles, rates = self._read(row, plant)
        if angles is plant.posture:
            self._found = self._arms.pose_and_jacobian(angles)
            return Measurement(angles, rates, *self._found)
        # what is read and what is true at once: that costs little more than one of them
        x, J = self._arms.pose_and_jacobian(np.concatenate([angles, plant.posture]))
        count = len(angles)
        self._found = x[count:], J[count:]
        return Measurement(angles, rates, x[:count], J[:count])

    @override
    def _truth(self, plant: Plant) -> tuple[Floats, Floats]:
        return self._found


class DelayLine:
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
