"""Programs for KUKA's and ABB's controllers, read back: they lead along the drawing."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import dqpaint
from dqpaint import dq
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.outputs.formats.krl import frame
from dqpaint.outputs.registry import choose_export_writer, make_files
from dqpaint.outputs.robot import moves_of
from tests.support.robot_programs import read_krl, read_rapid, walk

TEXT = """period 10 ms
speed 60 mm/s
profile quintic
start at (-40, 0) mm
line to (0, 20) mm light red
arc centre (0, 0) mm angle 360 deg light white 50%
move to (40, 20) mm tool rot(y, 25 deg)
hold 0.3 s light blue
line to (40, 0) mm light green to blue in 1 s
curve (40 - 60 * t, 20 * sin(3 * t*rad), 5 * t) mm for t from 0 to 1 light red in 2 s
"""
READ = {"krl": (".src", read_krl), "rapid": (".mod", read_rapid)}
CHOICES = {"robot": "viper850", "plant": "ideal", "size": (64, 36)}


def drawn(folder, text, **choices):
    (folder / "hook.traj").write_text(text)
    return dqpaint.draw(folder / "hook.traj", **{**CHOICES, **choices})


@pytest.fixture(scope="module")
def painting(tmp_path_factory):
    return drawn(tmp_path_factory.mktemp("moves"), TEXT)


def text_of(painting, form):
    return make_files([choose_export_writer(form)], painting)[READ[form][0]].decode()


@pytest.mark.parametrize("form", READ)
def test_it_leads_along_the_drawing_with_its_light(painting, form):
    motion, program = painting.motion, READ[form][1](text_of(painting, form))
    points, turns, light = walk(program, 200)
    far, _ = cKDTree(points).query(motion.points)
    assert far.max() < 2.2e-4  # 0.1 mm, and half a gap of the walk
    away, row = cKDTree(motion.points).query(points)
    assert away.max() < 5e-4  # rows are up to 0.6 mm apart
    asked = dq.rotation(motion.pose)[:, [1, 2, 3, 0]]
    from scipy.spatial.transform import Rotation

    off = [(turns[k] * Rotation.from_quat(asked[row[k]]).inv()).magnitude()
           for k in range(0, len(points), 31)]  # fmt: skip
    assert np.degrees(max(off)) < 1.0
    lit = motion.light[:-1]
    shown = {tuple(np.round(colour, 3)) for colour in light}
    assert {(1.0, 0.0, 0.0), (0.5, 0.5, 0.5), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)} <= shown
    straight = (motion.stroke[:-1] == 4).nonzero()[0]
    for k in straight[::5]:  # the gradient, where the tool is
        at = points[np.linalg.norm(points - motion.points[k], axis=1) < 5e-4]
        assert len(at)
        near = np.linalg.norm(points - motion.points[k], axis=1) < 5e-4
        assert np.abs(light[near] - lit[k]).max(axis=1).min() < 1 / 32
    assert program.light == (0, 0, 0)


@pytest.mark.parametrize("form", READ)
def test_poses_are_read_back(painting, form):
    """To 1e-3 mm and 1e-4 deg, arcs as arcs."""
    from scipy.spatial.transform import Rotation

    moves, program = moves_of(painting), READ[form][1](text_of(painting, form))
    assert len(program.steps) == len(moves.moves)
    for step, move in zip(program.steps, moves.moves, strict=True):
        np.testing.assert_allclose(step.end, dq.translation(move.end), atol=1e-6)
        asked = Rotation.from_quat(np.roll(dq.rotation(move.end), -1))
        assert np.degrees((step.turn * asked.inv()).magnitude()) < 1e-4
        assert (step.via is None) == (move.via is None)
        if move.via is not None:
            np.testing.assert_allclose(step.via, move.via, atol=1e-6)
        assert step.wait == pytest.approx(move.wait, abs=1e-6)
        if not move.wait:
            assert step.speed == pytest.approx(max(move.speed, 1e-3), rel=1e-3)
    assert sum(step.via is not None for step in program.steps) == 4  # the circle, in quarters
    assert [step.wait for step in program.steps if step.wait] == [pytest.approx(0.3)]
    tool = dq.matrix_from_pose(moves.tool)
    np.testing.assert_allclose(program.tool[0], tool[:3, 3], atol=1e-6)
    np.testing.assert_allclose(program.tool[1].as_matrix(), tool[:3, :3], atol=1e-6)


@pytest.mark.parametrize("form", READ)
def test_the_first_line_says_what_it_is(painting, form):
    first = text_of(painting, form).splitlines()[0]
    assert "Geometric, not timed" in first
    assert "Never run on a controller" in first


def test_angles_of_krl_at_random_and_where_b_is_a_right_angle():
    from scipy.spatial.transform import Rotation

    turns = [*Rotation.random(200, random_state=4), *(
        Rotation.from_euler("ZYX", [a, b, c], degrees=True)
        for a in (0, 33, -170) for b in (90, -90) for c in (0, 71))]  # fmt: skip
    for turn in turns:
        x, y, z, w = turn.as_quat()
        text = frame(dq.pose_from([0.1, -0.2, 0.3], [w, x, y, z]))
        angles = [float(word.split()[1].rstrip("}")) for word in text.split(", ")[3:]]
        back = Rotation.from_euler("ZYX", angles, degrees=True)
        assert np.degrees((back * turn.inv()).magnitude()) < 1e-5


HEAD = "period 10 ms\nspeed 60 mm/s\nprofile quintic\nstart at (0, 0) mm\n"


@pytest.mark.parametrize(
    ("text", "choices", "error", "says"),
    [
        (HEAD + "line to (20, 0) mm\n", {"robot": "iiwa"}, UsageError, "elbow"),
        (HEAD + "strobe 10 Hz\nline to (20, 0) mm light red\n", {}, UsageError, "line 6: a strobe"),
        (HEAD + "step to (1, 0) mm\nhold 1 s\n", {}, UsageError, "line 5: a step"),
        (
            HEAD + "arc centre (0, 1) mm angle 30 deg light red\n",
            {}, DqpaintError, "line 5: an arc's points",
        ),
        (
            HEAD + "profile constant\ncurve (2 * cos(t*rad), 2 * sin(t*rad), 0) mm "
            "for t from 0 to 6.2 light red in 0.1 s\n",
            {}, DqpaintError, "controller takes one in 12 ms",
        ),
    ],
)  # fmt: skip
def test_traps_are_refused_with_their_reasons(tmp_path, text, choices, error, says):
    painting = drawn(tmp_path, text, **choices)
    writer = choose_export_writer("krl")

    def tried():
        for need in writer.needs[:-1]:  # the limits of the arm aside
            need.check(painting)
        moves_of(painting)

    with pytest.raises(error, match=says):
        tried()


def test_a_singular_wrist_is_refused(tmp_path):
    from dataclasses import replace

    painting = drawn(tmp_path, HEAD + "line to (20, 0) mm light red\n")
    posture = painting.track.posture.copy()
    posture[7, 4] = np.radians(2.0)
    singular = replace(painting, track=replace(painting.track, posture=posture))
    check = choose_export_writer("krl").needs[2].check
    check(painting)
    with pytest.raises(DqpaintError, match="line 5: the axes 4 and 6 are 2 deg"):
        check(singular)


SMALL = """period 20 ms
profile quintic
start at (-20, 0) mm
line to (20, 0) mm in 1 s light red
arc centre (20, 20) mm angle 90 deg in 1 s light white 50%
"""


@pytest.mark.parametrize("form", READ)
def test_the_text_itself(tmp_path, form):
    """To be renewed by hand, after reading it as its controller would."""
    ending, _ = READ[form]
    made = text_of(drawn(tmp_path, SMALL), form)
    kept = (Path(__file__).parent / "golden" / f"small{ending}").read_text()
    mark = kept[0]  # of comments: they have versions
    told, stood = (
        [line for line in text.splitlines() if line[:1] != mark] for text in (made, kept)
    )
    assert told == stood
