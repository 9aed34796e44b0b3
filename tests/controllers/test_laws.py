"""Each law against the same law written otherwise, and against its own differential equation."""

import dqrobotics
import numpy as np
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS, Seen
from dqpaint.controllers.pose_errors import invariant_error, spatial_error
from dqpaint.robots.card import read_card
from dqpaint.robots.kinematics import Kinematics, manipulability
from dqpaint.robots.resolver import resolve
from tests.conftest import random_poses, random_rotations

ARM = Kinematics(read_card("iiwa"))


def law(name, **gains):
    chosen = CONTROLLERS[name]
    return lambda seen: chosen.law(seen, chosen.read_gains(gains).first)


def states(rng, n, size=0.3):
    """What a law sees at random healthy postures, with errors up to about `size`."""
    out = []
    while len(out) < n:
        q = rng.uniform(ARM.card.lower, ARM.card.upper)
        x, J = ARM.pose_and_jacobian(q)
        if manipulability(J) < 0.03:
            continue
        error = dq.exp(rng.uniform(-size, size, 6) / 2)
        x_d = dq.mul(error, x) * rng.choice([-1, 1])
        out.append(Seen(x, x_d, rng.normal(size=6), rng.normal(size=6), J, q, 0.0, 0.008))
    return out


def peer_rates(seen, k, feed_forward):
    """N^+ (k e - vec(x* x_d_dot)) with dqrobotics' own primitives and an 8 x n pseudo-inverse."""
    x = dqrobotics.DQ(list(seen.pose))
    x_d = dqrobotics.DQ(list(dq.nearest(seen.pose_d, seen.pose)))
    E6 = np.zeros((8, 6))
    E6[[1, 2, 3, 5, 6, 7], range(6)] = 1
    J8 = 0.5 * x.haminus8() @ E6 @ seen.jacobian
    N = x_d.haminus8() @ dqrobotics.C8() @ J8
    e = (dqrobotics.DQ([1]) - x.conj() * x_d).vec8()
    rate_d = 0.5 * dqrobotics.DQ(list(dq.pure(seen.twist_d))) * x_d
    wanted = k * e - feed_forward * (x.conj() * rate_d).vec8()
    return np.linalg.pinv(N, rcond=1e-8) @ wanted


@pytest.mark.parametrize(("name", "feed_forward"), [("p", 0), ("pff", 1)])
def test_proportional_laws_agree_with_dqrobotics(rng, name, feed_forward):
    for seen in states(rng, 100):
        ours = resolve(
            seen.jacobian, dq.translation(seen.pose), law(name, k=7.0)(seen), np.zeros(7)
        )
        np.testing.assert_allclose(ours, peer_rates(seen, 7.0, feed_forward), atol=1e-9, rtol=1e-7)


def test_hinf_set_is_its_equation(rng):
    """x_e by homogeneous matrices: R_e = R R_d', p_e = p - R_e p_d."""
    for seen in states(rng, 50):
        T, T_d = dq.matrix_from_pose(seen.pose), dq.matrix_from_pose(seen.pose_d)
        T_e = T @ np.linalg.inv(T_d)
        q = dqrobotics.DQ(list(spatial_error(seen.pose, seen.pose_d)))
        assert q.q[0] >= 0
        u = law("hinf-set", gamma_O=0.1, gamma_T=0.05)(seen)
        angle = np.arccos(np.clip((np.trace(T_e[:3, :3]) - 1) / 2, -1, 1))
        axis = np.array([T_e[2, 1] - T_e[1, 2], T_e[0, 2] - T_e[2, 0], T_e[1, 0] - T_e[0, 1]]) / (
            2 * np.sin(angle)
        )
        np.testing.assert_allclose(u[:3], -(2 / 0.1) * np.sin(angle / 2) * axis, atol=1e-7)
        np.testing.assert_allclose(u[3:], -np.sqrt(2) / 0.05 * T_e[:3, 3], atol=1e-10)


def simulate(name, gains, x, x_d_of, seconds, steps):
    """The ideal body under a law, by RK4 on exponential coordinates: error poses along the way."""
    chosen = law(name, **gains)
    h = seconds / steps
    errors = []

    def twist(pose, t):
        pose_d, twist_d = x_d_of(t)
        seen = Seen(pose, pose_d, twist_d, np.zeros(6), np.zeros((6, 0)), np.zeros(0), t, h)
        return chosen(seen)

    for k in range(steps):
        t = k * h
        errors.append(spatial_error(x, x_d_of(t)[0]))
        a = twist(x, t)
        b = twist(dq.mul(dq.exp(0.25 * h * a), x), t + h / 2)
        c = twist(dq.mul(dq.exp(0.25 * h * b), x), t + h / 2)
        d = twist(dq.mul(dq.exp(0.5 * h * c), x), t + h)
        x = dq.mul(dq.exp(0.5 * h * (a + 2 * b + 2 * c + d) / 6), x)
    errors.append(spatial_error(x, x_d_of(seconds)[0]))
    return np.array(errors)


RATES = [
    ("p", {"k": 5.0}, 5.0, 5.0), ("pff", {"k": 5.0}, 5.0, 5.0),
    ("hinf-set", {"gamma_O": 0.25, "gamma_T": 0.5}, 4.0, np.sqrt(2) / 0.5),
    ("hinf", {"gamma_O": 0.25, "gamma_T": 0.5}, 4.0, np.sqrt(2) / 0.5),
]  # fmt: skip


@pytest.mark.parametrize(("name", "gains", "turning", "moving"), RATES)
def test_small_errors_decay_at_the_stated_rates(rng, name, gains, turning, moving):
    """A rotation alone and a translation alone; within 1 %."""
    x_d = random_poses(rng, 1)[0]
    at = dq.translation(x_d)
    axis = random_rotations(rng, 1)[0][1:]
    spin = np.concatenate([axis, dq.cross(at, axis)])  # a turn about the tool itself
    move = np.concatenate([np.zeros(3), axis])
    for start, rate, part in ((spin, turning, slice(0, 3)), (move, moving, slice(3, 6))):
        x = dq.mul(dq.exp(0.5 * 0.01 * start), x_d)
        errors = simulate(name, gains, x, lambda _t: (x_d, np.zeros(6)), 0.5, 500)
        left = np.linalg.norm(dq.log(errors)[:, part], axis=1)
        assert np.log(left[0] / left[-1]) / 0.5 == pytest.approx(rate, rel=0.01)


@pytest.mark.parametrize("name", ["pff", "hinf"])
def test_feed_forward_leaves_no_lag_on_a_moving_pose(rng, name):
    xi, x0 = rng.normal(size=6), random_poses(rng, 1)[0]

    def asked(t):
        return dq.mul(dq.exp(0.5 * np.sin(t) * xi), x0), np.cos(t) * xi

    errors = simulate(name, {}, x0, asked, 2.0, 2000)
    assert np.abs(dq.log(errors)).max() < 1e-9
    off = simulate(name, {}, dq.mul(dq.exp(0.05 * rng.normal(size=6)), x0), asked, 2.0, 2000)
    assert np.abs(dq.log(off[-1])).max() < 1e-9


def test_the_feed_forward_of_hinf_is_the_asked_twist_carried_to_the_error(rng):
    """hinf - hinf-set = Ad(x_e) xi_d, by the 6 x 6 matrix of a homogeneous one."""
    for seen in states(rng, 30, size=2.0):
        T = dq.matrix_from_pose(seen.pose) @ np.linalg.inv(dq.matrix_from_pose(seen.pose_d))
        R, p = T[:3, :3], T[:3, 3]
        cross = np.array([[0, -p[2], p[1]], [p[2], 0, -p[0]], [-p[1], p[0], 0]])
        wanted = np.r_[R @ seen.twist_d[:3], R @ seen.twist_d[3:] + cross @ R @ seen.twist_d[:3]]
        added = law("hinf")(seen) - law("hinf-set")(seen)
        np.testing.assert_allclose(added, wanted, atol=1e-11)


def test_hinf_error_obeys_its_own_differential_equation(rng):
    """d(2 (1 - eta))/dt = -K_O |Im r_e|^2 and d|p_e|^2/dt = -2 K_T |p_e|^2, from large errors."""
    x, x_d = random_poses(rng, 2)
    errors = simulate(
        "hinf-set", {"gamma_O": 0.5, "gamma_T": 0.5}, x, lambda _t: (x_d, np.zeros(6)), 0.4, 4000
    )
    h = 1e-4
    eta, sine = errors[:, 0], (errors[:, 1:4] ** 2).sum(1)
    np.testing.assert_allclose((2 * (eta[:-2] - eta[2:]) / (2 * h)), -4.0 * sine[1:-1], rtol=1e-5)
    p = (dq.translation(errors) ** 2).sum(1)
    np.testing.assert_allclose(
        (p[2:] - p[:-2]) / (2 * h), -2 * np.sqrt(2) / 0.5 * p[1:-1], rtol=1e-5
    )


def test_gammas_give_the_gains_of_the_thesis():
    gains = CONTROLLERS["hinf"].read_gains({}).first
    assert pytest.approx(40) == gains.K_O
    assert pytest.approx(20, rel=1e-3) == gains.K_T
    # equal pairs: sqrt(2) sqrt(g^-2 + g^-2) and sqrt(g^-2 + g^-2)
    assert pytest.approx(np.sqrt(2) * np.sqrt(2 / gains.gamma_O**2)) == gains.K_O
    assert pytest.approx(np.sqrt(2 / gains.gamma_T**2)) == gains.K_T


def test_errors_are_the_ones_of_the_papers(rng):
    x, x_d = random_poses(rng, 2)
    if (x[:4] @ x_d[:4]) < 0:
        x_d = -x_d
    e = (dqrobotics.DQ([1]) - dqrobotics.DQ(list(x)).conj() * dqrobotics.DQ(list(x_d))).vec8()
    np.testing.assert_allclose(invariant_error(x, x_d), e, atol=1e-14)
    moved = random_poses(rng, 1)[0]
    again = invariant_error(dq.mul(moved, x), dq.mul(moved, x_d))
    np.testing.assert_allclose(again, e, atol=1e-13)  # the same from any frame
