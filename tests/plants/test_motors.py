"""Geared motors without a physics engine, against closed forms and event-exact solutions."""

import numpy as np
import pytest
from scipy.optimize import brentq

from dqpaint.plants.motors import (
    Cascade,
    GearedMotors,
    Gears,
    MinimumJerk,
    ServoMotors,
    Slew,
    ThetaGC,
)
from dqpaint.plants.motors.commands import DelayLine

FREE, FAST = 1e-9, 1e7  # a gear that carries nothing; a current loop without lag
STEP = 2.5e-4


def gears(n=1, **given):
    usual = {
        "inertia": 0.8, "viscous": 0.0, "friction": 0.0, "stiction": 1.0, "stiffness": FREE,
        "damping": 0.0, "backlash": 0.0, "ripple": 0.0, "cycles": 200.0,
    }  # fmt: skip
    return Gears(**{name: np.full(n, one) for name, one in {**usual, **given}.items()})


def cascade(one, kp=30.0, kv=70.0, reset=0.0, forward=0.0, limit=1e6):
    return Cascade(
        one.inertia, one.inertia, kp, kv, reset, np.full_like(one.inertia, limit), forward
    )


def servo(one, loop, make_filter=None, delay=0.0, current=FAST):
    n = len(one.inertia)
    return ServoMotors(
        one, loop, make_filter or (lambda first: Slew(first, np.full(n, 1e9))), np.zeros(n),
        np.zeros(n), np.array([[-10.0] * n, [10.0] * n]), delay, current,
    )  # fmt: skip


def test_the_cascade_is_a_loop_of_second_order():
    """A step of 0.1 rad: q = 0.1 (1 - e^-zwt (cos w_d t + z / sqrt(1-z^2) sin w_d t))."""
    kp, kv = 60.0, 50.0
    one = gears(3, inertia=0.8)
    motors = servo(one, cascade(one, kp, kv))
    motors.command_angle(np.array([0.1, -0.2, 0.05]))
    t = np.arange(1, 801) * STEP
    found = []
    for _ in t:
        motors.step(STEP, np.zeros(3), np.zeros(3))
        found.append(motors.gear.angle)
    w, z = np.sqrt(kp * kv), kv / 2 / np.sqrt(kp * kv)
    wd = w * np.sqrt(1 - z**2)
    wanted = 1 - np.exp(-z * w * t) * (np.cos(wd * t) + z * w / wd * np.sin(wd * t))
    assert wanted.max() > 1.1
    for joint, size in enumerate([0.1, -0.2, 0.05]):
        np.testing.assert_allclose(np.array(found)[:, joint] / size, wanted, atol=0.002)


def test_feed_forward_leaves_no_lag_and_a_velocity_integral_no_sag():
    one = gears(2, viscous=2.0)
    motors = servo(one, cascade(one, reset=0.05, forward=1.0))
    motors.command(np.array([0.3, -0.2]))
    for _ in range(8000):
        motors.step(STEP, np.zeros(2), np.zeros(2))
    np.testing.assert_allclose(motors.gear.angle, 2.0 * np.array([0.3, -0.2]), atol=1e-5)


def test_an_integrator_does_not_gather_what_the_motors_limit_keeps():
    """A radian at the motors' limit: without its care it would pass the target by 2.5 rad."""
    one = gears(1)
    motors = servo(one, cascade(one, kp=5.0, reset=0.1, limit=2.0))
    motors.command_angle(np.array([1.0]))
    angles = []
    for _ in range(12000):
        motors.step(STEP, np.zeros(1), np.zeros(1))
        angles.append(motors.gear.angle[0])
    assert 1.1 < max(angles) < 1.4
    assert angles[-1] == pytest.approx(1.0, abs=0.001)


def test_current_loops_follow_with_their_lag():
    """tau = limit (1 - e^-wt): the mean over steps that are as long as the lag is exact."""
    one = gears(1)
    motors = servo(one, cascade(one, limit=7.0), current=100.0)
    motors.command_angle(np.array([5.0]))
    momentum = 0.0
    for k in range(1, 6):
        motors._part(0.01, np.zeros(1), np.zeros(1))
        t = 0.01 * k
        assert motors.motor_torque[0] == pytest.approx(7 * (1 - np.exp(-100 * t)), rel=1e-12)
        momentum = 7 * (t - (1 - np.exp(-100 * t)) / 100)
    assert motors.gear.rate[0] == pytest.approx(momentum / 0.8, rel=1e-6)


@pytest.mark.parametrize("stiction", [1.0, 1.5])
def test_static_friction_has_its_dead_band(stiction):
    """|reference - theta| < stiction friction / (I kp kv) moves nothing; a hair more does."""
    one = gears(1, friction=0.9, stiction=stiction)
    band = 0.9 * stiction / (0.8 * 30 * 70)

    def moves(target):
        motors = servo(one, cascade(one))
        motors.command_angle(np.array([target]))
        for _ in range(400):
            motors.step(STEP, np.zeros(1), np.zeros(1))
        return motors.gear.angle[0] != 0.0

    low, high = 0.1 * band, 10 * band
    for _ in range(12):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if moves(middle) else (middle, high)
    assert high == pytest.approx(band, rel=0.01)


def test_friction_stops_a_motor_where_it_should_and_for_good():
    """From rate w: after B w / friction, B w^2 / (2 friction) on; then exactly at rest."""
    one = gears(1, friction=0.9)
    motor = GearedMotors(one, np.zeros(1), np.zeros(1))
    motor.rate = np.array([2.0])
    motor._before = motor.rate
    time, rates = 0.0, []
    while motor.rate[0] > 0:
        push(motor, np.zeros(1))
        time += STEP
    assert time == pytest.approx(0.8 * 2 / 0.9, rel=0.01)
    assert motor.angle[0] == pytest.approx(0.8 * 4 / 2 / 0.9, rel=0.01)
    for torque in (0.89, -0.89, 0.5, 0.0):
        push(motor, np.array([torque]))
        rates.append(motor.rate[0])
    assert rates == [0.0] * 4


def test_a_motor_pushed_against_friction_runs_as_its_closed_form():
    """B w_dot = tau - friction - viscous w: w = (tau - friction) / b (1 - e^-bt/B)."""
    one = gears(1, friction=0.9, viscous=3.0)
    motor = GearedMotors(one, np.zeros(1), np.zeros(1))
    for k in range(1, 2001):
        push(motor, np.array([2.0]))
        wanted = 1.1 / 3 * (1 - np.exp(-3 * k * STEP / 0.8))
        assert motor.rate[0] == pytest.approx(wanted, rel=1e-5)


def test_sticking_and_slipping_neither_chatters_nor_creeps():
    """A sinusoidal torque below static friction, then above: it turns back only at rest."""
    one = gears(1, friction=0.9, stiction=1.3)
    motor = GearedMotors(one, np.zeros(1), np.zeros(1))
    signs = []
    for k in range(20000):
        t = k * STEP
        size = 1.1 if t < 2.5 else 1.5
        push(motor, np.array([size * np.sin(2 * np.pi * t)]))
        signs.append(np.sign(motor.rate[0]))
    signs = np.array(signs)
    assert not signs[: int(2.5 / STEP)].any()
    turns = np.flatnonzero(np.diff(signs[int(2.5 / STEP) :]))
    assert 8 <= len(turns) <= 11  # starts and stops of five half swings, none more


def push(motor, torque):
    """A step under a torque, with nothing behind the gear."""
    middle = motor.middle(STEP)
    motor.carry(middle, np.zeros(1), np.zeros(1))
    motor.move(STEP, middle, torque)


def free_pair(k, d, gap, B=0.8, H=0.5, rate=1.0, steps=4000, step=STEP):
    """A motor thrown against a link that moves freely: angle and rate between them."""
    one = gears(1, inertia=B, stiffness=k, damping=d, backlash=gap)
    motor = GearedMotors(one, np.zeros(1), np.zeros(1))
    motor.rate = np.array([rate])
    motor._before = motor.rate
    q, v, before = np.zeros(1), np.zeros(1), np.zeros(1)  # q half a step ahead, as an engine has it
    found = []
    for _ in range(steps):
        torque = motor.carry(motor.middle(step), q, 1.5 * v - 0.5 * before)
        motor.move(step, motor.middle(step), np.zeros(1))
        before, v = v, v + step * torque / H
        found.append((motor.angle[0] - (q[0] + 0.5 * step * v[0]), motor.rate[0] - v[0],
                      motor.rate[0], v[0]))  # fmt: skip
        q = q + step * v
    return np.array(found)


def exact_pair(k, d, gap, times, B=0.8, H=0.5, rate=1.0):
    """The same from event to event: straight in the gap, a damped swing in contact."""
    m = B * H / (B + H)
    a, w0 = d / 2 / m, np.sqrt(k / m)
    wd = np.sqrt(w0**2 - a**2)
    out, t0, x0, v0 = np.empty(len(times)), 0.0, 0.0, rate
    in_gap, side = True, 1.0
    while t0 < times[-1]:
        if in_gap:
            side = np.sign(v0)
            length = (side * gap / 2 - x0) / v0
            now = (times >= t0) & (times < t0 + length)
            out[now] = x0 + v0 * (times[now] - t0)
            t0, x0, in_gap = t0 + length, side * gap / 2, False
            continue
        begin = v0

        def rate_at(t, begin=begin):
            return begin * np.exp(-a * t) * (np.cos(wd * t) - a / wd * np.sin(wd * t))

        def wound_at(t, begin=begin):
            return begin / wd * np.exp(-a * t) * np.sin(wd * t)

        # it lets go where spring and damper together push no more
        least, most = 0.25 * np.pi / wd, 1.0001 * np.pi / wd
        length = brentq(lambda t, s=side: s * (k * wound_at(t) + d * rate_at(t)), least, most)
        now = (times >= t0) & (times < t0 + length)
        out[now] = side * gap / 2 + wound_at(times[now] - t0)
        x0, v0 = side * gap / 2 + wound_at(length), rate_at(length)
        t0, in_gap = t0 + length, True
    return out


@pytest.mark.parametrize("loss", [0.0, 0.05])
def test_backlash_is_that_of_an_event_exact_solution(loss):
    """Motor and link thrown to and fro in their gap, 20 impacts: within 1 % of the gap."""
    k, gap = 900.0, 0.02
    m = 0.8 * 0.5 / 1.3
    d = 2 * loss * np.sqrt(k * m)
    step = 1e-4
    found = free_pair(k, d, gap, steps=15000, step=step)
    times = step * np.arange(1, 15001)
    exact = exact_pair(k, d, gap, times)
    impacts = np.count_nonzero(np.diff(np.abs(exact) > gap / 2)) / 2
    assert impacts >= 12
    amplitude = np.abs(exact).max()
    assert amplitude > 1.3 * gap
    np.testing.assert_allclose(found[:, 0], exact, atol=0.01 * amplitude)


def test_energy_does_not_grow_by_itself():
    """Spring, gap and rotors without loss keep it; a damper only takes."""
    B, H, gap = 0.8, 0.5, 0.02
    for k, d in ((900.0, 0.0), (900.0, 3.0), (30000.0, 0.0), (30000.0, 40.0)):
        apart, _, motor, link = free_pair(k, d, gap, steps=5000).T
        wound = np.maximum(np.abs(apart) - gap / 2, 0)
        energy = 0.5 * (B * motor**2 + H * link**2 + k * wound**2) / (0.5 * B)
        assert energy.max() < 1.01
        # what is left when the two go on together: the common motion
        assert energy[-1] == pytest.approx(1.0 if d == 0 else B / (B + H), rel=0.02)


def test_ripple_has_its_amplitude():
    """Coasting over it: B (w_max^2 - w_min^2) / 2 = 2 ripple / cycles."""
    one = gears(1, ripple=0.4, cycles=50.0)
    motor = GearedMotors(one, np.zeros(1), np.zeros(1))
    motor.rate = np.array([0.5])
    motor._before = motor.rate
    rates = []
    for _ in range(4000):
        push(motor, np.zeros(1))
        rates.append(motor.rate[0])
    swing = 0.5 * 0.8 * (np.max(rates) ** 2 - np.min(rates) ** 2)
    assert swing == pytest.approx(2 * 0.4 / 50, rel=0.01)


def test_delay_is_exact_whatever_the_steps_are(rng):
    """The integral of random commands of 8 ms, 3.3 ms late, in steps of 0.7 ms and others."""
    rates, delay, period = rng.normal(size=12), 0.0033, 0.008
    for parts in (11, 7, 3):
        line, step, angle, found = DelayLine(np.zeros(1), delay), period / parts, 0.0, []
        for rate in rates:
            line.give(np.array([rate]))
            for _ in range(parts):
                angle += step * line.advance(step)[0][0]
                found.append(angle)
        t = step * np.arange(1, len(found) + 1)
        edges = period * np.arange(13)
        wanted = [
            sum(
                r * (min(max(now - delay, a), b) - a)
                for r, a, b in zip(rates, edges[:-1], edges[1:], strict=True)
            )
            for now in t
        ]
        np.testing.assert_allclose(found, wanted, atol=1e-14)


def test_the_slew_filter_limits_speed_and_nothing_else():
    one = Slew(np.zeros(2), np.array([0.5, 2.0]))
    for k in range(1, 101):
        middle = one.advance(1e-3, np.array([0.03, -0.15]))
        t = 1e-3 * k
        half = t - 0.5e-3
        np.testing.assert_allclose(
            middle, [min(0.03, 0.5 * half), -min(0.15, 2 * half)], atol=1e-15
        )
        np.testing.assert_allclose(one.angle, [min(0.03, 0.5 * t), -min(0.15, 2 * t)], atol=1e-15)


def test_the_minimum_jerk_filter_is_the_quintic():
    """From rest: h (10 s^3 - 15 s^4 + 6 s^5), its largest speed the given one."""
    speed, h = 0.5, 0.2
    one = MinimumJerk(np.zeros(1), np.array([speed]), 0.008)
    one.begin(np.array([h]))
    D = 1.875 * h / speed
    angles = [0.0]
    for k in range(1, 1001):
        one.advance(1e-3, np.array([h]))
        angles.append(one.angle[0])
        s = min(1.0, 1e-3 * k / D)
        assert one.angle[0] == pytest.approx(h * s**3 * (10 - 15 * s + 6 * s**2), abs=1e-9)
    assert np.diff(angles).max() / 1e-3 == pytest.approx(speed, rel=1e-3)


def test_the_minimum_jerk_filter_turns_without_a_jolt():
    """A new target on the way: position, rate and acceleration go on."""
    one = MinimumJerk(np.zeros(1), np.array([0.5]), 0.008)
    one.begin(np.array([0.2]))
    angles = []
    for k in range(1500):
        if k == 300:
            one.begin(np.array([-0.1]))
        one.advance(1e-3, np.array([0.2 if k < 300 else -0.1]))
        angles.append(one.angle[0])
    acceleration = np.diff(angles, 2) / 1e-6
    assert np.abs(np.diff(acceleration)).max() < 0.15  # jerk below 150 rad/s^3
    assert angles[-1] == pytest.approx(-0.1, abs=1e-9)


def held_joint(scale=0.5, friction=0.0, bandwidth=200.0, steps=4000, reset=0.0):
    """THETA_GC with the joint held 0.05 rad from its reference."""
    one = gears(1, inertia=0.4, stiffness=400.0, friction=friction)
    loop = ThetaGC(
        np.array([40.0]), np.array([3.0]), reset, scale, one.inertia, one.stiffness, bandwidth,
        np.array([1e6]),
    )  # fmt: skip
    loop.added = np.array([1.5])
    motors = servo(one, loop)
    motors.command_angle(np.array([0.05]))
    torques = [motors.step(STEP, np.zeros(1), np.zeros(1))[0] for _ in range(steps)]
    return np.array(torques)


def test_theta_gc_gives_the_scaled_torque_and_what_is_fed_forward():
    """tau = s P 0.05 + added (4.1, 4.2); the loop that makes it is of second order, 0.7 damped."""
    for scale in (0.5, 1.0):
        torques = held_joint(scale)
        wanted = scale * 40 * 0.05 + 1.5
        assert torques[-1] == pytest.approx(wanted, rel=1e-3)
        t = (np.arange(len(torques)) + 0.5) * STEP
        w, z = 200.0, 0.7
        wd = w * np.sqrt(1 - z**2)
        step = 1 - np.exp(-z * w * t) * (np.cos(wd * t) + z * w / wd * np.sin(wd * t))
        np.testing.assert_allclose(torques, wanted * step, atol=0.01 * wanted)


def test_the_torque_loop_holds_friction_down():
    """What friction takes of the torque is friction / (1 + G), with G = B w^2 / k - 1."""
    gain = 0.4 * 200.0**2 / 400 - 1
    lost = held_joint(friction=0.0)[-1] - held_joint(friction=2.0)[-1]
    assert 0 < abs(lost) <= 2.0 / (1 + gain) * 1.01
    assert gain == pytest.approx(39)


def test_loops_hold_the_arm_from_the_first_step_on():
    """In balance under a torque, gears wound and their gaps closed: nothing moves."""
    one = gears(2, stiffness=500.0, backlash=0.01, damping=2.0)
    torque, joint = np.array([6.0, -3.0]), np.array([0.4, -0.2])
    loops = [
        cascade(one), cascade(one, reset=0.1),
        ThetaGC(np.full(2, 40.0), np.full(2, 3.0), 0.0, 0.5, one.inertia, one.stiffness, 200.0,
                np.full(2, 1e6)),
    ]  # fmt: skip
    for loop in loops:
        loop.added = 0.6 * torque
        motors = ServoMotors(
            one, loop, lambda first: Slew(first, np.full(2, 1.0)), joint, torque,
            np.array([[-3.0] * 2, [3.0] * 2]), 0.003, 1000.0,
        )  # fmt: skip
        for _ in range(100):
            np.testing.assert_allclose(motors.step(STEP, joint, np.zeros(2)), torque, atol=1e-9)
