"""Values -> means with intervals, and whether two means differ: paired, Welch's, Wilcoxon's test.

Student, The probable error of a mean, Biometrika 6, 1908; B. L. Welch, The generalization of
"Student's" problem when several different population variances are involved, Biometrika 34, 1947;
F. Wilcoxon, Individual comparisons by ranking methods, Biometrics Bulletin 1, 1945; S. Holm, A
simple sequentially rejective multiple test procedure, Scand. J. Statistics 6, 1979. Effect sizes:
J. Cohen, Statistical Power Analysis for the Behavioral Sciences, 1988; their intervals are those
of the noncentral t (G. Cumming and S. Finch, Educ. Psychol. Meas. 61, 2001).

`scipy.special` is imported where it is needed: it is slow, and many studies test nothing.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dqpaint.dq import Floats

FAR = 1000.0
"""A t beyond which its interval is that of a sure mean: its ends are shares of t."""
LEVEL = 0.05
"""A difference is called one where chance alone would make it in fewer than 1 of 20 studies."""
REPEATED = 1e-3
"""Runs that spread by less of their mean are as good as one run: no test speaks of them."""
SAME = 1e-9
"""Two runs whose figures differ by less, of the larger, differ by rounding."""
UNKNOWN = (math.nan, math.nan)

Interval = tuple[float, float]


@dataclass(frozen=True)
class Spread:
    """Mean, standard deviation (divided by N - 1) and median of N values; nan of too few."""

    n: int
    mean: float
    std: float
    median: float = math.nan

    @property
    def interval(self) -> Interval:
        """The 95 % interval of the mean, by Student's t; nan where it is not known."""
        if self.n < 2 or not math.isfinite(self.std):
            return UNKNOWN
        half = quantile(self.n - 1) * self.std / math.sqrt(self.n)
        return self.mean - half, self.mean + half


@dataclass(frozen=True)
class Test:
    """Whether two means differ.

    Attributes:
        t: their difference by its standard error; infinite where nothing spreads. Of Wilcoxon's
            test the smaller sum of ranks.
        freedom: degrees of freedom; of Wilcoxon's test nan.
        p: the chance of so large a difference, either way, if there were none.
        difference: the first mean less the second; of Wilcoxon's test the median of the means of
            all two differences (Hodges and Lehmann).
        interval: its 95 % interval; nan where there are too few runs for one.
        effect: the difference by a standard deviation: of the differences where they are paired
            (d_z), else the root of the mean variance of both (Cohen's d).
        effect_interval: its 95 % interval.
    """

    __test__ = False  # pytest, it is none of yours

    t: float
    freedom: float
    p: float
    difference: float = math.nan
    interval: Interval = UNKNOWN
    effect: float = math.nan
    effect_interval: Interval = UNKNOWN


def spread(values: Sequence[float]) -> Spread:
    """Mean, standard deviation and median of values (N,)."""
    n = len(values)
    if not n:
        return Spread(0, math.nan, math.nan)
    std = float(np.std(values, ddof=1)) if n > 1 else math.nan
    return Spread(n, float(np.mean(values)), std, float(np.median(values)))


def why_untested(one: Sequence[float], other: Sequence[float], paired: bool) -> str | None:
    """Why a test of two sets of runs would say nothing, or None.

    Runs that differ by rounding, or by a noise that hardly reaches them, are one run written down
    several times: each difference between two such sets is `significant`, whatever it means.

    Args:
        one: the figures of some runs (N,).
        other: of others (M,).
        paired: whether they belong together, one by one.
    """
    fewest = min(len(one), len(other))
    if fewest < 2:
        return "one run" if fewest else "no result"
    largest = max(map(abs, (*one, *other)))
    if paired and max(abs(a - b) for a, b in zip(one, other, strict=True)) <= SAME * largest:
        return "the same runs"
    if all(float(np.std(v, ddof=1)) <= REPEATED * abs(float(np.mean(v))) for v in (one, other)):
        return "hardly any spread"
    return None


def paired_t(one: Sequence[float], other: Sequence[float]) -> Test | None:
    """Student's t-test of paired values (N,), two-sided; None of fewer than 2 pairs."""
    if len(one) < 2:
        return None
    of = spread(np.subtract(one, other).tolist())
    freedom = float(of.n - 1)
    if of.std <= 1e-12 * max(map(abs, (*one, *other))):  # rounding
        return _without_spread(of.mean, float(np.mean(one)), float(np.mean(other)))
    effect = of.mean / of.std
    t = effect * math.sqrt(of.n)
    ends = _effect_interval(t, freedom, math.sqrt(of.n))
    return Test(t, freedom, two_sided(t, freedom), of.mean, of.interval, effect, ends)


def paired_verdict(one: Sequence[float], other: Sequence[float], unit: str) -> str:
    """Whether paired values (N,) differ by more than they spread, in a sentence."""
    reason = why_untested(one, other, paired=True)
    pairs = f"{len(one)} pair{'s' if len(one) != 1 else ''}"
    means = f"{np.mean(one):.4g} and {np.mean(other):.4g} {unit} over {pairs}"
    test = None if reason else paired_t(one, other)
    if test is None:
        return f"{means}: not tested, {reason or 'too few runs'}"
    low, high = test.interval
    told = f"{means}; the difference is {test.difference:.3g} {unit}"
    if math.isfinite(low):
        told += f", 95 % interval {low:.3g} to {high:.3g}"
    sure = "more than the spread" if test.p < LEVEL else "not more than the spread may make"
    return f"{told}: {sure} (p = {test.p:.2g}, paired t-test)"


def welch(one: Spread, other: Spread) -> Test | None:
    """Welch's t-test of two means, two-sided; None where one of them has fewer than 2 values."""
    if min(one.n, other.n) < 2:
        return None
    a, b = one.std**2 / one.n, other.std**2 / other.n
    difference = one.mean - other.mean
    # what only rounding spreads does not spread: equal runs would seem to differ by an ulp
    if a + b <= (1e-12 * max(abs(one.mean), abs(other.mean))) ** 2:
        return _without_spread(difference, one.mean, other.mean)
    error = math.sqrt(a + b)
    t = difference / error
    freedom = (a + b) ** 2 / (a**2 / (one.n - 1) + b**2 / (other.n - 1))
    half = quantile(freedom) * error
    unit = math.sqrt((one.std**2 + other.std**2) / 2)
    return Test(
        t, freedom, two_sided(t, freedom), difference, (difference - half, difference + half),
        difference / unit, _effect_interval(t, freedom, unit / error),
    )  # fmt: skip


def wilcoxon(one: Sequence[float], other: Sequence[float]) -> Test | None:
    """Wilcoxon's signed-rank test of paired values (N,), two-sided and exact; None of fewer than 2.

    It takes no distribution for granted but that differences are symmetric about their middle. Of
    5 pairs or fewer it cannot come below 5 %. Pairs without a difference are left out.
    """
    given = np.subtract(one, other)
    found = given[np.abs(given) > 0]
    n = len(found)
    if n < 2:
        return None
    ranks = _ranks(np.abs(found))
    sums = _signed_rank_chances(ranks)  # by twice the sum, for ranks may be halves
    low = min(float(ranks[found > 0].sum()), float(ranks[found < 0].sum()))
    p = min(1.0, 2 * float(sums[: round(2 * low) + 1].sum()))
    row, column = np.triu_indices(n)
    walsh = np.sort((found[row] + found[column]) / 2)
    exact = np.cumsum(_signed_rank_chances(np.arange(1.0, n + 1)))[::2]  # of sums 0, 1, ...
    cut = int(np.searchsorted(exact, LEVEL / 2, side="right"))  # of the walsh means, at each end
    ends = (float(walsh[cut - 1]), float(walsh[-cut])) if cut else UNKNOWN
    of = spread(given.tolist())
    effect, t = of.mean / of.std, of.mean / of.std * math.sqrt(of.n)
    about = _effect_interval(t, of.n - 1.0, math.sqrt(of.n))
    return Test(low, math.nan, p, float(np.median(walsh)), ends, effect, about)


def two_sided(t: float, freedom: float) -> float:
    """The chance that Student's t of so many degrees of freedom is at least as far from 0."""
    from scipy.special import stdtr

    return float(2 * stdtr(freedom, -abs(t)))


def quantile(freedom: float) -> float:
    """Student's t that is exceeded, either way, with the chance `LEVEL`."""
    from scipy.special import stdtrit

    return float(stdtrit(freedom, 1 - LEVEL / 2))


def holm(chances: Sequence[float]) -> list[float]:
    """Chances of several tests at once, each raised so that all together keep the level."""
    raised = [0.0] * len(chances)
    most = 0.0
    for rank, i in enumerate(sorted(range(len(chances)), key=lambda i: chances[i])):
        most = max(most, min(1.0, (len(chances) - rank) * chances[i]))
        raised[i] = most
    return raised


def _without_spread(difference: float, one: float, other: float) -> Test:
    """The test of means that do not spread: they differ surely, or not at all."""
    alike = abs(difference) <= SAME * max(abs(one), abs(other))
    t = 0.0 if alike else math.copysign(math.inf, difference)
    return Test(t, math.inf, float(alike), difference)


def _effect_interval(t: float, freedom: float, root: float) -> Interval:
    """The 95 % interval of an effect size t / root: of the noncentral t that meet t there."""
    from scipy.special import nctdtrinc

    # far out the interval grows with t, but the search for it takes minutes
    far = max(1.0, abs(t) / FAR)
    ends = (nctdtrinc(freedom, p, t / far) for p in (1 - LEVEL / 2, LEVEL / 2))
    low, high = (float(end) * far / root for end in ends)
    return (low, high) if math.isfinite(low) and math.isfinite(high) and low < high else UNKNOWN


def _ranks(values: Floats) -> Floats:
    """The ranks (N,) of values, from 1; equal values share the mean of theirs."""
    below = (values[None, :] < values[:, None]).sum(axis=1)
    same = (values[None, :] == values[:, None]).sum(axis=1)
    return np.asarray(below + (same + 1) / 2)


def _signed_rank_chances(ranks: Floats) -> Floats:
    """The chance of each sum of the ranks with a plus, by twice the sum; signs are coin flips."""
    chances = np.ones(1)
    for rank in np.rint(2 * ranks).astype(int):
        moved = np.zeros(len(chances) + rank)
        moved[: len(chances)] += chances / 2
        moved[rank:] += chances / 2
        chances = moved
    return chances
