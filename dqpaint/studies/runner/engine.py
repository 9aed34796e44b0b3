"""Runs -> results, kept in a journal, so that a study that was stopped goes on.

What is done lies in the study's folder (see `journal`), by the key of the run (see `run`). So the
same study again finds its runs there, and so does a larger one that shares some of them.
"""

import time
from collections.abc import Sequence
from contextlib import ExitStack, closing
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Self

from dqpaint.core import log
from dqpaint.outputs import files
from dqpaint.painting import time_limit
from dqpaint.studies.runner.journal import Journal
from dqpaint.studies.runner.process_pool import Pool, check_jobs
from dqpaint.studies.runner.reporter import SILENT, Reporter
from dqpaint.studies.runner.run import Result, Run
from dqpaint.studies.runner.run_arrays import arrays_path

if TYPE_CHECKING:
    from dqpaint.studies.runner.dask_pool import Cluster

Workers = int | str | None
"""How many processes, None for one a core; or the address of a Dask cluster."""


def carry_out_study(
    runs: Sequence[Run],
    folder: Path,
    jobs: Workers = None,
    what: str = "study",
    reporter: Reporter = SILENT,
) -> list[Result]:
    """The results of runs, in their order.

    Args:
        runs: what to paint; all are checked before the first begins.
        folder: where the journal lies; made if it is not there.
        jobs: how many processes, None is one a core; or the address of a Dask cluster.
        what: the title that the reporter shows.
        reporter: is told how far it is.

    Raises:
        UsageError: a choice that is none; nothing has been run.
        DqpaintError: the folder cannot be written, or the workers do not start.
        KeyboardInterrupt: a Ctrl-C; what was done is on disk.
    """
    if not isinstance(jobs, str):
        check_jobs(jobs)
    check(runs)
    with Study(folder, jobs, what, len(runs), reporter) as study:
        return study.results(runs, tell_known=True)


class Study:
    """A study at work: runs in, results out, as often as one likes; reported as one.

    Args:
        folder: where the journal lies; made if it is not there.
        jobs: how many processes, None is one a core; or the address of a Dask cluster.
        what: the title that the reporter shows.
        total: how many runs it will be at most.
        reporter: is told how far it is.

    Raises:
        DqpaintError: the folder cannot be written.
    """

    def __init__(
        self, folder: Path, jobs: Workers, what: str, total: int, reporter: Reporter = SILENT
    ) -> None:
        self._folder, self._total = folder, total
        self._begin = time.monotonic()
        self._reporter = reporter
        reporter.begin(f"{what}, {total} runs")
        with ExitStack() as opened:
            self._workers = opened.enter_context(closing(_workers(folder, jobs)))
            self._journal = opened.enter_context(Journal(folder))
            for note in [*self._workers.notes, *self._journal.notes, *files.finished(folder)]:
                reporter.note(note)
            self._opened = opened.pop_all()
        self._known: set[str] = set()  # keys of runs that were done before
        self._done: set[str] = set()

    def results(self, runs: Sequence[Run], tell_known: bool = False) -> list[Result]:
        """The results of runs, in their order; what is in the journal is not run again.

        Args:
            runs: what to paint.
            tell_known: say beforehand how many are in the journal.

        Raises:
            DqpaintError: the folder cannot be written, or the workers do not start.
        """
        keys = [run.key for run in runs]
        found = self._journal.results
        tasks = {
            key: run
            for key, run in zip(keys, runs, strict=True)
            if not _is_done(found.get(key), run, self._folder)
        }
        known = set(keys) - tasks.keys() - self._done - self._known
        self._known |= known
        self._total -= len(known)
        if known and tell_known:
            self._reporter.note(f"{len(known)} of {len(set(keys))} runs were done before")
        before = len(self._done)

        def tell(count: float) -> None:
            self._reporter.show(min(1.0, (before + count) / max(1, self._total)))

        for result in self._workers.carry_out(list(tasks.items()), tell):
            self._journal.add(result)
            self._done.add(result.key)
            log("studies", "run %s: %s, %.2f s", result.key[:8], result.status, result.wall)
        return [found[key] for key in keys]

    @property
    def known(self) -> int:
        """How many of the runs so far were done before."""
        return len(self._known)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        fault: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End the workers; after a Ctrl-C, say what is kept."""
        self._opened.close()
        self._reporter.end()
        if kind is None and self._done:
            seconds = time.monotonic() - self._begin
            self._reporter.note(f"{len(self._done)} runs took {seconds:.1f} s", aside=True)
        if kind is KeyboardInterrupt:
            done = len(self._known | self._done)
            self._reporter.note(
                f"{done} runs are done and kept in '{self._folder}'; "
                "the same command goes on from there"
            )


def _workers(folder: Path, jobs: Workers) -> "Pool | Cluster":
    if isinstance(jobs, str):
        from dqpaint.studies.runner.dask_pool import Cluster

        return Cluster(folder, jobs)
    return Pool(folder, check_jobs(jobs))


def check(runs: Sequence[Run]) -> None:
    """Check each choice once; seeds make no difference.

    Raises:
        UsageError: an unknown name or a value out of its range.
        ScriptError: a mistake in the drawing.
    """
    seen = set()
    for run in runs:
        alike = run.settings.model_copy(update={"seed": 0}).model_dump_json(), run.text
        if alike not in seen:
            seen.add(alike)
            with time_limit.limit_time(run.settings.timeout):  # a law's file is read, which runs it
                run.check()


def _is_done(result: Result | None, run: Run, folder: Path) -> bool:
    if result is None or result.status == "died":
        return False
    kept = run.keep and result.figures  # a run that failed has nothing to keep
    return not kept or arrays_path(folder, result.key).is_file()
