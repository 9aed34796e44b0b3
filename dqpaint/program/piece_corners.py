"""Piecewise curves with corners -> the same, each corner replaced by an arc or a Bezier curve.

An arc that touches both sides of a corner of the turn t at the distance c from it is c / tan(t / 4)
... c tan(t / 4) away from the corner: a deviation d needs c = d / tan(t / 4). Between two straight
lines it is the arc; otherwise the cubic Bezier curve that would be nearest to it. A corner takes at
most half of the smooth stretch on either side, so that two of them never meet.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dqpaint.program.piecewise import (
    Indices,
    derivatives,
    is_nonuniform,
    stretch_lengths,
)
from dqpaint.program.program import PiecewiseCurve
from dqpaint.program.taylor import Floats

NO_CORNER = 1e-3  # [rad]: a turn of the direction below it is smooth
BACK = 1e-3  # [rad] from a half turn: the way turns back, and no arc rounds it
REST = 1e-6  # of a piece's mean speed: below it the piece is at rest there
BESIDE = 1e-4  # where its direction is taken instead
GONE = 1e-9  # of its length: what is left of a piece that is not kept
CLOSER, TRIES = 0.9, 8  # of a corner between bent pieces that is too far from the curve
LOOKS = np.linspace(0.0, 1.0, 33)


@dataclass(frozen=True)
class _Corners:
    """Corners (K) of pieces, and where their curves begin and end.

    Attributes:
        piece: the piece that begins at each.
        turn: of the direction there [rad].
        reach: how far from it a curve may begin and end, along the pieces [m].
    """

    piece: Indices
    turn: Floats
    reach: Floats


def rounded(
    whole: PiecewiseCurve, starts: Indices, deviation: float, distance: float = 0.0
) -> tuple[PiecewiseCurve, Indices]:
    """Concatenated pieces with rounded corners, and the first piece of each curve.

    Args:
        whole: the pieces (M).
        starts: the first piece of each curve.
        deviation: how far a curve may be from the corner [m], where `distance` is 0.
        distance: within what distance of a corner it is rounded [m].
    """
    count = len(whole.cubic)
    bent = is_nonuniform(whole)
    every = np.arange(count)
    size = stretch_lengths(whole, bent, every, np.zeros(count), np.ones(count))
    ends = np.cumsum(size)
    corners = _find(whole, starts, size, ends, deviation, distance)
    if not len(corners.piece):
        return whole, starts
    cut = corners.reach
    tip = derivatives(whole, corners.piece, np.zeros(len(cut)))[0]
    for _ in range(TRIES):
        left = _piece_at(whole, bent, size, ends, corners.piece, -cut)
        right = _piece_at(whole, bent, size, ends, corners.piece, cut)
        straight = (left[0] == corners.piece - 1) & (right[0] == corners.piece)
        straight &= ~bent[left[0]] & ~bent[right[0]] & ~_round(whole, left[0], right[0])
        curves = _curves(whole, left, right, straight)
        (loose,) = np.nonzero(~straight)  # between straight lines the distance is exact
        if distance or not len(loose):
            break
        at = derivatives(curves, np.repeat(loose, len(LOOKS)), np.tile(LOOKS, len(loose)))[0]
        way = at.reshape(len(loose), -1, 3) - tip[loose, None]
        far = loose[np.linalg.norm(way, axis=2).min(axis=1) > deviation * (1.0 + 1e-6)]
        if not len(far):
            break
        cut[far] *= CLOSER
    return _assembled(whole, starts, size, corners.piece, left, right, curves)


def _find(
    whole: PiecewiseCurve,
    starts: Indices,
    size: Floats,
    ends: Floats,
    deviation: float,
    distance: float,
) -> _Corners:
    """The corners that can be rounded."""
    out, into = _tangents(whole, size, 1.0), _tangents(whole, size, 0.0)
    inner = np.delete(np.arange(len(size)), starts)
    a, b = out[inner - 1], into[inner]
    turn = np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(1))
    sharp = turn > NO_CORNER
    breaks = np.union1d(starts, inner[sharp])
    before = ends - size
    run = np.diff(np.append(before[breaks], ends[-1]))
    of_run = np.searchsorted(breaks, inner[sharp])
    room = 0.5 * np.minimum(run[of_run], run[of_run - 1])
    piece, turn = inner[sharp], turn[sharp]
    want = np.full(len(piece), distance) if distance else deviation / np.tan(0.25 * turn)
    some = turn < np.pi - BACK
    return _Corners(piece[some], turn[some], np.minimum(want, room)[some])


def _tangents(whole: PiecewiseCurve, size: Floats, g: float) -> Floats:
    """The directions (M, 3) at one end of each piece, or beside it where a piece is at rest."""
    every = np.arange(len(size))
    way = derivatives(whole, every, np.full(len(size), g))[1]
    rest = np.flatnonzero(np.linalg.norm(way, axis=1) <= REST * size)
    if len(rest):
        way[rest] = derivatives(whole, rest, np.full(len(rest), abs(g - BESIDE)))[1]
    norm = np.linalg.norm(way, axis=1, keepdims=True)
    return np.asarray(way / np.where(norm > 0.0, norm, 1.0))


def _piece_at(
    whole: PiecewiseCurve,
    bent: NDArray[np.bool_],
    size: Floats,
    ends: Floats,
    corner: Indices,
    way: Floats,
) -> tuple[Indices, Floats]:
    """The piece (K,) and its parameter (K,) at distances (K,) from corners, before or after."""
    begins = ends - size
    at = begins[corner] + way
    if (way < 0.0).all():
        piece = np.minimum(np.searchsorted(ends, at, side="left"), corner - 1)
    else:
        piece = np.maximum(np.searchsorted(begins, at, side="right") - 1, corner)
    wanted = np.clip(at - begins[piece], 0.0, size[piece])
    g = wanted / size[piece]
    lower, upper = np.zeros(len(g)), np.ones(len(g))
    hard = np.flatnonzero(bent[piece])
    for _ in range(60 if len(hard) else 0):
        so_far = stretch_lengths(whole, bent, piece[hard], np.zeros(len(hard)), g[hard])
        beyond = so_far > wanted[hard]
        upper[hard] = np.where(beyond, g[hard], upper[hard])
        lower[hard] = np.where(beyond, lower[hard], g[hard])
        g[hard] = 0.5 * (lower[hard] + upper[hard])
    return piece, g


def _round(whole: PiecewiseCurve, *pieces: Indices) -> NDArray[np.bool_]:
    """Whether one of some pieces (K,) is an arc."""
    return np.asarray(np.any([whole.angles[piece, 1] != 0.0 for piece in pieces], axis=0))


def _curves(
    whole: PiecewiseCurve,
    left: tuple[Indices, Floats],
    right: tuple[Indices, Floats],
    straight: NDArray[np.bool_],
) -> PiecewiseCurve:
    """The curve round each corner (K), from a place before it to one after it."""
    (start, out), (end, into) = (derivatives(whole, *side)[:2] for side in (left, right))
    out, into = (v / np.linalg.norm(v, axis=1, keepdims=True) for v in (out, into))
    turn = np.arctan2(np.linalg.norm(np.cross(out, into), axis=1), (out * into).sum(1))[:, None]
    chord = np.linalg.norm(end - start, axis=1)[:, None]
    handle = chord / np.cos(0.25 * turn) ** 2
    cubic = np.zeros((len(start), 4, 3))
    cubic[:, 0], cubic[:, 1] = start, handle * out
    cubic[:, 2] = 3.0 * (end - start) - handle * (2.0 * out + into)
    cubic[:, 3] = handle * (out + into) - 2.0 * (end - start)
    ellipse, angles = np.zeros((len(start), 2, 3)), np.zeros((len(start), 2))
    normal = into - (into * out).sum(1, keepdims=True) * out  # towards the centre
    normal = normal[straight] / np.linalg.norm(normal[straight], axis=1, keepdims=True)
    radius = 0.5 * chord[straight] / np.sin(0.5 * turn[straight])
    cubic[straight] = 0.0
    cubic[straight, 0] = start[straight] + radius * normal
    ellipse[straight, 0], ellipse[straight, 1] = -radius * normal, radius * out[straight]
    angles[straight, 1] = turn[straight, 0]
    return PiecewiseCurve(cubic, ellipse, angles)


def _assembled(
    whole: PiecewiseCurve,
    starts: Indices,
    size: Floats,
    corner: Indices,
    left: tuple[Indices, Floats],
    right: tuple[Indices, Floats],
    curves: PiecewiseCurve,
) -> tuple[PiecewiseCurve, Indices]:
    """What is left of the pieces, with the curves between them."""
    lower, upper = np.zeros(len(size)), np.ones(len(size))
    upper[left[0]], lower[right[0]] = left[1], right[1]
    gone = np.zeros(len(size) + 1, dtype=np.intp)
    for begin, end in ((left[0] + 1, corner), (corner, right[0])):
        np.add.at(gone, begin, 1)
        np.add.at(gone, end, -1)
    kept = np.flatnonzero((np.cumsum(gone[:-1]) == 0) & (upper - lower > GONE))
    g, width = lower[kept, None], (upper - lower)[kept, None]
    c0, c1, c2, c3 = whole.cubic[kept].transpose(1, 0, 2)
    cubic = np.stack([
        c0 + g * (c1 + g * (c2 + g * c3)),
        width * (c1 + g * (2.0 * c2 + 3.0 * g * c3)),
        width**2 * (c2 + 3.0 * g * c3),
        width**3 * c3,
    ], axis=1)  # fmt: skip
    start, turn = whole.angles[kept].T
    angles = np.stack([start + g[:, 0] * turn, width[:, 0] * turn], axis=1)
    order = np.argsort(np.concatenate([kept, corner - 0.5]), kind="stable")
    curve_of = np.searchsorted(starts, np.concatenate([kept, corner - 1]), side="right")[order]
    made = PiecewiseCurve(
        np.concatenate([cubic, curves.cubic])[order],
        np.concatenate([whole.ellipse[kept], curves.ellipse])[order],
        np.concatenate([angles, curves.angles])[order],
    )
    return made, np.searchsorted(curve_of, np.arange(1, len(starts) + 1))
