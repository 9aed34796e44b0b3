"""The search for the worst disturbance: it finds the bounds, and what it finds is run again."""

import numpy as np
import pytest

import dqpaint
from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.errors import UsageError
from dqpaint.language import parse
from dqpaint.metrics.attenuation import bounds_in_steps, largest_turn
from dqpaint.motion import plan
from dqpaint.studies.kinds.worst_loop import Loop, search
from dqpaint.testing.runs import arm

STILL = "period {} ms\nstart at (20, 10, 5) mm tool rpy(10 deg, 5 deg, 0)\nhold {} s\n"
MOVING = "period 10 ms\nstart at (40, 0) mm\narc centre (0, 0) angle 90 deg in 0.4 s\n"


def looped(text, law="hinf", **gains):
    motion = plan(parse(text, "t.traj"), arm().card.canvas.pose)
    schedule = CONTROLLERS[law].read_gains(gains)
    return motion, Loop(CONTROLLERS[law], schedule, arm(), motion), schedule.disturbance_bounds()


def found(text, part, size, turn=0.0, rounds=20, **gains):
    """The search's ratio as a part of the promise, what it found, and its bound in steps."""
    motion, loop, bounds = looped(text, **gains)
    one = search(loop, part, len(motion.t) - 1, size, turn, rounds, seed=3)
    apart = dq.mul(one.pose, dq.conj(motion.pose))
    i = 0 if part == "rotation" else 1
    steps = bounds_in_steps(bounds, motion.period, largest_turn(apart))[i]
    return one.ratio / bounds[i], one, steps / bounds[i]


@pytest.mark.slow
def test_it_finds_the_bound_of_translation():
    part, one, _ = found(STILL.format(8, 3), "translation", 0.01)
    assert 0.99 <= part <= 1
    assert np.sqrt((one.v[:, 3:] ** 2).sum(axis=1).mean()) == pytest.approx(0.01)
    assert not one.v[:, :3].any()


@pytest.mark.slow
def test_it_finds_the_bound_of_rotation():
    part, one, _ = found(STILL.format(20, 8), "rotation", 40.0)
    assert 0.95 <= part <= 1
    assert np.sqrt((one.v[:, :3] ** 2).sum(axis=1).mean()) == pytest.approx(40)


@pytest.mark.slow
def test_it_finds_that_turning_breaks_the_bound_of_continuous_time():
    """At K_T T = 0.5 with turns of 0.3 rad a step: 1.036 and more, within the bound in steps."""
    T = 0.008
    part, one, steps = found(
        STILL.format(8, 2), "translation", 0.01, 0.3 / T, K_T=0.5 / T, K_O=1 / T
    )
    assert 1.036 <= part < steps
    assert np.linalg.norm(one.v[:, :3], axis=1).max() == pytest.approx(0.3 / T)


@pytest.mark.parametrize("law", ["hinf", "p", "log", "decoupled"])
@pytest.mark.parametrize("part", ["translation", "rotation"])
def test_the_gradient_is_that_of_differences(law, part, rng):
    motion, loop, _ = looped(MOVING, law)
    v = rng.normal(size=(len(motion.t) - 1, 2, 6)) * [1, 1, 1, 0.1, 0.1, 0.1]
    along = rng.normal(size=v.shape)
    h = 1e-5
    energies = [loop.energy(loop.run(v + s * h * along), part) for s in (1, -1)]
    slope = (energies[0] - energies[1]) / (2 * h)
    told = 2 * (loop.gradient(v, part) * along).sum(axis=(0, -1))
    np.testing.assert_allclose(told, slope, rtol=1e-4)


def test_a_step_of_the_loop_is_that_of_matrices(rng):
    """hinf by hand: u = [-K_O Im(r_e); -K_T p_e], at a still pose, by pinocchio's exponential."""
    import pinocchio

    motion, loop, _ = looped(STILL.format(8, 0.1))
    v = rng.normal(size=(1, 6))
    x = dq.mul(dq.exp(rng.normal(size=6) * 0.2), motion.pose[0])
    X, X_d = (pinocchio.SE3(dq.matrix_from_pose(p)) for p in (x, motion.pose[0]))
    E = X * X_d.inverse()
    log = pinocchio.log3(E.rotation)
    angle = np.linalg.norm(log)
    w = -40 * log / angle * np.sin(angle / 2) + v[0, :3]
    u = -np.sqrt(2) / 0.0707 * E.translation + v[0, 3:]
    after = pinocchio.exp6(pinocchio.Motion(0.008 * np.r_[u, w])) * X
    np.testing.assert_allclose(
        dq.matrix_from_pose(loop.step(0, x, v[0])), after.homogeneous, atol=1e-9
    )


def test_what_is_found_is_run_again_from_its_file(tmp_path):
    drawing = tmp_path / "a.traj"
    drawing.write_text(STILL.format(20, 1))
    made = dqpaint.study(
        "worst", drawing, controllers=["hinf", "p(k=5)"], error="translation", rounds=3,
        folder=tmp_path / "w",
    )  # fmt: skip
    made.save(tmp_path / "w")
    assert [case.law for case in made.study.cases] == ["hinf", "p(k=5)"]
    for case in made.study.cases:
        gains = {"k": 5} if "k=5" in case.law else {}
        again = dqpaint.draw(
            drawing, plant="ideal", controller=case.law.partition("(")[0], gains=gains,
            disturb={"twist": str(tmp_path / f"w/a{case.end}")}, size=(16, 16),
        )  # fmt: skip
        came = again.attenuation["translation"]
        assert came.ratio == pytest.approx(case.on_arm.ratio, rel=1e-6)
        assert came.bound == case.on_arm.bound
    assert {"-worst.png", "-table.csv", "-table.md"} <= set(made.files)
    assert not list((tmp_path / "w").glob("*trial*"))
    row = made.files["-table.csv"].decode().splitlines()[1].split(",")
    assert float(row[4]) == made.study.cases[0].on_arm.ratio


@pytest.mark.slow
def test_on_another_plant_it_goes_on_by_runs(tmp_path):
    """A weak spring swings: what it answers worst is at its own frequency, far above the loop's."""
    drawing = tmp_path / "a.traj"
    drawing.write_text(STILL.format(10, 2))
    tried = {
        trials: dqpaint.study(
            "worst", drawing, controllers="pff(k=14)", error="translation", rounds=2,
            plants="compliant(frequency=30,damping=0.2)", trials=trials,
        ).study.cases[0].on_arm.ratio
        for trials in (1, 7)
    }  # fmt: skip
    assert tried[7] > 1.02 * tried[1]


@pytest.mark.parametrize(("choices", "said"), [
    ({"controllers": "accel"}, "'accel' commands acceleration"),
    ({"disturb": "twist=x=1"}, "leave out --disturb"),
    ({"size": -1.0}, "size -1.0"),
    ({"error": "place"}, "error 'place'"),
])  # fmt: skip
def test_what_cannot_be_sought_is_refused(tmp_path, choices, said):
    drawing = tmp_path / "a.traj"
    drawing.write_text(STILL.format(20, 0.1))
    with pytest.raises(UsageError, match=said):
        dqpaint.study("worst", drawing, **choices)
