"""Results -> the journal of a study on disk, one line of JSON a run as soon as it is done.

A line begins with a hash of the rest, so that damage is told and never read as a number:

    {"dqpaint": "0f3a...", "key": "...", "status": "done", "message": "", "figures": {...}, ...}
"""

import hashlib
import json
import math
import os
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, Self

from pydantic import TypeAdapter

from dqpaint.core import NotRegularError, make_folder, open_folder, open_regular, write_new
from dqpaint.errors import DqpaintError, OutputError
from dqpaint.studies.runner.run import Result

try:
    import fcntl
except ImportError:  # where there is no such lock, two studies in one folder are not told apart
    fcntl = None  # type: ignore[assignment]

NAME = "runs.jsonl"
HEAD, DIGITS = b'{"dqpaint": "', 16
OLD_HEAD = b'{"key": "'  # of lines without a hash, of dqpaint 0.1
LONGEST_LINE = 1_000_000  # bytes
ELSE = "move the file away, or choose another --out"
_RESULT = TypeAdapter(Result)


def encode_line(result: Result) -> bytes:
    """The line of a result; numbers are read back bit for bit.

    Raises:
        ValueError: a figure is not finite.
    """
    rest = json.dumps(vars(result), allow_nan=False)[1:].encode()
    return HEAD + _hash(rest) + b'", ' + rest + b"\n"


def decode_line(line: bytes) -> Result:
    """The result of a whole line.

    Raises:
        ValueError: what is wrong with the line.
    """
    body, rest = line.removesuffix(b"\n"), len(HEAD) + DIGITS + 3
    if not body.startswith(HEAD):
        raise ValueError("is not the result of a run")
    if body[len(HEAD) : rest] != _hash(body[rest:]) + b'", ':
        raise ValueError("is damaged, or was changed: its hash does not fit")
    try:
        result = _RESULT.validate_json(b"{" + body[rest:], strict=True)
    except ValueError:
        raise ValueError("is not the result of a run of this version of dqpaint") from None
    if result.status == "done" and not result.figures:
        raise ValueError("has no figures")
    if not all(map(math.isfinite, [*result.figures.values(), result.wall])):
        raise ValueError("has a figure that is not finite")
    return result


def _hash(rest: bytes) -> bytes:
    return hashlib.sha256(rest).hexdigest()[:DIGITS].encode()


class Journal:
    """The results that a folder holds, by their keys; open while a study adds to them.

    A last line that was cut off, by a kill or a full disk, is dropped: its run was not done. What
    was there of it is kept in a file of its own. One study at a time.

    Attributes:
        results: by their keys.
        notes: what was dropped, a sentence each.

    Raises:
        OutputError: the folder cannot be written.
        DqpaintError: another study is at work in it, or the journal is damaged or something else;
            it is as it was.
    """

    def __init__(self, folder: Path) -> None:
        self.path = folder / NAME
        self.results: dict[str, Result] = {}
        self.notes: list[str] = []
        try:
            make_folder(folder)
            self._handle = open_regular(self.path, os.O_RDWR | os.O_CREAT | os.O_APPEND)
            try:
                self._lock()
                self._read()
            except BaseException:
                self.close()
                raise
        except NotRegularError as problem:
            raise DqpaintError(f"'{self.path}' is {problem}, not a journal; {ELSE}") from None
        except OSError as problem:
            raise self._refused(problem) from None

    def _lock(self) -> None:
        if fcntl is None:
            return
        try:
            fcntl.flock(self._handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise DqpaintError(
                f"another study is at work in '{self.path.parent}'; wait, or choose another --out"
            ) from None

    def _read(self) -> None:
        with os.fdopen(os.dup(self._handle), "rb") as file:
            file.seek(0)
            whole, tail = self._read_lines(file)
        if tail:
            self._drop(whole, tail)
        else:
            with open_folder(self.path.parent) as folder:
                folder.sync()  # a journal that is new

    def _read_lines(self, file: BinaryIO) -> tuple[int, bytes]:
        """Read whole lines; returns where they end, and what follows."""
        whole = number = 0
        while line := file.readline(LONGEST_LINE):
            number += 1
            if not line.endswith(b"\n") and _was_cut_off(line, whole > 0) and not file.read(1):
                return whole, line
            try:
                result = decode_line(line)
            except ValueError as problem:
                if number == 1 and line.startswith(OLD_HEAD):
                    raise DqpaintError(
                        f"'{self.path}' seems to be of an older dqpaint, whose runs this one "
                        f"cannot use; {ELSE}"
                    ) from None
                told = f"'{self.path}' line {number} {problem}"
                cure = "take it out, and its run is done again" if line.startswith(HEAD) else ELSE
                raise DqpaintError(f"{told}; {cure}") from None
            self.results[result.key] = result
            whole += len(line)
        return whole, b""

    def _drop(self, whole: int, tail: bytes) -> None:
        copy = self._keep_copy(tail)
        os.ftruncate(self._handle, whole)
        os.fsync(self._handle)
        self.notes.append(
            f"the last line of '{self.path}' was cut off, so its run is done again; "
            f"what there was of it is in '{copy}'"
        )

    def _keep_copy(self, tail: bytes) -> Path:
        number = 1
        while os.path.lexists(copy := self.path.with_name(f"runs-cut-{number}.txt")):
            number += 1
        write_new(copy, tail)
        return copy

    def add(self, result: Result) -> None:
        """Keep a result; when this returns it is on the disk.

        Raises:
            OutputError: it cannot be written.
        """
        line = encode_line(result)
        before = os.fstat(self._handle).st_size
        try:
            done = 0
            while done < len(line):
                done += os.write(self._handle, line[done:])
            os.fsync(self._handle)
        except OSError as problem:
            self._take_back(before)
            raise self._refused(problem) from None
        self.results[result.key] = result

    def _take_back(self, before: int) -> None:
        """Remove a part of a line; if that fails too, the next study drops it."""
        with suppress(OSError):
            os.ftruncate(self._handle, before)

    def _refused(self, problem: OSError) -> OutputError:
        return OutputError(f"'{self.path}' cannot be written: {problem.strerror}")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *fault: object) -> None:
        self.close()

    def close(self) -> None:
        """Let others in."""
        os.close(self._handle)


def _was_cut_off(tail: bytes, follows: bool) -> bool:
    """Whether a line without an end is the begin of one of ours.

    A power cut may leave a file longer, with zeros in place of its last bytes. Only behind other
    lines of ours are a few bytes, or zeros alone, taken for ours.
    """
    text = tail.rstrip(b"\0")
    return text.startswith(HEAD) or (follows and HEAD.startswith(text))
