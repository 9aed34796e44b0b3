"""Tasks of fewer dimensions: what is controlled is reached, what is free is no error."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.errors import UnknownNameError
from dqpaint.language.vocabulary import words
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics import make_kinematics, tool_jacobian_map
from dqpaint.robots.model import TASKS, find_task, read_card
from dqpaint.robots.resolvers import Setup, State, make_resolver
from dqpaint.simulation import track
from tests.support.random_poses import random_poses


def test_the_language_knows_the_same_tasks():
    assert tuple(TASKS) == words.TASKS
    with pytest.raises(UnknownNameError):
        find_task("line")
    assert [task.dimensions for task in TASKS.values()] == [6, 5, 3, 3]


def test_what_is_near_keeps_what_is_controlled(rng):
    reference, pose = random_poses(rng, 50), random_poses(rng, 50)
    z = [0.0, 0.0, 1.0]
    for name in ("beam", "point"):
        near = TASKS[name].near(reference, pose)
        np.testing.assert_allclose(dq.translation(near), dq.translation(reference), atol=1e-12)
    beam = TASKS["beam"].near(reference, pose)
    here, there = (dq.rotate(dq.rotation(x), np.tile(z, (50, 1))) for x in (beam, reference))
    np.testing.assert_allclose(here, there, atol=1e-12)
    for turn in np.linspace(0, 2 * np.pi, 60):  # none of the others is nearer
        about = dq.pose_from(np.zeros(3), [np.cos(turn / 2), 0, 0, np.sin(turn / 2)])
        other = dq.mul(reference, about)
        assert (angle(other, pose) >= angle(beam, pose) - 1e-9).all()
    np.testing.assert_allclose(angle(TASKS["point"].near(reference, pose), pose), 0, atol=1e-7)


def angle(a, b):
    part = np.abs((dq.rotation(a) * dq.rotation(b)).sum(axis=-1))
    return 2 * np.arccos(np.minimum(part, 1.0))


def test_rows_are_those_of_a_turned_tool(rng):
    """By differences: a joint's motion changes the beam's direction by rows 0 and 1 alone."""
    arm, h = make_kinematics(read_card("iiwa")), 1e-6
    q, way = rng.uniform(-1, 1, 7), rng.normal(size=7)
    x, J = arm.pose_and_jacobian(q)
    rows = TASKS["beam"].rows(x) @ tool_jacobian_map(dq.translation(x)) @ J @ way
    ends = [arm.pose(q + side * h * way) for side in (1, -1)]
    z = [dq.matrix_from_quaternion(dq.rotation(end))[:, 2] for end in ends]
    R = dq.matrix_from_quaternion(dq.rotation(x))
    rate = R.T @ (z[0] - z[1]) / (2 * h)  # of the beam in the tool's frame: (w_y, -w_x, 0)
    np.testing.assert_allclose([-rate[1], rate[0]], rows[:2], atol=1e-8)
    p = [dq.translation(end) for end in ends]
    np.testing.assert_allclose((p[0] - p[1]) / (2 * h) / 0.3, rows[2:], atol=1e-8)


def test_what_comes_first_is_met_and_what_comes_second_is_least_squares_beside_it(rng):
    """With two joints held, six numbers ask too much: the point is met, the turn nearly so."""
    arm = make_kinematics(read_card("iiwa"))
    q = rng.uniform(-1.2, 1.2, 7)
    x, J = arm.pose_and_jacobian(q)
    J = J[:, [0, 1, 3, 4, 5]]
    one = make_resolver("none", Setup(arm, 0.008, TASKS["place-first"]))
    first, second = rng.normal(size=(2, 6))
    rates = one.rates(State(x, J, q), [first, second], None)
    shift = tool_jacobian_map(dq.translation(x))
    Jt, u1, u2 = shift @ J, shift @ first, shift @ second
    np.testing.assert_allclose(Jt[3:] @ rates, u1[3:], atol=1e-9)
    free = np.linalg.svd(Jt[3:])[2][3:].T  # of all rates that meet the first part ...
    start = np.linalg.pinv(Jt[3:]) @ u1[3:]
    best = start + free @ np.linalg.lstsq(Jt[:3] @ free, u2[:3] - Jt[:3] @ start)[0]
    np.testing.assert_allclose(rates, best, atol=1e-8)


@pytest.mark.parametrize("law", ["hinf", "p", "log", "lqr", "decoupled", "pham"])
@pytest.mark.parametrize("task", ["beam", "point"])
def test_laws_reach_what_a_task_controls_from_a_large_turn(law, task, set_point):
    """The point comes home though the tool stays turned; about the origin it would be off."""
    arm = make_kinematics(read_card("iiwa"), task=TASKS[task])
    motion, start = set_point
    chosen = CONTROLLERS[law]
    run = track(motion, arm, start, PLANTS["ideal"], chosen, chosen.read_gains({}), null="none")
    assert np.linalg.norm(run.points[-1] - motion.points[-1]) < 1e-6
    z = [dq.matrix_from_quaternion(dq.rotation(x))[:, 2] for x in (run.pose[-1], motion.pose[-1])]
    off = np.arccos(min(1.0, float(z[0] @ z[1])))
    assert off < 1e-4 if task == "beam" else off > 0.05


@pytest.fixture
def set_point():
    from dqpaint.language import parse
    from dqpaint.motion import plan

    arm = make_kinematics(read_card("iiwa"))
    motion = plan(parse("period 8 ms\nhold 2 s"), arm.card.canvas.pose)
    start = arm.card.home + np.array([0.1, 0.1, -0.2, 0.15, 0.3, -0.2, 0.7])
    return motion, start


@pytest.mark.slow
def test_an_arm_of_five_joints_paints_what_needs_no_whole_pose():
    """Asked for a pose from the same posture it is centimetres off: it lacks a joint."""
    from pathlib import Path

    import dqpaint

    robot = str(Path(__file__).parents[1] / "support/five_joints.toml")
    law = CONTROLLERS["hinf"]
    for task in ("beam", "point"):
        done = dqpaint.draw(
            "star", robot=robot, task=task, place="auto", plant="ideal", size=(32, 18)
        )
        assert done.metrics.figures["position_error_max_m"] < 1e-4
    arm = make_kinematics(done.law_model.card)
    whole = track(done.motion, arm, done.track.posture[0], PLANTS["ideal"], law, law.read_gains({}))
    assert np.linalg.norm(whole.points - whole.motion.points, axis=1).max() > 0.01
