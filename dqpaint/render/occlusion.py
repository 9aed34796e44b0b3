"""Postures, lamps and an eye -> the share of light that the arm does not occlude.

At selected instants the ray caster takes the arm's posture, and a ray from each lamp tests whether
the camera sees it. The instants are so close that neither lamp nor links move far between them.
Where a lamp is hidden at one and visible at the next, instants between them are tested until the
change is known to a sample. Between equal results there is no test, so an occluder that is thinner
than the motion between two instants can be missed.
"""

import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats
from dqpaint.render.ray_casting import RayCaster

LONGEST_LAMP_STEP = 0.004
"""Largest distance of a lamp between two tested instants [m]."""
LARGEST_TURN = np.radians(1.0)
"""Largest total joint rotation between two tested instants [rad]."""
CLEARANCE = 0.01
"""Distance between a lamp and the start of its ray, so that its holder does not hide it [m]."""


def visible_share(
    caster: RayCaster, postures: Floats, places: Floats, eye: Floats, lit: NDArray[np.bool_]
) -> Floats:
    """The share (M, K) of the light of K lamps that reaches the eye at M instants, 0 to 1.

    Args:
        caster: of the arm.
        postures: (M, n) at these instants [rad].
        places: (M, K, 3) of the lamps, base frame [m].
        eye: (3,) of the camera [m].
        lit: (M,) when any lamp is on. Otherwise no ray is cast, and the share is 1.
    """
    seen = np.ones(places.shape[:2])
    rows = np.flatnonzero(lit)
    if len(rows) == 0:
        return seen
    tried = np.zeros(len(lit), dtype=bool)

    def ask(rows: NDArray[np.int64]) -> None:
        start, end = _rays(places[rows], eye)
        seen[rows] = ~caster.blocked(postures[rows], start, end)
        tried[rows] = True

    ask(_instants(postures, places, rows))
    while True:
        known = np.flatnonzero(tried)
        apart = np.diff(known) > 1
        differ = (seen[known[1:]] != seen[known[:-1]]).any(axis=1)
        middle = ((known[1:] + known[:-1]) // 2)[apart & differ]
        middle = middle[lit[middle]]
        if len(middle) == 0:
            break
        ask(middle)
    return _interpolated(seen, tried, lit)


def _instants(postures: Floats, places: Floats, rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """The rows to test: both ends of each lit run, and sufficiently small steps within it."""
    way = np.sqrt((np.diff(places, axis=0) ** 2).sum(axis=2)).max(axis=1) / LONGEST_LAMP_STEP
    turn = np.abs(np.diff(postures, axis=0)).sum(axis=1) / LARGEST_TURN
    gone = np.concatenate([[0.0], np.cumsum(np.maximum(way, turn))])[rows]
    begins = np.diff(rows, prepend=-2) > 1
    ends = np.append(begins[1:], True)
    first = np.flatnonzero(begins)[np.cumsum(begins) - 1]  # of the run each row is in
    cell = np.floor(gone - gone[first])
    short = np.diff(cell, prepend=-1.0) > 0.0
    return np.asarray(rows[begins | ends | short])


def _rays(places: Floats, eye: Floats) -> tuple[Floats, Floats]:
    """Ray starts near positions (..., K, 3), towards the eye."""
    way = eye - places
    length = np.sqrt((way * way).sum(axis=-1, keepdims=True))
    start = places + way * (CLEARANCE / np.maximum(length, CLEARANCE))
    return start, np.broadcast_to(eye, places.shape)


def _interpolated(seen: Floats, tried: NDArray[np.bool_], lit: NDArray[np.bool_]) -> Floats:
    """Interpolate untested rows between their neighbours in the same lit run."""
    known = np.flatnonzero(tried)
    rows = np.arange(len(tried))
    filled = np.stack([np.interp(rows, known, column[known]) for column in seen.T], axis=1)
    filled[~lit] = 1.0
    return filled
