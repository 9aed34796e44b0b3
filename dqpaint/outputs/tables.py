"""Columns -> the text of a CSV file."""

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from dqpaint.metrics import Table

CHUNK = 8192  # rows of a table that are written at once


def encode_csv(table: "Table") -> bytes:
    """Columns as a CSV file with 12 digits."""
    row = ",".join(["%.12g"] * len(table)) + "\n"
    parts = [",".join(table) + "\n"]
    columns = list(table.values())
    for first in range(0, len(columns[0]), CHUNK):  # text of its own size, not lists of numbers
        rows = np.stack([column[first : first + CHUNK] for column in columns], axis=1).tolist()
        parts.append("".join([row % tuple(values) for values in rows]))
    return "".join(parts).encode()
