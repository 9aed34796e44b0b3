"""Physics engines beside each other: what is chosen, and that a run means the same on each."""

from itertools import pairwise

import numpy as np
import pytest

import dqpaint
from dqpaint import dq
from dqpaint.errors import UsageError
from dqpaint.plants import ENGINES, PLANTS, choose_engine, choose_plant
from dqpaint.plants.engines import choice
from dqpaint.plants.world import ForceCourse, Payload, Push, World
from dqpaint.robots.model.card import installed_names, read_card

CARD = read_card("iiwa")
PERIOD = 0.008
TILTED = dq.pose_from((0.1, 0, 0), np.array([np.cos(0.1), np.sin(0.1), 0, 0]))


def turning(t):
    return 20 * np.stack([np.sin(5 * t), np.cos(5 * t), 0 * t], axis=1)


WORLD = World(
    base=TILTED,
    payloads=(Payload(1.0, 0.04),),
    pushes=(Push((30.0, -20, 10), 4, 0.05, 0.2), Push((0.0, 15, 0), 0, 0.1, 0.1),
            ForceCourse(turning, 6)),
)  # fmt: skip


def both():
    for one in ENGINES.values():
        if not one.installed:
            pytest.skip(f"{one.name} is not installed")
    return list(ENGINES)


def weak(effort):
    limits = CARD.limits.model_copy(update={"effort_Nm": effort})
    return CARD.model_copy(update={"limits": limits})


def run(plant, engine, card=CARD, world=WORLD, count=40, drift=None, period=PERIOD):
    """Postures (N, n), rates (N, n) and efforts (N, n)."""
    arm = PLANTS[plant](card, card.home, period, world, engine=engine)
    found = []
    for row in range(count):
        command = 0.3 * np.sin(0.1 * row + np.arange(7))
        if arm.takes == "torque":
            command = arm.bodies.weight(arm.posture) + 10 * command
        arm.run(command, drift)
        found.append((arm.posture, arm.rates, arm.effort))
    arm.close()
    return [np.array(part) for part in zip(*found, strict=True)]


def test_the_first_that_is_installed_is_the_default(monkeypatch):
    monkeypatch.setattr(choice, "available_engines", lambda: ["pybullet", "mujoco"])
    assert choose_engine().name == "pybullet"
    assert choose_engine("mujoco").name == "mujoco"
    monkeypatch.setattr(choice, "available_engines", lambda: ["mujoco"])
    assert choose_engine().name == "mujoco"
    with pytest.raises(UsageError, match="pip install pybullet; installed: mujoco"):
        choose_engine("pybullet")
    monkeypatch.setattr(choice, "available_engines", lambda: [])
    with pytest.raises(UsageError, match=r"pip install mujoco-core.*ideal"):
        choose_plant(None, "rates").check_installed()
    choose_plant("ideal", "rates").check_installed()


def test_an_engine_without_effect_is_told():
    assert "no effect" in choose_plant("ideal", "rates", "mujoco").notes(CARD)[0]
    assert not choose_plant("stiff", "rates", "mujoco").notes(CARD)
    assert not choose_plant("ideal", "rates").notes(CARD)


@pytest.mark.slow
@pytest.mark.parametrize("plant", ["torque", "compliant", "stiff"])
def test_engines_agree_under_pushes_loads_a_tilted_base_and_drift(plant):
    """To rounding; the place of a push at the tool PyBullet knows to 5e-8 m alone."""
    drift = 0.02 * np.arange(7)
    one, other = (run(plant, name, drift=drift) for name in both())
    np.testing.assert_allclose(one[0], other[0], rtol=0, atol=1e-7)
    np.testing.assert_allclose(one[1], other[1], rtol=0, atol=3e-6)
    alone = run(plant, "mujoco", world=World(base=TILTED, payloads=WORLD.payloads), drift=drift)
    moved = np.abs(alone[0] - other[0]).max()
    assert moved > 1e-3 or plant == "stiff"


@pytest.mark.slow
@pytest.mark.parametrize("plant", list(PLANTS))
def test_an_engine_repeats_itself_bit_for_bit(plant, engine):
    if "an engine" not in PLANTS[plant].traits:
        pytest.skip("it has no engine")
    for one, other in zip(run(plant, engine), run(plant, engine), strict=True):
        assert (one == other).all()


def test_motors_at_their_torque_answer_alike():
    """Seven motors of which some are too weak: a problem with bounds, solved by both."""
    card = weak((60.0, 50, 30, 60, 5, 2, 0.05))
    one, other = (run("stiff", name, card) for name in both())
    most = card.effort
    held = np.abs(other[2]) >= most * (1 - 1e-12)
    assert held.any()
    assert not held.all(axis=1).any()
    assert (np.abs(other[2]) <= most).all()
    np.testing.assert_allclose(one[0], other[0], atol=1e-3)
    asked = run("stiff", "mujoco")
    assert np.abs(other[0] - asked[0]).max() > 0.02


def test_a_motor_within_its_torque_keeps_its_rate_while_others_do_not():
    """The bounded problem of one step: torque at its limit, or the rate exactly that commanded."""
    from dqpaint.plants.engines.mujoco_bodies import MuJoCoBodies

    card = weak((320.0, 320, 176, 176, 2, 1, 0.05))
    bodies = MuJoCoBodies(card, card.home, 0.001, World(), True)
    rates = np.array([0.02, -0.01, 0.02, 0.01, -0.2, 0.3, 0.4])
    torque = bodies.turn(rates, 1)
    kept = np.abs(np.array(bodies.state()[1]) - rates) < 1e-9
    at_limit = np.abs(torque) >= card.effort * (1 - 1e-12)
    assert (kept ^ at_limit).all()
    assert kept.any()
    assert at_limit.any()
    way = (rates - np.array(bodies.state()[1]))[at_limit]
    assert (np.sign(torque[at_limit]) == np.sign(way)).all()  # it pushes towards its rate


def test_steps_at_once_are_those_one_by_one(monkeypatch):
    """Where no motor reaches its torque, MuJoCo's stiff arm takes a period in one."""
    from dqpaint.plants.engines.mujoco_bodies import MuJoCoBodies

    quick = run("stiff", "mujoco", world=World())
    monkeypatch.setattr(MuJoCoBodies, "_turn_freely", lambda self, rates, steps: None)
    slow = run("stiff", "mujoco", world=World())
    np.testing.assert_allclose(quick[0], slow[0], atol=1e-14)
    np.testing.assert_allclose(quick[2], slow[2], atol=1e-8)


def test_what_diverges_stays_so_and_writes_no_log(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    arm = PLANTS["torque"](CARD, CARD.home, PERIOD, engine="mujoco")
    for _ in range(30):
        arm.run(np.full(7, 1e300))
    assert not np.isfinite(arm.posture).all()
    assert not list(tmp_path.iterdir())


def test_mechanical_stops_hold(engine):
    """Driven against its stops by its largest torques, no joint goes far past one."""
    arm = PLANTS["torque"](CARD, CARD.home, PERIOD, World(base=TILTED))
    stops = np.array([CARD.lower - 0.02, CARD.upper + 0.02])
    past = []
    for _ in range(150):
        arm.run(0.2 * CARD.effort)
        past.append(np.maximum(stops[0] - arm.posture, arm.posture - stops[1]).max())
    arm.close()
    assert max(past) > -0.05  # one is met
    assert max(past) < 0.1
    assert all(later < 0.1 for _, later in pairwise(past))


@pytest.mark.slow
@pytest.mark.parametrize("robot", installed_names())
def test_the_star_is_the_same_on_each(robot):
    """The whole closed loop on `stiff`: tool paths are the same within 0.1 mm."""
    one, other = (
        dqpaint.draw("star", robot=robot, place="auto", engine=name, size=(64, 36)).track.points
        for name in both()
    )
    assert np.abs(one - other).max() < 1e-4
