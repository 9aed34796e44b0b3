"""A CSV of numbers -> its columns; faults by file, row and column."""

import hashlib
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from dqpaint.core.inputs import read_regular
from dqpaint.errors import DqpaintError, UsageError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

LARGEST_FILE = 100_000_000  # bytes of a file
SHORTEST = 1e-6  # [s] between two rows
LARGEST_BY_UNIT = {
    "_s": 1e13,
    "_rad": 1e4,
    "_deg": 1e6,
    "_m": 1e3,
    "_N": 1e5,
}  # more is a slip, by a column's unit
LARGEST_NUMBER = 1e9  # of the others
MOST_NAMED = 8


class NumberTable:
    """Rows of numbers under their names, in a file with commas, semicolons or tabs.

    The first row that is not empty and does not begin with # names the columns.

    Args:
        path: of the file.
        kind: what it is, for the message of one that cannot be read.

    Attributes:
        name: of the file.
        sha256: of its bytes.
        names: of the columns.
        rows: the number of each row in the file, from 1.

    Raises:
        UsageError: it cannot be read.
        DqpaintError: it is no such table.
    """

    def __init__(self, path: str, kind: str) -> None:
        self.name = name = Path(path).name
        try:
            data = read_regular(path, LARGEST_FILE)
        except OSError as problem:
            raise UsageError(f"{kind} '{path}' cannot be read: {problem.strerror}") from None
        self.sha256 = hashlib.sha256(data).hexdigest()
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            raise DqpaintError(f"{name} is no text in UTF-8") from None
        lines = [
            (number, line)
            for number, line in enumerate(text.splitlines(), 1)
            if line.strip() and not line.lstrip().startswith("#")
        ]
        if not lines:
            raise DqpaintError(f"{name} is empty: it needs a row of names, and rows of numbers")
        head = lines[0][1]
        self._separator = max(",;\t", key=head.count)
        self.names = [word.strip().strip('"') for word in head.split(self._separator)]
        twice = next((n for n in self.names if n and self.names.count(n) > 1), None)
        if twice is not None:
            raise DqpaintError(f"{name}, row {lines[0][0]}: column '{twice}' is there twice")
        self._lines = lines[1:]
        if not self._lines:
            raise DqpaintError(f"{name} has names, but no rows of numbers")
        self.rows = [number for number, _ in self._lines]

    def columns(self, wanted: Sequence[str]) -> "NDArray[np.float64]":
        """The numbers (M, k) of some columns.

        Raises:
            DqpaintError: a column is missing, or a value is no number of its unit's size.
        """
        import numpy as np  # slow, and most that use this room need no arrays

        missing = [name for name in wanted if name not in self.names]
        if missing:
            has = ", ".join(self.names[:MOST_NAMED]) + (" ..." * (len(self.names) > MOST_NAMED))
            raise DqpaintError(f"{self.name} has no column '{missing[0]}'; it has: {has}")
        places = [self.names.index(name) for name in wanted]
        values = np.empty((len(self._lines), len(wanted)))
        for k, (row, line) in enumerate(self._lines):
            cells = line.split(self._separator)
            if len(cells) != len(self.names):
                raise DqpaintError(
                    f"{self.name}, row {row}: {len(cells)} values, but {len(self.names)} columns"
                )
            for i, place in enumerate(places):
                values[k, i] = self._number(cells[place], row, wanted[i])
        return values

    def _number(self, text: str, row: int, column: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise self.fault(row, column, f"'{text.strip()[:40]}' is not a number")
        most = LARGEST_BY_UNIT.get(column[column.rfind("_") :], LARGEST_NUMBER)
        if abs(value) > most:
            raise self.fault(row, column, f"{value:.6g} is more than any arm does (up to {most:g})")
        return value

    def fault(self, row: int, column: str, text: str) -> DqpaintError:
        """An error about one value."""
        return DqpaintError(f"{self.name}, row {row}, column {column}: {text}")

    def times(self) -> "NDArray[np.float64]":
        """The times (M,) [s] of the column `t_s`, which increase.

        Raises:
            DqpaintError: they do not.
        """
        t = self.columns(["t_s"])[:, 0]
        back = [k for k, gap in enumerate((t[1:] - t[:-1]).tolist()) if gap < SHORTEST]
        if back:
            k = back[0]
            text = f"{t[k + 1]:.9g} s does not come after {t[k]:.9g} s"
            if t[k + 1] > t[k]:
                text = f"{t[k + 1]:.9g} s comes less than a microsecond after {t[k]:.9g} s"
            raise self.fault(self.rows[k + 1], "t_s", text)
        return t
