"""A formula of one parameter -> its Taylor series and exact derivatives.

`Taylor` holds a function's value and its scaled derivatives f', f''/2!, f'''/3! at many parameter
values at once. Sums, products and functions follow the classic recurrences of automatic
differentiation (Griewank and Walther, Evaluating Derivatives, chapter 13). The functions of this
module take a plain float as well, so one evaluator serves both.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

ORDER = 3  # a tool that follows a curve's heading needs three derivatives for its acceleration
Floats = NDArray[np.float64]
FACTORIALS = np.array([[1.0], [1.0], [2.0], [6.0]])
Scalar = int | float


class Taylor:
    """A function of one parameter about N points: `coefficients` (K + 1, N), c_k = f^(k) / k!.

    K is 3, or less where fewer derivatives are needed.
    """

    __slots__ = ("coefficients",)
    __array_ufunc__ = None  # numpy leaves the operators to this class

    def __init__(self, coefficients: Floats) -> None:
        self.coefficients = coefficients

    @classmethod
    def variable(cls, at: Floats, order: int = ORDER) -> Taylor:
        """The parameter itself at the values `at` (N,), with derivatives up to `order`."""
        c = np.zeros((order + 1, len(at)))
        c[0], c[1] = at, 1.0
        return cls(c)

    @property
    def derivatives(self) -> Floats:
        """The derivatives f, f', f'', f''', (K + 1, N)."""
        return np.asarray(self.coefficients * FACTORIALS[: len(self.coefficients)])

    def _constant(self, value: Scalar) -> Taylor:
        c = np.zeros_like(self.coefficients)
        c[0] = value
        return Taylor(c)

    def __neg__(self) -> Taylor:
        return Taylor(-self.coefficients)

    def __pos__(self) -> Taylor:
        return self

    def __add__(self, other: Taylor | Scalar) -> Taylor:
        other = other if isinstance(other, Taylor) else self._constant(other)
        return Taylor(self.coefficients + other.coefficients)

    __radd__ = __add__

    def __sub__(self, other: Taylor | Scalar) -> Taylor:
        return self + (-other)

    def __rsub__(self, other: Scalar) -> Taylor:
        return (-self) + other

    def __mul__(self, other: Taylor | Scalar) -> Taylor:
        if not isinstance(other, Taylor):
            return Taylor(self.coefficients * other)
        a, b = self.coefficients, other.coefficients
        return Taylor(np.stack([sum(a[j] * b[k - j] for j in range(k + 1)) for k in range(len(a))]))

    __rmul__ = __mul__

    def __truediv__(self, other: Taylor | Scalar) -> Taylor:
        if not isinstance(other, Taylor):
            return Taylor(self.coefficients / other)
        a, b = self.coefficients, other.coefficients
        q = np.zeros_like(a)
        for k in range(len(a)):
            q[k] = (a[k] - sum(q[j] * b[k - j] for j in range(k))) / b[0]
        return Taylor(q)

    def __rtruediv__(self, other: Scalar) -> Taylor:
        return self._constant(other) / self


Value = Taylor | float


def _integrate(first: Floats, slope: Callable[[Floats, int], Floats], like: Floats) -> Taylor:
    """The series with c_0 = `first` and k c_k = `slope(c, k)`, term by term."""
    c = np.zeros_like(like)
    c[0] = first
    for k in range(1, len(c)):
        c[k] = slope(c, k) / k
    return Taylor(c)


def exp(x: Value) -> Value:
    """The exponential function."""
    if not isinstance(x, Taylor):
        return math.exp(x)
    a = x.coefficients
    return _integrate(
        np.exp(a[0]), lambda c, k: sum(j * a[j] * c[k - j] for j in range(1, k + 1)), a
    )


def ln(x: Value) -> Value:
    """Natural logarithm."""
    if not isinstance(x, Taylor):
        return math.log(x)
    return _from_slope(np.log(x.coefficients[0]), 1.0 / x, x)


def _from_slope(first: Floats, outer: Taylor | Scalar, x: Taylor) -> Taylor:
    """The series f(x) with value `first`, where f'(x) is the series `outer`."""
    a = x.coefficients
    slope = Taylor(np.vstack([a[1:] * np.arange(1, len(a))[:, None], np.zeros_like(a[:1])]))
    product = (slope * outer).coefficients
    return _integrate(first, lambda _c, k: product[k - 1], a)


def _sin_cos(x: Taylor) -> tuple[Taylor, Taylor]:
    a = x.coefficients
    s, c = np.zeros_like(a), np.zeros_like(a)
    s[0], c[0] = np.sin(a[0]), np.cos(a[0])
    for k in range(1, len(a)):
        s[k] = sum(j * a[j] * c[k - j] for j in range(1, k + 1)) / k
        c[k] = -sum(j * a[j] * s[k - j] for j in range(1, k + 1)) / k
    return Taylor(s), Taylor(c)


def sin(x: Value) -> Value:
    """Sine of an angle in rad."""
    return _sin_cos(x)[0] if isinstance(x, Taylor) else math.sin(x)


def cos(x: Value) -> Value:
    """Cosine of an angle in rad."""
    return _sin_cos(x)[1] if isinstance(x, Taylor) else math.cos(x)


def tan(x: Value) -> Value:
    """Tangent of an angle in rad."""
    if not isinstance(x, Taylor):
        return math.tan(x)
    s, c = _sin_cos(x)
    return s / c


def sqrt(x: Value) -> Value:
    """Square root."""
    if not isinstance(x, Taylor):
        return math.sqrt(x)
    a = x.coefficients
    r = np.zeros_like(a)
    r[0] = np.sqrt(a[0])
    for k in range(1, len(a)):
        r[k] = (a[k] - sum(r[j] * r[k - j] for j in range(1, k))) / (2 * r[0])
    return Taylor(r)


def asin(x: Value) -> Value:
    """The angle in rad, from -pi/2 to pi/2, with this sine."""
    if not isinstance(x, Taylor):
        return math.asin(x)
    return _from_slope(np.arcsin(x.coefficients[0]), 1.0 / _root(1.0 - x * x), x)


def acos(x: Value) -> Value:
    """The angle in rad, from 0 to pi, with this cosine."""
    if not isinstance(x, Taylor):
        return math.acos(x)
    return _from_slope(np.arccos(x.coefficients[0]), -1.0 / _root(1.0 - x * x), x)


def atan(x: Value) -> Value:
    """The angle in rad, from -pi/2 to pi/2, with this tangent."""
    if not isinstance(x, Taylor):
        return math.atan(x)
    return _from_slope(np.arctan(x.coefficients[0]), 1.0 / (1.0 + x * x), x)


def _root(x: Taylor) -> Taylor:
    root = sqrt(x)
    assert isinstance(root, Taylor)
    return root


def power(x: Value, y: Value) -> Value:
    """X to the power y. An integer exponent takes any base, another exponent a positive base."""
    if not isinstance(x, Taylor) and not isinstance(y, Taylor):
        result = x**y
        if isinstance(result, complex):
            raise ValueError("a negative number to a non-integer power")
        return float(result)
    if isinstance(x, Taylor) and not isinstance(y, Taylor) and float(y).is_integer():
        return _whole_power(x, int(y))
    return exp(y * ln(x))


def _whole_power(x: Taylor, n: int) -> Taylor:
    if n < 0:
        return 1.0 / _whole_power(x, -n)
    result, square = x._constant(1.0), x
    while n:
        if n & 1:
            result = result * square
        square, n = square * square, n >> 1
    return result


def _choose(x: Value, y: Value, first: NDArray[np.bool_]) -> Taylor:
    """The series `x` where `first` is true, else `y`; at least one of them is a series."""
    like = x if isinstance(x, Taylor) else y
    assert isinstance(like, Taylor)
    series = [v if isinstance(v, Taylor) else like._constant(v) for v in (x, y)]
    return Taylor(np.where(first, series[0].coefficients, series[1].coefficients))


def _first(x: Value) -> Floats:
    return x.coefficients[0] if isinstance(x, Taylor) else np.array(x)


def minimum(x: Value, y: Value) -> Value:
    """The smaller of two; where they are equal, with the derivatives of the first."""
    if not isinstance(x, Taylor) and not isinstance(y, Taylor):
        return min(x, y)
    return _choose(x, y, _first(x) <= _first(y))


def maximum(x: Value, y: Value) -> Value:
    """The larger of two; where they are equal, with the derivatives of the first."""
    if not isinstance(x, Taylor) and not isinstance(y, Taylor):
        return max(x, y)
    return _choose(x, y, _first(x) >= _first(y))


def absolute(x: Value) -> Value:
    """The absolute value."""
    return maximum(x, -x)
