"""Every branch of what is suggested, in a world where a rule says what an arm can draw.

`test_suggestions` looks at whether it helps on real arms.
"""

import numpy as np
import pytest

from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.planning import suggestions
from dqpaint.planning.suggestions import NO_SUGGESTION, suggest
from dqpaint.program import Screw
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.model.card import read_card

LINES = "start at (30, 20) mm\nline to (300, 100) mm in 1 s tool rot(z, 40 deg)\n"
SCREW = "screw about (60, 0, 0) mm along y angle {} deg pitch 150 mm/turn in 8 s\n"


@pytest.fixture(scope="module")
def arm():
    return Kinematics(read_card("iiwa"))


@pytest.fixture
def said(monkeypatch, arm):
    """What is suggested for a text, by rules (motion, arm) of what is drawn, placed, in reach."""

    def call(text, drawn=None, placed=None, reached=None, arms=()):
        never = lambda motion, arm: False  # noqa: E731
        drawn, placed = drawn or never, placed or never
        near = reached or (lambda poses: np.zeros(len(poses)))
        monkeypatch.setattr(suggestions, "can_draw", lambda motion, arm, null: drawn(motion, arm))
        monkeypatch.setattr(
            suggestions, "can_be_placed", lambda motion, arm, _: placed(motion, arm)
        )
        monkeypatch.setattr(suggestions, "least_errors", lambda arm, poses: near(poses))
        monkeypatch.setattr(suggestions, "installed_names", lambda: list(arms))
        motion = plan(parse(text, "t.traj"), arm.card.canvas.pose)
        return suggest(motion, arm, np.array([len(motion.t) - 1]))

    return call


def width(motion):
    return float(motion.box.max())


def is_straight(motion):
    return float(np.ptp(motion.pose[:, :4], axis=0).max()) < 1e-9


def angle(motion):
    (path,) = (s.path for s in motion.program.segments if isinstance(s.path, Screw))
    assert path.advance / path.angle == pytest.approx(0.15 / (2 * np.pi))  # the pitch stays
    return float(np.degrees(path.angle))


def test_where_nothing_helps_that_is_said(said):
    assert said(LINES) == NO_SUGGESTION
    assert said(LINES, arms=["iiwa", "panda"]) == NO_SUGGESTION


def test_the_largest_scale_that_is_drawn(said):
    small = lambda motion, arm: width(motion) < 0.27 * 0.52 and not is_straight(motion)  # noqa: E731
    assert said(LINES, small) == "make it smaller: with scale 0.5 ... end"
    at_last = lambda poses: np.where(np.arange(len(poses)) < 12, 1.0, 0.0)  # noqa: E731
    assert said(LINES, small, reached=at_last) == "make it smaller: with scale 0.35 ... end"


def test_metres_are_told_where_millimetres_are_drawn(said):
    far = "line to (100, 0) m in 9 s\n"
    assert "(0.1, 0)" in said(far, lambda motion, arm: width(motion) < 0.2)
    assert "(0.1, 0)" not in said(far)
    assert "(0.1, 0)" not in said(LINES, lambda motion, arm: width(motion) < 1e-3)


def test_another_place_and_a_straight_tool(said):
    whole = lambda motion, arm: width(motion) > 0.2 and not is_straight(motion)  # noqa: E731
    assert said(LINES, placed=whole) == "move it: place auto finds room"
    straight = lambda motion, arm: is_straight(motion) and width(motion) > 0.2  # noqa: E731
    assert said(LINES, straight) == "hold the tool straight: without 'tool' it is reached"
    out = lambda poses: np.ones(len(poses))  # noqa: E731
    assert said(LINES, straight, reached=out) == NO_SUGGESTION  # a first look says no
    both = said(LINES, straight, whole)
    assert both.split("; or ")[0].startswith("move it")
    assert both.split("; or ")[1].startswith("hold")


@pytest.mark.parametrize(("asked", "told"), [(360, 180), (-360, -180), (100, 90)])
def test_the_largest_angle_of_a_screw_that_is_drawn(said, asked, told):
    """A larger one than was asked for is none, though the arm could draw it."""

    def drawn(motion, arm):
        found = abs(angle(motion))
        return found < abs(told) + 1e-6 or found > abs(asked) + 1e-6

    found = said(SCREW.format(asked), drawn, reached=lambda poses: np.ones(len(poses)))
    assert found == f"a screw turns the tool with it: with angle {told} deg it is reached"


def test_two_changes_at_once_where_none_helps_alone(said):
    tiny = lambda motion, arm: width(motion) < 0.27 * 0.6 and not is_straight(motion)  # noqa: E731
    found = said(LINES, placed=tiny)
    assert found.startswith("make it smaller and move it: with scale 0.5")
    straight = lambda motion, arm: is_straight(motion)  # noqa: E731
    assert said(LINES, placed=straight).startswith(
        "hold the tool straight, without 'tool', and move"
    )


def test_another_arm_is_the_last(said, arm):
    other = lambda motion, one: one is not arm  # noqa: E731
    assert said(LINES, other, arms=["iiwa", "panda"]) == "take another arm: panda reaches it"
    own = lambda motion, one: one.card.name == "iiwa" and one is not arm  # noqa: E731
    assert said(LINES, own, arms=["iiwa"]) == NO_SUGGESTION
