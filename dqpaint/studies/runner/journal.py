"""Results -> the journal of a study on disk, one line of JSON a run as soon as it is done."""

import os
from pathlib import Path
from typing import Self

from dqpaint.errors import DqpaintError, OutputError
from dqpaint.studies.runner.run import Result, result_from_line

try:
    import fcntl
except ImportError:  # where there is no such lock, two studies in one folder are not told apart
    fcntl = None  # type: ignore[assignment]

NAME = "runs.jsonl"


class Journal:
    """The results that a folder holds, by their keys; open while a study adds to them.

    A line that a kill cut off is dropped: its run was not done. One study at a time.

    Raises:
        OutputError: the folder cannot be written.
        DqpaintError: another study is at work in it, or the record is something else.
    """

    def __init__(self, folder: Path) -> None:
        self.path = folder / NAME
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._file = open(self.path, "a+b")  # noqa: SIM115  for as long as the study runs
        except OSError as problem:
            raise OutputError(f"'{self.path}' cannot be written: {problem.strerror}") from None
        try:
            self._lock()
            self.results = self._read()
        except BaseException:
            self._file.close()
            raise

    def _lock(self) -> None:
        if fcntl is None:
            return
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise DqpaintError(
                f"another study is at work in '{self.path.parent}'; wait, or choose another --out"
            ) from None

    def _read(self) -> dict[str, Result]:
        self._file.seek(0)
        data = self._file.read()
        whole = data.rfind(b"\n") + 1
        if whole < len(data):
            self._file.truncate(whole)
        found = {}
        for number, line in enumerate(data[:whole].decode("utf-8", "replace").splitlines(), 1):
            try:
                result = result_from_line(line)
            except ValueError:
                raise DqpaintError(
                    f"'{self.path}' line {number} is not the result of a run; "
                    "move the file away, or choose another --out"
                ) from None
            found[result.key] = result
        return found

    def add(self, result: Result) -> None:
        """Keep a result; when this returns it is on the disk.

        Raises:
            OutputError: it cannot be written.
        """
        try:
            self._file.write(result.line.encode())
            self._file.flush()
            os.fsync(self._file.fileno())
        except OSError as problem:
            raise OutputError(f"'{self.path}' cannot be written: {problem.strerror}") from None
        self.results[result.key] = result

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *fault: object) -> None:
        self.close()

    def close(self) -> None:
        """Let others in."""
        self._file.close()
