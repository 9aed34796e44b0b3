"""Speed limits along strokes -> their fastest motion within an acceleration, in closed form.

The square x of the speed changes along a path with x' = 2 a at an acceleration a. So the largest x
within every limit X and |a| <= A is, at each place, the least of X + 2 A d over all places at a
distance d: one pass forwards and one backwards (as planners of machine tools do). From one node to
the next the point gains speed at A, keeps it, and brakes at A: three phases of constant
acceleration, so that position, speed and acceleration are known in closed form at any time.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats
from dqpaint.motion.profiles import Progress

HALVINGS = 50
SOON = 1e-9  # [s]: a phase that begins within it has begun, whatever rounding says
FASTEST = 8.0  # times the mean speed: the most that is tried to keep a duration

Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Stretches:
    """Consecutive stretches (K) of strokes (P), each with one limit of the speed.

    Attributes:
        first: of each stroke (P,).
        size: of each stretch (K,) [m].
        most: the square of the speed that each allows (K,) [m^2/s^2], above 0.
        gate: and the place where it begins (K,); 0 where the point has to stop.
        acceleration: along each (K,) [m/s^2], above 0.
    """

    first: Indices
    size: Floats
    most: Floats
    gate: Floats
    acceleration: Floats

    @property
    def stroke(self) -> Indices:
        """The stroke of each stretch (K,)."""
        return np.repeat(np.arange(len(self.first)), np.diff(self.first, append=len(self.size)))

    @property
    def lengths(self) -> Floats:
        """The length of each stroke (P,) [m]."""
        return np.asarray(np.add.reduceat(self.size, self.first))

    def select(self, strokes: Indices) -> Self:
        """Some of the strokes, in order."""
        ends = np.append(self.first[1:], len(self.size))
        count = (ends - self.first)[strokes]
        begins = np.cumsum(count) - count
        rows = np.arange(count.sum()) - np.repeat(begins - self.first[strokes], count)
        values = (self.size, self.most, self.gate, self.acceleration)
        return type(self)(begins, *(value[rows] for value in values))


@dataclass(frozen=True, eq=False)
class Phases:
    """Phases (Q) of constant acceleration of strokes (P), each from rest to rest.

    Attributes:
        first: of each stroke (P,).
        last: of each stroke (P,).
        time: at which each begins, since its stroke began (Q,) [s].
        place: where, since its stroke began (Q,) [m].
        speed: at that time (Q,) [m/s].
        acceleration: (Q,) [m/s^2].
        seconds: of each stroke (P,).
        lengths: of each stroke (P,) [m].
    """

    first: Indices
    last: Indices
    time: Floats
    place: Floats
    speed: Floats
    acceleration: Floats
    seconds: Floats
    lengths: Floats

    @property
    def peaks(self) -> Floats:
        """The largest speed of each stroke (P,) [m/s]: a phase that is faster later has a next."""
        return np.asarray(np.maximum.reduceat(self.speed, self.first))

    def progress(self, stroke: Indices, tau: Floats) -> Progress:
        """The fraction of the length of strokes (N,) at fractions of their time, per second."""
        t = tau * self.seconds[stroke]
        began = np.cumsum(self.seconds) - self.seconds
        every = np.repeat(began, self.last - self.first + 1) + self.time
        near = np.searchsorted(every, began[stroke] + t + SOON, side="right") - 1
        phase = np.clip(near, self.first[stroke], self.last[stroke])
        since, length = t - self.time[phase], self.lengths[stroke]
        speed, bend = self.speed[phase], self.acceleration[phase]
        place = self.place[phase] + since * (speed + 0.5 * bend * since)
        value = np.where(tau >= 1.0, 1.0, np.clip(place / length, 0.0, 1.0))
        return Progress(value, np.maximum(speed + bend * since, 0.0) / length, bend / length)


def fastest(stretches: Stretches, speed: Floats) -> Phases:
    """The fastest motion at no more than the cruise speeds (P,) [m/s]."""
    stroke = stretches.stroke
    most = np.minimum(stretches.most, speed[stroke] ** 2)
    gain, size = 2.0 * stretches.acceleration, stretches.size
    at_node = np.append(np.minimum(stretches.gate, most), 0.0)
    at_node[1:-1] = np.minimum(at_node[1:-1], most[:-1])
    at_node[stretches.first] = 0.0
    climb = np.concatenate([[0.0], np.cumsum(gain * size)])
    forth = climb + np.minimum.accumulate(at_node - climb)
    back = np.minimum.accumulate((at_node + climb)[::-1])[::-1] - climb
    x = np.where(at_node > 0.0, np.clip(np.minimum(forth, back), 0.0, at_node), 0.0)
    begin, end = x[:-1], x[1:]
    top = np.minimum(most, 0.5 * (begin + end + gain * size))
    top = np.maximum(top, np.maximum(begin, end))
    v, w, peak = np.sqrt(begin), np.sqrt(end), np.sqrt(top)
    up, down = (top - begin) / gain, (top - end) / gain
    level = np.maximum(size - up - down, 0.0)
    zero = np.zeros_like(size)
    ways = np.stack([up, level, down], axis=1).ravel()
    times = np.stack(
        [(peak - v) / stretches.acceleration, level / peak, (peak - w) / stretches.acceleration],
        axis=1,
    ).ravel()
    speeds = np.stack([v, peak, peak], axis=1).ravel()
    bends = np.stack([stretches.acceleration, zero, -stretches.acceleration], axis=1).ravel()
    return _phases(3 * stretches.first, ways, times, speeds, bends, stretches.lengths)


def _phases(
    first: Indices, ways: Floats, times: Floats, speeds: Floats, bends: Floats, lengths: Floats
) -> Phases:
    """Phases from their ways [m] and times [s] (Q,); those that take no time are left out."""
    stroke = np.repeat(np.arange(len(first)), np.diff(first, append=len(times)))
    seconds = np.add.reduceat(times, first)
    time, place = (_since_start(values, first, stroke) for values in (times, ways))
    real = times > 0.0
    count = np.add.reduceat(real.astype(np.intp), first)
    begins = np.cumsum(count) - count
    return Phases(
        *(begins, begins + count - 1, time[real], place[real], speeds[real], bends[real]),
        *(seconds, lengths),
    )


def _since_start(values: Floats, first: Indices, stroke: Indices) -> Floats:
    """The sums of values (Q,) before each, since the start of its stroke."""
    before = np.cumsum(values) - values
    return np.asarray(before - before[first][stroke])


def speeds_for(stretches: Stretches, seconds: Floats) -> Floats:
    """The cruise speeds (P,) [m/s] with which strokes take these times (P,) [s], or longer.

    Longer where the acceleration allows no less.
    """
    mean = np.log(stretches.lengths / seconds)
    low, high = mean, mean + np.log(FASTEST)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        slow = fastest(stretches, np.exp(middle)).seconds > seconds
        low, high = np.where(slow, middle, low), np.where(slow, high, middle)
    return np.asarray(np.exp(high))
