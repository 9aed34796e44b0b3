"""A drawing and its included files -> the drawing shown again after each save."""

import gc
import os
import sys
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import NoReturn

from dqpaint.clean_stream import send_raw
from dqpaint.cli.language import tell
from dqpaint.errors import DqpaintError
from dqpaint.language.imports import files_of

INTERVAL = 0.1  # [s] between two looks
SETTLED = 0.03  # [s] without a change: the editor has written all of it

Signature = tuple[int, int, int] | None
_CLEAR = "\x1b[2J\x1b[3J\x1b[H"


def watch(
    path: Path,
    show: Callable[[], None],
    wait: Callable[[float], None] = time.sleep,
    others: Iterable[Path] = (),
) -> NoReturn:
    """Show a drawing now and whenever one of its files is saved; ends by Ctrl-C alone.

    Args:
        path: of the drawing.
        show: shows it; its errors are printed, and the next save is waited for.
        wait: waits for some seconds.
        others: further files whose saves count.
    """
    gc.enable()  # a long life, unlike a command's
    while True:
        before = _signatures([*files_of(path), *others])
        _clear()
        try:
            show()
        except DqpaintError as problem:
            tell(problem)
        print(f"watching {path}; Ctrl-C ends", file=sys.stderr)
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
        _until_saved(path, before, wait)


def _until_saved(path: Path, before: dict[Path, Signature], wait: Callable[[float], None]) -> None:
    """Wait for a change that is complete; a drawing that is away for a moment is being written."""
    now = _signatures(before)
    while now == before or now[path] is None:
        wait(INTERVAL)
        now = _signatures(before)
    settled = False
    while not settled:
        wait(SETTLED)
        last, now = now, _signatures(before)
        settled = now == last


def _signatures(files: Iterable[Path]) -> dict[Path, Signature]:
    return {path: _signature(path) for path in files}


def _signature(path: Path) -> Signature:
    try:
        found = os.stat(path)
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


def _clear() -> None:
    """Clear the terminal before the next picture or errors."""
    if sys.stdout.isatty():
        send_raw(_CLEAR, sys.stdout)  # before what follows on the other stream
