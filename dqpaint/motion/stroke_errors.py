"""Segment -> diagnostic of an error in its motion."""

import math
from collections.abc import Iterator
from contextlib import contextmanager

from dqpaint.core import LARGEST_MAX_SAMPLES
from dqpaint.diagnostics import Diagnostic, DiagnosticCollector, ScriptError
from dqpaint.program import Duration, Segment, Step

MOST_SECONDS = 86_400.0  # of a drawing
TIME_KEPT = 1e-6  # relative: a motion that is slower than asked by less is in time
ROUNDING_WORTH_SAYING = 0.01

Faults = dict[int, tuple[Diagnostic, ...]]  # the first of each segment or stroke, by its number


class StrokeError(Exception):
    """A stroke without a valid motion, as diagnostics."""

    def __init__(self, *diagnostics: Diagnostic) -> None:
        super().__init__(diagnostics[0].message)
        self.diagnostics = diagnostics


@contextmanager
def stroke_errors(segment: Segment) -> Iterator[None]:
    """Turns exceptions of a curve's formula into a `StrokeError`."""
    try:
        yield
    except FloatingPointError:
        raise StrokeError(not_finite(segment)) from None
    except ScriptError as problem:  # the formula names the value of its parameter itself
        raise StrokeError(*problem.diagnostics) from None


def not_finite(segment: Segment) -> Diagnostic:
    """E324."""
    return Diagnostic(
        "E324",
        "this stroke, or one of its derivatives, is not finite everywhere on the way",
        segment.span,
        help="keep a formula away from where it breaks down, and rates and times within reason",
    )


def pole(segment: Segment) -> Diagnostic:
    """E327."""
    return Diagnostic(
        "E327",
        "this curve has no length: somewhere it runs off beyond all bounds, or shakes too finely",
        segment.span,
        help="choose the ends so that they leave out where its formula divides by zero",
    )


def cusp(segment: Segment) -> Diagnostic:
    """E321."""
    return Diagnostic(
        "E321",
        "this curve comes to a point on its way, so it can't be run at one speed",
        segment.span,
        label="its formula stands still somewhere",
        help="give it a time instead, for example: in 10 s",
    )


def fast_end(segment: Segment) -> Diagnostic:
    """E322."""
    return Diagnostic(
        "E322",
        "the rates of the profile carry this stroke beyond its speed",
        segment.span,
        help="lower the rates in the brackets, raise speed, or give a time: in 10 s",
    )


def too_short(segment: Segment, least: float) -> Diagnostic:
    """E328."""
    profile = segment.profile
    a, j = profile.acceleration, profile.jerk
    return Diagnostic(
        "E328",
        f"this takes {least:.3g} s at {a:.3g} m/s2 and {j:.3g} m/s3, more than the time given",
        segment.span,
        help="give it more time, or raise the numbers in the brackets of smooth",
    )


def on_the_spot(segment: Segment) -> Diagnostic:
    """E326."""
    return Diagnostic(
        "E326",
        "this goes nowhere, so it can't be part of a stroke, which does not stop",
        segment.span,
        help="end the stroke before it",
    )


def no_extent(segment: Segment) -> Diagnostic:
    """E323."""
    kinds = [("length", "mm/s"), ("turn", "deg/s")]
    (kind, unit), (_, other) = reversed(kinds) if segment.profile.angular else kinds
    return Diagnostic(
        "E323",
        f"the profile has rates in {unit}, but this stroke has no {kind}",
        segment.span,
        help=f"give the rates in {other}, or leave the brackets out",
    )


def too_many(segment: Segment, count: float, most: int) -> Diagnostic:
    """E302: the stroke with `count` samples exceeds the budget."""
    alone = f"{count:,}" if isinstance(count, int) else "endlessly many"
    more = "; to allow more: draw --max-samples N" if most + count <= LARGEST_MAX_SAMPLES else ""
    return Diagnostic(
        "E302",
        f"more than {most:,} samples in all",
        segment.span,
        label=f"this line alone has {alone}",
        help=f"make the period longer or the path shorter or faster{more}",
    )


def endless(segment: Segment, most: int) -> Diagnostic:
    """E302, where the number of samples is not finite."""
    return too_many(segment, math.inf, most)


def beyond_budget(findings: DiagnosticCollector) -> bool:
    """Whether a drawing is refused for its size, so that no sample of it is needed."""
    return any(found.code in ("E302", "E325") for found in findings.ordered())


def too_long(segment: Segment, seconds: float) -> Diagnostic:
    """E325."""
    return Diagnostic(
        "E325",
        f"the drawing takes more than {MOST_SECONDS / 3600:.0f} hours",
        segment.span,
        label=f"this line alone takes {seconds:,.0f} s",
        help="draw it faster, or shorten the pauses",
    )


def rounding(segment: Segment, wanted: float, given: float) -> Diagnostic | None:
    """W410: a duration is rounded up noticeably to whole periods; None if it is not."""
    asked = isinstance(segment.timing, Duration) and not isinstance(segment.path, Step)
    if not asked or given - wanted <= ROUNDING_WORTH_SAYING * wanted:
        return None
    return Diagnostic(
        "W410",
        f"this takes {given:.4g} s, not {wanted:.4g} s: times are rounded up to whole periods",
        segment.span,
        help="a shorter period comes closer",
    )
