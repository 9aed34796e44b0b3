"""When each stroke runs: whole samples, the time law over them, and the budget.

Durations are rounded up, so that every corner is itself a sample and no speed is exceeded.
"""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from dqpaint.dq import Floats
from dqpaint.language.diagnostics import Diagnostic, ScriptError
from dqpaint.language.findings import Findings
from dqpaint.language.program import Cruise, Lasting, Program, Samples, Segment, Step, Still
from dqpaint.motion.laws import LAWS, Progress, Rates, cruise_time, scale_rates
from dqpaint.motion.lengths import Extent, has_cusp, measure
from dqpaint.motion.runs import joined
from dqpaint.motion.shapes import Shape, shape

MOST_SAMPLES = 2_000_000
MOST_SECONDS = 86_400.0  # of a drawing
ENDLESS = 1e15  # samples
ROUNDING_WORTH_SAYING = 0.01


@dataclass(frozen=True)
class Stroke:
    """A segment, or several of one run, with shape, extent and the number of new samples.

    Attributes:
        segments: one, or all of a run (M).
        edges: the fractions (M + 1,) of the length where they begin, and the end.
        shape: of all of it.
        extent: of all of it.
        count: of new samples.
        by_length: the law runs over the length of the path, not over the parameter of its formula.
        end_rates: of the law: fractions of the path per second, and per second squared.
        wanted: the time [s] it would take if times were not rounded up to whole samples.
    """

    segments: tuple[Segment, ...]
    edges: Floats
    shape: Shape
    extent: Extent
    count: int
    by_length: bool
    end_rates: Rates
    wanted: float

    @property
    def segment(self) -> Segment:
        """The first one; law and timing are those of all."""
        return self.segments[0]

    @property
    def samples(self) -> Floats:
        """The fractions of the stroke's time at its count + 1 samples."""
        return np.arange(self.count + 1) / self.count

    def progress(self, tau: Floats, period: float) -> Progress:
        """Fraction of the path at fractions tau (N,) of the time, with derivatives per second."""
        time = self.count * period
        law = LAWS[self.segment.law.name](tau, scale_rates(self.end_rates, time))
        return Progress(law.value, law.rate / time, law.slope / time**2)


class StrokeError(Exception):
    """A stroke that has no timetable, as diagnostics."""

    def __init__(self, *diagnostics: Diagnostic) -> None:
        super().__init__(diagnostics[0].message)
        self.diagnostics = diagnostics


@contextmanager
def stroke_errors(segment: Segment) -> Iterator[None]:
    """Turn what a formula may raise on its way into a `StrokeError`."""
    try:
        yield
    except FloatingPointError:
        raise StrokeError(_not_finite(segment)) from None
    except ScriptError as problem:  # the formula names the value of its parameter itself
        raise StrokeError(*problem.diagnostics) from None


def timetable(program: Program, findings: Findings) -> list[Stroke]:
    """The strokes of a program; what is wrong or worth saying about their times is added.

    Raises:
        EnoughError: the list of errors is full.
    """
    strokes: list[Stroke] = []
    total = 1
    for segments in _runs(program.segments):
        segment = segments[0]
        try:
            stroke, note = _stroke(segments, program.period)
            total += stroke.count
            if total > MOST_SAMPLES:
                raise StrokeError(_too_many(segment, stroke.count))
            if total * program.period > MOST_SECONDS:
                raise StrokeError(_too_long(segment, stroke.count * program.period))
        except StrokeError as fault:
            for diagnostic in fault.diagnostics:
                findings.add(diagnostic)
            if total > MOST_SAMPLES or total * program.period > MOST_SECONDS:
                break
            continue
        strokes.append(stroke)
        if note is not None:
            findings.add(note)
    return strokes


def _runs(segments: tuple[Segment, ...]) -> Iterator[tuple[Segment, ...]]:
    """The segments one by one, or all of a run together."""
    for number, group in groupby(segments, key=lambda s: s.run.number if s.run else None):
        if number is None:
            yield from ((segment,) for segment in group)
        else:
            yield tuple(group)


def _stroke(segments: tuple[Segment, ...], period: float) -> tuple[Stroke, Diagnostic | None]:
    segment, timing = segments[0], segments[0].timing
    shapes, extents = [], []
    for one in segments:
        with stroke_errors(one):
            shapes.append(shape(one))
            extents.append(measure(shapes[-1]))
        by_length = not extents[-1].even and (
            one.run is not None
            or isinstance(timing, Cruise)
            or (any(one.law.rates) and not one.law.angular)
        )
        if by_length and has_cusp(shapes[-1], extents[-1]):
            raise StrokeError(_cusp(one))
        if one.run is not None and extents[-1].length == 0:
            raise StrokeError(_on_the_spot(one))
    form, extent, edges = shapes[0], extents[0], np.array([0.0, 1.0])
    if segment.run is not None:
        form, extent = joined(shapes, extents)
        by_length, edges = False, extent.edges
    end_rates = _end_rates(segment, extent)
    seconds = _seconds(segment, extents, end_rates, period)
    wanted = seconds / period
    if not wanted < ENDLESS:
        raise StrokeError(_too_many(segment, math.inf))
    count = timing.count if isinstance(timing, Samples) else _whole(wanted)
    if isinstance(segment.path, Step):
        count = 1
    stroke = Stroke(segments, edges, form, extent, count, by_length, end_rates, seconds)
    return stroke, _rounding(segment, seconds, count * period)


def _whole(samples: float) -> int:
    """The next whole number of samples, at least 1; the noise of a division is not another one."""
    return max(1, math.ceil(samples - 1e-9 - 1e-12 * samples))


def _end_rates(segment: Segment, extent: Extent) -> Rates:
    rates = segment.law.rates
    if not any(rates):
        return ()
    size, kind = (extent.angle, "turn") if segment.law.angular else (extent.length, "length")
    if size == 0 and isinstance(segment.path, Still | Step):
        return ()
    if size == 0:
        raise StrokeError(_no_extent(segment, kind))
    return tuple(rate / size for rate in rates)


def _seconds(segment: Segment, extents: list[Extent], end_rates: Rates, period: float) -> float:
    timing = segment.timing
    if isinstance(timing, Samples):
        return timing.count * period
    if isinstance(timing, Lasting):
        return timing.seconds
    length = sum(extent.length for extent in extents)
    least = length / timing.speed
    for extent in extents:  # nowhere may the tool turn too fast
        share = extent.length / length if length else 1.0
        least = max(least, extent.angle / share / timing.turnspeed)
    if least == 0:
        return period
    if not least < ENDLESS * period:
        raise StrokeError(_too_many(segment, math.inf))
    seconds = cruise_time(segment.law.name, end_rates, least)
    if seconds is None:
        raise StrokeError(_fast_end(segment))
    return seconds


def _not_finite(segment: Segment) -> Diagnostic:
    return Diagnostic(
        "E324",
        "this stroke, or one of its derivatives, is not finite everywhere on the way",
        segment.span,
        help="keep a formula away from where it breaks down, and rates and times within reason",
    )


def _cusp(segment: Segment) -> Diagnostic:
    return Diagnostic(
        "E321",
        "this curve comes to a point on its way, so it can't be run at one speed",
        segment.span,
        label="its formula stands still somewhere",
        help="give it a time instead, for example: in 10 s",
    )


def _fast_end(segment: Segment) -> Diagnostic:
    return Diagnostic(
        "E322",
        "the rates of the law carry this stroke beyond its speed",
        segment.span,
        help="lower the rates in the brackets, raise speed, or give a time: in 10 s",
    )


def _on_the_spot(segment: Segment) -> Diagnostic:
    return Diagnostic(
        "E326",
        "this goes nowhere, so it can't be part of a stroke, which does not stop",
        segment.span,
        help="end the stroke before it",
    )


def _no_extent(segment: Segment, kind: str) -> Diagnostic:
    unit = "deg/s" if kind == "turn" else "mm/s"
    other = "mm/s" if kind == "turn" else "deg/s"
    return Diagnostic(
        "E323",
        f"the law has rates in {unit}, but this stroke has no {kind}",
        segment.span,
        help=f"give the rates in {other}, or leave the brackets out",
    )


def _too_many(segment: Segment, count: float) -> Diagnostic:
    alone = f"{count:,}" if isinstance(count, int) else "endlessly many"
    return Diagnostic(
        "E302",
        f"more than {MOST_SAMPLES:,} samples in all",
        segment.span,
        label=f"this line alone has {alone}",
        help="make the period longer or the path shorter or faster",
    )


def _too_long(segment: Segment, seconds: float) -> Diagnostic:
    return Diagnostic(
        "E325",
        f"the drawing takes more than {MOST_SECONDS / 3600:.0f} hours",
        segment.span,
        label=f"this line alone takes {seconds:,.0f} s",
        help="draw it faster, or shorten the pauses",
    )


def _rounding(segment: Segment, wanted: float, given: float) -> Diagnostic | None:
    asked = isinstance(segment.timing, Lasting) and not isinstance(segment.path, Step)
    if not asked or given - wanted <= ROUNDING_WORTH_SAYING * wanted:
        return None
    return Diagnostic(
        "W410",
        f"this takes {given:.4g} s, not {wanted:.4g} s: times are rounded up to whole periods",
        segment.span,
        help="a shorter period comes closer",
    )
