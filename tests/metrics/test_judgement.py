"""Where a loop in steps is stable is known: the error of rate k is 1 - k T times the one before.

And what a run is not a result for: oscillation, commands at limits, a path too long, an arm astray.
"""

import re
from dataclasses import replace

import numpy as np
import pytest

import dqpaint
from dqpaint import dq
from dqpaint.diagnostics import SourceLine
from dqpaint.metrics import judge
from dqpaint.metrics.judgement import LEAST_ROWS
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
    assert judge(track(lines, product / PERIOD, controller=law)).is_result


@pytest.mark.parametrize("product", [2.02, 2.1, 2.5, 4.0])
@pytest.mark.parametrize("law", ["p", "pff"])
def test_loops_that_do_not_are_not(lines, law, product):
    assert "alternate" in judge(track(lines, product / PERIOD, controller=law)).why


def late_bound(periods):
    """The largest k T of x' = -k x heard so many periods late: roots of z^(d+1) - z^d + k T."""
    return 2 * np.sin(np.pi / (2 * (2 * periods + 1)))


@pytest.mark.parametrize("periods", [1, 2, 4, 8])
def test_a_loop_that_hears_late_is_stable_below_its_bound_and_not_above(lines, periods):
    late = {"latency": {"periods": periods}}
    k = late_bound(periods) / PERIOD
    assert judge(track(lines, 0.85 * k, disturb=late)).is_result
    for factor in (1.3, 2.0):
        assert "between the arm's limits" in judge(track(lines, factor * k, disturb=late)).why


def test_a_swing_that_is_asked_for_is_none(lines):
    one = track(lines, 20.0)
    swing = np.where(np.arange(len(one.command)) // 5 % 2, 1.0, -1.0)
    held = (Clamp("speed", 1, 0.0, 0.5 * float(one.motion.t[-1]), SourceLine(0, 3), 1.0, 2.0),)
    own = replace(one, command=swing[:, None] * np.ones(7), clamps=held)
    assert "swing" in judge(own).why
    assert "(push)" in judge(own, ("push",)).faults[0].says
    asked = replace(one.motion, twist=swing[:, None] * np.ones(6))
    assert judge(replace(own, motion=asked)).is_result
    assert judge(replace(own, clamps=())).is_result


def test_noise_is_no_instability(lines):
    noise = {"twist": {"form": "noise", "x": 0.05, "y": 0.05, "wz": 0.2, "frequency": 50.0}}
    assert judge(track(lines, 50.0, disturb=noise)).is_result


def test_noise_between_limits_is_none_and_a_swing_between_them_is(lines, rng):
    one = track(lines, 20.0)
    rows = len(one.command)
    held = (Clamp("speed", 1, 0.0, 0.5 * float(one.motion.t[-1]), SourceLine(0, 3), 1.0, 2.0),)
    white = replace(one, command=rng.choice([-1.0, 1.0], (rows, 7)), clamps=held)
    assert judge(white).is_result
    swing = np.where(np.arange(rows) % 2, 1.0, -1.0)[:, None] * np.ones(7)
    assert "limits" in judge(replace(one, command=swing, clamps=held)).why
    assert judge(replace(one, command=swing)).is_result  # it does not grow


def test_a_far_start_is_none_and_an_arm_that_turns_away_is_one(lines, tmp_path):
    assert judge(track(lines, 10.0, start="home")).is_result
    one = track(lines, 10.0)
    assert judge(moved(one, 0.3 * np.exp(-one.motion.t / 0.1)[:, None] * [0, 0, 1.0])).is_result
    (tmp_path / "away.py").write_text(
        "import numpy as np\ndef away(seen, k=1.0):\n    return np.array([0, 0, 0, 0, 0.1, 0.0])\n"
    )
    own = dqpaint.draw(
        lines, controller=str(tmp_path / "away.py"), plant="ideal", size=(16, 16)
    ).track
    assert "farther off" in judge(own).why


def test_a_short_run_is_not_judged(tmp_path):
    (tmp_path / "dot.traj").write_text("period 10 ms\nhold 50 ms\n")
    run = track(tmp_path / "dot.traj", 250.0)
    assert len(run.command) < LEAST_ROWS
    assert judge(run).is_result
    assert np.isfinite(run.command).all()


def moved(one, offset):
    """A run whose tool is elsewhere by an offset (N, 3) [m], sensors and all."""
    ways = np.hstack([np.tile([1.0, 0, 0, 0, 0], (len(offset), 1)), 0.5 * offset])
    return replace(one, pose=dq.mul(ways, one.pose), measured_pose=dq.mul(ways, one.measured_pose))


def sine(one, frequency, amplitude):
    return amplitude * np.sin(2 * np.pi * frequency * one.motion.t)[:, None] * [0, 0, 1.0]


def test_an_oscillation_is_told_with_its_frequency_amplitude_and_line(lines):
    one = track(lines, 20.0)
    found = judge(moved(one, sine(one, 12.0, 0.5e-3)))
    assert found.status == "oscillates"
    (fault,) = found.faults
    frequency, amplitude = re.search(r"at (.*) Hz by (.*) mm", fault.says).groups()
    assert float(frequency) == pytest.approx(12.0, abs=2 / one.motion.seconds)
    assert float(amplitude) == pytest.approx(0.5, rel=0.1)
    assert fault.line == SourceLine(0, 5)  # the second half
    assert "push-2" not in fault.says
    assert "push-2" in judge(moved(one, sine(one, 12.0, 0.5e-3)), ["push-2"]).why
    assert judge(moved(one, sine(one, 12.0, 0.02e-3))).is_result  # a fortieth of the speed
    assert "e+" not in judge(moved(one, sine(one, 12.0, 0.23))).faults[0].says  # 230, not 2.3e+02


def test_an_oscillation_is_looked_for_where_a_step_has_settled(tmp_path):
    """The answer to a step is larger than what goes on after it."""
    (tmp_path / "late.traj").write_text(
        "period 10 ms\nstart at (0, 0) mm\nhold 4 s\nstep to (40, 0) mm\nhold 1.6 s\n"
    )
    one = track(tmp_path / "late.traj", 20.0)
    assert judge(one).is_result
    (fault,) = judge(moved(one, sine(one, 12.0, 0.3e-3))).faults
    assert fault.kind == "oscillates"
    assert fault.line == SourceLine(0, 5)


def test_what_the_reference_a_disturbance_or_sensors_explain_is_no_oscillation(lines):
    one = track(lines, 20.0)
    swing = sine(one, 12.0, 0.5e-3)
    asked = moved(replace(one, pose=one.motion.pose, measured_pose=one.motion.pose), swing).pose
    assert judge(replace(moved(one, swing), motion=replace(one.motion, pose=asked))).is_result
    speed = np.gradient(swing, PERIOD, axis=0)
    push = np.hstack([np.zeros_like(speed), speed])
    assert judge(replace(moved(one, swing), disturbance=push)).is_result
    sensed = replace(moved(one, swing), measured_pose=one.measured_pose)
    assert judge(sensed).is_result


def test_a_path_twice_as_long_is_astray_whatever_its_form(lines, rng):
    one = track(lines, 20.0)
    still = replace(one, pose=one.motion.pose, measured_pose=one.motion.pose)
    step = np.linalg.norm(np.diff(one.motion.points, axis=0), axis=1).mean()
    walk = rng.standard_normal((len(one.command), 3)) * step
    found = judge(moved(still, walk))
    assert found.status == "astray"
    assert found.faults[0].line in (SourceLine(0, 4), SourceLine(0, 5))
    assert judge(moved(still, 0.3 * walk)).is_result
    noisy = replace(moved(still, walk), measured_pose=still.measured_pose)
    assert judge(noisy).is_result  # as much as the sensors are off
    speed = np.vstack([np.diff(walk, axis=0), np.zeros((1, 3))]) / PERIOD
    carried = np.hstack([np.zeros_like(speed), speed])
    assert judge(replace(moved(still, walk), disturbance=carried)).is_result
    constant = np.tile([0, 0, 0, *(3 * step / PERIOD * np.eye(3)[0])], (len(walk), 1))
    found = judge(replace(moved(still, walk), disturbance=constant))
    assert found.status == "astray"  # a constant twist is the law's to reject


def test_the_way_to_the_first_stroke_is_no_part_of_the_path(tmp_path, rng):
    (tmp_path / "late.traj").write_text(
        "period 10 ms\nspeed 60 mm/s\nstart at (0, 0) mm\nmove to (20, 0) mm\nline to (60, 40) mm\n"
    )
    one = track(tmp_path / "late.traj", 20.0)
    still = replace(one, pose=one.motion.pose, measured_pose=one.motion.pose)
    walk = 0.01 * rng.standard_normal((len(one.command), 3))
    first = int(one.motion.lit.argmax())
    before = np.arange(len(walk)) < first - 1
    assert 10 < before.sum() < len(walk) // 2
    assert judge(moved(still, walk * before[:, None])).is_result
    after = np.roll(before, first)
    assert judge(moved(still, walk * after[:, None])).status == "astray"


def test_commands_at_limits_for_a_fifth_of_the_second_half(lines):
    one = track(lines, 20.0)
    rows = len(one.command)
    for share, good in ((0.18, True), (0.22, False)):
        where = np.zeros((rows, 7), bool)
        where[rows - round(share * rows / 2) :, 3] = True
        found = judge(replace(one, clipped={"torque": where}))
        assert found.is_result == good
    assert found.status == "clipped"
    assert "torque limit of joint 4, line 5" in found.why
    early = np.zeros((rows, 7), bool)
    early[: rows // 2] = True
    assert judge(replace(one, clipped={"speed": early})).is_result


@pytest.mark.slow
def test_the_limit_cycles_of_springs_are_found_and_a_gentle_law_is_a_result(tmp_path):
    """A fifth of a spiral: at 12 Hz a loop through springs of 60 rad/s swings from 125 1/s on."""
    text = """period 8 ms
    start at (0, 70) mm
    arc centre (0, 0) axis -z angle 0.6 turn rise 14 mm samples 600 profile constant
    """
    (tmp_path / "fifth.traj").write_text(text)
    on = {
        "robot": "meka-a2", "plant": "compliant", "start": "home",
        "disturb": {"twist": {"z": -0.05}, "noise": {"rms": 2e-5}},
    }  # fmt: skip
    wild = {"q": 129.722, "r": 0.01, "s": 0.0}
    drawing, small = tmp_path / "fifth.traj", {"size": (16, 16), **on}
    found = dqpaint.draw(drawing, controller="lqr", gains=wild, **small).judgement
    assert {fault.kind for fault in found.faults} == {"oscillates", "clipped", "astray"}
    assert 10 < float(re.search(r"at (.*) Hz", found.why)[1]) < 14
    assert dqpaint.draw(drawing, controller="hinf", **small).judgement.is_result
