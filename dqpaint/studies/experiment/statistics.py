"""Means, spreads, and whether two of them differ: Welch's t-test, corrected after Holm.

B. L. Welch, The generalization of "Student's" problem when several different population variances
are involved, Biometrika 34, 1947; S. Holm, A simple sequentially rejective multiple test procedure,
Scand. J. Statistics 6, 1979. The distribution of t is an incomplete beta function, worked out as a
continued fraction (Abramowitz and Stegun 26.5.8, 26.7.1).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

LEVEL = 0.05
"""A difference is called one where chance alone would make it in fewer than 1 of 20 studies."""
TINY = 1e-300


@dataclass(frozen=True)
class Spread:
    """Mean and standard deviation (divided by N - 1) of N values; nan where there are too few."""

    n: int
    mean: float
    std: float


@dataclass(frozen=True)
class Test:
    """Whether two means differ.

    Attributes:
        t: their difference by its standard error; infinite where nothing spreads.
        freedom: degrees of freedom after Welch and Satterthwaite.
        p: the chance of so large a difference, either way, if there were none.
    """

    t: float
    freedom: float
    p: float


def spread(values: Sequence[float]) -> Spread:
    """Mean and standard deviation of values (N,)."""
    n = len(values)
    mean = float(np.mean(values)) if n else math.nan
    return Spread(n, mean, float(np.std(values, ddof=1)) if n > 1 else math.nan)


def welch(one: Spread, other: Spread) -> Test | None:
    """Welch's t-test of two means, two-sided; None where one of them has fewer than 2 values."""
    if min(one.n, other.n) < 2:
        return None
    a, b = one.std**2 / one.n, other.std**2 / other.n
    difference = one.mean - other.mean
    # what only rounding spreads does not spread: equal runs would seem to differ by an ulp
    if a + b <= (1e-12 * max(abs(one.mean), abs(other.mean))) ** 2:
        alike = abs(difference) <= 1e-9 * max(abs(one.mean), abs(other.mean))
        return Test(0.0 if alike else math.copysign(math.inf, difference), math.inf, float(alike))
    t = difference / math.sqrt(a + b)
    freedom = (a + b) ** 2 / (a**2 / (one.n - 1) + b**2 / (other.n - 1))
    return Test(t, freedom, two_sided(t, freedom))


def two_sided(t: float, freedom: float) -> float:
    """The chance that Student's t of so many degrees of freedom is at least as far from 0."""
    return incomplete_beta(freedom / (freedom + t * t), freedom / 2, 0.5)


def holm(chances: Sequence[float]) -> list[float]:
    """Chances of several tests at once, each raised so that all together keep the level."""
    raised = [0.0] * len(chances)
    most = 0.0
    for rank, i in enumerate(sorted(range(len(chances)), key=lambda i: chances[i])):
        most = max(most, min(1.0, (len(chances) - rank) * chances[i]))
        raised[i] = most
    return raised


def incomplete_beta(x: float, a: float, b: float) -> float:
    """The regularised incomplete beta function I_x(a, b), 0 <= x <= 1, a and b positive."""
    if x <= 0 or x >= 1:
        return float(x >= 1)
    if x > (a + 1) / (a + b + 2):  # where the fraction converges slowly, the other end's is fast
        return 1 - incomplete_beta(1 - x, b, a)
    log = math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b)
    front = math.exp(log + a * math.log(x) + b * math.log1p(-x)) / a
    return front / _fraction(x, a, b)


def _fraction(x: float, a: float, b: float) -> float:
    """1 + d1 / (1 + d2 / (1 + ...)) after Lentz, up from the front until it no longer changes."""
    value, c, d = 1.0, 1.0, 0.0
    for i in range(1, 10_000):
        m = i // 2
        if i % 2:
            term = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))
        else:
            term = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
        d = 1 / _nonzero(1 + term * d)
        c = _nonzero(1 + term / c)
        value *= c * d
        if abs(c * d - 1) < 1e-15:
            break
    return value


def _nonzero(value: float) -> float:
    return value if abs(value) > TINY else TINY
