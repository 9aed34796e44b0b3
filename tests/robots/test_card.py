"""Robot cards: every one is usable, and what is wrong with one is said."""

import importlib.metadata

import numpy as np
import pytest
from pydantic import ValidationError

from dqpaint import dq
from dqpaint.cli.listing import lists
from dqpaint.errors import UnknownNameError, UsageError
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.kinematics.start_posture import StartPosture, find_start
from dqpaint.robots.model.card import Canvas, Card, Mount, card_names, installed_names, read_card
from tests.support.installed import needs_pybullet_data


@pytest.mark.parametrize("name", installed_names())
def test_every_arm_reaches_a_hand_around_its_canvas(name):
    arm = Kinematics(read_card(name))
    corners = np.array(
        [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0.05], [-0.1, 0, 0.1], [0, -0.1, 0], [0, 0, 0]]
    )
    local = dq.pose_from(corners, np.tile([1.0, 0, 0, 0], (6, 1)))
    found = find_start(arm, dq.mul(arm.card.canvas.pose, local), np.arange(6.0))
    assert isinstance(found, StartPosture)
    assert found.margin > np.radians(10)


@pytest.mark.parametrize("name", card_names())
def test_every_card_says_where_it_comes_from(name):
    card = read_card(name)
    assert card.source
    assert card.licence
    assert card.joints == len(card.effort) == len(card.speed)


@pytest.mark.parametrize("name", installed_names())
def test_home_is_before_the_canvas(name):
    arm = Kinematics(read_card(name))
    gap = dq.translation(arm.pose(arm.card.home)) - dq.translation(arm.card.canvas.pose)
    assert np.linalg.norm(gap) < 0.1


def test_an_unknown_robot_lists_the_known_ones():
    with pytest.raises(UnknownNameError, match=r"'ur7'; .*iiwa, "):
        read_card("ur7")


def test_an_arm_of_an_extra_is_listed_and_says_how_to_get_it(monkeypatch):
    """As on a machine without the extra."""

    def nothing(name):
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr("importlib.metadata.distribution", nothing)
    ur5 = read_card("ur5")
    assert ur5.missing == "pip install 'dqpaint[robots]'"
    assert "ur5" in card_names()
    assert "ur5" not in installed_names()
    assert "iiwa" in installed_names()
    with pytest.raises(UsageError, match=r"pip install 'dqpaint\[robots\]'"):
        Kinematics(ur5)
    rows = {row["name"]: row for row in lists("robots")["robots"]}
    assert rows["ur5"]["missing"] == "pip install 'dqpaint[robots]'"
    assert "not installed: pip install" in rows["ur5"]["about"]
    assert rows["lwr4"]["missing"] == ""


def test_a_missing_package_is_named():
    file = read_card("iiwa").urdf.model_copy(update={"package": "no_such_package"})
    with pytest.raises(UsageError, match=r"model[.]urdf .*'no_such_package'"):
        file.path  # noqa: B018


@needs_pybullet_data
def test_a_link_that_is_not_there_is_named():
    card = read_card("iiwa")
    file = card.urdf.model_copy(update={"link": "hand"})
    with pytest.raises(UsageError, match=r"model[.]urdf .*'hand'; .*lbr_"):
        Kinematics(card.model_copy(update={"urdf": file}))


def limits(lower, upper, speed):
    return {
        "limits": {"lower_deg": lower, "upper_deg": upper, "speed_deg_s": speed, "effort_Nm": [1]}
    }


@pytest.mark.parametrize(("change", "rule"), [
    ({"home_deg": [0] * 6}, "one number for each joint"),
    ({"home_deg": [0, 0, 0, -150, 0, 0, 0]}, "inside the limits"),
    ({"colour": "red"}, "Extra inputs"),
    ({"canvas": {"at_m": [0, 0, 0], "right": [1, 0, 0], "up": [1, 0, 0]}}, "perpendicular"),
    (limits([0], [0], [1]), "below"),
    (limits([0], [1, 2], [1]), "each joint"),
    (limits([0], [1], [0]), "greater than or equal to"),
    ({"urdf": None}, "needs one of the tables"),
    ({"denavit_hartenberg": {"rows": [{}] * 7}}, "needs one of the tables"),
    ({"body": {"mass_kg": [1], "radius_m": [1, 1]}}, "a URDF has its own masses"),
])  # fmt: skip
def test_faulty_cards_are_refused_with_the_rule(change, rule):
    good = read_card("iiwa").model_dump()
    with pytest.raises(ValidationError, match=rule):
        Card(**{**good, **change})


@pytest.mark.parametrize(("change", "rule"), [
    ({"body": None}, r"needs the table \[body\]"),
    ({"body": {"mass_kg": [1] * 7, "radius_m": [0.1] * 7}}, "radius_m one more"),
    ({"body": {"mass_kg": [0] * 7, "radius_m": [0.1] * 8}}, "greater than or equal to"),
    ({"denavit_hartenberg": {"rows": [{}] * 6}}, "each of the 6 joints"),
    ({"denavit_hartenberg": {"rows": []}}, "at least 1 item"),
    ({"denavit_hartenberg": {"rows": [{"d": 1}]}}, "rows.0.d"),
    ({"denavit_hartenberg": {"rows": [{"d_m": np.nan}]}}, "finite"),
    ({"denavit_hartenberg": {"rows": [{}], "convention": "Craig"}}, "'standard' or 'modified'"),
    (
        {"denavit_hartenberg": None, "screws": {
            "points_m": [[0, 0, 0]], "directions": [[0, 0, 0]], "flange": {},
        }},
        "a direction must not be zero",
    ),
    (
        {"denavit_hartenberg": None, "screws": {
            "points_m": [[0, 0, 0]], "directions": [], "flange": {},
        }},
        "one entry for each joint",
    ),
])  # fmt: skip
def test_faulty_chains_are_refused_with_the_rule(change, rule):
    good = read_card("lwr4").model_dump()
    with pytest.raises(ValidationError, match=rule):
        Card(**{**good, **change})


def test_mount_turns_about_fixed_axes_x_then_y_then_z():
    pose = Mount(at_m=(0.1, 0.2, 0.3), rpy_deg=(20, 30, 40)).pose
    a, b, c = np.radians([20, 30, 40])
    X = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    Y = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    Z = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
    np.testing.assert_allclose(dq.matrix_from_pose(pose)[:3, :3], Z @ Y @ X, atol=1e-15)


def test_canvas_has_its_axes_where_it_says():
    T = dq.matrix_from_pose(Canvas(at_m=(0.5, 0, 0.4), right=(0, 1, 0), up=(0, 0, 1)).pose)
    np.testing.assert_allclose(T[:3, :3], [[0, 0, 1], [1, 0, 0], [0, 1, 0]], atol=1e-15)
