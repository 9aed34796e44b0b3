"""Many runs as one batch: the same as each by itself, whatever else is in it; also in a study."""

import json

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.disturbances import make_disturbances
from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.planning.reachability import reachable_start_posture
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics.batched import ManyKinematics
from dqpaint.robots.kinematics.differential_ik import resolve
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.kinematics.nullspace import OBJECTIVES, make_secondary_task
from dqpaint.robots.model.card import installed_names, read_card
from dqpaint.settings.model import make_settings
from dqpaint.simulation.closed_loop import track, track_many
from dqpaint.simulation.sensors import ModelsDifferError
from dqpaint.studies.runner.batches import MOST, carry_out_batch, goes_in_batches, groups
from dqpaint.studies.runner.engine import carry_out_study
from dqpaint.studies.runner.journal import NAME
from dqpaint.studies.runner.run import Run, seeded
from dqpaint.studies.runner.worker import carry_out, carry_out_all

ARC = (
    "period 8 ms\nstart at (0, 70) mm tool rpy(20 deg, 10 deg, 0)\n"
    "arc centre (0, 0) mm axis -z angle 40 deg rise 5 mm in 0.8 s\n"
)
DISTURB = {
    "twist": {"form": "noise", "x": 0.02, "wz": 0.1, "frequency": 5.0},
    "noise": {"rms": 1e-4, "step": 1e-5},
    "latency": {"periods": 1},
    "base": {"z": 0.01, "wx": 0.02},
}
ARRAYS = (
    "posture", "pose", "measured_posture", "measured_pose", "manipulability", "command",
    "measured_rates", "measured_twist", "unclipped",
    "disturbance",
)  # fmt: skip
CLOSE = 1e-11
RATE_LAWS = [n for n, law in CONTROLLERS.items() if law.batched and not law.drives_torque]


def run(**choices):
    usual = {"controller": "hinf", "plant": "ideal", "disturb": DISTURB, "width": 16, "height": 16}
    return Run("arc.traj", ARC, make_settings(**{**usual, **choices}))


@pytest.fixture(scope="module")
def arm():
    card = read_card("iiwa")
    kinematics = Kinematics(card)
    motion = plan(parse(ARC, "arc.traj"), card.canvas.pose)
    return motion, kinematics, reachable_start_posture(motion, kinematics).posture


@pytest.mark.parametrize("name", installed_names())
def test_many_poses_and_jacobians_are_pinocchio_s(name, rng):
    card = read_card(name)
    kinematics = Kinematics(card)
    postures = rng.uniform(card.lower, card.upper, (40, card.joints))
    x, J = ManyKinematics(kinematics).pose_and_jacobian(postures)
    expected, jacobians = kinematics.poses_and_jacobians(postures)
    assert np.abs(dq.nearest(x, expected) - expected).max() < 1e-13
    assert np.abs(J - jacobians).max() < 1e-13


@pytest.mark.parametrize("name", RATE_LAWS)
def test_a_batch_is_what_each_run_is_by_itself(arm, name):
    motion, kinematics, start = arm
    law, given = CONTROLLERS[name], make_disturbances(DISTURB)
    ramp = next(iter(law.gains.model_fields), None)
    changing = "0.02..0.05@50%" if ramp == "gamma_O" else "10..20@50%"
    gains = law.read_gains({} if ramp is None else {ramp: changing})
    seeds = (3, 11, 4)
    fixed = (motion, kinematics, start, PLANTS["ideal"], law, gains)
    many = track_many(*fixed, given, seeds, "limits,gain=1")
    for seed, found in zip(seeds, many, strict=True):
        one = track(*fixed, disturbances=given, seed=seed, null="limits,gain=1")
        for array in ARRAYS:
            assert np.abs(getattr(found, array) - getattr(one, array)).max() < CLOSE, array
        assert [str(clamp) for clamp in found.clamps] == [str(clamp) for clamp in one.clamps]
    assert np.abs(many[0].posture - many[1].posture).max() > 1e-6  # they do differ


def test_a_run_does_not_depend_on_what_else_is_in_its_batch(arm):
    motion, kinematics, start = arm
    law, given = CONTROLLERS["p"], make_disturbances(DISTURB)
    fixed = (motion, kinematics, start, PLANTS["ideal"], law, law.read_gains({}))
    many = track_many(*fixed, given, range(20))
    for seeds in ([7], [7, 3], [1, 2, 7, 9, 13]):
        for seed, one in zip(seeds, track_many(*fixed, given, seeds), strict=True):
            for array in ARRAYS:
                assert np.array_equal(getattr(one, array), getattr(many[seed], array))


@pytest.mark.parametrize("name", OBJECTIVES)
def test_wishes_of_many_are_those_of_each(name, arm, rng):
    _, kinematics, start = arm
    card = kinematics.card
    q = rng.uniform(card.lower, card.upper, (5, card.joints))
    x, J = kinematics.poses_and_jacobians(q)
    wish = make_secondary_task(name, card, start)
    many = np.broadcast_to(wish(q, J, dq.translation(x)), q.shape)
    for i in range(5):
        one = wish(q[i], J[i], dq.translation(x[i]))
        np.testing.assert_allclose(many[i], one, atol=1e-10)


def test_one_near_a_singularity_changes_none_of_the_others(arm, rng):
    _, kinematics, _ = arm
    card = kinematics.card
    q = rng.uniform(card.lower, card.upper, (6, card.joints))
    q[2] = 0.0  # stretched out
    x, J = kinematics.poses_and_jacobians(q)
    twist, wish = rng.normal(size=(6, 6)), rng.normal(size=q.shape)
    many = resolve(J, dq.translation(x), twist, wish)
    for i in range(6):
        one = resolve(J[i], dq.translation(x[i]), twist[i], wish[i])
        np.testing.assert_allclose(many[i], one, rtol=1e-9, atol=1e-9)


def test_what_goes_in_batches():
    assert goes_in_batches(run())
    assert not goes_in_batches(run(plant="stiff"))
    assert not goes_in_batches(run(disturb={}))
    assert not goes_in_batches(run(on_limit="stop"))
    assert not goes_in_batches(run(controller="trajectories/mylaw.py"))
    tasks = [(f"{law} {r.settings.seed}", r) for law in ("p", "hinf")
             for r in seeded(run(controller=law), MOST + 2)]  # fmt: skip
    tasks.insert(5, ("alone", run(plant="stiff")))
    found = groups(tasks)
    assert [len(group) for group in found] == [MOST, 2, 1, MOST, 2]
    assert sorted(key for group in found for key, _ in group) == sorted(key for key, _ in tasks)


def test_figures_of_a_batch_are_those_of_runs_by_themselves(tmp_path):
    tasks = [(str(r.settings.seed), r) for r in seeded(run(), 3)]
    for (key, one), found in zip(tasks, carry_out_batch(tasks, tmp_path), strict=True):
        alone = carry_out(one, key, tmp_path)
        assert (found.key, found.status, found.limits) == (key, alone.status, alone.limits)
        assert found.figures == pytest.approx(alone.figures, rel=1e-9)
        assert list(found.figures) == list(alone.figures)


def test_models_that_differ_and_what_fails_goes_by_itself(tmp_path, arm):
    wrong = run(disturb={"links": {"part": 0.01}})
    motion, kinematics, start = arm
    law = CONTROLLERS["p"]
    with pytest.raises(ModelsDifferError):
        track_many(motion, kinematics, start, PLANTS["ideal"], law, law.read_gains({}),
                   make_disturbances({"links": {"part": 0.01}}), [1, 2])  # fmt: skip
    tasks = [(str(r.settings.seed), r) for r in seeded(wrong, 2)]
    assert carry_out_batch(tasks, tmp_path) is None
    found = list(carry_out_all(tasks, tmp_path))
    assert [r.figures for r in found] == [carry_out(r, k, tmp_path).figures for k, r in tasks]
    far = run(disturb=DISTURB, robot="nobody")
    (result,) = carry_out_all([("far", far)], tmp_path)
    assert result.status == "failed"
    assert "nobody" in result.message


@pytest.mark.slow
def test_a_study_is_the_same_whatever_the_workers_and_after_a_stop(tmp_path):
    runs = [r for law in ("p", "hinf") for r in seeded(run(controller=law), 4)]
    whole = carry_out_study(runs, tmp_path / "two", 2)
    assert [r.status for r in whole] == ["done"] * 8
    (tmp_path / "half").mkdir()
    lines = (tmp_path / "two" / NAME).read_text().splitlines()
    (tmp_path / "half" / NAME).write_text("\n".join(lines[:3]) + "\n")  # as a kill leaves it
    again = carry_out_study(runs, tmp_path / "half", 1)
    assert [(r.key, r.figures) for r in again] == [(r.key, r.figures) for r in whole]
    keys = [json.loads(line)["key"] for line in (tmp_path / "half" / NAME).read_text().splitlines()]
    assert len(keys) == len(set(keys)) == 8
