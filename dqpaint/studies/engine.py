"""Runs -> results, whatever the number of workers; a study that was stopped goes on.

What is done lies in the study's folder (see `record`), by the key of the run (see `runs`). So the
same study again finds its runs there, and so does a larger one that shares some of them.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

from dqpaint.studies.keeping import place
from dqpaint.studies.pool import carry_out_all, check_jobs
from dqpaint.studies.record import Record
from dqpaint.studies.runs import Result, Run
from dqpaint.terminal import Progress


def carry_out_study(
    runs: Sequence[Run], folder: Path, jobs: int | None = None, what: str = "study"
) -> list[Result]:
    """The results of runs, in their order.

    Args:
        runs: what to paint; all are checked before the first begins.
        folder: where the record lies; made if it is not there.
        jobs: how many processes; None is one a core.
        what: is being done, for the progress bar.

    Raises:
        UsageError: a choice that is none; nothing has been run.
        DqpaintError: the folder cannot be written, or the workers do not start.
        KeyboardInterrupt: a Ctrl-C; what was done is on disk.
    """
    jobs = check_jobs(jobs)
    _check(runs)
    keys = [run.key for run in runs]
    with Record(folder) as record:
        tasks = {
            key: run
            for key, run in zip(keys, runs, strict=True)
            if not _is_done(record.results.get(key), run, folder)
        }
        known = len(set(keys)) - len(tasks)
        if known:
            print(f"note: {known} of {len(set(keys))} runs were done before", file=sys.stderr)
        done = 0
        try:
            with Progress(f"{what}, {len(tasks)} runs") as progress:
                for result in carry_out_all(list(tasks.items()), folder, jobs, progress):
                    record.add(result)
                    done += 1
        except KeyboardInterrupt:
            print(
                f"note: {known + done} of {len(set(keys))} runs are done and kept in '{folder}'; "
                "the same command goes on from there",
                file=sys.stderr,
            )
            raise
        return [record.results[key] for key in keys]


def _check(runs: Sequence[Run]) -> None:
    """Check each choice once; seeds make no difference."""
    seen = set()
    for run in runs:
        alike = run.settings.model_copy(update={"seed": 0}).model_dump_json(), run.text
        if alike not in seen:
            seen.add(alike)
            run.check()


def _is_done(result: Result | None, run: Run, folder: Path) -> bool:
    if result is None or result.status == "died":
        return False
    kept = run.keep and result.figures  # a run that failed has nothing to keep
    return not kept or place(folder, result.key).is_file()
