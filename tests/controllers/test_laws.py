"""Each law against the same law written otherwise: dqrobotics, pinocchio, homogeneous matrices."""

import dqrobotics
import numpy as np
import pinocchio
import pytest
from dqrobotics.robot_modeling import DQ_Kinematics

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.controllers.base.pose_errors import invariant_error, spatial_error
from dqpaint.robots.kinematics.differential_ik import resolve
from tests.support.control import STILL, law, states
from tests.support.random_poses import random_poses

E6 = np.zeros((8, 6))
E6[[1, 2, 3, 5, 6, 7], range(6)] = 1


def joint_rates(name, seen, **gains):
    """What the arm is told, without a wish in the null space."""
    said = law(name, **gains)(seen)
    if CONTROLLERS[name].commands == "rates":
        return said
    return resolve(seen.jacobian, dq.translation(seen.pose), said, np.zeros(7))


def peers(seen):
    """x, x_d on its side, J8: in dqrobotics' own primitives."""
    x = dqrobotics.DQ(list(seen.pose))
    x_d = dqrobotics.DQ(list(dq.nearest(seen.pose_d, seen.pose)))
    return x, x_d, 0.5 * x.haminus8() @ E6 @ seen.jacobian


def peer_invariant(seen, k, feed_forward):
    """N^+ (k e - vec(x* x_d_dot)); dqrobotics' `1 - x` has the wrong sign, `DQ([1]) - x` not."""
    x, x_d, J8 = peers(seen)
    N = x_d.haminus8() @ dqrobotics.C8() @ J8
    e = (dqrobotics.DQ([1]) - x.conj() * x_d).vec8()
    rate_d = 0.5 * dqrobotics.DQ(list(dq.pure(seen.twist_d))) * x_d
    wanted = k * e - feed_forward * (x.conj() * rate_d).vec8()
    return np.linalg.pinv(N, rcond=1e-8) @ wanted


def peer_pham(seen, k):
    x, x_d, J8 = peers(seen)
    return np.linalg.pinv(J8, rcond=1e-8) @ (k * (x_d - x).vec8())


def peer_pham_t(seen, k):
    x, x_d, J8 = peers(seen)
    return J8.T @ (k * (x_d - x).vec8())


def peer_decoupled(seen, k_t, k_r):
    """[J_t; N_r]^+ [...] with dqrobotics' own translation and rotation Jacobians."""
    x, x_d, J8 = peers(seen)
    J_t = DQ_Kinematics.translation_jacobian(J8, x)
    N_r = x_d.P().haminus4() @ dqrobotics.C4() @ DQ_Kinematics.rotation_jacobian(J8)
    e_r = (dqrobotics.DQ([1]) - x.P().conj() * x_d.P()).vec4()
    e_t = (x_d.translation() - x.translation()).vec4()
    return np.linalg.pinv(np.vstack([J_t, N_r]), rcond=1e-8) @ np.r_[k_t * e_t, k_r * e_r]


@pytest.mark.parametrize(("name", "gains", "peer"), [
    ("p", {"k": 7.0}, lambda s: peer_invariant(s, 7.0, 0)),
    ("pff", {"k": 7.0}, lambda s: peer_invariant(s, 7.0, 1)),
    ("pham", {"k": 7.0}, lambda s: peer_pham(s, 7.0)),
    ("pham-t", {"k": 7.0}, lambda s: peer_pham_t(s, 7.0)),
    ("decoupled", {"k_t": 7.0, "k_r": 4.0}, lambda s: peer_decoupled(s, 7.0, 4.0)),
])  # fmt: skip
def test_laws_agree_with_dqrobotics(rng, name, gains, peer):
    for seen in states(rng, 100, size=1.0):
        ours = joint_rates(name, seen, **gains)
        np.testing.assert_allclose(ours, peer(seen), atol=1e-9, rtol=1e-7)


def twist_matrix(T):
    """Ad of a homogeneous matrix, 6 x 6, on [w; v]."""
    R, p = T[:3, :3], T[:3, 3]
    cross = np.array([[0, -p[2], p[1]], [p[2], 0, -p[0]], [-p[1], p[0], 0]])
    return np.block([[R, np.zeros((3, 3))], [cross @ R, R]])


def error_matrix(seen):
    return dq.matrix_from_pose(seen.pose) @ np.linalg.inv(dq.matrix_from_pose(seen.pose_d))


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_log_by_the_logarithm_of_pinocchio(rng, share):
    for seen in states(rng, 100, size=2.5):
        T = error_matrix(seen)
        v_w = pinocchio.log6(pinocchio.SE3(T)).vector
        wanted = -3.0 * np.r_[v_w[3:], v_w[:3]] + share * twist_matrix(T) @ seen.twist_d
        said = law("log", k=3.0, feed_forward=share)(seen)
        np.testing.assert_allclose(said, wanted, atol=1e-9)


def sine_and_place(T):
    """Im(r_e) and p_e by matrices: sin(angle / 2) about the axis, and the translation."""
    angle = np.arccos(np.clip((np.trace(T[:3, :3]) - 1) / 2, -1, 1))
    axis = np.array([T[2, 1] - T[1, 2], T[0, 2] - T[2, 0], T[1, 0] - T[0, 1]]) / 2 / np.sin(angle)
    return np.sin(angle / 2) * axis, T[:3, 3]


@pytest.mark.parametrize(("gains", "k_O", "k_T"), [
    ({"gamma_O": 0.1, "gamma_T": 0.05}, 2 / 0.1, np.sqrt(2) / 0.05),
    ({"K_O": 5.3, "K_T": 3.8}, 5.3, 3.8), ({"K_O": 5.3, "gamma_T": 0.372}, 5.3, np.sqrt(2) / 0.372),
])  # fmt: skip
def test_hinf_set_is_its_equation(rng, gains, k_O, k_T):
    for seen in states(rng, 50, size=1.0):
        sine, place = sine_and_place(error_matrix(seen))
        u = law("hinf-set", **gains)(seen)
        np.testing.assert_allclose(u[:3], -k_O * sine, atol=1e-6)
        np.testing.assert_allclose(u[3:], -k_T * place, rtol=1e-5, atol=1e-9)


def test_lqr_is_its_equation(rng):
    q, r = np.array([1.0, 2, 3, 4, 5, 6]), np.array([0.1, 0.2, 0.3, 0.1, 0.2, 0.3])
    P = np.sqrt(q * r)  # of a drawing that ends in this weight, at any time
    for seen in states(rng, 50, size=1.0):
        T = error_matrix(seen)
        sine, place = sine_and_place(T)
        wanted = -2 * P / r * np.r_[sine, place / 2] + twist_matrix(T) @ seen.twist_d
        said = law("lqr", q=tuple(q), r=tuple(r))(seen)
        np.testing.assert_allclose(said, wanted, atol=1e-6)


def test_lqr8_is_its_equation(rng):
    """N^+ R^-1 (P e + g) with the 8 x n matrix, any P and g, a diagonal R."""
    r = np.arange(1.0, 9.0)
    upper = np.triu_indices(8)
    for seen in states(rng, 50, size=1.0):
        P = rng.normal(size=(8, 8))
        P, g = P + P.T, rng.normal(size=8)
        x, x_d, J8 = peers(seen)
        N = x_d.haminus8() @ dqrobotics.C8() @ J8
        e = (dqrobotics.DQ([1]) - x.conj() * x_d).vec8()
        wanted = np.linalg.pinv(N, rcond=1e-8) @ ((P @ e + g) / r)
        one = CONTROLLERS["lqr8"].law()
        one._P, one._g = P[upper][None], g[None]
        twist = one(seen, CONTROLLERS["lqr8"].read_gains({"r": tuple(r)}).first)
        ours = resolve(seen.jacobian, dq.translation(seen.pose), twist, np.zeros(7))
        np.testing.assert_allclose(ours, wanted, atol=1e-9, rtol=1e-7)


def test_lqr8_of_a_drawing_that_stands_still_is_p(rng):
    """P = sqrt(q r) and g = 0: the proportional law at the rate sqrt(q / r)."""
    for seen in states(rng, 20):
        np.testing.assert_allclose(law("lqr8", STILL)(seen), law("p", k=20.0)(seen), atol=1e-9)


@pytest.mark.parametrize(("with_it", "without"), [("hinf", "hinf-set"), ("log", "log0")])
def test_the_feed_forward_is_the_asked_twist_carried_to_the_error(rng, with_it, without):
    """Ad(x_e) xi_d, by the 6 x 6 matrix of a homogeneous one."""
    for seen in states(rng, 30, size=2.0):
        plain = law("log", feed_forward=0)(seen) if without == "log0" else law(without)(seen)
        wanted = twist_matrix(error_matrix(seen)) @ seen.twist_d
        np.testing.assert_allclose(law(with_it)(seen) - plain, wanted, atol=1e-11)


def test_gammas_give_the_gains_of_the_thesis():
    gains = CONTROLLERS["hinf"].read_gains({}).first
    assert pytest.approx(40) == gains.k_O
    assert pytest.approx(20, rel=1e-3) == gains.k_T
    # equal pairs: sqrt(2) sqrt(g^-2 + g^-2) and sqrt(g^-2 + g^-2)
    assert pytest.approx(np.sqrt(2) * np.sqrt(2 / gains.gamma_O**2)) == gains.k_O
    assert pytest.approx(np.sqrt(2 / gains.gamma_T**2)) == gains.k_T


def test_errors_are_the_ones_of_the_papers(rng):
    x, x_d = random_poses(rng, 2)
    if (x[:4] @ x_d[:4]) < 0:
        x_d = -x_d
    e = (dqrobotics.DQ([1]) - dqrobotics.DQ(list(x)).conj() * dqrobotics.DQ(list(x_d))).vec8()
    np.testing.assert_allclose(invariant_error(x, x_d), e, atol=1e-14)
    moved = random_poses(rng, 1)[0]
    again = invariant_error(dq.mul(moved, x), dq.mul(moved, x_d))
    np.testing.assert_allclose(again, e, atol=1e-13)  # the same from any frame
    assert spatial_error(x, -x_d)[0] >= 0
