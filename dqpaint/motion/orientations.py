"""What the tool does along a stroke: orientation, angular velocity and its derivative."""

from collections.abc import Callable

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.language.program import Arc, Follow, Keep, Look, LookLine, Segment, Turn
from dqpaint.motion.places import Places

# (f (N,), places (4, N, 3)) -> r (N, 4), w (N, 3) [rad per f], its derivative (N, 3)
Spin = Callable[[Floats, Floats], tuple[Floats, Floats, Floats]]


def orientation(segment: Segment, places: Places) -> Spin:
    """The tool of one segment along its places, for strokes that are not one screw."""
    tool = segment.tool
    r0 = np.array(segment.start.orientation)
    if isinstance(tool, Keep):
        return _turning(r0, np.zeros(3))
    if isinstance(tool, Turn):
        r1 = np.array(segment.end.orientation)
        step = dq.quaternion_mul(r1, r0 * dq.C4)
        return _turning(r0, 2 * dq.log(dq.pose_from(np.zeros(3), step))[:3])
    if isinstance(tool, Follow) and isinstance(segment.path, Arc):
        return _turning(r0, segment.path.angle * np.array(segment.path.axis))
    if isinstance(tool, Follow):
        return _heading(r0, np.array(tool.axis), places)
    if isinstance(tool, Look):
        return _looking_at(np.array(tool.point), np.array(tool.up))
    return _looking_at_line(tool)


def _turning(r0: Floats, turn: Floats) -> Spin:
    """A constant turn (3,) [rad], axis times angle, over the whole stroke."""

    def spin(f: Floats, _at: Floats) -> tuple[Floats, Floats, Floats]:
        half = np.concatenate([0.5 * f[:, None] * turn, np.zeros((len(f), 3))], axis=1)
        w = np.tile(turn, (len(f), 1))
        return dq.quaternion_mul(dq.exp(half)[:, :4], r0), w, np.zeros_like(w)

    return spin


def _heading(r0: Floats, axis: Floats, places: Places) -> Spin:
    """The turn about `axis` by which the tangent's direction across it has changed."""
    e1 = _across(axis)
    e2 = dq.cross(axis, e1)
    tangent = places(np.zeros(1))[1, 0]
    start = np.arctan2(tangent @ e2, tangent @ e1)

    def spin(_f: Floats, at: Floats) -> tuple[Floats, Floats, Floats]:
        x, y = at[1:] @ e1, at[1:] @ e2  # (3, N): of p', p'', p'''
        square = x[0] ** 2 + y[0] ** 2
        if not np.isfinite(at[3]).all() or not (square > 0).all():
            raise FloatingPointError("a heading, or one of its derivatives, is not finite")
        turning = x[0] * y[1] - y[0] * x[1]
        rate = turning / square
        spread = 2 * (x[0] * x[1] + y[0] * y[1])
        slope = (x[0] * y[2] - y[0] * x[2] - rate * spread) / square
        half = 0.5 * (np.arctan2(y[0], x[0]) - start)
        q = np.concatenate([np.cos(half)[:, None], np.sin(half)[:, None] * axis], axis=1)
        return dq.quaternion_mul(q, r0), rate[:, None] * axis, slope[:, None] * axis

    return spin


def _across(axis: Floats) -> Floats:
    """A unit vector square to `axis`."""
    least = np.eye(3)[np.argmin(np.abs(axis))]
    across = dq.cross(axis, least)
    return np.asarray(across / np.linalg.norm(across))


def _looking_at(point: Floats, up: Floats) -> Spin:
    """Tool z towards `point`, x = up x z made a unit vector, y = z x x."""

    def spin(_f: Floats, at: Floats) -> tuple[Floats, Floats, Floats]:
        towards = np.stack([point - at[0], -at[1], -at[2]])
        z = _unit(towards)
        x = _unit(_cross(_fixed(up, z), z))
        return _spin_of_frame(x, _cross(z, x), z)

    return spin


def _looking_at_line(tool: LookLine) -> Spin:
    """Tool z square to the line and towards it, x along the line, y = z x x."""
    point, along = np.array(tool.point), np.array(tool.along)

    def spin(_f: Floats, at: Floats) -> tuple[Floats, Floats, Floats]:
        towards = np.stack([point - at[0], -at[1], -at[2]])
        z = _unit(towards - (towards @ along)[..., None] * along)
        x = _fixed(along, z)
        return _spin_of_frame(x, _cross(z, x), z)

    return spin


# Vectors that move: (3, N, 3), value and first two derivatives.


def _fixed(vector: Floats, like: Floats) -> Floats:
    """A vector (3,) that does not move."""
    out = np.zeros_like(like)
    out[0] = vector
    return out


def _unit(a: Floats) -> Floats:
    """The direction of a moving vector: from a = r n, a' = r' n + r n', and once more."""
    r = np.sqrt((a[0] ** 2).sum(-1, keepdims=True))
    n = a[0] / r
    r1 = (n * a[1]).sum(-1, keepdims=True)
    n1 = (a[1] - r1 * n) / r
    r2 = (n1 * a[1] + n * a[2]).sum(-1, keepdims=True)
    n2 = (a[2] - r2 * n - 2 * r1 * n1) / r
    return np.stack([n, n1, n2])


def _cross(a: Floats, b: Floats) -> Floats:
    """The vector product of moving vectors, by the product rule."""
    first = dq.cross(a[1], b[0]) + dq.cross(a[0], b[1])
    second = dq.cross(a[2], b[0]) + 2 * dq.cross(a[1], b[1]) + dq.cross(a[0], b[2])
    return np.stack([dq.cross(a[0], b[0]), first, second])


def _spin_of_frame(x: Floats, y: Floats, z: Floats) -> tuple[Floats, Floats, Floats]:
    """Of a moving frame: w = 1/2 sum e x e', and w' = 1/2 sum e x e'' as e' x e' = 0."""
    r = dq.quaternion_from_matrix(np.stack([x[0], y[0], z[0]], axis=-1))
    axes = (x, y, z)
    w = 0.5 * sum(dq.cross(e[0], e[1]) for e in axes)
    w_slope = 0.5 * sum(dq.cross(e[0], e[2]) for e in axes)
    return r, np.asarray(w), np.asarray(w_slope)
