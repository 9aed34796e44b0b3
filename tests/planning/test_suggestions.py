"""What is advised where a drawing leaves the reach, followed: the error is gone."""

import re

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.language import ScriptError, parse
from dqpaint.motion import plan
from dqpaint.motion.transform import moved, scaled, straight
from dqpaint.painting.paint import prepare
from dqpaint.planning.forecast_report import make_report
from dqpaint.planning.ideal_run import can_draw, find_start_posture
from dqpaint.planning.placement import can_be_placed
from dqpaint.planning.suggestions import NO_SUGGESTION, suggest
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.kinematics.start_posture import PATH_TOLERANCE, least_errors
from dqpaint.robots.model.card import read_card
from dqpaint.settings.model import make_settings

PLACE = "place at (0.3, 0.3, 0.4) m turned rpy(90 deg, 0 deg, 90 deg)\n"
STROKES = (
    "start at (30, 20, 10) mm tool rot(x, 20 deg)\nline to (300, 100, -50) mm in 1 s\n"
    "arc to (100, 200, -50) mm radius 250 mm left in 1 s tool rot(z, 40 deg)\n"
)


def motion_of(text, name="iiwa"):
    arm = Kinematics(read_card(name))
    return plan(parse(text, "far.traj"), arm.card.canvas.pose), arm


@pytest.mark.parametrize("head", ["", PLACE])
def test_the_scale_that_is_tried_is_that_of_the_language(head):
    asked, _ = motion_of(head + STROKES)
    wanted, _ = motion_of(f"{head}with scale 0.35\n{STROKES}end\n")
    found = scaled(asked, 0.35)
    np.testing.assert_allclose(found.pose, wanted.pose, atol=1e-12)


def test_the_straight_tool_that_is_tried_is_that_of_a_drawing_without_tool():
    asked, _ = motion_of(PLACE + STROKES)
    wanted, _ = motion_of(PLACE + re.sub(r" tool rot\(.*?deg\)", "", STROKES))
    found = straight(asked).pose
    apart = dq.log(dq.mul(dq.nearest(wanted.pose, found), dq.conj(found)))
    assert np.abs(apart).max() < 1e-12
    assert straight(wanted) is None


def test_the_place_that_is_tried_is_that_of_the_language():
    asked, _ = motion_of(PLACE + STROKES)
    wanted, _ = motion_of(PLACE.replace("0.3, 0.3, 0.4", "0.5, -0.1, 0.6") + STROKES)
    found = moved(asked, np.array([0.5, -0.1, 0.6]))
    np.testing.assert_allclose(found.pose, wanted.pose, atol=1e-12)
    np.testing.assert_allclose(found.canvas, wanted.canvas, atol=1e-12)


SCREW = "screw about (60, 0, 0) mm along y angle {} deg pitch 150 mm/turn in 8 s\n"


@pytest.mark.slow
@pytest.mark.parametrize("sign", [1, -1])
def test_a_screw_out_of_reach_is_told_a_smaller_angle_not_to_leave_out_a_tool(sign):
    asked, arm = motion_of(SCREW.format(sign * 360))
    with pytest.raises(ScriptError) as caught:
        prepare(asked.program, make_settings(robot="iiwa"))
    (found,) = caught.value.diagnostics
    assert "without 'tool'" not in found.help
    angle = int(re.search(r"angle (-?\d+) deg", found.help)[1])
    assert 0 < sign * angle < 360
    assert can_draw(motion_of(SCREW.format(angle))[0], arm)
    assert straight(asked) is None


def test_metres_where_millimetres_are_meant():
    with pytest.raises(ScriptError) as caught:
        prepare(parse("line to (100, 0) m in 9 s"), make_settings(robot="iiwa"))
    assert "(0.1, 0)" in caught.value.diagnostics[0].help


@pytest.mark.parametrize(("text", "fits"), [
    ("line to (80, 0) mm", True), ("line to (0, 0, 600) mm", False), ("line to (1, 0) m", False),
    ("line to (80, 0) mm tool rot(x, 180 deg)", False),
])  # fmt: skip
def test_what_an_arm_can_draw(text, fits):
    assert can_draw(*motion_of(f"start at (0, 0) mm\n{text}\n")) is fits


@pytest.mark.slow
def test_a_way_along_which_the_arm_is_beside_the_path_is_none():
    """For a moment, between the poses looked at first, 2 mm beyond the stretched arm."""
    z = 1e3 * (0.82 - 0.539) + 2.0
    out = f"curve (0, -140 mm * sin(t), {z:.3f} mm * sin(t)) for t from 0 to 180 deg in 1 s\n"
    home = "repeat 40\n  line by (0.5, 0) mm in 0.1 s\n  line by (-0.5, 0) mm in 0.1 s\nend\n"
    far = motion_of("period 8 ms\n" + home + out + home)
    assert find_start_posture(*far).margin > 0  # at the poses looked at first
    assert not can_draw(*far)
    with pytest.raises(ScriptError, match=r"E310\]: sample \d+ .*2 mm"):
        make_report(far[0].program, far[1])
    near = out.replace(f"{z:.3f}", f"{z - 20:.3f}")
    assert can_draw(*motion_of("period 8 ms\n" + home + near + home))


def test_a_way_along_which_a_joint_goes_beyond_its_end_is_none():
    """For a moment, between the poses looked at first, farther than a short-tied wrist turns."""
    card = read_card("viper850")
    ends = {"lower_deg": (*card.limits.lower_deg[:-1], -100.0),
            "upper_deg": (*card.limits.upper_deg[:-1], 100.0)}  # fmt: skip
    tied = card.model_copy(update={"limits": card.limits.model_copy(update=ends)})
    home = "repeat 90\n  line by (0.5, 0) mm in 0.1 s\n  line by (-0.5, 0) mm in 0.1 s\nend\n"

    def turned(angle):
        out = "".join(
            f"line by ({way}, 0) mm tool rot(z, {to} deg) in 0.2 s\n"
            for way, to in ((1, angle), (-1, 0), (1, -angle), (-1, 0))
        )
        motion = plan(parse("period 8 ms\n" + home + out + home, "t"), card.canvas.pose)
        return motion, Kinematics(tied)

    assert can_draw(*turned(8))  # it begins 10 degrees from an end, whichever way it holds itself
    assert find_start_posture(*turned(60)).margin > 0
    assert not can_draw(*turned(60))


@pytest.mark.slow
def test_room_is_where_place_auto_finds_it():
    assert can_be_placed(*motion_of("start at (0, 0) mm\nline to (500, 0) mm\n"))
    assert not can_be_placed(*motion_of("start at (0, 0) mm\nline to (3, 0) m\n"))


@pytest.mark.slow
def test_a_scale_at_which_only_the_farthest_point_is_reached_is_not_advised():
    """Half as large, the line's farthest point is reached, but not what lies beyond it."""
    strokes = "line to (-329, -227, 67) mm light red\n"
    motion, arm = motion_of(PLACE + strokes, "viper850")
    rows = np.array([388])  # the one that is told
    half = scaled(motion, 0.5)
    assert least_errors(arm, half.pose[rows])[0] < PATH_TOLERANCE
    assert not can_draw(half, arm)
    scale = re.search(r"with scale ([\d.]+) ... end", suggest(motion, arm, rows))[1]
    assert can_draw(*motion_of(f"{PLACE}with scale {scale}\n{strokes}end\n", "viper850"))


def test_another_arm_is_advised_where_nothing_else_helps(monkeypatch):
    """The upright Viper has reach enough for a place that is 1.2 m high; the iiwa's is nearer."""
    from dqpaint.planning import suggestions as advice

    motion, arm = motion_of("place at (0.6, 0, 1.25) m turned rpy(90 deg, 0 deg, 90 deg)\n"
                            "start at (0, 0) mm\nline to (10, 0) mm\n", "meka-a2")  # fmt: skip
    monkeypatch.setattr(advice, "can_be_placed", lambda *_: False)
    monkeypatch.setattr(advice, "installed_names", lambda: ["meka-a2", "panda", "iiwa"])
    said = suggest(motion, arm, np.array([0]))
    reached = [
        name for name in ("panda", "iiwa") if can_draw(*motion_of(motion.program.text, name))
    ]
    assert said == (f"take another arm: {reached[0]} reaches it" if reached else NO_SUGGESTION)


ARMS = ["iiwa", "panda", "viper850", "xarm6", "meka-a2", "lwr4"]


def too_far(seed):
    """Settings, and strokes that reach far out, some of them turning far, some far off at once."""
    rng = np.random.default_rng([310, seed])
    size, turns = rng.choice([300, 450, 700]), rng.random() < 0.4
    strokes = ""
    for _ in range(rng.integers(1, 5)):
        x, y, z = rng.uniform(-size, size, 3) * [1, 1, 0.5]
        strokes += f"line to ({x:.0f}, {y:.0f}, {z:.0f}) mm"
        if turns:
            strokes += f" tool rot({rng.choice(list('xyz'))}, {rng.uniform(-150, 150):.0f} deg)"
        strokes += " light red\n"
    head = "period 10 ms\nspeed 250 mm/s\n"
    return head + (PLACE if rng.random() < 0.3 else ""), strokes


def draw(text, robot, place=None):
    ready = prepare(parse(text, "t"), make_settings(plant="ideal", robot=robot, place=place))
    ready.run()


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_what_is_advised_helps(seed):
    """Each piece of it, by a run."""
    arm = ARMS[seed % len(ARMS)]
    head, strokes = too_far(seed)
    try:
        draw(head + strokes, arm)
    except ScriptError as problem:
        text = str(problem)
    else:
        return
    assert "E310" in text
    advice = text.rpartition("= help: ")[2].strip()
    for one in advice.split("; or "):
        smaller = re.search(r"with scale ([\d.]+) ... end", one)
        wrapped = f"with scale {smaller[1]}\n{strokes}end\n" if smaller else strokes
        if "without 'tool'" in one:
            wrapped = re.sub(r" tool rot\(.*?deg\)", "", strokes)
        other = re.search(r"take another arm: (\S+)", one)
        if one == NO_SUGGESTION:
            continue
        assert smaller or other or "place auto" in one or "without 'tool'" in one, one
        place = "auto" if "place auto" in one else None
        draw(head + wrapped, other[1] if other else arm, place)
