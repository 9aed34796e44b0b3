"""Arguments of this process -> a command's output, or an error message and an exit code."""

import os
import sys
from typing import NoReturn

from dqpaint.cli.language import point_at, tell
from dqpaint.cli.studies import app
from dqpaint.errors import DqpaintError, UsageError

DEBUG = "DQPAINT_DEBUG"  # an environment variable: internal errors show where they are
INTERRUPTED = 130


def run() -> None:
    """Run the command of this process; leaves by SystemExit or KeyboardInterrupt."""
    _secure_streams()
    try:
        _answer()
    except OSError as problem:  # of a stream
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115  nothing more can be said there
        if not isinstance(problem, BrokenPipeError):
            _end(f"error: standard output cannot be written: {problem.strerror}", 1)
        sys.exit(1)


def _answer() -> None:
    try:
        app()
    except UsageError as problem:
        _end(f"usage: {problem}", 2)
    except DqpaintError as problem:
        tell(problem)
        point_at([d.code for d in getattr(problem, "diagnostics", ())], sys.stderr)
        sys.exit(1)
    except SystemExit as stop:
        if stop.code == INTERRUPTED:  # typer has met a Ctrl-C
            raise KeyboardInterrupt from None
        if not sys.stdout.closed:
            sys.stdout.flush()
        raise
    except Exception as fault:
        if isinstance(fault, OSError) and fault.filename is None:  # of a stream: files have a name
            raise
        if sys.stdout.closed:
            _end("error: standard output was closed before the end", 1)
        if os.environ.get(DEBUG):
            raise
        _end(f"internal error, please report it: {fault!r}; {DEBUG}=1 shows where", 1)


def _secure_streams() -> None:
    """Closed streams discard text; characters that an encoding lacks are written as numbers."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "w"))  # noqa: SIM115  for as long as we run
        else:
            stream.reconfigure(errors="backslashreplace")


def _end(text: str, code: int) -> NoReturn:
    print(text, file=sys.stderr)
    sys.exit(code)
