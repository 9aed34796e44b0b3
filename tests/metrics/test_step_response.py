"""Settling time, overshoot and steady error against responses whose figures are known."""

from dataclasses import replace

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.core.examples import find_drawing
from dqpaint.language import parse, read
from dqpaint.metrics import measure
from dqpaint.metrics.step_response import (
    SETTLING_BAND,
    _rotation_vectors,
    step_curves,
    step_responses,
)
from dqpaint.motion import plan
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.simulation.closed_loop import track

CARD = read_card("iiwa")
ARM = Kinematics(CARD)
TEXT = """period 1 ms
start at (10, 5, 0) mm tool rpy(10 deg, 0, 0)
hold 0.5 s light off
step to (50, 50, -20) mm tool rpy(0, 20 deg, 30 deg)
hold 2 s
step to (0, 0, 0) mm tool rpy(0, 20 deg, 30 deg)
hold 1 s
"""


@pytest.fixture(scope="module")
def run():
    motion = plan(parse(TEXT, "test.traj"), CARD.canvas.pose)
    law = CONTROLLERS["p"]
    return track(motion, ARM, CARD.home, PLANTS["ideal"], law, law.read_gains({}))


def answered(run, shape):
    """The run, but for poses that go from set point to set point by a part `shape` of the time."""
    motion = run.motion
    pose = motion.pose.copy()
    for before in np.flatnonzero(motion.jump):
        old, new = motion.pose[before], motion.pose[before + 1]
        way = dq.translation(new) - dq.translation(old)
        turn = 2 * dq.log(dq.mul(new, dq.conj(old)))[:3]
        for k in range(before + 1, len(pose)):
            done = shape(motion.t[k] - motion.t[before + 1])
            r = dq.exp(0.5 * done * np.r_[turn, 0, 0, 0])[:4]
            place = dq.translation(old) + done * way
            pose[k] = dq.pose_from(place, dq.quaternion_mul(r, old[:4]))
    return replace(run, pose=dq.continuous(pose))


def test_an_exponential_settles_after_ln_50_over_its_rate(run):
    first, second = step_responses(answered(run, lambda t: 1 - np.exp(-5.0 * t)))
    assert (first.line.line, second.line.line) == (4, 6)
    assert first.time == pytest.approx(0.501)
    for part, size in (
        (first.translation, np.linalg.norm([0.04, 0.045, -0.02])),
        (first.rotation, 2 * np.arccos(abs(_dot(run, 0.4, 0.6)))),
    ):
        assert part.size == pytest.approx(size, rel=1e-6)
        assert part.settling == pytest.approx(np.log(1 / SETTLING_BAND) / 5.0, abs=2e-3)
        assert part.overshoot == pytest.approx(0.0, abs=1e-6)
        # mean of exp(-5 t) over the last tenth of 1.999 s
        t = np.linspace(0.9, 1.0, 2001) * 1.999
        assert part.steady == pytest.approx(size * np.exp(-5 * t).mean(), rel=0.01)


def _dot(run, before, after):
    a, b = (run.motion.pose[int(t / 0.001), :4] for t in (before, after))
    return a @ b


def test_a_damped_oscillation_overshoots_by_its_closed_form(run):
    zeta, w = 0.4, 12.0
    wd = w * np.sqrt(1 - zeta**2)

    def answer(t):
        return 1 - np.exp(-zeta * w * t) * (
            np.cos(wd * t) + zeta / np.sqrt(1 - zeta**2) * np.sin(wd * t)
        )

    first, _ = step_responses(answered(run, answer))
    beyond = np.exp(-np.pi * zeta / np.sqrt(1 - zeta**2))
    for part in (first.translation, first.rotation):
        assert part.overshoot == pytest.approx(beyond, rel=1e-3)
        t = np.arange(0, 2, 1e-4)
        last = t[np.flatnonzero(np.abs(answer(t) - 1) > SETTLING_BAND)[-1]]
        assert part.settling == pytest.approx(last, abs=3e-3)


def test_a_response_that_stays_away_never_settles(run):
    first, _ = step_responses(answered(run, lambda t: 0.9))
    assert first.translation.settling is None
    assert first.translation.steady == pytest.approx(0.1 * first.translation.size, rel=1e-9)
    assert first.rotation.steady == pytest.approx(0.1 * first.rotation.size, rel=1e-6)


def test_what_was_not_asked_to_move_has_no_settling(run):
    _, second = step_responses(answered(run, lambda t: 1 - np.exp(-5 * t)))
    assert second.rotation.size == 0
    assert second.rotation.settling is None
    assert second.translation.settling == pytest.approx(np.log(50) / 5, abs=2e-3)


def test_a_law_settles_at_its_own_rate(run):
    """`p` decays at k in both, small errors exactly so; slow enough for the joints' limits."""
    law = CONTROLLERS["p"]
    slow = track(run.motion, ARM, CARD.home, PLANTS["ideal"], law, law.read_gains({"k": 2.5}))
    first, _ = step_responses(slow)
    for part in (first.translation, first.rotation):
        assert part.settling == pytest.approx(np.log(50) / 2.5, rel=0.1)
        assert part.steady < 0.02 * part.size
        assert part.overshoot < 1e-3


def test_drawings_without_a_jump_have_none_and_the_example_has_one():
    motion = plan(parse("line to (10, 0) mm\n", "test.traj"), CARD.canvas.pose)
    law = CONTROLLERS["p"]
    none = track(motion, ARM, CARD.home, PLANTS["ideal"], law, law.read_gains({}))
    assert step_responses(none) == ()
    assert plan(read(find_drawing("step")), CARD.canvas.pose).jump.sum() == 1


def test_a_turn_is_seen_along_the_base_s_axes_from_any_orientation(run):
    """Beyond the goal along the same turn overshoots; across it does not. By pinocchio's log."""
    import pinocchio

    first, _ = step_responses(answered(run, lambda t: 1.2 if t > 0.5 else 1.0 - np.exp(-9.0 * t)))
    assert first.rotation.overshoot == pytest.approx(0.2, rel=1e-6)
    before = int(np.flatnonzero(run.motion.jump)[0])
    old, new = (dq.matrix_from_pose(run.motion.pose[i])[:3, :3] for i in (before, before + 1))
    wanted = pinocchio.log3(new @ old.T)
    found = _rotation_vectors(run.motion.pose[before + 1], run.motion.pose[before])
    np.testing.assert_allclose(found, wanted, atol=1e-9)
    assert np.abs(wanted - pinocchio.log3(old.T @ new)).max() > 1e-2


def test_curves_and_figures_of_steps_are_those_of_the_responses(run):
    def shape(t):
        return 1 - 1.2 * np.exp(-5.0 * t) * np.cos(12 * t)

    answer = answered(run, shape)
    for curve, jump in zip(step_curves(answer), step_responses(answer), strict=True):
        np.testing.assert_allclose(curve.moved, shape(curve.t)[:, None] * curve.step, atol=1e-9)
        assert np.linalg.norm(curve.step) == pytest.approx(jump.translation.size)
        assert curve.turn == pytest.approx(jump.rotation.size, abs=1e-9)
        if curve.turn:
            np.testing.assert_allclose(curve.turned, shape(curve.t) * curve.turn, atol=1e-9)
    figures, jumps = measure(answer).figures, step_responses(answer)
    first, second = (jump.translation for jump in jumps)
    assert figures["step_position_settling_s"] == max(first.settling, second.settling)
    assert figures["step_position_overshoot"] == max(first.overshoot, second.overshoot) > 0
    assert figures["step_position_steady_m"] == max(first.steady, second.steady)
    assert figures["step_orientation_settling_s"] == jumps[0].rotation.settling  # one turns
    never = measure(answered(run, lambda t: 0.5)).figures
    assert "step_position_settling_s" not in never
    assert never["step_position_steady_m"] > 0.01


def test_a_drawing_without_steps_has_no_such_figures():
    law = CONTROLLERS["pff"]
    motion = plan(parse("period 10 ms\nline to (10, 0) mm\n", "test.traj"), CARD.canvas.pose)
    line = track(motion, ARM, CARD.home, PLANTS["ideal"], law, law.read_gains({}))
    assert not any(name.startswith("step_") for name in measure(line).figures)


@pytest.mark.parametrize("text", ["line to (10, 0) mm\n", "", "hold 0.1 s\nstep to (0, 9) mm\n"])
def test_a_last_step_has_no_time_to_be_answered(text):
    motion = plan(parse(f"{text}step to (10, 10) mm\n", "end.traj"), CARD.canvas.pose)
    law = CONTROLLERS["p"]
    run = track(motion, ARM, CARD.home, PLANTS["ideal"], law, law.read_gains({}))
    assert step_responses(run) == ()
    numbers = [value for value in measure(run).figures.values() if isinstance(value, float)]
    assert len(numbers) > 5
    assert np.isfinite(numbers).all()
