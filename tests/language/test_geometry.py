"""Frames, arcs, looks, screws, heading: every end pose against an independent calculation."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from dqpaint.language import ScriptError
from dqpaint.language.values import vectors
from dqpaint.program.program import (
    Arc,
    Duration,
    FixedOrientation,
    FollowHeading,
    Look,
    LookLine,
    Samples,
    Screw,
    ScrewTo,
    SlerpOrientation,
    Straight,
)
from tests.support.drawn import drawn, last, matrix, only, rotation

Z = (0.0, 0.0, 1.0)


def written(p: NDArray[np.float64]) -> str:
    return f"({p[0]:.17g}, {p[1]:.17g}, {p[2]:.17g}) m"


# Frames.


def test_with_applies_its_parts_outermost_first() -> None:
    end = last("start at (0,0)\nwith rotate 90 deg shift (80, 0) mm\nline to (10, 0) mm\nend").end
    assert end.position == pytest.approx((0, 0.09, 0), abs=1e-16)
    end = last("start at (0,0)\nwith shift (80, 0) mm rotate 90 deg\nline to (10, 0) mm\nend").end
    assert end.position == pytest.approx((0.08, 0.01, 0), abs=1e-16)
    end = last("with scale 2 shift (80, 0) mm scale 3\nline to (10, 0) mm\nend").end
    assert end.position == pytest.approx((0.22, 0, 0), abs=1e-16)


def test_nested_with_is_the_same_as_one() -> None:
    inner = "line to (10, 20, 30) mm"
    one = last(f"with rotate 30 deg about x shift (1,2,3) cm scale 0.5\n{inner}\nend")
    two = last(f"with rotate 30 deg about x\nwith shift (1,2,3) cm scale 0.5\n{inner}\nend\nend")
    expected = rotation((1, 0, 0), 30) @ (0.5 * np.array([0.01, 0.02, 0.03]) + [0.01, 0.02, 0.03])
    assert one.end.position == pytest.approx(tuple(expected))
    assert two.end.position == pytest.approx(tuple(expected))


def test_rotate_about_a_point_keeps_the_point() -> None:
    point = "(10, 20) mm"
    end = last(f"with rotate 77 deg about {point}\nline to {point}\nend").end
    assert end.position == pytest.approx((0.01, 0.02, 0), abs=1e-16)


def test_a_frame_turns_by_and_axes_and_orientations_and_scales_lengths() -> None:
    program = drawn(
        "start at (0,0) tool rpy(10 deg, 20 deg, 30 deg)\n"
        "with rotate rot((1,2,3), 50 deg) scale 3\n"
        "line by (10, 20, 5) mm\n"
        "arc centre (30, 0, 0) mm axis x+y angle 70 deg rise 4 mm grow 2 mm\n"
        "line by (1, 0) mm tool rpy(1 deg, 2 deg, 3 deg)\n"
        "screw about (5, 5) mm along y angle 40 deg pitch 36 mm/turn\n"
        "end"
    )
    r = rotation((1, 2, 3), 50)
    straight, arc, turn, screw = program.segments
    start = rotation((0, 0, 1), 30) @ rotation((0, 1, 0), 20) @ rotation((1, 0, 0), 10)
    assert matrix(program.start.orientation) == pytest.approx(start, abs=1e-15)
    assert straight.tool == FixedOrientation()  # keep is kept in the world
    assert straight.end.position == pytest.approx(tuple(3 * r @ [0.01, 0.02, 0.005]))
    assert isinstance(arc.path, Arc)
    assert arc.path.centre == pytest.approx(tuple(3 * r @ [0.03, 0, 0]))
    assert arc.path.axis == pytest.approx(tuple(r @ np.array([1, 1, 0]) / math.sqrt(2)))
    assert (arc.path.rise, arc.path.grow) == (pytest.approx(0.012), pytest.approx(0.006))
    inside = rotation((0, 0, 1), 3) @ rotation((0, 1, 0), 2) @ rotation((1, 0, 0), 1)
    assert turn.tool == SlerpOrientation()
    assert matrix(turn.end.orientation) == pytest.approx(r @ inside, abs=1e-14)
    assert isinstance(screw.path, Screw)
    assert screw.path.advance == pytest.approx(3 * 0.036 * 40 / 360)
    assert screw.path.axis == pytest.approx(tuple(r @ [0, 1, 0]))


def test_speed_is_never_scaled() -> None:
    slow = last("speed 10 mm/s\nwith scale 5\nline by (1,0) mm\nend").timing
    assert slow == last("speed 10 mm/s\nline by (1,0) mm").timing


def test_settings_end_with_their_block_but_not_with_a_loop() -> None:
    program = drawn(
        "with light red speed 1 mm/s\nprofile constant\nline by (1,0) mm\nend\nline by (1,0) mm\n"
        "repeat 2\nline by (1,0) mm\nprofile constant\nend\n"
        "line by (1,0) mm light off\nline by (1,0) mm"
    )
    profiles = [s.profile.name for s in program.segments]
    assert profiles == ["constant", "trapezoid", "trapezoid", "constant", "constant", "constant"]
    reds = [s.light and s.light.first for s in program.segments]
    assert reds == [(1, 0, 0), (1, 1, 1), (1, 1, 1), (1, 1, 1), None, (1, 1, 1)]


def test_by_is_not_shifted() -> None:
    end = last(
        "start at (5, 0) mm\nwith shift (80, 0) mm rotate 90 deg\nline by (1, 0) mm\nend"
    ).end
    assert end.position == pytest.approx((0.005, 0.001, 0), abs=1e-16)


def test_a_frame_takes_looks_along() -> None:
    begin = "with rotate rot((1,2,3), 50 deg) shift (3, 4, 5) mm scale 2\n"
    r = rotation((1, 2, 3), 50)
    point = tuple(r @ (2 * np.array([0.01, 0.02, 0.09]) + [0.003, 0.004, 0.005]))
    look = only(f"{begin}tool look (10, 20, 90) mm up x\nline by (1, 0) mm\nend").tool
    assert isinstance(look, Look)
    assert look.point == pytest.approx(point)
    assert look.up == pytest.approx(tuple(r[:, 0]))
    line = only(f"{begin}line by (1, 0) mm tool look line (10, 20, 90) mm along x\nend").tool
    assert isinstance(line, LookLine)
    assert line.point == pytest.approx(point)
    assert line.along == pytest.approx(tuple(r[:, 0]))
    default = only(f"{begin}line by (1, 0) mm tool look (10, 20, 9) mm\nend").tool
    assert isinstance(default, Look)
    assert default.up == pytest.approx(tuple(r[:, 1]))


# Arcs.


def test_arc_through_three_points(rng: np.random.Generator) -> None:
    for size in (1e-3, 0.1, 10.0):
        for _ in range(20):
            q = rng.normal(size=(3, 3))
            r = np.linalg.qr(q)[0]
            r *= np.sign(np.linalg.det(r))
            centre = rng.normal(size=3) * size
            angle = rng.uniform(0.1, 6.1)
            share = rng.uniform(0.1, 0.9)

            angles = np.array([0, share * angle, angle])
            circle = size * np.array([np.cos(angles), np.sin(angles), 0 * angles])
            start, via, end = map(written, (r @ circle).T + centre)
            segment = only(f"start at {start}\narc via {via} to {end}")
            assert isinstance(segment.path, Arc)
            assert segment.path.centre == pytest.approx(tuple(centre), abs=1e-9 * size)
            assert segment.path.axis == pytest.approx(tuple(r[:, 2]), abs=1e-9)
            assert segment.path.angle == pytest.approx(angle, abs=1e-9)


def test_arc_end(rng: np.random.Generator) -> None:
    for _ in range(20):
        start, centre, axis = rng.normal(size=(3, 3))
        angle, rise, grow = rng.uniform(-700, 700), rng.normal(), rng.uniform(0, 1)
        segment = only(
            f"tool follow\nstart at {written(start)} tool rpy(5 deg, 6 deg, 7 deg)\n"
            f"arc centre {written(centre)} axis {written(axis)} angle {angle:.17g} deg"
            f" rise {rise:.17g} m grow {grow:.17g} m"
        )
        n = axis / np.linalg.norm(axis)
        along = ((start - centre) @ n) * n
        across = start - centre - along
        stretched = across * (1 + grow / np.linalg.norm(across))
        turn = rotation(tuple(axis), angle)
        end = centre + along + turn @ stretched + rise * n
        assert segment.end.position == pytest.approx(tuple(end), abs=1e-12)
        assert matrix(segment.end.orientation) == pytest.approx(
            turn @ matrix(segment.start.orientation), abs=1e-12
        )
        assert segment.tool == FollowHeading(pytest.approx(tuple(n)))


def test_a_flat_spiral_may_end_in_its_centre() -> None:
    end = only("start at (70, 0) mm\narc centre (0,0) angle 3 turn grow -70 mm").end
    assert end.position == pytest.approx((0, 0, 0), abs=1e-16)


# Tools.


def test_look(rng: np.random.Generator) -> None:
    for _ in range(20):
        start, by, point, up = rng.normal(size=(4, 3))
        program = drawn(
            f"start at {written(start)}\n"
            f"line by {written(by)} tool look {written(point)} up {written(up)}"
        )
        (segment,) = program.segments
        assert isinstance(segment.tool, Look)
        for pose in (segment.start, segment.end):
            z = point - pose.position
            z /= np.linalg.norm(z)
            x = np.cross(up, z) / np.linalg.norm(np.cross(up, z))
            expected = np.column_stack([x, np.cross(z, x), z])
            assert matrix(pose.orientation) == pytest.approx(expected, abs=1e-12)
        assert program.start == segment.start  # nothing else said how the tool is held


def test_look_line(rng: np.random.Generator) -> None:
    for _ in range(20):
        start, by, point, along = rng.normal(size=(4, 3))
        segment = only(
            f"tool look line {written(point)} along {written(along)}\n"
            f"start at {written(start)}\nline by {written(by)}"
        )
        assert isinstance(segment.tool, LookLine)
        for pose in (segment.start, segment.end):
            x = along / np.linalg.norm(along)
            z = point - pose.position
            z -= (z @ x) * x
            z /= np.linalg.norm(z)
            expected = np.column_stack([x, np.cross(z, x), z])
            assert matrix(pose.orientation) == pytest.approx(expected, abs=1e-12)


def test_a_look_along_up_is_found_wherever_it_is_on_the_way() -> None:
    """Not where it is nearest to the point; in the middle of a line; `up` is y."""
    for end, up, wrong in (
        ("(10, 25, 0)", "y", True),
        ("(10, 25, 0.02)", "y", True),  # within a degree
        ("(10, 25, 2)", "y", False),
        ("(10, 25, 0)", "z", False),
        ("(10, -45, 0)", "y", True),  # it looks up there, not down
        ("(-1, 14, 0)", "y", False),  # it ends before
    ):
        look = f"tool look (0, 0, 0) up {up}"
        text = f"start at (-10, 5, 0) mm {look}\nline to {end} mm {look}"
        if not wrong:
            drawn(text)
            continue
        with pytest.raises(ScriptError, match=r"E252.*\n --> test.traj:2:1"):
            drawn(text)
    assert only("line by (1, 0) mm tool look (0, 0, -50) mm").tool == Look((0, 0, -0.05), (0, 1, 0))


def test_a_look_that_begins_elsewhere_turns_in_the_dark_first() -> None:
    program = drawn("line by (1, 0) mm\nline by (1, 0) mm tool look (0, 0, -50) mm up y")
    _, turn, stroke = program.segments
    assert turn.path == Straight((0, 0, 0))
    assert turn.tool == SlerpOrientation()
    assert turn.light is None
    assert turn.profile.name == "trapezoid"
    assert stroke.start.orientation == turn.end.orientation
    assert [note.code for note in program.notes] == ["W404"]


def test_a_move_sets_the_start_only_where_nothing_else_does() -> None:
    text = "move to (5, 0) mm by (0, 1) mm\nline by (1, 0) mm"
    program = drawn(text)
    assert program.start.position == pytest.approx((0.005, 0, 0))
    assert [s.light is None for s in program.segments] == [True, False]
    program = drawn(f"start at (1, 1) mm\n{text}")
    assert program.start.position == pytest.approx((0.001, 0.001, 0))
    assert [s.light is None for s in program.segments] == [True, True, False]
    assert drawn("move to (5, 0) mm tool rot(x, 90 deg)\nline by (1, 0) mm").start.orientation == (
        pytest.approx((math.sqrt(0.5), math.sqrt(0.5), 0, 0))
    )


def test_a_setting_before_the_start_is_how_the_tool_is_held() -> None:
    program = drawn("tool rot(x, 40 deg)\nmove to (1, 2) mm\nline by (1, 0) mm")
    assert len(program.segments) == 1
    assert matrix(program.start.orientation) == pytest.approx(rotation((1, 0, 0), 40), abs=1e-15)
    assert program.segments[0].tool == FixedOrientation()


def test_turn_and_light_and_time_are_spread_over_a_polyline() -> None:
    program = drawn(
        "line by (30, 0) mm by (0, 10) mm by (-60, 0) mm tool rot(z, 100 deg)"
        " light red to blue samples 11"
    )
    assert [s.timing for s in program.segments] == [Samples(n) for n in (3, 2, 6)]
    shares = (0.3, 0.4, 1.0)
    for segment, share in zip(program.segments, shares, strict=True):
        assert matrix(segment.end.orientation) == pytest.approx(rotation(Z, 100 * share), abs=1e-12)
        assert segment.light is not None
        assert segment.light.last == pytest.approx((1 - share, 0, share))
    assert program.segments[0].light.first == (1, 0, 0)
    times = drawn("line by (30, 0) mm by (0, 10) mm by (-60, 0) mm in 5 s").segments
    assert [s.timing for s in times] == [Duration(pytest.approx(t)) for t in (1.5, 0.5, 3.0)]


def test_turn_on_the_spot() -> None:
    segment = only("line by (0, 0) tool rot(y, 30 deg) in 2 s")
    assert segment.path == Straight((0, 0, 0))
    assert segment.tool == SlerpOrientation()
    assert matrix(segment.end.orientation) == pytest.approx(rotation((0, 1, 0), 30), abs=1e-15)


@pytest.mark.parametrize(
    ("curve", "degrees"),
    [
        ("polar(10 mm, t) for t from 0 to 250 deg", 250),
        ("polar(10 mm, t) for t from 250 deg to 0", -250),
        ("polar(10 mm, t) for t from 0 to 5 turns", 1800),
        ("(t, 0) for t from 0 to 9 mm", 0),
        ("(t, t^2/mm) for t from 0 to 0.5 mm", 45),
    ],
)
def test_follow_turns_with_the_heading(curve: str, degrees: float) -> None:
    segment = last(f"start at (10, 0) mm tool rpy(3 deg, 4 deg, 5 deg)\ncurve {curve} tool follow")
    before = matrix(segment.start.orientation)
    assert segment.tool == FollowHeading(Z)
    assert matrix(segment.end.orientation) == pytest.approx(rotation(Z, degrees) @ before, abs=1e-9)


def test_a_curve_that_starts_elsewhere_gets_a_dark_way() -> None:
    program = drawn("profile constant\ncurve (t, 42 mm) for t from 0 to 9 mm")
    way, curve = program.segments
    assert way.light is None
    assert way.path == Straight(pytest.approx((0, 0.042, 0)))
    assert way.profile.name == "trapezoid"
    assert curve.profile.name == "constant"
    assert [note.code for note in program.notes] == ["W402"]


# Screws.


def test_screw_about(rng: np.random.Generator) -> None:
    for _ in range(10):
        start, point, axis = rng.normal(size=(3, 3))
        angle, pitch = rng.uniform(-400, 400), rng.normal()
        segment = only(
            f"start at {written(start)} tool rpy(11 deg, 12 deg, 13 deg)\n"
            f"screw about {written(point)} along {written(axis)} angle {angle:.17g} deg"
            f" pitch {pitch:.17g} m/turn"
        )
        turn, n = rotation(tuple(axis), angle), axis / np.linalg.norm(axis)
        end = point + turn @ (start - point) + pitch * angle / 360 * n
        assert segment.end.position == pytest.approx(tuple(end), abs=1e-12)
        assert matrix(segment.end.orientation) == pytest.approx(
            turn @ matrix(segment.start.orientation), abs=1e-12
        )


def test_screw_to() -> None:
    segment = only("screw to (1, 2, 3) cm tool rot(x, 50 deg)")
    assert segment.path == ScrewTo()
    assert segment.end.position == pytest.approx((0.01, 0.02, 0.03))
    assert matrix(segment.end.orientation) == pytest.approx(rotation((1, 0, 0), 50), abs=1e-15)


# Light.


def test_lights() -> None:
    program = drawn(
        'light "#f00" to blue 50%\nline by (1,0) mm\nhold 1 s\nhold 1 s light red to off\n'
        "light off\nline by (1,0) mm\nline by (1,0) mm light on\nlight lime\n"
        "line by (1,0) mm light on 40%\nline by (1,0) mm light on 40%\n"
        "step to (9,9) mm\nmove by (1,0) mm"
    )
    lights = [s.light and (s.light.first, s.light.last) for s in program.segments]
    assert lights == [
        ((1, 0, 0), (0, 0, 0.5)),
        ((0, 0, 0.5), (0, 0, 0.5)),  # a pause shines as the stroke before it ended
        ((1, 0, 0), (0, 0, 0)),
        None,
        ((1, 0, 0), (0, 0, 0.5)),  # on: what shone last
        ((0, 0.4, 0), (0, 0.4, 0)),
        ((0, 0.4, 0), (0, 0.4, 0)),
        ((0, 1, 0), (0, 1, 0)),
        None,
    ]


def test_unit_helpers_are_exact_at_the_edges() -> None:
    assert vectors.turn_between((1, 0, 0, 0), (-1, 0, 0, 0)) == 0
    assert vectors.turn_between((1, 0, 0, 0), (0, 1, 0, 0)) == pytest.approx(math.pi)
    tiny = vectors.turn_about(Z, 1e-9)
    assert vectors.turn_between((1, 0, 0, 0), tiny) == pytest.approx(1e-9)
    assert vectors.unit((1e-300, 0, 0)) == (1, 0, 0)
    for degrees in (0, 90, 179.999, 180, -120):
        for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, -1, 1)):
            r = rotation(axis, degrees)
            columns = [tuple(r[:, i]) for i in range(3)]
            assert matrix(vectors.turn_of_axes(*columns)) == pytest.approx(r, abs=1e-12)
