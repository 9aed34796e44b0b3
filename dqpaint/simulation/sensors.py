"""The true state of a plant -> its measurement, and the light's true pose."""

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
    """Encoder angles (n,) [rad], rates (n,) [rad/s], pose (8,), J (6, n).

    Pose and Jacobian are those of the law's model at the measured angles.
    """

    posture: Floats
    rates: Floats
    pose: Floats
    jacobian: Floats


class ModelsDifferError(ValueError):
    """Arms cannot go as one batch: the law's model of each is another."""


class Sensors:
    """Encoders, and the law's model of the arm.

    Attributes:
        world: the disturbances of the arm itself.
        model: the law's.
        exact: whether every measurement is true.
        offset: displacements (N, 8) of the tool on the flange; None where it has none.
    """

    def __init__(
        self,
        kinematics: Kinematics,
        t: Floats,
        period: float,
        disturbances: Disturbances,
        seed: int,
    ) -> None:
        self.world = UNDISTURBED
        self.model = law_model(kinematics, disturbances, seed)
        self._period = period
        self._encoders: list[Encoder] = []
        for name, one in disturbances.items():
            one.check(t)
            self.world = one.world(self.world)
            encoder = one.encoder(len(t), kinematics.card.joints, random_numbers(seed, name))
            if encoder is not None:
                self._encoders.append(encoder)
        self._error = np.zeros(kinematics.card.joints)
        self.offset, self._measured_offset = _offsets(t, period, disturbances, seed)
        hidden = self.offset is not None and self._measured_offset is not self.offset
        self.exact = not self._encoders and self.model is kinematics and not hidden
        self._true = kinematics

    def measure(self, row: int, plant: Plant) -> Measurement:
        """The measurement at a row.

        Rates are differences of readings: their error is the change of the angles' error in a
        period.
        """
        angles, rates = self._read(row, plant)
        x, J = self.model.pose_and_jacobian(angles)
        return Measurement(angles, rates, _displaced(x, self._measured_offset, row), J)

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

    def truth(self, row: int, plant: Plant, measured: Measurement) -> tuple[Floats, Floats]:
        """The light's true pose (8,) and Jacobian (6, n) at a row, in the law's own base frame."""
        displaced = self.world.is_displaced
        if self.exact and not displaced and measured.posture is plant.posture:
            return measured.pose, measured.jacobian
        x, J = self._truth(plant)
        x = _displaced(x, self.offset, row)
        if displaced:
            base = self.world.base
            x, J = dq.mul(base, x), dq.adjoint(base, J.mT).mT
        return x, J

    def _truth(self, plant: Plant) -> tuple[Floats, Floats]:
        return self._true.pose_and_jacobian(plant.posture)


class BatchedSensors(Sensors):
    """The same for many arms at once that differ only in their random numbers; arrays (B, ...).

    Raises:
        ModelsDifferError: their models differ, too.
    """

    def __init__(
        self,
        kinematics: Kinematics,
        t: Floats,
        period: float,
        disturbances: Disturbances,
        seeds: Sequence[int],
    ) -> None:
        each = [Sensors(kinematics, t, period, disturbances, seed) for seed in seeds]
        if any(one.model is not kinematics for one in each):
            raise ModelsDifferError("the law's models of the arms differ")
        self.world, self._period = each[0].world, period
        self.model = kinematics
        self._arms = ManyKinematics(kinematics)
        self._encoders = [
            Encoder(np.stack([one.errors for one in alike], axis=1), alike[0].step)
            for alike in zip(*(one._encoders for one in each), strict=True)
        ]
        self._error = np.zeros((len(each), kinematics.card.joints))
        self.exact = not self._encoders and each[0].exact
        self.offset = _stacked([one.offset for one in each])
        self._measured_offset = _stacked([one._measured_offset for one in each])

    @override
    def measure(self, row: int, plant: Plant) -> Measurement:
        angles, rates = self._read(row, plant)
        if angles is plant.posture:
            x, J = self._found = self._arms.pose_and_jacobian(angles)
            return Measurement(angles, rates, _displaced(x, self._measured_offset, row), J)
        # measured and true angles in one call cost little more than one of them
        x, J = self._arms.pose_and_jacobian(np.concatenate([angles, plant.posture]))
        count = len(angles)
        self._found = x[count:], J[count:]
        seen = _displaced(x[:count], self._measured_offset, row)
        return Measurement(angles, rates, seen, J[:count])

    @override
    def _truth(self, plant: Plant) -> tuple[Floats, Floats]:
        return self._found


def _offsets(
    t: Floats, period: float, disturbances: Disturbances, seed: int
) -> tuple[Floats | None, Floats | None]:
    """Displacements (N, 8) of the tool, all of them and those that the law measures, or None."""
    every: Floats | None = None
    measured: Floats | None = None
    for name, one in disturbances.items():
        c = one.displacement(t, period, random_numbers(seed, name))
        if c is None:
            continue
        every = c if every is None else dq.mul(every, c)
        if one.is_measured:
            measured = c if measured is None else dq.mul(measured, c)
    all_measured = all(
        one.is_measured or type(one).displacement is Disturbance.displacement
        for one in disturbances.values()
    )
    return every, every if all_measured else measured


def _displaced(pose: Floats, offset: Floats | None, row: int) -> Floats:
    """Poses with the tool displaced as at a row."""
    return pose if offset is None else dq.mul(pose, offset[row])


def _stacked(each: Sequence[Floats | None]) -> Floats | None:
    """Arrays (N, 8) of several runs as (N, B, 8); all have one, or none."""
    there = [one for one in each if one is not None]
    return np.stack(there, axis=1) if there else None


class DelayLine:
    """Delays commands by some periods; until the first one arrives the arm is held still."""

    def __init__(self, delay: int, hold: Floats) -> None:
        self._waiting = deque([hold] * delay)

    def __call__(self, command: Floats) -> Floats:
        """The command that arrives now."""
        self._waiting.append(command)
        return self._waiting.popleft()


def law_model(kinematics: Kinematics, disturbances: Disturbances, seed: int) -> Kinematics:
    """The law's model of an arm."""
    for name, one in disturbances.items():
        kinematics = one.law_model(kinematics, random_numbers(seed, name))
    return kinematics


def random_numbers(seed: int, name: str) -> "np.random.Generator":
    """The random numbers of one disturbance: the same whatever other disturbances there are."""
    return np.random.default_rng([seed, crc32(name.encode())])


def total_delay(disturbances: Disturbances) -> int:
    """How many periods late commands arrive."""
    return sum(one.delay for one in disturbances.values())
