"""Runs -> results, carried out by a Dask cluster; the only module that imports distributed.

The workers need the same dqpaint, Python and libraries, and the files a run names (a law or an arm
of one's own, what a drawing includes) where they lie here; drawings travel with their runs, and
what is to be kept comes back. Each worker carries out one run at a time, whatever the number of
its threads, in a process of its own as a study here has them: a law that hangs, dies or is over its
time takes no worker along.

Whoever reaches the ports of a scheduler or a worker runs code there: SECURITY.md has who may, and
how TLS keeps others out.
"""

import atexit
import gc
import hashlib
import logging
import platform
import queue
import re
import shutil
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from dqpaint.errors import DqpaintError, UsageError
from dqpaint.studies.runner.batches import Task, groups
from dqpaint.studies.runner.process_pool import Pool
from dqpaint.studies.runner.run import Result, Run, code_versions, run_from_data
from dqpaint.studies.runner.run_arrays import arrays_path, write_encoded

ANSWER_TIMEOUT = 10.0  # [s] for a scheduler to answer and a first worker to come
NO_WORKER_TIMEOUT = 30.0  # [s] without any worker, after which nothing more is expected
POLL_INTERVAL = 0.2  # [s] after which a Ctrl-C is noticed at the latest
START = (
    "dask scheduler --host 127.0.0.1 --dashboard-address 127.0.0.1:0, and dask worker "
    "tcp://127.0.0.1:8786 --host 127.0.0.1 --dashboard-address 127.0.0.1:0 --nthreads 1, for this "
    "machine alone; over a network only with TLS (SECURITY.md), for who reaches their ports can "
    "run code"
)
TLS = (
    "certificates are those of Dask's settings: DASK_DISTRIBUTED__COMM__TLS__CA_FILE, "
    "..__CLIENT__CERT and ..__CLIENT__KEY"
)
LOOPBACK = re.compile(r"(127\.[\d.]+|localhost|\[::1\]):\d+")
ADDRESS = re.compile(r"((tcp|tls|ws|wss|ucx)://)?[^/\s]+:\d{1,5}")
_one_at_a_time = threading.Lock()


class Cluster:
    """Workers elsewhere, as `pool.Pool` has them here.

    Args:
        folder: the study's, for arrays that are kept.
        address: of the scheduler, as in tls://10.0.0.1:8786.

    Raises:
        UsageError: that is no address.
        DqpaintError: the extra is not installed, nobody answers, or the workers are not alike.
    """

    def __init__(self, folder: Path, address: str) -> None:
        if not ADDRESS.fullmatch(address):
            raise UsageError(
                f"'{address}' is no address of a Dask scheduler, such as tls://10.0.0.1:8786"
            )
        self._folder, self._address = folder, address
        self.notes = warnings_of(address)
        self._client: Any = _connected(address)
        try:
            self._check_workers()
        except BaseException:
            self._client.close()
            raise

    def _check_workers(self) -> None:
        try:
            self._client.wait_for_workers(1, timeout=ANSWER_TIMEOUT)
        except TimeoutError:
            raise DqpaintError(
                f"the cluster at '{self._address}' has no workers; to start one: {START}"
            ) from None
        ours = worker_versions()
        for worker, theirs in self._client.run(worker_versions, on_error="return").items():
            if isinstance(theirs, Exception):
                raise DqpaintError(
                    f"the worker {worker} cannot load this dqpaint: {theirs}; install it there"
                )
            for name, wanted in ours.items():
                if theirs.get(name) != wanted:
                    raise DqpaintError(
                        f"the worker {worker} has {name} {theirs.get(name, 'not at all')}, here is "
                        f"{wanted}: results could differ; install the same there"
                    )

    def carry_out(
        self, tasks: Sequence[Task], progress: Callable[[float], None]
    ) -> Iterator[Result]:
        """The results of runs, each as soon as it is there.

        Args:
            tasks: runs with their keys.
            progress: called with how many are done.

        Raises:
            DqpaintError: the cluster was lost, or a worker's files are not those here.
        """
        done: queue.SimpleQueue[Any] = queue.SimpleQueue()
        submitted: dict[str, list[str]] = {}  # keys of runs, by Dask's own
        for group in groups(tasks):
            keys = [key for key, _ in group]
            given = [(key, run.data) for key, run in group]
            future: Any = self._client.submit(carry_out_at_worker, given, key=_name(keys))
            submitted[future.key] = keys
            future.add_done_callback(done.put)
        since = time.monotonic()
        count = 0
        while count < len(tasks):
            try:
                future = done.get(timeout=POLL_INTERVAL)
            except queue.Empty:
                if self._client.status != "running":
                    raise self._lost("its scheduler is gone") from None
                if self._client.scheduler_info()["workers"]:
                    since = time.monotonic()
                elif time.monotonic() - since > NO_WORKER_TIMEOUT:
                    raise self._lost("it has no workers any more") from None
                continue
            since = time.monotonic()
            for result in self._results(submitted[future.key], future):
                count += 1
                yield result
                progress(count)

    def _results(self, keys: Sequence[str], future: Any) -> list[Result]:
        from distributed import KilledWorker

        if future.status in ("cancelled", "lost"):
            raise self._lost("its scheduler is gone")
        if future.status == "error":
            fault = future.exception()
            if isinstance(fault, KilledWorker):
                return [Result(key, "died", "the workers that tried it ended") for key in keys]
            if isinstance(fault, DqpaintError):
                raise fault
            raise DqpaintError(f"a worker of the cluster failed: {fault!r}")
        results = []
        for given, kept in future.result():
            result = Result(**given)
            if kept is not None:
                write_encoded(self._folder, result.key, kept)
            results.append(result)
        return results

    def _lost(self, why: str) -> DqpaintError:
        return DqpaintError(
            f"the cluster at '{self._address}' is lost: {why}; what was done is kept in "
            f"'{self._folder}', and the same command goes on from there"
        )

    def close(self) -> None:
        """Leave the cluster; it drops what was under way."""
        self._client.close()


def warnings_of(address: str) -> tuple[str, ...]:
    """What a person has to know of an address that others may reach."""
    scheme, _, rest = address.rpartition("://")
    if scheme in ("tls", "wss") or LOOPBACK.fullmatch(rest):
        return ()
    return (
        f"'{address}' has no TLS: who reaches the ports of this cluster can read the runs and run "
        "code on its machines; see SECURITY.md",
    )


def _connected(address: str) -> Any:
    """A client of the scheduler at an address; errors as those of `Cluster`."""
    try:
        from distributed import Client
    except ImportError:
        raise DqpaintError(
            "a study on a cluster needs Dask: pip install 'dqpaint[cluster]'"
        ) from None
    for name in [n for n in logging.root.manager.loggerDict if n.startswith("distributed")]:
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what matters is told by us
    try:
        return Client(address, timeout=ANSWER_TIMEOUT, set_as_default=False)
    except (OSError, ValueError, TypeError) as problem:
        said = str(problem).splitlines()[0] if str(problem) else type(problem).__name__
    # The client that failed stops its thread when it is collected. Were that in the thread of the
    # next client, which starts under the same lock, both would wait for each other.
    gc.collect()
    keys = f"; {TLS}" if address.startswith(("tls://", "wss://")) else ""
    raise DqpaintError(
        f"no Dask scheduler answers at '{address}': {said}{keys}; to start one: {START}"
    )


def worker_versions() -> dict[str, str]:
    """What has to be alike here and there."""
    return {
        "Python": platform.python_version(),
        "distributed": version("distributed"),
        **code_versions(),
    }


def _name(keys: Sequence[str]) -> str:
    """Of runs that go together, for Dask."""
    return f"dqpaint-{hashlib.sha256(' '.join(keys).encode()).hexdigest()}"


def carry_out_at_worker(
    given: Sequence[tuple[str, dict[str, Any]]],
) -> list[tuple[dict[str, Any], bytes | None]]:
    """Runs that go together at a worker, each with its key: results, and files of what is kept.

    Raises:
        DqpaintError: the files that a run names are not the same here.
    """
    tasks = [(key, run_from_data(data)) for key, data in given]
    for key, run in tasks:
        _check_files(key, run)
    with _one_at_a_time:
        scratch, pool = _pool()
        results = list(pool.carry_out(tasks, lambda _done: None))
        return [(vars(result), _taken(arrays_path(scratch, result.key))) for result in results]


@cache
def _pool() -> tuple[Path, Pool]:
    """The process of this worker, which ends with it, and the folder of what it keeps."""
    scratch = tempfile.mkdtemp(prefix="dqpaint-")
    atexit.register(shutil.rmtree, scratch, ignore_errors=True)
    return Path(scratch), Pool(Path(scratch), 1)


def _taken(path: Path) -> bytes | None:
    """The bytes of a file, which goes; None if there is none."""
    if not path.is_file():
        return None
    data = path.read_bytes()
    path.unlink()
    return data


def _check_files(key: str, run: Run) -> None:
    try:
        same = run.key == key
    except DqpaintError as problem:
        raise DqpaintError(f"on a worker of the cluster: {problem}") from None
    if not same:
        names = ", ".join(name for name, value in run.files().items() if value) or "none"
        raise DqpaintError(
            f"on a worker of the cluster the files of {Path(run.name).name} are not those here; "
            f"they have to lie in the same places (there: {names})"
        )
