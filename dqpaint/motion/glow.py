"""The light of a stroke, row by row: gradients over its length, and light that is even."""

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.language.program import Bar, Light, Segment, Step, Still
from dqpaint.motion.laws import LAWS, peak_rate, scale_rates
from dqpaint.motion.runs import part_at
from dqpaint.motion.shapes import Flow
from dqpaint.motion.timetable import Stroke

NEAR_END = 0.01  # of the length: how bright the ends of a stroke are is told there


def glow(stroke: Stroke, flow: Flow, fraction: Floats, period: float) -> Floats:
    """Mean linear RGB (N, 3) between the rows of a stroke.

    Args:
        stroke: which.
        flow: its N + 1 rows, per second; more than it has steps where the clock was slowed.
        fraction: of the length before each row (N + 1,).
        period: [s].
    """
    if all(segment.light is None for segment in stroke.segments):
        return np.zeros((len(fraction) - 1, 3))
    first, last = _colours(stroke)
    # a law may run beyond the ends of a stroke; its colours do not
    inside = np.clip(fraction, 0.0, 1.0)
    light = _means(stroke.edges, first, last, inside)
    even = np.array([s.light is not None and s.light.even for s in stroke.segments])
    if even.any():
        part = part_at(stroke.edges, 0.5 * (inside[1:] + inside[:-1]))
        share = _share_of_peak(stroke, flow, fraction, period)
        light *= np.where(even[part], share, 1.0)[:, None]
    return light


def _colours(stroke: Stroke) -> tuple[Floats, Floats]:
    """The colours at the first and at the last point of each part (M, 3)."""
    pairs = [
        _part_of_gradient(segment, *stroke.edges[i : i + 2])
        for i, segment in enumerate(stroke.segments)
    ]
    colours = np.array(pairs)
    return colours[:, 0], colours[:, 1]


def _part_of_gradient(segment: Segment, start: float, end: float) -> tuple[Floats, Floats]:
    light = segment.light or Light((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    first, last = np.array(light.first), np.array(light.last)
    if segment.run is not None and light == segment.run.light:
        return (1 - start) * first + start * last, (1 - end) * first + end * last
    return first, last


def _means(edges: Floats, first: Floats, last: Floats, at: Floats) -> Floats:
    """The mean colours (N, 3) over the length between fractions (N + 1,) of it.

    Within a part that is the colour in the middle; over a joint, a difference of the integral.
    """
    width = np.diff(edges)[:, None]
    middle = 0.5 * (at[1:] + at[:-1])
    part = part_at(edges, middle)
    share = (middle - edges[part])[:, None] / width[part]
    means = (1 - share) * first[part] + share * last[part]
    if len(width) > 1:
        before = np.concatenate([np.zeros((1, 3)), np.cumsum(width * 0.5 * (first + last), axis=0)])
        parts = part_at(edges, at)
        u = (at - edges[parts])[:, None] / width[parts]
        gathered = width[parts] * u * first[parts]
        gathered += width[parts] * 0.5 * u**2 * (last - first)[parts]
        total = before[parts] + gathered
        step = np.diff(at)[:, None]
        over = (np.diff(parts) != 0) & (np.abs(step[:, 0]) > 1e-9)
        means[over] = np.clip(np.diff(total, axis=0)[over] / step[over], 0.0, 1.0)
    return np.asarray(means)


def _share_of_peak(stroke: Stroke, flow: Flow, fraction: Floats, period: float) -> Floats:
    """How fast the point is from row to row (N,), as a share of the fastest of the stroke.

    A point of light that stays where it is has no way to be even over; a bar that turns has.
    """
    segment = stroke.segments[0]
    length = stroke.extent.length
    if length == 0.0:
        if isinstance(segment.path, Still | Step) or not isinstance(segment.brush, Bar):
            return np.zeros(len(fraction) - 1)
        length = 1.0
    way = np.abs(np.diff(fraction)) * length / period
    time = stroke.count * period
    if stroke.by_length or stroke.extent.even or stroke.extent.length == 0.0:
        rates = scale_rates(stroke.end_rates, time)
        peak = peak_rate(segment.law.name, rates) * length / time
    else:
        velocity = dq.point_velocity(flow.twist, dq.translation(flow.pose))
        peak = max(float(np.linalg.norm(velocity, axis=1).max()), float(way.max()))
    return np.asarray(np.minimum(way / peak, 1.0))


def ends_over_middle(stroke: Stroke, period: float) -> float:
    """How much brighter a stroke is at 1 % of its length than in the middle; 1 for even light."""
    lit = any(s.light is not None and not s.light.even for s in stroke.segments)
    if not lit or stroke.extent.length == 0.0:
        return 1.0
    segment = stroke.segments[0]
    if not any(segment.law.rates):
        return _OVER_MIDDLE[segment.law.name]
    return _over_middle(segment.law.name, scale_rates(stroke.end_rates, stroke.count * period))


def _over_middle(law: str, rates: tuple[float, ...]) -> float:
    """Brightness is time per length."""
    progress = LAWS[law](np.linspace(0.0, 1.0, 2001), rates)
    if not (np.diff(progress.value) > 0).all():
        return 1.0  # it turns back on its way
    near = np.array([NEAR_END, 0.5, 1 - NEAR_END])
    start, middle, end = np.interp(near, progress.value, progress.rate)
    return float(middle / min(start, end))


_OVER_MIDDLE = {name: _over_middle(name, ()) for name in LAWS}
