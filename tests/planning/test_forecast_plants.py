"""What motors and springs of each plant bear, against runs on it; and what is said of it."""

import re

import numpy as np
import pytest

from dqpaint.controllers import CONTROLLERS
from dqpaint.errors import UsageError
from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.planning.check import as_json, check
from dqpaint.planning.forecast import forecast
from dqpaint.planning.reachability import reachable_start_posture
from dqpaint.plants.plant import find_plant
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.simulation.closed_loop import track
from tests.support.forecasts import lifted, random_drawing, rows_of

SWING = 0.15  # of a torque: springs swing where the acceleration changes at once
GAINS = {"k": 20.0}


def look_and_run(text, plant, law, gains=None, name="iiwa"):
    arm = Kinematics(read_card(name))
    motion = plan(parse(text, "test.traj"), arm.card.canvas.pose)
    start = reachable_start_posture(motion, arm).posture
    law, chosen = CONTROLLERS[law], find_plant(plant)
    run = track(
        motion, Kinematics(lifted(arm.card)), start, chosen, law, law.read_gains(gains or {})
    )
    return forecast(motion, arm, start, plant=chosen), run, arm.card


def part(run, card, line):
    return (np.abs(run.effort[rows_of(run, line) + 1]) / card.effort).max()


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_torques_that_are_commanded(seed):
    """Without corners: what these cost is the law's own."""
    text = random_drawing(seed).replace("profile constant", "profile trapezoid")
    found, run, card = look_and_run(text, "torque", "accel")
    assert len(found) == 4
    for one in found:
        assert one.effort_part == pytest.approx(part(run, card, one.line.line), rel=0.02)
        assert one.jolt is one.jolt_part is one.sag is None


@pytest.mark.slow
@pytest.mark.parametrize("seed", [2, 5, 9])
def test_torques_through_springs_and_their_dampers(seed):
    """Corners and all; those of seed 5 ask for twice what the arm has."""
    text = random_drawing(seed)
    assert "profile constant" in text
    found, run, card = look_and_run(text, "compliant", "pff")
    corner = set()
    for one in found:
        assert one.jolt_part == pytest.approx(part(run, card, one.line.line), rel=SWING)
        assert one.effort_part < one.jolt_part * (1 + 1e-9)
        corner |= {one.line.line} if one.jolt_part > 1.5 * one.effort_part else set()
    assert corner


@pytest.mark.slow
def test_a_damper_on_the_ground_bears_no_corner():
    found, run, card = look_and_run(random_drawing(3), "compliant:damper=ground", "pff")
    for one in found:
        assert one.jolt_part == pytest.approx(one.effort_part, rel=0.05)
        assert one.jolt_part == pytest.approx(part(run, card, one.line.line), rel=1.5 * SWING)


@pytest.mark.parametrize("law", ["quintic", "trapezoid"])
def test_where_no_speed_changes_at_once_dampers_bear_nothing_more(law):
    text = f"period 8 ms\nlaw {law}\nspeed 400 mm/s\nstart at (0, 0) mm\nline to (100, 60) mm\n"
    arm = Kinematics(read_card("iiwa"))
    motion = plan(parse(text, "t"), arm.card.canvas.pose)
    (one,) = forecast(
        motion, arm, reachable_start_posture(motion, arm).posture, plant=find_plant("compliant")
    )
    assert one.jolt_part == pytest.approx(one.effort_part, rel=1e-6)


SLOW = "period 8 ms\nstart at (60, 0) mm\nline to (-80, 60) mm in 3 s\nhold 0.5 s\n"


@pytest.mark.slow
@pytest.mark.parametrize(("plant", "name"), [
    ("compliant:encoder=motor", "iiwa"), ("compliant:encoder=motor,gravity=0.3", "meka-a2"),
    ("compliant:encoder=motor,stiffness=3000/2000/2500/1500/900/800/700", "iiwa"),
])  # fmt: skip
def test_the_sag_that_no_encoder_sees_is_the_error_of_the_run(plant, name):
    found, run, _ = look_and_run(SLOW, plant, "pff", GAINS, name)
    off = np.linalg.norm(run.points - run.motion.points, axis=1)
    assert found[-1].line.line == 4
    assert found[-1].sag == pytest.approx(off[-1], rel=0.02)
    still = run.motion.t > 1.0
    assert max(one.sag for one in found) == pytest.approx(off[still].max(), rel=0.1)
    assert 0.5e-3 < off[-1] < 0.1


def test_a_plant_without_masses_bears_nothing(tmp_path):
    path = tmp_path / "a.traj"
    path.write_text("start at (0, 0) mm\nline to (40, 0) mm\n")
    said = check(str(path), plant="ideal")
    assert "torque" not in said.text
    (line,) = as_json([said])["files"][0]["forecast"]["lines"]
    assert line["effort_Nm"] is line["effort_within_1_ms_Nm"] is line["sag_m"] is None
    assert line["speed_rad_s"]["part_of_limit"] > 0


CORNERS = (
    "period 8 ms\nprofile constant\nspeed 700 mm/s\nstart at (0, 0) mm\nline to (100, 0) mm\n"
    "line to (0, 60) mm\n"
)


@pytest.mark.parametrize(("plant", "codes", "said"), [
    (None, {"W503", "W504"}, "to follow within 1 ms joint"),
    ("stiff", {"W503", "W504"}, "torque within 1 ms"),
    ("ideal", set(), "at most"), ("torque", set(), "of its torque"),
    ("compliant:frequency=300", {"W504"}, "with its spring's damper joint"),
    ("compliant", set(), r"springs give way by \d\.\d mm \(line"),
    ("compliant:encoder=motor", set(), r"springs give way by \d\.\d mm, which no encoder sees"),
])  # fmt: skip
def test_corners_are_a_matter_of_the_plant(tmp_path, plant, codes, said):
    path = tmp_path / "a.traj"
    path.write_text(CORNERS)
    found = check(str(path), robot="iiwa", plant=plant)
    assert {d.code for d in found.forecast.warnings} & {"W503", "W504"} == codes
    assert re.search(said, found.text)
    assert as_json([found])["files"][0]["forecast"]["plant"] == (plant or "stiff")


def test_on_limit_slow_counts_the_motors_of_the_plant(tmp_path):
    path = tmp_path / "a.traj"
    path.write_text(CORNERS)
    times = {
        plant: check(
            str(path), robot="iiwa", plant=plant, on_limit="slow"
        ).forecast.retiming.extra_time
        for plant in ("ideal", "torque", "stiff")
    }
    assert times["ideal"] <= times["torque"] < times["stiff"]


@pytest.mark.parametrize(("plant", "said"), [
    ("rubber", "'rubber'; .*stiff"),
    ("ideal:frequency=3", "takes no values"), ("compliant:stiffness=3/4", "iiwa has 7 joints"),
    ("compliant:frequency=1e9", "iiwa .*steps of"),
])  # fmt: skip
def test_a_plant_that_is_none(tmp_path, plant, said):
    path = tmp_path / "a.traj"
    path.write_text(CORNERS)
    with pytest.raises(UsageError, match=said):
        check(str(path), plant=plant)
