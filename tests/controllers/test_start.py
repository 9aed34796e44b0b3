"""Each run starts a law of its own: what laws remember, work out beforehand and see ahead."""

import shutil
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import dqpaint
from dqpaint import dq
from dqpaint.controllers import CONTROLLERS, Arm, Gains, find_controller
from dqpaint.controllers.base.controller import Controller
from dqpaint.controllers.base.user_controller import make_controller
from dqpaint.disturbances import make_disturbances
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.planning.retiming import retime
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.settings import make_settings
from dqpaint.simulation.closed_loop import track, track_many
from dqpaint.studies.runner.batches import goes_in_batches
from dqpaint.studies.runner.run import Run
from tests.support.control import ARM, SHORT, STILL, law, seen_by, started
from tests.support.random_poses import random_poses

PI = Path(__file__).parents[2] / "trajectories" / "pi.py"
PUSHED = {"twist": {"x": 0.01}}
LAWS = pytest.mark.parametrize("name", [*CONTROLLERS, str(PI)])


def tracked(controller, motion=SHORT, plant="ideal", arm=ARM, gains=None, **choices):
    plant = PLANTS["torque" if controller.drives_torque else plant]
    gains = controller.read_gains(gains or {})
    return track(motion, arm, arm.card.home, plant, controller, gains, **choices)


def answers(law, controller, states):
    gains = controller.read_gains({}).first
    return np.array([law(state, gains) for state in states])


@LAWS
def test_two_laws_of_one_controller_share_nothing(name, rng):
    """Started together and asked by turns, each says what it says alone."""
    controller = find_controller(name)
    states = [
        seen_by(ARM, rng.uniform(-1, 1, 7), x, rng)._replace(row=i)
        for i, x in enumerate(random_poses(rng, 6))
    ]
    other = [state._replace(pose_d=state.pose) for state in reversed(states)]
    alone = answers(started(controller), controller, states)
    halved = {gain: value / 2 for gain, value in controller.gains().as_dict().items()
              if gain in controller.gains.model_fields and isinstance(value, float)}  # fmt: skip
    one = dict(list(halved.items())[:1])  # of a law without gains none
    first, second = started(controller), started(controller, motion=STILL, **one)
    gains, by_turns = controller.read_gains({}).first, []
    for state, another in zip(states, other, strict=True):
        second(another, gains)
        by_turns.append(first(state, gains))
    np.testing.assert_array_equal(by_turns, alone)
    np.testing.assert_array_equal(answers(started(controller), controller, states), alone)


@pytest.mark.parametrize("name", ["lqr", "lqr8"])
def test_what_was_worked_out_is_looked_up_at_the_row(name, rng):
    """With no weight at the end nothing is corrected there: at most the forward part is left."""
    said = law(name, s=0.0)
    seen = seen_by(ARM, ARM.card.home, random_poses(rng, 1)[0], rng)
    last = said(seen._replace(row=len(SHORT.t) - 1))
    x_e = dq.mul(seen.pose, dq.conj(dq.nearest(seen.pose_d, seen.pose)))
    left = dq.adjoint(x_e, seen.twist_d) if name == "lqr" else np.zeros(6)
    np.testing.assert_allclose(last, left, atol=1e-12)
    assert np.abs(said(seen) - left).max() > 1


@LAWS
def test_a_run_gives_the_same_bits_after_another_one(name):
    controller = find_controller(name)
    first = tracked(controller)
    tracked(controller, STILL)
    again = tracked(controller)
    np.testing.assert_array_equal(again.posture, first.posture)
    np.testing.assert_array_equal(again.command, first.command)


def test_the_integral_takes_away_what_a_push_leaves():
    """The proportional part alone leaves v / k of a constant push v."""
    pushed = partial(tracked, find_controller(str(PI)), STILL)
    push = make_disturbances(PUSHED)
    with_it, without = (
        pushed(disturbances=push, gains={"k": 40.0, "k_i": k_i}).points[-1] - STILL.points[-1]
        for k_i in (400.0, 0.0)
    )
    assert np.abs(without - [0.01 / 40.0, 0, 0]).max() < 1e-6
    assert np.abs(with_it).max() < 1e-6


def test_pi_is_a_class_of_a_dozen_lines():
    lines = PI.read_text("utf-8").split("class PI:")[1].splitlines()
    assert len([line for line in lines if line.strip()]) <= 12


# What of one's own is a law


class Counter:
    """Counts its steps, in a list that the class keeps, a number of its own, and in `start`."""

    calls = []  # noqa: RUF012  the mistake that this is about

    def __init__(self, first=1):
        self.number = first

    def start(self, arm, motion, gains):
        self.offset = gains.first.k

    def __call__(self, seen, k=2.0):
        self.calls.append(1)
        self.number += 1
        return np.full(6, self.number * k + len(self.calls) + self.offset)


@pytest.mark.parametrize("law", [Counter, Counter(), Counter(first=1)])
def test_a_class_and_an_object_begin_anew_each_run(law, rng):
    controller = make_controller(law, "counter")
    assert controller.summary.startswith("Counts its steps")
    seen, gains = seen_by(ARM, np.zeros(7), SHORT.pose[0], rng), controller.read_gains({}).first
    for _ in range(2):
        one = started(controller)
        assert [one(seen, gains)[0] for _ in range(2)] == [7.0, 10.0]
    assert Counter.calls == []
    if not isinstance(law, type):
        assert vars(law) == {"number": 1}


def test_an_object_goes_on_from_what_it_was_given_with(rng):
    controller = make_controller(Counter(first=5), "counter")
    seen = seen_by(ARM, np.zeros(7), SHORT.pose[0], rng)
    assert started(controller)(seen, controller.read_gains({}).first)[0] == 15.0


def test_methods_and_partial_functions_are_laws(rng):
    seen = seen_by(ARM, np.zeros(7), SHORT.pose[0], rng)

    class Box:
        def law(self, seen, k=2.0):
            """Twice."""
            self.k = getattr(self, "k", 0) + k
            return self.k * seen.twist_d

    box = Box()
    method = make_controller(box.law, "box")
    part = make_controller(partial(Box().law, k=3.0), "part")
    for controller, k in ((method, 2), (part, 3)):
        said = started(controller)(seen, controller.read_gains({}).first)
        np.testing.assert_allclose(said, k * seen.twist_d)
        assert controller.list_gains() == f"k = {k} (no unit said)"
        assert controller.summary == "Twice"
    assert vars(box) == {}


def test_a_class_says_what_it_commands(rng):
    @dqpaint.controllers.commands("rates")
    class Rates:
        def __call__(self, seen):
            return -seen.posture

    class Inside:
        @dqpaint.controllers.commands("torque")
        def __call__(self, seen):
            return seen.bias

    assert make_controller(Rates, "rates").commands == "rates"
    assert make_controller(Rates(), "rates").commands == "rates"
    assert make_controller(Inside, "inside").drives_torque


def test_start_is_told_of_the_arm_the_motion_and_the_gains():
    told = []

    class Curious:
        def start(self, arm, motion, gains):
            told.append((arm, motion, gains))

        def __call__(self, seen, k=2.0):
            return seen.twist_d

    tracked(make_controller(Curious(), "curious"), gains={"k": "1..3"})
    ((arm, motion, gains),) = told
    assert motion is SHORT
    assert [gains.at(part).k for part in (0, 0.5, 1)] == [1, 2, 3]
    assert arm.joints == 7
    q = ARM.card.home
    for mine, own in zip(
        arm.kinematics.pose_and_jacobian(q), ARM.pose_and_jacobian(q), strict=True
    ):
        np.testing.assert_array_equal(mine, own)
    assert arm.kinematics.model is not ARM.model  # a law may change it
    nearest = arm.collisions.nearest(q[None])
    assert 0.01 < nearest.distance[0] < 1


def test_the_arm_is_the_one_of_the_law_s_model():
    """Which a disturbance may have changed; the kinematics are those it is told by."""
    lengths = []

    class Curious:
        def start(self, arm, motion, gains):
            lengths.append(arm.kinematics.lengths)

        def __call__(self, seen):
            return seen.twist_d

    wrong = make_disturbances({"links": {"part": 0.01}})
    tracked(make_controller(Curious, "curious"), disturbances=wrong)
    assert 1e-4 < np.abs(lengths[0] - ARM.lengths).max() < 0.05


# What is seen


@pytest.mark.parametrize("robot", ["iiwa", "viper850"])
def test_limits_are_those_of_the_card(robot):
    card = read_card(robot)
    arm, seen = Kinematics(card), []

    def law(one):
        seen.append(one.limits)
        return np.zeros(6)

    tracked(make_controller(law, "law"), arm=arm)
    for limits in (seen[0], seen[-1], Arm(arm).limits):
        for name in ("lower", "upper", "speed", "effort"):
            np.testing.assert_array_equal(getattr(limits, name), getattr(card, name))
        with pytest.raises(ValueError, match="read-only"):
            limits.lower[0] = 0
    assert seen_by(arm, card.home, arm.pose(card.home)).limits.upper == np.inf


def slowed():
    """A motion whose clock runs slower where the arm could not keep up."""
    text = "period 8 ms\nmove to (-90, 0) mm\nline to (90, 0) mm in 0.25 s\nhold 80 ms\n"
    motion = dqpaint.motion.plan(dqpaint.language.parse(text, "fast"), ARM.card.canvas.pose)
    found = retime(motion, ARM, ARM.card.home, "start", "none")
    assert found.extra_time > 0.1
    return found.motion


@pytest.mark.parametrize("motion", [SHORT, slowed()], ids=["as asked", "slowed"])
def test_the_window_is_the_motion_s_own_rows(motion):
    rows, count = len(motion.t), 7
    asked = []

    def law(seen):
        window = seen.ahead(count)
        k = len(asked)
        asked.append(len(window.time))
        np.testing.assert_array_equal(window.time, motion.t[k : k + count + 1])
        np.testing.assert_array_equal(window.pose, motion.pose[k : k + count + 1])
        np.testing.assert_array_equal(window.twist, motion.twist[k : k + count + 1])
        np.testing.assert_array_equal(window.acceleration, motion.acceleration[k : k + count + 1])
        np.testing.assert_array_equal(window.pose[0], seen.pose_d)
        np.testing.assert_array_equal(window.twist[0], seen.twist_d)
        assert window.time[0] == seen.time
        assert window.pose.base is not None  # a view: nothing is copied
        assert not window.pose.flags.writeable
        assert len(seen.ahead(0).time) == 1
        return seen.twist_d

    tracked(make_controller(law, "law"), motion)
    assert asked == [min(count + 1, rows - k) for k in range(rows)]


def test_a_law_that_looks_ahead_leads_where_it_looks():
    """Going for the pose of three rows on, the tool is there two rows too soon."""
    motion, rows = SHORT, 3

    def early(seen, k=1.0):
        there = seen.ahead(rows).pose[-1]
        return 2 * dq.log(dq.mul(there, dq.conj(dq.nearest(seen.pose, there)))) / seen.period

    start = dqpaint.planning.reachability.reachable_start_posture(motion, ARM).posture
    law = make_controller(early, "early")
    found = track(motion, ARM, start, PLANTS["ideal"], law, law.read_gains({}))
    later = motion.points[1 + rows :]  # what row 2 and the next ones are led to
    np.testing.assert_allclose(found.points[2 : len(later) + 2], later, atol=2e-5)
    assert np.abs(found.points - motion.points).max() > 1e-3


def test_a_window_that_is_none_is_refused():
    def back(seen):
        return seen.ahead(-1).twist

    with pytest.raises(DqpaintError, match=r"test_start\.py:\d+: ValueError: a window of -1 rows"):
        tracked(make_controller(back, "back"))
    with pytest.raises(ValueError, match="no motion to look ahead at"):
        seen_by(ARM, np.zeros(7), SHORT.pose[0]).ahead(1)


# Faults


def written(tmp_path, text):
    path = tmp_path / "mine.py"
    path.write_text(text, "utf-8")
    return str(path)


@pytest.mark.parametrize(("text", "said"), [
    ("class A:\n    pass\n", "class 'A' can't be called: it has no __call__; a law is a function"),
    ("class A:\n    def __init__(self, x): pass\n    def __call__(self, seen): pass\n",
     "law 'A' in mine.py: each run makes a A() of its own, but 'x' of its constructor has no def"),
    ("class A:\n    def start(self, arm): pass\n    def __call__(self, seen): pass\n",
     "law 'A' in mine.py: its start is not def start(self, arm, motion, gains)"),
    ("class A:\n    start = 3\n    def __call__(self, seen): pass\n",
     "law 'A' in mine.py: its start is not def start(self, arm, motion, gains)"),
    ("class A:\n    def __call__(self): pass\n", "law 'A' in mine.py takes nothing; a law is"),
    ("class A:\n    def __call__(self, seen, k): pass\n", "parameter 'k' has no number; a law is"),
    ("def f(seen):\n    yield seen.twist_d\n",
     "law 'f' in mine.py yields, but a law returns what it commands; a law is a function"),
    ("class A:\n    def __call__(self, seen):\n        yield 1\n", "law 'A' in mine.py yields"),
    ("async def f(seen): return seen.twist_d\n", "law 'f' in mine.py is async, but a law returns"),
    ("class A:\n    commands = 'force'\n    def __call__(self, seen): pass\n",
     "law 'A' in mine.py can't command 'force'; known: twist, rates"),
    ("class A:\n    def __call__(self, seen): pass\nclass B(A): pass\n",
     "mine.py has 2 laws; choose one: mine.py:NAME; its laws: A, B; a law is"),
    ("class A: pass\nclass B: pass\n", "mine.py has 0 laws; its laws: none; a law is"),
])  # fmt: skip
def test_what_is_no_law_is_refused_before_the_run(tmp_path, text, said):
    with pytest.raises(UsageError) as caught:
        find_controller(written(tmp_path, text))
    assert said in str(caught.value)


@pytest.mark.parametrize(("text", "said"), [
    ("class A:\n    def start(self, arm, motion, gains):\n        1 / 0\n"
     "    def __call__(self, seen): return seen.twist_d\n",
     "mine.py:3: ZeroDivisionError: division by zero\n  |\n3 |         1 / 0"),
    ("class A:\n    def __init__(self):\n        raise OSError('no')\n"
     "    def __call__(self, seen): return seen.twist_d\n", "mine.py:3: OSError: no"),
    ("class A:\n    def start(self, arm, motion, gains): return self\n"
     "    def __call__(self, seen): return seen.twist_d\n",
     "mine.py: start of law 'A' returned a A; it returns nothing: what it works out is kept"),
    ("class A:\n    def start(self, arm, motion, gains): yield\n"
     "    def __call__(self, seen): return seen.twist_d\n",
     "mine.py: start of law 'A' returned a generator; it returns nothing"),
    ("class A:\n    def __call__(self, seen): return seen.twist_d[:5]\n",
     "mine.py:2: a law that commands a twist returns 6 numbers, this one returned an array of "
     "shape (5,)"),
    ("class A:\n    def __call__(self, seen): return seen.twist_d * float('nan')\n",
     "mine.py:2: at 0.000 s the law returned [nan nan nan nan nan nan], not finite numbers"),
    ("class A:\n    def __call__(self, seen):\n        return self.sum\n",
     "mine.py:3: AttributeError: 'A' object has no attribute 'sum'"),
    ("from abc import ABC, abstractmethod\nclass A(ABC):\n    @abstractmethod\n"
     "    def f(self): pass\n    def __call__(self, seen): pass\n", "mine.py: TypeError: Can't"),
    ("class A:\n    def start(self, arm, motion, gains): arm.limits.lower[0] = 1\n"
     "    def __call__(self, seen): return seen.twist_d\n", "assignment destination is read-only"),
    ("class A:\n    def start(self, arm, motion, gains): motion.pose[0] = 1\n"
     "    def __call__(self, seen): return seen.twist_d\n", "assignment destination is read-only"),
])  # fmt: skip
def test_faults_of_a_class_are_told_with_its_own_line(tmp_path, text, said):
    controller = find_controller(written(tmp_path, text))
    with pytest.raises(DqpaintError) as caught:
        tracked(controller)
    assert said in str(caught.value)
    assert "dqpaint/" not in str(caught.value)


@pytest.mark.parametrize("law", [3, (x for x in "abc"), [1.0] * 6])
def test_what_can_t_be_called_is_refused(law):
    with pytest.raises(UsageError, match="can't be called: it has no __call__; a law is a funct"):
        dqpaint.draw("circle", controller=law)


def test_what_can_t_be_copied_is_told():
    class Held:
        def __init__(self):
            self.file = open(__file__)  # noqa: SIM115

        def __call__(self, seen):
            return seen.twist_d

    held = Held()
    with pytest.raises(DqpaintError, match=r"TypeError: cannot pickle '.*TextIO"):
        started(make_controller(held, "held"))
    held.file.close()


# Batches and studies


def run_of(controller):
    settings = make_settings(controller=controller, plant="ideal", disturb=PUSHED)
    return Run("line.traj", "line to (20, 0) mm\n", settings)


class Many:
    """A law that remembers the sum of errors of every arm."""

    batched = True

    def start(self, arm, motion, gains):
        self.sum = 0.0

    def __call__(self, seen, k=20.0):
        e = 2 * dq.log(dq.mul(seen.pose_d, dq.conj(dq.nearest(seen.pose, seen.pose_d))))
        self.sum = self.sum + seen.period * e
        return seen.twist_d + k * e + 30 * self.sum


def test_a_class_goes_in_batches_where_it_says_so(tmp_path):
    push = make_disturbances({"twist": {"form": "noise", "x": 0.02, "frequency": 5.0}})
    many = make_controller(Many, "many")
    fixed = (SHORT, ARM, ARM.card.home, PLANTS["ideal"], many, many.read_gains({}))
    assert many.batched
    together = track_many(*fixed, push, [3, 4])
    for seed, found in zip([3, 4], together, strict=True):
        alone = track(*fixed, disturbances=push, seed=seed)
        np.testing.assert_allclose(found.posture, alone.posture, atol=1e-11)
    one = find_controller(str(PI))
    assert not one.batched
    with pytest.raises(ValueError, match="law 'pi' takes one arm at a time"):
        track_many(SHORT, ARM, ARM.card.home, PLANTS["ideal"], one, one.read_gains({}), push, [3])
    assert not goes_in_batches(run_of(str(PI)))
    assert not goes_in_batches(run_of("nobody"))
    text = "class A:\n    batched = True\n    def __call__(self, seen): return seen.twist_d\n"
    spec = written(tmp_path, text)
    assert goes_in_batches(run_of(spec))
    wrong = find_controller(written(tmp_path, text.replace("twist_d", "twist_d[:6]")))
    with pytest.raises(DqpaintError, match=r"an array of shape \(2, 6\), this one returned an arr"):
        track_many(*fixed[:4], wrong, wrong.read_gains({}), push, [3, 4])


ALONE = {"adaptive", "mpc", "admittance"}  # what they keep or solve is of one arm


def test_registered_classes_say_whether_they_go_in_batches():
    for name, chosen in CONTROLLERS.items():
        assert chosen.batched is (name not in ALONE), name
    one = Controller("mine", "a test", Gains, Counter)
    assert not one.batched


def test_the_key_of_a_run_holds_the_class(tmp_path):
    spec = str(shutil.copy(PI, tmp_path / "pi.py"))
    run = run_of(spec)
    before = run.key
    assert run.files()["law"] == find_controller(str(PI)).sha256
    Path(spec).write_text(Path(spec).read_text().replace("100.0", "101.0"))
    assert replace(run).key != before


@pytest.mark.slow
def test_pi_gives_the_same_bits_in_this_process_and_in_two_workers(tmp_path):
    """As a file, a class and an object; by a sweep, by draws one after the other, by compare."""
    drawing = tmp_path / "line.traj"
    drawing.write_text("period 10 ms\nspeed 60 mm/s\nline to (40, 20) mm\n")
    scope = {}
    exec(PI.read_text("utf-8"), scope)
    small = {"plant": "ideal", "disturb": PUSHED}
    swept = dqpaint.sweep(drawing, "k=10,20,30", controller=str(PI), jobs=2, **small)
    alone = dqpaint.sweep(drawing, "k=10,20,30", controller=str(PI), jobs=1, **small)
    np.testing.assert_equal(swept.table, alone.table)
    for i, k in enumerate((10.0, 20.0, 30.0)):
        drawn = [
            dqpaint.draw(drawing, controller=law, gains={"k": k}, **small)
            for law in (str(PI), scope["PI"], scope["PI"](), str(PI))
        ]
        for one in drawn:
            np.testing.assert_array_equal(one.track.command, drawn[0].track.command)
            found = one.metrics.figures["position_error_rms_m"]
            assert found == swept.table["position_error_rms_m_mean"][i]
    assert [one.controller.name for one in drawn] == ["pi", "PI", "PI", "pi"]
    compared = dqpaint.compare(drawing, [f"{PI}:PI", "pff"], jobs=2, **small)
    errors = compared.table["position_error_rms_m_mean"]
    assert errors[0] == swept.table["position_error_rms_m_mean"][1]
    assert errors[0] < errors[1]
    tuned = dqpaint.tune(drawing, "k_i=1..100", controller=str(PI), budget=25, jobs=2, **small)
    assert len(tuned.table["k_i"]) <= 25
