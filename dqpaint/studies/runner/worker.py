"""A process that carries out runs: lines of JSON in, lines of JSON out, until the input ends.

It is a fresh interpreter, not a fork: a fork of a process whose libraries have threads (OpenBLAS,
OpenCV) can inherit a lock that nobody holds any more, and waits for it for ever. It imports
everything before its first run and lives as long as the study, so the start is paid once a worker,
on the worker's own core.
"""

import json
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from dqpaint.errors import DqpaintError, UnstableError
from dqpaint.metrics import limits_text
from dqpaint.painting import paint
from dqpaint.studies.runner.batches import Task, carry_out_batch, goes_in_batches
from dqpaint.studies.runner.run import Result, Run, Status, is_of_the_machine, run_from_data
from dqpaint.studies.runner.run_arrays import write_arrays

PROGRESS_INTERVAL = 0.2  # [s]


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
        said = str(fault) if known else f"internal error: {fault!r}"
        status: Status = "died" if is_of_the_machine(fault) else "failed"
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
        with suppress(Exception):  # what is wrong each run says by itself
            results = carry_out_batch(tasks, folder, lambda part: progress(part * len(tasks)))
    if results is not None:
        yield from results
    elif len(tasks) > 1:  # one that cannot be in a batch must not change how the others are done
        for task in tasks:
            yield from carry_out_all([task], folder, progress)
    else:
        ((key, run),) = tasks
        yield carry_out(run, key, folder, progress)


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

    try:
        say(ready=True)
        for line in sys.stdin:
            said = json.loads(line)
            tasks = [(task["key"], run_from_data(task["run"])) for task in said["tasks"]]
            for result in carry_out_all(tasks, Path(said["folder"]), tell):
                say(result=vars(result))
    except BrokenPipeError:  # the study has ended
        os._exit(1)


if __name__ == "__main__":
    main()
