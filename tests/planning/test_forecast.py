"""Each forecast against the run it speaks of: which limit, on which line, by how much."""

from functools import cache

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.planning.forecast import _Run, forecast
from dqpaint.planning.reachability import reachable_start_posture
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics.differential_ik import CHARACTERISTIC_LENGTH
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import Card, read_card
from dqpaint.settings.model import make_settings
from dqpaint.simulation.closed_loop import track, track_many
from tests.support.forecasts import lifted, random_drawing, rows_of

RATE, TORQUE = 0.025, 0.04  # relative: a run takes each step with what it saw before it
CORRECTION = 0.08  # of a torque limit: what a law adds to correct its own errors
ANGLE = np.radians(0.1)


def look_and_run(text, plant, name="iiwa"):
    """The forecast, the run, and the run of the arm that has no limits."""
    arm = Kinematics(name if isinstance(name, Card) else read_card(name))
    motion = plan(parse(text, "test.traj"), arm.card.canvas.pose)
    start = reachable_start_posture(motion, arm).posture
    law = CONTROLLERS["pff"]
    gains = law.read_gains({})
    runs = [
        track(motion, Kinematics(card), start, PLANTS[plant], law, gains)
        for card in (arm.card, lifted(arm.card))
    ]
    return forecast(motion, arm, start), *runs, arm.card


@cache
def looked_and_run(seed):
    return look_and_run(random_drawing(seed), "stiff")


def compare_amounts(found, free, card, efforts):
    for one in found:
        rows = rows_of(free, one.line.line)
        q = free.posture[rows]
        margin = np.minimum(q - card.lower, card.upper - q)
        assert one.margin.value == pytest.approx(margin.min(), abs=ANGLE)
        assert margin[:, one.margin.joint - 1].min() == pytest.approx(margin.min(), abs=ANGLE)
        rates = np.abs(free.command[rows])
        part = (rates / card.speed).max()
        assert one.speed_part == pytest.approx(part, rel=RATE, abs=0.01)
        assert one.speed.value == pytest.approx(
            rates[:, one.speed.joint - 1].max(), rel=RATE, abs=0.01
        )
        assert one.manipulability == pytest.approx(
            free.manipulability[rows].min(), rel=RATE, abs=1e-4
        )
        if efforts:
            torque = np.abs(free.effort[rows + 1])
            part = (torque / card.effort).max()
            assert one.jolt_part == pytest.approx(part, rel=TORQUE, abs=CORRECTION)
            most = torque[:, one.jolt.joint - 1].max()
            slack = CORRECTION * card.effort[one.jolt.joint - 1]
            assert one.jolt.value == pytest.approx(most, rel=TORQUE, abs=slack)


def kinds(one):
    broken = {"position": one.margin.value < 0, "speed": one.speed_part > 1}
    return {kind for kind, is_so in {**broken, "torque": one.jolt_part > 1}.items() if is_so}


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
def test_ten_random_drawings_on_the_stiff_arm(seed):
    found, run, free, card = looked_and_run(seed)
    assert not free.clamps
    compare_amounts(found, free, card, efforts=True)
    # every forecast limit is met on its line, and speed by the joint that was named
    met = {(clamp.kind, clamp.line) for clamp in run.clamps}
    joints = {(clamp.kind, clamp.line, clamp.joint) for clamp in run.clamps}
    for one in found:
        assert {(kind, one.line) for kind in kinds(one)} <= met
        if one.speed_part > 1:
            assert ("speed", one.line, one.speed.joint) in joints
        # which joint lacks most torque, the free run has said: once one saturates, others have less
    # and the first limit that is met was forecast; later ones may follow from it
    if run.clamps:
        first = run.clamps[0]
        before = [one for one in found if one.line < first.line]
        assert not any(kinds(one) for one in before)
        assert first.kind in kinds(next(one for one in found if one.line == first.line))
    else:
        assert not any(kinds(one) for one in found)


@pytest.mark.slow
def test_the_random_drawings_are_not_all_alike():
    """Else the comparison would say little: limits of speed, of torque, and none are among them."""
    seen = set()
    for seed in range(10):
        for one in looked_and_run(seed)[0]:
            seen |= kinds(one) or {"none"}
    assert seen == {"speed", "torque", "none"}


def stiff_wrist():
    """The Viper with 200 degrees of room in its last joint; it has no joint to spare."""
    card = read_card("viper850")
    limits = card.limits.model_copy(
        update={
            "lower_deg": (*card.limits.lower_deg[:-1], -100.0),
            "upper_deg": (*card.limits.upper_deg[:-1], 100.0),
        }
    )
    return card.model_copy(update={"limits": limits})


ACROSS = "period 4 ms\nstart at (0, 0) mm\nline to (20, 0) mm\n" + "".join(
    f"line by (5, 0) mm tool rot(z, {angle} deg) in 2 s\n" for angle in (80, 160, -110)
)


def test_a_joint_limit_is_forecast_where_the_run_meets_it():
    found, run, free, card = look_and_run(ACROSS, "ideal", stiff_wrist())
    compare_amounts(found, free, card, efforts=False)
    beyond = [one for one in found if one.margin.value < 0]
    assert beyond
    first = next(clamp for clamp in run.clamps if clamp.kind == "position")
    assert (first.line, first.joint) == (beyond[0].line, beyond[0].margin.joint)


@pytest.mark.parametrize("name", ["viper850", "meka-a2", "panda"])
def test_other_arms(name):
    text = "period 8 ms\nstart at (0, 0) mm\nline to (60, 30) mm tool rot(y, 25 deg) in 1 s\n"
    found, _, free, card = look_and_run(text, "ideal", name)
    compare_amounts(found, free, card, efforts=False)


def prepared(text, name="iiwa"):
    arm = Kinematics(read_card(name))
    motion = plan(parse(text, "test.traj"), arm.card.canvas.pose)
    return motion, arm, reachable_start_posture(motion, arm).posture


def test_the_arm_follows_exactly_and_its_torques_are_those_of_lagrange():
    """Energy: the work of the torques is the change of kinetic and potential energy."""
    import pinocchio

    text = "period 2 ms\nstart at (0, 0) mm\nline to (80, 60) mm profile quintic in 0.5 s\n"
    motion, arm, start = prepared(text)
    run = _Run(motion, arm, start)
    assert np.linalg.norm(run.points - motion.points, axis=1).max() < 2e-6
    model = arm.model.copy()
    data = model.createData()
    middle = 0.5 * (run.rates[:-1] + run.rates[1:])
    energy = [
        pinocchio.computeKineticEnergy(model, data, q, v)
        + pinocchio.computePotentialEnergy(model, data, q)
        for q, v in zip(run.posture[1:], middle, strict=True)
    ]
    damping = np.array(model.damping)
    work = ((run.effort[1:] - damping * run.rates[1:]) * middle).sum(axis=1) * run.period
    gained = np.diff(energy)
    assert np.cumsum(work)[:-1] == pytest.approx(np.cumsum(gained), abs=0.02 * np.ptp(energy))


def test_the_singular_value_is_measured_at_the_tool():
    motion, arm, start = prepared("start at (0, 0) mm\nline to (30, 0) mm\n")
    run = _Run(motion, arm, start)
    x, J = arm.pose_and_jacobian(run.posture[7])
    p = dq.translation(x)
    at_tool = np.concatenate([J[:3], (J[3:] + np.cross(J[:3].T, p).T) / CHARACTERISTIC_LENGTH])
    assert run.singular_value[7] == pytest.approx(np.linalg.svd(at_tool)[1][-1], rel=1e-12)


def test_a_jump_of_the_set_point_counts_as_no_speed():
    text = "period 8 ms\nstart at (0, 0) mm\nhold 0.2 s\nstep to (60, 40) mm\nhold 0.5 s\n"
    motion, arm, start = prepared(text)
    run = _Run(motion, arm, start)
    assert np.linalg.norm(run.points - motion.points, axis=1).max() < 1e-3
    assert np.abs(run.rates).max() < 0.05  # the null space alone: the jump itself would be 7 rad/s
    assert all(one.jolt_part < 0.5 for one in forecast(motion, arm, start))


def test_a_jump_from_full_speed_counts_as_no_torque():
    text = (
        "period 4 ms\nprofile constant\nspeed 400 mm/s\nstart at (0, 0) mm\nline to (60, 0) mm\n"
        "step to (60, 40) mm\nhold 0.2 s\n"
    )
    found = {one.line.line: one for one in forecast(*prepared(text))}
    assert found[5].jolt_part > 1
    assert found[6].jolt_part < 0.3


def test_a_long_drawing_is_looked_at_in_longer_steps(monkeypatch):
    from dqpaint.planning import forecast as module

    motion, arm, start = prepared("start at (0, 0) mm\nline to (80, 60) mm in 4 s\n")
    whole = forecast(motion, arm, start)[0]
    monkeypatch.setattr(module, "MOST_ROWS", 100)
    coarse = forecast(motion, arm, start)[0]
    assert coarse.speed_part == pytest.approx(whole.speed_part, rel=0.03)
    assert coarse.margin.value == pytest.approx(whole.margin.value, abs=ANGLE)


@pytest.mark.parametrize("null", [
    "limits,gain=4", *(pytest.param(null, marks=pytest.mark.slow)
                       for null in ("none", "home", "manipulability,gain=3")),
])  # fmt: skip
def test_the_null_space_is_that_of_the_run(null):
    """On an arm with a joint to spare other wishes lead to other postures, forecast and run."""
    text = (
        "period 8 ms\nstart at (60, 0) mm\n"
        "line to (-80, 60) mm in 2 s\nline to (40, -60) mm in 2 s tool rot(x, 25 deg)\n"
    )
    motion, arm, start = prepared(text)
    law = CONTROLLERS["pff"]
    run = track(
        motion, Kinematics(lifted(arm.card)), start, PLANTS["ideal"], law, law.read_gains({}),
        null=null,
    )  # fmt: skip
    found = forecast(motion, arm, start, make_settings(null=null))
    if null.startswith("limits"):  # of the card, not of the arm without any
        run = track(motion, arm, start, PLANTS["ideal"], law, law.read_gains({}), null=null)
        assert not run.clamps
    compare_amounts(found, run, arm.card, efforts=False)
    own = _Run(motion, arm, start, null)
    assert np.abs(own.posture - run.posture).max() < 0.01
    assert np.abs(own.posture - _Run(motion, arm, start).posture).max() > 0.03


def test_an_arm_that_begins_elsewhere_is_forecast_from_where_it_joins_the_drawing():
    motion, arm, _ = prepared("period 8 ms\nstart at (60, 0) mm\nline to (-80, 60) mm in 2 s\n")
    run = _Run(motion, arm, arm.card.home)
    assert np.linalg.norm(run.points - motion.points, axis=1).max() < 1e-3
    law = CONTROLLERS["pff"]
    ran = track(motion, arm, arm.card.home, PLANTS["ideal"], law, law.read_gains({}))
    settled = motion.t > 0.5
    assert np.abs(run.posture - ran.posture)[settled].max() < 0.01
    assert forecast(motion, arm, arm.card.home)[0].speed_part < 0.5  # not the way there


def test_the_resolver_is_that_of_the_run():
    """A price on the rates shortens the way of forecast and run alike; without one it is exact."""
    motion, arm, start = prepared("period 8 ms\nstart at (60, 0) mm\nline to (-80, 60) mm in 2 s\n")
    law = CONTROLLERS["pff"]
    off = {}
    for resolver in ("filter", "none", "wampler,factor=0.3"):
        run = track(motion, arm, start, PLANTS["ideal"], law, law.read_gains({}), resolver=resolver)
        foreseen = _Run(motion, arm, start, resolver=resolver)
        off[resolver] = foreseen.path_error.max()
        near = np.abs(foreseen.posture - run.posture).max()
        assert near < (0.1 if resolver.startswith("wampler") else 0.002), (resolver, near)
    assert max(off["filter"], off["none"]) < 1e-5
    assert off["wampler,factor=0.3"] > 1e-4
    many = track_many(motion, arm, start, PLANTS["ideal"], law, law.read_gains({}), {}, [0],
                      resolver="wampler,factor=0.3")  # fmt: skip
    np.testing.assert_allclose(many[0].posture, run.posture, atol=1e-9)
