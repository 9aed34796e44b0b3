"""Laws of one's own: found in a file or handed over, their gains, and how their faults are told."""

import hashlib
import os
from pathlib import Path
from typing import Annotated

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS, Seen, commands, find_controller
from dqpaint.controllers.base.user_controller import make_controller
from dqpaint.core import short_name
from dqpaint.errors import DqpaintError, UsageError
from tests.support.control import started
from tests.support.random_poses import random_poses

EXAMPLE = Path(__file__).parents[2] / "trajectories" / "mylaw.py"


def seen_at(rng, joints=7):
    x, x_d = random_poses(rng, 2)
    twist, slope = rng.normal(size=(2, 6))
    J, q = rng.normal(size=(6, joints)), rng.normal(size=joints)
    return Seen(x, x_d, twist, slope, J, q, 0.25, 0.005, rng.normal(size=joints))


def written(tmp_path, text, name="mine.py"):
    path = tmp_path / name
    path.write_text(text, "utf-8")
    return str(path)


def asked(controller, seen, **gains):
    """What the law of a run answers."""
    return started(controller, **gains)(seen, controller.read_gains(gains).first)


def test_the_example_is_the_law_its_text_says(rng):
    """Along the screw from x to x_d, by homogeneous matrices and pinocchio's logarithm."""
    import pinocchio

    law = find_controller(str(EXAMPLE))
    assert (law.name, law.commands) == ("mylaw", "twist")
    assert law.summary.startswith("Follow the screw")
    seen = seen_at(rng)
    T = dq.matrix_from_pose(seen.pose_d) @ np.linalg.inv(dq.matrix_from_pose(seen.pose))
    v = pinocchio.log6(pinocchio.SE3(T)).vector
    wanted = seen.twist_d + 3.0 * np.r_[v[3:], v[:3]]
    u = asked(law, seen, k=3.0)
    np.testing.assert_allclose(u, wanted, atol=1e-9)


def test_a_law_is_ten_lines():
    lines = EXAMPLE.read_text("utf-8").splitlines()
    assert len([line for line in lines if line.strip()]) <= 10


def test_functions_are_found_by_name_or_as_the_only_one(tmp_path):
    spec = written(
        tmp_path,
        "import math\nfrom dqpaint.dq import mul\n\n"
        "def one(seen): return seen.twist_d\n\ndef two(seen, k=2): return k * seen.twist_d\n\n"
        "def _hidden(seen): pass\n",
    )
    assert find_controller(f"{spec}:two").name == "two"
    with pytest.raises(UsageError, match=r"mine.py has 2 laws; choose one: mine.py:NAME; "):
        find_controller(spec)
    with pytest.raises(UsageError, match=r"no law named 'three'; its laws: one, two; a"):
        find_controller(f"{spec}:three")
    alone = written(tmp_path, "def whatever(seen): return seen.twist_d\n", "alone.py")
    assert find_controller(alone).name == "alone"
    same = written(tmp_path, "def a(seen): pass\n\ndef same(seen): pass\n", "same.py")
    assert find_controller(same).law.__name__ == "same"
    with pytest.raises(UsageError, match="has 0 laws"):
        find_controller(written(tmp_path, "x = 3\n", "none.py"))
    assert find_controller("hinf") is CONTROLLERS["hinf"]
    assert [short_name(n) for n in ("hinf", "a/b.py", "a/b.py:c")] == ["hinf", "b", "c"]


def test_parameters_are_gains_with_units(rng):
    def law(seen, k: Annotated[float, "1/s, how fast"] = 2, offset=-1.0):
        return k * seen.twist_d + offset

    chosen = make_controller(law, "law")
    assert chosen.list_gains() == "k = 2 (1/s, how fast), offset = -1 (no unit said)"
    seen = seen_at(rng)
    gains = chosen.read_gains({"k": "0..4@50%"})
    np.testing.assert_allclose(started(chosen)(seen, gains.at(0.25)), 2 * seen.twist_d - 1)
    with pytest.raises(UsageError, match=r"'K'; .*k = 2 \(1/s"):
        chosen.read_gains({"K": 1.0})
    with pytest.raises(UsageError, match=r"'k' .*nan"):
        chosen.read_gains({"k": float("nan")})


@pytest.mark.parametrize("law", [lambda seen, k: 0, lambda seen, *k: 0, lambda seen, k=True: 0,
                                 lambda seen, k="a": 0, lambda seen, **k: 0])  # fmt: skip
def test_other_parameters_are_refused(law):
    with pytest.raises(UsageError, match="'k' has no number"):
        make_controller(law, "law")


def test_a_law_of_nothing_is_refused():
    with pytest.raises(UsageError, match="takes nothing"):
        make_controller(lambda: 0, "law")


def test_a_law_says_what_it_commands(rng):
    @commands("rates")
    def rates(seen):
        return -seen.posture

    @commands("torque")
    def torque(seen):
        return seen.bias

    chosen = make_controller(rates, "rates")
    assert (chosen.commands, chosen.drives_torque) == ("rates", False)
    assert make_controller(torque, "torque").drives_torque
    seen = seen_at(rng, joints=5)
    np.testing.assert_array_equal(asked(chosen, seen), -seen.posture)
    with pytest.raises(ValueError, match="'force'"):
        commands("force")


FAULTS = [
    ("def f(seen):\n    return helper(seen)\n\ndef _x(): pass\n",
     "mine.py:2: NameError: name 'helper' is not defined\n  |\n2 |     return helper(seen)"),
    ("def _deep(x):\n    return 1 / 0\n\ndef f(seen):\n    return _deep(seen)\n",
     "mine.py:2: ZeroDivisionError: division by zero\n  |\n2 |     return 1 / 0"),
    ("import numpy as np\ndef f(seen):\n    return np.linalg.inv(np.zeros((2, 3)))\n",
     "mine.py:3: LinAlgError"),
    ("def f(seen):\n    seen.posture[0] = 1\n", "mine.py:2: ValueError: assignment destination"),
    ("def f(seen): return None\n",
     "mine.py:1: a law that commands a twist returns 6 numbers, this one returned nothing"),
    ("def f(seen): return [1, 2]\n", r"returned an array of shape (2,)"),
    ("def f(seen): return 'left'\n", "returned a str"),
    ("def f(seen): return [[1], [2, 3]]\n", "returned an array of shape (2,)"),
    ("def f(seen): return [float('inf')] * 6\n", "at 0.250 s the law returned [inf"),
    ("def f(seen): raise SystemExit(3)\n", "mine.py:1: SystemExit: 3"),
    ("import os\ndef f(seen): os._exit(0)\n", "mine.py:2: SystemExit: os._exit(0)"),
    ("def f(seen): raise GeneratorExit\n", "mine.py:1: GeneratorExit"),
    ("class B(BaseException): pass\ndef f(seen): raise B('x')\n", "mine.py:2: B: x"),
    ("class B(Exception):\n    def __str__(self): raise OSError\n\ndef f(seen): raise B()\n",
     "mine.py:4: B\n"),
    ("def f(seen): return ['1'] * 6\n", "returned values of type str, not numbers"),
    ("def f(seen): return [True] * 6\n", "returned values of type bool, not numbers"),
    ("import numpy as np\ndef f(seen): return np.ma.array(np.ones(6), mask=[1, 0, 0, 0, 0, 0])\n",
     "returned masked numbers"),
    ("import numpy as np\ndef f(seen): return [np.ma.masked, 1, 1, 1, 1, 1]\n",
     "returned masked numbers"),
    ("def f(seen): return [None] * 6\n", "returned values that are not numbers"),
    ("def f(seen): return [10**400] * 6\n", "at 0.250 s the law returned [inf"),
    ("def f(seen): return [[1]] * 6\n", "returned an array of shape (6, 1)"),
    ("def f(seen): return [[1], [2, 3]] * 3\n", "returned rows of several lengths"),
    ("class A:\n    def __array__(self, *a, **k): raise OSError('no')\n\ndef f(seen): return A()\n",
     "mine.py:2: OSError: no"),
    ("class A:\n    def __float__(self): raise OSError('no')\n\ndef f(seen): return [A()] * 6\n",
     "mine.py:2: OSError: no"),
    ("import numpy as np\ndef f(seen): return np.broadcast_to(0.0, (10**12, 6))\n",
     "returned an array of shape (1000000000000, 6)"),
    ("def f(seen): return 1 / 0  # " + 200 * "x" + "\n", 90 * "x" + " ..."),
]  # fmt: skip


@pytest.mark.parametrize(("text", "said"), FAULTS)
def test_faults_of_a_law_are_told_with_its_own_line(tmp_path, rng, text, said):
    law = find_controller(written(tmp_path, text))
    with pytest.raises(DqpaintError) as caught:
        asked(law, seen_at(rng))
    assert said in str(caught.value)
    assert "dqpaint/" not in str(caught.value)


def test_other_threads_and_processes_end_as_they_ask(tmp_path, rng):
    """Such as the one that ends a worker with its study, and a process that a law forks."""
    text = (
        "import os\n"
        "def f(seen):\n"
        "    child = os.fork()\n"
        "    if not child:\n"
        "        os._exit(7)\n"
        "    return [os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])] * 6\n"
    )
    law = find_controller(written(tmp_path, text))
    assert asked(law, seen_at(rng)).tolist() == [7.0] * 6
    assert os._exit.__module__ == "posix"


@pytest.mark.parametrize(("text", "said"), [
    ("def f(:\n", "mine.py:1: SyntaxError: "), ("x = 1 / 0\n", "mine.py:1: ZeroDivisionError"),
    ("import nothing_of_this_name\n", "mine.py:1: ModuleNotFoundError"),
    ("exit(3)\n", "mine.py:1: SystemExit: 3"), ("\x00", "null bytes"),
    ("from os import _exit\n_exit(0)\n", "mine.py:2: SystemExit: os._exit"),
])  # fmt: skip
def test_faults_of_a_file_are_told(tmp_path, text, said):
    with pytest.raises(DqpaintError, match=said.replace("(", r"\(")):
        find_controller(written(tmp_path, text))


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(DqpaintError, match="cannot be read"):
        find_controller(str(tmp_path / "none.py"))
    (tmp_path / "latin.py").write_bytes(b"# M\xfcller\n")
    with pytest.raises(DqpaintError, match="UTF-8"):
        find_controller(str(tmp_path / "latin.py"))


@pytest.mark.parametrize(("default", "said"), [("float('nan')", "nan"), ("10**400", "1000")])
def test_a_default_is_finite(tmp_path, default, said):
    with pytest.raises(UsageError, match=f"parameter 'k' is {said}"):
        find_controller(written(tmp_path, f"def f(seen, k={default}): return seen.twist_d\n"))


def test_commands_that_are_none_are_refused(tmp_path):
    spec = written(tmp_path, "def f(seen): return seen.twist_d\nf.commands = 'force'\n")
    with pytest.raises(UsageError, match="'force'"):
        find_controller(spec)


def test_what_is_no_plain_file_is_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe.py")
    (tmp_path / "folder.py").mkdir()
    (tmp_path / "zero.py").symlink_to("/dev/zero")
    for name in ("pipe.py", "folder.py", "zero.py"):
        with pytest.raises(DqpaintError, match="cannot be read"):
            find_controller(str(tmp_path / name))
    large = written(tmp_path, "#" * 1_000_001, "large.py")
    with pytest.raises(DqpaintError, match="it is larger than 1 MB"):
        find_controller(large)


def test_a_mark_at_the_beginning_does_no_harm_and_the_hash_is_of_what_was_run(tmp_path):
    text = "\ufeffdef f(seen): return seen.twist_d\n"
    spec = written(tmp_path, text)
    law = find_controller(spec)
    Path(spec).write_text("changed since")
    assert law.sha256 == hashlib.sha256(text.encode()).hexdigest()


def test_a_law_can_t_load_itself(tmp_path, rng):
    again = "from dqpaint.controllers import find_controller\n"
    with pytest.raises(DqpaintError, match=r"mine\.py draws with itself"):
        find_controller(written(tmp_path, again + "find_controller(__file__)\n"))
    law = find_controller(
        written(tmp_path, again + "def f(seen): return find_controller(__file__)\n")
    )
    with pytest.raises(DqpaintError, match=r"mine\.py draws with itself"):
        asked(law, seen_at(rng))


def test_neighbours_and_classes_of_a_file_can_be_used(tmp_path, rng):
    written(tmp_path, "FACTOR = 3.0\n", "neighbour_of_mine.py")
    spec = written(
        tmp_path,
        "from dataclasses import dataclass\nfrom neighbour_of_mine import FACTOR\n\n"
        "@dataclass\nclass State:\n    k: float\n\n"
        "def f(seen):\n    return State(FACTOR).k * seen.twist_d\n",
    )
    law, seen = find_controller(spec), seen_at(rng)
    np.testing.assert_allclose(asked(law, seen), 3 * seen.twist_d)


@pytest.mark.slow
def test_a_function_can_be_handed_over_from_python(tmp_path):
    import dqpaint

    def straight(seen, k=10.0):
        """Straight to the point."""
        return seen.twist_d + 2 * k * dq.log(dq.mul(seen.pose_d, dq.conj(seen.pose)))

    drawing = tmp_path / "line.traj"
    drawing.write_text("line to (30, 0) mm in 0.5 s\n")
    painting = dqpaint.draw(drawing, controller=straight, gains={"k": 15.0}, size=(64, 36))
    assert painting.controller.name == "straight"
    assert painting.gains == {"k": 15.0}
    assert painting.metrics.figures["position_error_rms_m"] < 1e-3
    assert [path.name for path in dqpaint.save(painting, tmp_path)] == [
        "line-straight.png", "line-straight.csv", "line-straight.json",
    ]  # fmt: skip


@pytest.mark.parametrize(
    "name", ["_k", "as_dict", "disturbance_bounds", "copy", "json", "model_config"]
)
def test_a_gain_has_no_name_of_the_model_s_own(name):
    scope = {}
    exec(f"def law(seen, {name}=1.0): pass", scope)
    with pytest.raises(UsageError, match=f"'{name}'"):
        make_controller(scope["law"], "law")


def test_complex_answers_are_refused(rng):
    law = make_controller(lambda seen: seen.twist_d + 1j, "law")
    with pytest.raises(DqpaintError, match="complex"):
        asked(law, seen_at(rng))


def test_units_are_found_where_annotations_are_put_off(tmp_path):
    text = (
        "from __future__ import annotations\nfrom typing import Annotated\n\n"
        'def f(seen, k: Annotated[float, "1/s"] = 2.0): return k * seen.twist_d\n'
    )
    assert find_controller(written(tmp_path, text)).list_gains() == "k = 2 (1/s)"
    assert make_controller(lambda seen: 0, "law").list_gains() == "none"


def test_a_law_that_opens_what_it_sees_moves_nothing(tmp_path, rng):
    """Arrays are of the law's own: an arm is moved by commands alone."""
    spec = written(
        tmp_path,
        "def f(seen):\n"
        "    for array in (seen.pose, seen.jacobian, seen.posture, seen.rates):\n"
        "        array.flags.writeable = True\n"
        "        array[:] = 7.0\n"
        "    return seen.twist_d\n",
    )
    seen = seen_at(rng)
    arms = seen.pose, seen.jacobian, seen.posture, seen.rates
    before = [np.copy(array) for array in arms]
    asked(find_controller(spec), seen)
    for array, was in zip(arms, before, strict=True):
        np.testing.assert_array_equal(array, was)
