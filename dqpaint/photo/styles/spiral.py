"""A picture -> a spiral from its middle outwards: one line, without lifting the light."""

import numpy as np

from dqpaint.core.arrays import Floats
from dqpaint.photo.subject import STYLES, Subject
from dqpaint.program import PiecewiseCurve, piecewise

TURN = np.radians(2.5)
"""Angle of one piece: short enough to end near the edge of a picture, and not to skip a corner."""
LONGEST_DARK = 6.0
"""What is dark for longer is a dark move and not part of a stroke [distances between turns]."""
SAMPLES = 4


@STYLES.add("spiral")
def spiral(subject: Subject) -> list[PiecewiseCurve]:
    """One spiral, its turns `detail` apart."""
    growth = subject.detail / (2.0 * np.pi)
    outermost = subject.detail + 0.5 * float(np.hypot(subject.width, subject.height))
    count = max(2, int(np.ceil(outermost / growth / TURN)))
    angle = subject.angle + TURN * np.arange(count + 1)
    radius = growth * (angle - subject.angle)
    way = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    point = radius[:, None] * way
    slope = TURN * (growth * way + radius[:, None] * np.stack([-way[:, 1], way[:, 0]], axis=1))
    control = np.stack(
        [point[:-1], point[:-1] + slope[:-1] / 3.0, point[1:] - slope[1:] / 3.0, point[1:]], axis=1
    )
    return lit_runs(subject, control)


def lit_runs(subject: Subject, control: Floats) -> list[PiecewiseCurve]:
    """The parts of a line of Bezier pieces (M, 4, 2) where light is wanted, a curve each."""
    cubic = np.zeros((len(control), 4, 3))
    cubic[:, :, :2] = piecewise.coefficients(control)
    share = ((np.arange(SAMPLES) + 0.5) / SAMPLES)[:, None, None]
    c0, c1, c2, c3 = cubic[:, :, :2].transpose(1, 0, 2)
    at = c0 + share * (c1 + share * (c2 + share * c3))
    half = 0.5 * np.array([subject.width, subject.height])
    inside = (np.abs(at) <= half).all(axis=2)
    lit = (inside & subject.is_lit(at.reshape(-1, 2)).reshape(inside.shape)).any(axis=0)
    size = np.linalg.norm(control[:, 3] - control[:, 0], axis=1)
    runs: list[slice] = []
    for piece in np.flatnonzero(lit).tolist():
        dark = slice(runs[-1].stop, piece) if runs else slice(0, 0)
        if runs and float(size[dark].sum()) <= LONGEST_DARK * subject.detail:
            runs[-1] = slice(runs[-1].start, piece + 1)
        else:
            runs.append(slice(piece, piece + 1))
    return [piecewise.cubics(cubic[run]) for run in runs]
