"""Requests of pages -> answers of worker processes: the newest of each page wins.

Two processes, each with one job at a time: one reads and sketches, which takes milliseconds, the
other runs arms. A page's newer request replaces what it had asked before: what waits is dropped,
what runs is told to stop, and what does not stop within a second is ended with its process, as a
law that hangs must be.
"""

import asyncio
import itertools
import multiprocessing
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Literal

from dqpaint.studio.work.messages import Answer, Request

Kind = Literal["read", "run"]
Listener = Callable[[Answer], None]
PATIENCE = 1.0  # [s] for a job that was told to stop


@dataclass(frozen=True)
class _Job:
    number: int
    page: str
    request: Request
    listener: Listener


class Worker:
    """One process, its queue, and the job it has.

    Args:
        kind: which jobs it does.
        folders: whose files it may read.
        loop: on which listeners are called.
    """

    def __init__(
        self, kind: Kind, folders: Sequence[Path], loop: asyncio.AbstractEventLoop
    ) -> None:
        self._kind = kind
        self._folders = tuple(folders)
        self._loop = loop
        self._numbers = itertools.count(1)
        self._waiting: dict[str, _Job] = {}
        self._current: _Job | None = None
        self._cancelled = False
        self._closed = False
        self._start()

    def submit(self, page: str, request: Request, listener: Listener) -> None:
        """Ask for something; what the same page asked before is dropped.

        Args:
            page: that asks.
            request: what it asks.
            listener: called with each answer.
        """
        self._waiting[page] = _Job(next(self._numbers), page, request, listener)
        if self._current is not None and self._current.page == page:
            self._cancel()
        self._next()

    def forget(self, page: str) -> None:
        """Drop what a page has asked."""
        self._waiting.pop(page, None)
        if self._current is not None and self._current.page == page:
            self._cancel()

    def close(self) -> None:
        """End the process."""
        self._closed = True
        self._process.kill()
        self._process.join()
        self._pipe.close()

    def _start(self) -> None:
        from dqpaint.studio.work.jobs import serve

        context = multiprocessing.get_context("spawn")
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(
            target=serve, args=(self._kind, theirs, self._folders), daemon=True
        )
        self._process.start()
        theirs.close()
        threading.Thread(target=self._listen, args=(self._pipe, self._process), daemon=True).start()

    def _listen(self, pipe: Connection, process: Any) -> None:
        """Pass on what the process says, in a thread of its own."""
        while True:
            try:
                number, answer = pipe.recv()
            except (EOFError, OSError):
                break
            self._tell(self._receive, number, answer)
        process.join()
        self._tell(self._ended, process)

    def _tell(self, function: Callable[..., None], *arguments: Any) -> None:
        with suppress(RuntimeError):  # the loop has ended
            self._loop.call_soon_threadsafe(function, *arguments)

    def _receive(self, number: int, answer: Answer | None) -> None:
        """An answer, or None: the job is over."""
        job = self._current
        if job is None or job.number != number:
            return
        if answer is None:
            self._current, self._cancelled = None, False
            self._next()
        elif not self._cancelled:
            job.listener(answer)

    def _next(self) -> None:
        if self._current is not None or not self._waiting or self._closed:
            return
        page = next(iter(self._waiting))
        job = self._waiting.pop(page)
        self._current = job
        self._pipe.send((job.number, job.request))

    def _cancel(self) -> None:
        if self._cancelled or self._current is None:
            return
        self._cancelled = True
        self._pipe.send((self._current.number, None))
        self._loop.call_later(PATIENCE, self._end, self._current.number)

    def _end(self, number: int) -> None:
        """End the process, if it is still at a job that was to stop."""
        if self._current is not None and self._current.number == number:
            self._process.kill()

    def _ended(self, process: Any) -> None:
        if self._closed or process is not self._process:
            return
        job, self._current = self._current, None
        stopped, self._cancelled = self._cancelled, False
        self._pipe.close()
        self._start()
        if job is not None and not stopped:
            from dqpaint.studio.work.messages import Failure

            job.listener(Failure("physics", "the run ended its process; the next one begins anew"))
        self._next()
