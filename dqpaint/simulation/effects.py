"""A run, and the same with less -> whether what is left out moves the tool at all."""

import math
import operator
from collections.abc import Callable

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError
from dqpaint.simulation.closed_loop import Track

LEAST_SHIFT, LEAST_TURN = 1e-6, math.radians(1e-3)  # [m, rad] a smaller effect is none


class _DiffersError(Exception):
    """The tool is elsewhere than in the other run."""


def has_effect(run: Track, again: Callable[[Callable[[int, Floats], None]], Track]) -> bool:
    """Whether the tool of another run leaves that of `run` by 1 um or 0.001 deg, in any row.

    The other run ends where it does, so that only what has no effect costs a whole run.

    Args:
        run: with everything.
        again: carries out the other run, and calls what it is given with each row and pose.
    """
    rotations, points = dq.rotation(run.pose).tolist(), run.points.tolist()

    def watch(row: int, pose: Floats) -> None:
        shift = math.dist(points[row], dq.translation(pose).tolist())
        rotation = dq.rotation(pose).tolist()
        sign = math.copysign(1.0, sum(map(operator.mul, rotations[row], rotation)))
        turned = [sign * value for value in rotation]
        chord = math.dist(rotations[row], turned)  # half the angle
        if shift >= LEAST_SHIFT or 2 * chord >= LEAST_TURN:
            raise _DiffersError

    try:
        again(watch)
    except (_DiffersError, DqpaintError):  # one that cannot be carried out is not the same
        return True
    return False
