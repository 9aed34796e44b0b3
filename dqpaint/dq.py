"""Dual quaternions, poses and twists: the conventions of the whole project, said once.

A quaternion is (w, x, y, z) with the Hamilton product. A dual quaternion is 8 numbers, the primary
part first: [w x y z  w' x' y' z']. A *pose* (..., 8) is a unit dual quaternion
x = r + eps t r / 2, with t [m] and r in the base frame; x and -x are the same pose.
A *twist* (..., 6) is spatial, in the base frame and about its origin: [w; v0] in rad/s and m/s, the
angular part first because it is the primary part: x_dot = xi x / 2. A *displacement* is a twist
times a time. Every function works on arrays of any leading shape, which broadcast.

After Adorno, "Robot kinematic modeling and control based on dual quaternion algebra" (2017), and
Ozgur and Mezouar, "Kinematic modeling and control of a robot arm using unit dual quaternions"
(2016).
"""

from collections.abc import Callable
from functools import partial
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats: TypeAlias = NDArray[np.float64]

IDENTITY: Floats = np.array([1.0, 0, 0, 0, 0, 0, 0, 0])
C4: Floats = np.array([1.0, -1, -1, -1])
C8: Floats = np.concatenate([C4, C4])  # vec(x*) = C8 vec(x), element by element
for _constant in (IDENTITY, C4, C8):
    _constant.setflags(write=False)


def _structure() -> Floats:
    """The constants of the product: (a b)_i = sum_jk T[i, j, k] a_j b_k."""
    q = np.zeros((4, 4, 4))
    for j, k, i, sign in [
        (0, 0, 0, 1), (0, 1, 1, 1), (0, 2, 2, 1), (0, 3, 3, 1),
        (1, 0, 1, 1), (1, 1, 0, -1), (1, 2, 3, 1), (1, 3, 2, -1),
        (2, 0, 2, 1), (2, 1, 3, -1), (2, 2, 0, -1), (2, 3, 1, 1),
        (3, 0, 3, 1), (3, 1, 2, 1), (3, 2, 1, -1), (3, 3, 0, -1),
    ]:  # fmt: skip
        q[i, j, k] = sign
    t = np.zeros((8, 8, 8))
    t[:4, :4, :4] = t[4:, :4, 4:] = t[4:, 4:, :4] = q
    return t


FEW = 8 * 256  # numbers, up to which matrix products cost less than the general way
BLOCK = 2048  # rows that are computed at once: they stay in the cache
_T = _structure()
_PLUS = np.ascontiguousarray(_T.transpose(0, 2, 1)).reshape(64, 8)  # @ a -> H+(a), flat
_MINUS = np.ascontiguousarray(_T).reshape(64, 8)  # @ b -> H-(b), flat
_PLACE = np.zeros((24, 8))  # t = x' _PLACE x, flat
_PLACE.reshape(3, 8, 8)[:, 4:, :4] = 2.0 * _T[1:4, :4, :4] * C4


def _adjoints() -> Floats:
    """(288, 8): the matrix of Ad(x), which is quadratic in x: [row, column, k] of one x_k, flat."""
    plus = _PLUS.T.reshape(8, 1, 8, 8)
    minus = (_MINUS * C8).T.reshape(1, 8, 8, 8)
    six = np.array([1, 2, 3, 5, 6, 7])
    both = (plus @ minus)[:, :, six[:, None], six]  # k, l, row, column
    return np.ascontiguousarray(both.transpose(2, 3, 0, 1)).reshape(288, 8)


_ADJOINT = _adjoints()


def hamilton_plus(a: Floats) -> Floats:
    """H+(a) (..., 8, 8), with vec(a b) = H+(a) vec(b)."""
    H: Floats = np.dot(a, _PLUS.T).reshape(*a.shape[:-1], 8, 8)
    return H


def hamilton_minus(b: Floats) -> Floats:
    """H-(b) (..., 8, 8), with vec(a b) = H-(b) vec(a)."""
    H: Floats = np.dot(b, _MINUS.T).reshape(*b.shape[:-1], 8, 8)
    return H


def mul(a: Floats, b: Floats) -> Floats:
    """The product of dual quaternions (..., 8)."""
    if a.ndim == b.ndim == 1:  # a control step: two small matrix products beat the general way
        single: Floats = np.dot(np.dot(_PLUS, a).reshape(8, 8), b)
        return single
    if max(a.size, b.size) <= FEW:  # and for a batch of runs
        few: Floats = np.matvec(hamilton_plus(a), b)
        return few
    return _in_blocks(_mul, 8, a, b)


def _in_blocks(formula: Callable[..., None], width: int, *arrays: Floats) -> Floats:
    """A formula of columns over rows (..., K) of arrays -> (..., width).

    A block of rows stays in the cache, and its columns each lie in one piece: several times faster.
    """
    first = arrays[0]
    if len(arrays) == 1 and first.ndim <= 2 and len(first) <= BLOCK:  # one, or a batch of runs
        few = np.empty((*first.shape[:-1], width))
        formula(few, first)
        return few
    shape = np.broadcast_shapes(*(array.shape[:-1] for array in arrays))
    rows = [
        np.ascontiguousarray(
            np.broadcast_to(array, (*shape, array.shape[-1])), dtype=np.float64
        ).reshape(-1, array.shape[-1])
        for array in arrays
    ]
    out = np.empty((len(rows[0]), width))
    for begin in range(0, len(out), BLOCK):
        own = slice(begin, begin + BLOCK)
        formula(out[own], *[row[own] for row in rows])
    return out.reshape(*shape, width)


def _complex_columns(x: Floats) -> NDArray[np.complex128]:
    """The columns (4, N) of numbers (N, 8), which lie in one piece, as pairs; each in one piece."""
    return np.ascontiguousarray(x.view(np.complex128).T)


def _mul(out: Floats, a: Floats, b: Floats) -> None:
    """Products (N, 8), as `quaternion_mul` with pairs of complex numbers."""
    first, second = _complex_columns(a), _complex_columns(b)
    (p0, p1, d0, d1), (q0, q1, e0, e1), (c0, c1, f0, f1) = first, second, second.conj()
    columns = out.view(np.complex128).T
    columns[0] = p0 * q0 - p1 * c1
    columns[1] = p0 * q1 + p1 * c0
    columns[2] = p0 * e0 - p1 * f1 + (d0 * q0 - d1 * c1)
    columns[3] = p0 * e1 + p1 * f0 + (d0 * q1 + d1 * c0)


def quaternion_mul(a: Floats, b: Floats) -> Floats:
    """The product of quaternions (..., 4).

    Written with pairs of complex numbers, a = z0 + z1 j: a third of the operations numpy would
    need for the sixteen products.
    """
    a, b = np.broadcast_arrays(a, b)
    p = np.ascontiguousarray(a, dtype=np.float64).view(np.complex128)
    q = np.ascontiguousarray(b, dtype=np.float64).view(np.complex128)
    p0, p1, q0, q1 = p[..., 0], p[..., 1], q[..., 0], q[..., 1]
    out = np.empty(p.shape, np.complex128)
    out[..., 0] = p0 * q0 - p1 * q1.conj()
    out[..., 1] = p0 * q1 + p1 * q0.conj()
    return out.view(np.float64)


def conj(x: Floats) -> Floats:
    """The conjugate x* of dual quaternions (..., 8); the inverse of a pose."""
    return x * C8


def pure(twist: Floats) -> Floats:
    """A 6-vector as a pure dual quaternion (..., 8): E6 of the equations."""
    out = np.zeros((*twist.shape[:-1], 8))
    out[..., 1:4] = twist[..., :3]
    out[..., 5:8] = twist[..., 3:]
    return out


def vector(x: Floats) -> Floats:
    """The 6-vector of the imaginary parts of dual quaternions (..., 8); undoes `pure`."""
    out = np.empty((*x.shape[:-1], 6))
    out[..., :3] = x[..., 1:4]
    out[..., 3:] = x[..., 5:8]
    return out


def cross(a: Floats, b: Floats) -> Floats:
    """The vector product of (..., 3); a tenth of the overhead of `numpy.cross`."""
    a, b = np.broadcast_arrays(a, b)
    out = np.empty(a.shape)
    out[..., 0] = a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1]
    out[..., 1] = a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2]
    out[..., 2] = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return out


def spatial_cross(a: Floats, b: Floats) -> Floats:
    """[w; v] x [w2; v2] = [w x w2; w x v2 + v x w2] of twists (..., 6)."""
    w, v, w2, v2 = a[..., :3], a[..., 3:], b[..., :3], b[..., 3:]
    return np.concatenate([cross(w, w2), cross(w, v2) + cross(v, w2)], axis=-1)


# Exponential and logarithm. Near zero angle the factors are series: a quotient there loses digits.


def _sinc(angle: Floats) -> Floats:
    return np.sinc(angle / np.pi)


def _sinc_slope(angle: Floats) -> Floats:
    """(cos a - sin a / a) / a^2, the derivative of sin(a)/a divided by a."""
    small = angle < 0.5
    out, y = np.zeros_like(angle), np.where(small, angle, 0.0) ** 2
    if small.any():
        for coefficient in _SINC_SLOPE:
            out = out * y + coefficient
    if not small.all():
        safe = np.where(small, 1.0, angle)
        out = np.where(small, out, (np.cos(safe) - np.sin(safe) / safe) / safe**2)
    return out


# (-1)^k 2k / (2k+1)!, highest power first: exact to the last digit below 0.5
_SINC_SLOPE = (
    -14.0 / 1307674368000, 12.0 / 6227020800, -10.0 / 39916800, 8.0 / 362880,
    -6.0 / 5040, 4.0 / 120, -2.0 / 6,
)  # fmt: skip


def exp(half: Floats) -> Floats:
    """The pose of half a displacement (..., 6), a pure dual quaternion.

    A twist xi held for a time t moves a pose x to exp(t xi / 2) x.
    """
    return _in_blocks(_exp, 8, half)


def _exp(out: Floats, half: Floats) -> None:
    columns = np.ascontiguousarray(half.T)
    a, b = columns[:3], columns[3:]
    angle = np.sqrt(_dot(a, a))
    s, ab = _sinc(angle), _dot(a, b)
    out[..., 0] = np.cos(angle)
    out[..., 1:4] = (s * a).T
    out[..., 4] = -s * ab
    out[..., 5:8] = (s * b + _sinc_slope(angle) * ab * a).T


def _dot(a: Floats, b: Floats) -> Floats:
    """The products a . b (...,) of columns (3, ...)."""
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


def log(x: Floats, short: bool = True) -> Floats:
    """Half the displacement (..., 6) of a pose, the short way: exp(log(x)) is x or -x.

    2 log(x) = [theta l; d l + theta m], theta in [0, pi]: turn theta about and move d along the
    line with direction l and moment m. Not `short` exp(log(x)) is x, and theta in [0, 2 pi); at a
    whole turn, x = -1, every line is one, and it is taken for none.
    """
    return _in_blocks(partial(_log, short=short), 6, x)


def _log(out: Floats, x: Floats, short: bool) -> None:
    columns = np.ascontiguousarray(x.T)
    if short:
        columns = np.where(columns[0] < 0, -columns, columns)
    v, w_dual, v_dual = columns[1:4], columns[4], columns[5:8]
    s = np.sqrt(_dot(v, v))
    angle = np.arctan2(s, columns[0])
    g = np.where(s > 0, angle / np.where(s > 0, s, 1.0), 1.0)  # angle / sin(angle)
    a = g * v
    ab = -w_dual * g
    out[..., :3] = a.T
    out[..., 3:] = (g * (v_dual - _sinc_slope(angle) * ab * a)).T


def left_jacobian(screw: Floats) -> Floats:
    """Jl(z) (6, 6) of a displacement z (6,), twice a logarithm.

    For x = exp(z / 2) the twist is Jl(z) z_dot, with x_dot = 1/2 xi x; the body twist is
    Jl(-z) z_dot. Jl(z) = sum_k ad(z)^k / (k + 1)!, with ad(z) a the product `spatial_cross(z, a)`.
    """
    w, v = (_cross_matrix(half) for half in (screw[:3], screw[3:]))
    ad = np.zeros((6, 6))
    ad[:3, :3] = ad[3:, 3:] = w
    ad[3:, :3] = v
    found = np.eye(6)
    for k in range(_JACOBIAN_TERMS, 1, -1):  # Horner
        found = np.eye(6) + ad @ found / k
    return found


_JACOBIAN_TERMS = 48  # for one turn: (2 pi)^48 / 49! is 1e-25; half a turn would need 24


def _cross_matrix(a: Floats) -> Floats:
    """[a]x (3, 3), with [a]x b = a x b."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def power(x: Floats, s: ArrayLike) -> Floats:
    """The pose `s` (...,) of the way from the identity to x, along one screw."""
    return exp(np.asarray(s, dtype=np.float64)[..., None] * log(x))


def sclerp(a: Floats, b: Floats, s: ArrayLike) -> Floats:
    """The pose `s` (...,) of the way from a to b along the one screw between them (ScLERP)."""
    return mul(a, power(mul(conj(a), b), s))


def adjoint(x: Floats, a: Floats) -> Floats:
    """Ad(x) a = x a x*: a twist (..., 6) given in frame x, seen from the base."""
    if x.ndim == a.ndim == 1:  # a control step
        carried: Floats = np.dot(np.dot(np.dot(_ADJOINT, x).reshape(36, 8), x).reshape(6, 6), a)
        return carried
    return vector(mul(mul(x, pure(a)), conj(x)))


# Double cover


def nearest(x: Floats, to: Floats) -> Floats:
    """The one of x and -x (..., 8) on the side of `to`: the way between them is the short one."""
    if x.ndim == to.ndim == 1:
        return -x if np.dot(x[:4], to[:4]) < 0 else x
    dot = (x[..., :4] * to[..., :4]).sum(-1, keepdims=True)
    near: Floats = np.where(dot < 0, -x, x)
    return near


def continuous(x: Floats) -> Floats:
    """The poses (N, 8) of a path with signs that never jump, beginning with its own first sign."""
    dots = (x[1:, :4] * x[:-1, :4]).sum(-1)
    signs = np.concatenate([[1.0], np.cumprod(np.where(dots < 0, -1.0, 1.0))])
    return np.asarray(x * signs[:, None])


# Conversions. Names read target_from_source.


def pose_from(translation: ArrayLike, rotation: ArrayLike) -> Floats:
    """The pose (..., 8) from t (..., 3) [m] and a unit quaternion r (..., 4)."""
    t, r = np.asarray(translation, np.float64), np.asarray(rotation, np.float64)
    t4 = np.concatenate([np.zeros((*t.shape[:-1], 1)), t], axis=-1)
    dual = 0.5 * quaternion_mul(t4, r)
    return np.concatenate([np.broadcast_to(r, dual.shape), dual], axis=-1)


def rotation(x: Floats) -> Floats:
    """The unit quaternion (..., 4) of a pose."""
    return x[..., :4]


def translation(x: Floats) -> Floats:
    """The place t (..., 3) [m] of a pose: 2 d r*."""
    if x.ndim == 1:
        place: Floats = np.dot(np.dot(_PLACE, x).reshape(3, 8), x)
        return place
    if x.size <= FEW:
        few: Floats = np.matvec(np.dot(x, _PLACE.T).reshape(*x.shape[:-1], 3, 8), x)
        return few
    return 2.0 * quaternion_mul(x[..., 4:], x[..., :4] * C4)[..., 1:]


def rotate(q: Floats, v: Floats) -> Floats:
    """The vector v (..., 3) turned by the unit quaternion q (..., 4)."""
    u = q[..., 1:]
    uv = 2.0 * cross(u, v)
    return np.asarray(v + q[..., :1] * uv + cross(u, uv))


def matrix_from_quaternion(q: Floats) -> Floats:
    """The rotation matrix (..., 3, 3) of a unit quaternion."""
    eye = np.broadcast_to(np.eye(3), (*q.shape[:-1], 3, 3))
    return np.swapaxes(rotate(q[..., None, :], eye), -1, -2)  # turned unit vectors are its columns


def quaternion_from_matrix(R: Floats) -> Floats:
    """The unit quaternion (..., 4), scalar part not negative, of a rotation matrix (..., 3, 3).

    From the largest of the four products, so that no digit is lost at any angle
    (Bar-Itzhack, "New method for extracting the quaternion from a rotation matrix", 2000, is the
    eigenvector of the same 4 x 4 matrix; this is its best column).
    """
    r = np.moveaxis(R, (-2, -1), (0, 1))
    trace = r[0, 0] + r[1, 1] + r[2, 2]
    K = np.empty((*R.shape[:-2], 4, 4))
    K[..., 0, 0] = 1 + trace
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        K[..., 0, i + 1] = K[..., i + 1, 0] = r[k, j] - r[j, k]
        K[..., i + 1, i + 1] = 1 + 2 * r[i, i] - trace
        K[..., i + 1, j + 1] = K[..., j + 1, i + 1] = r[i, j] + r[j, i]
    best = np.argmax(np.diagonal(K, axis1=-2, axis2=-1), axis=-1)
    q = np.take_along_axis(K, best[..., None, None], axis=-1)[..., 0]
    q = q / np.sqrt((q * q).sum(-1, keepdims=True))
    signed: Floats = np.where(q[..., :1] < 0, -q, q)
    return signed


def pose_from_matrix(T: Floats) -> Floats:
    """The pose (..., 8) of a homogeneous matrix (..., 4, 4)."""
    return pose_from(T[..., :3, 3], quaternion_from_matrix(T[..., :3, :3]))


def matrix_from_pose(x: Floats) -> Floats:
    """The homogeneous matrix (..., 4, 4) of a pose."""
    T = np.zeros((*x.shape[:-1], 4, 4))
    T[..., :3, :3] = matrix_from_quaternion(x[..., :4])
    T[..., :3, 3] = translation(x)
    T[..., 3, 3] = 1.0
    return T


def twist_from_screw(axis: ArrayLike, point: ArrayLike, pitch: ArrayLike = 0.0) -> Floats:
    """The unit twist (..., 6) of a screw: 1 rad/s about the line, pitch [m/rad] along it.

    The line goes through `point` (..., 3) [m] along the unit vector `axis` (..., 3); its moment is
    m = p x l, and the dual part of the twist is m + h l.
    """
    direction, p = np.asarray(axis, np.float64), np.asarray(point, np.float64)
    h = np.asarray(pitch, np.float64)[..., None]
    moment = cross(p, direction) + h * direction
    return np.concatenate([np.broadcast_to(direction, moment.shape), moment], axis=-1)


def point_velocity(twist: Floats, point: Floats) -> Floats:
    """The velocity p_dot = v0 + w x p (..., 3) [m/s] of a point (..., 3) carried by a twist."""
    return np.asarray(twist[..., 3:] + cross(twist[..., :3], point))


def point_acceleration(twist: Floats, acceleration: Floats, point: Floats) -> Floats:
    """p_ddot = v0_dot + w_dot x p + w x p_dot (..., 3) [m/s^2] of a point carried by a twist."""
    return np.asarray(
        point_velocity(acceleration, point) + cross(twist[..., :3], point_velocity(twist, point))
    )


def twist_from_point(angular: Floats, velocity: Floats, point: Floats) -> Floats:
    """The spatial twist (..., 6) of a body turning with `angular`, its `point` moving.

    v0 = p_dot + p x w.
    """
    return np.concatenate([angular, velocity + cross(point, angular)], axis=-1)


def acceleration_from_point(
    angular: Floats, angular_dot: Floats, velocity: Floats, velocity_dot: Floats, point: Floats
) -> Floats:
    """The plain derivative (..., 6) of `twist_from_point`.

    v0_dot = p_ddot + p_dot x w + p x w_dot.
    """
    dual = velocity_dot + cross(velocity, angular) + cross(point, angular_dot)
    return np.concatenate([angular_dot, dual], axis=-1)
