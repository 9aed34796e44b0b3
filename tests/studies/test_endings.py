"""Studies that are ended, and runs that do not end by themselves: no process is left."""

import json
import os
import signal
import sys
import time

import pytest

from dqpaint.settings import make_settings
from dqpaint.studies.runner import worker
from dqpaint.studies.runner.batches import goes_in_batches
from dqpaint.studies.runner.engine import carry_out_study
from dqpaint.studies.runner.journal import NAME
from dqpaint.studies.runner.run import Run, seeded
from tests.support.processes import start, wait_for_the_end

pytestmark = pytest.mark.slow
LINE = "period 10 ms\nspeed 60 mm/s\nstart at (0, 0) mm\nline to (40, 20) mm\n"
LAWS = """
import os, signal, time

def fine(seen, k=1.0):
    return seen.twist_d

def sleeps(seen, k=1.0):
    time.sleep(1000)
    return seen.twist_d

def deaf(seen, k=1.0):
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGALRM, signal.SIGTERM, signal.SIGHUP})
    open(os.environ.get("MARK", os.devnull), "a").write("x\\n")
    time.sleep(1000)

def gone(seen, k=1.0):
    os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.fixture
def law(tmp_path):
    (tmp_path / "laws.py").write_text(LAWS)
    (tmp_path / "line.traj").write_text(LINE)
    return lambda name: f"{tmp_path / 'laws.py'}:{name}"


def run(controller, timeout=1.0, **more):
    settings = make_settings(
        controller=controller, plant="ideal", width=16, height=16, timeout=timeout, **more
    )
    return Run("line.traj", LINE, settings)


def test_laws_that_sleep_hang_or_vanish_are_named_and_the_others_go_on(tmp_path, law):
    runs = [run(law(name)) for name in ("sleeps", "deaf", "gone", "fine")]
    results = carry_out_study(runs, tmp_path / "s", 2)
    assert [result.status for result in results] == ["died", "died", "died", "done"]
    assert results[0].message.startswith("laws.py:8: the run has not ended after 1 s")
    assert "not when it was told to: laws.py:14;" in results[1].message
    assert results[2].message == "its process ended with signal 9 while the law of laws.py ran"
    before = (tmp_path / "s" / NAME).read_text().count("\n")
    patient = run(law("fine"), timeout=50.0)
    assert patient.key == runs[3].key  # how long one waits does not decide what comes
    carry_out_study([patient], tmp_path / "s", 1)
    assert (tmp_path / "s" / NAME).read_text().count("\n") == before


def test_a_batch_has_the_time_of_its_runs(tmp_path, monkeypatch):
    noise = {"twist": {"form": "noise", "x": 0.02, "frequency": 5.0}}
    runs = seeded(run("p", timeout=1e-3, disturb=noise), 3)
    assert goes_in_batches(runs[0])
    monkeypatch.setattr(worker, "carry_out_batch", lambda *_: time.sleep(1000))
    results = list(worker.carry_out_all([(one.key, one) for one in runs], tmp_path))
    assert [result.status for result in results] == ["died"] * 3
    assert "after 0.003 s" in results[0].message


@pytest.mark.skipif(sys.platform == "win32", reason="it has no such signals")
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGINT", "SIGKILL"])
def test_no_worker_outlives_its_study_whatever_its_law_does(tmp_path, law, name, monkeypatch):
    mark = tmp_path / "mark"
    monkeypatch.setenv("MARK", str(mark))
    sweep = start(tmp_path, "sweep", "line.traj", "--controller", law("deaf"), "--plant", "ideal",
                  "--vary", "k=1,2", "--jobs", "2", "--out", "s")  # fmt: skip
    until = time.monotonic() + 60
    while not (mark.is_file() and mark.read_text().count("\n") == 2):
        assert time.monotonic() < until
        time.sleep(0.05)
    os.kill(sweep.pid, getattr(signal, name))
    err = sweep.communicate(timeout=60)[1]
    wait_for_the_end(sweep.pid)
    if name == "SIGKILL":
        assert sweep.returncode == -signal.SIGKILL
    else:
        assert sweep.returncode == 130, err
        assert "the same command goes on from there" in err
        assert err.endswith("interrupted\n")


def test_a_worker_ends_with_its_input_even_while_a_law_sleeps(tmp_path, law, monkeypatch):
    """What holds where a parent's death is no signal."""
    import subprocess

    mark = tmp_path / "mark"
    monkeypatch.setenv("MARK", str(mark))
    process = subprocess.Popen(
        [sys.executable, "-m", "dqpaint.studies.runner.worker"], text=True,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    one = run(law("deaf"), timeout=100.0)
    tasks = [{"key": one.key, "run": one.data}]
    process.stdin.write(json.dumps({"tasks": tasks, "folder": str(tmp_path)}) + "\n")
    process.stdin.flush()
    until = time.monotonic() + 60
    while not mark.is_file():
        assert time.monotonic() < until
        time.sleep(0.05)
    process.stdin.close()
    assert process.wait(timeout=20) == 1
    process.stdout.close()
