"""Where the light sits, as it is typed."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.errors import UsageError
from dqpaint.language import parse
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.loading.lookup import card_for, with_tool
from dqpaint.robots.model.card import read_card
from dqpaint.robots.model.tool_mount import parse_tool


@pytest.mark.parametrize("text", ["0.01, -.02,0.08,10,20,-30", "10mm,-2 cm,0.08m,10deg,20,-30 deg",
                                  "1e-2,-2e-2,80mm,0.17453292519943295rad,20,-30"])  # fmt: skip
def test_units(text):
    mount = parse_tool(text)
    assert mount.at_m == pytest.approx((0.01, -0.02, 0.08))
    assert mount.rpy_deg == pytest.approx((10, 20, -30))


@pytest.mark.parametrize("name", ["panda", "meka-a2", "iiwa"])
def test_three_numbers_are_a_place_and_leave_the_turn(name):
    """Of the Panda's hand and the Meka's fist, which are turned on their links."""
    card = read_card(name)
    moved = with_tool(card, "1cm,-2cm,80mm")
    assert moved.tool.at_m == pytest.approx((0.01, -0.02, 0.08))
    turns = [dq.rotation(Kinematics(one).pose(one.home)) for one in (card, moved)]
    np.testing.assert_array_equal(*turns)
    assert with_tool(card, "0,0,80mm,0,0,0").tool.rpy_deg == (0, 0, 0)


def test_the_light_is_moved_in_the_flange_s_frame():
    card = read_card("viper850")
    q = np.random.default_rng(3).uniform(-1, 1, card.joints)
    bare = dq.matrix_from_pose(Kinematics(with_tool(card, "0,0,0")).pose(q))
    moved = dq.matrix_from_pose(Kinematics(with_tool(card, "30mm,-20mm,0.1,25,-40,70")).pose(q))
    a, b, c = np.radians([25, -40, 70])
    Rx = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    Ry = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    Rz = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
    np.testing.assert_allclose(moved[:3, :3], bare[:3, :3] @ Rz @ Ry @ Rx, atol=1e-12)
    np.testing.assert_allclose(moved[:3, 3], bare[:3, :3] @ [0.03, -0.02, 0.1] + bare[:3, 3])


def test_it_overrides_the_card_and_nothing_else():
    program = parse("robot panda\nline to (1, 0) mm\n", "t")
    card = card_for(program, None, "0,0,5cm")
    assert card.name == "panda"
    assert card.tool.at_m == (0, 0, 0.05)
    assert card.model_copy(update={"tool": read_card("panda").tool}) == read_card("panda")


@pytest.mark.parametrize(("text", "word"), [
    ("", "X,Y,Z"), ("1,2", "X,Y,Z"), ("1,2,3,4", "X,Y,Z"), ("0,0,x", "'x' is not a number"),
    ("0,0,80", "write 80mm"), ("0,0,1deg", "m, cm, mm"), ("0,0,0,0,0,1mm", "deg, rad"),
    ("0,0,nan", "'nan'"), ("0,0,1e999", "inf m from"), ("0,0,", "'' is not"),
    ("٣,0,0", "'٣' is not a number"),
])  # fmt: skip
def test_slips(text, word):
    with pytest.raises(UsageError, match=None) as caught:
        parse_tool(text)
    assert word in str(caught.value)
