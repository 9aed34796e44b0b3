"""Any array -> a checked, read-only copy; the array types and batch size of the light room."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dqpaint.core.arrays import Floats as Floats
from dqpaint.core.arrays import checked_array as checked_array

Image = NDArray[np.float32]
"""(H, W, 3) linear RGB, 1.0 = what saturates the sensor once exposed."""
Picture = NDArray[np.uint8]
"""(H, W, 3) sRGB."""
ROWS_PER_SUM = 64  # short rows that are added as one
BATCH = 1 << 15
"""Number of steps, or pieces, in one batch; it fits the processor's cache. The size is fixed, so
that sums are made in the same order on every machine."""


def sum_rows(rows: Floats) -> Floats:
    """The sum (3,) of rows (N, 3): numpy adds long rows ten times as fast as short ones."""
    whole = len(rows) - len(rows) % ROWS_PER_SUM
    long = rows[:whole].reshape(-1, 3 * ROWS_PER_SUM).sum(axis=0)
    return np.asarray(long.reshape(-1, 3).sum(axis=0) + rows[whole:].sum(axis=0))
