"""Values -> means, standard deviations, and whether two differ: Welch's t-test, Holm corrected.

B. L. Welch, The generalization of "Student's" problem when several different population variances
are involved, Biometrika 34, 1947; S. Holm, A simple sequentially rejective multiple test procedure,
Scand. J. Statistics 6, 1979.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

LEVEL = 0.05
"""A difference is called one where chance alone would make it in fewer than 1 of 20 studies."""


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
    from scipy.special import stdtr  # slow to import, and many studies test nothing

    return float(2 * stdtr(freedom, -abs(t)))


def holm(chances: Sequence[float]) -> list[float]:
    """Chances of several tests at once, each raised so that all together keep the level."""
    raised = [0.0] * len(chances)
    most = 0.0
    for rank, i in enumerate(sorted(range(len(chances)), key=lambda i: chances[i])):
        most = max(most, min(1.0, (len(chances) - rank) * chances[i]))
        raised[i] = most
    return raised
