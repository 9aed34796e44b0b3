"""Where a loop in steps is stable is known: the error of rate k is 1 - k T times the one before."""

from dataclasses import replace

import numpy as np
import pytest

import dqpaint
from dqpaint.metrics.stability import LEAST_ROWS, instability
from dqpaint.robots.kinematics.limits import Clamp

PERIOD = 0.01
LINES = f"""period {PERIOD * 1e3:g} ms
speed 60 mm/s
start at (0, 0) mm
line to (60, 20) mm
line to (0, 40) mm
"""


@pytest.fixture
def lines(tmp_path):
    (tmp_path / "lines.traj").write_text(LINES)
    return tmp_path / "lines.traj"


def track(drawing, k, **how):
    how = {"plant": "ideal", "controller": "p", "size": (16, 16), **how}
    return dqpaint.draw(drawing, gains={"k": k}, **how).track


@pytest.mark.parametrize("product", [0.05, 0.9, 1.5, 1.9, 1.98])
@pytest.mark.parametrize("law", ["p", "pff"])
def test_loops_that_converge_are_stable(lines, law, product):
    assert instability(track(lines, product / PERIOD, controller=law)) is None


@pytest.mark.parametrize("product", [2.02, 2.1, 2.5, 4.0])
@pytest.mark.parametrize("law", ["p", "pff"])
def test_loops_that_do_not_are_not(lines, law, product):
    assert "alternate" in instability(track(lines, product / PERIOD, controller=law))


def late_bound(periods):
    """The largest k T of x' = -k x heard so many periods late: roots of z^(d+1) - z^d + k T."""
    return 2 * np.sin(np.pi / (2 * (2 * periods + 1)))


@pytest.mark.parametrize("periods", [1, 2, 4, 8])
def test_a_loop_that_hears_late_is_stable_below_its_bound_and_not_above(lines, periods):
    late = {"latency": {"periods": periods}}
    k = late_bound(periods) / PERIOD
    assert instability(track(lines, 0.85 * k, disturb=late)) is None
    for factor in (1.3, 2.0):
        assert "between the arm's limits" in instability(track(lines, factor * k, disturb=late))


def test_a_swing_that_is_asked_for_is_none(lines):
    one = track(lines, 20.0)
    swing = np.where(np.arange(len(one.command)) // 5 % 2, 1.0, -1.0)
    held = (Clamp("speed", 1, 0.0, 0.5 * float(one.motion.t[-1]), 1, 1.0, 2.0),)
    own = replace(one, command=swing[:, None] * np.ones(7), clamps=held)
    assert "swing" in instability(own)
    asked = replace(one.motion, twist=swing[:, None] * np.ones(6))
    assert instability(replace(own, motion=asked)) is None
    assert instability(replace(own, clamps=())) is None


def test_noise_is_no_instability(lines):
    noise = {"twist": {"form": "noise", "x": 0.05, "y": 0.05, "wz": 0.2, "frequency": 50.0}}
    assert instability(track(lines, 50.0, disturb=noise)) is None


def test_noise_between_limits_is_none_and_a_swing_between_them_is(lines, rng):
    one = track(lines, 20.0)
    rows = len(one.command)
    held = (Clamp("speed", 1, 0.0, 0.5 * float(one.motion.t[-1]), 1, 1.0, 2.0),)
    white = replace(one, command=rng.choice([-1.0, 1.0], (rows, 7)), clamps=held)
    assert instability(white) is None
    swing = np.where(np.arange(rows) % 2, 1.0, -1.0)[:, None] * np.ones(7)
    assert "limits" in instability(replace(one, command=swing, clamps=held))
    assert instability(replace(one, command=swing)) is None  # it does not grow


def test_a_far_start_is_none_and_an_arm_that_turns_away_is_one(lines, tmp_path):
    assert instability(track(lines, 10.0, start="home")) is None
    (tmp_path / "away.py").write_text(
        "import numpy as np\ndef away(seen, k=1.0):\n    return np.array([0, 0, 0, 0, 0.1, 0.0])\n"
    )
    own = dqpaint.draw(
        lines, controller=str(tmp_path / "away.py"), plant="ideal", size=(16, 16)
    ).track
    assert "farther off" in instability(own)


def test_a_short_run_is_not_judged(tmp_path):
    (tmp_path / "dot.traj").write_text("period 10 ms\nhold 50 ms\n")
    run = track(tmp_path / "dot.traj", 250.0)
    assert len(run.command) < LEAST_ROWS
    assert instability(run) is None
    assert np.isfinite(run.command).all()
