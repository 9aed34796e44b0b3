"""A gain as a number, a diagonal or a matrix -> its checked value, and its product with an error.

    20                         k I
    1,1,1,4,4,4                a diagonal
    2,1,0; 1,2,0; 0,0,3        a matrix, row by row

In Python and in files a diagonal is a list or an array, a matrix a list of rows or an array.
"""

from collections.abc import Callable
from functools import partial
from typing import Annotated, Any

import numpy as np
from pydantic import PlainValidator

from dqpaint.dq import Floats

LEAST_GAIN, LARGEST_GAIN = 1e-9, 1e9  # beyond these a gain is a slip, its reciprocal no number soon
ASYMMETRY = 1e-9  # of a matrix's largest element: rounding
Row = tuple[float, ...]
Value = float | Row | tuple[Row, ...]


def read_value(given: Any, size: int, least: float = LEAST_GAIN, symmetric: bool = True) -> Value:
    """A gain of `size` components, checked: k I, a diagonal or a matrix that is positive definite.

    Args:
        given: a number, `size` numbers, or `size` rows of them; also arrays.
        size: of the error it multiplies.
        least: the least eigenvalue that a matrix may have, and the least number.
        symmetric: whether a matrix has to be symmetric; if not, its symmetric part is what has to
            be positive definite.

    Raises:
        ValueError: it is none of these; a reason that follows the gain's name.
    """
    forms = f"a number, a diagonal of {size} or a matrix of {size} x {size}"
    if isinstance(given, str | bool) or given is None:
        raise ValueError(f"is {given!r}; it is {forms}")
    try:
        found = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"is not made of numbers in rows of one length; it is {forms}") from None
    if found.shape not in ((), (size,), (size, size)):
        shown = " x ".join(map(str, found.shape)) + (" numbers" if found.ndim == 1 else "")
        raise ValueError(f"has {shown}; it is {forms}")
    if found.ndim == 2:
        _check_matrix(found, least, symmetric)
    else:
        for number in found.ravel().tolist():
            if not least <= number <= LARGEST_GAIN:
                raise ValueError(f"is {number:g}; a number is from {least:g} to {LARGEST_GAIN:g}")
    return as_value(found)


def _check_matrix(matrix: Floats, least: float, symmetric: bool) -> None:
    largest = np.abs(matrix).max()
    if not largest <= LARGEST_GAIN:
        raise ValueError(f"has the element {largest:g}; one is at most {LARGEST_GAIN:g}")
    uneven = np.abs(matrix - matrix.T)
    if symmetric and uneven.max() > ASYMMETRY * largest:
        i, j = np.unravel_index(uneven.argmax(), uneven.shape)
        raise ValueError(
            f"is not symmetric, as its proof of stability needs it: {matrix[i, j]:g} in row "
            f"{i + 1}, column {j + 1}, but {matrix[j, i]:g} in row {j + 1}, column {i + 1}"
        )
    lowest = least_eigenvalue(as_value(matrix))
    if not lowest >= least - 1e-12 * largest:
        part = "" if symmetric else " of its symmetric part"
        raise ValueError(
            f"is not positive definite: {lowest:.6g} is the least eigenvalue{part}, "
            f"which has to be {least:g} or more"
        )


def sized(size: int, symmetric: bool = True) -> PlainValidator:
    """The validator of a field that holds such a gain."""
    check: Callable[[Any], Value] = partial(read_value, size=size, symmetric=symmetric)
    return PlainValidator(check)


Gain3 = Annotated[Value, sized(3)]
Gain6 = Annotated[Value, sized(6)]
Gain8 = Annotated[Value, sized(8)]


def as_value(array: Any) -> Value:
    """A number, a tuple, or a tuple of rows, from an array."""
    found: Any = np.asarray(array, dtype=np.float64).tolist()
    if not isinstance(found, list):
        return float(found)
    return tuple(tuple(one) if isinstance(one, list) else one for one in found)


def times(gain: Value, error: Floats) -> Floats:
    """K e (..., m) of errors (..., m)."""
    if isinstance(gain, float | int):
        return np.asarray(gain * error)
    K = np.asarray(gain)
    return np.asarray(K * error if K.ndim == 1 else np.matvec(K, error))


def matrix(gain: Value, size: int) -> Floats:
    """The matrix K (size, size) of a gain."""
    K = np.asarray(gain, dtype=np.float64)
    return K if K.ndim == 2 else np.diag(np.broadcast_to(K, (size,)))


def least_eigenvalue(gain: Value) -> float:
    """Of the symmetric part of K: e' K e is at least this times |e|^2."""
    K = np.asarray(gain, dtype=np.float64)
    return float(np.linalg.eigvalsh((K + K.T) / 2)[0] if K.ndim == 2 else K.min())


def gain_text(value: Value) -> str:
    """A gain as it is written on the command line."""
    if isinstance(value, float | int):
        return f"{value:.6g}"
    return (";" if isinstance(value[0], tuple) else ",").join(gain_text(part) for part in value)


def parse_value(text: str) -> Value:
    """The gain of a text: numbers with commas between, rows with semicolons.

    Raises:
        ValueError: it is none.
    """
    rows = [tuple(float(number) for number in row.split(",")) for row in text.split(";")]
    if len(rows) > 1:
        return tuple(rows)
    return rows[0][0] if len(rows[0]) == 1 else rows[0]


def widened(values: list[Value]) -> list[Value]:
    """Values of one gain in one form: a number stands for k I, a diagonal for its matrix.

    Raises:
        ValueError: they are of several sizes.
    """
    arrays = [np.asarray(value, dtype=np.float64) for value in values]  # ragged rows: ValueError
    rank = max(array.ndim for array in arrays)
    if rank == 0:
        return values
    size = max(array.shape[0] for array in arrays if array.ndim)
    if rank == 2:
        return [as_value(matrix(value, size)) for value in values]
    return [as_value(np.broadcast_to(array, (size,))) for array in arrays]
