"""Drawings that leave the reach: found wherever it happens, with distance and advice that hold."""

import re

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.language import ScriptError, parse, read
from dqpaint.painting.paint import paint
from dqpaint.planning.forecast_report import make_report
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.kinematics.start_posture import METRES_PER_RADIAN, shortfall
from dqpaint.robots.model.card import read_card
from dqpaint.settings.model import make_settings

SETTINGS = make_settings(plant="ideal", width=64, height=36)


def refused(text):
    with pytest.raises(ScriptError) as caught:
        paint(parse(text, "far.traj"), SETTINGS)
    return str(caught.value)


@pytest.mark.slow
def test_a_stroke_that_leaves_the_reach_between_the_rows_of_the_forecast_is_found_by_the_run():
    """A short bulge among 600 strokes that stay at home."""
    home = "repeat 150\n  line by (0.5, 0) mm\n  line by (-0.5, 0) mm\nend\n"
    out = "curve (0, 0, 400 mm * sin(t)) for t from 0 to 180 deg in 0.6 s\n"
    message = refused("period 8 ms\n" + home + out + home)
    assert "--> far.traj:6:1" in message
    assert "farthest point of this line" in message


@pytest.mark.slow
def test_the_farthest_point_is_named_with_about_its_distance():
    message = refused("hold 1 s\nline to (0, 0, 900) mm\n")
    found = re.search(r"sample \d+ \((\d+\.\d+) s\) is (\d+) mm", message)
    assert float(found[1]) == pytest.approx(1 + 900 / 100 * 1.25, abs=0.02)  # the end of the line
    # the shoulder stands 0.36 m high, the stretched arm with its lamp ends 0.82 + 0.161 m away
    assert float(found[2]) == pytest.approx(1e3 * (np.hypot(1.6 - 0.161, 0.14) - 0.82), rel=0.01)


@pytest.mark.slow
def test_the_advised_scale_is_reached_and_a_larger_one_is_not():
    text = "move to (0, 0, 0)\nline to (0, 0, 500) mm\n"
    scale = float(re.search(r"with scale (\d\.\d+)", refused(text))[1])
    paint(parse(f"with scale {scale}\n{text}end\n", "a"), SETTINGS)
    refused(f"with scale {scale + 0.1}\n{text}end\n")


@pytest.mark.slow
def test_a_tool_that_cannot_turn_so_is_told_apart_from_a_distance():
    message = refused("line to (0, 0) mm tool rpy(180 deg, 0, 0)\n")
    assert re.search(r"and \d+ deg outside the reach|only with the tool turned", message)
    assert "hold the tool straight: without 'tool' it is reached" in message


REACH = 0.82  # [m] of the iiwa's wrist about its shoulder, with a straight elbow


def beyond(x, y, z):
    """How far [mm] a place of the canvas is outside, the tool held towards the viewer."""
    return 1e3 * (np.linalg.norm([0.7 + z - 0.161, x, 0.5 + y - 0.36]) - REACH)


@pytest.mark.slow
def test_each_line_is_told_with_its_own_distance():
    text = "start at (0, 0) mm\n" + "".join(
        f"line to ({1e3 * x:.0f}, {1e3 * y:.0f}, {1e3 * z:.0f}) mm\nmove to (0, 0) mm\n"
        for x, y, z in ((0.75, 0, 0), (0, 0.2, 0.1), (-0.5, 0.6, 0.1))
    )
    message = refused(text)
    told = re.findall(r"is (\d+) mm[^\n]* outside the reach of iiwa\n --> far.traj:(\d)", message)
    far, other = beyond(0.75, 0, 0), beyond(-0.5, 0.6, 0.1)
    assert [int(line) for _, line in told] == [2, 3, 6, 7]  # 3 and 7 come back from there
    for (found, _), wanted in zip(told, (far, far, other, other), strict=True):
        assert float(found) == pytest.approx(wanted, rel=0.05)
    assert message.count("= help:") == 1
    assert "make it smaller: with scale 0.55 ... end; or move it: place auto finds room" in message


@pytest.mark.slow
def test_of_many_lines_the_first_are_told_and_the_others_named():
    lines = "".join(f"line to ({700 + i}, {10 * i}) mm in 1 s\n" for i in range(14))
    message = refused(f"start at (650, -10) mm\n{lines}")
    assert message.count("error[E310]") == 5
    assert "farthest point of this line; likewise lines 7, 8, 9, 10, 11, 12 and 3 more" in message


@pytest.mark.slow
def test_other_lines_of_an_included_file_are_named_by_it(tmp_path):
    lines = "".join(f"line to ({700 + i}, {10 * i}) mm in 1 s\n" for i in range(7))
    far = tmp_path / "far.traj"
    far.write_text(lines)
    (tmp_path / "a.traj").write_text('start at (650, -10) mm\ninclude "far.traj"\n')
    with pytest.raises(ScriptError) as caught:
        paint(read(tmp_path / "a.traj"), SETTINGS)
    assert f"likewise lines {far}:6, {far}:7" in str(caught.value)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "at"), [
    ("iiwa", (-0.2, 0.7, 0.5)), ("panda", (-0.7, 0.3, 0.2)), ("viper850", (0.3, 0.9, 0.1)),
    ("xarm6", (0.1, -0.7, 0.3)), ("meka-a2", (0.5, 0.2, 0.1)),
])  # fmt: skip
def test_the_distance_is_the_least_there_is(name, at):
    """Against a search that knows nothing of Jacobians."""
    arm, rng = Kinematics(read_card(name)), np.random.default_rng(4)
    card = arm.card
    turn = np.array([np.cos(0.2), *(np.sin(0.2) * np.array([0.6, 0, 0.8]))])
    pose = dq.mul(card.canvas.pose, dq.pose_from(at, turn))

    def badness(q):
        error = dq.mul(pose, dq.conj(arm.pose(q)))
        far = np.linalg.norm(dq.translation(pose) - dq.translation(arm.pose(q)))
        return far + METRES_PER_RADIAN * 2 * np.arccos(min(1.0, abs(error[0])))

    q = min(rng.uniform(card.lower, card.upper, (300, card.joints)), key=badness)
    least, step = badness(q), 0.5
    while step > 1e-4:
        tried = np.clip(q + step * rng.normal(size=(60, card.joints)), card.lower, card.upper)
        best = min(tried, key=badness)
        if badness(best) < least:
            q, least = best, badness(best)
        else:
            step *= 0.6
    found = shortfall(arm, pose)
    assert found.combined_error < 1.03 * least


@pytest.mark.slow
def test_a_joint_s_end_counts_as_reach_before_the_run_as_in_it():
    """A wrist that would have to turn 0.4 degrees too far, or stay 3 mm away."""
    text = (
        "place at (0.461, 0.034, 0.732) m turned rpy(90 deg, 0 deg, 90 deg)\nstart at (0, 0) mm\n"
        "line to (44, 52, 65) mm in 3 s\nline to (-60, 14, 23) mm in 3 s tool rot(z, 6 deg)\n"
        "line to (-4, -41, -64) mm in 3 s tool rot(z, 1 deg)\n"
    )
    program = parse(text, "t.traj")
    said = []
    for look in (lambda: paint(program, SETTINGS), lambda: make_report(program, arm_of("iiwa"))):
        with pytest.raises(ScriptError) as caught:
            look()
        said.append(str(caught.value))
    assert said[0] == said[1]


def arm_of(name):
    return Kinematics(read_card(name))


@pytest.mark.parametrize("beyond_mm", [0.4, 1.2])
@pytest.mark.slow
def test_a_first_place_hardly_out_of_reach_has_no_strokes_before_it(beyond_mm):
    z = 1e3 * (REACH - 0.539) + beyond_mm
    message = refused(f"start at (0, -140, {z:.3f}) mm\nline to (0, -100, 0) mm\n")
    assert f"sample 0 (0.00 s) is {beyond_mm:.1g} mm outside the reach of iiwa" in message


@pytest.mark.parametrize("inside_mm", [0.0, 0.1, 3.0])
def test_what_the_stretched_arm_just_reaches_is_drawn(inside_mm):
    """The elbow is straight there, which is a singularity; forecast and run say the same."""
    z = 1e3 * (REACH - 0.539) - inside_mm
    program = parse(f"start at (0, -100, 0) mm\nline to (0, -140, {z:.3f}) mm\n", "t")
    outlook = make_report(program, arm_of("iiwa"))
    assert max(line.path_error for line in outlook.lines) < 3e-4
    paint(program, SETTINGS)
