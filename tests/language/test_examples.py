"""The example files of the design, with numbers worked out by hand."""

import math

import numpy as np
import pytest

from dqpaint.program.program import (
    Arc,
    CruiseSpeed,
    Curve,
    Duration,
    Dwell,
    FixedOrientation,
    FollowHeading,
    Light,
    Profile,
    Samples,
    Screw,
    SlerpOrientation,
    Step,
    Straight,
)
from dqpaint.program.taylor import Taylor
from tests.support.drawing_texts import ROSE, STAR
from tests.support.drawn import drawn, matrix, rotation


def test_star() -> None:
    program = drawn(STAR)
    corners = [
        (0.08 * math.cos(a), 0.08 * math.sin(a), 0.0) for a in np.radians(90 + 144 * np.arange(6))
    ]
    assert program.period == pytest.approx(0.01)
    assert program.start.position == pytest.approx(corners[0], abs=1e-15)
    assert len(program.segments) == 5
    for segment, corner in zip(program.segments, corners[1:], strict=True):
        assert segment.end.position == pytest.approx(corner, abs=1e-15)
        assert isinstance(segment.path, Straight)
        assert np.linalg.norm(segment.path.by) == pytest.approx(
            2 * 0.08 * math.sin(math.radians(72))
        )
        assert segment.tool == FixedOrientation()
        assert segment.timing == CruiseSpeed(pytest.approx(0.06), pytest.approx(math.pi / 3))
        assert segment.profile == Profile("trapezoid")
        assert segment.line.line == 8
        assert segment.span.text_in(program.text).startswith("line to polar(")
        assert segment.light is not None
        assert segment.light.first == segment.light.last
    assert program.segments[-1].light == Light((1.0, 0.0, 0.0), (1.0, 0.0, 0.0))  # 360 deg is red
    assert program.notes == ()


def test_circle() -> None:
    (segment,) = drawn(
        "period 20 ms\nlet r = 7 cm\n\nstart at (0, r)\n"
        "arc centre (0, 0) axis -z angle 360 deg samples 3000 profile constant\n"
    ).segments
    assert segment.path == Arc((0, 0, 0), (0, 0, -1), pytest.approx(2 * math.pi))
    assert segment.timing == Samples(3000)
    assert segment.profile == Profile("constant")
    assert segment.end.position == pytest.approx((0, 0.07, 0), abs=1e-16)
    assert segment.line.line == 5


def test_square() -> None:
    program = drawn(
        "period 25 ms\nprofile constant\nlet a = 10 cm\nstart at (-a/2, -a/2)\n"
        "line by ( a,  0) samples 500\nline by ( 0,  a) samples 300\n"
        "line by (-a,  0) samples 500\nline by ( 0, -a) samples 300\n"
    )
    assert [s.timing for s in program.segments] == [Samples(n) for n in (500, 300, 500, 300)]
    ends = [(0.05, -0.05, 0), (0.05, 0.05, 0), (-0.05, 0.05, 0), (-0.05, -0.05, 0)]
    for segment, end in zip(program.segments, ends, strict=True):
        assert segment.end.position == pytest.approx(end, abs=1e-16)
        assert segment.profile == Profile("constant")


def test_spiral() -> None:
    (segment,) = drawn(
        "period 8 ms\nlet r = 7 cm\nstart at (0, r)\n"
        "arc centre (0, 0) axis -z angle 3 turn rise 7 cm samples 3000 profile constant\n"
    ).segments
    assert segment.path == Arc(
        (0, 0, 0), (0, 0, -1), pytest.approx(6 * math.pi), pytest.approx(0.07)
    )
    assert segment.end.position == pytest.approx((0, 0.07, -0.07), abs=1e-15)


def test_baxter_screw() -> None:
    program = drawn(
        "period 10 ms\nplace at (0, 0, 0)\nlet p = (700, 200, 400) mm\nlet d = (0, 0, 1)\n"
        "start at p - (150, 0, 0) mm tool look line p along d\n"
        "screw about p along d angle 90 deg in 10 s profile cubic(0 deg/s, 0 deg/s)\nhold 2 s\n"
    )
    screw, hold = program.segments
    assert program.placement is not None
    assert program.placement.position == (0, 0, 0)
    assert screw.path == Screw(
        pytest.approx((0.7, 0.2, 0.4)), (0, 0, 1), pytest.approx(math.pi / 2), 0
    )
    assert isinstance(screw.tool, FollowHeading)
    assert screw.profile == Profile("cubic", (0, 0), angular=True)
    assert screw.timing == Duration(10)
    # The tool's z points from the start at the line, its x lies along the line.
    start = matrix(program.start.orientation)
    assert start[:, 2] == pytest.approx([1, 0, 0], abs=1e-15)
    assert start[:, 0] == pytest.approx([0, 0, 1], abs=1e-15)
    assert screw.end.position == pytest.approx((0.7, 0.05, 0.4))
    assert matrix(screw.end.orientation) == pytest.approx(
        rotation((0, 0, 1), 90) @ start, abs=1e-15
    )
    assert hold.path == Dwell()
    assert hold.timing == Duration(2)
    assert hold.start == hold.end == screw.end
    assert hold.light == Light((1, 1, 1), (1, 1, 1))


def test_rose() -> None:
    program = drawn(ROSE)
    curves = program.segments[::2]
    moves = program.segments[1::2]
    assert len(program.segments) == 11
    assert program.start.position == pytest.approx((0.11, 0, 0))
    assert program.notes == ()
    assert all(move.light is None and isinstance(move.path, Straight) for move in moves)
    for k, segment in enumerate(curves):
        assert isinstance(segment.path, Curve)
        assert (segment.path.lower, segment.path.upper) == (0, pytest.approx(math.pi))
        assert segment.timing == Duration(12)
        t = np.linspace(0, math.pi, 7)
        xyz = np.array([c.coefficients[0] for c in segment.path.formula(Taylor.variable(t))])
        r = 0.03 * np.cos(3 * t)
        petal = np.array([r * np.cos(t) + 0.08, r * np.sin(t), 0 * t])
        assert xyz == pytest.approx(rotation((0, 0, 1), 60 * k) @ petal, abs=1e-15)
        assert segment.end.position == pytest.approx(tuple(xyz[:, -1]), abs=1e-15)


def test_step() -> None:
    program = drawn(
        "period 5 ms\nstart at (0, 0, 0) tool rpy(0, 0, 0)\nhold 1 s\n"
        "step to (50, 50, -20) mm tool rpy(0, 0, 30 deg)\nhold 10 s\n"
    )
    before, step, after = program.segments
    assert (before.path, step.path, after.path) == (Dwell(), Step(), Dwell())
    assert step.tool == SlerpOrientation()
    assert step.timing == Samples(1)
    assert step.end.position == pytest.approx((0.05, 0.05, -0.02))
    assert matrix(step.end.orientation) == pytest.approx(rotation((0, 0, 1), 30), abs=1e-15)
    assert after.start == step.end
    assert step.light == after.light == Light((1, 1, 1), (1, 1, 1))  # the way there is painted


def test_a_one_line_file() -> None:
    program = drawn("line to (100, 0) mm")
    (segment,) = program.segments
    assert program.period == pytest.approx(0.008)
    assert (program.robot, program.placement) == (None, None)
    assert segment.timing == CruiseSpeed(pytest.approx(0.1), pytest.approx(math.pi / 3))
    assert segment.profile == Profile("trapezoid")
    assert segment.tool == FixedOrientation()
    assert segment.light == Light((1, 1, 1), (1, 1, 1))
