"""Vectors, unit quaternions and similarity frames as plain tuples, for few values at a time.

Orientations are unit quaternions, scalar first. `Frame` maps p to scale * R(M p) + shift, where M
turns x round if the frame is mirrored.
"""

import math
from typing import NamedTuple

from dqpaint.program import Pose, Quaternion, Vector

ZERO: Vector = (0.0, 0.0, 0.0)
Y: Vector = (0.0, 1.0, 0.0)
Z: Vector = (0.0, 0.0, 1.0)
UNTURNED: Quaternion = (1.0, 0.0, 0.0, 0.0)


def plus(a: Vector, b: Vector) -> Vector:
    """A + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def minus(a: Vector, b: Vector) -> Vector:
    """A - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def times(k: float, a: Vector) -> Vector:
    """K a."""
    return k * a[0], k * a[1], k * a[2]


def dot(a: Vector, b: Vector) -> float:
    """The scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """The vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def length(a: Vector) -> float:
    """The Euclidean norm; `hypot` neither overflows nor underflows on the way."""
    return math.hypot(*a)


def unit(a: Vector) -> Vector:
    """The direction of a vector that is not zero."""
    largest = max(abs(a[0]), abs(a[1]), abs(a[2]))
    scaled = a[0] / largest, a[1] / largest, a[2] / largest
    size = length(scaled)
    return scaled[0] / size, scaled[1] / size, scaled[2] / size


def across(a: Vector, axis: Vector) -> Vector:
    """The part of `a` that is perpendicular to a unit vector."""
    return minus(a, times(dot(a, axis), axis))


def angle_between(a: Vector, b: Vector) -> float:
    """The angle [rad] between two vectors; exact near 0 and pi as well."""
    return math.atan2(length(cross(a, b)), dot(a, b))


def turn_product(p: Quaternion, q: Quaternion) -> Quaternion:
    """The orientation p after q: R(pq) = R(p) R(q)."""
    a, b, c, d = p
    e, f, g, h = q
    return _normal(
        (
            a * e - b * f - c * g - d * h,
            a * f + b * e + c * h - d * g,
            a * g - b * h + c * e + d * f,
            a * h + b * g - c * f + d * e,
        )
    )


def _normal(q: Quaternion) -> Quaternion:
    """A product of unit quaternions, normalised against rounding errors."""
    size = math.hypot(*q)
    return q[0] / size, q[1] / size, q[2] / size, q[3] / size


def turn_about(axis: Vector, angle: float) -> Quaternion:
    """The orientation of a rotation by `angle` [rad] about a unit vector."""
    half = 0.5 * angle
    c, s = math.cos(half), math.sin(half)
    return c, s * axis[0], s * axis[1], s * axis[2]


def turned(q: Quaternion, p: Vector) -> Vector:
    """The rotated vector R(q) p."""
    w, v = q[0], (q[1], q[2], q[3])
    t = times(2.0, cross(v, p))
    return plus(plus(p, times(w, t)), cross(v, t))


def turn_between(p: Quaternion, q: Quaternion) -> float:
    """The angle [rad], 0 to pi, of the rotation from one orientation to another."""
    real = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]
    sign = 1.0 if real >= 0.0 else -1.0
    # The chord keeps its digits where the arc cosine loses them.
    chord = math.hypot(*(a - sign * b for a, b in zip(p, q, strict=True)))
    return 4.0 * math.asin(min(1.0, 0.5 * chord))


def part_of_turn(p: Quaternion, q: Quaternion, share: float) -> Quaternion:
    """The orientation at a fraction, 0 to 1, of the shorter rotation from p to q (slerp)."""
    real = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]
    if real < 0.0:
        q = (-q[0], -q[1], -q[2], -q[3])
    half = 0.5 * turn_between(p, q)
    if half < 1e-9:
        return q
    a, b = math.sin((1.0 - share) * half) / math.sin(half), math.sin(share * half) / math.sin(half)
    return _normal(
        (
            a * p[0] + b * q[0],
            a * p[1] + b * q[1],
            a * p[2] + b * q[2],
            a * p[3] + b * q[3],
        )
    )


def turn_of_axes(x: Vector, y: Vector, z: Vector) -> Quaternion:
    """The orientation with these axes; x, y, z are orthonormal and right-handed."""
    trace = x[0] + y[1] + z[2]
    if trace > 0.0:
        s = 2.0 * math.sqrt(1.0 + trace)
        return _normal((0.25 * s, (y[2] - z[1]) / s, (z[0] - x[2]) / s, (x[1] - y[0]) / s))
    if x[0] >= y[1] and x[0] >= z[2]:
        s = 2.0 * math.sqrt(1.0 + x[0] - y[1] - z[2])
        return _normal(((y[2] - z[1]) / s, 0.25 * s, (y[0] + x[1]) / s, (z[0] + x[2]) / s))
    if y[1] >= z[2]:
        s = 2.0 * math.sqrt(1.0 + y[1] - x[0] - z[2])
        return _normal(((z[0] - x[2]) / s, (y[0] + x[1]) / s, 0.25 * s, (z[1] + y[2]) / s))
    s = 2.0 * math.sqrt(1.0 + z[2] - x[0] - y[1])
    return _normal(((x[1] - y[0]) / s, (z[0] + x[2]) / s, (z[1] + y[2]) / s, 0.25 * s))


def turn_of_rpy(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Rotations [rad] about the fixed x, then y, then z axis: Rz(yaw) Ry(pitch) Rx(roll)."""
    about_x = turn_about((1.0, 0.0, 0.0), roll)
    about_y = turn_about((0.0, 1.0, 0.0), pitch)
    return turn_product(turn_about(Z, yaw), turn_product(about_y, about_x))


class Frame(NamedTuple):
    """A similarity: p goes to scale * R(turn) M p + shift; M is diag(-1, 1, 1) if mirrored."""

    scale: float = 1.0
    turn: Quaternion = UNTURNED
    shift: Vector = ZERO
    mirrored: bool = False

    @property
    def hand(self) -> float:
        """1, or -1 if what turns right-handed inside turns left-handed outside."""
        return -1.0 if self.mirrored else 1.0

    def point(self, p: Vector) -> Vector:
        """A position in the outer frame."""
        return p if self is WORLD else plus(self.vector(p), self.shift)

    def vector(self, v: Vector) -> Vector:
        """A displacement in the outer frame."""
        return v if self is WORLD else times(self.scale, self.direction(v))

    def direction(self, d: Vector) -> Vector:
        """A unit vector in the outer frame."""
        return turned(self.turn, (self.hand * d[0], d[1], d[2]))

    def orientation(self, q: Quaternion) -> Quaternion:
        """An orientation in the outer frame.

        No tool can be mirrored: of the image of its axes y and z stay, x turns round. So it points
        where its image points, and a tool that faces the viewer still does.
        """
        w, x, y, z = q
        return turn_product(self.turn, (w, x, self.hand * y, self.hand * z))

    def within(self, inner: "Frame") -> "Frame":
        """The composition of `inner` and then this frame."""
        return Frame(
            self.scale * inner.scale,
            self.orientation(inner.turn),
            self.point(inner.shift),
            self.mirrored != inner.mirrored,
        )


WORLD = Frame()


def mirror(normal: Vector, point: Vector = ZERO) -> Frame:
    """The reflection across the plane through `point` whose unit normal is `normal`.

    Two reflections are a turn, the product of their normals: this one after that of x.
    """
    x, y, z = normal
    return Frame(1.0, (-x, 0.0, z, -y), times(2.0 * dot(normal, point), normal), mirrored=True)


def screw_moved(pose: Pose, point: Vector, axis: Vector, angle: float, advance: float) -> Pose:
    """A pose after a screw motion about the line through `point` along `axis`."""
    turn = turn_about(axis, angle)
    arm = turned(turn, minus(pose.position, point))
    position = plus(plus(point, arm), times(advance, axis))
    return Pose(position, turn_product(turn, pose.orientation))
