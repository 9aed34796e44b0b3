"""What a law says -> what an arm is told: against pinocchio's forward dynamics."""

import numpy as np
import pinocchio
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS, commands
from dqpaint.controllers.base.user_controller import make_controller
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics.dynamics import Dynamics
from dqpaint.robots.kinematics.jacobians import drift_acceleration
from dqpaint.robots.kinematics.nullspace import make_secondary_task
from dqpaint.simulation.drives import make_drive
from tests.support.control import ARM, law, seen_by, started, states

TORQUE_LAWS = [name for name, c in CONTROLLERS.items() if c.drives_torque]
AT_ONCE = 1e-13  # [s], a period in which nothing changes


def back_to(posture):
    """The wish to come back to a posture, as a run has it."""
    return make_secondary_task("start", ARM.card, posture)


def bend(posture, rates, torque):
    """Joint accelerations of the arm of the file, viscous friction in its joints."""
    data = ARM.model.createData()
    felt = torque - ARM.model.damping * rates
    return pinocchio.aba(ARM.model, data, posture, rates, felt)


@pytest.mark.parametrize("name", TORQUE_LAWS)
def test_the_tool_accelerates_as_the_law_says(name, rng):
    """J q_ddot + J_dot q_dot = a, with q_ddot by pinocchio and J_dot by differences."""
    drive = make_drive(
        CONTROLLERS[name], [started(CONTROLLERS[name])], ARM, back_to(ARM.card.home), AT_ONCE
    )
    gains, h = CONTROLLERS[name].read_gains({}).first, 1e-6
    for seen in states(rng, 50, size=0.5):
        q_ddot = bend(seen.posture, seen.rates, drive.command(seen, gains))
        later, earlier = (ARM.pose_and_jacobian(seen.posture + s * seen.rates)[1] for s in (h, -h))
        got = seen.jacobian @ q_ddot + (later - earlier) / (2 * h) @ seen.rates
        wanted = law(name)(seen)
        np.testing.assert_allclose(got, wanted, atol=1e-6 * np.abs(wanted).max())


def test_the_drift_acceleration_is_the_jacobian_s_derivative_times_the_rates(rng):
    for seen in states(rng, 20):
        h = 1e-6
        later, earlier = (ARM.pose_and_jacobian(seen.posture + s * seen.rates)[1] for s in (h, -h))
        wanted = (later - earlier) / (2 * h) @ seen.rates
        assert np.abs(wanted).max() > 1e-2
        found = drift_acceleration(seen.jacobian, seen.rates)
        np.testing.assert_allclose(found, wanted, atol=1e-8)


@pytest.mark.parametrize("name", TORQUE_LAWS)
def test_what_is_free_in_a_redundant_arm_is_damped(name, rng):
    """In the null space q_ddot = 4 (start - q) - 4 q_dot: back to where it began, and at rest."""
    start = ARM.card.home + rng.uniform(-0.1, 0.1, 7)
    drive = make_drive(
        CONTROLLERS[name], [started(CONTROLLERS[name])], ARM, back_to(start), AT_ONCE
    )
    gains = CONTROLLERS[name].read_gains({}).first
    for seen in states(rng, 20):
        null = np.linalg.svd(seen.jacobian)[2][-1]
        q_ddot = bend(seen.posture, seen.rates, drive.command(seen, gains))
        wanted = null @ (4.0 * (start - seen.posture) - 4.0 * seen.rates)
        assert null @ q_ddot == pytest.approx(wanted, abs=1e-6 * np.abs(q_ddot).max())


@pytest.mark.parametrize("name", TORQUE_LAWS)
def test_a_swinging_elbow_comes_to_rest_while_the_tool_stays(name):
    goal, J = ARM.pose_and_jacobian(ARM.card.home)
    null = np.linalg.svd(J)[2][-1]
    gains, period = CONTROLLERS[name].read_gains({}).first, 0.005
    drive = make_drive(
        CONTROLLERS[name], [started(CONTROLLERS[name])], ARM, back_to(ARM.card.home), period
    )
    plant = PLANTS["torque"](ARM.card, ARM.card.home, period)
    plant.run(drive.clip(400.0 * null, ARM.card.home))  # a knock along the self-motion
    swing, away = [], []
    for _ in range(800):
        seen = seen_by(ARM, plant.posture, goal)._replace(rates=plant.rates)
        swing.append(np.abs(plant.rates).max())
        away.append(np.abs(plant.posture - ARM.card.home).max())
        plant.run(drive.command(seen, gains))
    plant.close()
    assert max(away) > 0.1
    assert swing[-1] < 0.02 * max(swing)
    assert away[-1] < 0.02 * max(away)
    assert np.abs(dq.log(dq.mul(ARM.pose(plant.posture), dq.conj(goal)))).max() < 1e-5


def test_a_light_joint_gains_what_it_is_asked_in_a_whole_period():
    """Its friction takes hold within the period: with that of the beginning it gains 0.4 of it."""
    q, wanted, period = ARM.card.home, np.array([0, 0, 0, 0, 0, 0, 8.0]), 0.005
    plant = PLANTS["torque"](ARM.card, q, period)
    plant.run(Dynamics(ARM).torque(q, np.zeros(7), wanted, period))
    plant.close()
    assert plant.rates[6] / period == pytest.approx(8.0, rel=0.15)


def test_an_own_torque_law_holds_by_the_bias_and_is_not_resolved(rng):
    """tau = bias leaves no acceleration; the inertia is whole and pinocchio's."""

    @commands("torque")
    def hold(seen):
        kept.append(seen)
        return seen.bias

    kept, chosen = [], make_controller(hold, "hold")
    drive = make_drive(chosen, [started(chosen)], ARM, lambda *_: np.zeros(7), 0.005)
    for seen in states(rng, 10):
        q, rates = seen.posture, seen.rates
        torque = drive.command(seen, chosen.read_gains({}).first)
        np.testing.assert_allclose(bend(q, rates, torque), 0, atol=1e-8)
        data = ARM.model.createData()
        still = pinocchio.rnea(ARM.model, data, q, rates, np.zeros(7))
        np.testing.assert_allclose(torque, still + ARM.model.damping * rates, atol=1e-9)
        columns = [
            pinocchio.rnea(ARM.model, data, q, rates, one).copy() - still for one in np.eye(7)
        ]
        np.testing.assert_allclose(kept[-1].inertia, np.stack(columns, axis=1), atol=1e-9)


def test_torques_stay_within_the_motors():
    name = TORQUE_LAWS[0]
    drive = make_drive(
        CONTROLLERS[name], [started(CONTROLLERS[name])], ARM, lambda *_: np.zeros(7), 0.005
    )
    effort = ARM.card.effort
    wanted = np.array([9.0, -9.0, 0.5, -0.5, 2.0, -2.0, 0.0]) * effort
    np.testing.assert_allclose(
        drive.clip(wanted, ARM.card.home), np.array([1, -1, 0.5, -0.5, 1, -1, 0]) * effort
    )


def test_what_a_law_sees_of_the_twist_is_the_jacobian_s(rng):
    for seen in states(rng, 5):
        np.testing.assert_allclose(seen.twist, seen.jacobian @ seen.rates, atol=1e-12)
