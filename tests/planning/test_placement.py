"""`place auto`: reachable, better than elsewhere, the same each time, and fit to be pasted."""

from dataclasses import replace

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.language import ScriptError, parse
from dqpaint.motion import plan
from dqpaint.planning import placement
from dqpaint.planning.forecast import forecast
from dqpaint.planning.placement import find_placement, place_program
from dqpaint.planning.reachability import reachable_start_posture
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.settings.model import make_settings

AUTO = make_settings(place="auto")
WIDE = "place auto\nstart at (0, 0) mm\nline to (500, 0) mm\nline by (0, 300) mm\n"
SMALL = "start at (-60, 0) mm\nline to (60, 30) mm tool rot(y, 20 deg)\nline to (0, 90) mm\n"


@pytest.fixture(scope="module")
def arm():
    return Kinematics(read_card("iiwa"))


@pytest.fixture(scope="module")
def placed(arm):
    return place_program(parse(SMALL, "small.traj"), arm, AUTO)[1]


@pytest.mark.slow
def test_it_is_better_than_the_canvas_and_than_other_places(arm, placed):
    """Against the figures of the whole drawing, at places nobody chose for it."""
    program = place_program(parse(SMALL, "small.traj"), arm, AUTO)[0]
    canvas = arm.card.canvas.pose
    turned = dq.rotation(canvas)
    rng = np.random.default_rng(9)
    places = [dq.translation(canvas), *rng.uniform([0.3, -0.6, 0], [0.8, 0.6, 0.9], (7, 3))]
    others = [
        placement._evaluate(program, arm, placement._place_statement(p, turned)) for p in places
    ]
    merits = [other.merit for other in others if other is not None]
    assert len(merits) > 2
    assert placed.merit > 1.5 * merits[0]
    assert placed.merit > max(merits)


@pytest.mark.slow
def test_no_small_step_is_better(arm, placed):
    program = place_program(parse(SMALL, "small.traj"), arm, AUTO)[0]
    at = np.array(placed.pose.position)
    for way in np.vstack([np.eye(3), -np.eye(3)]):
        line = placement._place_statement(at + 0.02 * way, dq.rotation(arm.card.canvas.pose))
        other = placement._evaluate(program, arm, line)
        assert other is None or other.merit < 1.05 * placed.merit


def test_the_search_climbs_from_the_grid(arm):
    motion = plan(parse(SMALL, "small.traj"), arm.card.canvas.pose)
    search = placement._Search(motion, arm)
    grid = search._grid()
    rough = search._merits(grid, placement.COARSE_POSES, placement.COARSE_STARTS)
    best = grid[int(np.argmax(rough))]
    found = search._climb(best, on_floor=False)
    before, after = search._merits(
        np.stack([best, found]), placement.FINE_POSES, placement.FINE_STARTS
    )
    assert before > 0
    assert after > 1.01 * before
    assert (rough > 0).mean() < 0.9  # some places of the grid are out of reach


def test_the_line_is_exactly_that_place(arm, placed):
    program = parse(f"{placed.statement}\n{SMALL}", "pasted.traj")
    assert program.placement == placed.pose
    np.testing.assert_allclose(
        dq.matrix_from_quaternion(np.array(placed.pose.orientation)),
        dq.matrix_from_quaternion(dq.rotation(arm.card.canvas.pose)),
        atol=1e-9,
    )


def test_the_figures_are_those_of_the_drawing_at_that_place(arm, placed):
    program = parse(f"{placed.statement}\n{SMALL}", "pasted.traj")
    motion = plan(program, arm.card.canvas.pose)
    q = reachable_start_posture(motion, arm).posture
    worst, room = np.inf, 1.0
    card = arm.card
    for x_d in motion.pose[::4]:  # Newton by pinocchio's Jacobian alone
        for _ in range(4):
            x, J = arm.pose_and_jacobian(q)
            error = 2 * dq.log(dq.mul(dq.nearest(x_d, x), dq.conj(x)))
            q = q + np.linalg.pinv(J) @ error
        J = arm.pose_and_jacobian(q)[1]
        worst = min(worst, np.sqrt(np.linalg.det(J @ J.T)))
        left = np.minimum(q - card.lower, card.upper - q) / (0.5 * (card.upper - card.lower))
        room = min(room, left.min())
    assert placed.manipulability == pytest.approx(worst, rel=0.05)
    assert placed.relative_margin == pytest.approx(room, rel=0.05)
    assert placed.merit == pytest.approx(
        placed.manipulability * placed.relative_margin * placed.torque_left * placed.pace
    )


def test_the_torque_that_the_weight_leaves_is_that_of_lifting_it(arm, placed):
    """By what the potential energy gains where a joint turns a little."""
    import pinocchio

    motion = plan(parse(f"{placed.statement}\n{SMALL}", "pasted.traj"), arm.card.canvas.pose)
    q, model = reachable_start_posture(motion, arm).posture, arm.model
    data, left, step = model.createData(), 1.0, 1e-5
    for x_d in motion.pose[::8]:
        for _ in range(4):
            x, J = arm.pose_and_jacobian(q)
            q = q + np.linalg.pinv(J) @ (2 * dq.log(dq.mul(dq.nearest(x_d, x), dq.conj(x))))
        for j, most in enumerate(arm.card.effort):
            turn = step * np.eye(7)[j]
            gained = pinocchio.computePotentialEnergy(model, data, q + turn)
            gained -= pinocchio.computePotentialEnergy(model, data, q - turn)
            left = min(left, 1 - abs(gained) / (2 * step) / most)
    assert placed.torque_left == pytest.approx(left, abs=0.01)
    assert left < 0.9


@pytest.mark.slow
def test_a_weak_arm_is_given_a_place_where_its_weight_is_less(monkeypatch):
    """An iiwa whose shoulder could hardly hold it where the merit without torque puts it."""
    card = read_card("iiwa")
    effort = (*card.limits.effort_Nm[:1], 55.0, *card.limits.effort_Nm[2:])
    weak = Kinematics(card.model_copy(update={
        "limits": card.limits.model_copy(update={"effort_Nm": effort})
    }))  # fmt: skip
    found = place_program(parse(SMALL, "small.traj"), weak, AUTO)[1]
    with monkeypatch.context() as patched:
        patched.setattr(placement, "_torque_left", lambda _part: 1.0)
        blind = place_program(parse(SMALL, "small.traj"), weak, AUTO)[1]
    motion = plan(parse(f"{blind.statement}\n{SMALL}", "t"), weak.card.canvas.pose)
    lines = forecast(motion, weak, reachable_start_posture(motion, weak).posture)
    assert found.torque_left > 1.5 * (1 - max(one.weight_part for one in lines))
    assert found.merit > blind.merit * (1 - max(one.weight_part for one in lines))


@pytest.mark.parametrize(
    "bad", [{"path_error": 2e-3}, {"relative_margin": -0.01}, {"clearance": -1e-3}]
)
def test_a_place_that_does_not_do(arm, placed, bad):
    motion = plan(parse(f"{placed.statement}\n{SMALL}", "pasted.traj"), arm.card.canvas.pose)
    one = forecast(motion, arm, reachable_start_posture(motion, arm).posture)[0]
    assert placement._is_valid(one)
    assert not placement._is_valid(replace(one, **bad))


@pytest.mark.slow
def test_a_light_that_the_arm_hides_everywhere_is_placed_all_the_same(arm):
    text = "start at (0, 0) mm tool rpy(0 deg, 150 deg, 0 deg)\nline to (30, 0) mm light red\n"
    placed = place_program(parse(text, "t"), arm, AUTO)[1]
    assert placed.occluded > placement.MOST_OCCLUDED
    assert placed.relative_margin > 0


@pytest.mark.slow
def test_a_drawing_too_wide_for_the_canvas_finds_its_place(arm):
    program = parse(WIDE, "wide.traj")
    with pytest.raises(ScriptError, match="E310"):
        reachable_start_posture(plan(program, arm.card.canvas.pose), arm)
    settled, first = place_program(program, arm)
    motion = plan(settled, arm.card.canvas.pose)
    assert reachable_start_posture(motion, arm).margin > 0
    assert find_placement(program, arm) == first  # again the same
    np.testing.assert_array_equal(motion.front, dq.rotation(arm.card.canvas.pose))


@pytest.mark.slow
def test_a_drawing_stays_above_what_the_arm_stands_on_where_it_can(monkeypatch):
    """The xArm 6 would fit one of them better lower down; another one has to go there."""
    arm = Kinematics(read_card("xarm6"))

    def lowest_and_merit(half):
        text = f"start at (0, {half}) mm\nline to (0, -{half}) mm\n"
        settled, placed = place_program(parse(text, "t"), arm, AUTO)
        return plan(settled, arm.card.canvas.pose).points[:, 2].min(), placed.merit

    above, merit = lowest_and_merit(300)
    assert above > -1e-4
    assert lowest_and_merit(420)[0] < -0.1
    monkeypatch.setattr(placement._Search, "_above", lambda _, shifts: np.ones(len(shifts), bool))
    below, better = lowest_and_merit(300)
    assert below < -0.05
    assert better > merit


def test_turned_is_kept(arm):
    text = "place auto turned rpy(90 deg, 0 deg, 60 deg)\n" + SMALL
    program, found = place_program(parse(text, "turned.traj"), arm)
    asked = parse(text.replace("auto", "at (0, 0) mm"), "t").placement
    np.testing.assert_allclose(found.pose.orientation, asked.orientation, atol=1e-9)
    assert program.placement == found.pose


def test_a_place_of_the_file_stays_unless_auto_is_asked_for(arm):
    text = "place at (700, 0, 500) mm turned rpy(90 deg, 0 deg, 90 deg)\n" + SMALL
    program = parse(text, "t")
    assert place_program(program, arm) == (program, None)
    assert place_program(program, arm, AUTO)[1].merit > 0


@pytest.mark.slow
def test_nowhere(arm):
    with pytest.raises(ScriptError) as caught:
        place_program(parse("place auto\nline to (3, 0) m\n", "long.traj"), arm)
    text = str(caught.value)
    assert "E313" in text
    assert "long.traj:1:1" in text
    assert "3000 x 0 x 0 mm" in text
    assert "make it smaller: with scale 0.25 ... end" in text
    place_program(parse("place auto\nwith scale 0.25\nline to (3, 0) m\nend\n", "long.traj"), arm)


@pytest.mark.slow
def test_nowhere_with_the_tool_turned_so(arm):
    """A straight tool has room, a smaller drawing has not."""
    turns = "line to (60, 0) mm tool rot(x, 100 deg)\nline to (0, 0) mm tool rot(x, -100 deg)\n"
    turns += "line to (60, 0) mm tool rot(y, 150 deg)\nline to (0, 0) mm tool rot(y, -150 deg)\n"
    with pytest.raises(ScriptError) as caught:
        place_program(parse(f"place auto\n{turns}", "turns.traj"), arm)
    assert "= help: hold the tool straight: without 'tool' there is room" in str(caught.value)


@pytest.mark.parametrize(("line", "code"), [
    ("place auto at (0, 0) mm", "E248"), ("place automatic", "E110"), ("place auto auto", "E110"),
    ("place auto\nplace auto", "E1"), ("let auto = 3 mm", "E1"),
])  # fmt: skip
def test_slips_in_the_language(line, code):
    with pytest.raises(ScriptError) as caught:
        parse(f"{line}\nline to (1, 0) mm\n", "t")
    assert code in str(caught.value)


@pytest.mark.parametrize(("changed", "poor"), [
    ({"relative_margin": 0.5, "torque_left": 0.5}, False),
    ({"relative_margin": 0.06, "torque_left": 0.5}, True),
    ({"relative_margin": 0.5, "torque_left": 0.06}, True),
    ({"relative_margin": 0.5, "torque_left": 0.5, "pace": 0.9}, True),
])  # fmt: skip
def test_a_place_that_leaves_little_is_called_poor(placed, changed, poor):
    assert replace(placed, **changed).figures.startswith("a poor place: ") == poor


@pytest.mark.slow
def test_the_speeds_of_a_place_count(arm):
    """The place of the slow drawing is worse for the fast one than its own, and called poor."""
    line = "place auto\nline to (0, 300) mm in {} s\n"
    fast = parse(line.format(0.35), "t")
    own = placement.find_placement(fast, arm)
    slow = placement.find_placement(parse(line.format(9), "t"), arm)
    assert slow.pace == 1.0
    there = placement._evaluate(fast, arm, slow.statement)
    assert there.pace < own.pace < 1.0
    assert there.merit < own.merit
    assert own.is_poor
    assert not slow.is_poor
    motion = plan(replace(fast, placement=own.pose), arm.card.canvas.pose)
    lines = forecast(motion, arm, reachable_start_posture(motion, arm).posture)
    assert own.pace == pytest.approx(1 / max(one.speed_part for one in lines))
