"""`dqpaint pose`: its numbers against each other and against what was typed."""

import json

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.cli import pose as pose_text
from dqpaint.errors import UsageError
from dqpaint.robots import pose_query
from dqpaint.robots.model.card import read_card
from tests.support.random_poses import random_poses

VIPER = read_card("viper850")
PHAM = "20,-110,190,25,45,20"


def test_pham_s_pose_is_shown_to_its_four_decimals():
    posed = pose_query.pose_arm(VIPER, pose_query.read_posture(VIPER, PHAM, None), flange=True)
    facts = pose_query.as_json(posed)
    printed = [0.3530, 0.0651, 0.8660, 0.3482, -0.2192, -0.2526, -0.0098, 0.2938]
    np.testing.assert_allclose(facts["pose"], printed, atol=5.1e-5)
    np.testing.assert_allclose(facts["matrix"][2], [-0.5661, 0.6489, -0.5083, 0.7963], atol=6e-5)
    assert facts["frame"] == "flange"
    assert facts["warnings"] == []
    shown = pose_text.text(posed)
    assert "0.353016   0.065085   0.865985   0.348157" in shown
    assert "-0.000000" not in shown


def test_the_tool_sits_on_the_flange():
    posture = pose_query.read_posture(VIPER, PHAM, None)
    flange, tool = (pose_query.pose_arm(VIPER, posture, bare) for bare in (True, False))
    asked = dq.mul(flange.pose, VIPER.tool.pose)
    np.testing.assert_allclose(dq.nearest(tool.pose, asked), asked, atol=1e-12)
    np.testing.assert_allclose(tool.jacobian, flange.jacobian, atol=1e-12)


def test_the_screw_gives_the_pose_back(rng):
    """Turn about the line and move along it: by the exponential of its own twist."""
    for x in random_poses(rng, 50):
        screw = pose_query.screw_from_pose(x)
        assert 0 < screw.angle <= np.pi
        unit = dq.twist_from_screw(screw.axis, screw.point, screw.pitch)
        again = dq.exp(0.5 * screw.angle * unit)
        np.testing.assert_allclose(dq.nearest(again, x), x, atol=1e-12)
        assert screw.axis @ screw.point == pytest.approx(0, abs=1e-12)
        assert screw.advance == pytest.approx(screw.angle * screw.pitch)


def test_a_translation_is_a_screw_without_a_turn():
    screw = pose_query.screw_from_pose(dq.pose_from([3.0, 0, 4], [1.0, 0, 0, 0]))
    np.testing.assert_allclose(screw.axis, [0.6, 0, 0.8])
    assert (screw.angle, screw.advance, screw.point, screw.pitch) == (0, 5, None, None)
    nowhere = pose_query.screw_from_pose(dq.IDENTITY)
    assert (nowhere.angle, nowhere.advance) == (0, 0)


def test_a_pure_translation_is_told_as_one():
    card = VIPER.model_copy(update={"tool": VIPER.tool})
    posed = pose_query.pose_arm(card, card.home, flange=False)
    still = pose_query.PoseReport(
        card, False, card.home, dq.pose_from([0, 0, 0.5], [1.0, 0, 0, 0]), posed.jacobian, ()
    )
    assert "a translation without rotation" in pose_text.text(still)
    assert pose_query.as_json(still)["screw"]["pitch_m_rad"] is None
    json.dumps(pose_query.as_json(still), allow_nan=False)


def test_radians_are_degrees():
    angles = ",".join(repr(float(x)) for x in np.radians([20, -110, 190, 25, 45, 20]))
    np.testing.assert_allclose(
        pose_query.read_posture(VIPER, None, angles), pose_query.read_posture(VIPER, PHAM, None)
    )
    np.testing.assert_array_equal(pose_query.read_posture(VIPER, None, None), VIPER.home)
    np.testing.assert_array_equal(
        pose_query.read_posture(VIPER, "1 2, 3,4 5,6", None), np.radians([1, 2, 3, 4, 5, 6])
    )


@pytest.mark.parametrize(("deg", "rad", "message"), [
    ("1,2", None, "6 joints, .*--deg .*2 angles"),
    (None, "1", "6 joints, .*--rad .*1 angle"),
    ("", None, "--deg .*0 angles"),
    ("1,2,3,4,5,6,7", None, "7 angles"),
    ("1,2,3,x,5,6", None, "--deg: 'x'"),
    ("1,2,3,nan,5,6", None, "--deg: 'nan'"),
    (None, "1,2,3,inf,5,6", "--rad: 'inf'"),
    ("1", "1", "not with both"),
])  # fmt: skip
def test_what_is_no_posture_is_refused(deg, rad, message):
    with pytest.raises(UsageError, match=message):
        pose_query.read_posture(VIPER, deg, rad)


def test_angles_that_are_slips_are_refused():
    with pytest.raises(UsageError, match=r"--rad .*1e.06 rad"):
        pose_query.read_posture(read_card("iiwa"), None, "1e9 0 0 0 0 0 0")


def test_joints_beyond_their_limits_are_named():
    posture = pose_query.read_posture(VIPER, "0,46,0,0,-121,0", None)
    beyond = pose_query.pose_arm(VIPER, posture, flange=False).limit_violations
    assert beyond == [
        "joint 2 at 46 deg is beyond its limits, -190 to 45 deg",
        "joint 5 at -121 deg is beyond its limits, -120 to 120 deg",
    ]
    at_the_limit = pose_query.read_posture(VIPER, "-170,45,256,190,-120,360", None)
    assert pose_query.pose_arm(VIPER, at_the_limit, flange=False).limit_violations == []
