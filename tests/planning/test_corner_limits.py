"""Accelerations at corners that an arm can bear, against forecasts and runs."""

import numpy as np
import pytest

from dqpaint.language import parse
from dqpaint.language.pen.stroke_state import ACCELERATION
from dqpaint.painting import paint
from dqpaint.planning.corner_limits import SHARE
from dqpaint.planning.forecast import forecast
from dqpaint.planning.prepared_motion import prepare_motion
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.settings import make_settings

NAME = 'text "Ada" font "futural" height 40 mm at (-40, 0) mm'
WEAK = "period 16 ms\nstroke\nline by (60, 0) mm by (0, 60) mm by (-60, 5) mm\nend"


def weak(name, share):
    """An arm whose motors have a share of their torques beside what holds its weight."""
    card = read_card(name)
    limits = card.limits.model_copy(
        update={"effort_Nm": tuple(share * one for one in card.limits.effort_Nm)}
    )
    return Kinematics(card.model_copy(update={"limits": limits}))


def jolts(arm, ready):
    return max(one.jolt_part for one in forecast(ready.motion, arm, ready.start))


def test_what_an_arm_can_do_is_left_as_it_is():
    arm = Kinematics(read_card("iiwa"))
    for text in (WEAK, "line by (60, 0) mm by (0, 60) mm"):
        ready = prepare_motion(parse(text, "a"), arm)
        assert ready.corners is None
        if text == WEAK:
            assert ready.program.segments[0].profile.acceleration == ACCELERATION
            assert jolts(arm, ready) < 1


@pytest.mark.parametrize("share", [0.5, 0.35])
def test_a_weak_arm_takes_corners_as_its_motors_can(share):
    arm = weak("iiwa", share)
    ready = prepare_motion(parse(WEAK, "a"), arm)
    assert ready.corners is not None
    assert 0.05 < ready.corners.least < ACCELERATION
    # as a forecast finds by inverse dynamics along the postures themselves
    strong = prepare_motion(parse(WEAK, "a"), Kinematics(read_card("iiwa")))
    weight = max(one.weight_part for one in forecast(ready.motion, arm, ready.start))
    wanted = weight + SHARE * (1 - weight)
    assert jolts(arm, strong) > 1.04 * wanted
    assert jolts(arm, ready) == pytest.approx(wanted, abs=0.02)
    assert ready.motion.seconds >= strong.motion.seconds
    np.testing.assert_allclose(ready.motion.pose[-1], strong.motion.pose[-1], atol=1e-12)
    profiles = {segment.profile for segment in ready.program.segments}
    (stroke,) = {segment.stroke for segment in ready.program.segments}
    assert profiles == {stroke.profile}


def test_it_is_told_with_the_figures():
    arm = weak("iiwa", 0.4)
    corners = prepare_motion(parse(WEAK, "a"), arm).corners
    assert corners.as_json == {"least_m_s2": corners.least, "allowed_m_s2": ACCELERATION}
    assert f"{corners.least:.2g} m/s2" in str(corners)


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["iiwa", "panda"])
def test_a_name_is_run_within_every_limit(robot):
    painting = paint.paint(parse(NAME, "a"), make_settings(robot=robot, size="160x90"))
    assert not painting.limits
    assert painting.metrics.figures["position_error_max_m"] < 1e-3
    assert (np.abs(painting.track.effort) < read_card(robot).effort).all()
