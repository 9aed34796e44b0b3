"""Program -> schedule: samples and profile of each stroke, within the sample budget.

Durations are rounded up, so that every corner is itself a sample and no speed is exceeded. What
belongs to the strokes stands in arrays, one row a stroke: a drawing may have many.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dqpaint.diagnostics import Diagnostic, DiagnosticCollector, Span
from dqpaint.dq import Floats
from dqpaint.motion import stroke_errors
from dqpaint.motion.geometry.arc_length import has_cusp, length_fraction
from dqpaint.motion.geometry.batched_shapes import Flags, Shapes, gather_shapes
from dqpaint.motion.geometry.paths import Indices
from dqpaint.motion.geometry.s_curves import s_curves
from dqpaint.motion.geometry.shapes import Flow
from dqpaint.motion.geometry.speed_limits import stretches_of
from dqpaint.motion.look_ahead import FASTEST, Phases, Stretches, fastest, speeds_for
from dqpaint.motion.profiles import (
    PEAK,
    PROFILES,
    Progress,
    Rates,
    cruise_time,
    peak_rate,
    scale_rates,
)
from dqpaint.motion.stroke_errors import MOST_SECONDS, Faults
from dqpaint.program import STANDING, CruiseSpeed, Program, Samples, Segment, Step

ENDLESS = 1e15  # samples
NAMES = tuple(PROFILES)
RATES = {"cubic": 2, "quintic": 4}  # how many a profile may have


@dataclass(frozen=True, eq=False)
class Schedule:
    """The strokes of a drawing (S), each of one segment or several.

    Attributes:
        program: what is drawn.
        shapes: of its segments (M).
        first: the number of each stroke's first segment (S,).
        size: and how many it has (S,).
        begin: where each segment begins, as a fraction of its stroke's length (M,).
        end: and where it ends (M,).
        by_length: which segments (M,) the profile runs over by the length of their path, not by the
            parameter of their formula.
        length: of each stroke's path [m] (S,).
        profile: which of `NAMES` each profile is (S,).
        rates: v0, v1, a0, a1 of each profile (S, 4): fractions of the path per second, and per
            second squared.
        count: of new samples (S,).
        wanted: the times [s] they would take if those were not rounded up to whole samples (S,).
        paced: which of the strokes of `pace` each is (S,); -1 for those by their profile alone.
        pace: the motion of strokes with look-ahead (P), before times are rounded.
        cruise: the speed at which the light of each of these shines in full (P,) [m/s].
    """

    program: Program
    shapes: Shapes
    first: Indices
    size: Indices
    begin: Floats
    end: Floats
    by_length: Flags
    length: Floats
    profile: Indices
    rates: Floats
    count: NDArray[np.int64]
    wanted: Floats
    paced: Indices
    pace: Phases | None = None
    cruise: Floats = field(default_factory=lambda: np.empty(0))

    def __len__(self) -> int:
        return len(self.first)

    @cached_property
    def time(self) -> Floats:
        """The duration of each stroke (S,) [s]."""
        return np.asarray(self.count * self.program.period)

    @cached_property
    def firsts(self) -> list[Segment]:
        """The first segment of each stroke, whose profile and timing hold for all of it."""
        return [self.program.segments[number] for number in self.first]

    def select(self, strokes: Flags | Indices) -> "Schedule":
        """Some of the strokes."""
        names = ("first", "size", "length", "profile", "rates", "count", "wanted", "paced")
        return replace(self, **{name: getattr(self, name)[strokes] for name in names})

    def edges(self, stroke: int) -> Floats:
        """The fractions of a stroke's length at which its segments begin, and 1."""
        first = self.first[stroke]
        return np.append(self.begin[first : first + self.size[stroke]], 1.0)

    def profiles(self) -> Iterator[tuple[str, bool, Indices]]:
        """The strokes of each profile without look-ahead, with and without boundary rates."""
        rated, alone = self.rates.any(axis=1), self.paced < 0
        for number, name in enumerate(NAMES):
            for with_rates in (False, True):
                of_it = alone & (self.profile == number) & (rated == with_rates)
                strokes = np.flatnonzero(of_it)
                if len(strokes):
                    yield name, with_rates, strokes

    def end_rates(self, name: str, strokes: Indices | int) -> Rates:
        """The boundary rates per tau of strokes of one profile, or of one stroke."""
        columns = self.rates[strokes].T[: RATES[name]]
        return scale_rates(tuple(columns), self.time[strokes])

    @cached_property
    def peak_rates(self) -> Floats:
        """The largest rates of the profiles (S,), in fractions of the path per tau."""
        peak = np.empty(len(self))
        for name, with_rates, strokes in self.profiles():
            rates = self.end_rates(name, strokes) if with_rates else ()
            peak[strokes] = peak_rate(name, rates)
        if self.pace is not None:
            own, of = self._paced_rows(np.arange(len(self)))
            peak[own] = (self.pace.peaks * self.pace.seconds / self.pace.lengths)[of]
        return peak

    def _paced_rows(self, stroke: Indices) -> tuple[Indices, Indices]:
        """Which of some strokes (N,) have look-ahead, and their numbers in `pace`."""
        own = np.flatnonzero(self.paced[stroke] >= 0)
        return own, self.paced[stroke[own]]

    def progress(self, stroke: Indices, tau: Floats) -> Progress:
        """The progress of strokes (N,) at fractions tau (N,) of their times, per second."""
        value, rate, slope = np.zeros((3, len(tau)))  # rows with look-ahead are filled last
        kind = np.full(len(self), -1)
        profiles = list(self.profiles())
        for number, (_, _, strokes) in enumerate(profiles):
            kind[strokes] = number
        one = len(profiles) == 1 and self.pace is None
        for number, (name, with_rates, _) in enumerate(profiles):
            rows = slice(None) if one else np.flatnonzero(kind[stroke] == number)
            rates = self.end_rates(name, stroke[rows]) if with_rates else ()
            profile = PROFILES[name](tau[rows], rates)
            value[rows], rate[rows], slope[rows] = profile.value, profile.rate, profile.slope
        time = self.time[stroke]
        rate, slope = rate / time, slope / time**2
        if self.pace is not None:
            own, of = self._paced_rows(stroke)
            found, faster = self.pace.progress(of, tau[own]), self.pace.seconds[of] / time[own]
            value[own] = found.value
            rate[own], slope[own] = found.rate * faster, found.slope * faster**2
        return Progress(value, rate, slope)

    def parts(self, stroke: Indices, fraction: Floats) -> Indices:
        """The segments of strokes (N,), in order, at fractions (N,) of their length.

        At a joint it is the one that begins there; values outside belong to the outer ones.
        """
        number = self.first[stroke]
        several = stroke[self.size[stroke] > 1]
        for run in np.unique(several) if len(several) else ():
            rows = slice(*np.searchsorted(stroke, (run, run + 1)))
            number[rows] += interval_of(self.edges(run), fraction[rows])
        return np.asarray(number)

    def flow(self, stroke: Indices, tau: Floats, faults: Faults) -> tuple[Flow, Floats]:
        """Motion of strokes (N,), in order, at fractions tau (N,), in the drawing frame.

        Args:
            stroke: which.
            tau: when.
            faults: gets what goes wrong, by the segment; there the rows are not finite.

        Returns:
            The flow per second, and the fraction of the length, which is exact where the light
            needs it: in a gradient, and where it is even.
        """
        progress = self.progress(stroke, tau)
        number, f = self.inside(stroke, progress.value)
        flow = self.shapes.flow(number, f, self.by_length, faults)
        if (self.size[stroke] > 1).any():
            flow = flow.reparametrised(1.0 / (self.end - self.begin)[number], np.zeros(len(tau)))
        fraction = self._by_length(stroke, progress.value, faults)
        return flow.reparametrised(progress.rate, progress.slope), fraction

    def _by_length(self, stroke: Indices, fraction: Floats, faults: Faults) -> Floats:
        """Length fractions from parameter fractions, where the light is a gradient."""
        out = fraction
        for number in self._changing():
            rows = slice(*np.searchsorted(stroke, (number, number + 1)))
            if rows.start < rows.stop and int(self.first[number]) not in faults:
                out = out.copy() if out is fraction else out
                first = int(self.first[number])
                form, extent = self.shapes.shape(first), self.shapes.nonuniform[first]
                out[rows] = length_fraction(form, extent, fraction[rows])
        return out

    def _changing(self) -> list[int]:
        """The strokes sampled by parameter whose light depends on the length."""
        found = []
        for first in self.shapes.nonuniform:
            light = self.program.segments[first].light
            changes = light is not None and (light.changes or light.even)
            if changes and not self.by_length[first]:
                found += np.flatnonzero(self.first == first).tolist()
        return found

    def inside(self, stroke: Indices, fraction: Floats) -> tuple[Indices, Floats]:
        """The segments as in `parts`, and the fractions within each of them."""
        number = self.parts(stroke, fraction)
        begin = self.begin[number]
        return number, (fraction - begin) / (self.end[number] - begin)


def interval_of(edges: Floats, f: Floats) -> Indices:
    """The interval (N,) of each fraction; values outside belong to the outer ones."""
    return np.clip(np.searchsorted(edges, f, side="right") - 1, 0, len(edges) - 2)


def schedule_strokes(program: Program, findings: DiagnosticCollector) -> Schedule:
    """The schedule of a program; errors and warnings about its times go to `findings`.

    Strokes that are wrong are left out.

    Raises:
        ErrorLimitError: the list of errors is full.
    """
    segments = program.segments
    faults: Faults = {}  # of segments
    shapes = gather_shapes(segments, faults, program.most_samples * program.period)
    first, size = _strokes(segments)
    by_length = _by_length(shapes, faults)
    begin, end, length = _segment_edges(shapes, first, size)
    draft = Schedule(
        *(program, shapes, first, size, begin, end, by_length, length),
        *(np.zeros(len(first), np.intp), np.zeros((len(first), 4))),
        *(np.ones(len(first), np.int64), np.ones(len(first))),
        np.full(len(first), -1),
    )
    wrong = _first_errors(faults, first)
    profile, rates = _profiles(draft, wrong)
    table = replace(draft, profile=profile, rates=rates)
    wanted = _seconds(table, wrong)
    table = _with_look_ahead(replace(table, wanted=wanted), wrong)
    table = replace(table, count=_counts(draft.firsts, table.wanted, program))
    return table.select(_report(table, wrong, findings))


def _with_look_ahead(table: Schedule, wrong: Faults) -> Schedule:
    """The schedule with the motion of strokes that have an acceleration, and their times."""
    found = [
        s for s, one in enumerate(table.firsts)
        if one.profile.acceleration > 0.0 and s not in wrong and table.length[s] > 0.0
    ]  # fmt: skip
    if not found:
        return table
    found.sort(key=lambda stroke: table.firsts[stroke].profile.jerk > 0.0)
    strokes = np.array(found, dtype=np.intp)
    firsts = [table.firsts[stroke] for stroke in strokes]
    size = table.size[strokes]
    begins = np.cumsum(size) - size
    numbers = np.arange(size.sum()) + np.repeat(table.first[strokes] - begins, size)
    wanted = table.wanted.copy()
    speed = np.array([
        one.timing.speed if isinstance(one.timing, CruiseSpeed) else 0.0 for one in firsts
    ])  # fmt: skip
    timed = np.flatnonzero(speed == 0.0)
    speed[timed] = FASTEST * table.length[strokes[timed]] / wanted[strokes[timed]]
    acceleration = np.array([one.profile.acceleration for one in firsts])
    stretches = stretches_of(
        *(table.shapes, numbers, begins, table.by_length),
        *(acceleration, speed, table.program.period),
    )
    jerk = np.array([one.profile.jerk for one in firsts])
    for own in (timed[jerk[timed] == 0.0], timed[jerk[timed] > 0.0]):
        if len(own):
            speed[own] = _speeds(stretches.select(own), jerk[own], wanted[strokes[own]])
    pace = _pace(stretches, jerk, speed)
    for number in timed[jerk[timed] > 0.0].tolist():
        stroke, least = int(strokes[number]), float(pace.seconds[number])
        if least > wanted[stroke] * (1 + stroke_errors.TIME_KEPT):
            wrong[stroke] = (stroke_errors.too_short(firsts[number], least),)
    cruise = speed.copy()
    if len(timed):  # strokes of one statement shine alike
        spans = [firsts[number].span for number in timed.tolist()]
        played = (pace.peaks * pace.seconds)[timed] / wanted[strokes[timed]]
        most: dict[Span, float] = {}
        for span, value in zip(spans, played.tolist(), strict=True):
            most[span] = max(most.get(span, 0.0), value)
        cruise[timed] = [most[span] for span in spans]
    cruising = np.ones(len(strokes), dtype=bool)
    cruising[timed] = False
    wanted[strokes[cruising]] = pace.seconds[cruising]
    paced = table.paced.copy()
    paced[strokes] = np.arange(len(strokes))
    return replace(table, wanted=wanted, paced=paced, pace=pace, cruise=cruise)


def _pace(stretches: Stretches, jerk: Floats, speed: Floats) -> Phases:
    """The motion of strokes (P,), those with a jerk last, at no more than the cruise speeds."""
    plain, curved = np.flatnonzero(jerk == 0.0), np.flatnonzero(jerk > 0.0)
    if not len(curved):
        return fastest(stretches, speed)
    late = s_curves(stretches.select(curved), jerk[curved], speed[curved])
    if not len(plain):
        return late
    return fastest(stretches.select(plain), speed[plain]).followed_by(late)


def _speeds(stretches: Stretches, jerk: Floats, seconds: Floats) -> Floats:
    """The cruise speeds (P,) [m/s] of strokes that all have a jerk, or none, in their times."""
    if not jerk[0]:
        return speeds_for(stretches, seconds)
    return speeds_for(stretches, seconds, lambda v: s_curves(stretches, jerk, v).seconds)


def _strokes(segments: Sequence[Segment]) -> tuple[Indices, Indices]:
    """The first segment of each stroke (S,), and its number of segments."""
    run = np.array([s.stroke.number if s.stroke else 0 for s in segments])
    goes_on = (run[1:] == run[:-1]) & (run[1:] != 0)
    first = np.flatnonzero(np.concatenate([[True], ~goes_on]))
    return first, np.diff(np.append(first, len(segments)))


def _by_length(shapes: Shapes, faults: Faults) -> Flags:
    """Which segments (M,) are sampled by arc length; a cusp on their way is an error."""
    out = np.zeros(len(shapes.segments), dtype=bool)
    for number, extent in shapes.nonuniform.items():
        segment = shapes.segments[number]
        profile = segment.profile
        cruises = segment.stroke is not None or isinstance(segment.timing, CruiseSpeed)
        cruises = cruises or profile.acceleration > 0.0
        out[number] = cruises or (any(profile.rates) and not profile.angular)
        if out[number] and has_cusp(shapes.shape(number), extent):
            faults.setdefault(number, (stroke_errors.cusp(segment),))
    for number in np.flatnonzero(shapes.length == 0.0).tolist():
        if shapes.segments[number].stroke is not None:
            faults.setdefault(number, (stroke_errors.on_the_spot(shapes.segments[number]),))
    return out


def _segment_edges(shapes: Shapes, first: Indices, size: Indices) -> tuple[Floats, Floats, Floats]:
    """Start and end of segments (M,), as fractions of their strokes, and the lengths (S,)."""
    begin, end = np.zeros(len(shapes.segments)), np.ones(len(shapes.segments))
    length = shapes.length[first]
    for stroke in np.flatnonzero(size > 1).tolist():
        own = slice(first[stroke], first[stroke] + size[stroke])
        ends = np.concatenate([[0.0], np.cumsum(shapes.length[own])])
        length[stroke] = ends[-1]
        if ends[-1] > 0.0:
            edges = ends / ends[-1]
            begin[own], end[own] = edges[:-1], edges[1:]
    return begin, end, length


def _first_errors(faults: Faults, first: Indices) -> Faults:
    """The first error of each stroke, from the errors of its segments."""
    wrong: Faults = {}
    for number in sorted(faults):
        stroke = int(np.searchsorted(first, number, side="right")) - 1
        wrong.setdefault(stroke, faults[number])
    return wrong


def _profiles(table: Schedule, wrong: Faults) -> tuple[Indices, Floats]:
    """The profile of each stroke (S,), and its boundary rates as fractions of the path (S, 4)."""
    firsts = table.firsts
    profile = np.array([NAMES.index(segment.profile.name) for segment in firsts])
    rates = np.zeros((len(firsts), 4))
    for stroke, segment in enumerate(firsts):
        given = segment.profile.rates
        if not any(given) or stroke in wrong:
            continue
        angles = table.shapes.angle[table.first[stroke] :][: table.size[stroke]]
        extent = sum(angles.tolist()) if segment.profile.angular else float(table.length[stroke])
        if extent != 0:
            rates[stroke, : len(given)] = np.array(given) / extent
        elif not isinstance(segment.path, STANDING):
            wrong[stroke] = (stroke_errors.no_extent(segment),)
    return profile, rates


def _seconds(table: Schedule, wrong: Faults) -> Floats:
    """The wanted duration of each stroke (S,) [s]."""
    period, firsts = table.program.period, table.firsts
    seconds, speed, turnspeed = np.array([_wanted_timing(s, period) for s in firsts]).T
    cruising = speed > 0.0
    total = np.repeat(table.length, table.size)
    share = np.divide(table.shapes.length, total, out=np.ones_like(total), where=total > 0.0)
    with np.errstate(all="ignore"):  # of strokes that are wrong already
        turns = np.maximum.reduceat(table.shapes.angle / share, table.first)
        least = np.maximum(table.length / speed, turns / turnspeed)  # nowhere too fast
    peak = np.array([PEAK[name] for name in NAMES])[table.profile]
    seconds = np.where(cruising, np.where(least == 0, period, peak * least), seconds)
    endless = ~(seconds / period < ENDLESS) | (cruising & ~(least < ENDLESS * period))
    for stroke in np.flatnonzero(endless).tolist():
        wrong.setdefault(
            stroke, (stroke_errors.endless(firsts[stroke], table.program.most_samples),)
        )
    good = np.array([stroke not in wrong for stroke in range(len(table))])
    for name, with_rates, strokes in table.profiles():
        own = strokes[(cruising & (least > 0) & good)[strokes]]
        if with_rates and len(own):
            rates = tuple(table.rates[own].T[: RATES[name]])
            seconds[own] = cruise_time(name, rates, least[own])
    for stroke in np.flatnonzero(np.isnan(seconds) & good).tolist():
        wrong[stroke] = (stroke_errors.fast_end(firsts[stroke]),)
    return seconds


def _wanted_timing(segment: Segment, period: float) -> tuple[float, float, float]:
    """The time [s] of a stroke, or its speed [m/s] and turnspeed [rad/s]."""
    timing = segment.timing
    if isinstance(timing, CruiseSpeed):
        return 0.0, timing.speed, timing.turnspeed
    return timing.count * period if isinstance(timing, Samples) else timing.seconds, 0.0, 1.0


def _counts(firsts: Sequence[Segment], seconds: Floats, program: Program) -> NDArray[np.int64]:
    """The new samples of each stroke (S,); a count beyond the budget is clipped just above it."""
    most = 2 * program.most_samples
    wanted = np.minimum(np.nan_to_num(seconds / program.period), float(most))
    # the next whole number, at least 1; the noise of a division is not another one
    count = np.maximum(1, np.ceil(wanted - 1e-9 - 1e-12 * wanted)).astype(np.int64)
    for stroke, segment in enumerate(firsts):
        if isinstance(segment.path, Step):
            count[stroke] = 1
        elif isinstance(segment.timing, Samples):
            count[stroke] = min(segment.timing.count, most)
    return count


def _report(table: Schedule, wrong: Faults, findings: DiagnosticCollector) -> Flags:
    """Says what is wrong, and what is rounded by much; gives which strokes (S,) are left."""
    period, most, firsts = table.program.period, table.program.most_samples, table.firsts
    good = np.array([stroke not in wrong for stroke in range(len(table))])
    total = 1 + np.cumsum(np.where(good, table.count, 0))
    over = np.flatnonzero(good & ((total > most) | (total * period > MOST_SECONDS)))
    end = int(over[0]) if len(over) else len(table)
    longer = table.time - table.wanted > stroke_errors.ROUNDING_WORTH_SAYING * table.wanted
    for stroke in sorted({*wrong, *np.flatnonzero(longer & good).tolist()}):
        if stroke >= end:
            break
        note = stroke_errors.rounding(
            firsts[stroke], float(table.wanted[stroke]), float(table.time[stroke])
        )
        for diagnostic in wrong.get(stroke, (note,) if note else ()):
            findings.add(diagnostic)
    if end < len(table):
        findings.add(_too_much(firsts[end], table, end, bool(total[end] > most)))
    return good & (np.arange(len(table)) < end)


def _too_much(segment: Segment, table: Schedule, stroke: int, samples: bool) -> Diagnostic:
    count, period = int(table.count[stroke]), table.program.period
    most = table.program.most_samples
    if count >= 2 * most:
        wanted = float(table.wanted[stroke]) / period
        count = math.ceil(wanted - 1e-9 - 1e-12 * wanted)
    if isinstance(segment.timing, Samples):
        count = segment.timing.count
    return (
        stroke_errors.too_many(segment, count, most)
        if samples
        else stroke_errors.too_long(segment, count * period)
    )
