"""Array types of the light, the size of its batches, and sums of long rows."""

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
"""How many steps, or pieces, are worked on at once: what fits the cache. It is fixed, so that sums
are made in the same order whatever machine they are made on."""


def sum_rows(rows: Floats) -> Floats:
    """(3,) the sum of rows (N, 3): numpy adds long rows ten times as fast as short ones."""
    whole = len(rows) - len(rows) % ROWS_PER_SUM
    long = rows[:whole].reshape(-1, 3 * ROWS_PER_SUM).sum(axis=0)
    return np.asarray(long.reshape(-1, 3).sum(axis=0) + rows[whole:].sum(axis=0))
