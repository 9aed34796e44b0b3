"""Bytes -> a file, written whole or not at all: a temporary file is moved into place."""

import os
import tempfile
from pathlib import Path

from dqpaint.errors import OutputError


def write_temporary(path: Path, data: bytes) -> Path:
    """Write a temporary file in the same folder; the caller moves or removes it.

    Raises:
        OSError: it cannot be written; nothing is left.
    """
    handle, name = tempfile.mkstemp(prefix=".dqpaint-", suffix=".part", dir=path.parent)
    staged = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        os.chmod(staged, 0o666 & ~_umask())
    except BaseException:
        staged.unlink(missing_ok=True)
        raise
    return staged


def rewrite(path: Path, data: bytes) -> None:
    """Replace the contents of a file; its permissions and links to it remain.

    Raises:
        OutputError: it cannot be written; it is unchanged.
    """
    try:
        place = path.resolve(strict=True)
        staged = write_temporary(place, data)
        try:
            os.chmod(staged, place.stat().st_mode & 0o7777)
            os.replace(staged, place)
        finally:
            staged.unlink(missing_ok=True)
    except (OSError, ValueError) as problem:
        raise _refused(path, problem) from None


def write_new(path: Path, data: bytes) -> None:
    """Write a file that does not exist yet.

    Raises:
        OutputError: it exists, or its folder cannot be written.
    """
    try:
        staged = write_temporary(path, data)
        try:
            os.link(staged, path)  # unlike a move this fails if something is there
        finally:
            staged.unlink(missing_ok=True)
    except FileExistsError:
        raise OutputError(f"'{path}' is there already; nothing was changed") from None
    except (OSError, ValueError) as problem:
        raise _refused(path, problem) from None


def _refused(path: Path, problem: OSError | ValueError) -> OutputError:
    reason = problem.strerror if isinstance(problem, OSError) else str(problem)
    return OutputError(f"'{str(path)[:60]}' cannot be written: {reason}")


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
