"""The tool's displacement c(t) and wrong masses, against closed forms."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.controllers.base.controller import Controller
from dqpaint.controllers.laws.pereira.p import RateGains
from dqpaint.disturbances import make_disturbances
from dqpaint.errors import UsageError
from dqpaint.language import parse
from dqpaint.metrics import attenuation
from dqpaint.motion import plan
from dqpaint.planning.reachability import reachable_start_posture
from dqpaint.plants import PLANTS, World
from dqpaint.robots.kinematics import Dynamics
from dqpaint.simulation import track, track_many
from dqpaint.testing.runs import arm, motion, start

STILL = "period 10 ms\nstart at (20, 10, 5) mm tool rpy(10 deg, 5 deg, 0)\nhold 1.5 s\n"
SINE = {"form": "sine", "x": 0.02, "z": -0.01, "wx": 0.2, "wy": 0.1, "frequency": 1.5}


def run(given, law=None, plant="ideal"):
    law = law or CONTROLLERS["hinf"]
    begin = reachable_start_posture(motion(), arm()).posture
    return track(
        motion(), arm(), begin, PLANTS[plant], law, law.read_gains({}),
        disturbances=make_disturbances(given),
    )  # fmt: skip


def displacement(t):
    """c(t) by homogeneous matrices (N, 4, 4)."""
    import pinocchio

    s = np.sin(2 * np.pi * 1.5 * t)
    found = np.tile(np.eye(4), (len(t), 1, 1))
    found[:, :3, :3] = [pinocchio.exp3(v) for v in s[:, None] * np.array([0.2, 0.1, 0.0])]
    found[:, :3, 3] = s[:, None] * np.array([0.02, 0.0, -0.01])
    return found


@pytest.mark.parametrize("measured", ["yes", "no"])
def test_the_tool_is_where_the_joints_and_c_put_it(measured):
    found = run({"offset": {**SINE, "measured": measured}})
    flange = dq.matrix_from_pose(arm().poses(found.posture))
    np.testing.assert_allclose(
        dq.matrix_from_pose(found.pose), flange @ displacement(motion().t), atol=1e-12
    )
    seen = dq.matrix_from_pose(found.measured_pose)
    expected = flange @ displacement(motion().t) if measured == "yes" else flange
    np.testing.assert_allclose(seen, expected, atol=1e-12)


def test_its_twist_is_the_derivative_of_c_seen_from_the_base():
    """x_dot = 1/2 v_c x with the joints held: by differences of 4x4 matrices (3.17)."""
    found = run({"offset": SINE})
    X, h = dq.matrix_from_pose(found.pose), 1e-6
    flange = X @ np.linalg.inv(displacement(motion().t))
    for k in (10, 41, 77):
        middle = motion().t[k : k + 1] + motion().period / 2
        after, before = (flange[k] @ displacement(middle + s)[0] for s in (h, -h))
        rate = (after - before) / (2 * h) @ np.linalg.inv((after + before) / 2)
        twist = [rate[2, 1], rate[0, 2], rate[1, 0], *rate[:3, 3]]
        np.testing.assert_allclose(
            found.pose_disturbance[k], twist, atol=2e-3 * np.abs(twist).max()
        )
    assert not found.pose_disturbance[-1].any()
    assert np.abs(found.pose_disturbance).max() > 1


def test_a_law_that_measures_it_keeps_its_bound_and_one_that_does_not_is_off_by_c():
    law = CONTROLLERS["hinf"]
    still = plan(parse(STILL, "still.traj"), arm().card.canvas.pose)
    begin = reachable_start_posture(still, arm()).posture
    seen = track(
        still, arm(), begin, PLANTS["ideal"], law, law.read_gains({}),
        disturbances=make_disturbances({"offset": {**SINE, "wx": 0.04, "wy": 0.02}}),
    )  # fmt: skip
    assert not seen.clamps
    bounds = law.read_gains({}).disturbance_bounds()
    found = attenuation(seen, bounds)
    assert set(found) == {"rotation", "translation"}
    assert all(0.3 * one.bound < one.ratio < one.bound for one in found.values())
    hidden = run({"offset": {"z": 0.01, "measured": "no"}})
    off = np.linalg.norm(hidden.points - motion().points, axis=1)
    believed = dq.translation(hidden.measured_pose) - motion().points
    np.testing.assert_allclose(np.linalg.norm(hidden.points - dq.translation(
        hidden.measured_pose), axis=1), 0.01, atol=1e-12)  # fmt: skip
    assert off.min() > 0.01 - np.linalg.norm(believed, axis=1).max()


def test_several_add_up_and_a_batch_is_what_each_run_is_by_itself():
    given = {"offset": SINE, "offset-2": {"form": "noise", "x": 0.01, "measured": "no"}}
    law = CONTROLLERS["hinf"]
    fixed = (motion(), arm(), start(), PLANTS["ideal"], law, law.read_gains({}))
    made = make_disturbances(given)
    for seed, one in zip((3, 4), track_many(*fixed, made, (3, 4)), strict=True):
        alone = track(*fixed, disturbances=made, seed=seed)
        for name in ("pose", "measured_pose", "pose_disturbance"):
            np.testing.assert_allclose(getattr(one, name), getattr(alone, name), atol=1e-10)
        assert np.abs(alone.pose - alone.measured_pose).max() > 1e-3


@pytest.mark.slow
@pytest.mark.parametrize(("values", "parts"), [({"error": 0.2}, 1.2), ({"error": -0.5}, 0.5)])
def test_a_law_s_inertia_and_weight_are_off_by_the_stated_share(values, parts):
    told = []

    def weigh(seen, _gains):
        told.append((seen.posture, seen.inertia, seen.bias))
        return seen.bias

    run({"masses": values}, Controller("weigh", "none", RateGains, weigh, "torque"), "torque")
    q, inertia, bias = told[0]  # at rest
    true = Dynamics(arm())
    np.testing.assert_allclose(inertia, parts * true.inertia(q), rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(bias, parts * true.weight(q), atol=1e-9)


@pytest.mark.slow
def test_each_link_has_an_error_of_its_own():
    rng = np.random.default_rng(0)
    model = make_disturbances({"masses": {"spread": 0.2}})["masses"].law_model(arm(), rng)
    own = np.array([b.mass for b in model.model.inertias][1:])
    true = np.array([b.mass for b in arm().model.inertias][1:])
    assert 0.05 < np.std(own / true) < 0.4
    with pytest.raises(UsageError, match="error -1"):
        make_disturbances({"masses": {"error": -1}})


def test_the_springs_model_of_their_weight_is_off_likewise():
    """With a gravity error besides, as a product."""
    world = World()
    wrong = {"masses": {"error": 0.2}, "gravity": {"error": -0.5}}
    for one in make_disturbances(wrong).values():
        world = one.world(world)
    assert world.model_gravity == pytest.approx(1.2 * 0.5)
