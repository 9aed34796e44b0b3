"""What a program does to a folder -> every state in which a power cut may leave it.

Writes, creations, moves and removals are recorded with what was synced. POSIX promises no more than
that: bytes written since the last `fsync` of a file may be there, be cut, be zeros, or be missing;
of what happened to names since the last `fsync` of the folder any part may have come to pass.
"""

import contextlib
import io
import itertools
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest import mock

Contents = dict[str, bytes]
Action = tuple[Any, ...]
DAMAGE = {
    "all": lambda data: data,
    "half": lambda data: data[: len(data) // 2],
    "zeros": lambda data: bytes(len(data)),
    "none": lambda data: b"",
}
"""What may be left of bytes that were not synced."""


class Recorder:
    """Records what is done to one folder within a `with`, and when the program says "written"."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.before = read_folder(folder)
        self.inodes = {name: os.stat(folder / name).st_ino for name in self.before}
        self.actions: list[Action] = []
        self._patches = contextlib.ExitStack()

    def said(self, what: Any) -> None:
        """The program says that something is done."""
        self.actions.append(("said", what))

    def __enter__(self) -> "Recorder":
        patch, real = self._patches.enter_context, {
            name: getattr(os, name)
            for name in ("open", "write", "fsync", "replace", "link", "unlink", "ftruncate")
        }  # fmt: skip
        note = self.actions.append
        here = os.stat(self.folder).st_ino

        def opened(path: Any, flags: int, *mode: Any, **named: Any) -> int:
            new = flags & os.O_CREAT and not os.path.lexists(path)
            handle: int = real["open"](path, flags, *mode, **named)
            if new:
                note(("create", Path(path).name, os.fstat(handle).st_ino))
            return handle

        def write(handle: int, data: bytes) -> int:
            count: int = real["write"](handle, data)
            note(("write", os.fstat(handle).st_ino, bytes(data[:count])))
            return count

        def fsync(handle: int) -> None:  # without the disk, which is slow
            inode = os.fstat(handle).st_ino
            note(("sync folder",) if inode == here else ("sync", inode))

        def replace(source: Any, target: Any) -> None:
            inode = os.stat(source).st_ino
            real["replace"](source, target)
            note(("move", Path(source).name, Path(target).name, inode))

        def link(source: Any, target: Any) -> None:
            real["link"](source, target)
            note(("create", Path(target).name, os.stat(source).st_ino))

        def unlink(path: Any) -> None:
            real["unlink"](path)
            note(("remove", Path(path).name))

        def ftruncate(handle: int, size: int) -> None:
            real["ftruncate"](handle, size)
            note(("truncate", os.fstat(handle).st_ino, size))

        class File(io.FileIO):
            def write(self, data: Any) -> int:
                count = super().write(data)
                note(("write", os.fstat(self.fileno()).st_ino, bytes(data[:count])))
                return count

        def fdopen(handle: int, mode: str = "r", *_: Any) -> Any:
            raw = File(handle, mode.replace("b", ""))
            return io.BufferedWriter(raw) if "w" in mode else io.BufferedReader(raw)

        mine = {"open": opened, "write": write, "fsync": fsync, "replace": replace, "link": link,
                "unlink": unlink, "ftruncate": ftruncate, "fdopen": fdopen}  # fmt: skip
        for name, function in mine.items():
            patch(mock.patch.object(os, name, function))
        return self

    def __exit__(self, *_: object) -> None:
        self._patches.close()

    def cuts(self) -> Iterator[tuple[Contents, list[Any]]]:
        """Each state that a cut may leave, once, with what had been said before."""
        seen = set()
        for end in range(len(self.actions) + 1):
            said = [action[1] for action in self.actions[:end] if action[0] == "said"]
            for state in self._states(self.actions[:end]):
                mark = (tuple(sorted(state.items())), len(said))
                if mark not in seen:
                    seen.add(mark)
                    yield state, said

    def _states(self, actions: list[Action]) -> Iterator[Contents]:
        names = [a for a in actions if a[0] in ("create", "move", "remove", "sync folder")]
        synced = max((i + 1 for i, a in enumerate(names) if a[0] == "sync folder"), default=0)
        sure, open_ = names[:synced], names[synced:]
        for damage in DAMAGE:
            data = self._data(actions, damage)
            for chosen in itertools.product((True, False), repeat=len(open_)):
                kept = [a for a, yes in zip(open_, chosen, strict=True) if yes]
                entries = self._entries([*sure, *kept])
                yield {name: data[inode] for name, inode in entries.items()}

    def _entries(self, names: list[Action]) -> dict[str, int]:
        entries = dict(self.inodes)
        for action in names:
            if action[0] == "create":
                entries[action[1]] = action[2]
            elif action[0] == "move":
                entries.pop(action[1], None)
                entries[action[2]] = action[3]
            elif action[0] == "remove":
                entries.pop(action[1], None)
        return entries

    def _data(self, actions: list[Action], damage: str) -> dict[int, bytes]:
        """The bytes of every file, damaged where they were not synced."""
        whole = {self.inodes[name]: data for name, data in self.before.items()}
        sure = dict(whole)
        for action in actions:
            if action[0] == "create":
                whole.setdefault(action[2], b"")
                sure.setdefault(action[2], b"")
            elif action[0] == "write":
                whole[action[1]] += action[2]
            elif action[0] == "truncate":
                whole[action[1]] = whole[action[1]][: action[2]]
            elif action[0] == "sync":
                sure[action[1]] = whole[action[1]]
        left = {}
        for inode, data in whole.items():
            safe = sure[inode]
            if data.startswith(safe):
                left[inode] = safe + DAMAGE[damage](data[len(safe) :])
            else:  # cut since: it may be as long as before
                left[inode] = data if damage == "all" else safe
        return left


def read_folder(folder: Path) -> Contents:
    """The files of a folder."""
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def lay_down(folder: Path, state: Contents) -> None:
    """Make a folder that has these files."""
    folder.mkdir()
    for name, data in state.items():
        (folder / name).write_bytes(data)
