"""Track -> the step response to each jump of the reference: settling, overshoot, steady error."""

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


def step_responses(track: Track) -> tuple[StepResponse, ...]:
    """The response to every jump of the reference after which it stays for a while."""
    motion = track.motion
    found = []
    for before in np.flatnonzero(motion.jump):
        rows = _rows_of_set_point(motion.pose, int(before) + 1)
        if len(rows) < 2:
            continue
        old, new = motion.pose[before], motion.pose[rows[0]]
        times = motion.t[rows] - motion.t[rows[0]]
        way = dq.translation(new) - dq.translation(old)
        turn = _rotation_vectors(new, old)
        found.append(
            StepResponse(
                time=float(motion.t[rows[0]]),
                line=motion.source.at(int(before)),
                translation=_response(way, track.points[rows] - dq.translation(new), times),
                rotation=_response(turn, _rotation_vectors(track.pose[rows], new), times),
            )
        )
    return tuple(found)


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
    steady = float(far[times >= (1 - STEADY_SHARE) * times[-1]].mean())
    if size < LEAST_STEP:
        return PartResponse(0.0, None, 0.0, steady)
    outside = np.flatnonzero(far > SETTLING_BAND * size)
    after = int(outside[-1]) + 1 if len(outside) else 0
    settling = float(times[after]) if after < len(times) else None
    beyond = float((errors @ step).max()) / size**2
    return PartResponse(size, settling, max(beyond, 0.0), steady)
