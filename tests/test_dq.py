"""The algebra against dqrobotics, pinocchio, the axioms of a group, and at its hard edges."""

from fractions import Fraction
from math import factorial

import dqrobotics
import numpy as np
import pinocchio
import pytest

from dqpaint import dq
from tests.support.random_poses import random_poses, random_rotations

EXACT = 1e-14
LOG_TOLERANCE = 1e-12  # of exp(log(x)) as a pose, for every angle


def peer(x):
    return dqrobotics.DQ(list(x))


def as_pose_difference(a, b):
    """The larger of position [m] and rotation difference of poses, whatever their signs."""
    a = dq.nearest(a, b)
    return np.abs(dq.matrix_from_pose(a) - dq.matrix_from_pose(b)).max()


def test_product_and_conjugate_agree_with_dqrobotics(rng):
    a, b = rng.normal(size=(2, 50, 8))
    ours = dq.mul(a, b)
    for i in range(50):
        np.testing.assert_allclose(ours[i], (peer(a[i]) * peer(b[i])).vec8(), atol=EXACT)
        np.testing.assert_allclose(dq.mul(a[i], b[i]), ours[i], atol=EXACT)
        np.testing.assert_allclose(dq.conj(a[i]), peer(a[i]).conj().vec8(), atol=EXACT)


def test_hamilton_operators_agree_with_dqrobotics_and_the_product(rng):
    a, b = rng.normal(size=(2, 20, 8))
    np.testing.assert_allclose(
        (dq.hamilton_plus(a) @ b[..., None])[..., 0], dq.mul(a, b), atol=EXACT
    )
    np.testing.assert_allclose(
        (dq.hamilton_minus(b) @ a[..., None])[..., 0], dq.mul(a, b), atol=EXACT
    )
    for x in a:
        np.testing.assert_array_equal(dq.hamilton_plus(x), peer(x).hamiplus8())
        np.testing.assert_array_equal(dq.hamilton_minus(x), peer(x).haminus8())


def test_product_is_associative_and_conjugation_reverses_it(rng):
    a, b, c = rng.normal(size=(3, 40, 8))
    np.testing.assert_allclose(dq.mul(dq.mul(a, b), c), dq.mul(a, dq.mul(b, c)), atol=1e-13)
    np.testing.assert_allclose(dq.conj(dq.mul(a, b)), dq.mul(dq.conj(b), dq.conj(a)), atol=EXACT)


def test_poses_are_a_group(rng):
    x, y = random_poses(rng, 40), random_poses(rng, 40)
    np.testing.assert_allclose(dq.mul(x, dq.conj(x)), np.tile(dq.IDENTITY, (40, 1)), atol=EXACT)
    composed = dq.matrix_from_pose(x) @ dq.matrix_from_pose(y)
    np.testing.assert_allclose(dq.matrix_from_pose(dq.mul(x, y)), composed, atol=1e-13)


def test_product_broadcasts_over_leading_shapes(rng):
    a, b = rng.normal(size=(5, 1, 8)), rng.normal(size=(3, 8))
    out = dq.mul(a, b)
    assert out.shape == (5, 3, 8)
    np.testing.assert_allclose(out[4, 2], dq.mul(a[4, 0], b[2]), atol=EXACT)


def test_rotation_of_the_log_agrees_with_dqrobotics(rng):
    """Only the rotation: dqrobotics puts half the translation into the dual part of its log."""
    x = random_poses(rng, 50)
    x[x[:, 0] < 0] *= -1  # dqrobotics does not choose the short way
    for pose, half in zip(x, dq.log(x), strict=True):
        np.testing.assert_allclose(half[:3], peer(pose).log().vec8()[1:4], atol=1e-12)


def test_exp_agrees_with_pinocchio(rng):
    for half in rng.normal(size=(50, 6)):
        M = pinocchio.exp6(pinocchio.Motion(2 * half[3:], 2 * half[:3])).homogeneous
        np.testing.assert_allclose(dq.matrix_from_pose(dq.exp(half)), M, atol=1e-13)


def test_log_agrees_with_pinocchio(rng):
    for x in random_poses(rng, 50):
        body = pinocchio.log6(pinocchio.SE3(dq.matrix_from_pose(x))).vector  # (v, w)
        ours = 2 * dq.log(x)
        np.testing.assert_allclose(ours, np.r_[body[3:], body[:3]], atol=1e-11)


ANGLES = [0.0, 1e-300, 1e-160, 1e-12, 1e-9, 1e-6, 1e-3, 0.1, 0.4999, 0.5, 0.5001, 0.9999, 1.0,
          1.0001, 2.0, 3.0, np.pi - 1e-3, np.pi - 1e-9, np.pi - 1e-15, np.pi]  # fmt: skip


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("sign", [1, -1])
def test_exp_undoes_log_at_every_angle(rng, angle, sign):
    axes = rng.normal(size=(200, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    r = np.concatenate([np.full((200, 1), np.cos(angle / 2)), np.sin(angle / 2) * axes], axis=1)
    x = sign * dq.pose_from(rng.normal(size=(200, 3)), r)
    half = dq.log(x)
    assert as_pose_difference(dq.exp(half), x) < LOG_TOLERANCE
    turned = 2 * np.linalg.norm(half[:, :3], axis=1)
    np.testing.assert_allclose(turned, angle, atol=1e-15, rtol=1e-13)  # the short way, either sign


def test_exp_undoes_log_at_random_angles(rng):
    x = random_poses(rng, 20000)
    assert as_pose_difference(dq.exp(dq.log(x)), x) < LOG_TOLERANCE


@pytest.mark.parametrize("angle", [0, 1e-8, 1e-3, 0.1, 0.3, 0.49, 0.4999999, 0.5, 0.51, 0.8, 1.5])
def test_the_factor_of_exp_against_exact_fractions(angle):
    """(cos a - sin a / a) / a^2 to the last places on both sides of where its series ends."""
    y = Fraction(angle) ** 2
    exact = sum(
        (-1) ** k * Fraction(2 * k, factorial(2 * k + 1)) * y ** (k - 1) for k in range(1, 30)
    )
    assert abs(float(dq._sinc_slope(np.array(float(angle))) - float(exact))) < 1e-15


def test_one_twist_held_is_the_exponential(rng):
    """x_dot = xi x / 2, by central differences of t -> exp(t xi / 2) x0."""
    xi, x0 = rng.normal(size=(20, 6)), random_poses(rng, 20)
    errors = []
    for h in (1e-3, 5e-4):
        ahead, behind = (dq.mul(dq.exp(0.5 * (0.7 + s * h) * xi), x0) for s in (1, -1))
        now = dq.mul(dq.exp(0.35 * xi), x0)
        errors.append(np.abs((ahead - behind) / (2 * h) - 0.5 * dq.mul(dq.pure(xi), now)).max())
    assert 3.8 < errors[0] / errors[1] < 4.2


def test_screw_turns_about_its_line_and_advances_along_it(rng):
    """An independent truth: geometry. Points of the axis slide, others keep their distance."""
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    point, pitch, angle = rng.normal(size=3), 0.37, 1.9
    twist = dq.twist_from_screw(axis, point, pitch)
    T = dq.matrix_from_pose(dq.exp(0.5 * angle * twist))
    for along in (-2.0, 0.0, 1.3):
        p = point + along * axis
        np.testing.assert_allclose(T[:3, :3] @ p + T[:3, 3], p + pitch * angle * axis, atol=1e-14)
    other = rng.normal(size=3)
    moved = T[:3, :3] @ other + T[:3, 3]

    def arm(q):
        return (q - point) - axis * ((q - point) @ axis)

    np.testing.assert_allclose(np.linalg.norm(arm(moved)), np.linalg.norm(arm(other)), atol=1e-14)
    sine = axis @ np.cross(arm(other), arm(moved)) / (arm(other) @ arm(other))
    np.testing.assert_allclose(sine, np.sin(angle), atol=1e-13)  # right-handed


def test_sclerp_goes_from_a_to_b_with_one_body_screw(rng):
    a, b = random_poses(rng, 30), random_poses(rng, 30)
    assert as_pose_difference(dq.sclerp(a, b, 0.0), a) < 1e-12
    assert as_pose_difference(dq.sclerp(a, b, 1.0), b) < 1e-12
    s = np.linspace(0, 1, 7)
    path = dq.sclerp(a[0], b[0], s)
    steps = dq.log(dq.mul(dq.conj(path[:-1]), path[1:]))
    np.testing.assert_allclose(steps, np.tile(steps[0], (6, 1)), atol=1e-13)
    opposite = dq.sclerp(a, -b, s[:, None])
    assert as_pose_difference(opposite, dq.sclerp(a, b, s[:, None])) < 1e-12


def test_power_repeated_is_the_product(rng):
    x = random_poses(rng, 20)
    third = dq.power(x, 1 / 3)
    assert as_pose_difference(dq.mul(dq.mul(third, third), third), x) < 1e-12


def test_adjoint_agrees_with_pinocchio_and_dqrobotics(rng):
    for x, xi in zip(random_poses(rng, 20), rng.normal(size=(20, 6)), strict=True):
        motion = pinocchio.SE3(dq.matrix_from_pose(x)).act(pinocchio.Motion(xi[3:], xi[:3]))
        np.testing.assert_allclose(
            dq.adjoint(x, xi), np.r_[motion.angular, motion.linear], atol=1e-13
        )
        other = dqrobotics.Ad(peer(x), peer(dq.pure(xi))).vec8()
        np.testing.assert_allclose(dq.pure(dq.adjoint(x, xi)), other, atol=1e-13)


def test_spatial_cross_agrees_with_pinocchio_and_the_commutator(rng):
    a, b = rng.normal(size=(2, 20, 6))
    commutator = 0.5 * (dq.mul(dq.pure(a), dq.pure(b)) - dq.mul(dq.pure(b), dq.pure(a)))
    np.testing.assert_allclose(dq.pure(dq.spatial_cross(a, b)), commutator, atol=EXACT)
    for x, y in zip(a, b, strict=True):
        m = pinocchio.Motion(x[3:], x[:3]).cross(pinocchio.Motion(y[3:], y[:3]))
        np.testing.assert_allclose(dq.spatial_cross(x, y), np.r_[m.angular, m.linear], atol=EXACT)


def test_nearest_takes_the_short_way_and_continuous_never_jumps(rng):
    x = random_poses(rng, 100)
    y = random_poses(rng, 100)
    dots = (dq.nearest(x, y)[:, :4] * y[:, :4]).sum(1)
    assert (dots >= 0).all()
    far = x.copy()
    far[:, 4:] *= -100.0  # the side is that of the rotations, whatever the dual parts are
    assert ((dq.nearest(far, y)[:, :4] * y[:, :4]).sum(1) >= 0).all()
    assert all(dq.nearest(a, b)[:4] @ b[:4] >= 0 for a, b in zip(far, y, strict=True))
    path = dq.sclerp(x[0], y[0], np.linspace(0, 1, 50))
    torn = path * rng.choice([-1, 1], 50)[:, None]
    whole = dq.continuous(torn)
    assert ((whole[1:, :4] * whole[:-1, :4]).sum(1) > 0.9).all()
    np.testing.assert_array_equal(whole[0], torn[0])


def test_conversions_undo_each_other(rng):
    r = random_rotations(rng, 500)
    special = [
        [1, 0, 0, 0],
        [0, 1, 0, 0],
        [0, 0, 1, 0],
        [0, 0, 0, 1],
        [0, 0.6, -0.8, 0],
        [1e-9, 1, 0, 0],
    ]
    r = np.vstack([r, np.array(special, float) / np.linalg.norm(special, axis=1, keepdims=True)])
    t = rng.normal(size=(len(r), 3))
    x = dq.pose_from(t, r)
    np.testing.assert_allclose(dq.translation(x), t, atol=EXACT)
    T = dq.matrix_from_pose(x)
    np.testing.assert_allclose(
        T[:, :3, :3] @ T[:, :3, :3].swapaxes(1, 2), np.tile(np.eye(3), (len(r), 1, 1)), atol=EXACT
    )
    np.testing.assert_allclose(np.linalg.det(T[:, :3, :3]), 1, atol=EXACT)
    back = dq.pose_from_matrix(T)
    np.testing.assert_allclose(dq.nearest(back, x), x, atol=1e-14)
    for pose, matrix in zip(x[:50], T, strict=False):
        q = pinocchio.Quaternion(matrix[:3, :3]).coeffs()  # x y z w
        np.testing.assert_allclose(
            dq.nearest(np.r_[q[3], q[:3], 0, 0, 0, 0], pose)[:4], pose[:4], atol=1e-13
        )


def test_rotate_agrees_with_the_sandwich_product(rng):
    q, v = random_rotations(rng, 20), rng.normal(size=(20, 3))
    v4 = np.concatenate([np.zeros((20, 1)), v], axis=1)
    sandwich = dq.quaternion_mul(dq.quaternion_mul(q, v4), q * dq.C4)
    np.testing.assert_allclose(dq.rotate(q, v), sandwich[:, 1:], atol=EXACT)


def test_point_rates_agree_with_differences_of_a_moving_body(rng):
    """A point of the body x(t) = exp(f(t) xi / 2) exp(g(t) eta / 2) x0."""
    xi, eta = rng.normal(size=(2, 6))
    x0, body_point = random_poses(rng, 1)[0], rng.normal(size=3)

    def pose(t):
        return dq.mul(dq.mul(dq.exp(0.5 * np.sin(t) * xi), dq.exp(0.5 * t * t * eta)), x0)

    def twist(t):
        return np.cos(t) * xi + dq.adjoint(dq.exp(0.5 * np.sin(t) * xi), 2 * t * eta)

    def point(t):
        return dq.rotate(pose(t)[:4], body_point) + dq.translation(pose(t))

    t, h = 0.8, 1e-4
    acceleration = (twist(t + h) - twist(t - h)) / (2 * h)
    velocity = dq.point_velocity(twist(t), point(t))
    np.testing.assert_allclose(velocity, (point(t + h) - point(t - h)) / (2 * h), atol=1e-7)
    second = (point(t + h) - 2 * point(t) + point(t - h)) / h**2
    here = dq.point_acceleration(twist(t), acceleration, point(t))
    np.testing.assert_allclose(here, second, atol=1e-5)
    again = dq.twist_from_point(twist(t)[:3], velocity, point(t))
    np.testing.assert_allclose(again, twist(t), atol=1e-13)
    w, w_dot = twist(t)[:3], acceleration[:3]
    back = dq.acceleration_from_point(w, w_dot, velocity, here, point(t))
    np.testing.assert_allclose(back, acceleration, atol=1e-12)


def test_arguments_are_left_as_they_were(rng):
    x, xi = random_poses(rng, 3), rng.normal(size=(3, 6))
    kept = x.copy(), xi.copy()
    for call in (dq.conj, dq.log, dq.continuous, dq.translation, dq.matrix_from_pose):
        call(x)
    dq.exp(xi), dq.adjoint(x, xi), dq.nearest(x, -x), dq.mul(x, x)
    np.testing.assert_array_equal(x, kept[0])
    np.testing.assert_array_equal(xi, kept[1])


def test_many_rows_are_as_one_by_one(rng):
    """Across the blocks in which many are computed, and where they broadcast."""
    a, b = rng.normal(size=(2, 2 * dq.BLOCK + 7, 8))
    at = [0, 1, dq.BLOCK - 1, dq.BLOCK, 2 * dq.BLOCK, -1]
    x = dq.exp(a[:, :6])
    for function, arrays in {
        dq.mul: (a, b), dq.exp: (a[:, :6],), dq.log: (x,), dq.adjoint: (x, b[:, :6])
    }.items():  # fmt: skip
        many = function(*arrays)
        for k in at:
            one = function(*(array[k] for array in arrays))
            np.testing.assert_allclose(many[k], one, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(dq.mul(a, b[:1]), dq.mul(a, np.tile(b[0], (len(a), 1))))
    grid = dq.mul(a[:600].reshape(3, 200, 8), b[:200])
    np.testing.assert_allclose(grid[2, 5], dq.mul(a[405], b[5]), rtol=1e-13, atol=1e-13)
