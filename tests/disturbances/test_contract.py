"""What every disturbance promises: it changes the run, repeats, vanishes, and is reported."""

from itertools import pairwise

import numpy as np
import pytest

from dqpaint import api, dq
from dqpaint.cli.report import of_painting
from dqpaint.controllers import CONTROLLERS
from dqpaint.controllers.base.controller import Controller
from dqpaint.controllers.laws.pereira.p import RateGains
from dqpaint.disturbances import DISTURBANCES, make_disturbances
from dqpaint.errors import UsageError
from dqpaint.language import parse
from dqpaint.metrics.run_metrics import measure
from dqpaint.motion import plan
from dqpaint.outputs.summary import summarise
from dqpaint.planning.reachability import reachable_start_posture
from dqpaint.plants import choose_plant
from dqpaint.plants.plant import PLANTS
from dqpaint.robots.kinematics.dynamics import Dynamics
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.simulation.closed_loop import track
from tests.support.control import ACCEL
from tests.support.disturbances import SIZES

CARD = read_card("iiwa")
ARM = Kinematics(CARD)
TEXT = "period 10 ms\nstart at (40, 0) mm\narc centre (0, 0) angle 90 deg in 0.6 s\nhold 0.2 s\n"
MOTION = plan(parse(TEXT, "t.traj"), CARD.canvas.pose)
START = CARD.home + np.array([0.1, -0.1, 0.15, 0.1, -0.2, 0.1, 0.3])

NEAR_HALF_A_TURN = {"adversary"}  # nothing elsewhere: see controllers/test_signs
EVERY = pytest.mark.parametrize("name", sorted({*DISTURBANCES} - NEAR_HALF_A_TURN))


def run(disturb, plant=None, seed=0, law=None):
    law = law or (ACCEL if plant == "torque" else CONTROLLERS["hinf"])
    chosen = choose_plant(plant, "torque" if law.drives_torque else "rates")
    return track(
        MOTION, ARM, START, chosen, law, law.read_gains({}),
        disturbances=make_disturbances(disturb), seed=seed,
    )  # fmt: skip


def plant_for(name):
    needs = DISTURBANCES[name].needs
    return {None: "ideal", "masses": "stiff", "a model of gravity": "compliant"}[needs]


def test_every_disturbance_has_a_size_here():
    assert {*SIZES} | NEAR_HALF_A_TURN == {*DISTURBANCES}


@pytest.mark.slow
@EVERY
def test_it_vanishes_at_size_zero(name):
    zero = {key: 0 for key in SIZES[name] if key != "form"}
    try:
        given = make_disturbances({name: zero})
    except UsageError:
        assert name in ("twist", "offset")  # it says itself that it has no effect
        return
    assert given
    plain, none = run({}, plant_for(name)), run({name: zero}, plant_for(name))
    for field in ("posture", "pose", "measured_posture", "measured_pose", "command", "effort"):
        np.testing.assert_array_equal(getattr(plain, field), getattr(none, field))


@pytest.mark.slow
@EVERY
def test_it_is_told_in_the_summary(name, tmp_path):
    file = tmp_path / "t.traj"
    file.write_text(TEXT)
    painting = api.draw(
        file, plant=plant_for(name), disturb={name: SIZES[name]}, seed=3, size=(64, 48)
    )
    told = summarise(painting)
    assert SIZES[name].items() <= told["disturbances"][name].items()
    assert told["seed"] == 3
    assert f"disturbed by       {name}  " in of_painting(painting, [])


@EVERY
def test_one_that_cannot_show_is_refused(name):
    needs = DISTURBANCES[name].needs
    for plant in PLANTS:
        chosen = choose_plant(plant, PLANTS[plant].takes)
        if needs is None or needs in PLANTS[plant].traits:
            chosen.require_trait(needs, name)
        else:
            with pytest.raises(UsageError, match=f"'{name}' has no effect on plant '{plant}'"):
                chosen.require_trait(needs, name)


@pytest.mark.parametrize(("name", "values", "said"), [
    ("noise", {"rms": -1e-3}, "rms -0.001"),
    ("latency", {"": 1.5}, "periods 1.5"),
    ("payload", {"": "heavy"}, "mass 'heavy'"),
    ("push", {"at": 3.0}, "'at'"),
    ("base", {"x": float("inf")}, "x inf"),
])  # fmt: skip
def test_bad_values_are_refused(name, values, said):
    with pytest.raises(UsageError, match=said):
        make_disturbances({name: values})


@pytest.mark.parametrize(("values", "said"), [
    ({"x": 5.0, "link": 8, "start": 0.1}, "link 8, .* 7 links"),
    ({"x": 5.0, "start": 3.0}, r"3 s, .*0\.8 s"),
])  # fmt: skip
def test_a_push_that_meets_nothing_is_refused(values, said):
    with pytest.raises(UsageError, match=said):
        run({"push": values}, "stiff")


# What each of them does, against what it should.


def test_noise_has_its_rms_and_steps_their_size():
    noisy = run({"noise": {"rms": 2e-4}}, "ideal")
    errors = noisy.measured_posture - noisy.posture
    np.testing.assert_allclose(errors.std(), 2e-4, rtol=0.1)
    assert np.abs(np.corrcoef(errors[:-1].ravel(), errors[1:].ravel())[0, 1]) < 0.15
    stepped = run({"noise": {"step": 1e-3}}, "ideal")
    np.testing.assert_allclose(
        stepped.measured_posture / 1e-3, np.round(stepped.measured_posture / 1e-3), atol=1e-9
    )
    assert 3e-4 < np.abs(stepped.measured_posture - stepped.posture).max() <= 0.5e-3 + 1e-12


def test_speeds_are_told_as_the_readings_say():
    """On the ideal arm the true rate is the last difference: the read one is that of readings."""
    told = []
    spy = Controller("spy", "none", RateGains, lambda seen, _g: told.append(seen) or np.zeros(6))
    run({"noise": {"rms": 1e-4}}, "ideal", law=spy)
    for before, now in pairwise(told[1:]):
        slope = (now.posture - before.posture) / MOTION.period
        np.testing.assert_allclose(now.rates, slope, atol=1e-9)


def test_the_light_and_its_error_are_the_true_ones():
    noisy = run({"noise": {"rms": 1e-3}}, "ideal")
    np.testing.assert_allclose(
        dq.matrix_from_pose(noisy.pose), dq.matrix_from_pose(ARM.poses(noisy.posture)), atol=1e-12
    )
    np.testing.assert_allclose(
        dq.matrix_from_pose(noisy.measured_pose),
        dq.matrix_from_pose(ARM.poses(noisy.measured_posture)),
        atol=1e-12,
    )
    assert np.abs(noisy.pose - noisy.measured_pose).max() > 1e-3


def test_the_table_has_what_was_told_beside_what_is_true():
    plain, noisy, wrong = (
        measure(run(given, "ideal")).table
        for given in ({}, {"noise": {"rms": 1e-3}}, {"links": {"part": 0.01}})
    )
    assert "read1_rad" not in plain
    assert "believed_x_m" not in plain
    assert 1e-4 < np.abs(noisy["read3_rad"] - noisy["q3_rad"]).max() < 1e-2
    assert "read1_rad" not in wrong
    assert np.abs(wrong["believed_x_m"] - wrong["x_m"]).max() > 1e-3


@pytest.mark.parametrize("plant", ["ideal", pytest.param("torque", marks=pytest.mark.slow)])
def test_late_commands_come_late(plant):
    late, plain = run({"latency": {"periods": 3}}, plant), run({}, plant)
    if plant == "ideal":
        moved = np.diff(late.posture, axis=0) / MOTION.period
        np.testing.assert_array_equal(moved[:3], 0)
        np.testing.assert_allclose(moved[3:], late.command[:-4], atol=1e-12)
    else:  # held by what it weighs
        assert np.abs(late.posture[3] - START).max() < 1e-6
    assert np.abs(late.posture[4] - START).max() > 1e-5
    assert np.abs(plain.posture[3] - START).max() > 1e-5


def test_wrong_lengths_are_of_their_size_and_the_law_s_alone(rng):
    model = make_disturbances({"links": {"part": 0.05, "offset": 0.003}})["links"]
    wrong = [model.law_model(ARM, np.random.default_rng(seed)) for seed in range(200)]
    stretched = np.array([arm.lengths for arm in wrong]) - ARM.lengths
    far = np.linalg.norm(ARM.lengths, axis=1) > 0.05
    along = (stretched * ARM.lengths).sum(-1)[:, far] / (ARM.lengths**2).sum(-1)[far]
    size = np.sqrt(0.05**2 + 0.003**2 / (ARM.lengths**2).sum(-1)[far])
    np.testing.assert_allclose(along.std(axis=0), size, rtol=0.15)
    ran = run({"links": {"part": 0.01}}, "ideal")
    np.testing.assert_allclose(ran.points, dq.translation(ARM.poses(ran.posture)), atol=1e-12)
    settled = dq.translation(ran.measured_pose)[-1] - MOTION.points[-1]
    assert np.linalg.norm(settled) < 1e-3  # the law thinks it is there
    assert np.linalg.norm(ran.points[-1] - MOTION.points[-1]) > 2e-3


def test_a_believed_arm_s_jacobian_goes_with_its_poses(rng):
    q, h = rng.uniform(-1, 1, 7), 1e-6
    wrong = ARM.with_model_error(lengths=rng.normal(size=(8, 3)) * 0.02)
    _, J = wrong.pose_and_jacobian(q)
    for joint in range(7):
        step = h * np.eye(7)[joint]
        slope = 2 * dq.log(dq.mul(wrong.pose(q + step), dq.conj(wrong.pose(q - step)))) / (2 * h)
        np.testing.assert_allclose(slope, J[:, joint], atol=1e-8)


def test_a_displaced_base_carries_the_light_along():
    """A settled law puts the light at B times the asked pose: B is the base's displacement."""
    values = {"x": 0.02, "y": -0.01, "z": 0.005, "wx": 0.03, "wy": -0.02, "wz": 0.05}
    ran = run({"base": values}, "ideal")
    turn = np.array([values[k] for k in ("wx", "wy", "wz")])
    from_pin = pytest.importorskip("pinocchio").exp3(turn)
    t = np.array([values[k] for k in ("x", "y", "z")])
    np.testing.assert_allclose(
        ran.points, dq.translation(ran.measured_pose) @ from_pin.T + t, atol=1e-12
    )
    turned = dq.matrix_from_pose(ran.pose)[:, :3, :3]
    np.testing.assert_allclose(
        turned, from_pin @ dq.matrix_from_pose(ran.measured_pose)[:, :3, :3], atol=1e-12
    )


@pytest.mark.slow
def test_a_turned_base_leaves_gravity_upright():
    """The stiff arm's motors at rest bear the weight as seen from the turned base."""
    import pinocchio

    still = plan(parse("period 10 ms\nhold 0.3 s\n", "t.traj"), CARD.canvas.pose)
    law = Controller("still", "none", RateGains, lambda seen, _g: np.zeros(6))
    ran = track(
        still, ARM, CARD.home, PLANTS["stiff"], law, law.read_gains({}),
        disturbances=make_disturbances({"base": {"wx": 0.5, "wz": 1.0}}), null="none",
    )  # fmt: skip
    model = pinocchio.Model(ARM.model)
    R = pinocchio.exp3(np.array([0.5, 0, 1.0]))
    model.gravity.linear = R.T @ ARM.model.gravity.linear
    weight = pinocchio.computeGeneralizedGravity(model, model.createData(), ran.posture[-1])
    np.testing.assert_allclose(ran.effort[-1], weight, atol=0.05)
    assert np.abs(weight - Dynamics(ARM).weight(ran.posture[-1])).max() > 5


@pytest.mark.slow
def test_a_payload_weighs_where_the_light_is():
    law = Controller("still", "none", RateGains, lambda seen, _g: np.zeros(6))
    still = plan(parse("period 10 ms\nhold 0.3 s\n", "t.traj"), CARD.canvas.pose)
    efforts = [
        track(
            still, ARM, START, PLANTS["stiff"], law, law.read_gains({}), null="none",
            disturbances=make_disturbances(given),
        ).effort[-1]
        for given in ({}, {"payload": {"mass": 3.0}})
    ]  # fmt: skip
    x, J = ARM.pose_and_jacobian(START)
    p = dq.translation(x)
    up = np.concatenate([np.cross(p, [0, 0, 1.0]), [0, 0, 1.0]])  # the wrench that bears 1 N
    np.testing.assert_allclose(efforts[1] - efforts[0], 3.0 * 9.81 * J.T @ up, atol=0.05)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "law", "mass", "close"), [
    ("xarm6", "accel", 0.3, 1e-6), ("xarm6", "accel-decoupled", 0.3, 1e-6),
    ("viper850", "accel", 0.02, 1e-6), ("panda", "accel", 0.3, 0.01),  # spare joint still settling
])  # fmt: skip
def test_a_payload_a_torque_law_knows_nothing_of_is_borne_by_its_error(name, law, mass, close):
    """At rest H J^+ a bears J' F, so that the commanded a = 2 Kp log x_e is J H^-1 J' F.

    A light wrist gives way more than the whole arm's weight lets expect: on the iiwa 2 kg move the
    light by 60 to 130 mm at Kp = 400, as though the arm weighed 0.6 kg there.
    """
    arm = Kinematics(read_card(name))
    text = "period 2 ms\nstart at (30, -40, 20) mm tool rot(x, 15 deg)\nhold 3 s\n"
    motion = plan(parse(text, "t.traj"), arm.card.canvas.pose)
    chosen = CONTROLLERS[law]
    run = track(
        motion, arm, reachable_start_posture(motion, arm).posture, PLANTS["torque"], chosen,
        chosen.read_gains({}),
        disturbances=make_disturbances({"payload": {"mass": mass}}),
    )  # fmt: skip
    x, J = arm.pose_and_jacobian(run.posture[-1])
    p, down = dq.translation(x), np.array([0, 0, -9.81 * mass])
    weight = J.T @ np.concatenate([np.cross(p, down), down])
    a = -J @ np.linalg.solve(Dynamics(arm).inertia(run.posture[-1]), weight)
    if law == "accel":
        wanted = 400 * 2 * dq.log(dq.mul(dq.nearest(motion.pose[-1], x), dq.conj(x)))
    else:
        away = motion.points[-1] - p
        a, wanted = a[3:] + np.cross(a[:3], p), 400 * away
    assert not run.clamps
    assert np.linalg.norm(motion.points[-1] - p) > 1e-3
    np.testing.assert_allclose(a, wanted, atol=close * np.abs(wanted).max())


@pytest.mark.slow
@pytest.mark.parametrize("link", [0, 4])
def test_a_push_is_a_force_at_its_place_for_its_time(link):
    """On the torque-driven arm: what changes in a step is H^-1 J' F by pinocchio."""
    import pinocchio

    force, begin, lasts = np.array([20.0, -30.0, 15.0]), 0.05, 0.004
    push = {"x": 20.0, "y": -30.0, "z": 15.0, "link": link, "start": begin, "seconds": lasts}
    still = plan(parse("period 1 ms\nhold 0.07 s\n", "t.traj"), CARD.canvas.pose)
    weigh = Controller("weigh", "none", RateGains, lambda seen, _g: seen.bias, "torque")
    plain, pushed = (
        track(still, ARM, START, PLANTS["torque"], weigh, weigh.read_gains({}),
              disturbances=make_disturbances(given))
        for given in ({}, {"push": push})
    )  # fmt: skip
    apart = np.abs(pushed.posture - plain.posture).max(axis=1)
    assert apart[:51].max() == 0  # it begins with the step from 50 ms on
    assert apart[51] > 0
    if link:
        data = ARM.model.createData()
        pinocchio.computeJointJacobians(ARM.model, data, START)
        J = pinocchio.getJointJacobian(ARM.model, data, link, pinocchio.LOCAL_WORLD_ALIGNED)
        joint = data.oMi[link]
        lever = joint.rotation @ ARM.model.inertias[link].lever
        tau = J[:3].T @ force + J[3:].T @ np.cross(lever, force)
    else:
        x, J = ARM.pose_and_jacobian(START)
        tau = J.T @ np.concatenate([np.cross(dq.translation(x), force), force])
    bend = np.linalg.solve(Dynamics(ARM).inertia(START), tau)
    np.testing.assert_allclose(
        (pushed.posture - plain.posture)[51] / 1e-6, bend, rtol=0.01, atol=0.02 * np.abs(bend).max()
    )
    rate = np.diff(pushed.posture - plain.posture, axis=0)[:, np.abs(bend).argmax()]
    gain = np.abs(np.diff(rate))[[50, 51, 52, 53, 55, 60]]
    assert gain[:3].min() > 20 * gain[4:].max()  # and ends after four steps


@pytest.mark.slow
def test_gravity_that_errs_pulls_a_torque_driven_arm_off():
    """Held by Kp: J' F = error G, so the error grows with it."""
    small, large = (
        np.abs(run({"gravity": {"error": e}}, "torque").points - run({}, "torque").points).max()
        for e in (0.05, 0.1)
    )
    assert large == pytest.approx(2 * small, rel=0.1)
    assert small > 1e-3
