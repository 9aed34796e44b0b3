"""Files by their names -> a folder that has all of them or none, wherever the writing is cut off.

Each is written beside its place. Then a note that names them all, with their hashes, is put into
the folder: from there on they count as written, move to their places, and the note goes. Who next
writes to the folder finishes what a note says, and removes what has none. So after a power cut the
folder is as before, or has the whole set.
"""

import hashlib
import json
import os
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from io import BufferedReader
from pathlib import Path

from dqpaint.core.atomic_files import (
    PART,
    NotRegularError,
    OpenFolder,
    make_folder,
    open_folder,
    open_regular,
    remove_temporary,
    sync_files,
    write_temporary,
)
from dqpaint.errors import OutputError

NOTE = ".moves"
LARGEST_NOTE = 1_000_000  # bytes
OWN_PART = re.compile(rf"{re.escape(PART[0])}\w+{re.escape(PART[1])}")
OWN_NOTE = re.compile(rf"{re.escape(PART[0])}\w+{re.escape(NOTE)}")


@dataclass(frozen=True)
class _Move:
    """A temporary file of a set, its name in the end, and the SHA-256 of its bytes."""

    part: str
    name: str
    sha256: str


def write_together(folder: Path, contents: Mapping[str, bytes]) -> None:
    """Write files of one folder, which is made if it is not there; all of them or none.

    When it returns they are on the disk. Two processes write one after the other.

    Args:
        folder: of the files.
        contents: the bytes of each file by its name.

    Raises:
        OutputError: a file cannot be written, or is a folder; the message says so if a part is in
            place and the rest will follow. Every file there is whole, the old or the new one.
        OSError: likewise; nothing has changed.
    """
    make_folder(folder)
    with open_folder(folder) as place:
        _finish(place)
        staged: list[Path] = []
        moves: list[_Move] = []
        try:
            for name, data in contents.items():
                if (folder / name).is_dir():
                    raise OutputError(f"'{folder / name}' cannot be written: it is a folder")
                staged.append(write_temporary(folder / name, data, synced=False))
                moves.append(_Move(staged[-1].name, name, hashlib.sha256(data).hexdigest()))
            if len(moves) > 1:
                text = json.dumps([vars(move) for move in moves]).encode()
                staged.append(write_temporary(folder / NOTE, text, synced=False))
            sync_files(staged)
            if len(moves) > 1:
                _move_all(place, moves, staged[-1])
            elif moves:
                os.replace(staged[0], folder / moves[0].name)
                place.sync()
        except _Committed as cut:
            staged.clear()  # they will be needed
            raise OutputError(
                f"'{folder}': {cut}; the new files {', '.join(contents)} are complete on the "
                "disk, and the next command that writes there puts them in their places"
            ) from None
        finally:
            for part in staged:
                remove_temporary(part)


def finish_interrupted(folder: Path) -> list[str]:
    """Finish what a cut left in a folder; returns the names of files that are in place since then.

    Raises:
        OSError: the folder cannot be written.
        OutputError: likewise, or another process is writing to it.
    """
    with open_folder(folder) as place:
        return _finish(place)


class _Committed(Exception):  # noqa: N818  the set is written, but not in its places
    pass


def _move_all(place: OpenFolder, moves: list[_Move], written: Path) -> None:
    """Put a set that is written, as the note is, into its places.

    Raises:
        OSError: nothing has changed.
        _Committed: what is left has to be finished later.
    """
    note = written.with_suffix(NOTE)
    os.replace(written, note)
    moved = 0
    try:
        place.sync()
        for move in moves:
            os.replace(place.path / move.part, place.path / move.name)
            moved += 1
        place.sync()
    except OSError as problem:
        if moved or not remove_temporary(note):
            raise _Committed(problem.strerror) from None
        raise
    except BaseException:  # a Ctrl-C
        _finish(place)
        raise
    remove_temporary(note)  # one that stays has nothing left to move


def _finish(place: OpenFolder) -> list[str]:
    """Finish the moves of notes, and remove temporary files without one; returns what moved."""
    folder, finished = place.path, []
    names = os.listdir(folder)
    for name in filter(OWN_NOTE.fullmatch, names):
        moves = _read_note(folder / name)
        if moves is None:  # it is no note of ours
            continue
        waiting = [move for move in moves if _is(folder / move.part, move)]
        if all(move in waiting or _is(folder / move.name, move) for move in moves):
            for move in waiting:
                os.replace(folder / move.part, folder / move.name)
            place.sync()
            finished += [move.name for move in waiting]
        # else the disk lost a file before the note was synced: nothing had been moved
        (folder / name).unlink()
    if place.alone:
        for name in filter(OWN_PART.fullmatch, names):
            remove_temporary(folder / name)
    return finished


def _read_note(path: Path) -> list[_Move] | None:
    """The moves of a note; None if it is something else, or another person's.

    It may have come with a folder from elsewhere: it can name only files of this folder, and move
    only temporary ones.
    """
    with _opened(path) as file:
        data = b"" if file is None else file.read(LARGEST_NOTE)
    try:
        moves = [_Move(**one) for one in json.loads(data)]
        safe = all(OWN_PART.fullmatch(m.part) and Path(m.name).name == m.name for m in moves)
    except (ValueError, TypeError, RecursionError):
        return None
    return moves if safe else None


def _is(path: Path, move: _Move) -> bool:
    """Whether a file has the bytes of a move."""
    with _opened(path) as file:
        return file is not None and hashlib.file_digest(file, "sha256").hexdigest() == move.sha256


@contextmanager
def _opened(path: Path) -> Iterator[BufferedReader | None]:
    """A regular file of this user; None if there is none."""
    try:
        file = os.fdopen(open_regular(path, os.O_RDONLY), "rb")
    except (FileNotFoundError, NotRegularError):
        yield None
        return
    with file:
        own = not hasattr(os, "geteuid") or os.fstat(file.fileno()).st_uid == os.geteuid()
        yield file if own else None
