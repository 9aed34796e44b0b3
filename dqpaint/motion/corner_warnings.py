"""Schedule -> warnings with numbers: velocity jumps, and strokes that do not reach their speed."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from dqpaint import dq
from dqpaint.diagnostics import Diagnostic, Span
from dqpaint.dq import Floats
from dqpaint.motion.geometry.batched_shapes import Flags
from dqpaint.motion.geometry.paths import Indices
from dqpaint.motion.schedule import Schedule
from dqpaint.program import Arc, CruiseSpeed, PiecewiseCurve, Segment, Straight

LEAST_JUMP = 1e-4  # [m/s] worth a warning,
LEAST_PART = 0.01  # and of the speed
ALIKE = 1e-9  # of a jump: rounding must not decide which corner is the largest
REACHED = 0.9  # of its speed: a stroke that reaches this part gets no warning


class _Corner(NamedTuple):
    jump: float  # [m/s]
    span: Span
    within: bool  # a `stroke`
    round: bool  # it can be rounded


def velocity_jumps(table: Schedule, rates: Floats | None = None) -> Iterator[Diagnostic]:
    """W403: the largest jump of the velocity between strokes, and the largest within one.

    Args:
        table: the strokes (S).
        rates: s_dot of the clock at start and end of each (S, 2); None without retiming.
    """
    for within, found in ((False, _between(table, rates)), (True, _within(table))):
        jump, number = found
        told = _not_meant(table, number)
        jump, number = jump[told], number[told]
        if len(jump):
            largest = number[jump >= jump.max() * (1.0 - ALIKE)].tolist()
            segments = table.program.segments
            pairs = [(segments[n - 1], segments[n]) for n in largest]
            alike = [_corner(float(jump.max()), pair, within) for pair in pairs]
            last = max(alike, key=lambda corner: (corner.span.start, corner.round))
            yield _jump(last, len(jump))


def _between(table: Schedule, rates: Floats | None) -> tuple[Floats, Indices]:
    """The jumps between strokes worth a warning (K,) [m/s], and the segments they begin (K,)."""
    number = np.arange(len(table))
    velocity = np.empty((2, len(table), 3))
    for end in (0, 1):
        flow, _ = table.flow(number, np.full(len(table), float(end)), {})
        velocity[end] = dq.point_velocity(flow.twist, dq.translation(flow.pose))
        if rates is not None:
            velocity[end] *= rates[:, end, None]
    moves = table.length > 0.0
    after = np.flatnonzero(moves[1:] & moves[:-1]) + 1
    jump, large = _large_jumps(velocity[1, after - 1], velocity[0, after])
    return jump, table.first[after[large]]


def _not_meant(table: Schedule, number: Indices) -> Flags:
    """Which of some segments (K,) begin with a jump that nobody has said to be meant."""
    segments = table.program.segments
    return np.array([not (segments[n].jumps and segments[n - 1].jumps) for n in number.tolist()],
                    dtype=bool)  # fmt: skip


def _within(table: Schedule) -> tuple[Floats, Indices]:
    """The same within strokes of several segments."""
    runs = np.flatnonzero((table.size > 1) & (table.paced < 0))
    if not len(runs):
        return np.empty(0), np.empty(0, dtype=np.intp)
    stroke = np.repeat(runs, table.size[runs])
    number = np.concatenate(
        [np.arange(n, n + m) for n, m in zip(table.first[runs], table.size[runs], strict=True)]
    )
    velocity = np.empty((2, len(number), 3))
    for end in (0, 1):
        at = np.full(len(number), float(end))
        flow = table.shapes.flow(number, at, table.by_length, {})
        velocity[end] = dq.point_velocity(flow.twist, dq.translation(flow.pose))
        velocity[end] /= (table.end - table.begin)[number, None]
    joint = np.flatnonzero(stroke[1:] == stroke[:-1]) + 1
    rate = np.concatenate([_rates_at_joints(table, run) for run in runs.tolist()])[:, None]
    jump, large = _large_jumps(rate * velocity[1, joint - 1], rate * velocity[0, joint])
    return jump, number[joint[large]]


def _rates_at_joints(table: Schedule, run: int) -> Floats:
    """The rates of a stroke where its segments meet (M - 1,) [1/s]."""
    tau = np.linspace(0.0, 1.0, 4 * int(table.count[run]) + 1)
    progress = table.progress(np.full(len(tau), run), tau)
    return np.interp(table.edges(run)[1:-1], progress.value, np.abs(progress.rate))


def _large_jumps(before: Floats, after: Floats) -> tuple[Floats, Indices]:
    """The jumps between velocities (K, 3) that are worth a warning (L,), and their indices (L,)."""
    jump = np.linalg.norm(after - before, axis=1)
    speed = np.maximum(np.linalg.norm(before, axis=1), np.linalg.norm(after, axis=1))
    large = np.flatnonzero(jump > np.maximum(LEAST_JUMP, LEAST_PART * speed))
    return jump[large], large


def _corner(jump: float, segments: tuple[Segment, Segment], within: bool) -> _Corner:
    lifted = (segments[0].light is None) != (segments[1].light is None)
    round_ = not lifted and all(isinstance(s.path, Straight | Arc) for s in segments)
    return _Corner(jump, segments[1].span, within, round_)


def _jump(corner: _Corner, count: int) -> Diagnostic:
    others = f", the largest of {count} such corners" if count > 1 else ""
    ways = [
        "slow down for it: corner 0.1 mm"
        if corner.within
        else "use profile trapezoid to stop at corners"
    ]
    if corner.round:
        ways.append("round the corner: blend 5 mm" if corner.within else "round them: blend 5 mm")
    ways.append("if it is meant: corner jump")
    message = f"the velocity jumps by {1e3 * corner.jump:.3g} mm/s here{others}"
    cure = f"{', or '.join(ways[:-1])}; {ways[-1]}"
    return Diagnostic("W403", message, corner.span, "corner where this begins", cure)


def slow_strokes(table: Schedule) -> Iterator[Diagnostic]:
    """W411: the stroke that is farthest below its cruise speed."""
    firsts = table.firsts
    speed, most = np.array([
        (s.timing.speed, s.timing.turnspeed) if isinstance(s.timing, CruiseSpeed) else (0.0, 1.0)
        for s in firsts
    ]).T  # fmt: skip
    lit = np.array([segment.light is not None for segment in table.program.segments])
    lit_strokes = np.logical_or.reduceat(lit, table.first)
    curves = np.array([isinstance(segment.path, PiecewiseCurve) for segment in firsts])
    peak, time = table.peak_rates, table.time
    reached = peak * table.length / time
    below = (speed > 0.0) & (table.length > 0.0) & lit_strokes & (reached < REACHED * speed)
    turning = np.add.reduceat(table.shapes.angle, table.first)
    # with look-ahead others are as fast as their acceleration allows
    below &= (table.paced < 0) | (turning * speed > table.length * most)
    least = np.divide(peak * table.length, speed, out=np.zeros_like(time), where=speed > 0.0)
    rounded = time - table.wanted > 0.5 * (time - least)
    found = np.flatnonzero(below & ~(rounded & curves))  # short curves such as the dot of an i
    if len(found):
        worst = found[np.argmin(reached[found] / speed[found])]
        yield _slow(firsts[worst], float(reached[worst]), bool(rounded[worst]), len(found))


def _slow(segment: Segment, reached: float, rounded: bool, count: int) -> Diagnostic:
    assert isinstance(segment.timing, CruiseSpeed)
    others = f", the slowest of {count} such strokes" if count > 1 else ""
    wanted = f"{1e3 * segment.timing.speed:.3g} mm/s"
    message = f"this reaches {1e3 * reached:.3g} mm/s, not {wanted}{others}"
    label, help = "the tool turns as fast as it may", "raise turnspeed, or lower speed"
    if rounded:
        label, help = "its time is rounded up to whole periods", "a shorter period comes closer"
    return Diagnostic("W411", message, segment.span, label, help)
