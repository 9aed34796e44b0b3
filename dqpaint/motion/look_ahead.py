"""Speed limits along strokes -> their fastest motion within an acceleration, in closed form.

The square x of the speed changes along a path with x' = 2 a at an acceleration a. So the largest x
within every limit X and |a| <= A is, at each place, the least of X + 2 A d over all places at a
distance d: one pass forwards and one backwards (as planners of machine tools do). From one node to
the next the point gains speed at A, keeps it, and brakes at A: three phases of constant
acceleration, so that position, speed and acceleration are known in closed form at any time.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Self

import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats
from dqpaint.motion.profiles import Progress

MOST_TRIES = 60
SAME_SPEED = 1e-13  # relative
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
    """Phases (Q) of constant jerk of strokes (P), each from rest to rest.

    Attributes:
        first: of each stroke (P,).
        last: of each stroke (P,).
        time: at which each begins, since its stroke began (Q,) [s].
        place: where, since its stroke began (Q,) [m].
        speed: at that time (Q,) [m/s].
        acceleration: and the acceleration (Q,) [m/s^2].
        seconds: of each stroke (P,).
        lengths: of each stroke (P,) [m].
        jerk: throughout (Q,) [m/s^3].
    """

    first: Indices
    last: Indices
    time: Floats
    place: Floats
    speed: Floats
    acceleration: Floats
    seconds: Floats
    lengths: Floats
    jerk: Floats

    def followed_by(self, other: "Phases") -> "Phases":
        """These strokes, then others."""
        shift = {"first": len(self.time), "last": len(self.time)}
        return Phases(*(
            np.concatenate([getattr(self, f.name), getattr(other, f.name) + shift.get(f.name, 0)])
            for f in fields(self)
        ))  # fmt: skip

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
        speed, bend, jerk = self.speed[phase], self.acceleration[phase], self.jerk[phase]
        place = self.place[phase] + since * (speed + since * (0.5 * bend + since * jerk / 6))
        value = np.where(tau >= 1.0, 1.0, np.clip(place / length, 0.0, 1.0))
        rate = speed + since * (bend + 0.5 * since * jerk)
        return Progress(value, np.maximum(rate, 0.0) / length, (bend + jerk * since) / length)


@dataclass(frozen=True, eq=False)
class _Run:
    """The fastest motion over stretches (K): squares of speeds, of which each has three phases."""

    stretches: Stretches
    begin: Floats
    end: Floats
    top: Floats

    @property
    def times(self) -> tuple[Floats, Floats, Floats]:
        """How long it gains speed, keeps it, and brakes, on each stretch (K,) [s]."""
        peak, gain = np.sqrt(self.top), self.stretches.acceleration
        level = self.ways[1] / peak
        return (peak - np.sqrt(self.begin)) / gain, level, (peak - np.sqrt(self.end)) / gain

    @property
    def ways(self) -> tuple[Floats, Floats, Floats]:
        """How far meanwhile (K,) [m]."""
        gain = 2.0 * self.stretches.acceleration
        up, down = (self.top - self.begin) / gain, (self.top - self.end) / gain
        return up, np.maximum(self.stretches.size - up - down, 0.0), down

    @property
    def seconds(self) -> Floats:
        """The time of each stroke (P,)."""
        return np.asarray(np.add.reduceat(sum(self.times), self.stretches.first))


def _run(stretches: Stretches, speed: Floats) -> _Run:
    """The fastest motion at no more than the cruise speeds (P,) [m/s]."""
    most = np.minimum(stretches.most, (speed**2)[stretches.stroke])
    rise = 2.0 * stretches.acceleration * stretches.size
    at_node = np.append(np.minimum(stretches.gate, most), 0.0)
    at_node[1:-1] = np.minimum(at_node[1:-1], most[:-1])
    at_node[stretches.first] = 0.0
    climb = np.concatenate([[0.0], np.cumsum(rise)])
    forth = climb + np.minimum.accumulate(at_node - climb)
    back = np.minimum.accumulate((at_node + climb)[::-1])[::-1] - climb
    x = np.where(at_node > 0.0, np.clip(np.minimum(forth, back), 0.0, at_node), 0.0)
    begin, end = x[:-1], x[1:]
    top = np.minimum(most, 0.5 * (begin + end + rise))
    return _Run(stretches, begin, end, np.maximum(top, np.maximum(begin, end)))


def fastest(stretches: Stretches, speed: Floats) -> Phases:
    """The fastest motion at no more than the cruise speeds (P,) [m/s]."""
    run = _run(stretches, speed)
    peak, gain = np.sqrt(run.top), stretches.acceleration
    real = np.stack(run.times, axis=1) > 0.0  # the other phases are left out
    count = np.add.reduceat(real.sum(axis=1), stretches.first)
    first = np.cumsum(count) - count
    time, way = (np.stack(getattr(run, name), axis=1)[real] for name in ("times", "ways"))
    return Phases(
        first,
        first + count - 1,
        _since_start(time, first, count),
        _since_start(way, first, count),
        np.stack([np.sqrt(run.begin), peak, peak], axis=1)[real],
        np.stack([gain, np.zeros_like(gain), -gain], axis=1)[real],
        np.add.reduceat(time, first),
        stretches.lengths,
        np.zeros(len(time)),
    )


def _since_start(values: Floats, first: Indices, count: Indices) -> Floats:
    """The sums of values (Q,) before each, since the start of its stroke."""
    before = np.cumsum(values) - values
    return np.asarray(before - np.repeat(before[first], count))


def speeds_for(
    stretches: Stretches, seconds: Floats, time_at: Callable[[Floats], Floats] | None = None
) -> Floats:
    """The cruise speeds (P,) [m/s] with which strokes take these times (P,) [s], or longer.

    Longer where the acceleration allows no less.

    Args:
        stretches: of the strokes.
        seconds: that they are to take (P,).
        time_at: what they take (P,) [s] at cruise speeds (P,); None: by `fastest`.
    """

    def lateness(log_speed: Floats) -> Floats:
        speed = np.exp(log_speed)
        taken = time_at(speed) if time_at else _run(stretches, speed).seconds
        return np.asarray(np.log(taken / seconds))

    low = np.log(stretches.lengths / seconds)
    high = low + np.log(FASTEST)
    slow, quick = (lateness(speed) for speed in (low, high))
    for _ in range(MOST_TRIES):
        wide = (quick < 0.0) & (slow > 0.0) & (high - low > SAME_SPEED)
        if not wide.any():
            break
        middle = np.where(wide, low + (high - low) * slow / np.where(wide, slow - quick, 1.0), high)
        late = lateness(middle)
        # the false position, with the value of an end halved that stays (Illinois)
        low, high, slow, quick = np.where(
            late > 0.0, (middle, high, late, 0.5 * quick), (low, middle, 0.5 * slow, late)
        )
    return np.asarray(np.exp(high))
