"""A drawing whose clock runs slower: re-timed exactly, corners kept, smooth, nowhere too quick."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.motion.time_scaling import AHEAD, TimeScaling, smooth
from dqpaint.robots.model.card import read_card

CANVAS = read_card("iiwa").canvas.pose
PERIOD = 0.004
TEXT = """period 4 ms
start at (60, 0, 10) mm
arc centre (0, 0) angle 200 deg in 0.9 s profile quintic light red to blue
line to (0, 90, 30) mm tool rpy(10 deg, 20 deg, 30 deg) in 0.7 s
screw about (0, 0, 0) along (1, 2, 3) angle 50 deg pitch 90 mm/turn in 0.5 s profile constant
step to (10, 80, 0) mm
hold 0.3 s
"""
ASKED = plan(parse(TEXT, "t.traj"), CANVAS)


def slowed(slowness):
    return plan(parse(TEXT, "t.traj"), CANVAS, TimeScaling(slowness, PERIOD))


def wavy():
    """Up to four times as slow, and as asked near the end."""
    s = ASKED.t
    return np.where(s < 1.9, 1 + 3 * np.sin(np.pi * s / 1.9) ** 4, 1.0)


def asked_at(clock):
    """What was asked, between its samples: the same drawing, sampled 64 times as finely."""
    fine = plan(parse(TEXT.replace("4 ms", "0.0625 ms"), "t.traj"), CANVAS)
    return fine.pose[np.round(clock / 6.25e-5).astype(int)], fine


def test_no_slowness_is_the_same_bit_for_bit():
    again = slowed(np.ones(len(ASKED.t)))
    for name in ("t", "pose", "twist", "acceleration", "light", "jump", "clock"):
        np.testing.assert_array_equal(getattr(again, name), getattr(ASKED, name))
    np.testing.assert_array_equal(again.source.line, ASKED.source.line)


def test_the_path_is_the_same_and_the_clock_lags():
    motion = slowed(wavy())
    assert motion.t[-1] > ASKED.t[-1] + 1
    assert motion.clock[-1] == pytest.approx(ASKED.clock[-1])
    assert (np.diff(motion.clock) > 0).all()
    assert (np.diff(motion.clock) < PERIOD * (1 + 1e-9)).all()
    inside = motion.clock < 2.1  # before the jump
    near, fine = asked_at(motion.clock[inside])
    apart = np.linalg.norm(dq.translation(near) - motion.points[inside], axis=1)
    speed = np.linalg.norm(np.diff(fine.points[:33600], axis=0), axis=1).max() / 6.25e-5
    assert apart.max() < speed * 3.2e-5  # half a fine sample


def test_twist_and_acceleration_are_the_derivatives_in_real_time():
    """Central differences inside each stroke, of second order."""
    motion = slowed(wavy())
    for stroke in range(3):
        rows = np.flatnonzero(motion.stroke == stroke)[2:-2]
        x, xi = motion.pose, motion.twist
        rate = dq.log(dq.mul(dq.nearest(x[rows + 1], x[rows - 1]), dq.conj(x[rows - 1]))) / PERIOD
        # the profile of `in` strokes has acceleration corners: where it is smooth, to order 2
        np.testing.assert_allclose(rate, xi[rows], atol=2e-2 * np.abs(xi).max())
        slope = (xi[rows + 1] - xi[rows - 1]) / (2 * PERIOD)
        apart = np.abs(slope - motion.acceleration[rows]).max(axis=1)
        size = np.abs(motion.acceleration[rows]).max()
        assert np.median(apart) < 0.01 * size
    quintic = np.flatnonzero(motion.stroke == 0)[2:-2]
    slope = (motion.twist[quintic + 1] - motion.twist[quintic - 1]) / (2 * PERIOD)
    np.testing.assert_allclose(
        slope, motion.acceleration[quintic], atol=0.01 * np.abs(motion.acceleration[quintic]).max()
    )


def test_every_corner_is_a_sample_and_jumps_jump_once():
    motion = slowed(wavy())
    for stroke in range(ASKED.stroke.max() + 1):
        before = np.flatnonzero(ASKED.stroke == stroke)[0]
        after = np.flatnonzero(motion.stroke == stroke)[0]
        np.testing.assert_allclose(motion.pose[after], ASKED.pose[before], atol=1e-12)
        assert motion.clock[after] == pytest.approx(ASKED.clock[before])
    assert motion.jump.sum() == ASKED.jump.sum() == 1


def test_the_light_stays_tied_to_the_path():
    """The colour at each place of the gradient is the one that was asked for there."""
    motion = slowed(wavy())
    rows = np.flatnonzero(motion.stroke == 0)
    asked = np.flatnonzero(ASKED.stroke == 0)
    for channel in range(3):
        wanted = np.interp(
            motion.clock[rows], ASKED.clock[asked] + PERIOD / 2, ASKED.light[asked, channel]
        )
        np.testing.assert_allclose(motion.light[rows, channel], wanted, atol=0.02)
    assert not motion.light[-1].any()


def test_a_smooth_slowness_is_enough_everywhere_and_smooth(rng):
    needed = np.ones(1000)
    needed[300:310] = 5.0
    needed[600] = 3.0
    needed[-1] = 2.0
    slow = smooth(needed, PERIOD)
    assert (slow >= needed - 1e-12).all()
    reach = round(AHEAD / PERIOD)
    assert (slow[: 300 - 2 * reach - 2] == 1).all()
    assert slow[300 - reach] > 1  # it begins before
    assert np.abs(np.diff(slow)).max() < 4 * 4.0 / (2 * reach)
    assert np.abs(np.diff(slow, n=2)).max() < 40.0 / reach**2
    rough = 1 + rng.exponential(size=500)
    assert (smooth(rough, PERIOD) >= rough - 1e-12).all()


@pytest.mark.parametrize("count", [1, 2, 3, 100])
@pytest.mark.parametrize("slow", [1.0, 1.001, 1.5, 7.3])
def test_a_stroke_takes_whole_periods(count, slow):
    ticks = TimeScaling(np.full(count + 5, slow), PERIOD).ticks(2, count)
    assert ticks.count >= count * slow - 1e-6
    assert ticks.count < count * slow + 1
    assert (ticks.tau[0], ticks.tau[-1]) == (0, 1)
    assert (np.diff(ticks.tau) > 0).all()
    if slow > 1:
        mean = count / ticks.count
        assert ticks.rate.mean() == pytest.approx(mean, rel=0.5)
        assert (ticks.rate <= 1 / slow + 1e-12).all()


def test_a_jump_is_never_slowed():
    motion = slowed(np.full(len(ASKED.t), 4.0))
    assert motion.jump.sum() == 1
    assert (motion.stroke == 3).sum() == (ASKED.stroke == 3).sum() == 1


@pytest.mark.parametrize("first", [1.0, 1.7])
def test_the_pace_at_both_ends_of_a_stroke_is_the_one_asked_for(first):
    """What makes its end a sample is spread over its middle, and nothing of it over the ends."""
    slowness = first + 1.3 * np.sin(np.linspace(0.0, 2.0, 41)) ** 2
    ticks = TimeScaling(slowness, PERIOD).ticks(0, 40)
    assert ticks.rate[[0, -1]] == pytest.approx(1 / slowness[[0, -1]], rel=1e-12)
    tau = ticks.tau
    assert tau[0] == 0.0
    assert tau[-1] == 1.0
    slope = np.gradient(tau, 1.0 / 40)
    assert slope[1:-1] == pytest.approx(ticks.rate[1:-1], rel=2e-3)
