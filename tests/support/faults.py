"""Faults made on purpose: the n-th call for a file or for memory fails, as a failing machine would.

Files: `os.open`, `write`, `fsync`, `replace` and so on, and what `open` returns, whose reads and
writes are calls of their own. What libraries in C open by themselves is out of reach.

Memory: functions of numpy that make arrays, as called from dqpaint, one fault for each line.
"""

import builtins
import contextlib
import errno
import io
import os
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any
from unittest import mock

import numpy as np

CALLS = ("open", "read", "write", "fsync", "replace", "rename", "link", "unlink", "mkdir",
         "listdir", "ftruncate", "chmod")  # fmt: skip
ARRAYS = ("array", "asarray", "ascontiguousarray", "empty", "empty_like", "zeros", "zeros_like",
          "ones", "full", "stack", "concatenate", "linspace", "arange")  # fmt: skip
OF_KIND = {
    "open": (errno.EMFILE, errno.EACCES, errno.EIO, errno.ENOSPC),
    "read": (errno.EIO,),
    "write": (errno.ENOSPC, errno.EIO),
    "fsync": (errno.EIO, errno.ENOSPC),
    "replace": (errno.EACCES, errno.EIO, errno.ENOSPC),
    "rename": (errno.EACCES, errno.EIO),
    "link": (errno.EACCES, errno.ENOSPC),
    "unlink": (errno.EACCES, errno.EIO),
    "mkdir": (errno.EACCES, errno.ENOSPC),
    "listdir": (errno.EACCES, errno.EIO),
    "ftruncate": (errno.EIO,),
    "chmod": (errno.EACCES,),
}
"""What each call may fail with."""
PACKAGE = str(Path(__file__).parents[2] / "dqpaint")


class Faults:
    """Counts calls for files within a `with`; the one of a number fails.

    Args:
        fail: the number of the call, from 0; None fails none.
        code: its `errno`.
        lasting: all later calls of its kind fail, too, as those of a full disk do.
    """

    def __init__(self, fail: int | None = None, code: int = 0, lasting: bool = False) -> None:
        self.fail, self.code, self.lasting = fail, code, lasting
        self.calls: list[str] = []
        self.failed = ""
        self._patches = contextlib.ExitStack()

    def hit(self, kind: str, where: object = None) -> None:
        """A call; raises if it is the one."""
        if not _ours():
            return
        number = len(self.calls)
        self.calls.append(kind)
        if number == self.fail or (self.lasting and kind == self.failed):
            self.failed = kind
            name = os.fspath(where) if isinstance(where, str | os.PathLike) else None
            raise OSError(self.code, os.strerror(self.code), name)

    def __enter__(self) -> "Faults":
        patch = self._patches.enter_context
        for name in CALLS:
            patch(mock.patch.object(os, name, self._wrapped(name)))
        real = io.open
        opened = self._open(real)
        for module in (io, builtins):
            patch(mock.patch.object(module, "open", opened))
        return self

    def __exit__(self, *_: object) -> None:
        self._patches.close()

    def _wrapped(self, name: str) -> Callable[..., Any]:
        real = getattr(os, name)

        def call(*given: Any, **named: Any) -> Any:
            self.hit(name, given[0] if given else None)
            return real(*given, **named)

        return call

    def _open(self, real: Callable[..., Any]) -> Callable[..., Any]:
        faults = self

        class File(io.FileIO):
            def readinto(self, *given: Any) -> Any:
                faults.hit("read")
                return super().readinto(*given)

            def readall(self) -> Any:
                faults.hit("read")
                return super().readall()

            def read(self, *given: Any) -> Any:
                faults.hit("read")
                return super().read(*given)

            def write(self, *given: Any) -> Any:
                faults.hit("write")
                return super().write(*given)

        def opened(
            file: Any, mode: str = "r", buffering: int = -1, encoding: Any = None,
            errors: Any = None, newline: Any = None, closefd: bool = True, opener: Any = None,
        ) -> Any:  # fmt: skip
            if not _ours():
                return real(file, mode, buffering, encoding, errors, newline, closefd, opener)
            if not isinstance(file, int) and opener is None:
                faults.hit("open", file)
            raw = File(file, mode.replace("b", "").replace("t", ""), closefd, opener)
            try:
                if buffering == 0:
                    return raw
                kind = (io.BufferedRandom if "+" in mode else
                        io.BufferedReader if "r" in mode else io.BufferedWriter)  # fmt: skip
                buffered = kind(raw)
                if "b" in mode:
                    return buffered
                return io.TextIOWrapper(buffered, encoding, errors, newline)
            except BaseException:
                raw.close()
                raise

        return opened


class NoMemory:
    """Counts the lines of dqpaint that ask numpy for memory; the first call of one fails.

    Args:
        fail: the number of the line, in the order in which they are reached; None fails none.
    """

    def __init__(self, fail: int | None = None) -> None:
        self.fail = fail
        self.calls: dict[tuple[str, int], int] = {}
        self.failed = ""
        self._patches = contextlib.ExitStack()

    def __enter__(self) -> "NoMemory":
        for name in ARRAYS:
            wrapped = self._wrapped(getattr(np, name))
            self._patches.enter_context(mock.patch.object(np, name, wrapped))
        return self

    def __exit__(self, *_: object) -> None:
        self._patches.close()

    def _wrapped(self, real: Callable[..., Any]) -> Callable[..., Any]:
        def call(*given: Any, **named: Any) -> Any:
            frame = sys._getframe(1)
            place = frame.f_code.co_filename, frame.f_lineno
            if place[0].startswith(PACKAGE) and place not in self.calls and _ours():
                self.calls[place] = len(self.calls)
                if self.calls[place] == self.fail:
                    self.failed = f"{Path(place[0]).name}:{place[1]}"
                    raise MemoryError("Unable to allocate 7.45 GiB for an array")
            return real(*given, **named)

        return call


def _ours() -> bool:
    """Whether this thread is the command's, not that of a test runner."""
    thread = threading.current_thread()
    return thread is threading.main_thread() or thread.name.startswith("ThreadPoolExecutor")


def forget() -> None:
    """Empty the caches of dqpaint, so that a command reads all its files again.

    Not the hash of its code, which would be a thousand reads of no other kind than the rest.
    """
    from dqpaint.studies.runner import run

    for name, module in list(sys.modules.items()):
        if name.startswith("dqpaint"):
            for thing in list(vars(module).values()):
                if isinstance(thing, ModuleType) or thing is run.code_versions:
                    continue  # a library may be one that is not installed
                if callable(getattr(thing, "cache_clear", None)):
                    thing.cache_clear()


class Answer:
    """What a command answers in this process.

    Attributes:
        code: its exit code; 130 for a Ctrl-C.
        out: what it prints.
        err: what it says on standard error.
    """

    def __init__(self, *words: str) -> None:
        from dqpaint.cli import main

        out, err = io.BytesIO(), io.BytesIO()
        self.code: int = 0
        with (
            mock.patch.object(sys, "argv", ["dqpaint", *words]),
            contextlib.redirect_stdout(io.TextIOWrapper(out, "utf-8")),
            contextlib.redirect_stderr(io.TextIOWrapper(err, "utf-8")),
        ):
            try:
                main.run()
            except SystemExit as stop:
                self.code = stop.code if isinstance(stop.code, int) else int(stop.code is not None)
            except KeyboardInterrupt:
                self.code = 130
            sys.stdout.flush()  # the command may have put streams of its own in their places
            sys.stderr.flush()
            self.out, self.err = out.getvalue().decode(), err.getvalue().decode()


@contextlib.contextmanager
def workers_in_this_process() -> Iterator[None]:
    """Studies carry out their runs here, where faults reach them."""
    from dqpaint.studies.runner import engine
    from dqpaint.studies.runner.batches import groups
    from dqpaint.studies.runner.worker import carry_out_all

    class Here:
        notes = ()

        def __init__(self, folder: Path) -> None:
            self.folder = folder

        def carry_out(self, tasks: Any, progress: Any) -> Iterator[Any]:
            for group in groups(tasks):
                yield from carry_out_all(group, self.folder)

        def close(self) -> None:
            pass

    with mock.patch.object(engine, "_workers", lambda folder, *_: Here(folder)):
        yield
