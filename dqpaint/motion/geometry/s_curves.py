"""Speed limits along strokes -> their fastest motion within an acceleration and a jerk.

Between two places where the acceleration is zero the fastest motion within a speed, an acceleration
and a jerk is an S-curve of up to seven phases of constant jerk (Biagiotti and Melchiorri,
Trajectory Planning for Automatic Machines and Robots, 2008, section 3.4): the acceleration goes up
with the jerk, stays, and comes down, the speed stays, and the same again to brake. A stroke without
bends is one of them. Where bends limit the speed, the acceleration is made zero at the ends of the
stretch that would be passed too fast by most, as often as it takes: a stroke is a chain of S-curves
then, within every limit, but not the very fastest.
"""

import math
from dataclasses import dataclass

import numpy as np

from dqpaint.dq import Floats
from dqpaint.motion.geometry.paths import Indices
from dqpaint.motion.look_ahead import Phases, Stretches

HALVINGS = 60  # of an interval that has the peak, or the time of a place
CLOSE = 1e-9  # relative: a limit is kept
SINH = 1e6  # where asinh would lose nothing, but its argument could overflow


def change_time(change: Floats, acceleration: Floats, jerk: Floats) -> Floats:
    """How long speeds take to change by `change` (K,) [m/s], from and to no acceleration [s]."""
    long = change * jerk >= acceleration**2
    return np.where(long, change / acceleration + acceleration / jerk, 2 * np.sqrt(change / jerk))


def reached(speed: float, way: float, acceleration: float, jerk: float) -> float:
    """The largest speed after a way [m], from a speed [m/s], both without acceleration [m/s]."""
    full = acceleration * acceleration / jerk
    if way >= (2 * speed + full) * acceleration / jerk:
        half = speed + 0.5 * full
        left = 2 * acceleration * (way - speed * acceleration / jerk)
        return speed + left / (half + math.sqrt(half * half + left))
    # u^3 + p u = q for the root u of the change
    p, q = 2 * speed, way * math.sqrt(jerk)
    if p * math.sqrt(p) * SINH <= q:
        u = math.cbrt(q)
        u -= (u**3 + p * u - q) / (3 * u * u + p) if u else 0.0
    else:
        u = 2 * math.sqrt(p / 3) * math.sinh(math.asinh(1.5 * q / p * math.sqrt(3 / p)) / 3)
    return speed + u * u


@dataclass(frozen=True, eq=False)
class _Chain:
    """S-curves (C) of strokes (P), each over one stretch or several in a row.

    Attributes:
        begin: the first stretch of each (C,).
        stroke: of each (C,).
        size: of each (C,) [m].
        speeds: at its start, at its peak, and at its end (3, C) [m/s].
        acceleration: (C,) [m/s^2].
        jerk: (C,) [m/s^3].
    """

    begin: Indices
    stroke: Indices
    size: Floats
    speeds: Floats
    acceleration: Floats
    jerk: Floats

    def phases(self) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        """Of each S-curve (C, 7): time, way, and place, speed, acceleration, jerk as it begins."""
        v0, peak, v1 = self.speeds
        a, j = self.acceleration, self.jerk
        ramps = []
        for change in (peak - v0, peak - v1):
            bend = np.minimum(np.sqrt(change / j), a / j)
            ramps.append((bend, np.maximum(change / a - a / j, 0.0)))
        (up, gain), (down, loss) = ramps
        none = np.zeros_like(peak)
        sides = 0.5 * (v0 + peak) * (2 * up + gain) + 0.5 * (v1 + peak) * (2 * down + loss)
        level = np.divide(
            *(np.maximum(self.size - sides, 0.0), peak), out=none.copy(), where=peak > 0
        )
        time = np.stack([up, gain, up, level, down, loss, down], axis=1)
        jerk = j[:, None] * np.array([1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0])
        bend = np.stack([none, j * up, j * up, none, none, -j * down, -j * down], axis=1)
        speed = np.stack(
            [
                *(v0, v0 + 0.5 * j * up**2, peak - 0.5 * j * up**2, peak),
                *(peak, peak - 0.5 * j * down**2, v1 + 0.5 * j * down**2),
            ],
            axis=1,
        )
        way = time * (speed + time * (0.5 * bend + time * jerk / 6))
        place = np.cumsum(way, axis=1) - way
        return time, way, place, speed, bend, jerk


def s_curves(stretches: Stretches, jerk: Floats, speed: Floats) -> Phases:
    """The motion of strokes at no more than the cruise speeds (P,) [m/s] and jerks (P,) [m/s^3]."""
    chain = _chained(stretches, jerk, speed)
    time, way, place, velocity, bend, jerks = chain.phases()
    real = time > 0.0  # the other phases are left out
    begins = np.searchsorted(chain.stroke, np.arange(len(stretches.first)))
    count = np.add.reduceat(real.sum(axis=1), begins)
    first = np.cumsum(count) - count
    size = way.sum(axis=1)
    before = np.cumsum(size) - size
    before -= before[begins][chain.stroke]
    times = time[real]
    since = np.cumsum(times) - times
    return Phases(
        first,
        first + count - 1,
        since - np.repeat(since[first], count),
        (before[:, None] + place)[real],
        velocity[real],
        bend[real],
        np.add.reduceat(times, first),
        stretches.lengths,
        jerks[real],
    )


def _chained(stretches: Stretches, jerk: Floats, speed: Floats) -> _Chain:
    """The S-curves of strokes, chained where one would be too fast for a stretch within."""
    stroke = stretches.stroke
    most = np.minimum(stretches.most, (speed**2)[stroke])
    gate = np.minimum(stretches.gate, most)
    gate[1:] = np.minimum(gate[1:], most[:-1])
    gate[stretches.first] = 0.0
    chosen = stretches.gate < most
    chosen[stretches.first] = True
    while True:
        chain = _through(stretches, jerk, most, gate, np.flatnonzero(chosen))
        worst = _too_fast(stretches, most, chain)
        new = np.concatenate([worst, worst + 1])
        new = new[new < len(chosen)]
        new = new[~chosen[new]]
        if not len(new):
            return chain
        chosen[new] = True


def _through(
    stretches: Stretches, jerk: Floats, most: Floats, gate: Floats, begin: Indices
) -> _Chain:
    """The S-curves that begin with some of the stretches, as fast as all of them can be."""
    stroke = stretches.stroke[begin]
    size = np.add.reduceat(stretches.size, begin)
    gain = np.minimum.reduceat(stretches.acceleration, begin)
    j, top = jerk[stroke], np.sqrt(np.maximum.reduceat(most, begin))
    at_start = np.sqrt(gate[begin])
    last = np.append(stroke[1:] != stroke[:-1], True)
    v = at_start.tolist()
    ways, gains, jerks, ends = size.tolist(), gain.tolist(), j.tolist(), last.tolist()
    for k in range(len(v) - 1):
        if not ends[k]:
            v[k + 1] = min(v[k + 1], reached(v[k], ways[k], gains[k], jerks[k]))
    for k in range(len(v) - 1, -1, -1):
        after = 0.0 if ends[k] else v[k + 1]
        v[k] = min(v[k], reached(after, ways[k], gains[k], jerks[k]))
    v0 = np.array(v)
    v1 = np.where(last, 0.0, np.append(v0[1:], 0.0))
    low = np.maximum(v0, v1)
    high = np.maximum(low, top)
    for _ in range(HALVINGS):
        peak = 0.5 * (low + high)
        way = sum(
            0.5 * (v + peak) * change_time(np.maximum(peak - v, 0.0), gain, j) for v in (v0, v1)
        )
        long = way > size
        low, high = np.where(long, low, peak), np.where(long, peak, high)
    return _Chain(begin, stroke, size, np.stack([v0, low, v1]), gain, j)


def _too_fast(stretches: Stretches, most: Floats, chain: _Chain) -> Indices:
    """The stretch of each S-curve that is passed too fast by most; of those that have one."""
    count = np.diff(chain.begin, append=len(most))
    several = np.flatnonzero(count > 1)
    if not len(several):
        return several
    time, _, place, speed, bend, jerk = (part[several] for part in chain.phases())
    begin, size = chain.begin[several], count[several]
    starts = np.cumsum(size) - size
    curve = np.repeat(np.arange(len(several)), size)
    own = np.arange(size.sum()) - np.repeat(starts - begin, size)
    way = np.cumsum(stretches.size[own])
    end = way - np.repeat((way - stretches.size[own])[starts], size)
    here = end - stretches.size[own]

    def speeds(at: Floats) -> Floats:
        phase = (at[:, None] >= place[curve, 1:]).sum(axis=1)
        rows = (curve, phase)
        low, high = np.zeros(len(at)), time[rows]
        for _ in range(HALVINGS):
            t = 0.5 * (low + high)
            far = place[rows] + t * (speed[rows] + t * (0.5 * bend[rows] + t * jerk[rows] / 6)) > at
            low, high = np.where(far, low, t), np.where(far, t, high)
        return np.asarray(speed[rows] + high * (bend[rows] + 0.5 * high * jerk[rows]))

    fastest = np.maximum(speeds(here), speeds(end))
    rises, falls = place[curve, 3], place[curve, 4]
    fastest = np.where((here <= falls) & (end >= rises), chain.speeds[1, several][curve], fastest)
    excess = fastest**2 / most[own]
    largest = np.maximum.reduceat(excess, starts)
    at = np.flatnonzero((excess == largest[curve]) & (excess > 1 + CLOSE))
    _, once = np.unique(curve[at], return_index=True)
    return np.asarray(own[at[once]])
