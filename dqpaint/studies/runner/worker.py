"""A process that carries out runs: lines of JSON in, lines of JSON out, until the input ends.

It is a fresh interpreter, not a fork: a fork of a process whose libraries have threads (OpenBLAS,
OpenCV) can inherit a lock that nobody holds any more, and waits for it for ever. It imports
everything before its first run and lives as long as the study, so the start is paid once a worker,
on the worker's own core.
"""

import ctypes
import faulthandler
import json
import os
import queue
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from dqpaint.errors import DqpaintError, TimeLimitError, UnstableError, is_no_memory
from dqpaint.metrics import limits_text
from dqpaint.painting import paint, time_limit
from dqpaint.studies.runner.batches import Task, carry_out_batch, goes_in_batches
from dqpaint.studies.runner.run import Result, Run, Status, is_of_the_machine, run_from_data
from dqpaint.studies.runner.run_arrays import write_arrays

PROGRESS_INTERVAL = 0.2  # [s]
GRACE = 5.0  # [s] in which a run whose time is over may say where it is
PR_SET_PDEATHSIG = 1  # of Linux's prctl


def carry_out(
    run: Run, key: str, folder: Path, progress: Callable[[float], None] = lambda _done: None
) -> Result:
    """Paint; a fault of the run is its result, never an exception.

    Args:
        run: what to paint.
        key: of the run.
        folder: the study's, for arrays that are kept.
        progress: called while the arm moves, with the part done, 0 to 1.
    """
    begin = time.perf_counter()
    try:
        painting = paint.paint(run.program(), run.settings, progress)
        if run.keep:
            write_arrays(painting, run.keep, folder, key)
    except UnstableError as problem:
        return Result(key, "diverged", str(problem), wall=time.perf_counter() - begin)
    except Exception as fault:  # one broken run must not end the others
        known = isinstance(fault, DqpaintError)
        status: Status = "died" if is_of_the_machine(fault) else "failed"
        said = f"internal error: {fault!r}"
        if known or isinstance(fault, OSError):
            said = str(fault)
        elif is_no_memory(fault):
            said = "there is not enough memory"
        return Result(key, status, said, wall=time.perf_counter() - begin)
    found, figures = painting.judgement, painting.metrics.figures
    limits = limits_text(painting.track)
    wall = time.perf_counter() - begin
    idle = painting.without_effect
    return Result(key, found.status, found.why, figures, limits, idle, wall)


def carry_out_all(
    tasks: Sequence[Task], folder: Path, progress: Callable[[float], None] = lambda _done: None
) -> Iterator[Result]:
    """The results of a run, or of several that may go as one batch.

    Args:
        tasks: with their keys.
        folder: of the study.
        progress: called while arms move, with how many runs are done.
    """
    results = None
    if goes_in_batches(tasks[0][1]):
        limit = len(tasks) * tasks[0][1].settings.timeout
        try:
            with _last_resort(limit), time_limit.limit_time(limit) as check_time:

                def show(part: float) -> None:
                    check_time()
                    progress(part * len(tasks))

                results = carry_out_batch(tasks, folder, show)
        except TimeLimitError as problem:
            results = [Result(key, "died", str(problem)) for key, _ in tasks]
        except Exception:  # what is wrong each run says by itself
            results = None
    if results is not None:
        yield from results
    elif len(tasks) > 1:  # one that cannot be in a batch must not change how the others are done
        for task in tasks:
            yield from carry_out_all([task], folder, progress)
    else:
        ((key, run),) = tasks
        with _last_resort(run.settings.timeout):
            result = carry_out(run, key, folder, progress)
        yield result


@contextmanager
def _last_resort(seconds: float) -> Iterator[None]:
    """A context whose time, when it is over for good, ends this process, whatever hangs in it.

    A thread below Python does it, which needs no lock that others hold; it writes to standard error
    first where each thread is.
    """
    faulthandler.dump_traceback_later(seconds + GRACE, exit=True, file=2)
    try:
        yield
    finally:
        faulthandler.cancel_dump_traceback_later()


def _end_with_the_study() -> "queue.SimpleQueue[str]":
    """The lines of standard input; this process ends with them, whatever it is doing.

    Their end is that of the process that writes them. Linux ends this one even while a library
    keeps all other threads waiting.
    """
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    lines: queue.SimpleQueue[str] = queue.SimpleQueue()

    def read() -> None:
        with suppress(OSError, ValueError):
            for line in sys.stdin:
                lines.put(line)
        os._exit(1)

    threading.Thread(target=read, daemon=True).start()
    return lines


def main() -> None:
    """Answer the study that started this process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # a Ctrl-C is the study's to answer
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what libraries print does not belong among the answers
    last = 0.0

    def say(**what: Any) -> None:
        answers.write(json.dumps(what, allow_nan=False) + "\n")
        answers.flush()

    def tell(part: float) -> None:
        nonlocal last
        if time.monotonic() - last > PROGRESS_INTERVAL:
            last = time.monotonic()
            say(part=part)

    lines = _end_with_the_study()
    try:
        say(ready=True)
        while True:
            said = json.loads(lines.get())
            tasks = [(task["key"], run_from_data(task["run"])) for task in said["tasks"]]
            for result in carry_out_all(tasks, Path(said["folder"]), tell):
                say(result=vars(result))
    except BrokenPipeError:  # the study has ended
        os._exit(1)


if __name__ == "__main__":
    main()
