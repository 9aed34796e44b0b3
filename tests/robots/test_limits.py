"""Limits: what they leave of a command, and how a run names them."""

import math
from dataclasses import replace

import numpy as np
import pytest

from dqpaint.diagnostics import SourceLine
from dqpaint.motion import RowLines
from dqpaint.robots.kinematics.limits import RateBounds, find_clamps
from dqpaint.robots.model.card import read_card

CARD = read_card("iiwa")


def test_rates_are_cut_to_speed_and_to_what_ends_inside():
    bounds = RateBounds(CARD, 0.01)
    q = np.zeros(7)
    q[0] = CARD.upper[0] - 0.001
    q[1] = CARD.lower[1] + 0.002
    out = bounds.clip(np.array([1.0, -1.0, 9.0, -9.0, 0.5, 0.0, 0.0]), q)
    np.testing.assert_allclose(
        out, [0.1, -0.2, CARD.speed[2], -CARD.speed[3], 0.5, 0, 0], atol=1e-12
    )


def test_a_joint_beyond_its_limit_may_only_come_back():
    q = np.zeros(7)
    q[0] = CARD.upper[0] + 0.5
    bounds = RateBounds(CARD, 0.01)
    assert bounds.clip(np.array([1.0, 0, 0, 0, 0, 0, 0]), q)[0] == pytest.approx(-CARD.speed[0])


def test_a_joint_far_beyond_its_limit_comes_back_at_its_speed():
    bounds = RateBounds(CARD, 0.01)
    for side, edge in ((1, CARD.upper), (-1, CARD.lower)):
        out = bounds.clip(side * np.ones(7), edge + side * 0.5)
        np.testing.assert_allclose(out, -side * CARD.speed)


def test_each_kind_is_named_with_joint_time_line_and_amount():
    n = 10
    three, four = SourceLine(0, 3), SourceLine(1, 4)
    t, source = np.arange(n) * 0.01, RowLines.from_lines([three] * 5 + [four] * 5)
    posture, effort = np.zeros((n, 7)), np.zeros((n, 7))
    wanted, command = np.zeros((n, 7)), np.zeros((n, 7))
    wanted[2:4, 3], command[2:4, 3] = [-2.0, -3.0], -CARD.speed[3]  # the worst is told
    posture[6, 1], wanted[6, 1], command[6, 1] = CARD.upper[1] - 0.01, 1.4, 1.0
    effort[8, 5] = -CARD.effort[5]
    (speed, position, motor), clipped = find_clamps(
        CARD, t, source, posture, wanted, command, effort, False
    )
    assert {kind: np.argwhere(where).tolist() for kind, where in clipped.items()} == {
        "speed": [[2, 3], [3, 3]],
        "position": [[6, 1]],
        "torque": [[7, 5]],
    }
    assert (speed.kind, speed.joint, speed.line) == ("speed", 4, three)
    assert speed.start == pytest.approx(0.02)
    assert speed.seconds == pytest.approx(0.02)
    assert speed.wanted == pytest.approx(3.0)
    assert (position.kind, position.joint, position.line) == ("position", 2, four)
    assert position.limit == pytest.approx(np.radians(120))
    assert position.wanted == pytest.approx(np.radians(120) + 0.004)
    assert (motor.kind, motor.joint, motor.start) == ("torque", 6, pytest.approx(0.07))
    assert str(speed) == "joint 4 for 0.02 s from 0.020 s on (75 deg/s, 171.9 asked for)"
    assert str(position).startswith("joint 2 for 0.01 s from 0.060 s on (120 deg, 120.2 asked for)")
    near = replace(position, limit=math.radians(175), wanted=math.radians(175.00213))
    assert near.amounts == ("175", "175.002")  # not: 175 asked for, limit 175
    assert motor.wanted == motor.limit == 40
    assert str(motor) == "joint 6 for 0.01 s from 0.070 s on (40 Nm)"
