"""Schedule -> rows of its strokes, block by block, so that a long drawing needs little memory."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats
from dqpaint.motion.geometry.paths import Indices
from dqpaint.motion.geometry.shapes import Flow
from dqpaint.motion.schedule import Schedule
from dqpaint.motion.stroke_errors import Faults, not_finite
from dqpaint.motion.time_scaling import Ticks

AT_ONCE = 16_384  # rows, unless one stroke alone has more


@dataclass(frozen=True, eq=False)
class Rows:
    """Consecutive strokes, each from its start to its end, both included.

    Attributes:
        stroke: the number of each row's stroke (N,), in order.
        tau: the fraction of its time (N,).
        flow: the motion per second, in the drawing frame.
        fraction: progress along the path by the profile (N,).
        last: whether a row is the end of its stroke (N,); the next row is the start of another.
    """

    stroke: Indices
    tau: Floats
    flow: Flow
    fraction: Floats
    last: NDArray[np.bool_]


def blocks(counts: NDArray[np.int64]) -> Iterator[Indices]:
    """Slices of the strokes with these numbers of new samples (S,), of bounded size."""
    ends = np.cumsum(counts + 1)
    begin = 0
    while begin < len(counts):
        before = int(ends[begin - 1]) if begin else 0
        end = max(begin + 1, int(np.searchsorted(ends, before + AT_ONCE, side="right")))
        yield np.arange(begin, end)
        begin = end


def every_sample(counts: NDArray[np.int64], strokes: Indices) -> tuple[Indices, Floats]:
    """The stroke of each row (N,) of some strokes, and the fraction of its time (N,)."""
    own = counts[strokes]
    stroke = np.repeat(strokes, own + 1)
    begins = np.cumsum(own + 1) - (own + 1)
    step = np.arange(len(stroke)) - np.repeat(begins, own + 1)
    return stroke, step / counts[stroke]


def sample_rows(
    table: Schedule, ticks: Sequence[Ticks] | None, faults: Faults, split: bool = False
) -> Iterator[Rows]:
    """The rows of all strokes, block by block.

    Args:
        table: the strokes.
        ticks: sample times of each under retiming; None: at whole periods.
        faults: collects the errors, by stroke.
        split: whether a long stroke may be split; only without retiming.
    """
    counts = table.count if ticks is None else np.array([tick.count for tick in ticks])
    for strokes in blocks(counts):
        if ticks is None:
            stroke, tau = every_sample(counts, strokes)
        else:
            some = [ticks[number] for number in strokes]
            stroke = np.repeat(strokes, counts[strokes] + 1)
            tau = np.concatenate([tick.tau for tick in some])
        last = np.append(stroke[1:] != stroke[:-1], True)
        for begin in range(0, len(stroke), AT_ONCE) if split else (0,):
            own = slice(begin, begin + AT_ONCE) if split else slice(None)
            of_segments: Faults = {}
            with np.errstate(all="ignore"):  # non-finite rows are reported below
                flow, fraction = table.flow(stroke[own], tau[own], of_segments)
            if ticks is not None:
                flow = flow.reparametrised(*_clock_rates(some))
            _record_errors(table, stroke[own], flow, of_segments, faults)
            yield Rows(stroke[own], tau[own], flow, fraction, last[own])


def _clock_rates(ticks: Sequence[Ticks]) -> tuple[Floats, Floats]:
    """The rate s_dot of the clock at each row, and its derivative s_ddot."""
    rates = [np.ones(len(t.tau)) if t.rate is None else t.rate for t in ticks]
    slopes = [np.zeros(len(t.tau)) if t.slope is None else t.slope for t in ticks]
    return np.concatenate(rates), np.concatenate(slopes)


def _record_errors(
    table: Schedule, stroke: Indices, flow: Flow, of_segments: Faults, faults: Faults
) -> None:
    """Records the first error of each stroke: of its formula, or that its rows are not finite."""
    for number in sorted(of_segments):
        owner = int(np.searchsorted(table.first, number, side="right")) - 1
        found = of_segments[number]
        if found[0].code == "E324":
            found = (not_finite(table.program.segments[table.first[owner]]),)
        faults.setdefault(owner, found)
    parts = (flow.pose, flow.twist, flow.slope)
    if all(np.isfinite(part).all() for part in parts):
        return
    finite = np.logical_and.reduce([np.isfinite(part).all(axis=1) for part in parts])
    for number in np.unique(stroke[~finite]).tolist():
        faults.setdefault(number, (not_finite(table.program.segments[table.first[number]]),))
