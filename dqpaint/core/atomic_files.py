"""Bytes -> a file that is written whole or not at all, and on the disk when that is said."""

import errno
import os
import stat
import tempfile
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from dqpaint.errors import OutputError

try:
    import fcntl
except ImportError:  # Windows has neither such locks nor handles of folders
    fcntl = None  # type: ignore[assignment]

PART = (".dqpaint-", ".part")
"""How the name of a temporary file begins and ends."""
LONGEST_WAIT = 30.0  # [s] for another process that writes to the folder
POLL_INTERVAL = 0.01  # [s]
NO_WRITING = 0o222
NOT_SYNCED_HERE = (errno.EINVAL, errno.ENOTSUP)  # a file system that cannot sync folders
TAKEN = (errno.EAGAIN, errno.EACCES)
KINDS = {
    stat.S_IFLNK: "a link", stat.S_IFDIR: "a folder", stat.S_IFIFO: "a pipe",
    stat.S_IFSOCK: "a socket", stat.S_IFCHR: "a device", stat.S_IFBLK: "a device",
}  # fmt: skip
UNFOLLOWED = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)


@dataclass(frozen=True)
class OpenFolder:
    """A folder that one writes to.

    Attributes:
        path: of it.
        handle: of it; None where folders have none.
        alone: whether no other process of dqpaint writes to it; False where there are no locks.
    """

    path: Path
    handle: int | None
    alone: bool

    def sync(self) -> None:
        """Have on the disk what was created, moved and removed in it.

        Raises:
            OSError: the disk says no.
        """
        if self.handle is None:
            return
        try:
            os.fsync(self.handle)
        except OSError as problem:
            if problem.errno not in NOT_SYNCED_HERE:
                raise


@contextmanager
def open_folder(path: Path) -> Iterator[OpenFolder]:
    """A folder to write to, by one process at a time; the others wait.

    Raises:
        OutputError: another process has been writing to it for too long.
        OSError: it cannot be opened.
    """
    if fcntl is None:
        yield OpenFolder(path, None, False)
        return
    handle = os.open(path, os.O_RDONLY | os.O_DIRECTORY)
    try:
        yield OpenFolder(path, handle, _lock(handle, path))
    finally:
        os.close(handle)


def _lock(handle: int, path: Path) -> bool:
    """Whether the folder is ours; a file system without such locks lets everyone in."""
    until = time.monotonic() + LONGEST_WAIT
    while True:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as problem:
            if problem.errno not in TAKEN:
                return False
        else:
            return True
        if time.monotonic() > until:
            raise OutputError(
                f"another dqpaint has been writing to '{path}' for {LONGEST_WAIT:.0f} s; "
                "try again, or choose another folder"
            )
        time.sleep(POLL_INTERVAL)


class NotRegularError(Exception):
    """A name that is no regular file's; the message says what it is, such as "a link"."""


def open_regular(path: Path, flags: int) -> int:
    """The handle of a regular file; no link is followed, and a pipe is not waited for.

    Args:
        path: of the file.
        flags: of `os.open`; with O_CREAT it is made if nothing is there.

    Raises:
        NotRegularError: it is something else.
        OSError: it cannot be opened.
    """
    with suppress(FileNotFoundError):
        _check_regular(os.lstat(path).st_mode)  # a device is not even opened
    try:
        handle = os.open(path, flags | UNFOLLOWED, 0o666)
    except OSError as problem:
        if problem.errno == errno.ELOOP:
            raise NotRegularError(KINDS[stat.S_IFLNK]) from None
        raise
    try:
        _check_regular(os.fstat(handle).st_mode)  # another may have come in between
    except BaseException:
        os.close(handle)
        raise
    return handle


def _check_regular(mode: int) -> None:
    if not stat.S_ISREG(mode):
        raise NotRegularError(KINDS.get(stat.S_IFMT(mode), "no regular file"))


def make_folder(path: Path) -> None:
    """Make a folder and those it lies in, where they are not there.

    Raises:
        OSError: it cannot be made.
    """
    missing = []
    while not path.is_dir():
        missing.append(path)
        if path == path.parent:
            break
        path = path.parent
    for folder in reversed(missing):
        folder.mkdir(exist_ok=True)
        with open_folder(folder.parent) as parent:
            parent.sync()


def write_temporary(path: Path, data: bytes, synced: bool = True) -> Path:
    """Write a temporary file in the same folder; the caller moves or removes it.

    Args:
        path: of the file that it will be.
        data: its bytes.
        synced: they are on the disk when this returns; its name is when its folder is synced.

    Raises:
        OSError: it cannot be written; nothing is left.
    """
    handle, name = tempfile.mkstemp(prefix=PART[0], suffix=PART[1], dir=path.parent)
    staged = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            os.chmod(staged, 0o666 & ~_umask())
            file.flush()
            if synced:
                os.fsync(file.fileno())
    except BaseException:
        remove_temporary(staged)
        raise
    return staged


def remove_temporary(path: Path) -> bool:
    """Whether a temporary file could be removed; else who next writes there removes it."""
    try:
        path.unlink(missing_ok=True)
    except OSError:
        return False
    return True


def sync_files(paths: Iterable[Path]) -> None:
    """Have the bytes of files on the disk; all at once, which costs a disk about as much as one.

    Raises:
        OSError: the disk says no.
    """
    from concurrent.futures import ThreadPoolExecutor  # only where something is written

    with ThreadPoolExecutor() as threads:
        for _ in threads.map(_sync, paths):
            pass


def _sync(path: Path) -> None:
    handle = os.open(path, os.O_RDWR)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def rewrite(path: Path, data: bytes) -> None:
    """Replace the contents of a file; its permissions and links to it remain.

    Raises:
        OutputError: it cannot be written, or is read-only; it is unchanged.
    """
    try:
        place = path.resolve(strict=True)
        mode = place.stat().st_mode & 0o7777
        if not (mode & NO_WRITING and os.access(place, os.W_OK)):
            raise OutputError(f"'{str(path)[:60]}' is read-only; it was left as it is")
        with open_folder(place.parent) as folder:
            staged = write_temporary(place, data)
            try:
                os.chmod(staged, mode)
                os.replace(staged, place)
                folder.sync()
            finally:
                remove_temporary(staged)
    except (OSError, ValueError) as problem:
        raise _refused(path, problem) from None


def write_new(path: Path, data: bytes) -> None:
    """Write a file that does not exist yet.

    Raises:
        OutputError: it exists, or its folder cannot be written.
    """
    try:
        with open_folder(path.parent) as folder:
            staged = write_temporary(path, data)
            try:
                os.link(staged, path)  # unlike a move this fails if something is there
            finally:
                remove_temporary(staged)
            folder.sync()
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
