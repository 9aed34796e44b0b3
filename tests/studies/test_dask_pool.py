"""The same study on a local Dask cluster of two workers, one of which is killed."""

import gc
import json
import os
import signal
import subprocess
import sys
from collections import Counter

import pytest

from dqpaint.errors import DqpaintError, UsageError
from dqpaint.settings.model import make_settings
from dqpaint.studies.experiment.axes import parse_axis
from dqpaint.studies.kinds import StudyRequest, compare
from dqpaint.studies.runner import dask_pool
from dqpaint.studies.runner.journal import NAME
from dqpaint.studies.runner.run import Run
from tests.support.processes import start, wait_for_lines

pytest.importorskip("distributed", reason="the extra dqpaint[cluster] is not installed")
pytestmark = pytest.mark.slow

LINE = "period 5 ms\nspeed 20 mm/s\nstart at (0, 0) mm\nline to (60, 20) mm\n"
POINTS = 8
SWEEP = ("sweep", "line.traj", "--controller", "p", "--plant", "ideal",
         "--vary", f"k=2..300:log:{POINTS}")  # fmt: skip
CLUSTER = """
import sys
from distributed import LocalCluster

if __name__ == "__main__":
    here = LocalCluster(n_workers=int(sys.argv[1]), threads_per_worker=2, dashboard_address=None)
    print(here.scheduler_address, *(worker.pid for worker in here.workers.values()), flush=True)
    sys.stdin.read()
    here.close()
"""


def served(workers):
    """The address of a cluster, and the processes of its workers; ends when it is closed."""
    process = subprocess.Popen(
        [sys.executable, "-c", CLUSTER, str(workers)], text=True,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    with process:
        address, *pids = process.stdout.readline().split()
        yield address, [int(pid) for pid in pids]
        process.stdin.close()
        process.wait(timeout=60)


two_workers = pytest.fixture(scope="module")(lambda: (yield from served(2)))
no_workers = pytest.fixture(lambda: (yield from served(0)))


def tables(folder):
    return [(folder / f"line-k{end}").read_bytes() for end in ("-table.csv", "-table.md", ".png")]


def test_a_killed_worker_loses_no_run_and_repeats_none(tmp_path, two_workers):
    address, pids = two_workers
    (tmp_path / "line.traj").write_text(LINE)
    sweep = start(tmp_path, *SWEEP, "--out", "far", "--cluster", address)
    wait_for_lines(tmp_path / "far" / NAME, 1)
    os.kill(pids[0], signal.SIGKILL)
    out, err = sweep.communicate(timeout=100)
    assert sweep.returncode == 0, err
    lines = (tmp_path / "far" / NAME).read_text().splitlines()
    keys = Counter(json.loads(line)["key"] for line in lines)
    assert len(keys) == POINTS
    assert set(keys.values()) == {1}
    here = start(tmp_path, *SWEEP, "--out", "near", "--jobs", "1")
    assert here.communicate(timeout=100)[0].replace("near/", "far/") == out
    assert tables(tmp_path / "far") == tables(tmp_path / "near")


def test_what_is_kept_comes_back(tmp_path, two_workers):
    (tmp_path / "line.traj").write_text(LINE)
    (tmp_path / "far.py").write_text("def far(seen, k=1.0):\n    return [1.0]\n")
    noise = {"twist": {"form": "noise", "x": 0.02, "frequency": 5.0}}  # such go as batches
    base = make_settings(plant="ideal", width=160, height=90, disturb=noise)
    axes = [parse_axis(f"controller=p,pff,{tmp_path / 'far.py'}")]
    there, here = (
        compare.compare(
            StudyRequest("compare", str(tmp_path / "line.traj"), {}, tmp_path / f"s{i}", jobs),
            axes,
            base,
            3,
        )
        for i, jobs in enumerate((two_workers[0], 1))
    )
    assert [cell.status for cell in there.cells] == ["done", "done", "failed"]
    for one, other in zip(there.save(),
                          here.save(), strict=True):  # fmt: skip
        assert one.read_bytes() == other.read_bytes()


def test_workers_that_are_not_alike_are_refused(tmp_path, two_workers, monkeypatch):
    ours = {"numpy": "0.1", "pin": "1"}
    monkeypatch.setattr(dask_pool, "code_versions", lambda: ours)
    with pytest.raises(DqpaintError, match=r"the worker tcp.* has numpy \d.*, here is 0.1"):
        dask_pool.Cluster(tmp_path, two_workers[0])


def test_files_that_are_not_alike_are_refused(tmp_path):
    (tmp_path / "law.py").write_text("def law(seen, k=1.0):\n    return seen.twist_d\n")
    settings = make_settings(
        controller=str(tmp_path / "law.py"), plant="ideal", width=16, height=16
    )
    run = Run("line.traj", LINE, settings)
    key = run.key
    ((given, kept),) = dask_pool.carry_out_at_worker([(key, run.data)])
    assert (given["status"], kept) == ("done", None)
    (tmp_path / "law.py").write_text("def law(seen, k=2.0):\n    return seen.twist_d\n")
    with pytest.raises(DqpaintError, match=r"files of line[.]traj"):
        dask_pool.carry_out_at_worker([(key, run.data)])
    (tmp_path / "law.py").unlink()
    with pytest.raises(DqpaintError, match=r"on a worker of the cluster: .*law\.py"):
        dask_pool.carry_out_at_worker([(key, run.data)])


def test_a_cluster_without_workers_is_told(tmp_path, no_workers, monkeypatch):
    monkeypatch.setattr(dask_pool, "ANSWER_TIMEOUT", 1.0)
    with pytest.raises(DqpaintError, match="no workers"):
        dask_pool.Cluster(tmp_path, no_workers[0])


def test_addresses_where_nobody_answers_are_told(tmp_path, monkeypatch):
    monkeypatch.setattr(dask_pool, "ANSWER_TIMEOUT", 0.5)
    with pytest.raises(DqpaintError, match=r"'tcp://127\.0\.0\.1:9'"):
        dask_pool.Cluster(tmp_path, "tcp://127.0.0.1:9")
    for address in ("nonsense", "foo://bar:9", "", "tcp://", "tcp://a b:1"):
        with pytest.raises(UsageError, match="no address"):
            dask_pool.Cluster(tmp_path, address)


def test_a_missing_extra_is_told(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(DqpaintError, match=r"pip install 'dqpaint\[cluster\]'"):
        dask_pool.Cluster(tmp_path, "tcp://127.0.0.1:9")


def test_a_client_that_failed_is_gone_before_the_next_one_starts(tmp_path, monkeypatch):
    from distributed import Client

    monkeypatch.setattr(dask_pool, "ANSWER_TIMEOUT", 1.0)
    gc.collect()
    before = sum(isinstance(one, Client) for one in gc.get_objects())
    gc.disable()
    try:
        with pytest.raises(DqpaintError):
            dask_pool.Cluster(tmp_path, "tls://127.0.0.1:9")
        assert sum(isinstance(one, Client) for one in gc.get_objects()) == before
    finally:
        gc.enable()
