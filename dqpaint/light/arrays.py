"""Array types of the light and the size of its batches; any array -> a checked, read-only copy."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dqpaint.errors import DqpaintError

Floats = NDArray[np.float64]
Image = NDArray[np.float32]
"""(H, W, 3) linear RGB, 1.0 = what saturates the sensor once exposed."""
Picture = NDArray[np.uint8]
"""(H, W, 3) sRGB."""
ROWS_PER_SUM = 64  # short rows that are added as one
BATCH = 1 << 15
"""How many steps, or pieces, are worked on at once: what fits the cache. It is fixed, so that sums
are made in the same order whatever machine they are made on."""


def checked_array(name: str, values: ArrayLike, shape: tuple[int | None, ...]) -> Floats:
    """A read-only float64 copy of `values`, checked.

    Args:
        name: What the values are called in an error.
        values: The numbers to keep.
        shape: The shape they must have; None stands for any length.

    Raises:
        ValueError: If the shape differs.
        DqpaintError: If a value is not finite. A number that is not one would pass through sums
            and comparisons unseen and leave a picture that looks merely dark.
    """
    array = np.array(values, dtype=np.float64, order="C")
    if len(array.shape) != len(shape) or any(
        want is not None and want != have for want, have in zip(shape, array.shape, strict=True)
    ):
        raise ValueError(f"{name} has shape {array.shape}, not {shape}")
    finite = np.isfinite(array)
    if not finite.all():
        where = tuple(int(i) for i in np.argwhere(~finite)[0])
        raise DqpaintError(f"{name} {array[where]} at {where} is not finite")
    array.setflags(write=False)
    return array


def sum_rows(rows: Floats) -> Floats:
    """(3,) the sum of rows (N, 3): numpy adds long rows ten times as fast as short ones."""
    whole = len(rows) - len(rows) % ROWS_PER_SUM
    long = rows[:whole].reshape(-1, 3 * ROWS_PER_SUM).sum(axis=0)
    return np.asarray(long.reshape(-1, 3).sum(axis=0) + rows[whole:].sum(axis=0))
