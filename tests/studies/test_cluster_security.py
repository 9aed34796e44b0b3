"""Who reaches a Dask cluster: the commands of SECURITY.md, run here; TLS lets in who has a key."""

import re
import shutil
import socket
import subprocess
import sys
import time
from contextlib import ExitStack
from pathlib import Path

import pytest

from dqpaint.errors import DqpaintError
from dqpaint.settings import make_settings
from dqpaint.studies.runner import dask_pool
from dqpaint.studies.runner.engine import carry_out_study
from dqpaint.studies.runner.run import Run

pytest.importorskip("distributed", reason="the extra dqpaint[cluster] is not installed")
psutil = pytest.importorskip("psutil")

PAGE = (Path(__file__).parents[2] / "SECURITY.md").read_text("utf-8")
OPEN, SECURE = re.findall(r"^```sh\n(dask .*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
LINE = "period 10 ms\nspeed 60 mm/s\nstart at (0, 0) mm\nline to (40, 20) mm\n"
KEYS = "DASK_DISTRIBUTED__COMM__TLS__"


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def cluster(block, folder):
    """The scheduler and the worker of a block, on this machine, at a free port; its address."""
    port = free_port()
    lines = [line.replace("10.0.0.1", "127.0.0.1").replace(":8786", f":{port}")
             for line in block.splitlines()]  # fmt: skip
    scheduler, worker = (line.split()[1:] for line in lines[:2])
    processes = []
    with ExitStack() as opened:
        for words in ([*scheduler, "--port", str(port)], worker):
            process = subprocess.Popen(
                [sys.executable, "-m", "dask", *words], cwd=folder,
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            )  # fmt: skip
            opened.enter_context(process)
            opened.callback(end, process)
            processes.append(process)
            until = time.monotonic() + 60
            while not listening(process):
                assert time.monotonic() < until
                time.sleep(0.1)
        yield re.search(r"\w+://127\.0\.0\.1:\d+", " ".join(worker))[0], processes


def end(process):
    """End a process and its children at once."""
    for one in psutil.Process(process.pid).children(recursive=True):
        one.kill()
    process.kill()


def listening(process):
    """The addresses at which a process and its children can be reached."""
    whole = psutil.Process(process.pid)
    return [
        connection.laddr.ip
        for one in (whole, *whole.children(recursive=True))
        for connection in one.net_connections("inet")
        if connection.status == psutil.CONN_LISTEN
    ]


@pytest.fixture
def plain(tmp_path):
    yield from cluster(OPEN, tmp_path)


@pytest.fixture
def secure(tmp_path):
    if shutil.which("openssl") is None:
        pytest.skip("no openssl makes certificates here")
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-keyout",
         "key.pem", "-out", "cert.pem", "-subj", "/CN=here",
         "-addext", "subjectAltName=IP:127.0.0.1"],
        cwd=tmp_path, check=True, capture_output=True,
    )  # fmt: skip
    shutil.copy(tmp_path / "cert.pem", tmp_path / "ca.pem")
    yield from cluster(SECURE, tmp_path)


def run():
    return Run("line.traj", LINE, make_settings(controller="p", plant="ideal", width=16, height=16))


@pytest.mark.slow
def test_a_cluster_for_one_machine_is_reached_from_there_alone(plain, tmp_path):
    address, processes = plain
    (done,) = carry_out_study([run()], tmp_path / "far", address)
    (here,) = carry_out_study([run()], tmp_path / "near", 1)
    assert (done.status, done.figures) == ("done", here.figures)
    found = [ip for process in processes for ip in listening(process)]
    assert len(found) > 3
    assert set(found) == {"127.0.0.1"}


@pytest.mark.slow
def test_a_cluster_with_tls_lets_in_who_has_a_certificate(secure, tmp_path, monkeypatch):
    from dask import config

    address, processes = secure
    assert address.startswith("tls://")
    assert {ip for process in processes for ip in listening(process)} == {"127.0.0.1"}
    monkeypatch.setattr(dask_pool, "ANSWER_TIMEOUT", 3.0)
    with pytest.raises(DqpaintError, match=KEYS + "CA_FILE"):
        dask_pool.Cluster(tmp_path, address)
    with pytest.raises(DqpaintError, match="no Dask scheduler"):
        dask_pool.Cluster(tmp_path, address.replace("tls:", "tcp:"))
    monkeypatch.setattr(dask_pool, "ANSWER_TIMEOUT", 30.0)
    names = re.findall(rf"^export ({KEYS}\w+)=(\w+\.pem)$", SECURE, re.MULTILINE)
    assert len(names) == 3
    said = {  # as Dask reads its environment when it starts
        name.removeprefix("DASK_").lower().replace("__", ".").replace("_", "-"): tmp_path / file
        for name, file in names
    }
    with config.set({name: str(path) for name, path in said.items()}):
        (done,) = carry_out_study([run()], tmp_path / "far", address)
    assert done.status == "done"


@pytest.mark.parametrize(
    ("address", "open_to_others"),
    [
        ("tcp://10.0.0.1:8786", True), ("10.0.0.1:8786", True), ("ws://host:8786", True),
        ("tcp://127.0.0.1.example:8786", True), ("tls://10.0.0.1:8786", False),
        ("wss://host:8786", False), ("tcp://127.0.0.1:8786", False), ("localhost:8786", False),
        ("tcp://[::1]:8786", False),
    ],
)  # fmt: skip
def test_a_cluster_that_others_reach_is_told(address, open_to_others):
    assert bool(dask_pool.warnings_of(address)) == open_to_others


def test_what_is_advised_is_what_the_page_has():
    for line in OPEN.splitlines():
        assert line in dask_pool.START
