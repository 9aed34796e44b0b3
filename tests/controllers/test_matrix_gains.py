"""Gains as matrices: what is refused, how they are written, and each law against its matrix form.

The other implementation is that of the papers' 8 x n matrices, in dqrobotics' primitives and numpy.
"""

import json

import dqrobotics
import numpy as np
import pinocchio
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import solve_continuous_are

import dqpaint
from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.controllers.laws.pereira import lqr, lqr8
from dqpaint.errors import UsageError
from dqpaint.robots.kinematics.differential_ik import resolve
from tests.support.control import SHORT, law, states

E6 = np.zeros((8, 6))
E6[[1, 2, 3, 5, 6, 7], range(6)] = 1
ABOVE = 1e-9


def definite(rng, size, scale=5.0):
    """A random symmetric positive definite matrix."""
    root = rng.normal(size=(size, size))
    return scale * (root @ root.T / size + 0.3 * np.eye(size))


def rates(seen, twist):
    return resolve(seen.jacobian, dq.translation(seen.pose), twist, np.zeros(7))


def peers(seen):
    """x, x_d on its side, J8 and N, in dqrobotics' primitives."""
    x = dqrobotics.DQ(list(seen.pose))
    x_d = dqrobotics.DQ(list(dq.nearest(seen.pose_d, seen.pose)))
    J8 = 0.5 * x.haminus8() @ E6 @ seen.jacobian
    return x, x_d, J8, x_d.haminus8() @ dqrobotics.C8() @ J8


def invariant(x, x_d):
    return (dqrobotics.DQ([1]) - x.conj() * x_d).vec8()


@pytest.mark.parametrize("name", ["p", "pff", "pham", "pham-t"])
@pytest.mark.parametrize("kind", ["matrix", "diagonal"])
def test_the_gain_of_eight_numbers(rng, name, kind):
    for seen in states(rng, 30, size=1.0):
        K = definite(rng, 8) if kind == "matrix" else np.diag(rng.uniform(1, 9, 8))
        given = K if kind == "matrix" else K.diagonal()
        x, x_d, J8, N = peers(seen)
        difference = (x_d - x).vec8()
        rate_d = 0.5 * dqrobotics.DQ(list(dq.pure(seen.twist_d))) * x_d
        ahead = (x.conj() * rate_d).vec8()
        e, N_inverse, inverse = invariant(x, x_d), *(np.linalg.pinv(M, rcond=1e-8) for M in (N, J8))
        wanted = {
            "p": N_inverse @ K @ e,
            "pff": N_inverse @ (K @ e - ahead),
            "pham": inverse @ K @ difference,
            "pham-t": J8.T @ K @ difference,
        }[name]
        said = law(name, k=given.tolist())(seen)
        ours = said if name == "pham-t" else rates(seen, said)
        np.testing.assert_allclose(ours, wanted, atol=ABOVE, rtol=1e-9)


def sine_and_place(seen):
    """Im(r_e) and p_e of x x_d*, in dqrobotics."""
    x, x_d, *_ = peers(seen)
    x_e = x * x_d.conj()
    return x_e.P().vec3(), x_e.translation().vec3(), x_e


@pytest.mark.parametrize("name", ["hinf-set", "hinf"])
def test_the_gains_of_hinf_as_matrices(rng, name):
    """Also one that is not symmetric: the proof needs K + K' > 0."""
    for seen in states(rng, 30, size=1.0):
        K_O = definite(rng, 3) + np.cross(np.eye(3), rng.normal(size=3))
        K_T = rng.uniform(1, 9, 3)
        sine, place, x_e = sine_and_place(seen)
        ahead = dqrobotics.Ad(x_e, dqrobotics.DQ(list(dq.pure(seen.twist_d)))).vec6()
        wanted = np.r_[-K_O @ sine, -K_T * place] + (ahead if name == "hinf" else 0)
        said = law(name, K_O=K_O, K_T=K_T)(seen)
        np.testing.assert_allclose(said, wanted, atol=ABOVE, rtol=1e-9)


def test_the_springs_of_the_torque_laws_as_matrices(rng):
    for seen in states(rng, 30, size=1.0):
        Kp, Kv = definite(rng, 6, 100), definite(rng, 6, 20)
        x, x_d, *_ = peers(seen)
        x_e, xi = x_d * x.conj(), seen.jacobian @ seen.rates
        back = dqrobotics.Ad(x_e.conj(), dqrobotics.DQ(list(dq.pure(seen.twist_d)))).vec6()
        slope = dqrobotics.Ad(x_e.conj(), dqrobotics.DQ(list(dq.pure(seen.acceleration_d)))).vec6()
        w, v = back[:3], back[3:]
        cross = np.r_[np.cross(xi[:3], w), np.cross(xi[:3], v) + np.cross(xi[3:], w)]
        T = dq.matrix_from_pose(dq.mul(seen.pose_d, dq.conj(seen.pose)))
        screw = np.roll(pinocchio.log6(pinocchio.SE3(T)).vector, 3)  # dqrobotics' is no screw
        wanted = slope + cross + Kv @ (back - xi) + Kp @ screw
        said = law("accel", Kp=Kp, Kv=Kv)(seen)
        np.testing.assert_allclose(said, wanted, atol=1e-8, rtol=1e-9)
        four = [definite(rng, 3) for _ in range(4)]
        said = law("accel-decoupled", **dict(zip(("KPp", "KVp", "KPo", "KVo"), four, strict=True)))
        p, p_d = x.translation().vec3(), x_d.translation().vec3()
        speed, speed_d = (
            xi[3:] + np.cross(xi[:3], p),
            seen.twist_d[3:] + np.cross(seen.twist_d[:3], p_d),
        )
        w, w_d, dw, dv = xi[:3], seen.twist_d[:3], *np.split(seen.acceleration_d, 2)
        at = dv + np.cross(dw, p_d) + np.cross(w_d, speed_d) + four[1] @ (speed_d - speed)
        at += four[0] @ (p_d - p)
        turn = dw + four[3] @ (w_d - w) + four[2] @ (x_d.P() * x.P().conj()).vec3()
        spatial = np.r_[turn, at - np.cross(turn, p) - np.cross(w, speed)]
        np.testing.assert_allclose(said(seen), spatial, atol=ABOVE, rtol=1e-9)


# The Riccati equations, by an ODE solver of scipy's.


def lqr_weights(rng, size):
    return definite(rng, size, 3.0), definite(rng, size, 0.02), definite(rng, size, 0.4)


@pytest.mark.parametrize("form", ["derived", "printed"])
def test_lqr_with_full_matrices(rng, form):
    Q, R, S = lqr_weights(rng, 6)
    inverse = np.linalg.inv(R)
    end = SHORT.t[-1]
    solved = solve_ivp(
        lambda _s, P: (Q - P.reshape(6, 6) @ inverse @ P.reshape(6, 6)).ravel(),
        (0, end), S.ravel(), rtol=1e-12, atol=1e-14, dense_output=True,
    )  # fmt: skip
    given = {"q": Q, "r": R, "s": S}
    P = lqr.riccati(SHORT, CONTROLLERS["lqr"].read_gains(given))
    for row in (0, 40, 97, len(SHORT.t) - 1):
        exact = solved.sol(end - SHORT.t[row]).reshape(6, 6)
        np.testing.assert_allclose(P[row], exact, atol=1e-10)
        for seen in states(rng, 5, size=1.0):
            sine, place, x_e = sine_and_place(seen)
            ahead = dqrobotics.Ad(x_e, dqrobotics.DQ(list(dq.pure(seen.twist_d)))).vec6()
            factor = {"derived": 2, "printed": 1}[form]
            wanted = -factor * inverse @ exact @ np.r_[sine, place / 2] + ahead
            said = law("lqr", form=form, **given)(seen._replace(row=row))
            np.testing.assert_allclose(said, wanted, atol=1e-9 * np.abs(wanted).max())


@pytest.mark.parametrize("point", ["tool", "base"])
def test_lqr8_with_full_matrices_is_that_of_an_ode_solver(rng, point):
    Q, R, S = lqr_weights(rng, 8)
    given = {"q": Q, "r": R, "s": S, "point": point}
    inverse, end = np.linalg.inv(R), SHORT.t[-1]
    P, g = lqr8.riccati(SHORT, CONTROLLERS["lqr8"].read_gains(given))
    seen_from = {"tool": dq.adjoint(dq.conj(SHORT.pose), SHORT.twist), "base": -SHORT.twist}
    y = dq.pure(0.5 * seen_from[point])

    def slope(s, z):
        k = min(np.searchsorted(SHORT.t, end - s, side="right") - 1, len(y) - 2)
        share = (end - s - SHORT.t[k]) / SHORT.period
        one = (1 - share) * y[k] + share * y[k + 1]  # straight between the rows of a trapezoid
        A, Pz, gz = dq.hamilton_minus(one), z[:64].reshape(8, 8), z[64:]
        dP = -Pz @ A - A.T @ Pz + Pz @ inverse @ Pz - Q
        return -np.r_[dP.ravel(), -A.T @ gz + Pz @ inverse @ gz + Pz @ one]

    solved = solve_ivp(slope, (0, end), np.r_[S.ravel(), np.zeros(8)], rtol=1e-10, atol=1e-13,
                       max_step=SHORT.period / 2)  # fmt: skip
    z = solved.y[:, -1]
    found = P[0][lqr8.PLACES]
    np.testing.assert_allclose(found, z[:64].reshape(8, 8), atol=2e-6)
    np.testing.assert_allclose(g[0], z[64:], atol=2e-6)
    assert np.abs(found - np.diag(found.diagonal())).max() > 0.05
    if point == "base":
        for seen in states(rng, 5, size=1.0):
            x, x_d, *_ = peers(seen)
            x_e = x * x_d.conj()
            e = (dqrobotics.DQ([1]) - x_e).vec8()
            M = 0.5 * x_e.haminus8() @ E6
            wanted = np.linalg.pinv(M) @ inverse @ (found @ e + g[0])
            np.testing.assert_allclose(law("lqr8", **given)(seen), wanted, rtol=1e-9, atol=1e-9)


def test_lqr8_command_with_a_full_r(rng):
    Q, R, S = lqr_weights(rng, 8)
    chosen = CONTROLLERS["lqr8"]
    gains = chosen.read_gains({"q": Q, "r": R, "s": S})
    P, g = lqr8.riccati(SHORT, gains)
    for seen in states(rng, 20, size=1.0):
        x, x_d, _, N = peers(seen)
        inner = np.linalg.solve(R, P[3][lqr8.PLACES] @ invariant(x, x_d) + g[3])
        wanted = np.linalg.pinv(N, rcond=1e-8) @ inner
        ours = rates(seen, law("lqr8", q=Q, r=R, s=S)(seen._replace(row=3)))
        np.testing.assert_allclose(ours, wanted, atol=1e-9 * max(1, np.abs(wanted).max()))


def test_an_end_weight_not_given_keeps_the_gain_as_it_is(rng):
    """S is the solution of the algebraic equation: scipy's."""
    Q, R, _ = lqr_weights(rng, 6)
    schedule = CONTROLLERS["lqr"].read_gains({"q": Q, "r": R})
    S = solve_continuous_are(np.zeros((6, 6)), np.eye(6), Q, R)
    np.testing.assert_allclose(schedule.first.end_matrix(), S, atol=1e-10)
    P = lqr.riccati(SHORT, schedule)
    np.testing.assert_allclose(P, np.broadcast_to(S, P.shape), atol=1e-9)


@pytest.mark.parametrize(("name", "gain", "size"), [
    ("p", "k", 8), ("pham-t", "k", 8), ("hinf", "K_O", 3), ("accel", "Kp", 6), ("lqr", "q", 6),
    ("lqr", "r", 6), ("lqr8", "s", 8), ("translation", "k", 3), ("accel-decoupled", "KPo", 3),
])  # fmt: skip
def test_a_number_a_diagonal_and_a_matrix_of_the_same_are_one_law(rng, name, gain, size):
    for seen in states(rng, 3):
        forms = 7.0, [7.0] * size, 7.0 * np.eye(size), "7" + ",7" * (size - 1)
        one, *others = (law(name, **{gain: form})(seen) for form in forms)
        for other in others:
            np.testing.assert_allclose(other, one, rtol=1e-6, atol=1e-8)


def test_a_matrix_grows_along_a_drawing():
    schedule = CONTROLLERS["hinf"].read_gains({"K_O": "2,1,0;1,2,0;0,0,2..8@50%"})
    half = np.array(schedule.at(0.25).K_O)
    np.testing.assert_allclose(half, [[5, 0.5, 0], [0.5, 5, 0], [0, 0, 5]])
    bound = schedule.disturbance_bounds()[0]
    assert bound == pytest.approx(np.sqrt(2))  # the least eigenvalue of the first is 1


ASYMMETRIC = np.eye(8) + 0.1 * np.eye(8, k=1)


@pytest.mark.parametrize(("name", "gains", "says"), [
    ("p", {"k": [1.0, 2.0]}, "has 2 numbers"), ("p", {"k": np.eye(6)}, "6 x 6"),
    ("p", {"k": ASYMMETRIC}, "0.1 in row 1, column 2"),
    ("pham", {"k": -np.eye(8)}, "-1 is the least eigenvalue"),
    ("p", {"k": [[1.0], [1.0, 2.0]]}, "rows"), ("lqr", {"r": np.zeros((6, 6))}, "0 is the least"),
    ("hinf", {"K_T": np.eye(3) * np.nan}, "nan"), ("hinf", {"K_T": [1.0, 0.0, 1.0]}, "is 0"),
    ("hinf", {"K_T": "1,2;3"}, "'1,2;3'"), ("hinf", {"K_T": [["a", "b", "c"]] * 3}, "numbers"),
    ("hinf", {"K_T": np.eye(3) * 1e10}, r"1e\+10"), ("p", {"k": True}, "True"),
    ("hinf", {"K_O": -np.eye(3) + np.cross(np.eye(3), [0, 0, 5.0])}, "symmetric part"),
    ("lqr", {"form": "both"}, "derived or printed"), ("hinf", {"point": "flange"}, "base or tool"),
    ("accel", {"Kp": "1..1,2,3@10%"}, "3 numbers"), ("p", {"k": "1,2..1,2,3@10%"}, "'1,2"),
    ("p", {"k": "1,2;3,4..5@10%"}, "2 x 2"),
])  # fmt: skip
def test_what_is_no_gain_is_refused(name, gains, says):
    (gain,) = gains
    with pytest.raises(UsageError, match=says) as caught:
        CONTROLLERS[name].read_gains(gains)
    assert f"gain '{gain}' of controller '{name}'" in str(caught.value)


def test_matrices_from_python_a_file_and_the_summary(tmp_path):
    """An array, a settings file with nested lists, and the JSON that a summary is."""
    K = [[20.0, 5.0, 0.0], [5.0, 20.0, 0.0], [0.0, 0.0, 30.0]]
    (tmp_path / "gains.toml").write_text(f"controller = 'hinf'\n[gains]\nK_T = {K}\n")
    small = {"plant": "ideal", "size": (64, 36), "controller": "hinf"}
    by_array = dqpaint.draw("step", gains={"K_T": np.array(K)}, **small)
    by_text = dqpaint.draw("step", gains="K_T=20,5,0;5,20,0;0,0,30", **small)
    by_file = dqpaint.draw("step", settings=tmp_path / "gains.toml", **small)
    for other in (by_text, by_file):
        np.testing.assert_array_equal(by_array.track.command, other.track.command)
    dqpaint.save(by_array, tmp_path)
    (summary,) = tmp_path.glob("*.json")
    assert json.loads(summary.read_text())["gains"]["K_T"] == K
    again = dqpaint.draw("step", settings=summary, size=(64, 36))
    np.testing.assert_array_equal(by_array.track.command, again.track.command)
