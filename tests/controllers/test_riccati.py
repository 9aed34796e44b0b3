"""The Riccati solver against tiny steps and closed forms, and that the LQR laws are optimal."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.controllers.base.riccati import GAUSS
from dqpaint.controllers.laws.pereira import lqr, lqr8
from dqpaint.controllers.laws.pereira.lqr8 import BLOCK, PLACES, body_rates
from dqpaint.language import parse
from dqpaint.motion import plan
from tests.support.control import ARM
from tests.support.strokes import strokes_of

ACCURACY = 1e-6  # of P and g, relative to their largest
SMOOTH = (
    "period 8 ms\nstart at (40, 0) mm\ncurve (40 mm * cos(t), 30 mm * sin(2 * t), 20 mm * sin(t)) "
    "for t from 0 to 1 turn in 1.6 s profile quintic tool rpy(90 deg, 20 deg, -30 deg)\n"
)
CORNERS = (
    "period 8 ms\nline to (40, 0) mm in 0.4 s profile constant tool rpy(30 deg, 0 deg, 0 deg)\n"
    "arc centre (0, 0) angle 60 deg in 0.4 s profile cubic tool rpy(0 deg, 40 deg, 0 deg)\n"
    "step to (0, 0, 50) mm\nline to (0, 40) mm in 0.32 s profile constant\nhold 80 ms\n"
)
UNEVEN = {"q": "1,2,3,4,5,6,7,8", "r": "0.01,0.02,0.03,0.04,0.05,0.06,0.07,0.08", "s": 0.3}


def asked(text):
    return plan(parse(text, "test.traj"), ARM.card.canvas.pose)


def solved(motion, **gains):
    """P (N, 8, 8) and g (N, 8) of lqr8."""
    chosen = CONTROLLERS["lqr8"]
    P, g = lqr8.riccati(motion, chosen.read_gains(gains))
    return P[:, PLACES], g


def exact_body_rates(motion, tau):
    """x_d* x_d_dot of every stroke at fractions tau of each of its intervals, from its formula.

    Seen from the light it does not matter where the drawing is placed.
    """
    rates = []
    for stroke in strokes_of(motion.program):
        fractions = (np.arange(stroke.count)[:, None] + tau) / stroke.count
        flow = stroke.flow(fractions.ravel())
        y = 0.5 * dq.adjoint(dq.conj(flow.pose), flow.twist)
        rates.append(y.reshape(stroke.count, len(tau), 6))
    y = np.concatenate(rates)
    y[motion.jump[:-1]] = 0
    return dq.pure(y)


def slope(A, y, q, r, z):
    e, p = z[:8], z[8:]
    out = np.concatenate([A @ e - p / r[:, None], -q[:, None] * e - A.T @ p])
    out[:8, 8] -= y
    return out


def tiny_steps(motion, gains, steps=12):
    """P and g by RK4 in tiny steps on nine solutions [e; p] of the linear flow: P = Y X^-1."""
    schedule = CONTROLLERS["lqr8"].read_gains(gains)
    rows = len(motion.t)
    tau = np.arange(2 * steps + 1) / (2 * steps)
    ys = exact_body_rates(motion, np.clip(tau, 1e-12, 1 - 1e-12))
    P, g, h = schedule.at(1.0).end_matrix(), np.zeros(8), -motion.period / steps
    Ps, gs = np.empty((rows, 8, 8)), np.empty((rows, 8))
    Ps[-1], gs[-1] = P, g
    for k in range(rows - 2, -1, -1):
        parts = (k + tau) / (rows - 1)
        q, r = (
            np.broadcast_to(schedule.column(n, parts).reshape(len(parts), -1), (len(parts), 8))
            for n in "qr"
        )
        z = np.zeros((16, 9))  # the first eight without c, the last one with it
        z[:8, :8], z[8:, :8], z[8:, 8] = np.eye(8), P, g
        at = list(zip(dq.hamilton_minus(ys[k]), ys[k], q, r, strict=True))
        for i in range(2 * steps, 0, -2):
            a = slope(*at[i], z)
            b = slope(*at[i - 1], z + h / 2 * a)
            c = slope(*at[i - 1], z + h / 2 * b)
            z = z + h / 6 * (a + 2 * b + 2 * c + slope(*at[i - 2], z + h * c))
        P = np.linalg.solve(z[:8, :8].T, z[8:, :8].T).T
        P, g = (P + P.T) / 2, z[8:, 8] - P @ z[:8, 8]
        Ps[k], gs[k] = P, g
    return Ps, gs


def apart(one, other):
    return np.abs(one - other).max() / np.abs(other).max()


@pytest.mark.parametrize("gains", [
    {}, UNEVEN, {"s": 0.0}, {"q": 1.0, "r": 0.1, "s": 100.0},
    {"q": "2..8", "r": "0.02..0.01"},
], ids=["usual", "uneven", "free end", "heavy end", "scheduled"])  # fmt: skip
def test_the_solution_is_that_of_tiny_steps(gains):
    motion = asked(SMOOTH)
    P, g = solved(motion, **gains)
    P_fine, g_fine = tiny_steps(motion, gains)
    assert apart(P, P_fine) < ACCURACY
    assert apart(g, g_fine) < ACCURACY
    assert np.abs(np.diff(P_fine, axis=0)).max() > 1e-6
    across = P - P * np.eye(8)
    assert np.abs(across).max() > 1e-4  # the light moves: P is not diagonal


@pytest.mark.parametrize("gains", [
    {"q": 270.0, "r": 0.01}, {**UNEVEN, "r": "1,2,3,4,1,2,3,4".replace(",", "e-4,") + "e-4"},
])  # fmt: skip
def test_quick_laws_are_halved_and_doubled(gains):
    """The thesis's best gain, 164 1/s, and uneven ones: too much for one series a period.

    The rate times the period is above 1: its fourth order is coarser there.
    """
    motion = asked(SMOOTH)
    P, g = solved(motion, **gains)
    P_fine, g_fine = tiny_steps(motion, gains, steps=20)
    assert apart(P, P_fine) < 3 * ACCURACY
    assert apart(g, g_fine) < 150 * ACCURACY


def test_corners_and_jumps_are_not_smoothed_over():
    """Each interval has its own stroke's twist, up to the row where the next one begins."""
    motion = asked(CORNERS)
    P, g = solved(motion)
    P_fine, g_fine = tiny_steps(motion, {})
    assert apart(P, P_fine) < ACCURACY
    assert apart(g, g_fine) < 1e-5
    assert motion.jump.any()
    assert len(np.unique(motion.stroke)) == 5


@pytest.mark.parametrize("text", [SMOOTH, CORNERS])
def test_twists_within_intervals_are_those_of_the_strokes(text):
    motion = asked(text)
    found = body_rates(motion, 0, len(motion.t) - 1)
    wanted = exact_body_rates(motion, GAUSS).swapaxes(0, 1)
    assert np.abs(found - wanted).max() < 1e-5 * np.abs(wanted).max()
    part = body_rates(motion, 3, 9)
    np.testing.assert_allclose(part, found[:, 3:9], atol=1e-15)


def test_it_does_not_matter_where_the_blocks_end():
    """A drawing of more than one block, against the same equations in one go."""
    line = f"line to (40, 9) mm samples {2 * BLOCK + 5} profile quintic tool rot(x, 30 deg)"
    text = f"period 1 ms\n{line}\n"
    motion = asked(text)
    P, g = solved(motion)
    P_fine, g_fine = tiny_steps(motion, {}, steps=1)
    assert apart(P, P_fine) < ACCURACY
    assert apart(g, g_fine) < ACCURACY


@pytest.mark.parametrize("gains", [
    {"s": 100.0, "r": 0.1}, {"s": 1e9, "r": 1e-9, "q": 1e9}, {"s": 0.0, "r": 1e9, "q": 1e-9},
    {"q": "1e9,1,1,1,1e-9,1,1,1", "r": "1e-9,1,1,1,1,1,1,1e9", "s": 1e3}, {"s": 1e9},
    {"q": 1e6, "r": 1e-6, "s": 0.0},
])  # fmt: skip
def test_nothing_blows_up(gains):
    """Where an explicit step of 8 ms on P diverges, and far beyond."""
    P, g = solved(asked(SMOOTH), **gains)
    assert np.isfinite(P).all()
    assert np.isfinite(g).all()
    assert (np.linalg.eigvalsh(P) > -1e-9 * np.abs(P).max()).all()
    rates = CONTROLLERS["lqr"].read_gains({n: v for n, v in gains.items() if "," not in str(v)})
    assert np.isfinite(lqr.riccati(asked(SMOOTH), rates)).all()


def test_an_explicit_step_does_blow_up():
    """The reason for all this: RK4 on P itself at 8 ms, S = 100, R^-1 = 10... and 40."""
    P, h = np.eye(8) * 100.0, 0.008
    with np.errstate(all="ignore"):
        for _ in range(50):
            a = 40 * P @ P - np.eye(8)
            b = 40 * (P - h / 2 * a) @ (P - h / 2 * a) - np.eye(8)
            P = P - h * b
    assert not np.abs(P).max() < 1e6


@pytest.mark.parametrize("s", [0.0, 0.05, 0.2, 3.0])
def test_lqr_by_its_closed_form(s):
    """P = sigma (s + sigma T) / (sigma + s T), T = tanh(sqrt(q/r) (tf - t)), sigma = sqrt(q r)."""
    motion, chosen = asked(SMOOTH), CONTROLLERS["lqr"]
    q, r = np.array([1.0, 2, 3, 4, 5, 6]), np.array([0.1, 0.2, 0.3, 0.1, 0.2, 0.3])
    P = lqr.riccati(motion, chosen.read_gains({"q": tuple(q), "r": tuple(r), "s": s}))
    T = np.tanh(np.sqrt(q / r) * (motion.t[-1] - motion.t)[:, None])
    sigma = np.sqrt(q * r)
    np.testing.assert_allclose(P, sigma * (s + sigma * T) / (sigma + s * T), rtol=1e-11)


def test_lqr_over_more_than_one_block():
    motion, chosen = asked("period 1 ms\nline to (40, 9) mm in 9 s\n"), CONTROLLERS["lqr"]
    P = lqr.riccati(motion, chosen.read_gains({"q": 0.01, "r": 0.04, "s": 0.0}))
    T = np.tanh(0.5 * (motion.t[-1] - motion.t)[:, None])
    np.testing.assert_allclose(P, 0.02 * T * np.ones(6), rtol=1e-10)


def test_lqr_with_scheduled_weights_by_tiny_steps():
    motion, chosen = asked(SMOOTH), CONTROLLERS["lqr"]
    schedule = chosen.read_gains({"q": "2..9", "r": "0.01..0.05@60%", "s": 0.1})
    P = lqr.riccati(motion, schedule)
    fine = 40
    parts = np.arange((len(motion.t) - 1) * 2 * fine + 1) / ((len(motion.t) - 1) * 2 * fine)
    q, r = schedule.column("q", parts), schedule.column("r", parts)
    p, h, out = 0.1, -motion.period / fine, []
    for i in range(len(parts) - 1, -1, -2):
        if i % (2 * fine) == 0:
            out.append(p)
        if i == 0:
            break
        a = p**2 / r[i] - q[i]
        b = (p + h / 2 * a) ** 2 / r[i - 1] - q[i - 1]
        c = (p + h / 2 * b) ** 2 / r[i - 1] - q[i - 1]
        p += h / 6 * (a + 2 * b + 2 * c + (p + h * c) ** 2 / r[i - 2] - q[i - 2])
    np.testing.assert_allclose(P, np.array(out[::-1])[:, None] * np.ones(6), rtol=2e-6)


def test_the_gain_stays_to_the_end_unless_told_otherwise():
    """With s = sqrt(q r), the default; with s = 0 it dies away in the last 1 / rate."""
    motion, chosen = asked(SMOOTH), CONTROLLERS["lqr"]
    steady = lqr.riccati(motion, chosen.read_gains({"q": 9.0, "r": 0.04}))
    np.testing.assert_allclose(steady, 0.6, rtol=1e-12)
    shown = chosen.read_gains({"q": 9.0, "r": 0.04}).as_dict()
    assert shown == {
        "q": 9.0,
        "r": 0.04,
        "s": pytest.approx(0.6),
        "form": "derived",
        "point": "base",
    }
    dying = lqr.riccati(motion, chosen.read_gains({"q": 9.0, "r": 0.04, "s": 0}))
    assert (dying[-1] == 0).all()
    np.testing.assert_allclose(dying[0], 0.6, rtol=1e-6)


# Optimality: the cost of a policy on the law's own linear model.


def costs(motion, P, g, q, r, s, starts, moving):
    """1/2 e's e + 1/2 int e'q e + u'r u, (B,) for policies P (B, N, m, m), g (B, N, m).

    e_dot = A e + u + c, u = -R^-1 (P e + g), by RK4 over two rows at a time.
    """
    m, h = P.shape[-1], 2 * motion.period
    y = dq.pure(0.5 * dq.adjoint(dq.conj(motion.pose), motion.twist))
    A = dq.hamilton_minus(y) if moving else np.zeros((len(y), m, m))
    c = -y if moving else np.zeros((len(y), m))

    def rate(k, e):
        u = -(np.matvec(P[:, k], e) + g[:, k]) / r
        return e @ A[k].T + u + c[k], 0.5 * (q * e**2 + r * u**2).sum(-1)

    e, total = np.broadcast_to(starts, (len(P), m)).copy(), np.zeros(len(P))
    for k in range(0, len(y) - 2, 2):
        a, ca = rate(k, e)
        b, cb = rate(k + 1, e + h / 2 * a)
        d, cd = rate(k + 1, e + h / 2 * b)
        f, cf = rate(k + 2, e + h * d)
        e = e + h / 6 * (a + 2 * b + 2 * d + f)
        total += h / 6 * (ca + 2 * cb + 2 * cd + cf)
    return total + 0.5 * (s * e**2).sum(-1)


BRISK = SMOOTH.replace("period 8 ms", "period 2 ms").replace("1.6 s", "0.6 s")


def perturbed(rng, P, g, count, size):
    """Gains that differ smoothly over time; the first one is the law's own."""
    n, m = g.shape
    t = np.linspace(0, 1, n)
    shape = np.stack([np.ones(n), np.cos(np.pi * t), np.cos(2 * np.pi * t), np.cos(3 * np.pi * t)])
    dP = np.einsum("kn,bkij->bnij", shape, rng.normal(size=(count + 1, 4, m, m)))
    dg = np.einsum("kn,bki->bni", shape, rng.normal(size=(count + 1, 4, m)))
    dP[0] = dg[0] = 0
    return P + size * np.abs(P).max() * dP, g + size * np.abs(g).max() * dg


@pytest.mark.slow
@pytest.mark.parametrize("gains", [
    {"q": 1.0, "r": 0.01}, {"q": "1,2,3,4,5,6,7,8", "r": 0.02, "s": 0.0},
])  # fmt: skip
@pytest.mark.parametrize("size", [0.002, 0.03])
def test_no_other_gain_of_lqr8_costs_less(rng, gains, size):
    """1000 random perturbations of P(t) and g(t)."""
    motion = asked(BRISK)
    P, g = solved(motion, **gains)
    weights = CONTROLLERS["lqr8"].read_gains(gains).first
    q, r, s = (
        np.broadcast_to(v, 8) for v in (weights.q, weights.r, weights.end_matrix().diagonal())
    )
    some = [
        costs(motion, *perturbed(rng, P, g, 125, size), q, r, s, 0.2 * rng.normal(size=8), True)
        for _ in range(8)
    ]
    for found in some:
        assert (found[1:] > found[0]).all()


@pytest.mark.slow
@pytest.mark.parametrize("size", [0.002, 0.05])
def test_no_other_gain_of_lqr_costs_less(rng, size):
    """1000 random perturbations of P(t), cross terms too; the model is e_dot = w."""
    motion, chosen = asked(BRISK), CONTROLLERS["lqr"]
    schedule = chosen.read_gains({"q": (1.0, 2.0, 3.0, 1.0, 2.0, 3.0), "r": 0.01, "s": 0.05})
    P = lqr.riccati(motion, schedule)[:, :, None] * np.eye(6)
    q, r, s = np.array(schedule.first.q), np.full(6, 0.01), np.full(6, 0.05)
    for _ in range(8):
        gains, nothing = perturbed(rng, P, np.zeros((len(P), 6)), 125, size)
        found = costs(motion, gains, nothing, q, r, s, rng.normal(size=6), False)
        assert (found[1:] > found[0]).all()


def test_p_and_g_are_the_price_of_an_error(rng):
    """cost(e) - cost(0) = 1/2 e'P e + g'e at the start: P and g by the cost alone."""
    motion = asked(BRISK)
    P, g = solved(motion, **UNEVEN)
    weights = CONTROLLERS["lqr8"].read_gains(UNEVEN).first
    q, r, s = (
        np.broadcast_to(v, 8) for v in (weights.q, weights.r, weights.end_matrix().diagonal())
    )
    for e in rng.normal(size=(5, 8)):
        here, none = (
            costs(motion, P[None], g[None], q, r, s, start, True)[0] for start in (e, 0 * e)
        )
        assert here - none == pytest.approx(0.5 * e @ P[0] @ e + g[0] @ e, rel=1e-7)


@pytest.mark.parametrize(("name", "size"), [("lqr8", 8), ("lqr", 6)])
def test_diagonals_have_the_law_s_own_length(name, size):
    from dqpaint.errors import UsageError

    chosen = CONTROLLERS[name]
    given = chosen.read_gains({"q": ",".join(["2"] * size)}).first
    assert given.q == (2.0,) * size
    with pytest.raises(UsageError, match=f"3 numbers; .*{size}; "):
        chosen.read_gains({"q": "1,2,3"})
    with pytest.raises(UsageError, match=r"'r' .* is 0; .*1e-09"):
        chosen.read_gains({"r": (0.0,) * size})
    with pytest.raises(UsageError, match=r"'s' .* is -1; .*from 0 to"):
        chosen.read_gains({"s": -1})
