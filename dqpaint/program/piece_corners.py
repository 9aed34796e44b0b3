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
    batches,
    derivatives,
    is_nonuniform,
    parameters_at,
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

_Sides = tuple[Indices, Floats]  # the piece (K,) and its parameter (K,)


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
    tip = derivatives(whole, corners.piece, np.zeros(len(corners.piece)))[0]
    left, right, curves, straight = _cut(whole, bent, size, ends, corners.piece, corners.reach)
    loose = np.flatnonzero(~straight)  # between straight lines the distance is exact
    for _ in range(0 if distance else TRIES):
        loose = loose[_distances(curves, loose, tip[loose]) > deviation * (1.0 + 1e-6)]
        if not len(loose):
            break
        corners.reach[loose] *= CLOSER
        closer = _cut(whole, bent, size, ends, corners.piece[loose], corners.reach[loose])
        for old, new in zip((*left, *right), (*closer[0], *closer[1]), strict=True):
            old[loose] = new
        for name in ("cubic", "ellipse", "angles"):
            getattr(curves, name)[loose] = getattr(closer[2], name)
    return _assembled(whole, starts, size, corners.piece, left, right, curves)


def _cut(
    whole: PiecewiseCurve,
    bent: NDArray[np.bool_],
    size: Floats,
    ends: Floats,
    corner: Indices,
    reach: Floats,
) -> tuple[_Sides, _Sides, PiecewiseCurve, NDArray[np.bool_]]:
    """Where the curves of corners begin and end, the curves, and which are between lines."""
    left = _piece_at(whole, bent, size, ends, corner, -reach)
    right = _piece_at(whole, bent, size, ends, corner, reach)
    straight = (left[0] == corner - 1) & (right[0] == corner)
    straight &= ~bent[left[0]] & ~bent[right[0]] & ~_round(whole, left[0], right[0])
    return left, right, _curves(whole, left, right, straight), straight


def _distances(curves: PiecewiseCurve, some: Indices, tip: Floats) -> Floats:
    """The least distances of some Bezier curves (K,) from points (K, 3)."""
    out = np.empty(len(some))
    for own in batches(len(some)):
        way = LOOKS[:, None] ** np.arange(4) @ curves.cubic[some[own]] - tip[own, None]
        out[own] = np.linalg.norm(way, axis=2).min(axis=1)
    return out


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
    turn = _angles(a, b)
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
    way = np.empty((len(size), 3))
    for own in batches(len(size)):
        way[own] = derivatives(whole, every[own], np.full(len(every[own]), g))[1]
    rest = np.flatnonzero(np.linalg.norm(way, axis=1) <= REST * size)
    if len(rest):
        way[rest] = derivatives(whole, rest, np.full(len(rest), abs(g - BESIDE)))[1]
    norm = np.linalg.norm(way, axis=1, keepdims=True)
    return np.asarray(way / np.where(norm > 0.0, norm, 1.0))


def _angles(a: Floats, b: Floats) -> Floats:
    """The angles (K,) between directions (K, 3)."""
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(1)))


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
    bounds = np.zeros(len(piece)), np.ones(len(piece))
    return piece, parameters_at(whole, bent, piece, bounds, wanted / size[piece], wanted)


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
    turn = _angles(out, into)[:, None]
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
    order = np.argsort(np.concatenate([kept, corner - 0.5]), kind="stable")
    curve_of = np.searchsorted(starts, np.concatenate([kept, corner - 1]), side="right")[order]
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    of_kept, of_curves = place[: len(kept)], place[len(kept) :]
    count = len(order)
    made = PiecewiseCurve(np.empty((count, 4, 3)), np.empty((count, 2, 3)), np.empty((count, 2)))
    for own in batches(len(kept)):
        some, to = kept[own], of_kept[own]
        g, width = lower[some, None], (upper - lower)[some, None]
        c0, c1, c2, c3 = whole.cubic[some].transpose(1, 0, 2)
        made.cubic[to, 0] = c0 + g * (c1 + g * (c2 + g * c3))
        made.cubic[to, 1] = width * (c1 + g * (2.0 * c2 + 3.0 * g * c3))
        made.cubic[to, 2] = width**2 * (c2 + 3.0 * g * c3)
        made.cubic[to, 3] = width**3 * c3
        start, turn = whole.angles[some].T
        made.angles[to, 0], made.angles[to, 1] = start + g[:, 0] * turn, width[:, 0] * turn
        made.ellipse[to] = whole.ellipse[some]
    for name in ("cubic", "ellipse", "angles"):
        getattr(made, name)[of_curves] = getattr(curves, name)
    return made, np.searchsorted(curve_of, np.arange(1, len(starts) + 1))
