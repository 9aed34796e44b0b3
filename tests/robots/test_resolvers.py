"""Resolvers: each keeps its own equation, the program keeps its bounds and else changes nothing."""

import numpy as np
import pytest
from scipy.optimize import minimize

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.errors import UsageError
from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics import make_kinematics, resolve, tool_jacobian_map
from dqpaint.robots.model import TASKS, read_card
from dqpaint.robots.resolvers import (
    RESOLVERS,
    Bounds,
    Qp,
    Setup,
    State,
    make_resolver,
    read_resolver,
)
from dqpaint.simulation import track

ARM = make_kinematics(read_card("iiwa"))
PERIOD = 0.008


def state(posture):
    return State(*ARM.pose_and_jacobian(posture), posture)


def resolver(text, task="pose", period=PERIOD):
    return make_resolver(text, Setup(ARM, period, TASKS[task]))


def at_tool(now):
    return tool_jacobian_map(dq.translation(now.pose)) @ now.jacobian


@pytest.fixture
def general(rng):
    now = state(rng.uniform(-1.2, 1.2, 7))
    return now, rng.normal(size=6), rng.normal(size=7)


def near_singular(rng, bend=0.02):
    return state(np.array([0.3, 0.4, 0.1, -bend, 0.2, 0.5, 0.3]))


def test_without_damping_it_is_the_pseudo_inverse_of_moore_and_penrose(rng):
    """Beside numpy's pinv, at full rank and where the elbow is stretched: there it has no bound."""
    for posture in (rng.uniform(-1.5, 1.5, 7), np.array([0.3, 0.4, 0.1, 1e-4, 0.2, 0.5, 0.3])):
        now, twist, wish = state(posture), rng.normal(size=6), rng.normal(size=7)
        found = resolver("none").rates(now, [twist], wish)
        pseudo = np.linalg.pinv(now.jacobian, rcond=1e-12)
        expected = pseudo @ twist + wish - pseudo @ (now.jacobian @ wish)
        np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-6 * np.abs(expected).max())
    assert np.abs(found).max() > 100


def test_the_plain_inverse_leaves_out_what_is_rounding():
    squares = np.array([0.0, 1e-17, 0.25, 1.0, 2.0, 4.0])
    np.testing.assert_allclose(resolver("none").damping(squares), [0, 0, 4, 1, 0.5, 0.25])


def test_wampler_s_damping_is_least_squares_with_a_price_on_the_rates(general):
    """The rates are what minimises |J q - u|^2 + l^2 |q|^2, lengths in units of 0.3 m."""
    now, twist, _ = general
    factor, shift = 0.2, tool_jacobian_map(dq.translation(now.pose))
    stacked = np.vstack([shift @ now.jacobian, factor * np.eye(7)])
    expected = np.linalg.lstsq(stacked, np.append(shift @ twist, np.zeros(7)))[0]
    found = resolver(f"wampler,factor={factor}").rates(now, [twist], None)
    np.testing.assert_allclose(found, expected, atol=1e-12)


def test_the_filter_is_what_runs_have_always_had_and_takes_other_numbers(general, rng):
    now, twist, wish = general
    for one in (now, near_singular(rng)):
        usual = resolve(one.jacobian, dq.translation(one.pose), twist, wish)
        assert np.array_equal(resolver("filter").rates(one, [twist], wish), usual)
        said = resolver("filter,threshold=0.04,peak=0.0200000001").rates(one, [twist], wish)
        np.testing.assert_allclose(said, usual, rtol=1e-5, atol=1e-8)  # the general way, too
    t, peak = 0.3, 0.1
    damping = resolver(f"filter,threshold={t},peak={peak}").damping
    truth = 1 / np.array([peak**2, t * t / 4 + 0.75 * peak**2, t * t])
    np.testing.assert_allclose(damping(np.array([0.0, t * t / 4, t * t])), truth)


def test_uniform_damping_is_nakamura_s(rng):
    now, twist = near_singular(rng), rng.normal(size=6)
    J, shift = at_tool(now), tool_jacobian_map(dq.translation(now.pose))
    w, w0, l0 = np.sqrt(np.linalg.det(J @ J.T)), 0.5, 0.07
    assert w < 0.1 * w0
    damped = J @ J.T + (l0 * (1 - w / w0)) ** 2 * np.eye(6)
    found = resolver(f"uniform,factor={l0},below={w0}").rates(now, [twist], None)
    np.testing.assert_allclose(found, J.T @ np.linalg.solve(damped, shift @ twist), rtol=1e-8)
    healthy = resolver(f"uniform,below={w / 2}").rates(now, [twist], None)
    np.testing.assert_allclose(healthy, np.linalg.pinv(J) @ shift @ twist, rtol=1e-8)


def test_selective_damping_clamps_each_direction_by_what_it_costs(rng):
    """Written out by loops, as the paper has it."""
    now, twist, most = near_singular(rng, 0.05), 0.5 * rng.normal(size=6), 0.6
    J, left = at_tool(now), tool_jacobian_map(dq.translation(now.pose)) @ twist
    U, s, Vt = np.linalg.svd(J, full_matrices=False)
    total = np.zeros(7)
    for i in range(6):
        step = Vt[i] * (U[:, i] @ left) / s[i]
        cost = sum(abs(Vt[i, j]) * np.linalg.norm(J[:, j]) for j in range(7)) / s[i]
        bound = most * min(1.0, 1.0 / cost)
        total += step * min(1.0, bound / np.abs(step).max())
    total *= min(1.0, most / np.abs(total).max())
    found = resolver(f"selective,most={most}").rates(now, [twist], None)
    np.testing.assert_allclose(found, total, rtol=1e-9)
    assert np.abs(found).max() <= most * (1 + 1e-12)
    exact = resolver("selective,most=100").rates(
        state(rng.uniform(-1.2, 1.2, 7)), [1e-3 * twist], None
    )
    assert np.isfinite(exact).all()


@pytest.mark.parametrize("name", [n for n, one in RESOLVERS.items() if one.batched])
@pytest.mark.parametrize("task", TASKS)
def test_many_at_once_are_each_by_itself(name, task, rng):
    postures = rng.uniform(-1.2, 1.2, (4, 7))
    x, J = ARM.poses_and_jacobians(postures)
    twists, wish = rng.normal(size=(4, 6)), rng.normal(size=(4, 7))
    one = resolver(name, task)
    parts = len(TASKS[task].parts)
    many = one.rates(State(x, J, postures), [twists] * parts, wish)
    for i in range(4):
        alone = one.rates(State(x[i], J[i], postures[i]), [twists[i]] * parts, wish[i])
        np.testing.assert_allclose(many[i], alone, atol=1e-9)


@pytest.mark.parametrize("task", TASKS)
def test_the_program_is_the_filter_where_nothing_is_active(task, rng):
    for _ in range(20):
        now, twist = state(rng.uniform(-1.2, 1.2, 7)), 0.05 * rng.normal(size=6)
        twists = [twist] * len(TASKS[task].parts)
        wish = 0.05 * rng.normal(size=7)
        nominal = resolver("filter", task).rates(now, twists, wish)
        if np.abs(nominal).max() > 0.5:
            continue
        np.testing.assert_allclose(
            resolver("qp", task).rates(now, twists, wish), nominal, atol=1e-9
        )


def test_bounds_of_the_program_are_those_of_limits_rates_and_accelerations(rng):
    card = ARM.card
    q = card.upper.copy()
    q[0], q[3] = card.lower[0] + 0.01, card.lower[3] - 0.02  # near a limit, and beyond one
    q[1] = q[2] = q[4] = q[5] = q[6] = 0.0
    one = resolver("qp,eta=20,acceleration=5")
    bounds = one.bounds(state(q))
    assert bounds.lower[0] == pytest.approx(-0.2)
    assert bounds.lower[3] == pytest.approx(0.4)  # it comes back
    np.testing.assert_allclose(bounds.upper, np.minimum(card.speed, 20 * (card.upper - q)))
    first = one.rates(state(np.zeros(7) + 0.3), [np.zeros(6)], 0.2 * rng.normal(size=7))
    after = one.bounds(state(np.zeros(7) + 0.3))
    np.testing.assert_allclose(after.upper - first, 5 * PERIOD)
    np.testing.assert_allclose(first - after.lower, 5 * PERIOD)


def test_the_program_finds_the_nearest_rates_that_keep_everything(rng):
    """Beside scipy's SLSQP, from general problems."""
    for _ in range(10):
        J, wanted = rng.normal(size=(6, 7)), rng.normal(size=7)
        A = rng.normal(size=(5, 7))
        inside = 0.2 * rng.normal(size=7)
        b = A @ inside + rng.uniform(0.01, 0.1, 5)
        bounds = Bounds(inside - 0.5, inside + 0.5, A, b)
        found = Qp.nearest(wanted, lambda J=J: J.T @ J, bounds)
        H = J.T @ J + 1e-5 * np.eye(7)

        def cost(q, H=H, wanted=wanted):
            return (q - wanted) @ H @ (q - wanted)

        truth = minimize(
            cost, inside, jac=lambda q, H=H, w=wanted: 2 * H @ (q - w), method="SLSQP",
            bounds=list(zip(bounds.lower, bounds.upper, strict=True)),
            constraints={"type": "ineq", "fun": lambda q, A=A, b=b: b - A @ q},
            options={"ftol": 1e-14, "maxiter": 500},
        )  # fmt: skip
        assert (A @ found.rates <= b + 1e-8).all()
        assert cost(found.rates) <= cost(truth.x) + 1e-7
        assert found.slack == 0.0
        tight = b - A @ found.rates < 1e-7
        assert np.array_equal(found.active, tight) or not tight.any()


def test_what_cannot_be_kept_is_missed_by_the_least():
    """Two walls that close in on each other: both are missed by half of what they overlap."""
    A = np.array([[1.0, 0, 0, 0, 0, 0, 0], [-1.0, 0, 0, 0, 0, 0, 0]])
    bounds = Bounds(-np.ones(7), np.ones(7), A, np.array([-0.3, -0.1]))
    found = Qp.nearest(np.zeros(7), lambda: np.eye(7), bounds)
    assert found.slack == pytest.approx(0.2, abs=1e-3)
    np.testing.assert_allclose(found.rates[0], -0.1, atol=1e-3)
    limits = Bounds(-0.05 * np.ones(7), 0.05 * np.ones(7), A[:1], np.array([-0.3]))
    found = Qp.nearest(np.zeros(7), lambda: np.eye(7), limits)
    assert found.rates[0] == -0.05  # a joint's own limit is kept
    assert found.slack == pytest.approx(0.25, abs=1e-3)


def test_an_eta_that_passes_walls_is_refused_unless_forced():
    with pytest.raises(UsageError, match="125 here"):
        resolver("qp,eta=126")
    assert resolver("qp,eta=126,force=yes").eta == 126
    assert resolver("qp,eta=125").eta == 125
    assert resolver("qp").eta == pytest.approx(0.1 / PERIOD)


@pytest.mark.parametrize("text", [
    "x", "none,factor=1", "wampler,factor=0", "wampler,factor=2", "wampler,wide=1", "wampler,=", "",
    "qp,eta=0", "qp,eta=nan", "uniform,below=-1", "selective,most=0", "filter,threshold=2",
])  # fmt: skip
def test_a_resolver_that_cannot_be_is_refused(text):
    with pytest.raises(UsageError, match="resolver"):
        read_resolver(text)


def test_the_program_holds_the_rates_of_laws_that_command_joints():
    text = "period 8 ms\nstart at (0, 0) mm\nline to (150, 0) mm in 0.3 s\nhold 0.3 s\n"
    motion, law = plan(parse(text), ARM.card.canvas.pose), CONTROLLERS["translation"]
    how = (motion, ARM, ARM.card.home, PLANTS["ideal"], law, law.read_gains({}))
    plain, held = track(*how), track(*how, resolver="qp,acceleration=3")
    assert np.abs(np.diff(plain.command[:-1], axis=0)).max() > 4 * 3 * PERIOD
    assert np.abs(np.diff(held.command[:-1], axis=0)).max() < 3 * PERIOD * (1 + 1e-6)
    assert not held.clamps
