"""Rows of a run -> lines of the drawing, as indices into the distinct lines."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dqpaint.diagnostics import SourceLine

Rows = slice | NDArray[np.integer] | NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class RowLines:
    """The line of the drawing that each of N rows belongs to.

    Attributes:
        lines: distinct, in order; some may be of no row.
        index: (N,) which of them each row has; read-only.
    """

    lines: tuple[SourceLine, ...]
    index: NDArray[np.int64]

    def __post_init__(self) -> None:
        self.index.setflags(write=False)

    @classmethod
    def from_lines(cls, lines: Sequence[SourceLine]) -> "RowLines":
        """One row for each of some lines."""
        known = sorted(set(lines))
        place = {line: i for i, line in enumerate(known)}
        return cls(tuple(known), np.array([place[line] for line in lines], np.int64))

    def __len__(self) -> int:
        return len(self.index)

    def __getitem__(self, rows: Rows) -> "RowLines":
        return RowLines(self.lines, self.index[rows])

    def at(self, row: int) -> SourceLine:
        """The line of one row."""
        return self.lines[int(self.index[row])]

    @property
    def present(self) -> list[SourceLine]:
        """The lines with at least one row, without repetition, in order."""
        return [self.lines[i] for i in np.unique(self.index).tolist()]

    @property
    def file(self) -> NDArray[np.int64]:
        """The file of each row (N,): 0 is the main one."""
        return np.array([line.file for line in self.lines], np.int64)[self.index]

    @property
    def line(self) -> NDArray[np.int64]:
        """The number of each row's line (N,) in its own file, from 1."""
        return np.array([line.line for line in self.lines], np.int64)[self.index]
