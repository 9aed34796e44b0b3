"""Commands, each for a period -> the reference of a servo: delayed, and slewed or smoothed."""

from collections import deque
from typing import Protocol

import numpy as np

from dqpaint.dq import Floats

PEAK = 1.875  # of a minimum-jerk motion's speed, by its mean


class CommandFilter(Protocol):
    """What smooths a target on its way to the loops."""

    angle: Floats

    def begin(self, target: Floats) -> None:
        """A new command has arrived, for a target (n,) [rad]."""

    def advance(self, step: float, target: Floats) -> Floats:
        """Follow a target (n,) [rad] for a step [s]; returns the reference in its middle."""


class Slew:
    """A reference that goes to its target no faster than it may (the slew filter of Meka's THETA).

    Attributes:
        angle: the reference (n,) [rad].
    """

    def __init__(self, angle: Floats, speed: Floats) -> None:
        self.angle, self._speed = angle.copy(), speed

    def begin(self, target: Floats) -> None:
        """Nothing to prepare."""

    def advance(self, step: float, target: Floats) -> Floats:
        """Follow a target (n,) [rad] for a step [s]; returns the reference in its middle."""
        most, way, before = step * self._speed, target - self.angle, self.angle
        self.angle = before + np.minimum(np.maximum(way, -most), most)
        return np.asarray(before + np.minimum(np.maximum(way, -0.5 * most), 0.5 * most))


class MinimumJerk:
    """A reference on the quintic of least jerk to its target (Meka's THETA_MJ).

    A motion's duration makes its speed at most `speed`: 1.875 times the mean. Each new command
    begins a new motion, from the position, rate and acceleration that are reached.

    Attributes:
        angle: the reference (n,) [rad].
    """

    def __init__(self, angle: Floats, speed: Floats, period: float) -> None:
        self.angle, self._speed, self._period = angle.copy(), speed, period
        self._rate, self._acceleration = np.zeros_like(angle), np.zeros_like(angle)
        self._left = np.full_like(angle, period)  # [s]

    def begin(self, target: Floats) -> None:
        """Set out for a new target (n,) [rad]."""
        needed = PEAK * np.abs(target - self.angle) / self._speed
        self._left = np.maximum(needed, self._period)

    def advance(self, step: float, target: Floats) -> Floats:
        """Go on for a step [s]; returns the reference in its middle.

        The quintic from where it is leads on along itself.
        """
        before = self.angle
        v, a, D = self._rate, self._acceleration, np.maximum(self._left, step)
        h = target - self.angle
        vD, aD = v * D, a * D**2
        c3 = (20 * h - 12 * vD - 3 * aD) / (2 * D**3)
        c4 = (-30 * h + 16 * vD + 3 * aD) / (2 * D**4)
        c5 = (12 * h - 6 * vD - aD) / (2 * D**5)
        t = step
        self.angle = self.angle + t * (v + t * (a / 2 + t * (c3 + t * (c4 + t * c5))))
        self._rate = v + t * (a + t * (3 * c3 + t * (4 * c4 + t * 5 * c5)))
        self._acceleration = a + t * (6 * c3 + t * (12 * c4 + t * 20 * c5))
        self._left = D - step
        return 0.5 * (before + self.angle)


class DelayLine:
    """Values that take effect some time after they were given, exactly, whatever the steps are.

    Args:
        first: the value (n,) in effect until the first one arrives.
        delay: [s].
    """

    def __init__(self, first: Floats, delay: float) -> None:
        self._now, self._delay, self._time = first, delay, 0.0
        self._due: deque[tuple[float, Floats]] = deque()

    def give(self, value: Floats) -> None:
        """Send a value (n,)."""
        self._due.append((self._time + self._delay, value))

    def advance(self, step: float) -> tuple[Floats, bool]:
        """The mean (n,) of what is in effect over a step [s], and whether a value has arrived."""
        begin, end = self._time, self._time + step
        arrived, total, last = False, 0.0 * self._now, begin
        while self._due and self._due[0][0] < end:
            due, value = self._due.popleft()
            total = total + (max(due, begin) - last) * self._now
            last, self._now, arrived = max(due, begin), value, True
        self._time = end
        if not arrived:
            return self._now, False
        return (total + (end - last) * self._now) / step, True
