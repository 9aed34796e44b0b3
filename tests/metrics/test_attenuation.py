"""The H-infinity promise: what comes through against closed forms, and where it breaks."""

from dataclasses import replace

import numpy as np
import pytest

import dqpaint
from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.disturbances import make_disturbances
from dqpaint.language import parse
from dqpaint.metrics.attenuation import attenuation
from dqpaint.motion import plan
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.kinematics.start_posture import find_start, waypoints
from dqpaint.robots.model.card import read_card
from dqpaint.simulation.closed_loop import track

CARD = read_card("iiwa")
ARM = Kinematics(CARD)
PERIOD = 0.008
STILL = "period 8 ms\nstart at (20, 10, 5) mm tool rpy(10 deg, 5 deg, 0)\nhold 16 s\n"
MOVING = (
    "period 8 ms\nstart at (60, 0) mm\narc centre (0, 0) angle 2 turn in 8 s profile constant\n"
)


def came_through(values, text=STILL, law="hinf", seed=0, free=False, **gains):
    motion = plan(parse(text, "test.traj"), CARD.canvas.pose)
    rows = waypoints(motion.stroke)
    start = find_start(ARM, motion.pose[rows], motion.t[rows]).posture
    controller = CONTROLLERS[law]
    schedule = controller.read_gains(gains)
    run = track(
        motion, ARM, start, PLANTS["ideal"], controller, schedule,
        disturbances=make_disturbances({"twist": values}), seed=seed,
    )  # fmt: skip
    assert not (free and run.clamps)
    return attenuation(run, schedule.disturbance_bounds())


def discrete(K, hertz):
    """|H| of e(k+1) = (1 - K T) e(k) + T v(k) at a frequency [s]."""
    z = np.exp(2j * np.pi * hertz * PERIOD)
    return PERIOD / abs(z - (1 - K * PERIOD))


@pytest.mark.parametrize("hertz", [0.5, 2.0, 8.0, 30.0])
@pytest.mark.parametrize("gamma", [0.0707, 0.02])
def test_a_small_translation_comes_through_as_the_linear_loop_says(hertz, gamma):
    K = np.sqrt(2) / gamma
    found = came_through({"": "sine", "y": 1e-3, "frequency": hertz}, gamma_T=gamma)
    assert set(found) == {"translation"}
    assert found["translation"].ratio == pytest.approx(discrete(K, hertz), rel=0.02)
    assert found["translation"].bound == pytest.approx(1 / K)
    assert found["translation"].bound_holds


@pytest.mark.parametrize("hertz", [0.5, 4.0])
def test_a_small_rotation_comes_through_at_half_the_rate(hertz):
    """Near zero |1 - r_e| is half the angle, which decays at K_O / 2."""
    found = came_through({"": "sine", "wx": 1e-3, "frequency": hertz})["rotation"]
    assert found.ratio == pytest.approx(discrete(20.0, hertz) / 2, rel=0.02)
    assert found.bound == pytest.approx(np.sqrt(2) / 40)


@pytest.mark.slow
def test_the_bound_is_all_but_reached_at_zero_frequency():
    """0.997 of it in translation, at most 0.71 in rotation while errors are small."""
    long = STILL.replace("16 s", "40 s")
    shift = came_through({"x": 1e-3}, text=long)["translation"]
    assert 0.99 < shift.ratio / shift.bound <= 1.0
    turn = came_through({"wy": 1e-3}, text=long)["rotation"]
    assert 0.70 < turn.ratio / turn.bound < 0.71


@pytest.mark.parametrize(("law", "text"), [("hinf", STILL), ("hinf", MOVING), ("hinf-set", STILL)])
def test_the_promise_holds_for_noise_while_no_limit_holds_a_joint(law, text):
    values = {"": "noise", "x": 0.05, "z": 0.05, "wy": 0.25, "wz": 0.15, "frequency": 3.0}
    for seed in range(3):
        for one in came_through(values, text, law, seed, free=True).values():
            assert one.bound_holds


@pytest.mark.parametrize(("K", "times"), [(164.0, 1.9), (100.0, None), (124.0, None)])
def test_beyond_one_period_s_gain_the_promise_breaks(K, times):
    """At half the sampling rate |H| = T / |2 - K T|: above 1 / K once K T > 1."""
    nyquist = 0.5 / PERIOD
    found = came_through(
        {"": "sine", "y": 1e-4, "frequency": nyquist - 0.05}, gamma_T=np.sqrt(2) / K
    )["translation"]
    assert found.ratio == pytest.approx(discrete(K, nyquist - 0.05), rel=0.03)
    assert found.bound_holds == (times is None)
    if times:
        assert found.ratio / found.bound == pytest.approx(times, abs=0.1)


def test_laws_that_promise_nothing_report_the_ratio_alone():
    found = came_through({"x": 1e-3}, law="p")["translation"]
    assert found.bound is None
    assert found.bound_holds is None
    assert found.ratio == pytest.approx(1 / 20, rel=0.02)


def test_the_promise_of_gains_that_change_is_the_weakest_on_the_way():
    schedule = CONTROLLERS["hinf"].read_gains({"gamma_T": "0.1..0.2@50%..0.05@60%"})
    assert schedule.disturbance_bounds()[1] == pytest.approx(0.2 / np.sqrt(2))


def test_without_a_disturbance_there_is_nothing_to_report():
    motion = plan(parse("hold 80 ms\n", "t.traj"), CARD.canvas.pose)
    law = CONTROLLERS["hinf"]
    run = track(motion, ARM, CARD.home, PLANTS["ideal"], law, law.read_gains({}))
    assert attenuation(run, (1.0, 1.0)) == {}


@pytest.mark.parametrize("size", [1.0, 1e-170, 1e170])
def test_ratios_are_found_whatever_the_size(size):
    """A large error far from the origin, one row after its cause, by homogeneous matrices."""
    motion = plan(parse(STILL.replace("16 s", "80 ms"), "t.traj"), CARD.canvas.pose)
    law = CONTROLLERS["hinf"]
    run = track(motion, ARM, CARD.home, PLANTS["ideal"], law, law.read_gains({}))
    rng = np.random.default_rng(2)
    turn = np.c_[rng.normal(size=(len(motion.t), 3)), np.zeros((len(motion.t), 3))]
    far = dq.pose_from(rng.normal(size=(len(motion.t), 3)) * 9, dq.exp(0.5 * turn)[..., :4])
    v = np.zeros((len(motion.t), 6))
    v[:-1] = size * rng.normal(size=(len(motion.t) - 1, 6))
    found = attenuation(replace(run, pose=dq.mul(far, motion.pose), disturbance=v), None)
    x, x_d = (dq.matrix_from_pose(p)[1:] for p in (dq.mul(far, motion.pose), motion.pose))
    error = (x @ np.linalg.inv(x_d))[:, :3, 3]
    cause = np.linalg.norm(v[:, 3:] / size) * size
    assert found["translation"].ratio == pytest.approx(np.linalg.norm(error) / cause, rel=1e-9)


def test_springs_void_the_bound(tmp_path):
    (tmp_path / "line.traj").write_text("period 10 ms\nline to (20, 10) mm in 1 s\n")
    how = {"disturb": {"twist": {"x": 0.02}}, "size": (16, 16)}
    for plant, void in (("ideal", False), ("stiff", False), ("compliant", True)):
        found = dqpaint.draw(tmp_path / "line.traj", plant=plant, **how).attenuation["translation"]
        assert found.void == void
        assert (found.bound_holds is None) == void
        assert found.bound is not None
