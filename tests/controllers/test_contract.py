"""What every control law promises, whoever wrote it, on every arm there is."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS, Seen
from dqpaint.errors import UnknownNameError, UsageError
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics.jacobians import pose_map
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.kinematics.nullspace import make_secondary_task
from dqpaint.robots.model.card import installed_names, read_card
from dqpaint.simulation.drives import make_drive
from dqpaint.testing.controllers import left_over
from tests.support.control import ARM, STILL, body_sees, law, seen_by, started
from tests.support.random_poses import random_poses

LAWS = pytest.mark.parametrize("name", CONTROLLERS)
DAILY = ("iiwa", "viper850")  # of seven joints and of six; the others take their time
ROBOTS = pytest.mark.parametrize("robot", [
    pytest.param(name, marks=[pytest.mark.slow] * (name not in DAILY)) for name in installed_names()
])  # fmt: skip
SHAPES = {"twist": 6, "acceleration": 6, "rates": 7, "torque": 7}


@LAWS
def test_signs_of_poses_do_not_matter(name, rng):
    for x_d in random_poses(rng, 20):
        seen = seen_by(ARM, rng.uniform(-1, 1, 7), x_d, rng)
        u = first_command(name, seen)
        assert u.shape == (SHAPES[CONTROLLERS[name].commands],)
        scale = np.abs(u).max()
        for other in (seen._replace(pose=-seen.pose), seen._replace(pose_d=-x_d)):
            np.testing.assert_allclose(first_command(name, other), u, atol=1e-11 * scale)


def first_command(name, seen):
    """Of a law that has just been started, and remembers nothing."""
    return law(name)(seen)


@pytest.mark.parametrize("name", [name for name, one in CONTROLLERS.items() if one.batched])
def test_a_batch_is_the_same_as_one_by_one(name, rng):
    rows = [seen_by(ARM, rng.uniform(-1, 1, 7), x, rng) for x in random_poses(rng, 6)]
    rows = [row._replace(row=15 * i) for i, row in enumerate(rows)]
    alone = np.array([first_command(name, row) for row in rows])
    many = [f for f in Seen._fields if getattr(rows[0], f) is not None and f not in SINGLE]
    stacked = {f: np.array([getattr(row, f) for row in rows]) for f in many}
    together = first_command(name, rows[0]._replace(**stacked))
    np.testing.assert_allclose(together, alone, rtol=1e-10, atol=1e-9)
    shaped = {f: a.reshape(2, 3, *a.shape[1:]) for f, a in stacked.items()}
    folded = first_command(name, rows[0]._replace(**shaped))
    np.testing.assert_allclose(folded, together.reshape(2, 3, -1), rtol=1e-12, atol=1e-12)


SINGLE = ("time", "period", "inertia", "bias", "limits", "signed", "clipped")


@LAWS
@ROBOTS
def test_commands_are_finite_everywhere(name, robot, rng):
    """Of the law, and what its drive makes of it; singular postures, antipodal rotations."""
    arm = Kinematics(read_card(robot))
    chosen = CONTROLLERS[name]
    gains, said = chosen.read_gains({}).first, started(chosen, arm)
    drive = make_drive(
        chosen, [said], arm, make_secondary_task("start", arm.card, arm.card.home), 0.005
    )
    special = [np.zeros(arm.card.joints), arm.card.home, arm.card.lower, arm.card.upper]
    for q in [*special, *rng.uniform(arm.card.lower, arm.card.upper, (20, arm.card.joints))]:
        x = arm.pose(q)
        axis = rng.normal(size=3)
        half_turn = np.concatenate([axis / np.linalg.norm(axis) * np.pi, rng.normal(size=3)])
        for x_d in (x, -x, dq.mul(dq.exp(half_turn / 2), x), *random_poses(rng, 3)):
            seen = seen_by(arm, q, x_d, rng)
            assert np.isfinite(said(seen, gains)).all()
            wanted = drive.command(seen, gains)
            assert wanted.shape == q.shape
            assert np.isfinite(wanted).all()
            assert np.isfinite(drive.clip(wanted, q)).all()


@LAWS
@ROBOTS
def test_every_law_converges_on_a_set_point(name, robot, rng):
    """On the arm it commands: the ideal one, or rigid bodies under torques."""
    arm = Kinematics(read_card(robot))
    chosen, gains = CONTROLLERS[name], CONTROLLERS[name].read_gains({}).first
    goal, said = arm.pose(arm.card.home), started(chosen, arm, STILL)
    start = arm.card.home + rng.uniform(-0.3, 0.3, arm.card.joints)
    start = np.clip(start, arm.card.lower, arm.card.upper)
    period, seconds = 0.005, 3.0
    if name == "pham-t":  # as slow as its weakest mode
        x, J = arm.pose_and_jacobian(arm.card.home)
        seconds = 16.0 / (gains.k * np.linalg.svd(pose_map(x) @ J)[1][5] ** 2)
        period = 0.008
    drive = make_drive(chosen, [said], arm, make_secondary_task("start", arm.card, start), period)
    plant = PLANTS["torque" if chosen.drives_torque else "ideal"](arm.card, start, period)
    for _ in range(int(seconds / period)):
        q = plant.posture
        x, J = arm.pose_and_jacobian(q)
        zero = np.zeros(6)
        seen = Seen(x, -goal, zero, zero, J, q, 0.0, period, plant.rates)
        plant.run(drive.command(seen, gains))
    reached = arm.pose(plant.posture)
    plant.close()
    assert left_over(chosen, reached, goal) < CHATTER.get(name, 4e-6)


CHATTER = {"super-twisting": 2e-4}  # L T^2, in rotation 1e-5, and what that moves far out


@pytest.mark.parametrize("name", sorted({*CONTROLLERS} - {"p-least-squares", "adaptive", "mpc"}))
def test_the_long_way_round_is_never_taken(name):
    """From 170 degrees away about x, the tool turns back through 170, not on through 190."""
    x_d = dq.pose_from([0.4, 0.1, 0.3], [1.0, 0, 0, 0])
    angle = np.radians(170)
    for sign in (1, -1):
        x = sign * dq.pose_from([0.4, 0.1, 0.3], [np.cos(angle / 2), np.sin(angle / 2), 0, 0])
        for side in (x_d, -x_d):
            about_x = law(name)(body_sees(x, side))[0]
            if CONTROLLERS[name].controls in ("pose", "orientation"):
                assert about_x < -0.1
            else:
                assert about_x == pytest.approx(0, abs=1e-12)


@LAWS
def test_every_law_says_what_it_is(name):
    chosen = CONTROLLERS[name]
    assert chosen.summary
    assert chosen.source
    chosen.gains()
    for gain, field in chosen.gains.model_fields.items():
        assert field.description, gain
        assert gain in chosen.list_gains()
    assert ("tau" if chosen.drives_torque else "q_dot = ") in chosen.law.__doc__


EVERY_GAIN = [(name, gain) for name, c in CONTROLLERS.items() for gain in c.gains.model_fields]


@pytest.mark.parametrize(("name", "gain"), EVERY_GAIN)
@pytest.mark.parametrize(
    "value",
    [-1.0, float("nan"), float("inf"), "20deg", "20Hz", "20 mm", "fast", "-3..5@10%", "2.."],
)
def test_bad_gains_are_refused_with_the_law_s_own_list(name, gain, value):
    chosen = CONTROLLERS[name]
    with pytest.raises(UsageError, match=f"'{gain}' .*'{name}' ") as caught:
        chosen.read_gains({gain: value})
    assert chosen.list_gains() in str(caught.value)


@pytest.mark.parametrize(("name", "gain"), EVERY_GAIN)
def test_a_gain_of_zero_is_refused_where_it_means_nothing(name, gain):
    chosen = CONTROLLERS[name]
    if gain in ("s", "feed_forward", "rho"):  # a law without them is one, too
        assert getattr(chosen.read_gains({gain: 0.0}).first, gain) == 0
    else:
        with pytest.raises(UsageError, match=f"'{gain}' .*'{name}' is 0"):
            chosen.read_gains({gain: 0.0})


def test_a_unit_on_a_gain_is_answered_with_what_to_write():
    with pytest.raises(UsageError) as caught:
        CONTROLLERS["p"].read_gains({"k": "20deg"})
    assert str(caught.value) == (
        "gain 'k' of controller 'p' is '20deg'; write a number without a unit, or a ramp such as "
        "5..20@10% (from 5 to 20 over the first 10 %); its gains: " + CONTROLLERS["p"].list_gains()
    )


def test_unknown_names_list_the_known_ones():
    with pytest.raises(UnknownNameError, match="'pd'"):
        CONTROLLERS["pd"]
    for value in (3.0, "3", "3deg", "1..2"):
        with pytest.raises(UsageError, match=r"'k'; .*gamma_O = 0.05 \(s, "):
            CONTROLLERS["hinf"].read_gains({"k": value})
