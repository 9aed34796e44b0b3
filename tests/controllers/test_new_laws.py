"""Open loop, least squares (3.2), position alone and orientation alone."""

import dqrobotics
import numpy as np
import pytest
from dqrobotics.robot_modeling import DQ_Kinematics

import dqpaint
from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.errors import UsageError
from tests.support.control import body_sees, law, states
from tests.support.random_poses import random_poses

E6 = np.zeros((8, 6))
E6[[1, 2, 3, 5, 6, 7], range(6)] = 1


def peers(seen):
    x = dqrobotics.DQ(list(seen.pose))
    x_d = dqrobotics.DQ(list(dq.nearest(seen.pose_d, seen.pose)))
    return x, x_d, 0.5 * x.haminus8() @ E6 @ seen.jacobian


def test_translation_is_the_pseudo_inverse_of_the_translation_jacobian(rng):
    for seen in states(rng, 100, size=1.0):
        x, x_d, J8 = peers(seen)
        J_p = DQ_Kinematics.translation_jacobian(J8, x)  # the thesis's [15, p. 77]
        t, t_d = x.translation().vec4(), x_d.translation().vec4()
        at = dq.translation(seen.pose_d)
        ahead = np.r_[0, seen.twist_d[3:] + np.cross(seen.twist_d[:3], at)]
        wanted = np.linalg.pinv(J_p, rcond=1e-9) @ (7.0 * (t_d - t) + 0.3 * ahead)
        ours = law("translation", k=7.0, feed_forward=0.3)(seen)
        np.testing.assert_allclose(ours, wanted, atol=1e-9, rtol=1e-9)


def test_orientation_is_the_pseudo_inverse_of_the_rotation_jacobian(rng):
    """vec(r_dot) = J_o q_dot; k vec(r_d - r), the part of it that is a rotation."""
    for seen in states(rng, 100, size=1.0):
        x, x_d, J8 = peers(seen)
        J_o = DQ_Kinematics.rotation_jacobian(J8)
        wanted = np.linalg.pinv(J_o, rcond=1e-9) @ (7.0 * (x_d.P() - x.P()).vec4())
        ours = law("orientation", k=7.0)(seen)
        np.testing.assert_allclose(ours, wanted, atol=1e-9, rtol=1e-9)
        turn = law("orientation", k=7.0, feed_forward=1.0)(seen) - ours
        np.testing.assert_allclose(seen.jacobian[:3] @ turn, seen.twist_d[:3], atol=1e-9)


def test_a_gain_matrix_of_three(rng):
    K = np.array([[20.0, 5, 0], [5, 20, 1], [0, 1, 8]])
    for seen in states(rng, 20, size=1.0):
        rates = law("translation", k=K)(seen)
        t = dq.translation(seen.pose)
        velocity = dq.point_velocity(seen.jacobian @ rates, t)
        np.testing.assert_allclose(velocity, K @ (dq.translation(seen.pose_d) - t), atol=1e-9)


def test_open_loop_is_the_reference_s_twist(rng):
    for seen in states(rng, 5):
        np.testing.assert_array_equal(law("open-loop")(seen), seen.twist_d)


def drift(period):
    text = f"period {period} ms\narc centre (-60, 0) mm angle 360 deg in 4 s\n"
    run = dqpaint.draw(_drawing(text), controller="open-loop", plant="ideal", size=(64, 36))
    return run.table["position_error_m"][-1]


def _drawing(text):
    import tempfile
    from pathlib import Path

    path = Path(tempfile.mkdtemp()) / "circle.traj"
    path.write_text(text)
    return path


@pytest.mark.slow
def test_the_drift_of_the_open_loop_is_of_the_order_of_the_period():
    """(2.14): what each step does wrong adds up; feedback on the same arm leaves nothing."""
    long, short = drift(20), drift(10)
    assert long > 1e-4
    assert long / short == pytest.approx(2.0, rel=0.1)


def closed_loop(x_d, **gains):
    """The linear dynamics of a small body displacement of the tool at a set point, 6 x 6."""
    said, size, columns = law("p-least-squares", k=1.0, **gains), 1e-6, []
    for direction in np.eye(6):
        u = [
            said(body_sees(dq.mul(x_d, dq.exp(sign * size / 2 * direction)), x_d))
            for sign in (1, -1)
        ]
        columns.append(dq.adjoint(dq.conj(x_d), (u[0] - u[1]) / (2 * size)))
    return np.array(columns).T


def test_least_squares_comes_home_at_the_cosine_of_half_the_angle(rng):
    """At the base's origin at k cos(phi / 2), two with a turning of phi / 2; elsewhere slower."""
    for x_d in random_poses(rng, 40):
        half = np.arccos(min(1.0, abs(x_d[0])))
        here = dq.pose_from(np.zeros(3), dq.rotation(x_d))
        values = np.linalg.eigvals(closed_loop(here)[:3, :3])
        np.testing.assert_allclose(values.real, -np.cos(half), atol=1e-6)
        np.testing.assert_allclose(
            np.sort(values.imag), [-np.sin(half), 0, np.sin(half)], atol=1e-6
        )
        rates = -np.linalg.eigvals(closed_loop(x_d)).real / np.cos(half)
        assert (rates > 0.1).all()
        assert (rates < 1.001).all()
        printed = np.linalg.eigvals(closed_loop(x_d, form="printed")).real / np.cos(half)
        assert (printed > 0.1).all()


def test_least_squares_as_printed(rng):
    """q_dot = +k J8^+ e with the sign of x whose scalar is positive, in dqrobotics."""
    for seen in states(rng, 50, size=1.0):
        upright = seen._replace(pose=seen.pose * np.where(seen.pose[0] < 0, -1, 1))
        x, x_d, _ = peers(upright)
        e = (dqrobotics.DQ([1]) - x.conj() * x_d).vec8()
        wanted = np.linalg.pinv(0.5 * x.haminus8() @ E6) @ (3.0 * e)
        for form, sign in (("printed", 1), ("derived", -1)):
            said = law("p-least-squares", k=3.0, form=form)(seen)
            np.testing.assert_allclose(said, sign * wanted, atol=1e-9, rtol=1e-9)


# The gains of the papers.

PAPERS = {
    "p": {"k": 125.0}, "pff": {"k": 125.0},  # Fig. 5.4
    "hinf": {"gamma_T": 0.372, "gamma_O": 0.377}, "hinf-set": {"gamma_T": 0.372, "gamma_O": 0.377},
    "lqr": {"q": 270.0, "r": 0.01, "s": 0.0}, "lqr8": {"r": 0.01, "s": 0.0},  # Table 5.11
    "accel": {"Kp": 190.0, "Kv": 6.0},
    "accel-decoupled": {"KPp": 270.0, "KPo": 270.0, "KVp": 7.5, "KVo": 7.5},
}  # fmt: skip


@pytest.mark.parametrize("name", CONTROLLERS)
def test_the_gains_of_the_paper(name):
    chosen = CONTROLLERS[name]
    if name not in PAPERS:
        with pytest.raises(UsageError, match=f"'{name}' .*accel, accel-decoupled, hinf"):
            chosen.read_gains({"paper": "paper"})
        return
    assert chosen.paper_source
    schedule = chosen.read_gains({"paper": "paper"})
    for gain, value in PAPERS[name].items():
        assert getattr(schedule.first, gain) == value
    if name == "lqr8":
        assert [schedule.at(part).q for part in (0, 0.29, 0.31)] == [220.0, 220.0, 270.0]


def test_a_gain_beside_the_paper_s_has_precedence():
    assert CONTROLLERS["accel"].read_gains({"paper": "paper", "Kv": 30.0}).first.Kp == 190.0
    assert CONTROLLERS["accel"].read_gains({"paper": "paper", "Kv": 30.0}).first.Kv == 30.0
    run = dqpaint.draw("step", controller="p", gains="paper", plant="ideal", size=(64, 36))
    assert run.gains["k"] == 125.0


# Four gammas.


def test_the_four_gammas(rng):
    """Theorem 3.1, and that the bound of either holds: the gain is at least that of each alone."""
    for _ in range(20):
        g = dict(zip(("gamma_O1", "gamma_O2", "gamma_T1", "gamma_T2"), rng.uniform(0.01, 1, 4),
                     strict=True))  # fmt: skip
        gains = CONTROLLERS["hinf"].read_gains(g).first
        K_O = np.sqrt(2) * np.sqrt(g["gamma_O1"] ** -2 + g["gamma_O2"] ** -2)
        K_T = np.sqrt(g["gamma_T1"] ** -2 + g["gamma_T2"] ** -2)
        assert gains.k_O == pytest.approx(K_O, rel=1e-14)
        assert gains.k_T == pytest.approx(K_T, rel=1e-14)
        turning, moving = gains.disturbance_bounds()
        assert turning <= min(g["gamma_O1"], g["gamma_O2"])
        assert moving <= min(g["gamma_T1"], g["gamma_T2"])
        assert {name: gains.as_dict()[name] for name in g} == g
    equal = CONTROLLERS["hinf"].read_gains({"gamma_O1": 0.3, "gamma_O2": 0.3}).first
    assert equal.k_O == pytest.approx(2 / 0.3)
    alone = CONTROLLERS["hinf"].read_gains({"gamma_T2": 0.25}).first
    assert alone.k_T == 4.0
    with pytest.raises(UsageError, match="gamma_T or K_T or gamma_T1"):
        CONTROLLERS["hinf"].read_gains({"gamma_T2": 0.25, "K_T": 3.0})


def test_gammas_of_gains_that_are_given_otherwise():
    """Equal pairs with the same gain (5.5, 5.6), of a matrix those of its least eigenvalue."""
    read = CONTROLLERS["hinf"].read_gains
    K_T = [[5.0, 1.0, 0.0], [-1.0, 4.0, 1.0], [0.0, 1.0, 4.0]]  # symmetric part: 3 is the least
    for given in ({"gamma_O": 0.4, "gamma_T": 0.2}, {"K_O": 7.0, "K_T": K_T}):
        gains = read(given).first
        (O1, O2), (T1, T2) = gains.gammas
        assert (O1, T1) == (O2, T2)
        pair = read({"gamma_O1": O1, "gamma_O2": O2, "gamma_T1": T1, "gamma_T2": T2}).first
        least = np.linalg.eigvalsh((np.array(K_T) + np.transpose(K_T)) / 2)[0]
        assert pair.k_O == pytest.approx(7.0 if "K_O" in given else 5.0)
        assert pair.k_T == pytest.approx(least if "K_T" in given else np.sqrt(2) / 0.2)
    one, other = read({"gamma_T1": 0.25}).first.gammas[1]
    assert (one, other) == (0.25, np.inf)


def test_bounds_in_steps_are_of_numbers_at_the_base_s_origin():
    read = CONTROLLERS["hinf"].read_gains
    assert read({}).bounded_in_steps
    for given in ({"point": "tool"}, {"K_T": (20.0, 20.0, 30.0)}, {"K_O": (40.0, 40.0, 30.0)}):
        assert not read(given).bounded_in_steps
    assert not read({"K_T": "10..20@10%"}).bounded_in_steps
