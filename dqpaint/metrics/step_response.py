"""Track -> the step response to each jump of the reference: settling, overshoot, steady error."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.diagnostics import SourceLine
from dqpaint.dq import Floats
from dqpaint.simulation import Track

SETTLING_BAND = 0.02  # of the step: an error that stays below it has settled
STEADY_SHARE = 0.1  # of the time at the set point, at its end, counts for the steady error
LEAST_STEP = 1e-9  # [m, rad] a smaller step is none


@dataclass(frozen=True)
class PartResponse:
    """The response to the translation or the rotation of a step.

    Attributes:
        size: of the step [m] or [rad].
        settling: time [s] from the jump until the error stays below 2 % of the step; None if it
            never did, or there was no step to take.
        overshoot: the farthest beyond the set point, along the step, as a part of it; 0 if never.
        steady: mean error [m] or [rad] over the last tenth of the time at the set point.
    """

    size: float
    settling: float | None
    overshoot: float
    steady: float


@dataclass(frozen=True)
class StepResponse:
    """The response to one jump: its time [s], its line, and both parts."""

    time: float
    line: SourceLine
    translation: PartResponse
    rotation: PartResponse


@dataclass(frozen=True)
class StepCurve:
    """How a tool went from a set point to the next.

    Attributes:
        line: of the jump.
        t: times (N,) [s] since the jump.
        moved: position less that of the old set point (N, 3) [m], base frame.
        step: of the set point (3,) [m].
        turned: angle from the old orientation about the axis of the step (N,) [rad].
        turn: of the set point [rad].
    """

    line: SourceLine
    t: Floats
    moved: Floats
    step: Floats
    turned: Floats
    turn: float


def step_responses(track: Track) -> tuple[StepResponse, ...]:
    """The response to every jump of the reference after which it stays for a while."""
    motion = track.motion
    return tuple(
        StepResponse(
            time=float(motion.t[rows[0]]),
            line=motion.source.at(before),
            translation=_response(
                dq.translation(new) - dq.translation(old),
                track.points[rows] - dq.translation(new),
                times,
            ),
            rotation=_response(
                _rotation_vectors(new, old), _rotation_vectors(track.pose[rows], new), times
            ),
        )
        for before, rows, old, new, times in _steps(track)
    )


def step_curves(track: Track) -> tuple[StepCurve, ...]:
    """The way to every set point that the reference jumps to and stays at for a while."""
    found = []
    for before, rows, old, new, times in _steps(track):
        turn = _rotation_vectors(new, old)
        angle = float(np.linalg.norm(turn))
        axis = turn / angle if angle >= LEAST_STEP else np.zeros(3)
        found.append(
            StepCurve(
                track.motion.source.at(before), times, track.points[rows] - dq.translation(old),
                dq.translation(new) - dq.translation(old),
                _rotation_vectors(track.pose[rows], old) @ axis, angle,
            )
        )  # fmt: skip
    return tuple(found)


def _steps(track: Track) -> Iterator[tuple[int, NDArray[np.intp], Floats, Floats, Floats]]:
    """Of each jump the row before, the rows at the set point, both set points, times since [s]."""
    motion = track.motion
    for before in np.flatnonzero(motion.jump[:-1]).tolist():  # a last one has no time to be met
        rows = _rows_of_set_point(motion.pose, before + 1)
        if len(rows) >= 2:
            times = motion.t[rows] - motion.t[rows[0]]
            yield before, rows, motion.pose[before], motion.pose[rows[0]], times


def _rows_of_set_point(poses: Floats, first: int) -> NDArray[np.intp]:
    """The rows from `first` on that ask for the same pose."""
    other = (poses[first:] != poses[first]).any(axis=1)
    last = first + int(np.argmax(other)) if other.any() else len(poses)
    return np.arange(first, last)


def _rotation_vectors(x: Floats, start: Floats) -> Floats:
    """The rotation vectors (..., 3) [rad] from one orientation to others, the short way."""
    return np.asarray(2 * dq.log(dq.mul(x, dq.conj(start)))[..., :3])


def _response(step: Floats, errors: Floats, times: Floats) -> PartResponse:
    """From a step (3,), errors (N, 3) from its end, and times (N,) [s] since the jump."""
    size = float(np.linalg.norm(step))
    far = np.linalg.norm(errors, axis=1)
    # counted in rows: which is the first of them must not hang on how times were rounded
    rows = np.arange(len(far))
    steady = float(far[rows >= (1 - STEADY_SHARE) * rows[-1]].mean())
    if size < LEAST_STEP:
        return PartResponse(0.0, None, 0.0, steady)
    outside = np.flatnonzero(far > SETTLING_BAND * size)
    after = int(outside[-1]) + 1 if len(outside) else 0
    settling = float(times[after]) if after < len(times) else None
    beyond = float((errors @ step).max()) / size**2
    return PartResponse(size, settling, max(beyond, 0.0), steady)
