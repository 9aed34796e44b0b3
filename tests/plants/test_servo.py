"""Servo motors that move an engine's links: closed forms, energy, and the way to `stiff`."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.errors import UsageError
from dqpaint.plants import PLANTS, choose_plant, find_plant
from dqpaint.plants.servo_options import ServoOptions
from dqpaint.plants.world import Payload, World
from dqpaint.robots.kinematics.dynamics import Dynamics
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import Card, read_card

PERIOD = 0.008
IIWA = read_card("iiwa")
LYING = World(base=dq.pose_from((0, 0, 0), [np.sqrt(0.5), np.sqrt(0.5), 0, 0]))
SIDEWAYS = World(base=dq.pose_from((0, 0, 0), [np.cos(0.4), np.sin(0.4), 0, 0]))
BARE = {
    "friction": 0, "viscous": 0, "ripple": 0, "backlash": 0, "delay": 0, "reset": 0,
    "encoder": "joint",
}  # fmt: skip


def make(card=IIWA, world=None, start=None, **given):
    options = ServoOptions.model_validate(given)
    posture = card.home if start is None else start
    return PLANTS["servo"](card, posture, PERIOD, world or World(), options)


@pytest.mark.slow
@pytest.mark.parametrize("joint", [0, 1, 3])
@pytest.mark.parametrize("delay", [0.0, 0.003])
def test_a_joint_follows_as_a_loop_of_second_order(joint, delay, one_joint, engine):
    """A rate u at once: lag = u / w_d e^(-kv t/2) sin w_d t, w^2 = kp kv, a delay later."""
    card, kp, kv, u = one_joint(joint), 40.0, 60.0, 0.8
    plant = make(
        card, World() if joint % 2 == 0 else LYING,
        **{**BARE, "delay": delay}, position=kp, velocity=kv, stiffness=1e7, rotor=2e-4,
        current=1e5, slew=1e3, gravity=0,
    )  # fmt: skip
    found = []
    for _ in range(40):
        plant.run(np.array([u]))
        found.append(plant.posture[0])
    plant.close()
    t = np.maximum(PERIOD * np.arange(1, 41) - delay, 0.0)
    wd = np.sqrt(kp * kv - kv**2 / 4)
    lag = u / wd * np.exp(-kv / 2 * t) * np.sin(wd * t)
    assert lag.max() > 0.005
    np.testing.assert_allclose(found, u * t - lag, atol=0.01 * lag.max())


@pytest.mark.slow
def test_without_friction_and_delay_and_with_high_gains_it_tends_to_stiff(rng):
    """The whole iiwa, a smooth motion of 0.5 s: how far postures are from those of `stiff`."""
    t = np.arange(60) * PERIOD
    rates = 0.4 * np.sin(4 * t[:, None] + np.arange(7))

    def postures(plant):
        found = []
        for row in rates:
            plant.run(row)
            found.append(plant.posture)
        plant.close()
        return np.array(found)

    stiff = postures(PLANTS["stiff"](IIWA, IIWA.home, PERIOD))
    far = []
    for gain in (1.0, 4.0):
        plant = make(
            **BARE, position=60 * gain, velocity=150 * gain, stiffness=2e4 * gain**2,
            current=4000 * gain, loss=0.3,
        )  # fmt: skip
        far.append(np.abs(postures(plant) - stiff).max())
    usual = np.abs(postures(make()) - stiff).max()
    assert far[1] < 0.3 * far[0]
    assert far[0] < usual
    assert far[1] < 1e-3


class Dead:
    """Motors without current."""

    added, rate = np.zeros(7), 0.0

    def torque(self, step, seen):
        return np.zeros(7)


@pytest.mark.slow
@pytest.mark.parametrize("backlash", [0.0, 0.01])
def test_energy_does_not_grow_by_itself(backlash, one_joint, engine):
    """A dead arm falls: links, rotors and gears have what they began with; friction only takes."""
    # the iiwa's file has friction of its own; at its home most of it moves slowly
    urdf = IIWA.urdf.model_copy(update={"frictionless": True})
    frictionless = IIWA.model_copy(update={"urdf": urdf})
    arm = Kinematics(frictionless)
    import pinocchio

    data = arm.model.createData()
    for friction in (0.0, 3.0):
        plant = make(
            frictionless, friction=friction, viscous=0, ripple=0, backlash=backlash, loss=0,
            stiffness=8000, stiction=1,
        )  # fmt: skip
        plant.motors.loop = Dead()
        plant.motors.motor_torque = np.zeros(7)
        one = plant.motors.gear
        energies = []
        for _ in range(40):
            q, v = plant.posture, plant.rates
            wound = one.gears.wound(one.angle - q)
            energies.append(
                pinocchio.computeKineticEnergy(arm.model, data, q, v)
                + pinocchio.computePotentialEnergy(arm.model, data, q)
                + 0.5 * np.sum(one.gears.inertia * one.rate**2 + one.gears.stiffness * wound**2)
            )
            plant.run(np.zeros(7))
        plant.close()
        energies = np.array(energies) - energies[0]
        fallen = 0.5 * np.sum(one.gears.inertia * one.rate**2)
        assert fallen > 1
        assert energies.max() < 0.01 * fallen
        if friction:
            assert energies[-1] < -0.1
            assert np.diff(energies).max() < 0.02 * fallen
        else:
            assert abs(energies[-1]) < 0.02 * fallen


@pytest.mark.slow
def test_the_whole_arm_begins_in_balance():
    """With a payload, backlash and friction: nothing moves until it is told to."""
    for given in ({}, {"loop": "theta-gc", "gravity": 0.6}, {"reset": 0}):
        plant = make(world=World(payloads=(Payload(2.0, 0.03),)), start=IIWA.home + 0.1, **given)
        for _ in range(25):
            plant.run(np.zeros(7))
        np.testing.assert_allclose(plant.posture, IIWA.home + 0.1, atol=2e-5)
        plant.close()


@pytest.mark.slow
@pytest.mark.parametrize("joint", [1, 3])
def test_theta_gc_sags_by_what_is_not_compensated(joint, one_joint, engine):
    """Its reference measured: T u = (1 - share) G / (s P) holds it, wherever it hangs."""
    card = one_joint(joint)
    share, scale, hold = 0.7, 0.5, 300.0
    plant = make(
        card, loop="theta-gc", reference="measured", gravity=share, scale=scale, hold=hold,
        **{**BARE, "delay": 0.0}, rotor=1e-4, stiffness=3000, torque=400, slew=1e3, damping=0.5,
    )  # fmt: skip
    target, gain = 0.4, 100.0
    for _ in range(500):
        command = gain * (target - plant.encoder)
        plant.run(command)
    plant.close()
    weight = Dynamics(Kinematics(card)).weight(plant.posture)
    assert np.abs(weight) > 1
    assert PERIOD * command == pytest.approx((1 - share) * weight / (scale * hold), rel=0.01)


def test_what_is_assumed_is_said():
    plant = find_plant("servo")
    said = "".join(plant.notes(IIWA))
    assert "gear, rotor, stiffness, backlash, viscous, friction, ripple" in said
    assert plant.summary(IIWA)["origin"]["rotor"] == "assumed"
    given = find_plant("servo:friction=0,rotor=1e-4/2e-4/1e-4/1e-4/1e-4/1e-4/1e-4,backlash=0")
    assert "rotor" not in "".join(given.notes(IIWA))
    shown = given.summary(IIWA)
    assert shown["origin"]["friction"] == "given"
    assert shown["reflected_inertia_kg_m2"][:2] == [1.0, 2.0]
    assert shown["friction_Nm"] == [0.0] * 7


def test_a_card_brings_its_motors_with_their_source():
    panda = read_card("panda")
    plant = find_plant("servo")
    shown = plant.summary(panda)
    assert shown["origin"]["rotor"] == shown["origin"]["friction"] == "card"
    assert shown["reflected_inertia_kg_m2"] == list(panda.drives.reflected_inertia_kg_m2)
    assert "Gaz" in shown["source"]
    said = "".join(plant.notes(panda))
    assert "stiffness" in said
    assert "friction" not in said


def test_a_row_of_the_wrong_length_is_refused():
    drives = {"source": "x", "friction_Nm": (1.0, 2.0)}
    with pytest.raises(ValueError, match=r"drives\.friction_Nm .*7 joints"):
        Card.model_validate({**IIWA.model_dump(), "drives": drives})


def test_a_measured_reference_is_slewed_and_not_clipped():
    assert find_plant("servo").clips_rates
    assert find_plant("stiff").clips_rates
    assert not find_plant("servo:theta-gc,reference=measured").clips_rates


@pytest.mark.parametrize(("text", "said"), [
    ("servo:friction=-1", "friction -1.0 should be numbers from 0"),
    ("servo:rotor=0", "rotor 0.0 should be positive"),
    ("servo:stiction=0.5", "stiction"),
    ("servo:scale=2", "scale"),
    ("servo:torque-gc", "loop 'torque-gc'"),
    ("servo:k=3", "'k'"),
])  # fmt: skip
def test_bad_values_are_refused(text, said):
    with pytest.raises(UsageError, match=said):
        choose_plant(text, "rates")


def test_values_that_do_not_fit_the_arm_are_refused():
    for text, said in (
        ("servo:friction=3/2", "friction has 2 numbers.* 7 joints"),
        ("servo:stiffness=1e12", "servo.*iiwa need physics steps of .* us"),
    ):
        with pytest.raises(UsageError, match=said):
            choose_plant(text, "rates")(IIWA, IIWA.home, PERIOD, World())
