"""Rounded corners: where they begin and end, that they touch both strokes, and what goes along."""

import math

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.language import parse
from dqpaint.motion.geometry.batched_shapes import shape
from dqpaint.program.program import (
    Arc,
    CruiseSpeed,
    Curve,
    Duration,
    FixedOrientation,
    Look,
    Samples,
    SlerpOrientation,
    Straight,
)
from tests.support.drawn import drawn
from tests.support.wrong_drawings import found

TOOL = "start at (11, -7, 5) mm tool rpy(20 deg, 30 deg, 40 deg)\n"


def ends(segment):
    """Places, directions and poses at both ends, from the motion: another reckoning."""
    flow = shape(segment).flow(np.array([0.0, 1.0]))
    points = dq.translation(flow.pose)
    velocity = dq.point_velocity(flow.twist, points)
    return points, velocity / np.linalg.norm(velocity, axis=1)[:, None], flow.pose


CORNERS = {
    "right": "line by (40, 0, 0) mm by (0, 40, 0) mm",
    "sharp": "line by (40, 0, 0) mm by (-39, 4, 2) mm",
    "flat": "line by (40, 10, 3) mm by (40, 11, 3.1) mm",
    "line-arc": "line by (40, 0, 0) mm\narc via (61, 30, 20) mm to (30, 60, 40) mm",
    "arc-line": "arc via (61, 30, 20) mm to (30, 60, 40) mm\nline by (40, 0, 0) mm",
    "arc-arc": "arc via (61, 30, 20) mm to (30, 60, 40) mm\narc via (0, 90, 0) mm to (0, 30, 5) mm",
    "helix": "arc centre (40, 5, 7) mm axis (1, -2, 2) angle -130 deg rise 30 mm\n"
    "line by (9, 40, 0) mm",
}


@pytest.mark.parametrize(
    "tool", ["keep", "rpy(50 deg, -10 deg, 80 deg)", "follow", "look (90, 80, -400) mm"]
)
@pytest.mark.parametrize("corner", CORNERS)
def test_a_corner_is_left_and_reached_at_the_distance_and_touched(corner, tool):
    start = "start at (11, -7, 5) mm" if "look" in tool else TOOL
    text = f"{start}\ntool {tool}\n{CORNERS[corner]}"
    sharp = drawn(text).segments
    first, bend, second = drawn(f"blend 7 mm\n{text}").segments
    assert first.stroke == bend.stroke == second.stroke
    assert first.stroke is not None
    assert first.timing == CruiseSpeed(pytest.approx(0.1), pytest.approx(math.pi / 3))
    assert isinstance(bend.path, Arc if corner in ("right", "sharp", "flat") else Curve)
    for near, far in ((first, bend), (bend, second)):
        (_, place), (_, direction), (_, pose) = ends(near)
        (begin, _), (into, _), (begin_pose, _) = ends(far)
        np.testing.assert_allclose(place, begin, atol=1e-12)
        np.testing.assert_allclose(direction, into, atol=1e-7)
        np.testing.assert_allclose(dq.nearest(pose, begin_pose), begin_pose, atol=1e-9)
    # the ends of the drawing are where they were, the parts are of the strokes
    assert first.start == sharp[0].start
    assert second.end == sharp[1].end
    for part, whole, cut in ((first, sharp[0], 1), (second, sharp[1], 0)):
        length = integral(whole)
        assert integral(part) == pytest.approx(length - 0.007, rel=1e-9)
        share = (np.linspace(0, 1, 7) if cut else np.linspace(1, 0, 7)) * (1 - 0.007 / length)
        share = share if cut else 1 - share
        mine = shape(part).flow(np.linspace(0, 1, 7)).pose
        theirs = shape(whole).flow(share).pose
        np.testing.assert_allclose(dq.nearest(mine, theirs), theirs, atol=1e-9)
    # the bend is about as long as an arc of a circle between the same two directions
    points, directions, _ = ends(bend)
    turn = np.arccos(np.clip(directions[0] @ directions[1], -1, 1))
    chord = np.linalg.norm(points[1] - points[0])
    assert integral(bend) == pytest.approx(0.5 * chord * turn / np.sin(0.5 * turn), rel=0.03)
    # nothing of the bend is farther from the corner than its two ends
    corner_at = np.array(sharp[0].end.position)
    way = dq.translation(shape(bend).flow(np.linspace(0, 1, 99)).pose)
    assert np.linalg.norm(way - corner_at, axis=1).max() <= 0.007 * (1 + 1e-9)


def integral(segment):
    """The length of a segment's path by a fine polygon, extrapolated."""

    def polygon(n):
        points = dq.translation(shape(segment).flow(np.linspace(0, 1, n + 1)).pose)
        return np.linalg.norm(np.diff(points, axis=0), axis=1).sum()

    return (4 * polygon(4000) - polygon(2000)) / 3


def test_the_arc_between_lines_has_the_radius_of_geometry():
    _, bend, _ = drawn("blend 5 mm\nline by (20, 0) mm by (0, 20) mm").segments
    assert isinstance(bend.path, Arc)
    assert bend.path.centre == pytest.approx((0.015, 0.005, 0), abs=1e-15)
    assert bend.path.angle == pytest.approx(math.pi / 2)
    _, bend, _ = drawn("blend 5 mm\nline by (20, 0) mm by (20, 20) mm").segments
    radius = math.dist(bend.path.centre, bend.start.position)
    assert radius == pytest.approx(0.005 / math.tan(math.pi / 8))


def test_two_corners_may_meet_in_the_middle():
    text = "blend 5 mm\nline by (20, 0) mm by (0, 10) mm by (20, 0) mm"
    segments = drawn(text).segments
    kinds = [type(segment.path) for segment in segments]
    assert kinds == [Straight, Arc, Arc, Straight]
    assert segments[1].end.position == pytest.approx((0.02, 0.005, 0), abs=1e-15)


def test_light_and_turn_go_on():
    text = "line by (100, 0) mm light red to blue tool rpy(0, 0, 90 deg)\nline by (0, 50) mm"
    text = f"blend 10 mm\n{text} light lime"
    first, bend, second = drawn(text).segments
    assert first.light.last == pytest.approx((0.1, 0, 0.9))
    assert (bend.light.first, bend.light.last) == (first.light.last, (0, 1, 0))
    assert second.light.first == second.light.last == (0, 1, 0)
    assert isinstance(bend.tool, SlerpOrientation)
    turned = 2 * math.atan2(first.end.orientation[3], first.end.orientation[0])
    assert turned == pytest.approx(0.9 * math.pi / 2)
    assert isinstance(second.tool, FixedOrientation)


def test_a_tool_that_looks_goes_on_looking():
    text = (
        "start at (0, 0)\ntool look (5, 9, -300) mm\nblend 10 mm\nline by (50, 0) mm by (0, 50) mm"
    )
    assert all(isinstance(segment.tool, Look) for segment in drawn(text).segments)


@pytest.mark.parametrize("text", [
    "line by (20, 0) mm\nmove by (0, 20) mm\nline by (20, 0) mm",
    "line by (20, 0) mm\nhold 1 s\nline by (0, 20) mm",
    "line by (20, 0) mm\nstep to (0, 20) mm\nline by (0, 20) mm",
    "line by (20, 0) mm\nline by (0, 0) tool rpy(0, 0, 9 deg)\nline by (0, 20) mm",
    "stroke\nline by (20, 0) mm\nend\nline by (0, 20) mm",
    "line by (20, 0) mm\nstroke\nline by (0, 20) mm\nend",
    "line by (20, 0) mm blend off\nline by (0, 20) mm",
])  # fmt: skip
def test_no_corner_is_rounded_where_the_light_or_the_tool_stops(text):
    rounded, sharp = drawn(f"blend 3 mm\n{text}").segments, drawn(text).segments
    assert [s.path for s in rounded] == [s.path for s in sharp]


def test_what_is_straight_on_is_joined_and_not_cut():
    a, b = drawn("blend 3 mm\nline by (2, 0) mm\nline by (1, 0) mm").segments
    assert a.stroke == b.stroke
    assert a.stroke is not None
    assert b.end.position == pytest.approx((0.003, 0, 0))


def test_a_clause_rounds_the_end_of_its_own_line():
    text = "line by (20, 0) mm blend 3 mm\nline by (0, 20) mm\nline by (-20, 0) mm"
    assert [type(s.path) for s in drawn(text).segments] == [Straight, Arc, Straight, Straight]
    assert [s.stroke is None for s in drawn(text).segments] == [False, False, False, True]


def test_blend_in_a_scaled_block_is_scaled():
    _, bend, _ = drawn("with scale 0.5 blend 4 mm\nline by (20, 0) mm by (0, 20) mm\nend").segments
    assert bend.start.position == pytest.approx((0.008, 0, 0))


def test_the_time_of_legs_is_the_time_of_all():
    text = "blend 3 mm\nline by (20, 0) mm by (0, 20) mm by (20, 0) mm"
    for clause, timing in (("in 3 s", Duration(pytest.approx(3))), ("samples 50", Samples(50))):
        segments = drawn(f"{text} {clause}").segments
        assert {s.stroke.number for s in segments} == {1}
        assert all(s.timing == s.stroke.timing == timing for s in segments)


def test_each_stroke_is_rounded_within_itself():
    lines = "stroke in 2 s\nline by (20, 0) mm\nline by (0, 20) mm\nend\nmove by (9, 9) mm\n"
    segments = drawn(f"blend 3 mm\n{lines}line by (20, 0) mm by (0, 20) mm").segments
    round_ = [Straight, Arc, Straight]
    assert [type(s.path) for s in segments] == [*round_, Straight, *round_]
    last = segments[-1].stroke.number
    assert [s.stroke and s.stroke.number for s in segments] == [1, 1, 1, None, last, last, last]
    assert last > 1


def test_what_is_advised_for_a_short_stroke_works():
    text = "blend {}\nline by (20, 0) mm by (0, 3.3333) mm by (20, 0) mm"

    (told,) = found(text.format("5 mm"))
    advice = told.help.removeprefix("at most: blend ")
    assert advice == "1.66 mm"
    assert parse(text.format(advice), "a").segments


@pytest.mark.parametrize("angle", ["5e-324", "3e-310", "1e-200"])
def test_the_direction_of_an_arc_has_no_smallest_angle(angle):
    text = (
        f"arc centre (-12.6, 91.8) mm angle {angle} rad blend 1e-9 mm\n"
        "arc via (-130, 50.6) mm to (-46.3, -107, 25.8) mm blend 5 mm\n"
    )
    arc, *_ = parse(text).segments
    assert arc.path.angle == float(angle)
