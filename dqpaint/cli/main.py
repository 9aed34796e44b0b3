"""Arguments of this process -> a command's output, or an error message and an exit code."""

import os
import sys
import warnings
from typing import NoReturn

from dqpaint.clean_stream import cleaned
from dqpaint.cli.front import streams
from dqpaint.cli.front.colours import show
from dqpaint.cli.language import point_at, tell
from dqpaint.cli.studies import app
from dqpaint.errors import DqpaintError, UsageError, is_no_memory

DEBUG = "DQPAINT_DEBUG"  # an environment variable: internal errors show where they are
SHOWS = f"{DEBUG}=1 shows where"
INTERRUPTED = 130


def run() -> None:
    """Run the command of this process; leaves by SystemExit or KeyboardInterrupt."""
    _secure_streams()
    streams.reset()
    if not sys.warnoptions:  # results are checked; what numpy thinks on the way helps nobody
        warnings.simplefilter("ignore", RuntimeWarning)
    try:
        _answer()
    except _StreamError as problem:
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115  nothing more can be said there
        if problem.reason:
            _end(f"error: standard output cannot be written: {problem.reason}", 1)
        sys.exit(1)


class _StreamError(Exception):
    """Standard output cannot be written; `reason` is empty where its reader has simply left."""

    def __init__(self, problem: OSError) -> None:
        super().__init__()
        self.reason = "" if isinstance(problem, BrokenPipeError) else problem.strerror


def _answer() -> None:
    try:
        app(prog_name="dqpaint")
    except UsageError as problem:
        _end(f"usage: {problem}", 2)
    except DqpaintError as problem:
        tell(problem)
        point_at([d.code for d in getattr(problem, "diagnostics", ())], sys.stderr)
        sys.exit(1)
    except SystemExit as stop:
        if stop.code == INTERRUPTED:  # typer has met a Ctrl-C
            raise KeyboardInterrupt from None
        _flush()
        raise
    except Exception as fault:
        _flush()  # what a stream that is broken refused is still waiting there
        if sys.stdout.closed:
            _end("error: standard output was closed before the end", 1)
        if os.environ.get(DEBUG):
            raise
        _end(_of_the_machine(fault) or f"internal error, please report it: {fault!r}; {SHOWS}", 1)


def _flush() -> None:
    try:
        if not sys.stdout.closed:
            sys.stdout.flush()
    except OSError as problem:
        raise _StreamError(problem) from None


def _of_the_machine(fault: Exception) -> str:
    """The sentence of a fault that a full disk, memory or the like may cause anywhere."""
    if is_no_memory(fault):
        return f"error: there is not enough memory; a smaller --size or drawing needs less; {SHOWS}"
    if not isinstance(fault, OSError):
        return ""
    if isinstance(fault.filename, str):
        return f"error: '{fault.filename}' cannot be read or written: {fault.strerror}; {SHOWS}"
    import tempfile

    return (
        f"error: a file cannot be read or written: {fault.strerror}; temporary files are made in "
        f"'{tempfile.tempdir}', and TMPDIR names another folder; {SHOWS}"
    )


def _secure_streams() -> None:
    """Closed streams discard text; what an encoding lacks or a terminal obeys comes as numbers."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "w"))  # noqa: SIM115  for as long as we run
        else:
            setattr(sys, name, cleaned(stream))


def _end(text: str, code: int) -> NoReturn:
    show(text, sys.stderr)
    sys.exit(code)
