"""The error of every law obeys its own differential equation, integrated finely."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.controllers.base.pose_errors import difference_error, spatial_error
from dqpaint.robots.kinematics.jacobians import pose_map
from tests.support.control import ARM, STILL, body_sees, law, seen_by, states
from tests.support.random_poses import random_poses, random_rotations

RATE_TOLERANCE = 0.01  # of the rates the laws state, for small errors


def simulate(name, gains, x, asked, seconds, steps):
    """The ideal body under a law that commands twists, by RK4: error poses along the way."""
    said, h = law(name, STILL, **gains), seconds / steps
    errors = []

    def twist(pose, t):
        return said(body_sees(pose, *asked(t), time=t))

    for k in range(steps):
        t = k * h
        errors.append(spatial_error(x, asked(t)[0]))
        a = twist(x, t)
        b = twist(dq.mul(dq.exp(0.25 * h * a), x), t + h / 2)
        c = twist(dq.mul(dq.exp(0.25 * h * b), x), t + h / 2)
        d = twist(dq.mul(dq.exp(0.5 * h * c), x), t + h)
        x = dq.mul(dq.exp(0.5 * h * (a + 2 * b + 2 * c + d) / 6), x)
    errors.append(spatial_error(x, asked(seconds)[0]))
    return np.array(errors)


RATES = [
    ("p", {"k": 5.0}, 5.0, 5.0), ("pff", {"k": 5.0}, 5.0, 5.0), ("pham", {"k": 5.0}, 5.0, 5.0),
    ("decoupled", {"k_t": 5.0, "k_r": 3.0}, 3.0, 5.0),
    ("log", {"k": 5.0}, 5.0, 5.0), ("log", {"k": 5.0, "feed_forward": 0}, 5.0, 5.0),
    ("hinf-set", {"gamma_O": 0.25, "gamma_T": 0.5}, 4.0, np.sqrt(2) / 0.5),
    ("hinf", {"gamma_O": 0.25, "gamma_T": 0.5}, 4.0, np.sqrt(2) / 0.5),
    ("hinf", {"K_O": 8.0, "K_T": 3.0}, 4.0, 3.0),
    ("lqr", {"q": 2.5, "r": 0.1}, 5.0, 5.0), ("lqr8", {"q": 2.5, "r": 0.1}, 5.0, 5.0),
    ("lqr", {"q": "2.5,2.5,2.5,1.6,1.6,1.6", "r": 0.1}, 5.0, 4.0),
    ("lqr", {}, 20.0, 20.0), ("lqr8", {}, 20.0, 20.0), ("p", {}, 20.0, 20.0),
    ("pham", {}, 20.0, 20.0), ("decoupled", {}, 20.0, 20.0), ("log", {}, 20.0, 20.0),
    ("hinf", {}, 20.0, 20.0), ("hybrid", {"K_O": 8.0, "K_T": 3.0}, 4.0, 3.0),
    ("sine", {"k": 5.0}, 5.0, 5.0), ("se3", {"k_R": 4.0, "k_p": 3.0}, 4.0, 3.0),
    ("admittance", {"k": 5.0}, 5.0, 5.0),
]  # fmt: skip


@pytest.mark.parametrize(("name", "gains", "turning", "moving"), RATES)
def test_small_errors_decay_at_the_stated_rates(rng, name, gains, turning, moving):
    """A rotation alone and a translation alone."""
    x_d = random_poses(rng, 1)[0]
    at = dq.translation(x_d)
    axis = random_rotations(rng, 1)[0][1:]
    spin = np.concatenate([axis, dq.cross(at, axis)])  # a turn about the tool itself
    if name == "lqr":
        spin[3:] = 0  # its weights are those of p_e, which a turn about the base origin lacks
    move = np.concatenate([np.zeros(3), axis])
    for start, rate, part in ((spin, turning, slice(0, 3)), (move, moving, slice(3, 6))):
        x = dq.mul(dq.exp(0.5 * 0.01 * start), x_d)
        seconds = 2.0 / rate
        errors = simulate(name, gains, x, lambda _t: (x_d,), seconds, 150)
        left = np.linalg.norm(dq.log(errors)[:, part], axis=1)
        assert np.log(left[0] / left[-1]) / seconds == pytest.approx(rate, rel=RATE_TOLERANCE)


def test_every_law_that_commands_twists_has_a_rate_in_the_table():
    others = {
        "open-loop",
        "p-least-squares",
        "pi",
        "super-twisting",
    }  # see test_new_laws, test_stateful_laws
    found = {n for n, c in CONTROLLERS.items() if c.commands == "twist"}
    assert {row[0] for row in RATES} | others == found


@pytest.mark.parametrize("mode", range(6))
def test_the_transpose_decays_mode_by_mode_at_k_times_its_singular_value_squared(mode):
    """Along a right singular vector of J8 in the joints, integrated finely on the arm."""
    said = law("pham-t", k=9.0)
    goal, J = ARM.pose_and_jacobian(ARM.card.home)
    left, sigma, right = np.linalg.svd(pose_map(goal) @ J)
    q = ARM.card.home + 1e-5 * right[mode]
    rate = 9.0 * sigma[mode] ** 2
    seconds, steps = 1.0 / rate, 100
    h = seconds / steps

    def rates(posture):
        return said(seen_by(ARM, posture, -goal))

    def along(posture):
        return (
            left[:, mode]
            @ difference_error(ARM.pose(posture), goal)
            * np.sign(ARM.pose(posture)[:4] @ goal[:4])
        )

    before = along(q)
    for _ in range(steps):
        a = rates(q)
        b = rates(q + h / 2 * a)
        c = rates(q + h / 2 * b)
        q = q + h / 6 * (a + 2 * b + 2 * c + rates(q + h * c))
    assert np.log(before / along(q)) / seconds == pytest.approx(rate, rel=RATE_TOLERANCE)


def test_the_transpose_s_usual_gain_is_stable_up_to_20_ms(rng):
    """k s^2 T < 2 for the fastest mode in any posture of the iiwa, and not far from it."""
    k = CONTROLLERS["pham-t"].read_gains({}).first.k
    fastest = 0.0
    for q in rng.uniform(ARM.card.lower, ARM.card.upper, (3000, 7)):
        x, J = ARM.pose_and_jacobian(q)
        fastest = max(fastest, k * np.linalg.norm(pose_map(x) @ J, 2) ** 2)
    assert 1.0 < fastest * 0.02 < 1.9


def test_the_transpose_never_lets_the_error_grow(rng):
    """d|e|^2/dt = -2 k |J8' e|^2 from any error, by differences along its own joint rates."""
    h = 1e-5
    for seen in states(rng, 30, size=2.5):
        rates = law("pham-t", k=9.0)(seen)
        x_d = dq.nearest(seen.pose_d, seen.pose)
        sizes = [
            ((dq.nearest(ARM.pose(seen.posture + s * rates), seen.pose) - x_d) ** 2).sum()
            for s in (h, -h)
        ]
        J8 = pose_map(seen.pose) @ seen.jacobian
        wanted = -2 * 9.0 * ((J8.T @ (x_d - seen.pose)) ** 2).sum()
        assert (sizes[0] - sizes[1]) / (2 * h) == pytest.approx(wanted, rel=1e-5)


LOOK_AHEAD = ["pff", "hinf", "log", "lqr", "hybrid", "sine", "se3"]


@pytest.mark.parametrize("name", LOOK_AHEAD)
def test_feed_forward_leaves_no_lag_on_a_moving_pose(rng, name):
    xi, x0 = rng.normal(size=6), random_poses(rng, 1)[0]

    def asked(t):
        return dq.mul(dq.exp(0.5 * np.sin(t) * xi), x0), np.cos(t) * xi

    errors = simulate(name, {}, x0, asked, 0.3, 150)
    assert np.abs(dq.log(errors)).max() < 1e-9
    off = simulate(name, {}, dq.mul(dq.exp(0.05 * rng.normal(size=6)), x0), asked, 1.0, 300)
    assert np.abs(dq.log(off[-1])).max() < 1e-8


@pytest.mark.parametrize(("name", "gains"), [
    ("p", {}), ("pham", {}), ("hinf-set", {}), ("decoupled", {}), ("log", {"feed_forward": 0}),
])  # fmt: skip
def test_laws_without_it_lag_by_speed_over_rate(rng, name, gains):
    x0, v = random_poses(rng, 1)[0], 0.1 * np.r_[0, 0, 0, random_rotations(rng, 1)[0][1:]]

    def asked(t):
        return dq.mul(dq.exp(0.5 * t * v), x0), v

    errors = simulate(name, gains, x0, asked, 0.5, 200)
    lag = np.linalg.norm(dq.translation(errors[-1]))
    assert lag == pytest.approx(np.linalg.norm(v) / 20, rel=RATE_TOLERANCE)


def test_log_decays_along_one_screw_however_large_the_error(rng):
    """log x_e(t) = exp(-k t) log x_e(0), to the last digits."""
    x, x_d = random_poses(rng, 2)
    errors = simulate("log", {"k": 3.0}, x, lambda _t: (x_d,), 0.5, 500)
    t = np.linspace(0, 0.5, 501)[:, None]
    logs = dq.log(errors)
    assert np.linalg.norm(logs[0, :3]) > 0.5
    np.testing.assert_allclose(logs, np.exp(-3.0 * t) * logs[0], atol=1e-10)


def test_hinf_error_obeys_its_own_differential_equation(rng):
    """d(2 (1 - eta))/dt = -K_O |Im r_e|^2 and d|p_e|^2/dt = -2 K_T |p_e|^2, from large errors."""
    x, x_d = random_poses(rng, 2)
    gains = {"gamma_O": 0.5, "gamma_T": 0.5}
    errors = simulate("hinf-set", gains, x, lambda _t: (x_d,), 0.1, 1000)
    h = 1e-4
    eta, sine = errors[:, 0], (errors[:, 1:4] ** 2).sum(1)
    np.testing.assert_allclose((2 * (eta[:-2] - eta[2:]) / (2 * h)), -4.0 * sine[1:-1], rtol=1e-5)
    p = (dq.translation(errors) ** 2).sum(1)
    wanted = -2 * np.sqrt(2) / 0.5 * p[1:-1]
    np.testing.assert_allclose((p[2:] - p[:-2]) / (2 * h), wanted, rtol=1e-5)


def test_decoupled_errors_obey_their_own_equations(rng):
    """The place straight home at k_t; d(1 - eta)/dt = -k_r |Im r_e|^2, from large errors."""
    x, x_d = random_poses(rng, 2)
    errors = simulate("decoupled", {"k_t": 3.0, "k_r": 2.0}, x, lambda _t: (x_d,), 0.4, 500)
    places = dq.translation(dq.mul(errors, x_d)) - dq.translation(x_d)
    t = np.linspace(0, 0.4, 501)[:, None]
    np.testing.assert_allclose(places, np.exp(-3.0 * t) * places[0], atol=1e-6)
    eta, sine = errors[:, 0], (errors[:, 1:4] ** 2).sum(1)
    slope = (eta[:-2] - eta[2:]) / (2 * 8e-4)
    np.testing.assert_allclose(slope, -2.0 * sine[1:-1], rtol=1e-4)
    assert sine[0] > 0.1


# Second order: laws that command accelerations.


def moved(x, xi, acceleration, h):
    """Pose and twist a moment later; exact to second order."""
    step = h * xi + 0.5 * h**2 * acceleration
    return dq.mul(dq.exp(0.5 * step), x), xi + h * acceleration


def screw_errors(x, xi, x_d, xi_d):
    """x_e = x_d x* and xi_e = Ad(x_e*) xi_d - xi, the short way."""
    x_e = dq.mul(dq.nearest(x_d, x), dq.conj(x))
    return x_e, dq.adjoint(dq.conj(x_e), xi_d) - xi


def apart_errors(x, xi, x_d, xi_d):
    """p_d - p, its rate, and w_d - w."""
    p, p_d = dq.translation(x), dq.translation(x_d)
    return (
        p_d - p, dq.point_velocity(xi_d, p_d) - dq.point_velocity(xi, p), xi_d[:3] - xi[:3],
    )  # fmt: skip


def along_the_answer(name, gains, seen, h):
    """What the law makes of a moving body, a moment later and earlier: (x, xi, x_d, xi_d)."""
    a = law(name, **gains)(seen)
    return [
        (*moved(seen.pose, seen.twist, a, s), *moved(seen.pose_d, seen.twist_d,
         seen.acceleration_d, s)) for s in (h, -h)
    ]  # fmt: skip


def test_accel_is_a_damped_spring_along_the_screw(rng):
    """xi_e_dot + Kv xi_e + 2 Kp log x_e = 0, from large errors in general motion."""
    h = 1e-5
    for seen in states(rng, 100, size=2.0):
        later, earlier = along_the_answer("accel", {"Kp": 190, "Kv": 6}, seen, h)
        slope = (screw_errors(*later)[1] - screw_errors(*earlier)[1]) / (2 * h)
        x_e, xi_e = screw_errors(seen.pose, seen.twist, seen.pose_d, seen.twist_d)
        np.testing.assert_allclose(slope, -6 * xi_e - 2 * 190 * dq.log(x_e), atol=2e-4, rtol=1e-6)


def test_accel_decoupled_is_two_damped_springs(rng):
    h, gains = 1e-5, {"KPp": 270, "KVp": 7.5, "KPo": 190, "KVo": 6}
    for seen in states(rng, 100, size=2.0):
        later, earlier = along_the_answer("accel-decoupled", gains, seen, h)
        p_rate, w_rate = (
            (a - b) / (2 * h)
            for a, b in zip(apart_errors(*later)[1:], apart_errors(*earlier)[1:], strict=True)
        )
        p_e, p_e_dot, w_e = apart_errors(seen.pose, seen.twist, seen.pose_d, seen.twist_d)
        sine = dq.mul(dq.nearest(seen.pose_d, seen.pose), dq.conj(seen.pose))[1:4]
        np.testing.assert_allclose(p_rate, -270 * p_e - 7.5 * p_e_dot, atol=2e-4, rtol=1e-6)
        np.testing.assert_allclose(w_rate, -190 * sine - 6 * w_e, atol=2e-4, rtol=1e-6)


def swing(Kp, Kv, t):
    """The answer from 1 at rest of s^2 + Kv s + Kp."""
    root = np.sqrt(complex(Kv**2 / 4 - Kp))
    if abs(root) < 1e-9:
        return (1 + Kv / 2 * t) * np.exp(-Kv / 2 * t)
    fast, slow = -Kv / 2 - root, -Kv / 2 + root
    return np.real((slow * np.exp(fast * t) - fast * np.exp(slow * t)) / (slow - fast))


@pytest.mark.slow
@pytest.mark.parametrize(("name", "gains", "turning", "moving"), [
    ("accel", {}, (400, 40), (400, 40)), ("accel", {"Kp": 190, "Kv": 6}, (190, 6), (190, 6)),
    ("accel-decoupled", {}, (400, 40), (400, 40)),
    ("accel-decoupled", {"KPp": 270, "KVp": 7.5, "KPo": 270, "KVo": 7.5}, (135, 7.5), (270, 7.5)),
])  # fmt: skip
def test_small_errors_swing_as_their_spring_does(rng, name, gains, turning, moving):
    """By midpoint steps of a tenth of a millisecond, from rest."""
    x_d, said, h = random_poses(rng, 1)[0], law(name, **gains), 1e-4
    axis = random_rotations(rng, 1)[0][1:]
    spin = np.concatenate([axis, dq.cross(dq.translation(x_d), axis)])
    for start, spring in ((spin, turning), (np.r_[np.zeros(3), axis], moving)):
        x, xi, sizes = dq.mul(dq.exp(0.5 * 0.01 * start), x_d), np.zeros(6), []
        for _ in range(1000):
            part = dq.log(spatial_error(x, x_d))
            sizes.append(part @ start / (0.005 * start @ start))
            a = said(body_sees(x, x_d, twist=xi))
            middle = said(body_sees(*_half(x, xi, a, h, x_d)))
            x, xi = dq.mul(dq.exp(0.5 * (h * xi + 0.5 * h**2 * middle)), x), xi + h * middle
        t = np.arange(1000) * h
        np.testing.assert_allclose(sizes, swing(*spring, t), atol=RATE_TOLERANCE)


def _half(x, xi, a, h, x_d):
    there, speed = moved(x, xi, a, h / 2)
    return there, x_d, None, None, speed


@pytest.mark.parametrize(("name", "k"), [("sine", 3.0), ("se3", 3.0), ("log", 3.0), ("hinf", 3.0)])
def test_four_functions_of_one_angle(rng, name, k):
    """theta(t) in closed form, from 2.9 rad about a general axis through the tool."""
    x_d, axis = random_poses(rng, 1)[0], random_rotations(rng, 1)[0][1:]
    axis /= np.linalg.norm(axis)
    at, start, seconds = dq.translation(x_d), 2.9, 1.2
    x = dq.mul(dq.exp(0.5 * start * np.concatenate([axis, dq.cross(at, axis)])), x_d)
    gains = {"sine": {"k": k}, "se3": {"k_R": k}, "log": {"k": k}, "hinf": {"K_O": k}}[name]
    errors = simulate(name, gains, x, lambda _t: (x_d,), seconds, 400)
    t = np.linspace(0, seconds, 401)
    quarter, half = np.tan(start / 4), np.tan(start / 2)
    wanted = {
        "log": start * np.exp(-k * t),
        "sine": 4 * np.arctan(quarter * np.exp(-k * t)),
        "hinf": 4 * np.arctan(quarter * np.exp(-k * t / 2)),
        "se3": 2 * np.arctan(half * np.exp(-k * t)),
    }[name]
    found = 2 * np.linalg.norm(dq.log(errors)[:, :3], axis=1)
    np.testing.assert_allclose(found, wanted, atol=1e-7)


def test_the_dual_sine_keeps_the_screw_s_axis_and_its_advance_stalls_far_away(rng):
    """d_dot = -k d cos(theta / 2) and the axis stays, from a general displacement."""
    x, x_d = random_poses(rng, 2)
    errors = simulate("sine", {"k": 3.0}, x, lambda _t: (x_d,), 0.8, 800)
    screws = 2 * dq.log(errors)
    theta = np.linalg.norm(screws[:, :3], axis=1)
    line = screws[:, :3] / theta[:, None]
    advance = (line * screws[:, 3:]).sum(1)
    moment = (screws[:, 3:] - advance[:, None] * line) / theta[:, None]
    np.testing.assert_allclose(line, np.broadcast_to(line[0], line.shape), atol=1e-9)
    np.testing.assert_allclose(moment, np.broadcast_to(moment[0], line.shape), atol=1e-8)
    slope = np.gradient(advance, 0.001)[1:-1]
    np.testing.assert_allclose(slope, (-3.0 * advance * np.cos(theta / 2))[1:-1], atol=1e-5)
