"""Where an arm begins, and what is said of poses it cannot reach."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.kinematics.start_posture import NoPosture, StartPosture, find_start, waypoints
from dqpaint.robots.model.card import read_card

KEEP = np.array([1.0, 0, 0, 0])


@pytest.fixture(scope="module")
def arm():
    return Kinematics(read_card("iiwa"))


def on_canvas(arm, points):
    points = np.asarray(points, float)
    return dq.mul(arm.card.canvas.pose, dq.pose_from(points, np.tile(KEEP, (len(points), 1))))


def test_the_start_solves_the_first_pose_inside_the_limits(arm):
    poses = on_canvas(arm, [[0.05, -0.04, 0.02], [0.1, 0.1, 0], [-0.1, 0, 0.05]])
    found = find_start(arm, poses, np.arange(3.0))
    assert isinstance(found, StartPosture)
    reached = dq.matrix_from_pose(arm.pose(found.posture))
    np.testing.assert_allclose(reached, dq.matrix_from_pose(poses[0]), atol=1e-8)
    assert ((arm.card.lower < found.posture) & (found.posture < arm.card.upper)).all()


def test_the_whole_path_decides_not_the_first_pose(arm):
    """A path that turns the tool by 200 degrees needs room in the last joint that home lacks."""
    turns = np.radians(np.linspace(0, -200, 21))
    local = np.stack([np.cos(turns / 2), 0 * turns, 0 * turns, np.sin(turns / 2)], axis=1)
    poses = dq.mul(arm.card.canvas.pose, dq.pose_from(np.zeros((21, 3)), local))
    found = find_start(arm, poses, np.linspace(0, 20, 21))
    assert isinstance(found, StartPosture)
    assert found.margin > 0
    # home's last joint is at +90 degrees; -200 from there is fine, +200 is not: try the other way
    other = dq.mul(arm.card.canvas.pose, dq.pose_from(np.zeros((21, 3)), local * [1, 1, 1, -1]))
    opposite = find_start(arm, other, np.linspace(0, 20, 21))
    assert isinstance(opposite, StartPosture)
    assert opposite.margin > 0
    assert opposite.posture[6] < np.radians(175 - 190)


def test_a_pose_far_out_is_missed_by_about_its_distance(arm):
    far = find_start(arm, on_canvas(arm, [[0, 0, 0], [0, 0, 0.15], [0, 0, 0.9]]), np.arange(3.0))
    assert isinstance(far, NoPosture)
    assert far.index == 2
    # the shoulder is at z = 0.36, the stretched arm with its lamp ends 0.82 + 0.161 m from there
    nearest = np.hypot(0.7 + 0.9 - 0.161, 0.14) - 0.82
    assert far.shortfall == pytest.approx(nearest, rel=0.01)


def test_the_same_question_has_the_same_answer(arm):
    poses = on_canvas(arm, [[0.05, -0.04, 0.02], [0.1, 0.1, 0]])
    first, second = (find_start(arm, poses, np.arange(2.0)) for _ in range(2))
    np.testing.assert_array_equal(first.posture, second.posture)


def test_waypoints_hold_ends_and_corners():
    rows = waypoints(np.repeat([0, 1, 2], [500, 3, 400]))
    assert rows[0] == 0
    assert rows[-1] == 902
    assert {500, 503} <= set(rows.tolist())
    assert len(waypoints(np.arange(5000))) <= 90
    assert waypoints(np.array([0])).tolist() == [0]


@pytest.mark.slow
def test_every_pose_of_a_posture_inside_the_limits_is_found(arm, rng):
    """Uniform over all postures, those close to limits and singularities among them."""
    for q in rng.uniform(arm.card.lower, arm.card.upper, (150, 7)):
        found = find_start(arm, arm.pose(q)[None], np.zeros(1))
        assert isinstance(found, StartPosture)
        assert found.margin >= 0
        there = dq.matrix_from_pose(arm.pose(found.posture))
        np.testing.assert_allclose(there, dq.matrix_from_pose(arm.pose(q)), atol=3e-5)
