"""Where an arm cannot follow: what clip, slow and stop promise, in figures."""

import numpy as np
import pytest

from dqpaint import api, dq
from dqpaint.cli.report import of_painting
from dqpaint.controllers.base.user_controller import commands
from dqpaint.errors import DqpaintError
from dqpaint.language import ScriptError, parse
from dqpaint.motion import plan
from dqpaint.outputs.summary import summarise
from dqpaint.outputs.tables import encode_csv
from dqpaint.planning.reachability import reachable_start_posture
from dqpaint.planning.retiming import LIMIT_SHARE, _Torques, retime
from dqpaint.robots.kinematics.differential_ik import resolve
from dqpaint.robots.kinematics.dynamics import Dynamics
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.robots.resolvers import planning_resolver
from dqpaint.simulation.stop_on_limit import meets_limit
from tests.support.hard_drawings import BEYOND, FAST, far_out, past_a_singularity

GENTLE = "period 8 ms\nstart at (40, 0) mm\narc centre (0, 0) angle 90 deg speed 60 mm/s\n"


@pytest.fixture
def draw(tmp_path):
    def painted(text, on_limit, **more):
        file = tmp_path / "t.traj"
        file.write_text(text)
        more = {"plant": "ideal", "size": (64, 48), **more}
        return api.draw(file, on_limit=on_limit, **more)

    return painted


def worst(painting):
    return painting.metrics.figures["position_error_max_m"]


@pytest.mark.parametrize("plant", ["ideal", pytest.param("stiff", marks=pytest.mark.slow)])
def test_one_too_fast(draw, plant):
    clip, slow = (draw(FAST, how, plant=plant) for how in ("clip", "slow"))
    speed = read_card("iiwa").speed
    assert {held.kind for held in clip.limits} >= {"speed"}
    assert worst(clip) > 0.1
    assert not slow.limits
    assert worst(slow) < 1e-3  # the shape survives
    assert (np.abs(slow.track.command) <= speed).all()
    assert (
        np.abs(slow.track.command).max(axis=0) / speed
    ).max() > 0.8 * LIMIT_SHARE  # no slower than due
    assert slow.retiming.extra_time == pytest.approx(slow.motion.t[-1] - clip.motion.t[-1])
    assert 1 < slow.retiming.extra_time < 3
    assert {3, 5} <= {line.line for line in slow.retiming.lines}
    assert slow.motion.clock[-1] == pytest.approx(clip.motion.t[-1])
    told = summarise(slow)["pace"]
    assert told["longer_s"] == slow.retiming.extra_time
    assert "s longer, down to 0.3" in of_painting(slow, [])
    assert "drawing_time_s" in slow.table
    assert "drawing_time_s" not in clip.table
    assert summarise(clip)["pace"] is None


def test_the_speed_goes_and_comes_back_smoothly(draw):
    """The joint accelerations of the slowed run are no larger than those of the drawing itself."""
    slow = draw(FAST, "slow")
    pace = np.gradient(slow.motion.clock, slow.motion.t)[2:-2]
    assert pace.max() <= 1 + 1e-9
    assert np.abs(np.diff(pace)).max() < 0.05
    middle = np.flatnonzero(slow.motion.source.line == 4)
    assert np.gradient(slow.motion.clock, slow.motion.t)[middle].max() > 0.95  # it comes back


def test_one_too_fast_stops_with_joint_time_line_and_amount(draw):
    with pytest.raises(ScriptError) as caught:
        draw(FAST, "stop")
    said = str(caught.value)
    assert said.startswith("error[E312]: at 0.0")
    assert "joint 1 would have to turn at 1" in said
    assert "its limit is 85 deg/s" in said
    assert "t.traj:3:1" in said
    assert "--on-limit slow" in said


@pytest.mark.slow
def test_a_motor_that_saturates_stops_the_run(draw):
    with pytest.raises(ScriptError, match=r"joint \d .*\d+ Nm"):
        draw(FAST.replace("1500", "500 mm/s profile constant #"), "stop", plant="stiff")


@pytest.mark.parametrize("plant", ["ideal", pytest.param("stiff", marks=pytest.mark.slow)])
def test_one_through_a_singularity(draw, plant):
    text = past_a_singularity()
    clip, slow = (draw(text, how, plant=plant) for how in ("clip", "slow"))
    assert slow.table["manipulability"].min() < 0.1 * slow.table["manipulability"].max()
    assert {held.kind for held in clip.limits} >= {"speed"}
    assert worst(clip) > 0.05
    assert not slow.limits
    assert worst(slow) < 1e-3  # what the damping costs
    assert 0.5 < slow.retiming.extra_time < 2
    with pytest.raises(ScriptError, match=r"E312.*joint 4 "):
        draw(text, "stop", plant=plant)


def test_one_through_a_singularity_is_planned_with_the_run_s_own_damping(draw):
    """Damped everywhere, but less than `filter` does there: joints turn faster."""
    slow = draw(past_a_singularity(), "slow", resolver="wampler")
    assert not slow.limits
    assert worst(slow) < 5e-4
    more = draw(past_a_singularity(), "slow", resolver="wampler,factor=0.1")  # more damped: sooner
    assert more.retiming.extra_time < 0.5 * slow.retiming.extra_time


def test_one_across_a_joint_limit(draw):
    """No pace helps: slow holds the joint back as clip does, and says so as clip does."""
    clip, slow = (draw(BEYOND, how, start="home") for how in ("clip", "slow"))
    for painting in (clip, slow):
        assert {(held.kind, held.joint, held.line.line) for held in painting.limits} == {
            ("position", 7, 3)
        }
        assert painting.track.posture[:, 6].max() <= np.radians(175) + 1e-9
    with pytest.raises(ScriptError, match=r"joint 7 .*17\d.*175 deg"):
        draw(BEYOND, "stop", start="home")


def test_a_joint_held_at_its_end_does_not_slow_the_rest_down(draw):
    """Far off the path, with two joints at their ends, what would bring it back is no pace's."""
    text = (
        "period 8 ms\nline to (60, 0) mm tool rot(z, 100 deg) in 3 s\n"
        "line to (0, 60) mm tool rot(z, 200 deg) in 3 s\n"
        "line to (0, 60) mm tool rot(z, 300 deg) in 3 s\n"
    )
    slow = draw(text, "slow", start="home")
    assert worst(slow) > 0.05
    assert slow.retiming.extra_time < 0.5


@pytest.mark.slow
@pytest.mark.parametrize("how", ["clip", "slow", "stop"])
def test_one_out_of_reach_is_refused_whatever_is_asked(draw, how):
    text = far_out()
    with pytest.raises(ScriptError, match=r"E310.*iiwa"):
        draw(text, how)


@pytest.mark.parametrize("how", ["slow", "stop"])
def test_a_drawing_that_meets_no_limit_is_drawn_as_ever(draw, how):
    clip, other = draw(GENTLE, "clip"), draw(GENTLE, how)
    assert encode_csv(clip.table) == encode_csv(other.table)
    if how == "slow":
        assert (other.retiming.extra_time, other.retiming.lowest_pace, other.retiming.lines) == (
            0.0,
            1.0,
            (),
        )
        assert "retiming" in of_painting(other, [])


def test_an_arm_that_begins_elsewhere_does_not_slow_the_drawing_down(draw):
    """The way to the path is no part of the drawing."""
    slow = draw(GENTLE, "slow", start="home")
    assert slow.retiming.extra_time == 0


@commands("acceleration")
def stiff_law(seen, k=400.0):
    """Resolved acceleration, critically damped."""
    x_e = dq.mul(dq.nearest(seen.pose_d, seen.pose), dq.conj(seen.pose))
    return k * 2 * dq.log(x_e) + 2 * k**0.5 * (seen.twist_d - seen.twist) + seen.acceleration_d


@pytest.mark.slow
def test_a_law_of_torques_is_slowed_for_its_motors_too():
    """Weak motors: what they bear besides the weight shrinks with the square of the pace."""
    from dqpaint.controllers.base.user_controller import make_controller
    from dqpaint.plants import PLANTS
    from dqpaint.simulation.closed_loop import track

    card = read_card("iiwa")
    limits = card.limits.model_copy(update={"effort_Nm": (8.0, 60.0, 8.0, 20.0, 3.0, 2.0, 2.0)})
    arm = Kinematics(card.model_copy(update={"limits": limits}))
    text = (
        "period 4 ms\nprofile quintic\nline to (80, 40) mm in 0.25 s\nline to (-60, 0) mm in 3 s\n"
    )
    motion = plan(parse(text, "t.traj"), card.canvas.pose)
    start = reachable_start_posture(motion, arm).posture
    law = make_controller(stiff_law, "stiff_law")
    slowed = retime(motion, arm, start, "start", "smooth")
    assert slowed.lines[0].line == 3
    clip, slow = (
        track(one, arm, start, PLANTS["torque"], law, law.read_gains({}))
        for one in (motion, slowed.motion)
    )
    assert {held.kind for held in clip.clamps} == {"torque"}
    assert not slow.clamps
    apart = [np.linalg.norm(run.points - run.motion.points, axis=1).max() for run in (clip, slow)]
    assert apart[1] < 1e-3 < apart[0]
    assert (np.abs(slow.effort) < arm.card.effort).all()
    rates = retime(motion, arm, start, "start", "none")  # their speeds alone need less
    assert rates.extra_time < slowed.extra_time


SUDDEN = (
    "period 8 ms\nprofile constant\nstart at (-100, 0) mm\nline to (100, 60) mm speed 500 mm/s\n"
    "line to (100, -60) mm speed 100 mm/s\nhold 0.3 s\n"
)


@pytest.mark.slow
def test_motors_that_take_up_a_new_rate_at_once_are_spared_too(draw):
    """On the stiff arm a corner at full speed asks four times what a motor has."""
    clip, slow = (draw(SUDDEN, how, plant="stiff") for how in ("clip", "slow"))
    assert {held.kind for held in clip.limits} == {"torque"}
    assert not slow.limits
    assert worst(slow) < 1e-3
    effort = read_card("iiwa").effort
    assert 0.7 < (np.abs(slow.track.effort) / effort).max() < 1  # no slower than due
    assert draw(SUDDEN, "slow", plant="ideal").retiming.extra_time == 0  # nobody's motors there
    gentle = draw(SUDDEN, "slow", plant="compliant").retiming  # springs take a corner softly
    assert gentle.extra_time < 0.5 * slow.retiming.extra_time


def test_a_joint_driven_past_its_end_by_torques_meets_its_limit():
    """Nothing clips its command there: the stop is what holds it."""
    card, zero = read_card("iiwa"), np.zeros(7)
    row = (zero, zero, zero)  # wanted, commanded, effort
    assert not meets_limit(card, card.upper - 1e-6, *row, torques=True)
    assert meets_limit(card, card.upper + 1e-6, *row, torques=True)
    assert meets_limit(card, card.lower - 1e-6, *row, torques=True)
    assert not meets_limit(card, card.upper + 1e-6, *row, torques=False)


def solver(arm, text):
    return planning_resolver(text, arm, 0.008).rates


def test_a_motor_s_share_is_worked_out_as_it_is():
    """From rest, a motion m times too strong for a motor needs sqrt(m) times as long."""
    arm = Kinematics(read_card("iiwa"))
    motors, dynamics = _Torques(arm, solver(arm, "filter")), Dynamics(arm)
    q = arm.card.home + 0.1
    x, J = arm.pose_and_jacobian(q)
    slope = np.array([5.0, -3, 2, 40, 30, -20])
    bend = resolve(J, dq.translation(x), slope, np.zeros(7))
    weight = dynamics.weight(q)
    moving = np.abs(dynamics.torque(q, np.zeros(7), bend) - weight)
    wanted = np.sqrt((moving / (LIMIT_SHARE * arm.card.effort - np.abs(weight))).max())
    found = motors.excess(q, np.zeros(7), x, J, slope)
    assert found == pytest.approx(wanted, rel=1e-9)
    damped = _Torques(arm, solver(arm, "wampler,factor=0.5"))
    assert damped.excess(q, np.zeros(7), x, J, slope) < 0.95 * found
    assert abs(wanted - 1) > 0.1


def test_unknown_words_are_refused(draw):
    with pytest.raises(DqpaintError, match="'wait'"):
        draw(GENTLE, "wait")
