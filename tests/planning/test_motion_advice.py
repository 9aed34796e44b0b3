"""What a drawing is advised against torques: what it does not have yet, where it would help."""

import re

import numpy as np
import pytest

from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.planning.motion_advice import advise
from dqpaint.program import PiecewiseCurve
from dqpaint.robots.model.card import read_card

CANVAS = read_card("iiwa").canvas.pose
START = "start at (0, 0) mm\n"
LINE = "line to (100, 0) mm in 2 s\n"
CONSTANT = "line to (100, 0) mm in 2 s profile constant\n"
BEND = "line to (100, 0) mm\narc centre (100, 50) mm angle 90 deg\nend\n"  # no corner between them
CORNER = "line to (100, 0) mm\nline to (100, 100) mm\nend\n"
NONE, GENTLE, REST, SLOWER = "", "profile quintic", "profile trapezoid", "corner 0.1 mm"


def written(text, share, slowed=False):
    """What is to be written, against a torque at a share of the time."""
    motion = plan(parse(START + text, "t.traj"), CANVAS)
    row = round(share * (len(motion.t) - 1))
    said = advise(motion, float(motion.t[row]), slowed)
    assert said.startswith("draw it slower")
    assert ("--on-limit slow" in said) is not slowed
    found = re.search(r"write ((profile|corner) [\w. ]+)", said)
    return found[1].strip() if found else ""


@pytest.mark.parametrize(("text", "share", "advice"), [
    (LINE, 0.0, GENTLE), (LINE, 0.15, GENTLE), (LINE, 0.25, NONE), (LINE, 0.5, NONE),
    (LINE, 0.75, NONE), (LINE, 0.85, GENTLE), (LINE, 1.0, GENTLE),
    (LINE.replace("s\n", "s profile quintic\n"), 0.1, NONE),
    (CONSTANT, 0.5, REST),
    ("line to (100, 0) mm in 2 s profile cubic(50 mm/s, 50 mm/s)\n", 0.5, REST),
    ("corner jump\nstroke speed 50 mm/s\n" + CORNER, 0.02, SLOWER),
    ("corner jump\nstroke speed 50 mm/s\n" + CORNER, 0.25, SLOWER),
    ("stroke speed 50 mm/s profile constant\n" + BEND, 0.02, REST),
    ("stroke speed 50 mm/s profile constant\n" + BEND, 0.25, SLOWER),
    ("stroke speed 50 mm/s profile constant\n" + BEND, 0.5, SLOWER),  # the end of a leg is none
    ("corner 0.1 mm\nstroke speed 50 mm/s\n" + CORNER, 0.02, NONE),
    ("corner 0.1 mm\nstroke speed 50 mm/s profile constant\n" + CORNER, 0.25, NONE),
])  # fmt: skip
@pytest.mark.parametrize("slowed", [False, True])
def test_what_is_advised_is_what_the_place_lacks(text, share, advice, slowed):
    assert written(text, share, slowed) == advice


def test_where_a_line_begins_the_one_before_counts_too():
    """It ended at full speed, which the next line's own first row does not show."""
    text = CONSTANT + "line to (0, 0) mm in 2 s profile quintic\n"
    motion = plan(parse(START + text, "t.traj"), CANVAS)
    first = int(np.flatnonzero(motion.stroke == motion.stroke[-1])[0])
    assert "profile trapezoid" in advise(motion, float(motion.t[first]), slowed=True)
    assert "profile" not in advise(motion, float(motion.t[first + 2]), slowed=True)


def test_lettering_that_runs_through_corners_is_told_of_them():
    text = 'corner jump\ntext "O" height 40 mm speed 50 mm/s\n'
    motion = plan(parse(START + text, "t.traj"), CANVAS)
    curve, *_ = (
        number
        for number, one in enumerate(motion.program.segments)
        if isinstance(one.path, PiecewiseCurve)
    )
    rows = np.flatnonzero(motion.stroke == curve)
    said = advise(motion, float(motion.t[rows[len(rows) // 2]]), slowed=True)
    assert "corner 0.1 mm" in said
