"""Samples of whole drawings: corners, light, geometry, frames, budgets and their messages."""

import math
from dataclasses import replace

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.core.bounds import DEFAULT_MAX_SAMPLES, LARGEST_MAX_SAMPLES
from dqpaint.core.examples import examples_folder
from dqpaint.diagnostics import Diagnostic, ScriptError, SourceLine
from dqpaint.errors import UsageError
from dqpaint.language import parse
from dqpaint.motion import plan, survey
from dqpaint.motion.geometry.batched_shapes import gather_shapes
from dqpaint.motion.sampling import AT_ONCE
from dqpaint.motion.schedule import Schedule
from dqpaint.motion.stroke_errors import StrokeError
from dqpaint.program.program import (
    Arc,
    CruiseSpeed,
    Curve,
    Duration,
    Dwell,
    FixedOrientation,
    FollowHeading,
    Light,
    Pose,
    Profile,
    Samples,
    Screw,
    Step,
    Straight,
)
from dqpaint.settings.model import Settings, make_settings
from tests.support.strokes import AXIS, START, program, segment

CANVAS = dq.pose_from([0.7, -0.1, 0.5], np.array([0.5, 0.5, 0.5, 0.5]))


def stroke(path, start=START, end=None, timing=None, profile="constant", tool=None, **more):
    made = segment("line", "keep", profile)
    return replace(made, path=path, start=start, end=end or start, tool=tool or FixedOrientation(),
                   timing=timing or Samples(100), **more)  # fmt: skip


def codes(caught):
    return [d.code for d in caught.value.diagnostics]


def test_a_circle_lies_on_its_circle():
    """The thesis's circle, 3000 samples: radius and plane to 1e-12 m."""
    start = Pose((0.0, 0.07, 0.0), (1.0, 0.0, 0.0, 0.0))
    circle = stroke(Arc((0, 0, 0), (0, 0, -1.0), 2 * math.pi), start, timing=Samples(3000))
    motion = plan(program(circle, period=0.02), CANVAS)
    assert len(motion.t) == 3001
    assert motion.t[-1] == pytest.approx(60)
    local = dq.translation(dq.mul(dq.conj(CANVAS), motion.pose))
    assert np.abs(np.hypot(local[:, 0], local[:, 1]) - 0.07).max() < 1e-12
    assert np.abs(local[:, 2]).max() < 1e-12
    angle = 2 * math.pi * np.arange(3001) / 3000
    np.testing.assert_allclose(local[:, 0], 0.07 * np.sin(angle), atol=1e-12)


def test_a_screw_keeps_its_line():
    """Points of the axis, carried by the tool, slide along it by pitch x angle."""
    point, angle, advance = np.array([0.4, 0.1, -0.2]), 2.4, 0.15
    screw = stroke(
        Screw(tuple(point), AXIS, angle, advance), timing=Samples(500), tool=FollowHeading(AXIS)
    )
    motion = plan(program(screw), dq.IDENTITY)
    carried = dq.mul(motion.pose, dq.conj(motion.pose[0]))  # what moves the first pose to each
    axis = np.array(AXIS)
    moved = dq.rotate(carried[:, :4], np.broadcast_to(point, (501, 3))) + dq.translation(carried)
    wanted = point + np.linspace(0, advance, 501)[:, None] * axis
    assert np.abs(moved - wanted).max() < 1e-12


def test_samples_meet_at_corners_and_twists_are_of_what_follows():
    a = stroke(Straight((0.1, 0, 0)), timing=Samples(10))
    b_start = Pose((START.position[0] + 0.1, *START.position[1:]), START.orientation)
    b = stroke(Straight((0, 0.05, 0)), b_start, timing=Samples(20), line=SourceLine(0, 2))
    motion = plan(program(a, b), dq.IDENTITY)
    assert len(motion.t) == 31
    np.testing.assert_array_equal(motion.source.line, [1] * 10 + [2] * 21)
    np.testing.assert_allclose(motion.twist[9, 3:], [0.1 / 0.08, 0, 0], atol=1e-14)
    np.testing.assert_allclose(motion.twist[10, 3:], [0, 0.05 / 0.16, 0], atol=1e-14)
    np.testing.assert_allclose(
        np.diff(motion.points, axis=0) / 0.008, motion.twist[:-1, 3:], atol=1e-12
    )


def test_step_jumps_between_two_samples_without_a_twist():
    end = Pose((0.3, 0.1, -0.1), START.orientation)
    motion = plan(program(stroke(Dwell(), timing=Duration(0.08)), stroke(Step(), START, end),
                          stroke(Dwell(), end, timing=Duration(0.04))), dq.IDENTITY)  # fmt: skip
    assert len(motion.t) == 1 + 10 + 1 + 5
    np.testing.assert_allclose(motion.points[:11], np.tile(START.position, (11, 1)), atol=1e-15)
    np.testing.assert_allclose(motion.points[11:], np.tile(end.position, (6, 1)), atol=1e-15)
    assert not motion.twist.any()


def test_light_is_the_mean_of_each_step_and_a_gradient_runs_over_length():
    made = stroke(Straight((0.1, 0, 0)), timing=Samples(4), light=Light((1, 0, 0), (0, 0, 1)))
    dark = stroke(Dwell(), Pose((START.position[0] + 0.1, *START.position[1:]), START.orientation),
                  timing=Samples(3), light=None)  # fmt: skip
    motion = plan(program(made, dark), dq.IDENTITY)
    np.testing.assert_allclose(motion.light[:4, 0], [0.875, 0.625, 0.375, 0.125], atol=1e-14)
    assert not motion.light[4:].any()
    np.testing.assert_array_equal(motion.lit, [True] * 4 + [False] * 4)


def test_a_gradient_stays_between_its_colours_where_the_profile_overshoots():
    over = stroke(Straight((0.1, 0, 0)), timing=Samples(100), light=Light((1, 0, 0), (0, 0, 0)))
    over = replace(over, profile=Profile("cubic", (-0.5, -0.5)))
    light = plan(program(over), dq.IDENTITY).light
    assert light.min() == 0
    assert light.max() == 1


def test_a_drawing_of_days_and_one_beyond_the_numbers_are_refused():
    with pytest.raises(ScriptError) as caught:
        plan(program(stroke(Dwell(), timing=Samples(10_000)), period=10.0), CANVAS)
    assert codes(caught) == ["E325"]
    with pytest.raises(ScriptError) as caught:
        plan(program(stroke(Straight((0.1, 0, 0)), timing=CruiseSpeed(1e-200, 1.0))), CANVAS)
    assert codes(caught) == ["E302"]
    wild = replace(
        stroke(Straight((0.1, 0, 0)), timing=Samples(10)), profile=Profile("cubic", (1e308, 0))
    )
    with np.errstate(all="ignore"), pytest.raises(ScriptError) as caught:
        plan(program(wild), CANVAS)
    assert codes(caught) == ["E324"]


def test_a_gradient_on_a_curve_of_uneven_speed_still_runs_over_length():
    parabola = Curve(lambda t: (0.1 * t * t, 0.0 * t, 0.0 * t), 0.2, 1.0)
    made = stroke(parabola, timing=Samples(100), light=Light((1, 0, 0), (0, 0, 0)))
    motion = plan(program(made), dq.IDENTITY)
    done = (motion.points[:, 0] - motion.points[0, 0]) / np.ptp(motion.points[:, 0])
    np.testing.assert_allclose(motion.light[:100, 0], 1 - 0.5 * (done[1:] + done[:-1]), atol=1e-12)


def test_a_curve_with_a_time_is_its_formula_and_with_a_speed_is_even():
    line = Curve(lambda t: (0.1 * t * t, 0.0 * t, 0.2 * t * t), 0.3, 1.0)
    literal = plan(program(stroke(line, timing=Samples(7))), dq.IDENTITY)
    np.testing.assert_allclose(literal.points[:, 0], 0.1 * np.linspace(0.3, 1, 8) ** 2, atol=1e-15)
    even = plan(program(stroke(line, timing=CruiseSpeed(0.05, 1.0))), dq.IDENTITY)
    np.testing.assert_allclose(np.diff(even.points, axis=0)[:, 0].std(), 0, atol=1e-14)


@pytest.mark.parametrize("profile", ["constant", "trapezoid", "cubic", "quintic", "cubic-rates"])
@pytest.mark.parametrize("path", ["line", "circle", "spiral", "curve", "screw"])
def test_cruising_speed_is_reached_and_never_exceeded(path, profile):
    tool = "follow" if path == "screw" else "keep"
    made = replace(segment(path, tool, profile), timing=CruiseSpeed(0.08, 100.0))
    motion = plan(program(made, period=0.001), CANVAS)
    speed = np.linalg.norm(dq.point_velocity(motion.twist, motion.points), axis=1)
    assert speed.max() <= 0.08 * (1 + 1e-9)
    assert speed.max() >= 0.08 * 0.998


def test_turnspeed_holds_a_turn_back():
    motion = plan(program(segment("turn", "turn", "trapezoid"), period=0.001), CANVAS)
    rate = np.linalg.norm(motion.twist[:, :3], axis=1)
    assert 0.9 * 0.998 < rate.max() <= 0.9 * (1 + 1e-9)


def test_durations_are_rounded_up_and_said_where_it_matters():
    assert 0.07 / 0.01 > 7  # the noise of a division is not another sample
    assert len(plan(program(stroke(Dwell(), timing=Duration(0.07)), period=0.01), CANVAS).t) == 8
    motion = plan(program(stroke(Dwell(), timing=Duration(0.08))), CANVAS)
    assert len(motion.t) == 11
    assert not motion.notes
    motion = plan(program(stroke(Dwell(), timing=Duration(0.081))), CANVAS)
    assert len(motion.t) == 12
    assert [n.code for n in motion.notes] == ["W410"]


def test_the_canvas_carries_the_drawing_and_place_replaces_it():
    made = segment("helix", "turn")
    at_base = plan(program(made), dq.IDENTITY)
    on_canvas = plan(program(made), CANVAS)
    np.testing.assert_allclose(
        dq.nearest(dq.mul(CANVAS, at_base.pose), on_canvas.pose), on_canvas.pose, atol=1e-14
    )
    placed = Pose((0.7, -0.1, 0.5), (0.5, 0.5, 0.5, 0.5))
    np.testing.assert_array_equal(
        plan(program(made, placement=placed), dq.IDENTITY).pose, on_canvas.pose
    )
    # the twist is that of the carried pose: against differences
    ahead = 0.5 * dq.mul(dq.pure(on_canvas.twist[20:-20]), on_canvas.pose[20:-20])
    differences = (on_canvas.pose[21:-19] - on_canvas.pose[19:-21]) / 0.016
    np.testing.assert_allclose(ahead, differences, atol=2e-3)
    assert np.abs(ahead).max() > 0.1


def test_rows_are_read_only():
    motion = plan(program(segment("line", "keep")), CANVAS)
    with pytest.raises(ValueError, match="read-only"):
        motion.pose[0, 0] = 2.0


@pytest.mark.slow
def test_the_sample_budget_is_checked_before_anything_is_made():
    huge = stroke(Straight((0.1, 0, 0)), timing=CruiseSpeed(1e-9, 1.0), profile="trapezoid")
    with pytest.raises(ScriptError) as caught:
        plan(program(huge), CANVAS)
    assert codes(caught) == ["E302"]
    assert "this line alone has 15,625,000,000" in str(caught.value)
    with pytest.raises(ScriptError) as caught:
        plan(program(stroke(Dwell(), timing=Samples(10**12))), CANVAS)
    assert codes(caught) == ["E302"]
    many = stroke(Dwell(), timing=Samples(1_500_000))
    with pytest.raises(ScriptError) as caught:
        plan(program(many, many), CANVAS)
    assert codes(caught) == ["E302"]


def test_a_drawing_s_own_budget():
    """Of samples, the first included; what is refused for its size is not sampled at all."""
    lines = [stroke(Dwell(), timing=Samples(10)) for _ in range(3)]
    drawing = replace(program(*lines), most_samples=31)
    assert plan(drawing, CANVAS).samples == survey(drawing).samples == 31
    asked = []
    formula = Curve(lambda t: asked.append(t) or (t * 0.1, t * 0.0, t * 0.0), 0.0, 1.0)
    drawing = replace(program(stroke(formula, timing=Samples(10)), *lines), most_samples=40)
    for look in (survey, lambda one: plan(one, CANVAS)):
        asked.clear()
        with pytest.raises(ScriptError, match=r"E302.* 40 ") as caught:
            look(drawing)
        assert codes(caught) == ["E302"]
        measured = len(asked)
        with pytest.raises(ScriptError):
            survey(replace(drawing, most_samples=11))
        assert len(asked) == 2 * measured  # measured, but not sampled
    assert Settings().max_samples == DEFAULT_MAX_SAMPLES
    with pytest.raises(UsageError, match="100000000"):
        make_settings(max_samples=LARGEST_MAX_SAMPLES + 1)


def test_a_long_stroke_is_surveyed_in_parts(monkeypatch):
    """As many rows at once as `AT_ONCE` says: a million of one curve took 700 MB."""
    rows = []
    inner = Schedule.flow

    def flow(self, stroke, tau, faults):
        rows.append(len(tau))
        return inner(self, stroke, tau, faults)

    monkeypatch.setattr(Schedule, "flow", flow)
    curve = Curve(lambda t: (t * t * 0.1, t * 0.2, t * 0.0), 0.0, 1.0)
    drawing = program(stroke(curve, timing=Samples(40_000)), stroke(curve, timing=Samples(7)))
    found = survey(drawing)
    assert max(rows) == AT_ONCE
    assert sum(rows) > 40_000  # all of it
    np.testing.assert_allclose(found.box, plan(drawing, CANVAS).box, atol=1e-15)


def test_faults_of_strokes_are_all_reported():
    cusp = Curve(lambda t: (0.1 * t * t * t, 0.1 * t * t, 0.0 * t), -1.0, 1.0)
    root = Curve(lambda t: (0.1 * _sqrt(t), 0.0 * t, 0.0 * t), 0.0, 1.0)
    segments = [
        replace(stroke(cusp, timing=CruiseSpeed(0.1, 1.0)), span=_span(0)),
        replace(stroke(root, timing=Samples(10)), span=_span(1)),
        replace(
            stroke(Straight((0.1, 0, 0)), timing=CruiseSpeed(0.01, 1), profile="cubic-rates"),
            span=_span(2),
        ),
        replace(stroke(Dwell(), timing=Samples(5)), span=_span(3)),
        replace(segment("turn", "turn", "cubic-rates"), span=_span(4)),
    ]
    with pytest.raises(ScriptError) as caught:
        plan(program(*segments), CANVAS)
    assert codes(caught) == ["E321", "E324", "E322", "E323"]


def _sqrt(t):
    from dqpaint.program.taylor import sqrt

    return sqrt(t)


def _span(i):
    from dqpaint.diagnostics.diagnostic import Span

    return Span(i, i + 1)


def test_a_screw_to_the_antipodal_orientation_goes_the_short_way():
    from dqpaint.program.program import ScrewTo

    q = np.array(START.orientation)
    end = Pose((0.2, 0.0, 0.1), tuple(-q))
    made = stroke(ScrewTo(), START, end, timing=Samples(10), tool=FollowHeading())
    motion = plan(program(made), dq.IDENTITY)
    assert np.abs(motion.twist[:, :3]).max() < 1e-9


def test_profile_is_kept_out_of_the_way_of_a_still_stroke():
    made = replace(stroke(Dwell(), timing=Duration(0.4)), profile=Profile("cubic", (0.1, 0.1)))
    assert not plan(program(made), CANVAS).twist.any()


def test_at_most_twenty_faults_are_told_in_the_order_of_the_text():
    cusp = Curve(lambda t: (0.1 * t * t * t, 0.1 * t * t, 0.0 * t), -1.0, 1.0)
    faulty = stroke(cusp, timing=CruiseSpeed(0.1, 1.0))
    with pytest.raises(ScriptError) as caught:
        plan(program(*(replace(faulty, span=_span(i)) for i in range(60))), CANVAS)
    assert [d.span.start for d in caught.value.diagnostics] == list(range(20))


def test_a_placed_drawing_keeps_the_robot_s_front():
    placed = Pose((0.7, -0.1, 0.5), (1.0, 0.0, 0.0, 0.0))
    motion = plan(program(segment("line", "keep"), placement=placed), CANVAS)
    np.testing.assert_array_equal(motion.front, CANVAS[:4])
    np.testing.assert_allclose(motion.canvas[:4], [1, 0, 0, 0])


def test_the_frame_of_a_photograph_is_wider_by_its_detail_on_each_side():
    text = 'place at (500, 100, 400) mm turned rpy(20 deg, 30 deg, 40 deg)\n' \
           'photo "astronaut.jpg" height 100 mm as hatch detail 5 mm'  # fmt: skip
    here = examples_folder() / "a.traj"
    motion = plan(parse(text, str(here), here), dq.IDENTITY)
    (corners,), (frame,) = motion.photo_corners, motion.photo_frames
    assert frame.mean(axis=0) == pytest.approx(corners.mean(axis=0))
    sides, wider = (np.roll(four, -1, axis=0) - four for four in (corners, frame))
    lengths = np.linalg.norm(sides, axis=1)
    assert np.linalg.norm(wider, axis=1) == pytest.approx(lengths + 0.01)
    assert wider / (lengths + 0.01)[:, None] == pytest.approx(sides / lengths[:, None])
    assert lengths[1] == pytest.approx(0.1)
    assert abs(sides[0] @ sides[1]) < 1e-9


def test_a_stroke_error_says_its_first_message():
    found = [Diagnostic(f"E{n}", f"fault {n}", None, "", "") for n in (1, 2)]
    assert str(StrokeError(*found)) == "fault 1"
    assert StrokeError(*found).diagnostics == tuple(found)


def test_the_speed_of_a_shape_is_the_first_of_its_speeds():
    for text in (
        "line by (30, 40, 0) mm",
        "arc centre (30, 0) mm angle 80 deg rise 20 mm",
        "screw about (10, 0, 0) mm along (1, 2, 3) angle 50 deg pitch 9 mm/turn",
    ):
        made = gather_shapes(parse(text, "a").segments, {})
        form, f = made.shape(0), np.linspace(0.05, 0.95, 7)
        h = 1e-5
        ways = np.linalg.norm(
            dq.translation(form.flow(f + h).pose) - dq.translation(form.flow(f - h).pose), axis=1
        )
        assert form.speed(f) == pytest.approx(ways / (2 * h), rel=1e-6)
