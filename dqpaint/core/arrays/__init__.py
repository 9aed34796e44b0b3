"""Any array -> a checked, read-only copy. Not part of `core` itself, which needs no numpy."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dqpaint.errors import DqpaintError

__all__ = ["Floats", "checked_array"]

Floats = NDArray[np.float64]


def checked_array(name: str, values: ArrayLike, shape: tuple[int | None, ...]) -> Floats:
    """A read-only float64 copy of `values`, checked.

    Args:
        name: What the values are called in an error.
        values: The numbers to copy.
        shape: The shape they must have; None stands for any length.

    Raises:
        ValueError: If the shape differs.
        DqpaintError: If a value is not finite. NaN would pass through sums and comparisons
            unnoticed and leave a picture that is merely dark.
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
