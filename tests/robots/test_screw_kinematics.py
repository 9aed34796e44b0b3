"""A run by products of exponentials: the same as the default, by its own computation."""

import numpy as np
import pytest

import dqpaint
from dqpaint import dq
from dqpaint.robots.kinematics import Kinematics, ScrewKinematics
from dqpaint.robots.model.card import installed_names, read_card
from dqpaint.robots.model.screws import Screws

SAME = 1e-9
SCREW = (
    "period 5 ms\nstart at (20, 0) mm\nscrew about (0, 0, -30) mm along (0, 1, 1) angle 60 deg "
    "pitch 20 mm/turn in 1 s\nstep to (0, 10, 20) mm tool rpy(20 deg, 0, 0)\nhold 0.5 s\n"
)


@pytest.mark.parametrize("robot", installed_names())
def test_poses_and_jacobians_are_pinocchio_s(robot, rng):
    card = read_card(robot)
    one, other = Kinematics(card), ScrewKinematics(card)
    longer = rng.normal(size=one.lengths.shape) * 0.01
    for a, b in ((one, other), (one.with_model_error(longer), other.with_model_error(longer))):
        for q in rng.uniform(card.lower, card.upper, (10, card.joints)):
            (x, J), (y, K) = a.pose_and_jacobian(q), b.pose_and_jacobian(q)
            np.testing.assert_allclose(dq.nearest(y, x), x, atol=1e-12)
            np.testing.assert_allclose(K, J, atol=1e-12)
            np.testing.assert_array_equal(b.pose(q), y)


@pytest.fixture
def drawing(tmp_path):
    path = tmp_path / "screw.traj"
    path.write_text(SCREW)
    return path


@pytest.mark.parametrize("options", [
    {"controller": "hinf", "plant": "ideal"},
    {"controller": "p", "plant": "ideal", "disturb": {"links": {"part": 0.02}}},
    pytest.param({"controller": "accel"}, marks=pytest.mark.slow),
])  # fmt: skip
def test_a_run_by_screws_is_the_same_run(options, drawing):
    plain = dqpaint.draw(drawing, size=(64, 36), **options).track
    by_screws = dqpaint.draw(drawing, size=(64, 36), kinematics="screws", **options).track
    for column in ("posture", "pose", "command", "measured_pose"):
        ours, theirs = getattr(by_screws, column), getattr(plain, column)
        scale = max(1.0, np.abs(theirs).max())
        np.testing.assert_allclose(ours, theirs, atol=SAME * scale, err_msg=column)


def test_it_is_computed_by_screws(monkeypatch, drawing):
    calls, own = [], Screws.pose_and_jacobian

    def counted(chain, posture):
        calls.append(posture)
        return own(chain, posture)

    monkeypatch.setattr(Screws, "pose_and_jacobian", counted)
    run = dqpaint.draw(drawing, size=(64, 36), plant="ideal", kinematics="screws")
    assert len(calls) >= len(run.motion.t)
