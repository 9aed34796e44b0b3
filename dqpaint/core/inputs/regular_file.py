"""Name of a file -> its bytes: regular files alone, and no more bytes than their kind may have.

A pipe would be waited for without end, a device read without end.
"""

import errno
import os
import stat
from pathlib import Path

from dqpaint.core.atomic_files import KINDS

UNWAITED = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)


def read_regular(path: str | Path, most: int) -> bytes:
    """The bytes of a file; links are followed.

    Args:
        path: of the file.
        most: bytes that it may have.

    Raises:
        OSError: it cannot be read, is a pipe or a device, or is larger, which is EFBIG; its
            `strerror` says which.
    """
    handle, size = _open(path, most)
    with os.fdopen(handle, "rb") as file:
        data = file.read(min(size, most) + 1)
        data += file.read(most + 1 - len(data)) if len(data) > size else b""  # it grows
    if len(data) > most:
        raise _too_large(path, most)
    return data


def stat_regular(path: str | Path, most: int) -> int:
    """The size of a file [bytes] that `read_regular` would read.

    Raises:
        OSError: it would not.
    """
    handle, size = _open(path, most)
    os.close(handle)
    return size


def _open(path: str | Path, most: int) -> tuple[int, int]:
    """The handle and the size of a file that may be read."""
    try:
        _check(os.stat(path), path, most)  # a device is not even opened
        handle = os.open(path, os.O_RDONLY | UNWAITED)
    except ValueError:  # a zero character, or half of a letter
        raise OSError(errno.EINVAL, "no file can have this name", str(path)) from None
    try:
        return handle, _check(os.fstat(handle), path, most)  # another may be there by now
    except BaseException:
        os.close(handle)
        raise


def _check(facts: os.stat_result, path: str | Path, most: int) -> int:
    if stat.S_ISDIR(facts.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not stat.S_ISREG(facts.st_mode):
        kind = KINDS.get(stat.S_IFMT(facts.st_mode), "of another kind")
        raise OSError(errno.EINVAL, f"it is {kind}, not a file", str(path))
    if facts.st_size > most:
        raise _too_large(path, most)
    return facts.st_size


def _too_large(path: str | Path, most: int) -> OSError:
    text = f"{most // 10**6} MB" if most >= 10**6 else f"{most // 1000} kB"
    return OSError(errno.EFBIG, f"it is larger than {text}", str(path))
