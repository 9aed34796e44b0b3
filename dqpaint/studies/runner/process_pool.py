"""Runs -> results, carried out by worker processes, in the order in which they are done."""

import json
import os
import queue
import re
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from dqpaint.core import split_spec
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.studies.runner.batches import Task, groups
from dqpaint.studies.runner.run import Result, Run

ONE_THREAD = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
TRIES = 2  # at a run whose process ended
MOST_JOBS = 1024
POLL_INTERVAL = 0.2  # [s] after which a Ctrl-C is noticed at the latest
OUT_OF_TIME = "Timeout ("  # what faulthandler writes where the worker's last resort ends it


def all_cores() -> int:
    """The cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def check_jobs(jobs: int | None) -> int:
    """The number of workers, all cores by default.

    Raises:
        UsageError: it is none.
    """
    if jobs is not None and not 1 <= jobs <= MOST_JOBS:
        raise UsageError(f"{jobs} jobs; a study has 1 to {MOST_JOBS} workers")
    return jobs or all_cores()


class Pool:
    """Worker processes that live as long as a study; the first begin with its first runs.

    Args:
        folder: the study's, for arrays that are kept.
        jobs: how many processes at most.
    """

    def __init__(self, folder: Path, jobs: int) -> None:
        self._folder, self._jobs = folder, jobs
        self._todo: queue.SimpleQueue[list[Task] | None] = queue.SimpleQueue()
        self._said: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._workers: list[_Worker] = []
        self.notes: tuple[str, ...] = ()

    def carry_out(
        self, tasks: Sequence[Task], progress: Callable[[float], None]
    ) -> Iterator[Result]:
        """The results of runs, each as soon as it is there.

        Args:
            tasks: runs with their keys.
            progress: called with how many are done; one under way counts as a part.

        Raises:
            DqpaintError: the processes do not start.
        """
        together = groups(tasks)
        for group in together:
            self._todo.put(group)
        while len(self._workers) < min(self._jobs, len(together)):
            self._workers.append(_Worker(self._todo, self._said, self._folder))
        parts: dict[_Worker, float] = {}
        done = 0
        while done < len(tasks):
            try:
                worker, what = self._said.get(timeout=POLL_INTERVAL)
            except queue.Empty:
                continue
            if isinstance(what, DqpaintError):
                raise what
            parts[worker] = what if isinstance(what, float) else 0.0
            if isinstance(what, Result):
                done += 1
                yield what
            progress(done + sum(parts.values()))

    def close(self) -> None:
        """End all processes at once."""
        for _ in self._workers:
            self._todo.put(None)
        for worker in self._workers:
            worker.end()


class _Stopped(Exception):  # noqa: N818  no fault: the study ended while a process was to begin
    pass


class _Worker(threading.Thread):
    """One process and the thread that talks to it; another takes its place where it dies."""

    def __init__(self, todo: queue.SimpleQueue[list[Task] | None], said: Any, folder: Path) -> None:
        super().__init__(daemon=True)
        self._todo, self._said, self._folder = todo, said, folder
        self._over = False
        self._process: subprocess.Popen[str] | None = None
        self._lock = threading.Lock()
        self.start()

    def end(self) -> None:
        """Stop at once."""
        with self._lock:
            self._over = True
            if self._process is not None:
                self._process.kill()
        self.join()

    def run(self) -> None:
        """Carry out runs until there are to be no more."""
        with tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as remarks:
            try:
                while (group := self._todo.get()) is not None and not self._over:
                    for result in self._results(group, remarks):
                        self._say(result)
            except _Stopped:
                pass
            except Exception as problem:  # told where it is heard: a silent end would be a hang
                self._say(DqpaintError(f"a worker of the study failed: {problem}"))
            finally:
                self._close()

    def _say(self, what: object) -> None:
        if not self._over:
            self._said.put((self, what))

    def _results(self, group: list[Task], remarks: Any) -> Iterator[Result]:
        """Of runs that go together, each as soon as it is there."""
        left = dict(group)
        for _ in range(TRIES):
            process = self._process or self._begin(remarks)
            tasks = [{"key": key, "run": run.data} for key, run in left.items()]
            try:
                assert process.stdin is not None
                task = json.dumps({"tasks": tasks, "folder": str(self._folder.resolve())})
                process.stdin.write(task + "\n")
                process.stdin.flush()
                for said in self._answers(process):
                    if "result" in said:
                        result = Result(**said["result"])
                        del left[result.key]
                        yield result
                        if not left:
                            return
                    else:
                        self._say(float(said.get("part", 0.0)))
            except BrokenPipeError:
                pass
            if self._over:
                break
            code = process.wait()
            self._close()
            if any(line.startswith(OUT_OF_TIME) for line in _lines(remarks)):
                break  # a second try would take as long
        for key, run in left.items():
            yield Result(key, "died", _how_it_died(code, _lines(remarks), run))

    def _begin(self, remarks: Any) -> "subprocess.Popen[str]":
        with self._lock:
            if self._over:
                raise _Stopped
            remarks.seek(0)
            remarks.truncate()
            self._process = process = subprocess.Popen(
                [sys.executable, "-m", "dqpaint.studies.runner.worker"],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=remarks, text=True,
                encoding="utf-8", env=_environment(),
            )  # fmt: skip
        if not any(said.get("ready") for said in self._answers(process)) and not self._over:
            lines = _lines(remarks)
            raise DqpaintError(lines[-1] if lines else f"it ended with {_code(process.wait())}")
        return process

    @staticmethod
    def _answers(process: "subprocess.Popen[str]") -> Iterator[dict[str, Any]]:
        assert process.stdout is not None
        while (line := process.stdout.readline()).endswith("\n"):  # else it died while it wrote
            yield json.loads(line)

    def _close(self) -> None:
        with self._lock:
            process, self._process = self._process, None
        if process is None:
            return
        process.kill()
        process.wait()
        for stream in (process.stdin, process.stdout):
            if stream is not None:
                with suppress(OSError):
                    stream.close()


def _environment() -> dict[str, str]:
    """Variables of a worker: it finds this package, and leaves the other cores to its like."""
    here = str(Path(__file__).parent.parent.parent.parent)
    paths = os.pathsep.join(filter(None, [here, os.environ.get("PYTHONPATH")]))
    return {**os.environ, **dict.fromkeys(ONE_THREAD, "1"), "PYTHONPATH": paths}


def _lines(remarks: Any) -> list[str]:
    """What a worker wrote to standard error."""
    remarks.seek(0)
    return [line.strip() for line in remarks if line.strip()]


def _code(code: int) -> str:
    return f"{'signal' if code < 0 else 'code'} {abs(code)}"


def _how_it_died(code: int, lines: Sequence[str], run: Run) -> str:
    """Why a run has no result, in words; with the law's file, which may be why.

    Args:
        code: with which the process ended.
        lines: that it wrote to standard error.
        run: that was under way.
    """
    own = split_spec(run.settings.controller)
    if any(line.startswith(OUT_OF_TIME) for line in lines):
        frames = [re.match(r'File "(.*)", line (\d+)', line) for line in lines]
        of_law = (frame for frame in frames if frame and own and frame[1] == str(own[0]))
        frame = next(of_law, None)
        place = f"{Path(frame[1]).name}:{frame[2]}" if frame else "in a library"
        return (
            f"the run has not ended after {run.settings.timeout:g} s, and not when it was told to: "
            f"{place}; --timeout gives it more"
        )
    law = f" while the law of {own[0].name} ran" if own else ""
    said = f": {lines[-1]}" if lines else ""
    return f"its process ended with {_code(code)}{law}{said}"
