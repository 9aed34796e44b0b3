"""Laws that remember: what they promise beyond those that do not, on the ideal body."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import dqpaint
from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.controllers.laws.stateful.adaptive import cheapest, parameter_jacobians
from dqpaint.controllers.laws.stateful.admittance import spring_step
from dqpaint.robots.resolvers import Setup, State, make_resolver
from tests.support.control import ARM, STILL, body_sees, law, seen_by, started, states
from tests.support.random_poses import random_poses

PERIOD = 0.002


def course(t):
    """A turning reference on a circle, pose and twist, in closed form."""
    p = np.array([0.1 * np.sin(t), 0.1 * np.cos(t), 0.3])
    angle, w = 0.5 * np.sin(0.7 * t), np.array([0.0, 0.0, 0.35 * np.cos(0.7 * t)])
    pose = dq.pose_from(p, [np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2)])
    velocity = np.array([0.1 * np.cos(t), -0.1 * np.sin(t), 0.0])
    return pose, dq.twist_from_point(w, velocity, p)


def follow(name, disturbance, seconds=8.0, period=PERIOD, noise=None, **gains):
    """[2 Im r_b; p_b] (N, 6) of the ideal body with a twist of the reference's frame on top."""
    said, x = law(name, STILL, **gains), course(0.0)[0]
    errors = []
    for k in range(int(seconds / period)):
        x_d, xi_d = course(k * period)
        measured = x if noise is None else dq.mul(x, dq.exp(0.5 * noise.normal(size=6) * 1e-4))
        u = said(body_sees(measured, x_d, xi_d)._replace(period=period))
        v = dq.adjoint(x_d, disturbance(k * period))
        x = dq.mul(dq.exp(0.5 * period * (u + v)), x)
        b = dq.mul(dq.conj(course((k + 1) * period)[0]), x)
        errors.append(np.r_[2 * b[1:4] * np.sign(b[0]), dq.translation(b)])
    return np.array(errors)


SIZE = np.array([0.1, 0.0, 0.05, 0.02, 0.0, 0.01])


@pytest.mark.slow
def test_pi_leaves_nothing_of_a_constant_twist_where_others_leave_v_over_k():
    pi = follow("pi", lambda _t: SIZE)
    log = follow("log", lambda _t: SIZE)
    np.testing.assert_allclose(np.abs(log[-1]), np.abs(SIZE) / 20.0, rtol=0.1, atol=1e-4)
    assert np.abs(pi[-1000:]).max() < 3e-6  # what is left is of the period


def test_pi_s_error_has_the_roots_of_its_polynomial(rng):
    """A small error at a set point: s^2 + K_P s + K_I = 0, from Euler's steps of its sum."""
    said, x_d = law("pi", STILL, K_P=8.0, K_I=25.0), random_poses(rng, 1)[0]
    h, first = 1e-3, 1e-4 * np.array([0.5, -0.2, 0.4, 0.3, 0.1, -0.6])
    x, s, e = dq.mul(x_d, dq.exp(0.5 * first)), np.zeros(6), first
    for _ in range(800):
        u = said(body_sees(x, x_d)._replace(period=h))
        x = dq.mul(dq.exp(0.5 * h * u), x)
        e, s = e - h * (8.0 * e + 25.0 * s), s + h * e
    found = 2 * dq.log(dq.mul(dq.conj(x_d), x))
    np.testing.assert_allclose(found, e, atol=2e-4 * np.abs(first).max())
    t, w = 0.8, 3.0  # roots -4 +- 3i
    exact = first * np.exp(-4 * t) * (np.cos(w * t) - 4 / w * np.sin(w * t))
    np.testing.assert_allclose(found, exact, atol=0.02 * np.abs(first).max())


def test_pi_does_not_add_up_while_a_limit_clips():
    x, x_d = dq.pose_from([0.1, 0, 0], [1.0, 0, 0, 0]), dq.IDENTITY
    said = law("pi", STILL)
    seen = body_sees(x, x_d)
    first = said(seen._replace(clipped=np.bool_(True)))
    np.testing.assert_array_equal(said(seen), first)
    assert np.abs(said(seen) - first).max() == pytest.approx(0.1 * 100 * seen.period)


def slow_sine(t):
    """A disturbance of 2 rad/s, whose slope stays below 0.4 rad/s^2 and 0.15 m/s^2."""
    return SIZE * np.sin(2 * t)


@pytest.mark.slow
def test_super_twisting_is_exact_where_pi_is_not_and_chatters():
    """L T^2 is left of a sine: 1e-3 mm at 2 ms where `pi` leaves a millimetre."""
    errors = {name: follow(name, slow_sine)[-2000:] for name in ("pi", "super-twisting")}
    far = {name: np.linalg.norm(one[:, 3:], axis=1).max() for name, one in errors.items()}
    assert far["super-twisting"] < 2 * 0.15 * PERIOD**2
    assert far["pi"] > 3e-4
    turned = np.linalg.norm(errors["super-twisting"][:, :3], axis=1).max()
    assert turned < 2 * 0.4 * PERIOD**2


def travel(name, rng):
    """The total variation of what a law commands against a disturbance it sees through noise."""
    said, x, before, total = law(name, STILL), dq.IDENTITY, np.zeros(6), 0.0
    for k in range(3000):
        measured = dq.mul(x, dq.exp(0.5e-4 * rng.normal(size=6)))
        u = said(body_sees(measured, dq.IDENTITY)._replace(period=PERIOD))
        total += np.abs(u - before).sum() if k > 1500 else 0.0
        before = u
        x = dq.mul(dq.exp(0.5 * PERIOD * (u + slow_sine(k * PERIOD))), x)
    return total


def test_what_chatter_costs(rng):
    """6.6 times the travel of pi's command was seen with K_P = 10; half with twice that gain."""
    assert 2 < travel("super-twisting", rng) / travel("pi", rng) < 10


def accelerated(x_d, x, disturbance=None, seconds=1.5, h=5e-4, **gains):
    """z = 2 log(x_d x*) (N, 6) and s of a free body under `sliding`, and the time."""
    said, xi, zs, ss = law("sliding", STILL, **gains), np.zeros(6), [], []
    lam = gains.get("lam", 20.0)
    for k in range(int(seconds / h)):
        seen = body_sees(x, x_d, twist=xi)
        z = 2 * dq.log(dq.mul(x_d, dq.conj(x)))
        zs.append(z)
        ss.append(np.linalg.norm(-xi + lam * z))
        a = said(seen) + (0 if disturbance is None else disturbance(k * h))
        x = dq.mul(dq.exp(0.5 * h * (xi + 0.5 * h * a)), x)
        xi = xi + h * a
    return np.array(zs), np.array(ss), h * np.arange(len(zs))


@pytest.mark.slow
def test_sliding_s_error_dies_at_lambda_on_its_own_screw(rng):
    x, x_d = random_poses(rng, 2)
    x_d = dq.nearest(x_d, x)
    z, _, t = accelerated(x_d, x, lam=4.0, k=40.0, seconds=2.0)
    size, late = np.linalg.norm(z, axis=1), slice(1000, 3000)
    rate = -np.polyfit(t[late], np.log(size[late]), 1)[0]
    assert rate == pytest.approx(4.0, rel=0.01)
    way = z[late] / size[late][:, None]
    np.testing.assert_allclose(way, np.broadcast_to(way[-1], way.shape), atol=2e-3)


@pytest.mark.slow
def test_sliding_bounds_a_disturbance_where_accel_s_gains_yield(rng):
    x_d = random_poses(rng, 1)[0]
    size = np.array([1.0, 0.5, 0.0, 0.3, 0.2, 0.1])
    d = np.linalg.norm(size)
    for rho in (10.0, 0.0):
        _, s, _ = accelerated(x_d, x_d, lambda _t: size, rho=rho)
        assert 20 * s[-1] + rho * s[-1] / (s[-1] + 0.1) == pytest.approx(d, rel=0.02)


def test_left_jacobian_against_differences(rng):
    for z in rng.normal(size=(20, 6)) * 2.0:
        rate, h = rng.normal(size=6), 1e-6
        step = dq.mul(dq.exp(0.5 * (z + h * rate)), dq.conj(dq.exp(0.5 * (z - h * rate))))
        np.testing.assert_allclose(
            dq.left_jacobian(z) @ rate, dq.log(step) / h, atol=1e-7, rtol=1e-7
        )


def test_admittance_is_a_mass_on_a_spring_for_a_long_push(rng):
    """The free body follows z(t) of 2 kg, 200 N/m at half of critical damping, in closed form."""
    x_d, h = random_poses(rng, 1)[0], STILL.period
    force = np.array([3.0, -2.0, 5.0])
    said, x, found = law("admittance", STILL, damping=0.5), x_d, []
    for _ in range(150):
        u = said(body_sees(x, x_d)._replace(push=force))
        x = dq.mul(dq.exp(0.5 * h * u), x)
        found.append(dq.translation(x) - dq.translation(x_d))
    t, w = h * np.arange(1, 151), 10.0
    damped = w * np.sqrt(0.75)
    swing = np.cos(damped * t) + 0.5 * w / damped * np.sin(damped * t)
    wanted = (1 - np.exp(-0.5 * w * t) * swing)[:, None] * force / 200.0
    assert np.abs(found - wanted).max() < 0.06 * np.abs(wanted).max()  # Euler's step of the body


def test_the_spring_s_step_is_exact(rng):
    m, d, k, h, f = 0.7, 3.0, 90.0, 0.05, 4.0
    begin = rng.normal(size=2)
    flow = solve_ivp(
        lambda _t, y: [y[1], (f - d * y[1] - k * y[0]) / m], (0, h), begin, rtol=1e-11, atol=1e-12
    )
    np.testing.assert_allclose(spring_step(m, d, k, h) @ [*begin, f], flow.y[:, -1], atol=1e-8)


def learner(rng, **gains):
    """An `adaptive` with parameters that are none of them zero."""
    chosen = CONTROLLERS["adaptive"]
    said = started(chosen, ARM, STILL, **gains)
    said._base = dq.exp(0.1 * rng.normal(size=6))
    said._tool = dq.exp(0.1 * rng.normal(size=6))
    said._lengths = 0.02 * rng.normal(size=said._lengths.shape)
    return said


def test_the_learned_model_is_that_of_an_arm_with_these_lengths(rng):
    said = learner(rng)
    other = ARM.with_model_error(lengths=said._lengths)
    for q in rng.uniform(-1, 1, (5, 7)):
        x, J = other.pose_and_jacobian(q)
        wanted = dq.mul(dq.mul(said._base, x), said._tool)
        found, J_a = said.estimate(seen_by(ARM, q, x), ARM.link_axes(q))
        np.testing.assert_allclose(dq.nearest(found, wanted), wanted, atol=1e-12)
        np.testing.assert_allclose(J_a, dq.adjoint(said._base, J.T).T, atol=1e-12)


def test_how_the_estimate_changes_with_each_parameter(rng):
    said, q = learner(rng), rng.uniform(-1, 1, 7)
    axes, seen, h = ARM.link_axes(q), seen_by(ARM, q, dq.IDENTITY), 1e-6
    x_a, _ = said.estimate(seen, axes)
    place, turn = parameter_jacobians(x_a, said._base, axes)
    base, tool, lengths = said._base, said._tool, said._lengths
    for i in range(12 + lengths.size):
        ends = []
        for sign in (h, -h):
            a = np.zeros(12 + lengths.size)
            a[i] = sign
            said._base = dq.mul(dq.exp(0.5 * a[:6]), base)
            said._tool = dq.mul(tool, dq.exp(0.5 * a[6:12]))
            said._lengths = lengths + a[12:].reshape(-1, 3)
            ends.append(said.estimate(seen, axes)[0])
        moved = (dq.translation(ends[0]) - dq.translation(ends[1])) / (2 * h)
        turned = dq.log(dq.mul(ends[0], dq.conj(ends[1])))[:3] / h
        np.testing.assert_allclose(place[:, i], moved, atol=1e-8)
        np.testing.assert_allclose(turn[:, i], turned, atol=1e-8)


def test_what_is_learned_is_the_cheapest_change_and_turns_nothing(rng):
    A, usual = rng.normal(size=(6, 20)), rng.uniform(0.5, 2, 20)
    b = np.r_[rng.normal(size=3), 0, 0, 0]
    u = cheapest(A, b, usual)
    np.testing.assert_allclose(A @ u, b, atol=1e-5)
    free = np.linalg.svd(A)[2][6:]  # changes that nobody sees
    np.testing.assert_allclose(free @ (u / usual**2), 0, atol=1e-12)


@pytest.mark.slow
def test_the_second_star_of_a_bent_arm_is_straight():
    """Thirty times as straight as without; both begin as far off."""
    worst = {}
    for name in ("hinf", "adaptive"):
        run = dqpaint.draw(
            "bent-arm", controller=name, plant="ideal", disturb="links=part=0.03", size=(64, 36)
        )
        error = run.table["position_error_m"]
        worst[name] = error[len(error) // 2 :].max(), error[0]
    assert worst["adaptive"][1] == pytest.approx(worst["hinf"][1], rel=1e-9)
    assert worst["adaptive"][0] < 0.03 * worst["hinf"][0]


@pytest.mark.slow
def test_a_push_on_a_stiff_arm_is_a_mass_on_a_spring():
    """15 N on 2 kg and 200 N/m, critically damped, for a second: within 1 % of the largest way."""
    run = dqpaint.draw(
        "push", controller="admittance", disturb="push=z=15,start=1,seconds=1", size=(64, 36)
    )
    t = run.table["t_s"] - 1.0

    def step(t):
        t = np.maximum(t, 0)
        return 15 / 200 * (1 - (1 + 10 * t) * np.exp(-10 * t))

    wanted = step(t) - step(t - 1.0)
    found = run.table["z_m"] - run.table["desired_z_m"]
    assert np.abs(found - wanted).max() < 0.01 * wanted.max()


def test_mpc_of_one_step_is_log_with_the_resolver_qp(rng):
    """Where limits are in the way, and where none is, of healthy postures in motion."""
    for acceleration in (3.0, 1e6):
        text = f"qp,acceleration={min(acceleration, 1e5):g}"
        for seen in states(rng, 10, size=0.02):
            setup = Setup(ARM, seen.period)
            qp = make_resolver(text, setup)
            qp._last = np.zeros(7)  # at rest before, as the law is
            state = State(seen.pose, seen.jacobian, seen.posture, seen.time)
            wanted = qp.rates(state, [law("log", k=9.0)(seen)], None)
            found = law("mpc", k=9.0, steps=1, acceleration=acceleration)(seen)
            np.testing.assert_allclose(found, wanted, atol=2e-6)


@pytest.mark.slow
def test_mpc_rounds_a_corner_that_qp_overshoots():
    """Within the same accelerations; less than half of the largest error."""
    given = {"plant": "ideal", "null": "none", "size": (64, 36)}
    runs = [
        dqpaint.draw("corner", controller="log", resolver="qp,acceleration=3", **given),
        dqpaint.draw("corner", controller="mpc", gains={"steps": 10, "acceleration": 3.0}, **given),
    ]
    far = [run.table["position_error_m"].max() for run in runs]
    assert far[1] < 0.5 * far[0]
    for run in runs:
        change = np.abs(np.diff(run.track.command, axis=0)).max() / 0.008
        assert change < 3.0 * (1 + 1e-6)
        assert not run.track.clamps
