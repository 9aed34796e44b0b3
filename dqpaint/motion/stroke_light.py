"""Schedule -> light of each row: gradients along strokes, and light of even brightness."""

from dataclasses import dataclass

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.motion.geometry.batched_shapes import Flags
from dqpaint.motion.geometry.paths import Indices
from dqpaint.motion.profiles import Rates, rate_at, turns_back
from dqpaint.motion.sampling import Rows
from dqpaint.motion.schedule import Schedule, interval_of
from dqpaint.program import STANDING, Light

NEAR_END = 0.01  # of the length: where the brightness of a stroke's ends is evaluated
DARK = Light((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@dataclass(frozen=True, eq=False)
class StrokeLight:
    """The light of each segment (M) of a drawing.

    Attributes:
        first: linear RGB at the first point (M, 3).
        last: and at the last (M, 3).
        bent: those with more colours on the way: shares of their length (K,), colours (K, 3).
        even: whether it is dimmed where the tool is slow (M,).
        extent: the length of each stroke (S,) over which even light is even; 0 at a pause. For a
            rotation in place it is 0 with a single lamp, else 1 (its whole angle).
        peak: its largest speed by its profile, in the duration before rounding (S,).
    """

    table: Schedule
    first: Floats
    last: Floats
    bent: dict[int, tuple[Floats, Floats]]
    even: Flags
    extent: Floats
    peak: Floats

    def along(self, rows: Rows) -> Floats:
        """Mean linear RGB (K, 3) from each row to the next, without each stroke's last row."""
        table = self.table
        at = np.flatnonzero(~rows.last)
        stroke = rows.stroke[at]
        # a profile may run beyond the ends of a stroke; its colours do not
        inside = np.clip(rows.fraction, 0.0, 1.0)
        middle = 0.5 * (inside[at + 1] + inside[at])
        part, share = table.inside(stroke, middle)
        light = self._at(part, share)
        for run in np.unique(stroke[table.size[stroke] > 1]).tolist():
            own = slice(*np.searchsorted(rows.stroke, (run, run + 1)))
            steps = slice(*np.searchsorted(stroke, (run, run + 1)))
            self._over_joints(run, inside[own], light[steps])
        if self.even[part].any():
            dimmed = np.where(self.even[part], self._share_of_peak(rows, at), 1.0)
            light *= dimmed[:, None]
        return light

    def _at(self, part: Indices, share: Floats) -> Floats:
        """The colours (K, 3) of segments at shares of their lengths."""
        s = share[:, None]
        light = (1 - s) * self.first[part] + s * self.last[part]
        for number in self.bent.keys() & set(part.tolist()):
            own = np.flatnonzero(part == number)
            at, colours = self.bent[number]
            for channel in range(3):
                light[own, channel] = np.interp(share[own], at, colours[:, channel])
        return np.asarray(light)

    def _up_to(self, part: Indices, share: Floats) -> Floats:
        """The integral (K, 3) of the colours of segments over their shares, from 0 on."""
        s = share[:, None]
        total = s * self.first[part] + 0.5 * s**2 * (self.last - self.first)[part]
        for number in self.bent.keys() & set(part.tolist()):
            own = np.flatnonzero(part == number)
            at, colours = self.bent[number]
            legs = np.diff(at)[:, None] * 0.5 * (colours[1:] + colours[:-1])
            before = np.concatenate([np.zeros((1, 3)), np.cumsum(legs, axis=0)])
            leg = interval_of(at, share[own])
            into = (share[own] - at[leg])[:, None]
            slope = np.diff(colours, axis=0) / np.diff(at)[:, None]
            total[own] = before[leg] + into * colours[leg] + 0.5 * into**2 * slope[leg]
        return np.asarray(total)

    def _over_joints(self, run: int, at: Floats, means: Floats) -> None:
        """The mean colours across joints: there each is a difference of the integral.

        Args:
            run: which stroke.
            at: the fractions of its length at its rows (N + 1,).
            means: of the colours between them (N, 3), each that in the middle.
        """
        edges = self.table.edges(run)
        begin = self.table.first[run]
        segments = begin + np.arange(self.table.size[run])
        width = np.diff(edges)[:, None]
        wholes = width * self._up_to(segments, np.ones(len(segments)))
        before = np.concatenate([np.zeros((1, 3)), np.cumsum(wholes, axis=0)])
        parts = interval_of(edges, at)
        u = (at - edges[parts]) / width[parts, 0]
        total = before[parts] + width[parts] * self._up_to(segments[parts], u)
        step = np.diff(at)[:, None]
        over = (np.diff(parts) != 0) & (np.abs(step[:, 0]) > 1e-9)
        means[over] = np.clip(np.diff(total, axis=0)[over] / step[over], 0.0, 1.0)

    def _share_of_peak(self, rows: Rows, at: Indices) -> Floats:
        """The point's speed after rows `at` (K,), as a fraction of its peak."""
        table = self.table
        stroke = rows.stroke[at]
        speed = np.abs(rows.fraction[at + 1] - rows.fraction[at]) * self.extent[stroke]
        speed /= table.program.period
        peak = np.where(self.extent > 0.0, self.peak, np.inf)[stroke]
        for number in self._by_formula(stroke):
            own = slice(*np.searchsorted(rows.stroke, (number, number + 1)))
            steps = slice(*np.searchsorted(stroke, (number, number + 1)))
            point = dq.translation(rows.flow.pose[own])
            velocity = dq.point_velocity(rows.flow.twist[own], point)
            peak[steps] = max(np.linalg.norm(velocity, axis=1).max(), speed[steps].max())
        return np.asarray(np.minimum(speed / peak, 1.0))

    def _by_formula(self, stroke: Indices) -> list[int]:
        """Which strokes are sampled neither by length nor evenly."""
        table = self.table
        return [
            number
            for number in np.unique(stroke[table.size[stroke] == 1]).tolist()
            if table.first[number] in table.shapes.nonuniform
            and not table.by_length[table.first[number]]
            and table.length[number] > 0.0
        ]


def make_stroke_light(table: Schedule) -> StrokeLight:
    """The light of all segments of a drawing."""
    segments = table.program.segments
    lights = [segment.light or DARK for segment in segments]
    for i, segment in enumerate(segments):  # parts of a gradient over the whole stroke
        if segment.stroke is not None and lights[i] == segment.stroke.light:
            lights[i] = lights[i].part(float(table.begin[i]), float(table.end[i]))
    first, last = np.array([light.first for light in lights]), np.array([x.last for x in lights])
    bent = {
        i: (np.array([share for share, _ in light.stops]), np.array([c for _, c in light.stops]))
        for i, light in enumerate(lights)
        if light.between
    }
    even = np.array([light.even for light in lights])
    extent = table.length.copy()
    for stroke in np.flatnonzero(extent == 0.0).tolist():
        segment = segments[table.first[stroke]]
        turns = not isinstance(segment.path, STANDING)
        extent[stroke] = float(turns and segment.brush.several)
    # the speed before durations are rounded up: otherwise a short stroke would be the brightest
    fastest = table.peak_rates * extent / np.minimum(table.wanted, table.time)
    paced = table.paced >= 0
    fastest[paced] = table.cruise[table.paced[paced]]
    return StrokeLight(table, first, last, bent, even, extent, fastest)


def unevenness(table: Schedule) -> float:
    """Largest ratio of the brightness at 1 % of a stroke to that of its middle; 1 if even."""
    lit = np.array([s.light is not None and not s.light.even for s in table.program.segments])
    matters = np.logical_or.reduceat(lit, table.first) & (table.length > 0.0)
    found = [] if matters.all() else [1.0]
    for name, with_rates, strokes in table.profiles():
        some = strokes[matters[strokes]]
        if len(some):
            found.append(_largest_ratio(name, table.end_rates(name, some) if with_rates else ()))
    return max(found)


def _largest_ratio(profile: str, rates: Rates) -> float:
    """The largest ratio among strokes with one profile. Brightness is time per length."""
    start, middle, end = (rate_at(profile, rates, f) for f in (NEAR_END, 0.5, 1.0 - NEAR_END))
    times = middle / np.minimum(start, end)
    return float(np.where(turns_back(profile, rates), 1.0, times).max())
