"""Where an error is taken: each law and point against matrices, and what follows from it."""

import numpy as np
import pytest

import dqpaint
from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.controllers.base.gains import choices_of
from dqpaint.dq import adjoint, conj, mul, pose_from
from dqpaint.robots.kinematics.jacobians import pose_map
from tests.support.control import SHORT, body_sees, law, states
from tests.support.random_poses import random_poses

WITH_POINT = [n for n, c in CONTROLLERS.items() if "point" in c.gains.model_fields]
AT_THE_TOOL = {"decoupled", "translation", "se3", "pi", "super-twisting"}  # by their definitions
FIXED = AT_THE_TOOL | {"orientation", "accel-decoupled"}
ANYWHERE = {"log", "open-loop", "accel", "sine", "admittance", "adaptive", "mpc"}
MIXED = {"p-least-squares", "sliding"}


def test_every_law_has_a_choice_or_a_reason():
    assert set(WITH_POINT) | FIXED | ANYWHERE | MIXED == set(CONTROLLERS)
    for name in WITH_POINT:
        assert choices_of(CONTROLLERS[name].gains, "point") == ("base", "tool")


def matrices(seen):
    """R_e, t, t_d, w_d, t_d_dot, sine of half the error angle: of homogeneous matrices."""
    T, T_d = (dq.matrix_from_pose(x) for x in (seen.pose, seen.pose_d))
    R_e = T[:3, :3] @ T_d[:3, :3].T
    angle = np.arccos(np.clip((np.trace(R_e) - 1) / 2, -1, 1))
    axis = np.array([R_e[2, 1] - R_e[1, 2], R_e[0, 2] - R_e[2, 0], R_e[1, 0] - R_e[0, 1]])
    sine = np.sin(angle / 2) * axis / 2 / np.sin(angle)
    w_d, v_d = np.split(seen.twist_d, 2)
    t, t_d = T[:3, 3], T_d[:3, 3]
    return R_e, t, t_d, w_d, v_d + np.cross(w_d, t_d), sine


def spatial(w, velocity, at):
    return np.r_[w, velocity - np.cross(w, at)]


@pytest.mark.parametrize("name", ["hinf", "hinf-set", "lqr"])
def test_the_tool_s_own_error(rng, name):
    """Angular and linear velocity of the tool, by rotation matrices."""
    for seen in states(rng, 100, size=1.0):
        R_e, t, t_d, w_d, t_d_dot, sine = matrices(seen)
        w, velocity = -40.0 * sine, -20.0 * (t - t_d)
        gains = {} if name == "lqr" else {"K_O": 40.0, "K_T": 20.0}
        if name != "hinf-set":
            w, velocity = w + R_e @ w_d, velocity + t_d_dot
        said = law(name, point="tool", **gains)(seen)
        np.testing.assert_allclose(said, spatial(w, velocity, t), atol=1e-9, rtol=1e-9)


@pytest.mark.parametrize("name", ["p", "pff"])
def test_the_invariant_error_from_the_right(rng, name):
    """u + (Ad(x_e) xi_d) by least squares of x_e_dot = -k (x_e - 1), with numpy's pinv."""
    for seen in states(rng, 100, size=1.0):
        x_e = mul(seen.pose, conj(dq.nearest(seen.pose_d, seen.pose)))
        u = np.linalg.pinv(pose_map(x_e)) @ (7.0 * (dq.IDENTITY - x_e))
        if name == "pff":
            u = u + dq.vector(mul(mul(x_e, dq.pure(seen.twist_d)), conj(x_e)))
        said = law(name, k=7.0, point="base")(seen)
        np.testing.assert_allclose(said, u, atol=1e-9, rtol=1e-9)


def shifted(seen, c):
    """The same thing seen from a base whose origin is at c."""
    y = pose_from(-c, [1.0, 0, 0, 0])
    return seen._replace(
        pose=mul(y, seen.pose), pose_d=mul(y, seen.pose_d), twist_d=adjoint(y, seen.twist_d),
        acceleration_d=adjoint(y, seen.acceleration_d), jacobian=adjoint(y, seen.jacobian.T).T,
    ), y  # fmt: skip


@pytest.mark.parametrize("name", ["pham", "pham-t", "hinf-set"])
def test_at_the_tool_is_about_the_base_of_a_base_at_the_tool(rng, name):
    """hinf-set has its twist about the tool's own place, the others about where it should be."""
    for seen in states(rng, 30, size=1.0):
        moved, y = shifted(seen, dq.translation(seen.pose_d))
        said, there = law(name, point="tool")(seen), law(name, point="base")(moved)
        if name == "hinf-set":
            p_e = dq.translation(seen.pose) - dq.translation(seen.pose_d)
            there = there + np.r_[np.zeros(3), -np.cross(there[:3], p_e)]
        back = there if name == "pham-t" else adjoint(conj(y), there)
        np.testing.assert_allclose(said, back, atol=1e-9, rtol=1e-9)


@pytest.mark.parametrize("name", [*sorted(ANYWHERE | AT_THE_TOOL), "p", "pff"])
def test_a_law_that_does_not_know_where_the_base_is(rng, name):
    """Screws, and errors at the tool: a base elsewhere gives the same joint rates."""
    for seen in states(rng, 30, size=1.0):
        moved, y = shifted(seen, rng.normal(size=3))
        said, there = law(name)(seen), law(name)(moved)
        back = there if CONTROLLERS[name].commands == "rates" else adjoint(conj(y), there)
        np.testing.assert_allclose(said, back, atol=1e-7, rtol=1e-9)


@pytest.mark.parametrize("name", ["hinf", "lqr", "pham", "pham-t"])
def test_a_law_that_does(rng, name):
    seen = states(rng, 1, size=1.0)[0]
    moved, y = shifted(seen, np.array([0.3, -0.2, 0.4]))
    said, there = law(name)(seen), law(name)(moved)
    back = there if name == "pham-t" else adjoint(conj(y), there)
    assert np.abs(back - said).max() > 0.01


def test_decoupled_and_hinf_set_are_one_law_at_two_points(rng):
    for seen in states(rng, 30, size=1.0):
        apart = law("decoupled", k_t=7.0, k_r=4.0)(seen)
        np.testing.assert_allclose(
            law("hinf-set", K_O=8.0, K_T=7.0, point="tool")(seen), apart, atol=1e-10
        )
        assert np.abs(law("hinf-set", K_O=8.0, K_T=7.0)(seen) - apart).max() > 1e-3


@pytest.mark.parametrize(("name", "point"), [
    ("hinf", "tool"), ("hinf", "base"), ("lqr", "tool"), ("pff", "base"),
])  # fmt: skip
def test_no_point_lags_behind_a_moving_reference(name, point):
    """Where there is no error the command is the reference's own twist."""
    for row in range(5, 80, 25):
        seen = body_sees(SHORT.pose[row], SHORT.pose[row], SHORT.twist[row])._replace(row=row)
        said = law(name, point=point)(seen)
        np.testing.assert_allclose(said, SHORT.twist[row], atol=1e-12)


@pytest.mark.parametrize(("name", "gains"), [("hinf", {"K_T": 20.0}), ("lqr", {})])
def test_at_the_tool_the_position_error_decays_by_itself(rng, name, gains):
    """d(t - t_d)/dt = -k (t - t_d) exactly, whatever the orientation error and the reference do."""
    said = law(name, point="tool", **gains)
    for _ in range(20):
        x, x_d, xi_d = random_poses(rng, 1)[0], random_poses(rng, 1)[0], rng.normal(size=6)
        u = said(body_sees(x, x_d, xi_d))
        t, t_d = dq.translation(x), dq.translation(x_d)
        change = dq.point_velocity(u, t) - dq.point_velocity(xi_d, t_d)
        np.testing.assert_allclose(change, -20.0 * (t - t_d), atol=1e-9)


def bow(**gains):
    """How far the light leaves the straight way of a step with a turn [m]."""
    run = dqpaint.draw("step", plant="ideal", size=(64, 36), gains=gains)
    points = run.track.points[np.flatnonzero(run.track.motion.jump)[0] :]
    way = points[-1] - points[0]
    off = np.cross(points - points[0], way / np.linalg.norm(way))
    return np.linalg.norm(off, axis=1).max()


def test_the_bow_of_hinf_on_a_step_is_where_its_error_is_taken():
    with_bow, straight = bow(), bow(point="tool")
    assert with_bow > 0.02
    assert straight < 0.002  # the rates are held for a period: the arm moves on arcs
