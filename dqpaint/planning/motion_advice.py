"""Motion, a time and what ails it there -> the changes to the drawing that it does not have yet."""

import numpy as np

from dqpaint.motion import Motion
from dqpaint.program import PiecewiseCurve, Profile, Segment

SMOOTHEST = "quintic"
PART_OF_ENDS = 0.2  # of a stroke's time, at each end: there a profile speeds up, or brakes


def advise(motion: Motion, time: float, slowed: bool) -> str:
    """What would lower the torque that the motion needs at a time.

    Args:
        motion: as it will be run.
        time: [s] of the row that needs too much.
        slowed: it has been retimed already, as far as that helps.
    """
    segments = motion.program.segments
    row = round(time / motion.period)
    strokes = motion.stroke[max(row - 1, 0) : row + 1]
    around = [segments[int(number)] for number in np.unique(strokes)]
    ways = ["draw it slower", *_softer(around, _at_an_end(motion, row))]
    if not slowed:
        ways.append("let --on-limit slow find a pace")
    return ", or ".join(ways)


def _softer(around: list[Segment], at_an_end: bool) -> list[str]:
    """Other corners and profiles, where they would change anything."""
    # with an acceleration a segment slows down for its corners, as the arm can bear it
    alone = [segment for segment in around if segment.profile.acceleration == 0.0]
    if any(_runs_through_corners(one) and (one.jumps or not at_an_end) for one in alone):
        return ["write corner 0.1 mm, which slows down for corners"]
    if any(_begins_at_once(one.profile) for one in alone):
        return ["write profile trapezoid, which starts and ends at rest"]
    if at_an_end and any(one.profile.name != SMOOTHEST for one in alone):
        return [f"write profile {SMOOTHEST}, which starts and ends more gently"]
    return []


def _runs_through_corners(segment: Segment) -> bool:
    return segment.stroke is not None or isinstance(segment.path, PiecewiseCurve)


def _begins_at_once(profile: Profile) -> bool:
    return profile.name == "constant" or bool(profile.rates)


def _at_an_end(motion: Motion, row: int) -> bool:
    """Whether a row belongs to where its stroke, or run of segments, speeds up or brakes."""
    strokes = _runs(motion)
    its = np.flatnonzero(strokes == strokes[row])
    share = (row - its[0]) / max(len(its), 1)
    return not PART_OF_ENDS < share < 1.0 - PART_OF_ENDS


def _runs(motion: Motion) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """The stroke of each row (N,), where the segments of a `stroke` are one."""
    numbers = [
        -1 - segment.stroke.number if segment.stroke else index
        for index, segment in enumerate(motion.program.segments)
    ]
    return np.asarray(numbers, dtype=np.intp)[motion.stroke]
