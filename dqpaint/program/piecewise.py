"""Points, Bezier curves and arcs -> piecewise curves, which can be joined and transformed.

A curve that comes from a file has its coordinates in the file's own unit until it is mapped into
the drawing frame. `program.PiecewiseCurve` defines the numbers of a piece.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from dqpaint.program.program import PiecewiseCurve, Vector
from dqpaint.program.taylor import Floats

NODES, WEIGHTS = np.polynomial.legendre.leggauss(10)
CIRCLE_TOLERANCE = 1e-14  # an ellipse whose radii differ by less, in their squares, is a circle
BATCH = 10_000  # pieces, for the sake of memory
CORNER_ANGLE = np.radians(60.0)  # a smooth curve has a corner where it turns by more than this

Indices = NDArray[np.intp]


def batches(count: int) -> Iterator[slice]:
    """So many rows in batches, for the sake of memory."""
    yield from (slice(begin, begin + BATCH) for begin in range(0, count, BATCH))


def derivatives(curve: PiecewiseCurve, piece: Indices, g: Floats) -> Floats:
    """Positions (4, N, 3) and derivatives over g of pieces (N,) at their parameters (N,)."""
    c0, c1, c2, c3 = curve.cubic[piece].transpose(1, 0, 2)
    h = g[:, None]
    out = np.stack([
        c0 + h * (c1 + h * (c2 + h * c3)),
        c1 + h * (2.0 * c2 + 3.0 * h * c3),
        2.0 * c2 + 6.0 * h * c3,
        6.0 * c3,
    ])  # fmt: skip
    ellipse = curve.ellipse[piece]
    (arcs,) = np.nonzero(ellipse.any(axis=(1, 2)))
    if len(arcs):
        u, v = ellipse[arcs].transpose(1, 0, 2)
        start, turn = curve.angles[piece[arcs]].T[:, :, None]
        c, s = (wave(start + h[arcs] * turn) for wave in (np.cos, np.sin))
        outward, along = c * u + s * v, c * v - s * u
        out[0, arcs] += outward
        out[1, arcs] += turn * along
        out[2, arcs] -= turn**2 * outward
        out[3, arcs] -= turn**3 * along
    return out


def speeds(curve: PiecewiseCurve, piece: Indices, g: Floats) -> Floats:
    """Norms (N, K) of the first derivatives of pieces (N,) at their parameters (N, K)."""
    c1, c2, c3 = curve.cubic[piece, 1:].transpose(1, 2, 0)[:, :, :, None]  # (3, N, 1) each
    u, v = curve.ellipse[piece].transpose(1, 2, 0)[:, :, :, None]
    start, turn = curve.angles[piece].T[:, :, None]
    (arcs,) = np.nonzero(turn[:, 0])
    if len(arcs):
        a = start[arcs] + g[arcs] * turn[arcs]
        c, s = turn[arcs] * np.cos(a), turn[arcs] * np.sin(a)
    square = np.zeros_like(g)
    for axis in range(3):
        way = c1[axis] + g * (2.0 * c2[axis] + 3.0 * g * c3[axis])
        if len(arcs):
            way[arcs] += c * v[axis, arcs] - s * u[axis, arcs]
        square += way * way
    return np.asarray(np.sqrt(square))


# Made.


def cubics(cubic: Floats) -> PiecewiseCurve:
    """Pieces without arcs, from their c0 to c3 (M, 4, 3)."""
    none = np.zeros(())  # no arcs, without room for each
    count = len(cubic)
    return PiecewiseCurve(
        cubic, np.broadcast_to(none, (count, 2, 3)), np.broadcast_to(none, (count, 2))
    )


def straight(points: Floats) -> PiecewiseCurve:
    """Straight lines between consecutive points (N, 3); no two of them may be equal."""
    cubic = np.zeros((len(points) - 1, 4, 3))
    cubic[:, 0], cubic[:, 1] = points[:-1], np.diff(points, axis=0)
    return cubics(cubic)


def bezier(points: Floats) -> PiecewiseCurve:
    """One Bezier curve from its 3 or 4 control points."""
    return cubics(coefficients(points[None]))


def coefficients(control: Floats) -> Floats:
    """c0 to c3 (M, 4, D) of Bezier curves with control points (M, P, D), P = 2 to 4."""
    p0, *handles, p3 = control.transpose(1, 0, 2)
    if not handles:
        return np.stack([p0, p3 - p0, np.zeros_like(p0), np.zeros_like(p0)], axis=1)
    p1, p2 = handles[0], handles[-1]
    if len(handles) == 1:
        p1, p2 = (p0 + 2.0 * p1) / 3.0, (2.0 * p1 + p3) / 3.0
    c1, c2 = 3.0 * (p1 - p0), 3.0 * (p2 - 2.0 * p1 + p0)
    return np.stack([p0, c1, c2, p3 - p0 - c1 - c2], axis=1)


def arc(centre: Floats, u: Floats, v: Floats, start: float, turn: float) -> PiecewiseCurve:
    """An arc of the ellipse centre + u cos(a) + v sin(a), from a = start over `turn` [rad]."""
    cubic = np.zeros((1, 4, 3))
    cubic[0, 0] = centre
    return PiecewiseCurve(cubic, np.array([[u, v]]), np.array([[start, turn]]))


def smooth_curve(
    points: Floats, keep: NDArray[np.bool_] | None = None, stiff: float = np.inf
) -> PiecewiseCurve:
    """A curve through points (N, 3), smooth except at sharp turns.

    The direction at a point is that of the circle through it and its neighbours; between two
    points runs the Bezier curve that is next to a circular arc. Lines to a corner, and to the
    ends, are bent as their other end requires.

    Args:
        points: (N, 3), N at least 2, none of them the same as the next.
        keep: points (N,) that keep their corner; by default turns above `CORNER_ANGLE`.
        stiff: a line so many times longer than its neighbour stays straight.
    """
    way = np.diff(points, axis=0)
    size = np.linalg.norm(way, axis=1)
    u = way / size[:, None]
    closed = len(points) > 3 and bool((points[0] == points[-1]).all())
    if keep is None:
        keep = turn_angles(points) > CORNER_ANGLE
    keep = keep.copy()
    if not closed:
        keep[[0, -1]] = True
    tangent = _tangents(u, size[:, None], stiff)
    keep |= ~tangent.any(axis=1)
    cubic = np.empty((len(way), 4, 3))
    cubic[:, 0] = points[:-1]
    t0, t1, free0, free1 = tangent[:-1], tangent[1:], keep[:-1], keep[1:]
    for begin in range(0, len(way), BATCH):
        own = slice(begin, begin + BATCH)
        turned = t0[own], t1[own], free0[own], free1[own]
        cubic[own, 1:] = _bend(way[own], u[own], size[own], *turned)
    return cubics(cubic)


def _tangents(u: Floats, size: Floats, stiff: float) -> Floats:
    """Tangents (N, 3) at points between lines along u (N - 1, 3); zero if there is none."""
    before, after = np.roll(u, 1, axis=0), u  # at the points but the last
    l0, l1 = np.roll(size, 1), size
    tangent = before * l1 + after * l0
    tangent = np.where(l0 > stiff * l1, before, np.where(l1 > stiff * l0, after, tangent))
    tangent = np.concatenate([tangent, tangent[:1]])
    norm = np.linalg.norm(tangent, axis=1, keepdims=True)
    return np.asarray(tangent / np.where(norm > 0.0, norm, 1.0))


def _bend(
    way: Floats,
    u: Floats,
    size: Floats,
    t0: Floats,
    t1: Floats,
    free0: NDArray[np.bool_],
    free1: NDArray[np.bool_],
) -> Floats:
    """c1 to c3 (N, 3, 3) of lines bent from tangent t0 to t1, where the tangents are not free."""
    mirrored0, mirrored1 = _mirrored(t1, u), _mirrored(t0, u)
    t0 = np.where(free0[:, None], np.where(free1[:, None], u, mirrored0), t0)
    t1 = np.where(free1[:, None], np.where(free0[:, None], u, mirrored1), t1)
    first, last = (size[:, None] / (0.5 + 0.5 * (t * u).sum(1))[:, None] * t for t in (t0, t1))
    out = np.stack([first, 3.0 * way - 2.0 * first - last, first + last - 2.0 * way], axis=1)
    straight = np.maximum(np.abs(t0 - u).max(1), np.abs(t1 - u).max(1)) <= 1e-9
    out[straight, 0], out[straight, 1:] = way[straight], 0.0
    return out


def _mirrored(t: Floats, u: Floats) -> Floats:
    """The tangent at the other end of a circular arc whose chord has the direction u."""
    return np.asarray(2.0 * (t * u).sum(1, keepdims=True) * u - t)


def turn_angles(points: Floats) -> Floats:
    """The turn [rad] of a polyline at each point (N,), including the ends of a closed one."""
    u = np.diff(points, axis=0)
    u = u / np.linalg.norm(u, axis=1, keepdims=True)
    before = np.roll(u, 1, axis=0)
    angle = np.arctan2(np.linalg.norm(np.cross(before, u), axis=1), (before * u).sum(1))
    return np.concatenate([angle, angle[:1]])


# Changed.


def join(curves: Sequence[PiecewiseCurve]) -> PiecewiseCurve:
    """Join consecutive curves into one; the start of each is moved to the end before it."""
    if len(curves) == 1:
        return curves[0]
    whole, first, _ = concatenate(curves)
    _move(whole, first[1:])
    return whole


def link_pieces(whole: PiecewiseCurve, starts: Indices) -> None:
    """Move the start of each piece to the end before it, except at the start of a curve."""
    _move(whole, np.delete(np.arange(len(whole.cubic)), starts))


def _move(whole: PiecewiseCurve, heads: Indices) -> None:
    """Move the starts of pieces to the ends before them."""
    gap = _at(whole, heads - 1, 1.0) - _at(whole, heads, 0.0)
    whole.cubic[heads, 0] += gap
    whole.cubic[heads, 1] -= gap


def reverse(curve: PiecewiseCurve) -> PiecewiseCurve:
    """The same curve in the opposite direction."""
    c0, c1, c2, c3 = curve.cubic[::-1].transpose(1, 0, 2)
    cubic = np.stack([c0 + c1 + c2 + c3, -(c1 + 2.0 * c2 + 3.0 * c3), c2 + 3.0 * c3, -c3], axis=1)
    start, turn = curve.angles[::-1].T
    return PiecewiseCurve(
        cubic, curve.ellipse[::-1].copy(), np.stack([start + turn, -turn], axis=1)
    )


def transform(curve: PiecewiseCurve, matrix: Floats, shift: Floats) -> PiecewiseCurve:
    """The curve with every point p mapped to matrix (3, 3) p + shift (3,); overflow gives inf."""
    with np.errstate(over="ignore", invalid="ignore"):
        cubic = curve.cubic @ matrix.T
        cubic[:, 0] += shift
        arcs = curve.ellipse.any()
        return PiecewiseCurve(
            cubic, curve.ellipse @ matrix.T if arcs else curve.ellipse, curve.angles
        )


def largest_coordinate(curves: Sequence[PiecewiseCurve]) -> float:
    """The largest absolute number of all pieces [m]; NaN if one of them is NaN."""
    whole = concatenate(curves)[0]
    parts = whole.cubic, whole.ellipse
    return float(max(max(part.max(), -part.min()) for part in parts))


# Measured.


def _at(curve: PiecewiseCurve, piece: Indices, g: float) -> Floats:
    """Points (N, 3) of pieces at one common parameter."""
    places = np.array([1.0, g, g**2, g**3]) @ curve.cubic[piece]
    (arcs,) = np.nonzero(curve.ellipse[piece].any(axis=(1, 2)))
    a = curve.angles[piece[arcs]] @ [1.0, g]
    waves = np.stack([np.cos(a), np.sin(a)], axis=1)
    places[arcs] += (waves[:, :, None] * curve.ellipse[piece[arcs]]).sum(axis=1)
    return np.asarray(places)


def ends(curve: PiecewiseCurve) -> tuple[Vector, Vector]:
    """The first and the last point of a curve."""
    first, last = all_ends([curve])[0].tolist()
    return (first[0], first[1], first[2]), (last[0], last[1], last[2])


def all_ends(curves: Sequence[PiecewiseCurve]) -> Floats:
    """The first and the last points (N, 2, 3) of many curves."""
    whole, first, last = concatenate(curves)
    return np.stack([_at(whole, first, 0.0), _at(whole, last, 1.0)], axis=1)


def directions(curves: Sequence[PiecewiseCurve]) -> Floats:
    """Unit vectors (N, 2, 3) from the start and from the end into each curve."""
    whole, *pieces = concatenate(curves)
    ways = [
        sign * derivatives(whole, piece, np.full(len(piece), g))[1]
        for piece, g, sign in zip(pieces, (1e-3, 1.0 - 1e-3), (1.0, -1.0), strict=True)
    ]
    out = np.stack(ways, axis=1)
    norm = np.linalg.norm(out, axis=2, keepdims=True)
    return np.asarray(out / np.where(norm > 0.0, norm, 1.0))


def concatenate(curves: Sequence[PiecewiseCurve]) -> tuple[PiecewiseCurve, Indices, Indices]:
    """All pieces of many curves, with the first and the last piece of each."""
    whole = curves[0]
    if len(curves) > 1:  # else it is there already, and may be long
        whole = PiecewiseCurve(
            np.concatenate([curve.cubic for curve in curves]),
            np.concatenate([curve.ellipse for curve in curves]),
            np.concatenate([curve.angles for curve in curves]),
        )
    stop = np.cumsum([len(curve.cubic) for curve in curves])
    return whole, np.concatenate([[0], stop[:-1]]), stop - 1


def split(whole: PiecewiseCurve, starts: Indices) -> Iterator[PiecewiseCurve]:
    """The curves of concatenated pieces, from the first piece of each; they share its arrays."""
    ends = [*starts[1:].tolist(), len(whole.cubic)]
    for own in map(slice, starts.tolist(), ends):
        yield PiecewiseCurve(whole.cubic[own], whole.ellipse[own], whole.angles[own])


def lengths(curves: Sequence[PiecewiseCurve]) -> list[float]:
    """The lengths of curves, exact enough to distribute time and colour."""
    whole, first, _ = concatenate(curves)
    every = np.arange(len(whole.cubic))
    size = stretch_lengths(
        whole, is_nonuniform(whole), every, np.zeros(len(every)), np.ones(len(every))
    )
    return list(np.add.reduceat(size, first).tolist())


def is_nonuniform(curve: PiecewiseCurve) -> NDArray[np.bool_]:
    """Whether pieces (M,) have a varying speed: all but straight lines and circular arcs."""
    out = np.asarray(curve.cubic[:, 2:].any(axis=(1, 2)))
    (arcs,) = np.nonzero(curve.angles[:, 1])
    u, v = curve.ellipse[arcs].transpose(1, 0, 2)
    uu, vv, uv = ((a * b).sum(1) for a, b in ((u, u), (v, v), (u, v)))
    oval = np.maximum(np.abs(uu - vv), np.abs(uv)) > CIRCLE_TOLERANCE * uu
    out[arcs] |= oval | curve.cubic[arcs, 1].any(axis=1)
    return out


def stretch_lengths(
    curve: PiecewiseCurve, uneven: NDArray[np.bool_], piece: Indices, lower: Floats, upper: Floats
) -> Floats:
    """The lengths (N,) of pieces (N,) between two parameters (N,).

    `uneven` marks the pieces (M,) that need a quadrature.
    """
    out = np.empty(len(piece))
    for hard in (False, True):
        (which,) = np.nonzero(uneven[piece] == hard)
        for some in np.split(which, range(BATCH, len(which), BATCH)):
            size = (upper[some] - lower[some])[:, None]
            at = lower[some, None] + (0.5 * size * (1.0 + NODES) if hard else 0.0 * size)
            speed = speeds(curve, piece[some], at)
            out[some] = size[:, 0] * (speed @ (0.5 * WEIGHTS) if hard else speed[:, 0])
    return out


def parameters_at(
    curve: PiecewiseCurve,
    uneven: NDArray[np.bool_],
    piece: Indices,
    bounds: tuple[Floats, Floats],
    g: Floats,
    wanted: Floats,
) -> Floats:
    """The parameters (N,) of pieces (N,) at lengths (N,) behind the lower of two bounds (N,).

    By Newton's method from an estimate `g`, which is right already where a piece is not uneven.
    """
    start, (lower, upper) = bounds[0], (bound.copy() for bound in bounds)
    g, left = g.copy(), np.flatnonzero(uneven[piece])
    for _ in range(60):
        if not len(left):
            break
        now, of = g[left], piece[left]
        excess = stretch_lengths(curve, uneven, of, start[left], now) - wanted[left]
        upper[left] = np.where(excess > 0.0, now, upper[left])
        lower[left] = np.where(excess > 0.0, lower[left], now)
        with np.errstate(divide="ignore", invalid="ignore"):
            new = now - excess / speeds(curve, of, now[:, None])[:, 0]
        safe = (new >= lower[left]) & (new <= upper[left])
        new = np.where(safe, new, 0.5 * (lower[left] + upper[left]))
        g[left] = new
        left = left[np.abs(new - now) > 1e-12]  # the next step would be its square
    return g


def bounding_box(curves: Sequence[PiecewiseCurve]) -> tuple[Floats, Floats]:
    """The least and the greatest coordinates (3,), exact for bent pieces, too."""
    whole = concatenate(curves)[0]
    every = np.arange(len(whole.cubic))
    found = [_at(whole, every, 0.0), _at(whole, every, 1.0)]
    for axis in range(3):
        for piece, g in (_still_cubic(whole, axis), _still_arc(whole, axis)):
            inside = (g > 0.0) & (g < 1.0)
            if inside.any():
                found.append(derivatives(whole, piece[inside], g[inside])[0])
    points = np.concatenate(found)
    return points.min(axis=0), points.max(axis=0)


def _still_cubic(curve: PiecewiseCurve, axis: int) -> tuple[Indices, Floats]:
    """Parameters with zero derivative of a coordinate: the roots of c1 + 2 c2 g + 3 c3 g^2."""
    (piece,) = np.nonzero(curve.cubic[:, 2:, axis].any(axis=1))
    c, b, a = (k * curve.cubic[piece, k, axis] for k in (1, 2, 3))
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(np.maximum(b * b - 4.0 * a * c, 0.0))
        q = -0.5 * (b + np.copysign(root, b))  # the form that loses no digits
        g = np.concatenate([q / a, c / q])
    return np.concatenate([piece, piece]), np.where(np.isfinite(g), g, 0.0)


def _still_arc(curve: PiecewiseCurve, axis: int) -> tuple[Indices, Floats]:
    """Parameters with zero derivative of a coordinate of the ellipse: tan a = v / u."""
    (piece,) = np.nonzero(curve.ellipse[:, :, axis].any(axis=1) & (curve.angles[:, 1] != 0.0))
    u, v = curve.ellipse[piece, :, axis].T
    start, turn = curve.angles[piece].T
    half_turns = np.arange(-4, 5)[:, None] * np.pi  # arcs are at most one turn
    base = np.arctan2(v, u)
    base = base + np.pi * np.round((start + 0.5 * turn - base) / np.pi)
    g = (base + half_turns - start) / turn
    return np.tile(piece, len(half_turns)), g.ravel()
