"""A picture -> hatching: parallel lines to and fro, without lifting the light."""

import numpy as np

from dqpaint.core.arrays import Floats
from dqpaint.photo.subject import STYLES, Subject
from dqpaint.program import PiecewiseCurve, piecewise

TURN = 1.0
"""How far a turn from line to line bulges out, in distances between lines."""
LONGEST_TURN = 4.0
"""A longer way from line to line is a dark move [distances between lines]."""
SAMPLES = 3
"""Places a distance between lines at which a line looks for light."""


@STYLES.add("hatch")
def hatch(subject: Subject) -> list[PiecewiseCurve]:
    """Parallel lines, `detail` apart, from the first to the last light on each."""
    angles = [subject.angle, subject.angle + 0.5 * np.pi] if subject.cross else [subject.angle]
    return [curve for angle in angles for curve in _set(subject, angle)]


def _set(subject: Subject, angle: float) -> list[PiecewiseCurve]:
    """The lines of one direction, joined by turns where they are near each other."""
    along = np.array([np.cos(angle), np.sin(angle)])
    across = np.array([along[1], -along[0]])  # the first line is the topmost
    half = 0.5 * np.array([subject.width, subject.height])
    reach = float(np.abs(across) @ half)
    count = max(1, round(2.0 * reach / subject.detail))
    gap = 2.0 * reach / count
    made: list[list[Floats]] = []
    forward = True
    for number in range(count):
        foot = (-reach + (number + 0.5) * gap) * across
        ends = _lit_ends(subject, foot, along, half, gap / SAMPLES)
        if ends is None:
            continue
        line = np.array([foot + ends[0] * along, foot + ends[1] * along])
        line = line if forward else line[::-1]
        near = made and np.linalg.norm(line[0] - made[-1][-1][-1]) <= LONGEST_TURN * gap
        if near:
            way = (TURN * gap) * (along if not forward else -along)
            last = made[-1][-1][-1]
            made[-1].append(np.array([last, last + way, line[0] + way, line[0]]))
            made[-1].append(line)
        else:
            made.append([line])
        forward = not forward
    return [_curve(pieces) for pieces in made]


def _lit_ends(
    subject: Subject, foot: Floats, along: Floats, half: Floats, step: float
) -> tuple[float, float] | None:
    """Where the first and the last light on a line is, from its foot [m]; None if it is dark."""
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (-half - foot) / along, (half - foot) / along
    steady = along == 0.0
    low = float(np.where(steady, -np.inf, np.minimum(one, other)).max())
    high = float(np.where(steady, np.inf, np.maximum(one, other)).min())
    if not high - low > step:
        return None
    at = np.linspace(low, high, max(2, int(np.ceil((high - low) / step)) + 1))
    lit = np.flatnonzero(subject.is_lit(foot + at[:, None] * along))
    if not len(lit):
        return None
    first, last = max(lit[0] - SAMPLES, 0), min(lit[-1] + SAMPLES, len(at) - 1)
    return float(at[first]), float(at[last])


def _curve(pieces: list[Floats]) -> PiecewiseCurve:
    """Lines and turns (2 or 4, 2) in order, as one curve."""
    cubic = np.zeros((len(pieces), 4, 3))
    for size in (2, 4):
        own = [number for number, piece in enumerate(pieces) if len(piece) == size]
        if own:
            control = np.array([pieces[number] for number in own])
            cubic[own, :, :2] = piecewise.coefficients(control)
    return piecewise.cubics(cubic)
