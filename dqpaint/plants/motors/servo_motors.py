"""Joint-rate commands and a link's motion -> the torques of servo motors on its joints."""

import math
from collections.abc import Callable

import numpy as np

from dqpaint.dq import Floats
from dqpaint.plants.motors.commands import CommandFilter, DelayLine
from dqpaint.plants.motors.gears import GearedMotors, Gears
from dqpaint.plants.motors.loops import Loop, State

RESOLVED = 0.25  # of the quickest loop's time constant is a step


class ServoMotors:
    """Motors, gears and loops of an arm, at rest in a posture and in balance.

    Args:
        gears: of its joints.
        loop: that drives them.
        make_filter: makes the filter of commands from the first reference (n,) [rad].
        joint: angles (n,) [rad] at rest.
        torque: that the joints need there (n,) [Nm].
        bounds: lowest and highest reference (2, n) [rad].
        delay: of commands [s].
        current: bandwidth of the current loops [rad/s]; they follow the asked torque with a lag.

    Attributes:
        gear: rotors and what passes through the gears.
        motor_torque: (n,) [Nm] at the end of the last step.
        largest: the largest motor torques (n,) [Nm] since `command`, with their signs.
    """

    def __init__(
        self,
        gears: Gears,
        loop: Loop,
        make_filter: Callable[[Floats], CommandFilter],
        joint: Floats,
        torque: Floats,
        bounds: Floats,
        delay: float,
        current: float,
    ) -> None:
        self.gear = GearedMotors(gears, joint, torque)
        self.loop, self._bounds, self._current = loop, bounds, current
        self.motor_torque = torque.copy()
        self.largest = torque.copy()
        self._target = loop.reference_for(joint, self.gear.angle, torque)
        self._filter = make_filter(self._target)
        self._rates = DelayLine(np.zeros_like(joint), delay)
        self._targets: DelayLine | None = None
        self._delay = delay

    def command(self, rates: Floats) -> None:
        """Move the target on at rates (n,) [rad/s], from now and until the next command."""
        self._rates.give(rates)
        self.largest = self.motor_torque

    def command_angle(self, target: Floats) -> None:
        """Set a target (n,) [rad], from now and until the next command."""
        if self._targets is None:
            self._targets = DelayLine(self._target, self._delay)
        self._targets.give(target)
        self.largest = self.motor_torque

    def displace(self, angles: Floats) -> None:
        """Carry motors and references along by angles (n,) [rad]."""
        self.gear.angle = self.gear.angle + angles
        self._target = self._target + angles
        self._filter.angle = self._filter.angle + angles

    def parts(self, step: float) -> int:
        """How many parts of a step [s] resolve the loops."""
        return max(1, math.ceil(step * self.loop.rate / RESOLVED - 1e-9))

    def step(self, step: float, joint: Floats, joint_rate: Floats) -> Floats:
        """Make a step.

        Args:
            step: its length [s].
            joint: angles (n,) [rad] in its middle.
            joint_rate: rates (n,) [rad/s] there.

        Returns:
            The mean torque on the joints (n,) [Nm].
        """
        parts = self.parts(step)
        if parts == 1:
            return self._part(step, joint, joint_rate)
        part = step / parts
        torques = [
            self._part(part, joint + ((i + 0.5) * part - 0.5 * step) * joint_rate, joint_rate)
            for i in range(parts)
        ]
        return np.asarray(sum(torques) / parts)

    def _part(self, step: float, joint: Floats, joint_rate: Floats) -> Floats:
        self._advance_target(step)
        before = self._filter.angle
        reference = self._filter.advance(step, self._target)
        if self._targets is None:  # the target moves on, and does not jump
            reference = 0.5 * (before + self._filter.angle)
        reference_rate = (self._filter.angle - before) / step
        middle = self.gear.middle(step)
        carried = self.gear.carry(middle, joint, joint_rate)
        seen = State(reference, reference_rate, *middle, joint, joint_rate, carried)
        asked = self.loop.torque(step, seen)
        lag = step * self._current
        kept = math.exp(-lag)
        short = self.motor_torque - asked
        mean = asked + (1.0 - kept) / lag * short
        self.motor_torque = asked + kept * short
        self.largest = np.where(np.abs(mean) > np.abs(self.largest), mean, self.largest)
        self.gear.move(step, middle, mean)
        return carried

    def _advance_target(self, step: float) -> None:
        if self._targets is not None:
            self._target, arrived = self._targets.advance(step)
        else:
            rates, arrived = self._rates.advance(step)
            self._target = self._target + step * rates
        low, high = self._bounds
        self._target = np.minimum(np.maximum(self._target, low), high)
        if arrived:
            self._filter.begin(self._target)
