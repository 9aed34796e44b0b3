"""What the null space is asked for: gradients against differences, and what comes of them."""

import numpy as np
import pytest

from dqpaint import api, dq
from dqpaint.controllers import CONTROLLERS, Seen
from dqpaint.errors import UnknownNameError, UsageError
from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.kinematics.nullspace import (
    OBJECTIVES,
    SecondaryTask,
    make_batched_task,
    make_secondary_task,
    read_null,
)
from dqpaint.robots.model.card import installed_names, read_card
from dqpaint.simulation.closed_loop import track
from dqpaint.simulation.drives import make_drive
from tests.support.control import ACCEL

CARD = read_card("iiwa")
ARM = Kinematics(CARD)
EVERY = pytest.mark.parametrize("name", OBJECTIVES)
STILL = plan(parse("period 8 ms\nhold 3 s\n", "t.traj"), CARD.canvas.pose)


@EVERY
@pytest.mark.parametrize("robot", installed_names())
def test_slopes_are_the_derivatives(name, robot, rng):
    arm = Kinematics(read_card(robot))
    card = arm.card
    h = 1e-6
    for _ in range(5):
        start, q = rng.uniform(card.lower, card.upper, (2, card.joints))
        one = OBJECTIVES[name](card, start)

        def value(q, one=one):
            x, J = arm.pose_and_jacobian(q)
            return one.value(q, J, dq.translation(x))

        x, J = arm.pose_and_jacobian(q)
        found = one.gradient(q, J, dq.translation(x))
        steps = h * np.eye(card.joints)
        wanted = [(value(q + step) - value(q - step)) / (2 * h) for step in steps]
        np.testing.assert_allclose(found, wanted, atol=2e-6 * (1 + np.abs(wanted).max()))
        assert (np.abs(found).max() > 1e-6) == (name != "none")


@EVERY
def test_a_wish_goes_downhill(name, rng):
    start, q = rng.uniform(CARD.lower, CARD.upper, (2, 7))
    x, J = ARM.pose_and_jacobian(q)
    place = (J, dq.translation(x))
    one = OBJECTIVES[name](CARD, start)
    wish = make_secondary_task(name, CARD, start)(q, *place)
    np.testing.assert_allclose(wish, -OBJECTIVES[name].default_gain * one.gradient(q, *place))
    twice = make_secondary_task(f"{name},gain=4" if name != "none" else name, CARD, start)(
        q, *place
    )
    np.testing.assert_allclose(twice, -4 * one.gradient(q, *place))


def leaning(rng):
    """A posture that holds the drawing's first pose, well away along the self-motion."""
    q = CARD.home
    for _ in range(60):
        x, J = ARM.pose_and_jacobian(q)
        null = np.linalg.svd(J)[2][-1]
        q = q + 0.015 * null * np.sign(null[2])
        x, J = ARM.pose_and_jacobian(q)
        error = 2 * dq.log(dq.mul(dq.nearest(STILL.pose[0], x), dq.conj(x)))
        q = q + np.linalg.pinv(J) @ error
    return q


@EVERY
@pytest.mark.parametrize("law", [
    "hinf", "p", "pham-t", pytest.param("accelerate", marks=pytest.mark.slow),
])  # fmt: skip
def test_objectives_improve_while_the_tool_stands_still(name, law, rng):
    """For laws of velocity and of torque."""
    q = leaning(rng)
    chosen = ACCEL if law == "accelerate" else CONTROLLERS[law]
    plant = "torque" if law == "accelerate" else "ideal"
    run = track(STILL, ARM, q, PLANTS[plant], chosen, chosen.read_gains({}), null=name)
    moved = np.linalg.norm(run.points - STILL.points, axis=1).max()
    assert moved < 5e-4
    one = OBJECTIVES[name](CARD, q)
    heights = []
    for posture in (run.posture[0], run.posture[-1]):
        x, J = ARM.pose_and_jacobian(posture)
        heights.append(one.value(posture, J, dq.translation(x)))
    if name in ("start", "none"):
        assert np.abs(run.posture[-1] - q).max() < 1e-3
    else:
        assert heights[1] < heights[0] - 1e-3
    assert np.abs(np.diff(run.posture[-2:], axis=0)).max() < 1e-3  # it comes to rest, or nearly


def test_without_a_wish_a_closed_drawing_does_not_close():
    text = (
        "period 8 ms\nstart at (60, 0) mm\narc centre (0, 0) angle 3 turn in 6 s profile constant\n"
    )
    motion = plan(parse(text, "t.traj"), CARD.canvas.pose)
    law = CONTROLLERS["hinf"]
    open_, closed = (
        track(motion, ARM, leaning(None), PLANTS["ideal"], law, law.read_gains({}), null=null)
        for null in ("none", "start")
    )
    assert np.abs(open_.posture[-1] - open_.posture[250]).max() > 0.005
    assert np.abs(closed.posture[-1] - closed.posture[500]).max() < 0.002


def test_a_singular_posture_has_no_wish_for_manipulability():
    q = np.array([0.3, 0.5, 0, 0.0, 0.4, 0.0, 0.1])
    x, J = ARM.pose_and_jacobian(q)
    slope = OBJECTIVES["manipulability"](CARD, q).gradient(q, J, dq.translation(x))
    assert np.isfinite(slope).all()


@pytest.mark.parametrize("null", ["limits", "manipulability,gain=3"])
def test_pham_s_transpose_leaves_room_for_a_wish_and_is_the_paper_s_without(null, rng):
    """q_dot = J8' k e, and what --null wishes, which moves the tool by nothing."""
    law = CONTROLLERS["pham-t"]
    gains = law.read_gains({}).first
    q = CARD.home + rng.uniform(-0.3, 0.3, 7)
    x, J = ARM.pose_and_jacobian(q)
    goal = dq.mul(dq.exp(0.02 * rng.normal(size=6)), x)
    seen = Seen(x, goal, np.zeros(6), np.zeros(6), J, q, 0.0, 0.008, np.zeros(7))
    plain, wished = (
        make_drive(law, [law.law], ARM, make_secondary_task(one, CARD, CARD.home), 0.008).command(
            seen, gains
        )
        for one in ("none", null)
    )
    np.testing.assert_allclose(plain, law.law(seen, gains), atol=1e-15)
    wish = make_secondary_task(null, CARD, CARD.home)(q, J, dq.translation(x))
    projected = wish - np.linalg.pinv(J) @ (J @ wish)
    np.testing.assert_allclose(wished - plain, projected, atol=1e-9)
    assert np.abs(projected).max() > 1e-3
    np.testing.assert_allclose(J @ (wished - plain), 0, atol=1e-12)


def test_what_a_wish_does_in_a_time():
    """Of a pull towards a posture exactly e^-gt of the way is left, however long it takes."""
    q = CARD.home + 0.1
    x, J = ARM.pose_and_jacobian(q)
    wish = make_secondary_task("home,gain=3", CARD, CARD.home)
    for seconds in (1e-6, 0.3, 50.0):
        way = wish.displacement(seconds, q, J, dq.translation(x))
        np.testing.assert_allclose(q + way - CARD.home, 0.1 * np.exp(-3 * seconds), atol=1e-12)
    pull = make_batched_task("home,gain=3", ARM)
    both = pull(np.array([q, CARD.home]), np.array([q, q]), 0.3)
    np.testing.assert_allclose(both[0], wish.displacement(0.3, q, J, dq.translation(x)))
    np.testing.assert_allclose(both[1], 0, atol=1e-15)
    from dqpaint.robots.kinematics.start_posture import return_to_start

    starts = np.array([CARD.home, q])
    posture = np.array([q, CARD.home])
    np.testing.assert_allclose(make_batched_task("start", ARM)(posture, starts, 0.4),
                               return_to_start(posture, starts, 0.4), atol=1e-15)  # fmt: skip


def test_texts():
    assert read_null("limits") == ("limits", OBJECTIVES["limits"].default_gain)
    assert read_null("limits,gain=3") == read_null("limits:gain=3") == ("limits", 3.0)
    assert isinstance(make_secondary_task("home", CARD, CARD.home), SecondaryTask)
    for text, said in (
        ("limits,gain=-1", "gain -1.0 should be greater than or equal to 0"),
        ("limits,gain=21", "gain 21.0 should be less than or equal to 20"),
        ("limits,k=1", "has no value named 'k'; its values: gain"),
        ("none,gain=1", "'none' takes no gain"), ("a b", "is not NAME or NAME:KEY=VALUE"),
    ):  # fmt: skip
        with pytest.raises(UsageError, match=said):
            read_null(text)
    with pytest.raises(UnknownNameError, match=r"'elbow'; .*st"):
        read_null("elbow")


def test_the_choice_reaches_the_run_and_the_summary(tmp_path):
    from dqpaint.outputs.summary import summarise

    file = tmp_path / "t.traj"
    file.write_text("period 8 ms\nhold 0.2 s\n")
    painting = api.draw(file, null="limits,gain=3", plant="ideal", size=(64, 48))
    assert summarise(painting)["null_space"] == {"objective": "limits", "gain": 3.0}
    plain = api.draw(file, plant="ideal", size=(64, 48))
    assert np.abs(plain.track.posture - painting.track.posture).max() > 1e-3
