"""The product of exponentials, Denavit-Hartenberg rows and pinocchio: three ways, one arm."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import installed_names, read_card
from dqpaint.robots.model.fields import Mount
from dqpaint.robots.model.screws import Screws
from tests.support.robot_cards import CARDS

AGREES = 1e-12


def bare(card):
    """Kinematics of the flange, without a tool."""
    return Kinematics(card.model_copy(update={"tool": Mount()}))


def postures(card, rng, n=50):
    return rng.uniform(card.lower, card.upper, (n, card.joints))


@pytest.mark.parametrize("name", CARDS)
def test_three_ways_to_a_pose_and_a_jacobian_agree(name, rng):
    card = CARDS[name]
    q = postures(card, rng)
    x, J = bare(card).poses_and_jacobians(q)
    ways = [card.axes]
    if card.denavit_hartenberg is not None:
        ways.append(card.denavit_hartenberg.chain)
    for way in ways:
        np.testing.assert_allclose(dq.nearest(way.pose(q), x), x, atol=AGREES)
        np.testing.assert_allclose(way.jacobian(q), J, atol=AGREES)


@pytest.mark.parametrize("name", installed_names())
def test_every_arm_is_its_screw_axes(name, rng):
    """The axes at q = 0, read off the door to pinocchio, say the whole arm with its tool."""
    arm = Kinematics(read_card(name))
    q = postures(arm.card, rng)
    x, J = arm.poses_and_jacobians(q)
    screws = arm.screws()
    np.testing.assert_allclose(dq.nearest(screws.pose(q), x), x, atol=AGREES)
    np.testing.assert_allclose(screws.jacobian(q), J, atol=AGREES)


def test_a_single_turn_is_a_turn_about_the_line():
    """90 degrees about the vertical through (1, 0, 0): the origin goes to (1, -1, 0)."""
    axis = dq.twist_from_screw([0, 0, 1], [1, 0, 0])
    arm = Screws(axis[None], dq.IDENTITY)
    np.testing.assert_allclose(
        dq.translation(arm.pose(np.array([np.pi / 2]))), [1, -1, 0], atol=1e-15
    )


def test_any_leading_shape_gives_the_same(rng):
    screws = CARDS["baxter"].axes
    q = rng.uniform(-2, 2, (2, 3, 7))
    assert screws.pose(q).shape == (2, 3, 8)
    np.testing.assert_allclose(screws.pose(q)[1, 2], screws.pose(q[1, 2]), atol=1e-15)
    np.testing.assert_allclose(screws.jacobian(q)[0, 1], screws.jacobian(q[0, 1]), atol=1e-15)


@pytest.mark.parametrize("name", ["iiwa", "panda"])
def test_files_agree_with_published_rows(name, rng):
    """As closely as the files round a right angle: to 1e-11 rad."""
    rows = CARDS[name].denavit_hartenberg.chain
    arm = bare(read_card(name))
    q = postures(arm.card, rng)
    x, J = arm.poses_and_jacobians(q)
    np.testing.assert_allclose(dq.nearest(rows.pose(q), x), x, atol=1e-10)
    np.testing.assert_allclose(rows.jacobian(q), J, atol=1e-10)


@pytest.mark.skipif("baxter-right" not in installed_names(), reason="needs dqpaint[robots]")
def test_baxter_s_published_axes_are_those_of_its_file():
    """Chandra 2020's configuration, to the six decimals printed there; the flange turns freely."""
    published, file = CARDS["baxter"].axes, bare(read_card("baxter-right")).screws()
    np.testing.assert_allclose(published.axes, file.axes, atol=3e-6)
    np.testing.assert_allclose(dq.translation(published.home), dq.translation(file.home), atol=3e-6)
