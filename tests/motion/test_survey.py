"""What a survey says is what the plan says; and many strokes at once are what each is alone."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.language import ScriptError, parse, read
from dqpaint.motion import Motion, plan, survey
from dqpaint.motion.geometry.arc_length import measure_stroke
from dqpaint.motion.geometry.batched_shapes import gather_shapes
from dqpaint.motion.geometry.orientations import LookAtLine, LookAtPoint
from dqpaint.motion.geometry.paths import Lines
from dqpaint.motion.geometry.shapes import PositionAndOrientation
from dqpaint.program.program import CruiseSpeed, Duration, Program
from tests.support.drawings import drawing
from tests.support.strokes import KINDS, PROFILES, program, segment

FOLDER = Path(__file__).parents[2] / "trajectories"
FILES = sorted(FOLDER.glob("*.traj"))
CANVAS = dq.pose_from([0.7, -0.1, 0.5], np.array([0.5, 0.5, 0.5, 0.5]))
CHAINS = [
    'text "Ada" "Wo!" font "scripts" height 9 mm at (1, 2) mm tool rpy(0, 20 deg, 30 deg)\n'
    'text "By" width 30 mm tool look (9, 9, -99) mm in 3 s light red to blue even',
    "blend 3 mm\n"
    "line to (50, 0) mm to (50, 50) mm to (10, 50) mm light red to blue profile constant\n"
    "line to (0, 0) light white even profile constant\nhold 1 s light off to red",
    "arc centre (30, 0) mm angle 300 deg\narc centre (30, 9) mm angle 9 deg tool follow",
    "stroke profile constant\nline by (9, 0) mm\nline by (0, 9) mm\nline by (-9, 0) mm\nend",
]


def same(program: Program) -> Motion | None:
    """Compares both answers; the motion, if there is one."""
    try:
        with np.errstate(all="ignore"):
            motion = plan(program, CANVAS)
    except ScriptError as fault:
        planned = fault.diagnostics
        with np.errstate(all="ignore"), pytest.raises(ScriptError) as surveyed:
            survey(program)
        assert surveyed.value.diagnostics == planned
        return None
    found = survey(program)
    assert found.notes == motion.notes
    assert found.samples == len(motion.t)
    assert (found.seconds, found.length) == (motion.t[-1], motion.length)
    assert found.unevenness == motion.unevenness
    if np.abs(motion.points).max() < 1e9:  # farther out a box is rounding alone
        np.testing.assert_allclose(found.box, motion.box, rtol=1e-12, atol=1e-13)
    return motion


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_survey_of_an_example_is_that_of_its_plan(path):
    assert same(read(path)) is not None


@pytest.mark.parametrize("seed", range(12))
def test_a_survey_of_any_drawing_is_that_of_its_plan(seed):
    same(parse(drawing(seed), "any.traj"))


@pytest.mark.parametrize("text", CHAINS)
def test_a_survey_of_letters_and_rounded_corners_is_that_of_their_plan(text):
    assert same(parse(text, "any.traj")) is not None


@pytest.mark.parametrize("seed", range(40, 50))
def test_a_survey_finds_every_fault_that_the_plan_finds(seed):
    assert same(parse(drawing(seed, faults=4), "any.traj")) is None


@pytest.mark.slow
@pytest.mark.parametrize(("path", "tool"), KINDS)
@pytest.mark.parametrize("huge", [1e60, 1e155, 1e300, np.inf, np.nan])
def test_a_survey_finds_numbers_that_grow_beyond_all_numbers(path, tool, huge):
    made = segment(path, tool)
    for wild in (
        replace(made, start=replace_place(made.start, huge)),
        replace(
            made,
            timing=CruiseSpeed(0.08, 0.9),
            profile=replace(PROFILES["cubic"], rates=(huge, 0.0)),
        ),
    ):
        with np.errstate(all="ignore"):
            same(program(wild))


def replace_place(pose, x):
    return pose._replace(position=(x, *pose.position[1:]))


def alone(program: Program, chosen: slice) -> Motion:
    """A part of a drawing as a drawing of its own."""
    return plan(replace(program, segments=program.segments[chosen]), CANVAS)


def runs(program: Program) -> list[slice]:
    """The segments of each stroke."""
    number = [s.stroke.number if s.stroke else -i for i, s in enumerate(program.segments, 1)]
    starts = [i for i, n in enumerate(number) if i == 0 or n != number[i - 1]]
    return [slice(*pair) for pair in zip(starts, [*starts[1:], len(number)], strict=True)]


@pytest.mark.parametrize("text", [*map(drawing, (1, 3, 5, 7, 9)), *CHAINS])
def test_many_strokes_at_once_are_what_each_is_alone(text):
    drawn = parse(text, "any.traj")
    motion, first = plan(drawn, CANVAS), 0
    for own in runs(drawn):
        single = alone(drawn, own)
        rows = slice(first, first + len(single.t) - 1)
        first = rows.stop
        asked = single.pose[:-1]
        np.testing.assert_allclose(dq.nearest(motion.pose[rows], asked), asked, atol=1e-13)
        for name in ("twist", "acceleration", "light"):
            theirs = getattr(single, name)[:-1]
            if name == "light" and isinstance(drawn.segments[own.start].timing, Duration):
                theirs = theirs * (motion.light[rows].max() / max(theirs.max(), 1e-9))
            scale = 1.0 + np.abs(theirs).max()
            np.testing.assert_allclose(
                getattr(motion, name)[rows], theirs, rtol=0, atol=1e-11 * scale
            )
        np.testing.assert_array_equal(motion.stroke[rows], single.stroke[:-1] + own.start)
        np.testing.assert_array_equal(motion.source.line[rows], single.source.line[:-1])
    assert first == len(motion.t) - 1


def lines(count: int) -> str:
    """Lines, colours, arcs, pauses and jumps, none in the place of another."""
    kinds = [
        "line to ({x}, {y}) mm",
        "line to ({x}, {y}, {z}) mm light red to blue",
        "light hsv({x} deg)",
        "arc via ({y}, {z}) mm to ({x}, {y}) mm tool keep",
        "line by ({z}, {x}) mm in 0.5 s profile cubic(5 mm/s, 9 mm/s) light white even",
        "hold 0.1 s light off",
        "step to ({y}, {x}) mm",
        "arc centre ({y}, {z}) mm angle {x} deg profile constant",
    ]
    numbers = ({"x": i % 97 + 1, "y": i % 89 + 100, "z": i % 83 - 99} for i in range(count))
    return "\n".join(kinds[i % len(kinds)].format(**n) for i, n in enumerate(numbers))


def calls(work) -> int:
    """How many functions a piece of work calls, those of numpy and of Python's own included."""
    count = 0

    def note(_frame, event, _what) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(note)
    try:
        work()
    finally:
        sys.setprofile(None)
    return count


LOOKS = [
    "line to ({x}, {y}) mm tool look (0, 0, 500) mm",
    "line to ({x}, {y}) mm tool look line (900, 0, 90) mm along (1, 2, 3)",
    "arc centre ({x}, {z}) mm angle {x} deg tool look (0, 0, 500) mm",
    'text "Il" height 9 mm tool look (0, 0, 500) mm',
]


def looks(*forms: str, count: int) -> Program:
    """Strokes on which the tool looks at something."""
    numbers = ({"x": i % 97 + 1, "y": i % 89 + 100, "z": i % 83 - 99} for i in range(count))
    forms = ("start at (0, 0) mm", *(forms[i % len(forms)] for i in range(count)))
    return parse(
        "\n".join(form.format(**n) for form, n in zip(forms, numbers, strict=False)), "l.traj"
    )


def test_the_angles_of_many_tools_at_once_are_those_of_each_alone():
    """Against panels ever finer, which took 0.3 ms a line; and so are the timetables."""
    drawing = looks(*LOOKS, count=80)
    shapes = gather_shapes(drawing.segments, {})
    for number in range(len(drawing.segments)):
        form = shapes.shape(number)
        if not form.uniform:
            assert form.uniform_position
            alone = measure_stroke(form)
            assert shapes.length[number] == pytest.approx(alone.length, rel=1e-14)
            assert shapes.angle[number] == pytest.approx(alone.angle, rel=1e-11)
    assert same(drawing) is not None


def test_a_tool_that_must_turn_at_once_is_measured_too():
    """It passes 0.3 mm beside the line of 'up': there it turns by nearly half a turn."""
    look = "tool look (0, 0, 0) up y"
    drawing = parse(f"start at (-10, 5, 0) mm {look}\nline to (10, 25, 1) mm {look}", "up.traj")
    shapes = gather_shapes(drawing.segments, {})
    assert shapes.angle[0] > 2.5
    assert shapes.angle[0] == pytest.approx(measure_stroke(shapes.shape(0)).angle, rel=1e-9)
    assert same(drawing) is not None


def test_a_look_is_steep_where_a_line_comes_close():
    """To the point, or to where it is looked at along `up`; there all samples are asked."""
    point, up = np.zeros((1, 3)), np.array([[0.0, 1.0, 0.0]])
    for start, by, steep in [
        ((-1, 2, 0), (2, 0, 0), True),  # over the point, in the middle
        ((-1, 2, 1e-9), (2, 1, 0), True),
        ((-1, 2, 0), (0.5, 0, 0), False),  # it ends before
        ((-1, 2, 1), (2, 0, 0), False),
        ((-1, 0, 0), (2, 0, 0), True),  # through it
    ]:
        line = Lines(np.array([start], dtype=float), np.array([by], dtype=float))
        with np.errstate(all="ignore"):
            assert (LookAtPoint(point, up).largest_parameter_along(line)[0] > 1e9) == steep
    for start, steep in [((-1, 5, 0), True), ((-1, 5, 1), False)]:
        line = Lines(np.array([start], dtype=float), np.array([[2.0, 3.0, 0.0]]))
        with np.errstate(all="ignore"):
            assert (LookAtLine(point, up).largest_parameter_along(line)[0] > 1e9) == steep


def test_one_more_line_on_which_the_tool_looks_costs_few_calls():
    few, many = (looks(*LOOKS[:2], count=count) for count in (200, 400))
    survey(few)
    more = calls(lambda: survey(many)) - calls(lambda: survey(few))
    assert more < MOST_CALLS["survey"] * 200, more / 200


MOST_CALLS = {"read": 600, "survey": 40, "plan": 40}  # for one more line


def test_one_more_line_costs_few_calls():
    """A stroke that is computed by itself takes several hundred calls of numpy."""
    few, many = (parse(lines(count), "lines.traj") for count in (200, 400))
    works = {
        "read": lambda drawn: parse(drawn.text, "lines.traj"),
        "survey": survey,
        "plan": lambda drawn: plan(drawn, CANVAS),
    }
    for name, work in works.items():
        work(few)
        more = calls(lambda work=work: work(many)) - calls(lambda work=work: work(few))
        assert more < MOST_CALLS[name] * 200, (name, more / 200)


POLES = [
    "(0, 1/(t - 2)) mm",  # it shows in one panel at any fineness
    "(t, 1/(t - 2.1)) mm",
    "(t, 1/(t - 2.3)) mm",
    "(t, 10*tan(t*rad)) mm",
    "(t, 1/(t - 2)^2) mm",
]
STEEP = {
    "abs(t - 2.3)": lambda t: np.abs(t - 2.3),
    "sqrt(abs(t - 2.3))": lambda t: np.sqrt(np.abs(t - 2.3)),
    "30*sin(50*t*rad)": lambda t: 30 * np.sin(50 * t),
    "30*sin(200*t*rad)": lambda t: 30 * np.sin(200 * t),
}


@pytest.mark.parametrize("formula", POLES)
def test_a_curve_through_a_pole_has_no_length(formula):
    drawing = parse(f"curve {formula} for t from 0 to 5", "pole.traj")
    with pytest.raises(ScriptError) as caught:
        survey(drawing)
    assert [found.code for found in caught.value.diagnostics] == ["E327"]


@pytest.mark.parametrize(
    "formula", [pytest.param(f, marks=[pytest.mark.slow] * ("200" in f)) for f in STEEP]
)
def test_a_curve_with_a_corner_or_many_bends_has_one(formula):
    drawing = parse(f"curve (t, {formula}) mm for t from 0 to 5", "steep.traj")
    t = np.linspace(0.0, 5.0, 2_000_001)
    y = STEEP[formula](t)
    way = np.hypot(np.diff(t), np.diff(y)).sum() * 1e-3
    move = np.hypot(0.0, y[0]) * 1e-3  # from the origin to its start
    assert survey(drawing).length == pytest.approx(way + move, rel=2e-3)


def shapes(text: str):
    return gather_shapes(parse(text, "a").segments, {}).families


ANY = """line by (30, 10, 5) mm tool rpy(0, 20 deg, 30 deg)
arc centre (20, 9) mm angle 200 deg rise 9 mm grow 5 mm
arc centre (20, 19) mm angle 100 deg rise 9 mm
move to (9, 2) mm
curve (exp(t/9)*9 mm*cos(t*1 rad) + ln(t)*1 mm, atan(t)/rad*1 mm + sqrt(t)*2 mm,
  asin(t/9)/rad*1 mm + max(t, 3 - t)^3*1 mm + 1 mm/(1 + t)) for t from 1 to 4
text "S" height 20 mm at (0, 0)
"""


def test_the_velocity_alone_is_the_one_of_all_derivatives() -> None:
    f = np.linspace(0.03, 0.98, 57)
    loose = [form.positions for form in shapes(ANY) if isinstance(form, PositionAndOrientation)]
    assert len({type(places) for places in loose}) >= 4
    for places in loose:
        one = places.select(0)
        assert np.array_equal(one.velocity(f), one(f)[1])


def test_curves_that_come_after_too_many_samples_are_not_measured(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    measured = []
    monkeypatch.setattr(
        "dqpaint.motion.geometry.batched_shapes.measure_stroke",
        lambda shape: measured.append(shape) or measure_stroke(shape),
    )
    text = (
        "repeat 60\ncurve (t*t*1 mm, t*1 mm) for t from 0 to 9 speed 1 mm/s\nend\nline by (9, 0) mm"
    )
    few = replace(parse(text, "a"), most_samples=50_000)  # each takes 11,000 or so
    with pytest.raises(ScriptError) as refused:
        survey(few)
    assert len(measured) == 5
    monkeypatch.setattr(
        "dqpaint.motion.schedule.gather_shapes",
        lambda segments, faults, _: gather_shapes(segments, faults),
    )
    with pytest.raises(ScriptError) as told:
        survey(few)
    assert len(measured) == 65
    assert refused.value.diagnostics == told.value.diagnostics
    assert [found.code for found in refused.value.diagnostics] == ["E302"]
