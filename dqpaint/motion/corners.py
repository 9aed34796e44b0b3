"""Warnings with numbers: where the velocity jumps, where a stroke does not reach its speed."""

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.language.diagnostics import Diagnostic, Span
from dqpaint.language.program import Arc, Chain, Cruise, Segment, Straight
from dqpaint.motion.laws import peak_rate, scale_rates
from dqpaint.motion.runs import Joined, end_velocities
from dqpaint.motion.shapes import Flow
from dqpaint.motion.timetable import Stroke

LEAST_JUMP = 1e-4  # [m/s] worth a word,
LEAST_PART = 0.01  # and of the speed
REACHED = 0.9  # of its speed: a stroke that comes to that needs no word


class _Corner(NamedTuple):
    jump: float  # [m/s]
    span: Span
    within: bool  # a `stroke`
    round: bool  # it can be rounded


def jumps(strokes: list[Stroke], flows: list[Flow], period: float) -> Iterator[Diagnostic]:
    """W403: the largest jump of the velocity between strokes, and the largest within one."""
    found = [*_between(strokes, flows), *_within(strokes, period)]
    for within in (False, True):
        corners = [corner for corner in found if corner.within == within]
        if corners:
            yield _jump(max(corners), len(corners))


def _between(strokes: list[Stroke], flows: list[Flow]) -> Iterator[_Corner]:
    for (before, after), (flow, next_flow) in zip(pairwise(strokes), pairwise(flows), strict=True):
        if before.extent.length and after.extent.length:
            velocities = _velocity(flow, -1), _velocity(next_flow, 0)
            pair = before.segments[-1], after.segments[0]
            yield from _corner(*velocities, pair, within=False)


def _velocity(flow: Flow, row: int) -> Floats:
    return dq.point_velocity(flow.twist[row], dq.translation(flow.pose[row]))


def _corner(
    before: Floats, after: Floats, segments: tuple[Segment, Segment], within: bool
) -> Iterator[_Corner]:
    jump = float(np.linalg.norm(after - before))
    speed = max(float(np.linalg.norm(before)), float(np.linalg.norm(after)))
    if jump > max(LEAST_JUMP, LEAST_PART * speed):
        lifted = (segments[0].light is None) != (segments[1].light is None)
        round_ = not lifted and all(isinstance(s.path, Straight | Arc) for s in segments)
        yield _Corner(jump, segments[1].span, within, round_)


def _within(strokes: list[Stroke], period: float) -> Iterator[_Corner]:
    for stroke in strokes:
        if isinstance(stroke.shape, Joined):
            begin, end = end_velocities(stroke.shape)
            tau = np.linspace(0.0, 1.0, 4 * stroke.count + 1)
            progress = stroke.progress(tau, period)
            rates = np.interp(stroke.edges[1:-1], progress.value, np.abs(progress.rate))
            for i, rate in enumerate(rates):
                pair = stroke.segments[i], stroke.segments[i + 1]
                yield from _corner(rate * end[i], rate * begin[i + 1], pair, within=True)


def _jump(corner: _Corner, count: int) -> Diagnostic:
    others = f", the largest of {count} such corners" if count > 1 else ""
    ways = ["end the stroke before it" if corner.within else "use law trapezoid to stop at corners"]
    if corner.round:
        ways.append("round the corner: blend 5 mm" if corner.within else "round them: blend 5 mm")
    message = f"the velocity jumps by {1e3 * corner.jump:.3g} mm/s here{others}"
    return Diagnostic("W403", message, corner.span, "corner where this begins", ", or ".join(ways))


def slow(strokes: list[Stroke], period: float) -> Iterator[Diagnostic]:
    """W411: the stroke that stays most below the speed it is to cruise at."""
    found = []
    for stroke in strokes:
        segment = stroke.segments[0]
        if isinstance(segment.timing, Cruise) and stroke.extent.length and _lit(stroke.segments):
            time = stroke.count * period
            peak = peak_rate(segment.law.name, scale_rates(stroke.end_rates, time))
            reached = peak * stroke.extent.length / time
            if reached < REACHED * segment.timing.speed:
                rounded = stroke.count * period - stroke.wanted > 0.5 * (
                    time - peak * stroke.extent.length / segment.timing.speed
                )
                if rounded and isinstance(segment.path, Chain):
                    continue  # the dot of an i can't help it
                found.append((reached / segment.timing.speed, reached, segment, rounded))
    if found:
        _, reached, segment, rounded = min(found, key=lambda one: one[0])
        yield _slow(segment, reached, rounded, len(found))


def _lit(segments: tuple[Segment, ...]) -> bool:
    return any(segment.light is not None for segment in segments)


def _slow(segment: Segment, reached: float, rounded: bool, count: int) -> Diagnostic:
    assert isinstance(segment.timing, Cruise)
    others = f", the slowest of {count} such strokes" if count > 1 else ""
    asked = f"{1e3 * segment.timing.speed:.3g} mm/s"
    message = f"this reaches {1e3 * reached:.3g} mm/s, not {asked}{others}"
    label, cure = "the tool turns as fast as it may", "raise turnspeed, or lower speed"
    if rounded:
        label, cure = "its time is rounded up to whole periods", "a shorter period comes closer"
    return Diagnostic("W411", message, segment.span, label, cure)
