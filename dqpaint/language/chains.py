"""Chains of smooth pieces: made from points, Bezier curves and arcs; joined, turned round, fitted.

A chain that comes from a file has its coordinates in the file's own unit until it is mapped into
the drawing frame. What the numbers of a piece mean is said at `program.Chain`.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from dqpaint.language.program import Chain, Vector
from dqpaint.language.taylor import Floats

NODES, WEIGHTS = np.polynomial.legendre.leggauss(10)
CORNER = np.radians(60.0)  # a smooth line keeps the corners that turn by more than this

Indices = NDArray[np.intp]


def derivatives(chain: Chain, piece: Indices, g: Floats) -> Floats:
    """Places (4, N, 3) and derivatives over g, of pieces (N,) at their own parameters (N,)."""
    c0, c1, c2, c3 = chain.cubic[piece].transpose(1, 0, 2)
    h = g[:, None]
    out = np.stack([
        c0 + h * (c1 + h * (c2 + h * c3)),
        c1 + h * (2.0 * c2 + 3.0 * h * c3),
        2.0 * c2 + 6.0 * h * c3,
        6.0 * c3,
    ])  # fmt: skip
    if chain.ellipse.any():
        u, v = chain.ellipse[piece].transpose(1, 0, 2)
        start, turn = chain.angles[piece].T[:, :, None]
        c, s = np.cos(start + h * turn), np.sin(start + h * turn)
        outward, along = c * u + s * v, c * v - s * u
        out[0] += outward
        out[1] += turn * along
        out[2] -= turn**2 * outward
        out[3] -= turn**3 * along
    return out


# Made.


def _of_cubic(cubic: Floats) -> Chain:
    none = np.zeros(())  # no arcs, without room for each
    count = len(cubic)
    return Chain(cubic, np.broadcast_to(none, (count, 2, 3)), np.broadcast_to(none, (count, 2)))


def straight(points: Floats) -> Chain:
    """Straight lines from each point (N, 3) to the next; none of them has no length."""
    cubic = np.zeros((len(points) - 1, 4, 3))
    cubic[:, 0], cubic[:, 1] = points[:-1], np.diff(points, axis=0)
    return _of_cubic(cubic)


def bezier(points: Floats) -> Chain:
    """One Bezier curve by its 3 or 4 control points."""
    if len(points) == 3:
        start, handle, end = points
        points = np.array([start, (start + 2.0 * handle) / 3.0, (2.0 * handle + end) / 3.0, end])
    return _of_cubic(_coefficients(points[None]))


def _coefficients(control: Floats) -> Floats:
    """Of cubic Bezier curves with control points (M, 4, 3)."""
    p0, p1, p2, p3 = control.transpose(1, 0, 2)
    c1, c2 = 3.0 * (p1 - p0), 3.0 * (p2 - 2.0 * p1 + p0)
    return np.stack([p0, c1, c2, p3 - p0 - c1 - c2], axis=1)


def arc(centre: Floats, u: Floats, v: Floats, start: float, turn: float) -> Chain:
    """An arc of the ellipse centre + u cos(a) + v sin(a), from a = start over `turn` [rad]."""
    cubic = np.zeros((1, 4, 3))
    cubic[0, 0] = centre
    return Chain(cubic, np.array([[u, v]]), np.array([[start, turn]]))


def smooth(points: Floats, keep: NDArray[np.bool_] | None = None, stiff: float = np.inf) -> Chain:
    """A line through points (N, 3), without corners but where it turns sharply.

    The direction at a point is that of the circle through it and its neighbours; between two
    points runs the Bezier curve that is next to a circular arc. Lines to a point that keeps its
    corner, and to the ends, are bent as the other end asks.

    Args:
        points: (N, 3), N at least 2, none of them the same as the next.
        keep: which of them (N,) keep their corner; else those that turn by more than `CORNER`.
        stiff: a line so many times longer than its neighbour stays straight.
    """
    way = np.diff(points, axis=0)
    size = np.linalg.norm(way, axis=1)
    u = way / size[:, None]
    closed = len(points) > 3 and bool((points[0] == points[-1]).all())
    if keep is None:
        keep = turns(points) > CORNER
    keep = keep.copy()
    if not closed:
        keep[[0, -1]] = True
    before, after = np.roll(u, 1, axis=0), u  # at the points but the last
    l0, l1 = np.roll(size, 1)[:, None], size[:, None]
    tangent = before * l1 + after * l0
    tangent = np.where(l0 > stiff * l1, before, np.where(l1 > stiff * l0, after, tangent))
    tangent = np.concatenate([tangent, tangent[:1]])
    norm = np.linalg.norm(tangent, axis=1, keepdims=True)
    keep |= norm[:, 0] == 0.0
    tangent /= np.where(norm > 0.0, norm, 1.0)
    t0, t1, free0, free1 = tangent[:-1], tangent[1:], keep[:-1], keep[1:]
    mirrored0, mirrored1 = _mirrored(t1, u), _mirrored(t0, u)
    t0 = np.where(free0[:, None], np.where(free1[:, None], u, mirrored0), t0)
    t1 = np.where(free1[:, None], np.where(free0[:, None], u, mirrored1), t1)
    h0, h1 = (size / (1.5 * (1.0 + (t * u).sum(1))) for t in (t0, t1))
    control = np.stack(
        [points[:-1], points[:-1] + h0[:, None] * t0, points[1:] - h1[:, None] * t1, points[1:]],
        axis=1,
    )
    cubic = _coefficients(control)
    bends = np.maximum(np.abs(t0 - u).max(1), np.abs(t1 - u).max(1)) > 1e-9
    cubic[~bends, 1], cubic[~bends, 2:] = way[~bends], 0.0
    return _of_cubic(cubic)


def _mirrored(t: Floats, u: Floats) -> Floats:
    """The direction at the other end of a circular arc with the chord's direction u."""
    return np.asarray(2.0 * (t * u).sum(1, keepdims=True) * u - t)


def turns(points: Floats) -> Floats:
    """The angle [rad] by which a line turns at each point (N,); of the ends, if it is closed."""
    u = np.diff(points, axis=0)
    u = u / np.linalg.norm(u, axis=1, keepdims=True)
    before = np.roll(u, 1, axis=0)
    angle = np.arctan2(np.linalg.norm(np.cross(before, u), axis=1), (before * u).sum(1))
    return np.concatenate([angle, angle[:1]])


# Changed.


def joined(chains: Sequence[Chain]) -> Chain:
    """One chain of several that follow each other; a start is moved to the end before it."""
    whole, first, last = together(chains)
    heads = first[1:]
    gap = _at(whole, last[:-1], 1.0) - _at(whole, heads, 0.0)
    whole.cubic[heads, 0] += gap
    whole.cubic[heads, 1] -= gap
    return whole


def reversed_(chain: Chain) -> Chain:
    """The same way, from its end to its start."""
    c0, c1, c2, c3 = chain.cubic[::-1].transpose(1, 0, 2)
    cubic = np.stack([c0 + c1 + c2 + c3, -(c1 + 2.0 * c2 + 3.0 * c3), c2 + 3.0 * c3, -c3], axis=1)
    start, turn = chain.angles[::-1].T
    return Chain(cubic, chain.ellipse[::-1].copy(), np.stack([start + turn, -turn], axis=1))


def mapped(chain: Chain, matrix: Floats, shift: Floats) -> Chain:
    """Every point p goes to matrix (3, 3) p + shift (3,); too far for a number is infinite."""
    with np.errstate(over="ignore", invalid="ignore"):
        cubic = chain.cubic @ matrix.T
        cubic[:, 0] += shift
        arcs = chain.ellipse.any()
        return Chain(cubic, chain.ellipse @ matrix.T if arcs else chain.ellipse, chain.angles)


def farthest(chains: Sequence[Chain]) -> float:
    """The largest number of all pieces [m]; NaN if one of them is none."""
    whole = together(chains)[0]
    parts = whole.cubic, whole.ellipse
    return float(max(max(part.max(), -part.min()) for part in parts))


# Measured.


def _at(chain: Chain, piece: Indices, g: float) -> Floats:
    return np.asarray(derivatives(chain, piece, np.full(len(piece), g))[0])


def ends(chain: Chain) -> tuple[Vector, Vector]:
    """The first and the last point."""
    first, last = all_ends([chain])[0].tolist()
    return (first[0], first[1], first[2]), (last[0], last[1], last[2])


def all_ends(chains: Sequence[Chain]) -> Floats:
    """The first and the last points (N, 2, 3) of many chains."""
    whole, first, last = together(chains)
    return np.stack([_at(whole, first, 0.0), _at(whole, last, 1.0)], axis=1)


def directions(chains: Sequence[Chain]) -> Floats:
    """Unit vectors (N, 2, 3) into each chain from its start and from its end."""
    whole, *pieces = together(chains)
    ways = [
        sign * derivatives(whole, piece, np.full(len(piece), g))[1]
        for piece, g, sign in zip(pieces, (1e-3, 1.0 - 1e-3), (1.0, -1.0), strict=True)
    ]
    out = np.stack(ways, axis=1)
    norm = np.linalg.norm(out, axis=2, keepdims=True)
    return np.asarray(out / np.where(norm > 0.0, norm, 1.0))


def together(chains: Sequence[Chain]) -> tuple[Chain, Indices, Indices]:
    """All pieces of many chains, and which are the first and the last of each."""
    whole = chains[0]
    if len(chains) > 1:  # else it is there already, and may be long
        whole = Chain(
            np.concatenate([chain.cubic for chain in chains]),
            np.concatenate([chain.ellipse for chain in chains]),
            np.concatenate([chain.angles for chain in chains]),
        )
    stop = np.cumsum([len(chain.cubic) for chain in chains])
    return whole, np.concatenate([[0], stop[:-1]]), stop - 1


def lengths(chains: Sequence[Chain]) -> list[float]:
    """The lengths of chains, good enough to share out time and colour by them."""
    whole, first, _ = together(chains)
    size = np.linalg.norm(whole.cubic[:, 1], axis=1)
    bent = whole.cubic[:, 2:].any(axis=(1, 2)) | whole.ellipse.any(axis=(1, 2))
    (some,) = np.nonzero(bent)
    for part in np.split(some, range(10_000, len(some), 10_000)):
        g = np.tile(0.5 + 0.5 * NODES, len(part))
        speed = np.linalg.norm(derivatives(whole, np.repeat(part, 10), g)[1], axis=1)
        size[part] = 0.5 * speed.reshape(-1, 10) @ WEIGHTS
    return list(np.add.reduceat(size, first).tolist())


def box(chains: Sequence[Chain]) -> tuple[Floats, Floats]:
    """The least and the greatest coordinates (3,), exact where a curve bulges out as well."""
    whole = together(chains)[0]
    every = np.arange(len(whole.cubic))
    found = [_at(whole, every, 0.0), _at(whole, every, 1.0)]
    for axis in range(3):
        for piece, g in (_still_cubic(whole, axis), _still_arc(whole, axis)):
            inside = (g > 0.0) & (g < 1.0)
            if inside.any():
                found.append(derivatives(whole, piece[inside], g[inside])[0])
    points = np.concatenate(found)
    return points.min(axis=0), points.max(axis=0)


def _still_cubic(chain: Chain, axis: int) -> tuple[Indices, Floats]:
    """Where a coordinate of the cubic stands still: the roots of c1 + 2 c2 g + 3 c3 g^2."""
    (piece,) = np.nonzero(chain.cubic[:, 2:, axis].any(axis=1))
    c, b, a = (k * chain.cubic[piece, k, axis] for k in (1, 2, 3))
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(np.maximum(b * b - 4.0 * a * c, 0.0))
        q = -0.5 * (b + np.copysign(root, b))  # the form that loses no digits
        g = np.concatenate([q / a, c / q])
    return np.concatenate([piece, piece]), np.where(np.isfinite(g), g, 0.0)


def _still_arc(chain: Chain, axis: int) -> tuple[Indices, Floats]:
    """Where a coordinate of the ellipse stands still: tan a = v / u."""
    (piece,) = np.nonzero(chain.ellipse[:, :, axis].any(axis=1) & (chain.angles[:, 1] != 0.0))
    u, v = chain.ellipse[piece, :, axis].T
    start, turn = chain.angles[piece].T
    half_turns = np.arange(-4, 5)[:, None] * np.pi  # arcs are at most one turn
    base = np.arctan2(v, u)
    base = base + np.pi * np.round((start + 0.5 * turn - base) / np.pi)
    g = (base + half_turns - start) / turn
    return np.tile(piece, len(half_turns)), g.ravel()
