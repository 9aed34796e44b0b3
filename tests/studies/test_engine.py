"""Studies in processes: stopped and gone on, the same whatever the workers, no run lost by one."""

import json
import os
import signal
import sys
from collections import Counter

import pytest

import dqpaint
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.settings.model import make_settings
from dqpaint.studies.runner import process_pool, worker
from dqpaint.studies.runner.engine import carry_out_study
from dqpaint.studies.runner.journal import HEAD, NAME
from dqpaint.studies.runner.reporter import Callback
from dqpaint.studies.runner.run import (
    Run,
    drawing_text,
    run_from_data,
    seeded,
)
from dqpaint.studies.runner.run_arrays import arrays_path, read_arrays
from tests.support.processes import start, wait_for_lines, wait_for_the_end

pytestmark = pytest.mark.slow
LINE = "period 10 ms\nspeed 60 mm/s\nstart at (0, 0) mm\nline to (40, 20) mm\n"
GAINS = (5.0, 20.0, 400.0)


def run(k=20.0, text=LINE, **choices):
    usual = {"controller": "p", "gains": {"k": k}, "plant": "ideal", "width": 16, "height": 16}
    return Run("line.traj", text, make_settings(**{**usual, **choices}))


def facts(results):
    """All of results but the time they took."""
    return [{k: v for k, v in vars(result).items() if k != "wall"} for result in results]


def test_results_are_those_of_draw_whatever_the_number_of_workers(tmp_path):
    runs = [run(k) for k in GAINS]
    one, two = (carry_out_study(runs, tmp_path / str(n), n) for n in (1, 2))
    assert facts(one) == facts(two)
    (tmp_path / "line.traj").write_text(LINE)
    for k, result in zip(GAINS, one, strict=True):
        drawn = dqpaint.draw(
            tmp_path / "line.traj", controller="p", gains={"k": k}, plant="ideal", size=(16, 16)
        )
        assert result.figures == drawn.metrics.figures  # bit for bit
    assert [result.status for result in one] == ["done", "done", "oscillates"]


class Listener(Callback):
    """A reporter that keeps what it is told."""

    def __init__(self):
        self.heard = []
        super().__init__(lambda done: self.heard.append(done))

    def begin(self, title):
        self.heard.append(title)

    def note(self, text, aside=False):
        self.heard.append(text)

    def end(self):
        self.heard.append("end")


def test_what_was_done_is_not_done_again(tmp_path, capfd):
    carry_out_study([run(5.0), run(10.0)], tmp_path, 1)
    assert capfd.readouterr() == ("", "")  # nobody has asked to be told
    before = (tmp_path / NAME).read_bytes()
    listener = Listener()
    more = carry_out_study([run(10.0), run(20.0), run(10.0)], tmp_path, 1, "study", listener)
    assert more[0] == more[2]
    assert (tmp_path / NAME).read_bytes().startswith(before)
    assert (tmp_path / NAME).read_text().count("\n") == 3
    first, known, *parts, end, took = listener.heard
    assert (first, known, end) == ("study, 3 runs", "1 of 2 runs were done before", "end")
    assert took.startswith("1 runs took ")
    assert parts == sorted(parts)
    assert 0 < parts[-1] <= 1


def test_one_failed_run_does_not_lose_the_rest(tmp_path, monkeypatch):
    far = run(text=LINE.replace("(40, 20)", "(4000, 20)").replace("60 mm/s", "4 m/s"))
    (tmp_path / "law.py").write_text(
        "import os, signal\n"
        "def fine(seen, k=1.0):\n    return seen.twist_d\n"
        "def wrong(seen, k=1.0):\n    return [1.0]\n"
        "def killed(seen, k=1.0):\n    os.kill(os.getpid(), signal.SIGKILL)\n"
        "def once(seen, k=1.0):\n"
        f"    if not os.path.exists({str(tmp_path / 'mark')!r}):\n"
        f"        open({str(tmp_path / 'mark')!r}, 'w').close()\n"
        "        os.kill(os.getpid(), signal.SIGKILL)\n"
        "    return seen.twist_d\n"
        "def loud(seen, k=1.0):\n    print('text among the answers')\n    return seen.twist_d\n"
    )
    own = [run(1.0, controller=f"{tmp_path}/law.py:{name}") for name in
           ("fine", "wrong", "killed", "loud", "once")]  # fmt: skip
    results = carry_out_study([far, *own, run(5.0)], tmp_path / "study", 2)
    assert [r.status for r in results] == ["failed", "done", "failed", "died"] + ["done"] * 3
    assert "outside the reach" in results[0].message
    assert "returned an array of shape (1,)" in results[2].message
    assert "its process ended with signal 9" in results[3].message
    monkeypatch.setattr(process_pool, "TRIES", 1)
    again = carry_out_study([far, *own], tmp_path / "study", 1)
    lines = (tmp_path / "study" / NAME).read_text().splitlines()
    tries = Counter(json.loads(line)["key"] for line in lines)
    assert [tries[r.key] for r in again] == [1, 1, 1, 2, 1, 1]  # what died is tried again


def test_choices_are_checked_before_anything_runs(tmp_path):
    with pytest.raises(UsageError, match="no controller named 'q'"):
        carry_out_study([run(), run(controller="q")], tmp_path / "s", 1)
    with pytest.raises(UsageError, match="no gain named 'g'"):
        carry_out_study([run(gains={"g": 1.0})], tmp_path / "s", 1)
    with pytest.raises(UsageError, match="0 jobs"):
        carry_out_study([run()], tmp_path / "s", 0)
    (tmp_path / "arm.toml").write_text(
        '[urdf]\npackage = "no-such-package"\nfile = "arm.urdf"\nlink = "hand"\n'
        "[limits]\nlower_deg = [-9, -9, -9, -9, -9, -9]\nupper_deg = [9, 9, 9, 9, 9, 9]\n"
        "speed_deg_s = [9, 9, 9, 9, 9, 9]\neffort_Nm = [9, 9, 9, 9, 9, 9]\n"
    )
    with pytest.raises(UsageError, match="pip install no-such-package"):
        carry_out_study([run(robot=str(tmp_path / "arm.toml"))], tmp_path / "s", 1)
    assert not (tmp_path / "s").exists()
    with pytest.raises(UsageError, match="random"):
        seeded(run(), 3)
    with pytest.raises(UsageError, match="at least 1"):
        seeded(run(), 0)


def test_workers_that_do_not_start_are_told(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with pytest.raises(DqpaintError, match="worker"):
        carry_out_study([run()], tmp_path, 2)


def test_keys_change_with_what_decides_a_result(tmp_path):
    law = tmp_path / "law.py"
    law.write_text("def law(seen, k=1.0):\n    return seen.twist_d\n")
    first = run(1.0, controller=str(law)).key
    assert run(1.0, controller=str(law)).key == first
    others = [run(2.0, controller=str(law)), run(1.0, LINE + "\n", controller=str(law)),
              run(1.0, controller=str(law), seed=1)]  # fmt: skip
    assert first not in [other.key for other in others]
    law.write_text("def law(seen, k=1.0):\n    return 2 * seen.twist_d\n")
    assert run(1.0, controller=str(law)).key != first


def test_keys_change_with_the_files_a_drawing_and_a_brush_name(tmp_path):
    drawing, included = tmp_path / "a.traj", tmp_path / "b.traj"
    points, image = tmp_path / "points.csv", tmp_path / "image.png"
    drawing.write_text('period 10 ms\ninclude "b.traj"\n')
    included.write_text('path "points.csv" unit mm in 1 s\n')
    points.write_text("x,y\n0,0\n1,2\n3,1\n")
    image.write_bytes(b"one")

    def key():
        brush = f"pixelstick:length=50mm,image={image}"
        return Run(*drawing_text(str(drawing)), run(brush=brush).settings).key

    found = [key()]
    assert key() == found[0]
    for path, text in ((points, "x,y\n0,0\n1,2\n3,2\n"), (image, "two"),
                       (included, 'path "points.csv" unit mm in 2 s\n')):  # fmt: skip
        path.write_text(text)
        found.append(key())
    assert len(set(found)) == 4


def test_runs_are_read_back_as_they_were():
    one = run(gains={"k": "5..20@10%"}, seed=3)
    assert run_from_data(json.loads(json.dumps(one.data))) == one


def test_what_is_kept_is_there_or_is_made_again(tmp_path):
    one = Run("line.traj", LINE, run().settings, ("series", "light"))
    result = carry_out_study([one], tmp_path, 1)[0]
    arrays = read_arrays(tmp_path, result.key)
    assert arrays["light"].shape == (16, 16, 3)
    assert len(arrays["t_s"]) == len(arrays["position_error_m"]) > 50
    assert arrays["position_error_m"].max() == result.figures["position_error_max_m"]
    path = arrays_path(tmp_path, result.key)
    whole = path.read_bytes()
    for cut in (0, 1, 200, len(whole) // 2, len(whole) - 1):
        path.write_bytes(whole[:cut])
        with pytest.raises(DqpaintError, match=f"{result.key[:24]}.npz' cannot be read"):
            read_arrays(tmp_path, result.key)
    path.unlink()
    carry_out_study([one], tmp_path, 1)
    assert arrays_path(tmp_path, result.key).is_file()


# A sweep from the command line, killed and interrupted.

SLOW = "period 5 ms\nspeed 20 mm/s\nstart at (0, 0) mm\nline to (60, 20) mm\n"
POINTS = 7
SWEEP = ("sweep", "line.traj", "--controller", "held.py", "--plant", "ideal",
         "--vary", f"k=2..300:log:{POINTS}", "--jobs", "2")  # fmt: skip
HELD = """import os, time
from dqpaint import dq


def held(seen, k=20.0):
    if k > 2 and not os.path.exists("go"):  # all but the first run take seconds
        time.sleep(0.01)
    error = dq.mul(seen.pose_d, dq.conj(dq.nearest(seen.pose, seen.pose_d)))
    return seen.twist_d + 2 * k * dq.log(error)
"""


def laid_down(folder):
    (folder / "line.traj").write_text(SLOW)
    (folder / "held.py").write_text(HELD)


def tables(folder):
    return [(folder / f"line-k{end}").read_bytes() for end in ("-table.csv", "-table.md", ".png")]


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The tables of the sweep, done at once."""
    folder = tmp_path_factory.mktemp("whole")
    laid_down(folder)
    (folder / "go").touch()
    assert start(folder, *SWEEP, "--out", "study").communicate(timeout=100)[1] == ""
    return tables(folder / "study")


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_a_sweep_that_was_stopped_goes_on(tmp_path, how, whole):
    laid_down(tmp_path)
    sweep = start(tmp_path, *SWEEP, "--out", "study")
    record = tmp_path / "study" / NAME
    wait_for_lines(record, 1)
    # Ctrl-C in a terminal reaches every process of the group, a kill the one it is meant for
    (os.killpg if how == signal.SIGINT else os.kill)(sweep.pid, how)
    said = sweep.communicate(timeout=30)[1]
    assert sweep.returncode == (130 if how == signal.SIGINT else -how)
    if how == signal.SIGINT:
        assert "the same command goes on from there" in said
        assert "Traceback" not in said
    wait_for_the_end(sweep.pid)  # workers end with their study
    before = record.read_bytes()
    assert 1 <= before.count(b"\n") < POINTS
    assert not (tmp_path / "study" / "line-k.png").exists()

    (tmp_path / "go").touch()
    record.write_bytes(before + HEAD + b"cut o")  # as a failing disk would leave it
    again = start(tmp_path, *SWEEP, "--out", "study")
    count = before.count(b"\n")
    said = again.communicate(timeout=100)[1]
    assert f"{count} of {POINTS} runs were done before" in said
    assert "cut off" in said
    assert again.returncode == 0
    after = record.read_bytes()
    assert after.startswith(before)
    keys = Counter(json.loads(line)["key"] for line in after.splitlines())
    assert len(keys) == POINTS
    assert set(keys.values()) == {1}
    assert tables(tmp_path / "study") == whole


def test_runs_that_would_all_be_the_same_are_refused():
    for constant in ({}, {"payload": {"mass": 1.0}}, {"twist": {"form": "sine", "x": 0.01}}):
        with pytest.raises(UsageError, match="random"):
            seeded(run(disturb=constant), 3)
    assert len(seeded(run(disturb={"noise": {"rms": 1e-4}}), 3)) == 3


@pytest.mark.parametrize(("fault", "no_memory"), [
    (MemoryError(), True), (ImportError("a.so: failed to map segment from shared object"), True),
    (ImportError("no module named a"), False), (ValueError("failed to map segment"), False),
])  # fmt: skip
def test_no_memory_is_told_as_such_and_is_of_the_machine(tmp_path, monkeypatch, fault, no_memory):
    def broken(*_):
        raise fault

    monkeypatch.setattr(worker.paint, "paint", broken)
    run = Run("a.traj", "line to (1, 0) mm", make_settings(controller="p"))
    done = worker.carry_out(run, "key", tmp_path)
    assert (done.status, "memory" in done.message) == (
        ("died", True) if no_memory else ("failed", False)
    )
