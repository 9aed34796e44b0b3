"""Series elastic joints against closed forms: swing, sag, and where a loop becomes unstable."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.errors import UsageError
from dqpaint.plants import PLANTS, choose_plant, compliant
from dqpaint.plants.compliant import CompliantOptions
from dqpaint.plants.world import Payload, World
from dqpaint.robots.kinematics.dynamics import Dynamics
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("engine")]
PERIOD = 0.008
IIWA = read_card("iiwa")
UPRIGHT = World()
LYING = World(base=dq.pose_from((0, 0, 0), [np.sqrt(0.5), np.sqrt(0.5), 0, 0]))
SIDEWAYS = World(base=dq.pose_from((0, 0, 0), [np.cos(0.4), np.sin(0.4), 0, 0]))


def options(**given):
    return CompliantOptions.model_validate(given)


def discrete(inertia, k, d, friction, grounded, period):
    """Exact (Phi, Gamma) of (theta, q, q_dot) for a rate of the motor held over a period."""
    A = np.array([[0, 0, 0], [0, 0, 1], [k / inertia, -k / inertia, -(d + friction) / inertia]])
    B = np.array([1, 0, 0 if grounded else d / inertia])
    whole = np.zeros((4, 4))
    whole[:3, :3], whole[:3, 3] = A * period, B * period
    power, total = np.eye(4), np.eye(4)
    for n in range(1, 60):
        power = power @ whole / n
        total = total + power
    return total[:3, :3], total[:3, 3]


@pytest.mark.parametrize("joint", range(7))
def test_each_joint_swings_like_one_spring(joint, one_joint):
    """Its motor jumps by 0.1 rad: q = 0.1 (1 - e^-zwt (cos w_d t + z / sqrt(1-z^2) sin w_d t)).

    The base is turned so that the joint's axis stands upright: then nothing weighs on it.
    """
    card = one_joint(joint)
    inertia = Dynamics(Kinematics(card)).inertia(card.home)[0, 0]
    w, z = 50.0, 0.3
    plant = PLANTS["compliant"](
        card, card.home, PERIOD, UPRIGHT if joint % 2 == 0 else LYING,
        options(frequency=w, damping=z, gravity=0),
    )  # fmt: skip
    np.testing.assert_allclose(plant.stiffness, w**2 * inertia)
    assert plant.effort[0] == pytest.approx(0, abs=1e-9)
    plant.motor = plant.motor + 0.1
    found = [0.0]
    for _ in range(40):
        plant.run(np.zeros(1))
        found.append(plant.posture[0])
    plant.close()
    t = np.arange(41) * PERIOD
    wd = w * np.sqrt(1 - z**2)
    wanted = 0.1 * (1 - np.exp(-z * w * t) * (np.cos(wd * t) + z * w / wd * np.sin(wd * t)))
    assert wanted.max() > 0.13
    np.testing.assert_allclose(found, wanted, atol=0.1 * 0.01)


@pytest.mark.parametrize("damper", ["motor", "ground"])
def test_commands_wind_the_spring_as_they_should(damper, one_joint, rng):
    """Random rates, friction in the joint: against the exact solution of the linear joint."""
    card, friction = one_joint(2, friction=0.4), 0.4
    inertia = Dynamics(Kinematics(card)).inertia(card.home)[0, 0]
    k, z = 800.0, 0.5
    plant = PLANTS["compliant"](
        card, card.home, PERIOD, options=options(stiffness=k, damping=z, gravity=0, damper=damper)
    )
    Phi, Gamma = discrete(
        inertia, k, 2 * z * np.sqrt(k * inertia), friction, damper == "ground", PERIOD
    )
    state, wanted, found, torques = np.zeros(3), [], [], []
    for rate in rng.normal(size=60):
        plant.run(np.array([rate]))
        state = Phi @ state + Gamma * rate
        wanted.append(state)
        found.append([plant.motor[0], plant.posture[0], plant.rates[0]])
        torques.append(plant.effort[0])
    plant.close()
    wanted, found = np.array(wanted), np.array(found)
    np.testing.assert_allclose(found[:, 0], wanted[:, 0], atol=1e-12)
    np.testing.assert_allclose(found[:, 1], wanted[:, 1], atol=0.01 * np.abs(wanted[:, 1]).max())
    np.testing.assert_allclose(found[:, 2], wanted[:, 2], atol=0.02 * np.abs(wanted[:, 2]).max())
    assert np.abs(torques).max() > 1


def test_half_the_step_leaves_a_quarter_of_the_error(one_joint, rng, monkeypatch):
    """Of second order in the physics step, jumps of the command included."""
    card = one_joint(0)
    inertia = Dynamics(Kinematics(card)).inertia(card.home)[0, 0]
    w, z = 40.0, 0.7
    Phi, Gamma = discrete(inertia, w**2 * inertia, 2 * z * w * inertia, 0.0, False, PERIOD)
    rates = rng.normal(size=40)
    errors = []
    for fine in (0.03, 0.01):
        monkeypatch.setattr(compliant, "LARGEST_PHASE_STEP", fine)
        plant = PLANTS["compliant"](
            card, card.home, PERIOD, options=options(frequency=w, damping=z, gravity=0)
        )
        state, apart = np.zeros(3), []
        for rate in rates:
            plant.run(np.array([rate]))
            state = Phi @ state + Gamma * rate
            apart.append([plant.posture[0] - state[1], (plant.rates[0] - state[2]) / w])
        plant.close()
        errors.append(np.abs(apart).max(axis=0) * plant.step**-2)
    np.testing.assert_allclose(errors[0], errors[1], rtol=0.15)


@pytest.mark.parametrize("share", [0.0, 0.7])
@pytest.mark.parametrize("joint", range(7))
def test_each_joint_sags_by_what_it_weighs(joint, share, one_joint):
    """Lying on its side and turned by its motor: k (theta - q) = (1 - share) G(q)."""
    import pinocchio

    card = one_joint(joint)
    plant = PLANTS["compliant"](
        card, card.home, PERIOD, SIDEWAYS, options(frequency=30, damping=1, gravity=share)
    )
    before = plant.motor[0] - plant.posture[0]
    for rate in [1.0] * 50 + [0.0] * 100:
        plant.run(np.array([rate]))
    plant.close()
    model = Kinematics(card).model
    model.gravity.linear = SIDEWAYS.gravity
    believed = Dynamics(Kinematics(card)).weight(plant.posture)[0]
    weight = pinocchio.computeGeneralizedGravity(model, model.createData(), plant.posture)[0]
    sag = (weight - share * believed) / plant.stiffness[0]
    wound = plant.motor[0] - plant.posture[0]
    assert wound == pytest.approx(sag, rel=0.01, abs=1e-7)
    assert before != pytest.approx(wound, rel=0.05, abs=1e-7) or joint == 6  # it moved away
    assert np.abs(plant.rates).max() < 1e-6


def spectral_radius(gain, Phi, Gamma):
    return np.abs(np.linalg.eigvals(Phi - gain * np.outer(Gamma, [0, 1, 0]))).max()


@pytest.mark.parametrize(("w", "z", "damper"), [
    (40.0, 0.7, "motor"), (40.0, 0.7, "ground"), (80.0, 0.3, "motor"), (60.0, 0.1, "ground"),
])  # fmt: skip
def test_a_loop_becomes_unstable_where_its_polynomial_says(w, z, damper, one_joint):
    """u = -gain q once a period: the largest root of det(z - Phi + gain Gamma C) crosses 1."""
    card = one_joint(0)
    inertia = Dynamics(Kinematics(card)).inertia(card.home)[0, 0]
    chosen = options(frequency=w, damping=z, gravity=0, damper=damper)
    d = 2 * z * w * inertia
    system = discrete(inertia, w**2 * inertia, d, 0.0, damper == "ground", PERIOD)
    low, high = 0.1, 1000.0
    while high - low > 1e-4:
        gain = (low + high) / 2
        low, high = (gain, high) if spectral_radius(gain, *system) < 1 else (low, gain)

    def grows(gain):
        plant = PLANTS["compliant"](card, np.array([1e-6]), PERIOD, options=chosen)
        path = []
        for _ in range(400):
            plant.run(-gain * plant.posture)
            path.append(abs(plant.posture[0]))
        plant.close()
        return max(path[300:]) > max(path[100:200])

    assert not grows(0.95 * low)
    assert grows(1.05 * low)


def test_the_whole_arm_rests_on_its_springs():
    """It begins in balance, payload included, and sags between two postures as it should."""
    start = IIWA.home + 0.1
    world = World(payloads=(Payload(2.0, 0.03),))
    plant = PLANTS["compliant"](IIWA, start, PERIOD, world, options(frequency=80, gravity=0.7))
    for _ in range(25):
        plant.run(np.zeros(7))
    np.testing.assert_allclose(plant.posture, start, atol=1e-9)
    for rate in [0.3] * 100 + [0.0] * 200:
        plant.run(rate * np.array([1, 0.5, -1, 0.5, 1, 0.4, 1]))
    arm = Kinematics(IIWA)
    x, J = arm.pose_and_jacobian(plant.posture)
    p = dq.translation(x)
    weight = Dynamics(arm).weight(plant.posture)
    load = J.T @ np.concatenate([np.cross(p, [0, 0, 1]), [0, 0, 1]]) * 2.0 * 9.81
    sag = (0.3 * weight + load) / plant.stiffness
    np.testing.assert_allclose(plant.motor - plant.posture, sag, rtol=0.01, atol=1e-6)
    np.testing.assert_allclose(plant.effort, weight + load, rtol=0.01, atol=1e-3)
    plant.close()


def test_full_compensation_leaves_no_sag_and_an_erring_one_does():
    plants = [
        PLANTS["compliant"](IIWA, IIWA.home, PERIOD, World(model_gravity=m), options(gravity=1.0))
        for m in (1.0, 1.2)
    ]
    exact, wrong = (plant.motor - plant.posture for plant in plants)
    np.testing.assert_allclose(exact, 0, atol=1e-12)
    np.testing.assert_allclose(
        wrong * plants[1].stiffness, -0.2 * Dynamics(Kinematics(IIWA)).weight(IIWA.home), atol=1e-9
    )
    for plant in plants:
        plant.close()


def test_encoders_sit_where_they_are_told():
    rates = np.array([0.1, 0.2, 0.1, -0.2, 0.1, 0.1, 0.1])
    joint, motor = (
        PLANTS["compliant"](IIWA, IIWA.home, PERIOD, options=options(encoder=side))
        for side in ("joint", "motor")
    )
    for plant in (joint, motor):
        for _ in range(10):
            plant.run(rates)
    np.testing.assert_array_equal(joint.encoder, joint.posture)
    np.testing.assert_array_equal(motor.encoder, motor.motor)
    np.testing.assert_array_equal(motor.encoder_rates, rates)
    np.testing.assert_array_equal(joint.posture, motor.posture)
    assert np.abs(motor.encoder - motor.posture).max() > 1e-3
    joint.close()
    motor.close()


def test_a_motor_at_its_torque_winds_no_further():
    limits = IIWA.limits.model_copy(update={"effort_Nm": (320, 320, 176, 45, 110, 40, 40)})
    card = IIWA.model_copy(update={"limits": limits})
    plant = PLANTS["compliant"](card, card.home, PERIOD)
    for _ in range(60):
        plant.run(np.array([0, 0, 0, -8.0, 0, 0, 0]))
        assert np.abs(plant.effort[3]) <= 45
    added = 0.7 * Dynamics(Kinematics(card)).weight(plant.posture)[3]
    assert abs(plant.effort[3]) == 45
    wound = plant.stiffness[3] * (plant.motor - plant.posture)[3] + added
    assert abs(wound) <= 45 + 1.0  # `added` was of the posture a period ago
    plant.close()


@pytest.mark.parametrize(("text", "said"), [
    ("compliant:frequency=0", "plant 'compliant': frequency 0.0"),
    ("compliant:gravity=2", "gravity 2.0 .*1"),
    ("compliant:stiffness=3/x", "stiffness '3/x'"),
    ("compliant:stiffness=-3", "stiffness -3.0"),
    ("compliant:damper=air", "damper 'air'"),
    ("compliant:k=3", "'k'"),
    ("compliant:frequency=40,frequency=50", "'frequency=50'"),
    ("stiff:frequency=3", "'stiff' takes no"),
    ("compliant frequency=3", "NAME:KEY=VALUE"),
])  # fmt: skip
def test_bad_values_are_refused(text, said):
    with pytest.raises(UsageError, match=said):
        choose_plant(text, "rates")


def test_springs_that_do_not_fit_the_arm_are_refused():
    for text, said in (
        ("compliant:stiffness=300/200", "stiffness has 2 numbers.* 7 joints"),
        ("compliant:stiffness=1e9", "iiwa need physics steps of .* us"),
    ):
        with pytest.raises(UsageError, match=said):
            choose_plant(text, "rates")(IIWA, IIWA.home, PERIOD, World())


def test_the_summary_shows_the_springs():
    chosen = choose_plant("compliant:stiffness=900/900/500/500/100/50/10,damping=0.2", "rates")
    shown = chosen.summary(IIWA)
    assert chosen.name.startswith("compliant:stiffness=900")
    assert shown["stiffness_Nm_rad"] == [900, 900, 500, 500, 100, 50, 10]
    inertia = np.diag(Dynamics(Kinematics(IIWA)).inertia(IIWA.home))
    np.testing.assert_allclose(
        shown["damping_Nm_s_rad"], 0.4 * np.sqrt(inertia * shown["stiffness_Nm_rad"])
    )
