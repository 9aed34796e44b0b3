"""How arms answer: the ideal one exactly, the stiff one as rigid bodies under motors do."""

import subprocess
import sys

import numpy as np
import pytest

from dqpaint.errors import UnknownNameError, UsageError
from dqpaint.plants import PLANTS, choose_plant
from dqpaint.plants.rigid_arm import LONGEST_STEP
from dqpaint.plants.world import GRAVITY, Payload, World
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import installed_names, read_card

pytestmark = pytest.mark.slow
CARD = read_card("iiwa")
PERIOD = 0.008


def run(name, rates, card=CARD, period=PERIOD, drift=None):
    plant = PLANTS[name](card, card.home, period)
    postures, efforts = [plant.posture.copy()], [plant.effort.copy()]
    for row in rates:
        plant.run(row, drift)
        postures.append(plant.posture.copy())
        efforts.append(plant.effort.copy())
    plant.close()
    return np.array(postures), np.array(efforts)


def test_a_plant_is_chosen_to_suit_the_commands():
    assert choose_plant(None, "rates").make is PLANTS["stiff"]
    assert choose_plant(None, "torque").make is PLANTS["torque"]
    assert choose_plant("ideal", "rates").make is PLANTS["ideal"]
    with pytest.raises(UsageError, match=r"'stiff' takes joint rates, .*torque"):
        choose_plant("stiff", "torque")
    with pytest.raises(UsageError, match=r"'torque' takes torques, .*stiff"):
        choose_plant("torque", "rates")
    with pytest.raises(UnknownNameError):
        choose_plant("rubber", "rates")


@pytest.mark.parametrize("robot", installed_names())
def test_the_torque_driven_arm_obeys_pinocchio_s_forward_dynamics(robot, rng, engine):
    """From random states, one physics step: q_ddot to 1e-9 of its size, semi-implicit Euler."""
    import pinocchio

    card = read_card(robot)
    model = Kinematics(card).model
    data = model.createData()
    assert robot != "iiwa" or model.damping.all()  # the file's friction takes part
    assert (model.gravity.linear == [0, 0, GRAVITY]).all()
    plant = PLANTS["torque"](card, card.home, LONGEST_STEP)
    plant.close()
    step = plant.step
    for _ in range(5):
        q = rng.uniform(0.8 * card.lower, 0.8 * card.upper)
        v, tau = rng.normal(size=card.joints), rng.normal(size=card.joints) * card.effort / 4
        plant = PLANTS["torque"](card, q, step)
        plant.bodies.place(q, v)
        plant.run(tau)
        plant.close()
        bend = pinocchio.aba(model, data, q, v, tau - model.damping * v)
        found = (plant.rates - v) / step
        np.testing.assert_allclose(found, bend, rtol=1e-9, atol=1e-9 * np.abs(bend).max())
        np.testing.assert_allclose(plant.posture, q + step * plant.rates, atol=1e-14)
        assert (plant.effort == tau).all()


def test_a_payload_moves_as_pinocchio_says(rng, engine):
    """A large ball fixed where the light sits: from a random state, one physics step."""
    import pinocchio

    mass, radius = 1.5, 0.2
    arm = Kinematics(CARD)
    model = pinocchio.Model(arm.model)
    ball = pinocchio.Inertia(mass, np.zeros(3), 0.4 * mass * radius**2 * np.eye(3))
    at = model.frames[model.getFrameId(CARD.link, pinocchio.FrameType.BODY)].placement
    lamp = pinocchio.SE3(np.eye(3), np.array(CARD.tool.at_m))
    model.appendBodyToJoint(7, ball, at * lamp)
    q, v, tau = rng.uniform(-1, 1, 7), rng.normal(size=7), rng.normal(size=7)
    plant = PLANTS["torque"](CARD, q, LONGEST_STEP, World(payloads=(Payload(mass, radius),)))
    plant.bodies.place(q, v)
    plant.run(tau)
    plant.close()
    bend = pinocchio.aba(model, model.createData(), q, v, tau - model.damping * v)
    found = (plant.rates - v) / LONGEST_STEP
    np.testing.assert_allclose(found, bend, rtol=1e-9, atol=1e-9 * np.abs(bend).max())


def test_much_friction_on_a_light_link_takes_shorter_steps(one_joint, engine):
    """A torque against friction f ends at the speed tau / f; steps of 1 ms would blow up."""
    card = one_joint(6, friction=4.0)
    plant = PLANTS["torque"](card, card.home, PERIOD)
    assert plant.step < LONGEST_STEP / 2
    for _ in range(20):
        plant.run(np.array([2.0]))
    plant.close()
    assert plant.rates[0] == pytest.approx(0.5, rel=1e-6)


def test_torques_are_held_over_the_whole_period(engine):
    """Every physics step clears them: eight steps of 1 ms are eight periods of 1 ms."""
    tau = np.array([10.0, -60, 5, 20, -3, 2, 1])
    whole = run("torque", [tau], period=0.008)[0][-1]
    parts = run("torque", [tau] * 8, period=0.001)[0][-1]
    np.testing.assert_allclose(whole, parts, atol=1e-13)
    assert np.abs(whole - CARD.home).max() > 1e-3


def test_the_stiff_arm_carries_its_weight(engine):
    """At rest the motors hold gravity: against pinocchio's own static torques."""
    import pinocchio

    postures, efforts = run("stiff", np.zeros((50, 7)))
    model = Kinematics(CARD).model
    gravity = pinocchio.computeGeneralizedGravity(model, model.createData(), postures[-1])
    np.testing.assert_allclose(efforts[-1], gravity, atol=0.05)
    assert np.abs(gravity).max() > 20


def test_the_stiff_arm_s_motors_end_at_their_torque(engine):
    weak = CARD.model_copy(
        update={"limits": CARD.limits.model_copy(update={"effort_Nm": (5.0,) * 7})}
    )
    postures, efforts = run("stiff", np.zeros((50, 7)), weak)
    assert np.abs(efforts).max() == pytest.approx(5.0)
    assert np.abs(postures[-1] - CARD.home).max() > 0.05  # it sinks


@pytest.mark.parametrize("period", [0.02, 0.008, 0.0015, 0.0007])
def test_physics_steps_divide_the_period(period, engine):
    rates = np.tile([0.3, -0.2, 0.1, 0.2, -0.3, 0.1, 0.2], (40, 1))
    postures, _ = run("stiff", rates, period=period)
    np.testing.assert_allclose(postures[-1] - postures[0], 40 * period * rates[0], atol=2e-4)


@pytest.mark.parametrize(("period", "steps"), [(0.008, 8), (0.0015, 2), (0.0007, 1), (0.003, 3)])
def test_physics_steps_are_at_most_a_millisecond(period, steps, engine):
    plant = PLANTS["torque"](CARD, CARD.home, period)
    done, apply = [], plant.bodies.apply
    plant.bodies.apply = lambda torques: done.append(apply(torques))
    plant.run(np.zeros(7))
    plant.close()
    assert len(done) == steps
    assert plant.step * steps == pytest.approx(period, rel=1e-15)


def test_engines_keep_quiet(engine):
    """PyBullet writes a build line when imported, and a remark for each solver it is asked for."""
    code = (
        "from dqpaint.plants import PLANTS; from dqpaint.robots.model.card import read_card;"
        "card = read_card('iiwa');"
        f"PLANTS['stiff'](card, card.home, 0.01, engine='{engine}').close()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == ""
    assert done.stderr == ""


def test_a_plant_that_a_law_of_rates_cannot_run_on_is_not_advised():
    from dqpaint.plants.plant import find_plant

    assert "torque" not in find_plant("stiff").why_without_effect("masses").partition("--plant")[2]
    with pytest.raises(UsageError) as caught:
        find_plant("stiff").require_trait("a model of gravity", "gravity")
    assert "compliant" in str(caught.value)
    assert "torque" not in str(caught.value)
