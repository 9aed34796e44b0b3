"""Small positive definite matrices -> inverses and solutions; the only import of eigenpy.

A run inverts two 6 x 6 matrices a control step. Half of the step would go into numpy's checks of
its arguments; Eigen's Cholesky takes a fifth of numpy's time. For batches numpy's own is as good.
"""

from typing import TYPE_CHECKING

import numpy as np

from dqpaint.core import PINOCCHIO, Library
from dqpaint.dq import Floats

if TYPE_CHECKING:
    import eigenpy
else:
    eigenpy = Library("eigenpy", PINOCCHIO)

_EYES = [np.eye(n) for n in range(7)]


def inverse(squares: Floats) -> Floats:
    """The inverses of symmetric positive definite matrices (..., m, m), m at most 6.

    Raises:
        numpy.linalg.LinAlgError: a matrix is numerically singular.
    """
    if squares.ndim > 2:
        return np.asarray(np.linalg.inv(squares))
    return solve(squares, _EYES[len(squares)])


def solve(square: Floats, right: Floats) -> Floats:
    """Solve square X = right for X (m, k), with a symmetric positive definite matrix (m, m).

    Raises:
        numpy.linalg.LinAlgError: the matrix is numerically singular.
    """
    factor = eigenpy.LLT(square)
    if factor.info() != eigenpy.ComputationInfo.Success:
        raise np.linalg.LinAlgError("not positive definite")
    return np.asarray(factor.solve(right))
