"""Strokes of several lines: one profile over all, derivatives, joints, light, time, warnings."""

import math

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.language import ScriptError, parse
from dqpaint.language.pen.stroke_state import ACCELERATION
from dqpaint.motion import plan
from dqpaint.motion.geometry.batched_shapes import gather_shapes
from dqpaint.motion.geometry.speed_limits import ARM
from tests.support import strokes

PERIOD = 0.008
START = "start at (110, -70, 50) mm tool rpy(20 deg, 30 deg, 40 deg)\n"
# Tangent from line to arc to line to curve, each with the tool doing something else.
SMOOTH = """
  line by (40, 0, 0) mm tool rpy(50 deg, -10 deg, 80 deg)
  arc centre (150, -40, 50) mm angle 90 deg tool follow
  line by (0, 60, 0) mm
  arc centre (150, 20, 50) mm angle 130 deg tool look (300, 200, -400) mm up (0, 3, 4)
"""
BENT = """
  line by (40, 0, 10) mm tool rpy(50 deg, -10 deg, 80 deg)
  arc via (200, -30, 40) mm to (150, 60, 80) mm tool follow
  curve (150 + 40*sin(t), 60 + 30*t/rad + 5*sin(3*t), 80 + 20*(t/rad)^2) mm for t from 0 to 1.3 rad
  arc centre (140, 40, 7) mm axis (1, -2, 2) angle 1.3 turn rise -10 mm grow 25 mm tool follow
  screw about (5, 6, 7) mm along (1, -2, 2) angle 100 deg pitch 30 mm/turn
"""
LOOSE = SMOOTH.replace("tool look (300, 200, -400) mm up (0, 3, 4)", "tool keep")
BLENDED = """
  line by (40, 0, 10) mm tool rpy(50 deg, -10 deg, 80 deg)
  line by (-10, 50, 20) mm
  arc via (180, 10, 40) mm to (220, 60, 80) mm tool follow
  line by (-10, 50, 20) mm tool rpy(5 deg, -10 deg, 80 deg)
"""
PROFILES = [
    *("constant", "trapezoid", "cubic", "quintic", "cubic(20 mm/s, 30 mm/s)"),
    "trapezoid corner 0.1 mm",
]


def strokes_of(text):
    return strokes.strokes_of(parse(text, "run.traj"))


def stroke_of(body, clauses="in 6 s", before=""):
    return strokes_of(f"{START}{before}\nstroke {clauses}\n{body}end\n")[-1]


def test_a_smooth_chain_changes_its_velocity_within_its_acceleration():
    """Where the tool begins to turn it slows down: its turning may jump by a little only."""
    text = f"{START}stroke speed 60 mm/s turnspeed 400 deg/s\n{LOOSE}end"
    motion = plan(parse(text, "a"), dq.IDENTITY)
    assert not motion.notes
    velocity = dq.point_velocity(motion.twist, motion.points)
    change = np.linalg.norm(np.diff(velocity, axis=0), axis=1) / PERIOD
    assert change.max() < ACCELERATION * math.sqrt(2.0) * (1 + 1e-9)
    turning = np.linalg.norm(np.diff(motion.twist[:, :3], axis=0), axis=1)
    assert turning.max() < 2.0 * ACCELERATION / ARM * PERIOD * 1.01


BODIES = {
    "loose": (LOOSE, ""),
    "bent": (BENT, ""),
    "blended": (BLENDED, "blend 7 mm"),
    "looking": (BLENDED.replace("tool", "# tool"), "tool look (300, 90, -430) mm\nblend 7 mm"),
}


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("body", BODIES)
def test_twist_and_acceleration_are_derivatives(rng, body, profile):
    lines, before = BODIES[body]
    ahead = "" if "corner" in profile else "corner jump\n"
    stroke = stroke_of(lines, f"in 6 s profile {profile}", ahead + before)
    time, step = stroke.count * PERIOD, 0.001
    grid = np.linspace(0, 1, 20_001)
    joints = np.interp(stroke.edges, stroke.progress(grid).value, grid)
    tau = rng.uniform(0, 1, 500)
    breaks = np.concatenate([joints, [0.0, 0.2, 0.8, 1.0]])
    if stroke.table.pace is not None:
        phases = stroke.table.pace
        breaks = np.concatenate([breaks, phases.time / phases.seconds[-1]])
        step = 5e-5
    tau = tau[np.abs(tau[:, None] - breaks).min(axis=1) > 2 * step][:120]
    assert len(tau) > 60
    now = stroke.flow(tau)

    def errors(h):
        ahead, behind = (stroke.flow(tau + s * h) for s in (1, -1))
        rate = dq.nearest(ahead.pose, now.pose) - dq.nearest(behind.pose, now.pose)
        slope = (ahead.twist - behind.twist) / (2 * h * time)
        pose_rate = 0.5 * dq.mul(dq.pure(now.twist), now.pose)
        return np.abs(rate / (2 * h * time) - pose_rate).max(), np.abs(slope - now.slope).max()

    coarse, fine = errors(step), errors(step / 2)
    for a, b, size in zip(coarse, fine, (now.twist, now.slope), strict=True):
        scale = np.abs(size).max()
        assert a < 1e-10 * scale or 3.5 < a / b < 4.5, (a, b)
        assert b < 0.01 * scale


@pytest.mark.parametrize("body", BODIES)
def test_the_point_runs_evenly_and_the_pose_has_no_gap(body):
    lines, before = BODIES[body]
    stroke = stroke_of(lines, "in 6 s profile constant", before)
    flow = stroke.flow(np.linspace(0, 1, 4001))
    speed = np.linalg.norm(dq.point_velocity(flow.twist, dq.translation(flow.pose)), axis=1)
    length = stroke.length
    np.testing.assert_allclose(speed, length / 6.0, rtol=1e-9)
    way = np.linalg.norm(np.diff(dq.translation(flow.pose), axis=0), axis=1)
    assert way.sum() == pytest.approx(length, rel=3e-4)
    assert way.max() <= length / 4000 * (1 + 1e-9)
    rate = np.abs(0.5 * dq.mul(dq.pure(flow.twist), flow.pose)).max()
    assert np.abs(np.diff(flow.pose, axis=0)).max() < 1.01 * rate * 6.0 / 4000


def test_a_smooth_chain_does_not_stop_and_the_velocity_is_continuous():
    motion = plan(
        parse(f"{START}corner jump\nstroke speed 60 mm/s turnspeed 400 deg/s\n{LOOSE}end", "a"),
        dq.IDENTITY,
    )
    assert "W403" not in {note.code for note in motion.notes}
    velocity = dq.point_velocity(motion.twist, motion.points)
    speed = np.linalg.norm(velocity, axis=1)
    inner = (motion.t > 0.2 * motion.t[-1]) & (motion.t < 0.8 * motion.t[-1])
    np.testing.assert_allclose(speed[inner], speed.max(), rtol=1e-9)
    assert 0.99 * 0.06 < speed.max() <= 0.06 * (1 + 1e-12)
    # no sharper than the roundest arc asks for, and the ramp
    change = np.linalg.norm(np.diff(velocity, axis=0), axis=1) / PERIOD
    assert change.max() < 0.06**2 / 0.03 + speed.max() / (0.2 * motion.t[-1]) + 1e-6


def test_samples_speed_and_time_hold_for_all_of_it():
    body = "line by (30, 0) mm\narc centre (30, 20) mm angle 90 deg\nend"
    length = 0.03 + 0.02 * math.pi / 2
    motion = plan(parse(f"stroke samples 70 profile constant\n{body}", "a"), dq.IDENTITY)
    assert len(motion.t) == 71
    way = np.linalg.norm(np.diff(motion.points, axis=0), axis=1)
    np.testing.assert_allclose(way[motion.points[1:, 0] < 0.03], length / 70, rtol=1e-9)
    motion = plan(parse(f"stroke in 2 s\n{body}", "a"), dq.IDENTITY)
    assert motion.t[-1] == pytest.approx(2)
    motion = plan(parse(f"stroke speed 40 mm/s corner jump\n{body}", "a"), dq.IDENTITY)
    assert motion.t[-1] == pytest.approx(1.25 * length / 0.04, abs=PERIOD)
    assert motion.length == pytest.approx(length)
    np.testing.assert_array_equal(np.unique(motion.source.line), [2, 3])
    corner = np.argmax(motion.source.line == 3)
    assert motion.points[corner - 1, 0] < 0.03 < motion.points[corner, 0]
    assert set(motion.stroke[:corner]) == {0}
    assert set(motion.stroke[corner:]) == {1}


def test_at_a_joint_the_twist_is_of_what_begins():
    text = "stroke samples 2 profile constant\nline by (10, 0) mm\nline by (0, 10) mm\nend"
    motion = plan(parse(text, "a"), dq.IDENTITY)
    np.testing.assert_allclose(motion.twist[:, 3:], [[1.25, 0, 0], [0, 1.25, 0], [0, 1.25, 0]])
    np.testing.assert_array_equal(motion.stroke, [0, 1, 1])


def test_the_tool_nowhere_turns_faster_than_it_may():
    for corner in ("0.1 mm", "jump"):
        text = f"{START}stroke speed 200 mm/s turnspeed 30 deg/s corner {corner}\n{LOOSE}end"
        motion = plan(parse(text, "a"), dq.IDENTITY)
        rate = np.degrees(np.linalg.norm(motion.twist[:, :3], axis=1)).max()
        assert 29 < rate <= 30 * (1 + 1e-9)
    assert "W411" in {note.code for note in motion.notes}


def test_a_gradient_of_the_stroke_goes_over_all_of_it():
    text = (
        "stroke in 4 s light red to blue corner jump\nline by (30, 0) mm by (0, 10) mm\n"
        "line by (0, 20) mm light lime\nline by (-40, 0) mm\nmove by (0, 5) mm\nend"
    )
    motion = plan(parse(text, "a"), dq.IDENTITY)
    ways = np.linalg.norm(np.diff(motion.points, axis=0), axis=1)
    # corners are cut between two rows: the way along the drawing comes from the profile
    (stroke,) = strokes_of(text)
    at = stroke.progress(stroke.samples).value
    middle = 0.5 * (at[1:] + at[:-1])
    light = motion.light[:-1]
    own = (middle > 40.2 / 105) & (middle < 59.8 / 105)
    np.testing.assert_allclose(light[own], np.tile([0, 1, 0], (own.sum(), 1)), atol=1e-12)
    dark = at[:-1] > 100 / 105
    assert not light[dark].any()
    shared = (at[1:] < 40 / 105) | ((at[:-1] > 60 / 105) & (at[1:] < 100 / 105))
    np.testing.assert_allclose(light[shared, 0], 1 - middle[shared], atol=1e-9)
    np.testing.assert_allclose(light[shared, 2], middle[shared], atol=1e-9)
    assert ways.sum() == pytest.approx(0.105, rel=3e-3)


def test_the_light_of_a_step_over_a_joint_is_the_mean_by_length():
    lines = "line by (10, 0) mm light red\nline by (20, 0) mm light blue\n"
    text = f"stroke samples 3 profile constant\n{lines}end"
    light = plan(parse(text, "a"), dq.IDENTITY).light
    np.testing.assert_allclose(light[:3], [[1, 0, 0], [0, 0, 1], [0, 0, 1]], atol=1e-9)
    text = text.replace("samples 3", "samples 2")
    light = plan(parse(text, "a"), dq.IDENTITY).light
    np.testing.assert_allclose(light[:2], [[2 / 3, 0, 1 / 3], [0, 0, 1]], atol=1e-9)


EVEN = {
    "line": "line by (90, 0) mm",
    "arc": "arc centre (0, 40) mm angle 200 deg",
    "spiral": "arc centre (0, 40) mm angle 400 deg grow 30 mm",
    "curve": "curve (40*t, 30*sin(2*t*rad), 0) mm for t from 0 to 3",
}


@pytest.mark.parametrize("profile", ["constant", "trapezoid", "cubic", "quintic"])
@pytest.mark.parametrize("time", ["speed 70 mm/s", "in 3 s"])
@pytest.mark.parametrize("path", EVEN)
def test_even_light_gives_every_millimetre_the_same(path, time, profile):
    text = f"period 4 ms\n{EVEN[path]} {time} profile {profile} light white even"
    motion = plan(parse(text, "a"), dq.IDENTITY)
    stroke = strokes_of(text)[0]
    fraction = stroke.fraction(stroke.samples)
    way = np.diff(fraction) * motion.length
    per_length = motion.light[:-1, 0] * 0.004 / way
    np.testing.assert_allclose(per_length, per_length.mean(), rtol=1e-7)
    assert 0.98 < motion.light.max() <= 1.0
    # the brightness at the cruise is that of a light that is not even
    speed = np.linalg.norm(dq.point_velocity(motion.twist, motion.points), axis=1).max()
    assert per_length.mean() == pytest.approx(1 / speed, rel=2e-3)


@pytest.mark.parametrize(
    "text",
    [
        'text "line.traj" font "gothiceng" height 5 mm light white even',
        "line by (0.9, 0) mm light white even\nline by (0.83, 0) mm light white even\n"
        "line by (40, 0) mm light white even profile constant",
        "line by (3, 0) mm by (0, 90) mm by (1, 0) mm in 0.94 s light white even",
    ],
)
def test_even_light_is_the_same_on_short_strokes_as_on_long(text):
    """Times are rounded up to whole samples: a stroke of 4 mm was by 1.8 times the brightest."""
    motion = plan(parse(text, "a"), dq.IDENTITY)
    given = []
    for number, segment in enumerate(motion.program.segments):
        if segment.light is not None:
            light = motion.light[:-1, 0][motion.stroke[:-1] == number].sum() * motion.period
            given.append(light / gather_shapes((segment,), {}).length[0])
    assert len(given) > 2
    fastest = 0.125 if "0.94" in text else 0.1  # [m/s]
    np.testing.assert_allclose(given, 1 / fastest, rtol=1e-6)


def test_even_light_of_a_stroke_of_several_lines_and_of_a_part_of_it():
    body = "line by (30, 0) mm\narc centre (30, 20) mm angle 90 deg light red\nend"
    text = f"stroke in 2 s light white even corner jump\n{body}"
    (stroke,) = strokes_of(text)
    at = stroke.progress(stroke.samples)
    light = plan(parse(text, "a"), dq.IDENTITY).light[:-1]
    first = at.value[1:] < stroke.edges[1]
    share = np.diff(at.value) / PERIOD / at.rate.max()
    np.testing.assert_allclose(light[first], np.tile(share[first, None], 3), rtol=1e-9)
    later = at.value[:-1] > stroke.edges[1]
    np.testing.assert_allclose(light[later], np.tile([1, 0, 0], (later.sum(), 1)), atol=1e-12)


def test_even_light_is_dark_where_the_point_stays_and_a_bar_that_turns_is_not():
    text = "light white even\nline by (9, 0) mm\nhold 1 s\nline by (0, 0) mm tool rpy(0, 0, 90 deg)"
    motion = plan(parse(text, "a"), dq.IDENTITY)
    assert not motion.light[motion.source.line > 2].any()
    motion = plan(parse(f"brush bar 20 mm\n{text}", "a"), dq.IDENTITY)
    assert not motion.light[motion.source.line == 4].any()
    turning = motion.light[:-1][motion.source.line[:-1] == 5][:, 0]
    rate = np.linalg.norm(motion.twist[:, :3], axis=1)[motion.source.line == 5]
    np.testing.assert_allclose(turning, 0.5 * (rate[1:] + rate[:-1]) / rate.max(), atol=0.02)


def notes(text):
    return {note.code: note for note in plan(parse(text, "a"), dq.IDENTITY).notes}


def test_the_velocity_s_jump_at_a_corner_is_told_with_its_size():
    text = "speed 50 mm/s\nprofile constant\n"
    two = f"{text}line by (50, 0) mm\nline by (0, 50) mm"
    note = notes(two)["W403"]
    assert note.message == "the velocity jumps by 70.7 mm/s here"
    assert note.span.text_in(two) == "line by (0, 50) mm"
    assert note.help.startswith("use profile trapezoid to stop at corners, or round them: blend 5")
    assert note.help.endswith("; if it is meant: corner jump")
    note = notes(f"{two}\nline by (-50, 0) mm\nline by (40, 0) mm")["W403"]
    assert note.message == "the velocity jumps by 100 mm/s here, the largest of 3 such corners"
    alike = f"{two}\nline by (50, 0) mm\nline by (0, 50) mm"
    note = notes(alike)["W403"]  # the last of those that are alike
    assert (note.span.start, note.span.text_in(alike)) == (len(alike) - 18, "line by (0, 50) mm")
    assert "W403" not in notes(f"{text}line by (50, 0) mm\nline by (50, 0) mm")
    assert "W403" not in notes(f"{text}line by (50, 0) mm\nhold 1 s\nline by (0, 50) mm")
    assert "W403" not in notes("line by (50, 0) mm by (0, 50) mm")
    assert "W403" in notes(f"{text}line by (50, 0) mm\nline by (0, 50) mm profile cubic")


def test_a_corner_within_a_stroke_is_run_through_and_told():
    text = (
        "stroke speed 50 mm/s profile constant\n"
        "line by (50, 0) mm\nline by (50, 50) mm\nline by (50, 51) mm\nend"
    )
    note = notes(text)["W403"]
    # both corners are passed at the full speed, which rounding to whole samples lowers a little
    assert float(note.message.split()[4]) == pytest.approx(100 * math.sin(math.pi / 8), abs=0.2)
    assert note.span.text_in(text) == "line by (50, 50) mm"
    assert note.help.startswith("slow down for it: corner 0.1 mm, or round the corner: blend 5 mm")


def test_a_speed_that_is_not_reached_is_told():
    note = notes("line by (1, 0) mm speed 100 mm/s\nline by (200, 0) mm")["W411"]
    assert note.message == "this reaches 78.1 mm/s, not 100 mm/s"
    assert note.help == "a shorter period comes closer"
    note = notes("line by (50, 0) mm speed 100 mm/s tool rpy(0, 0, 90 deg)")["W411"]
    assert note.label == "the tool turns as fast as it may"
    assert "W411" not in notes("line by (50, 0) mm")
    assert "W411" not in notes("move by (1, 0) mm\nmove by (1, 0) mm\nline by (40, 0) mm")


@pytest.mark.parametrize(("line", "code"), [
    ("screw about (50, 0, 0) mm along x angle 90 deg", "E326"),
    ("curve (50 + 40*t^2, 40*t^3) mm for t from -1 to 1", "E321"),
])  # fmt: skip
def test_what_can_t_be_run_by_length_is_refused(line, code):
    start = "50, 0" if code == "E326" else "90, -40"
    text = f"start at (0, 0)\nstroke in 5 s\nline to ({start}) mm\n{line}\nend"
    with pytest.raises(ScriptError) as caught:
        plan(parse(text, "a"), dq.IDENTITY)
    (found,) = caught.value.diagnostics
    assert found.code == code
    assert found.span.text_in(text) == line


@pytest.mark.parametrize(
    ("profile", "times"),
    [("constant", 1.0), ("trapezoid", 3.54), ("cubic", 4.5), ("quintic", 7.0)],
)
def test_beads_at_the_ends_have_a_size(profile, times):
    """Against the figures measured for the design: 3.5, 4.5 and 7.0 at 1 % of the length."""
    text = f"profile {profile}\nline by (99, 0) mm"
    assert plan(parse(text, "a"), dq.IDENTITY).unevenness == pytest.approx(times, rel=0.02)
    text = f"profile {profile}\nline by (99, 0) mm light white even\nmove by (9, 0) mm"
    assert plan(parse(text, "a"), dq.IDENTITY).unevenness == 1.0


def test_where_the_light_goes_out_no_corner_is_rounded():
    """A blend would need light that is on and off at once."""
    text = "speed 50 mm/s\nprofile constant\nline by (50, 0) mm\n"
    assert "blend" in notes(f"{text}line by (0, 50) mm")["W403"].help
    assert "blend" not in notes(f"{text}move by (0, 50) mm")["W403"].help
