"""Points, segments and rods against shapes -> signed distances, where they are least and which way.

A distance of two rigid shapes changes by the velocities of the two points that are nearest, along
the line between them: with n from the shape's point to the robot's point p,

    d_dot = n . (w x p + v_0) - n . c_dot = [p x n; n] . xi + zeta

for a robot that moves with the spatial twist xi and a shape whose points move with c_dot (Marinho
et al. 2019, whose Jacobians of squared distances are 2 d times these). A point is a segment
without length, a line a cylinder without ends, a sphere a capsule without length.
"""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats

if TYPE_CHECKING:
    from scipy.spatial import ConvexHull

TINY = 1e-12  # [m] and less is no direction
TOUCHING = 1e-5  # [m] from a hull: what meets it is measured by how deep it is


class Contacts(NamedTuple):
    """The least distances of segments from a shape, m of them.

    Attributes:
        distance: signed (m,) [m]; negative inside.
        normal: unit vectors (m, 3), along which a segment gets away.
        point: of the segments there (m, 3) [m].
        which: number of the segment (m,).
    """

    distance: Floats
    normal: Floats
    point: Floats
    which: np.ndarray[tuple[int], np.dtype[np.intp]]


def twist_rows(contacts: Contacts) -> Floats:
    """The covectors (m, 6) of spatial twists whose product with one is the distance's rate."""
    return np.concatenate([dq.cross(contacts.point, contacts.normal), contacts.normal], axis=1)


def from_half_space(start: Floats, end: Floats, normal: Floats, offset: float) -> Contacts:
    """Both ends of segments (m, 3) over a plane: n . p - offset."""
    ends = np.concatenate([start, end])
    way = np.broadcast_to(normal, ends.shape)
    index = np.tile(np.arange(len(start)), 2)
    return Contacts(ends @ normal - offset, way, ends, index)


def from_point(start: Floats, end: Floats, centre: Floats) -> Contacts:
    """Segments (m, 3) from a point (3,)."""
    way = end - start
    part = _unit_part(((centre - start) * way).sum(axis=1), (way * way).sum(axis=1))
    return _between(start + part[:, None] * way, np.broadcast_to(centre, start.shape))


def from_line(start: Floats, end: Floats, point: Floats, axis: Floats) -> Contacts:
    """Segments (m, 3) from a line through a point along a unit vector, both (3,).

    Seen along the line it is a point.
    """
    across = np.eye(3) - np.outer(axis, axis)
    flat, flat_way = (start - point) @ across, (end - start) @ across
    part = _unit_part(-(flat * flat_way).sum(axis=1), (flat_way * flat_way).sum(axis=1))
    nearest = start + part[:, None] * (end - start)
    foot = point + np.outer((nearest - point) @ axis, axis)
    return _between(nearest, foot)


def from_segments(start: Floats, end: Floats, low: Floats, high: Floats) -> tuple[Contacts, Floats]:
    """Segments (m, 3) from segments (m, 3) or (3,), and the points of these (m, 3).

    The least of the squared distance over both parts, each from 0 to 1 (Ericson, Real-Time
    Collision Detection, 5.1.9, for m pairs at once).
    """
    low, high = np.broadcast_to(low, start.shape), np.broadcast_to(high, start.shape)
    u, v, w = end - start, high - low, start - low
    a, e, f = ((x * y).sum(axis=1) for x, y in ((u, u), (v, v), (v, w)))
    b, c = (u * v).sum(axis=1), (u * w).sum(axis=1)
    s = _unit_part(b * f - c * e, a * e - b * b)
    t = _unit_part(b * s + f, e)
    s = _unit_part(b * t - c, a)
    t = _unit_part(b * s + f, e)  # once more, where s was cut
    other = low + t[:, None] * v
    return _between(start + s[:, None] * u, other), other


def from_box(start: Floats, end: Floats, low: Floats, high: Floats) -> Contacts:
    """Segments (m, 3) from a box with two opposite corners (3,), signed.

    The squared distance from a box is convex along a segment, and its slope is straight between the
    planes of the sides: its zero is found exactly. What meets the box is as deep inside as its
    deepest point is from the nearest side.
    """
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    a, u = start - middle, end - start
    with np.errstate(divide="ignore", invalid="ignore"):
        crossings = [(side * half - a) / u for side in (-1.0, 1.0)]
    stops = np.concatenate([np.zeros((len(a), 1)), *crossings, np.ones((len(a), 1))], axis=1)
    stops = np.sort(np.clip(np.nan_to_num(stops, nan=0.0, posinf=1.0, neginf=0.0), 0, 1), axis=1)
    at = a[:, None] + stops[:, :, None] * u[:, None]
    excess = at - np.clip(at, -half, half)
    slope = (excess * u[:, None]).sum(axis=2)  # rises along each segment
    last = np.clip((slope <= 0).sum(axis=1) - 1, 0, stops.shape[1] - 2)
    row = np.arange(len(a))
    low_slope, high_slope = slope[row, last], slope[row, last + 1]
    share = _unit_part(-low_slope, high_slope - low_slope)
    part = stops[row, last] + share * (stops[row, last + 1] - stops[row, last])
    nearest = a + part[:, None] * u
    found = _between(nearest + middle, np.clip(nearest, -half, half) + middle)
    inside = np.flatnonzero(found.distance < TINY).tolist()
    if inside:
        normals = np.concatenate([np.eye(3), -np.eye(3)])
        for i in inside:
            _set_deepest(found, i, start[i], end[i], normals,
                         np.concatenate([high, -low]))  # fmt: skip
    return found


def from_hull(start: Floats, end: Floats, hull: "ConvexHull") -> Contacts:
    """Segments (m, 3) from a convex hull, signed: the least of |p - c| by a quadratic program."""
    import daqp

    sides = np.unique(hull.equations.round(10), axis=0)  # triangles of one side are one
    normals, offsets = sides[:, :3], -sides[:, 3]
    count = len(start)
    found = Contacts(np.empty(count), np.empty((count, 3)), np.empty((count, 3)), np.arange(count))
    lower = np.append(0.0, np.full(len(offsets), -1e30))
    H = np.diag([2e-6, 2.0, 2.0, 2.0])  # of s, and y = p - c: y'y, and of equals the least s
    for i in range(count):
        u = end[i] - start[i]
        rows = np.column_stack([normals @ u, -normals])
        x, _, answer, _ = daqp.solve(
            H, np.zeros(4), rows, np.append(1.0, offsets - normals @ start[i]), lower,
            np.zeros(len(offsets) + 1, dtype=np.int32), primal_tol=1e-11,
        )  # fmt: skip
        way = np.asarray(x[1:])
        far = float(np.linalg.norm(way))
        if answer < 1 or far < TOUCHING:
            _set_deepest(found, i, start[i], end[i], normals, offsets)
        else:
            point = start[i] + x[0] * u
            found.distance[i], found.normal[i], found.point[i] = far, way / far, point
    return found


def _set_deepest(
    found: Contacts, i: int, start: Floats, end: Floats, normals: Floats, offsets: Floats
) -> None:
    """The least over a segment of how far it is outside the nearest side: a linear program.

    max_k (n_k . p - o_k) is convex and piecewise straight along a segment: bisected by its slopes.
    """
    low, high = 0.0, 1.0
    steep = normals @ (end - start)
    for _ in range(60):
        part = 0.5 * (low + high)
        at = start + part * (end - start)
        k = int(np.argmax(normals @ at - offsets))
        low, high = (part, high) if steep[k] < 0 else (low, part)
    at = start + 0.5 * (low + high) * (end - start)
    depths = normals @ at - offsets
    before, after = (
        int(np.argmax(normals @ (start + s * (end - start)) - offsets)) for s in (low, high)
    )
    normal = normals[int(np.argmax(depths))]
    if steep[before] < 0 < steep[after]:  # at a kink, what lets the segment slide along itself
        share = steep[after] / (steep[after] - steep[before])
        normal = share * normals[before] + (1 - share) * normals[after]
    found.distance[i], found.normal[i], found.point[i] = depths.max(), normal, at


def cone_row(axis: Floats, wanted: Floats, angle: float) -> tuple[float, Floats]:
    """How far a direction of the robot is inside a cone, and its covector (6,).

    h = 2 (l . l_w - cos angle), the squared distance of two unit vectors seen from its largest
    value; l_dot = w x l gives h_dot = 2 w . (l x l_w) (Quiroz-Omana and Adorno 2019).

    Args:
        axis: l, a direction fixed to the robot (3,).
        wanted: l_w (3,).
        angle: of the cone [rad].
    """
    row = np.concatenate([2.0 * dq.cross(axis, wanted), np.zeros(3)])
    return float(2.0 * (axis @ wanted - np.cos(angle))), row


def _between(point: Floats, other: Floats) -> Contacts:
    way = point - other
    far = np.sqrt((way * way).sum(axis=1))
    up = np.broadcast_to(np.array([0.0, 0.0, 1.0]), way.shape)  # on the axis every way is as good
    normal = np.where(far[:, None] > TINY, way / np.maximum(far, TINY)[:, None], up)
    return Contacts(far, normal, point, np.arange(len(point)))


def _unit_part(over: Floats, under: Floats) -> Floats:
    """A quotient, over / under, from 0 to 1; 0 where that is no number."""
    known = under > TINY**2
    return np.asarray(np.clip(np.where(known, over / np.where(known, under, 1.0), 0.0), 0.0, 1.0))
