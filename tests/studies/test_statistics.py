"""Means, Welch's test and Holm's correction against numpy, published tables and integrals."""

import math

import numpy as np
import pytest
from scipy.special import chdtri

from dqpaint.studies.experiment.statistics import (
    Spread,
    holm,
    paired_t,
    paired_verdict,
    spread,
    two_sided,
    welch,
    why_untested,
    wilcoxon,
)
from tests.tools import truth

# Percentage points of Student's t, two-sided 5 % and 1 %: Abramowitz and Stegun, Table 26.10.
TABLE = {
    1: (12.706, 63.657), 2: (4.303, 9.925), 5: (2.571, 4.032), 10: (2.228, 3.169),
    30: (2.042, 2.750), 120: (1.980, 2.617),
}  # fmt: skip


@pytest.mark.parametrize("freedom", TABLE)
def test_t_against_the_published_table(freedom):
    for t, p in zip(TABLE[freedom], (0.05, 0.01), strict=True):
        assert two_sided(t, freedom) == pytest.approx(p, rel=2e-3)
        assert two_sided(-t, freedom) == two_sided(t, freedom)


@pytest.mark.parametrize("freedom", [1.7, 4.2, 9.0, 33.3])
@pytest.mark.parametrize("t", [0.05, 0.8, 2.9, 7.0])
def test_t_against_its_density_summed(t, freedom):
    norm = math.gamma((freedom + 1) / 2) / math.gamma(freedom / 2) / math.sqrt(math.pi * freedom)
    x = np.linspace(0, t, 200_001)
    inside = np.trapezoid((1 + x * x / freedom) ** (-(freedom + 1) / 2), x) * norm
    assert two_sided(t, freedom) == pytest.approx(1 - 2 * inside, abs=1e-9)


def test_spreads_are_numpy_s(rng):
    values = rng.normal(3, 2, 12).tolist()
    got = spread(values)
    assert (got.n, got.mean, got.std) == (12, np.mean(values), np.std(values, ddof=1))
    assert math.isnan(spread([1.0]).std)
    assert math.isnan(spread([]).mean)


def test_welch_on_a_known_example():
    """Two samples of unequal variance, worked out by hand in many textbooks: t, freedom, p."""
    one = [27.5, 21.0, 19.0, 23.6, 17.0, 17.9, 16.9, 20.1, 21.9, 22.6, 23.1, 19.6, 19.0, 21.7, 21.4]
    two = [27.1, 22.0, 20.8, 23.4, 23.4, 23.5, 25.8, 22.0, 24.8, 20.2, 21.9, 22.1, 22.9, 20.5, 24.4]
    test = welch(spread(one), spread(two))
    assert test.t == pytest.approx(-2.46, abs=0.005)
    assert test.freedom == pytest.approx(25.0, abs=0.05)
    assert test.p == pytest.approx(0.021, abs=5e-4)


def test_welch_errs_as_often_as_it_says(rng):
    """Of many pairs that do not differ, one in twenty seems to."""
    pairs = rng.normal(0, 1, (4000, 2, 6)) * np.array([1.0, 3.0])[:, None]
    wrong = np.mean([welch(spread(a), spread(b)).p < 0.05 for a, b in pairs])
    assert wrong == pytest.approx(0.05, abs=0.012)


def test_what_does_not_spread_differs_surely_or_not_at_all():
    assert welch(Spread(5, 1.0, 0.0), Spread(5, 1.1, 0.0)).p == 0.0
    assert welch(Spread(5, 1.0, 0.0), Spread(5, 1.0, 0.0)).p == 1.0
    assert welch(Spread(5, 1.0, 1e-17), Spread(5, 1.0 + 2e-16, 1e-17)).p == 1.0
    assert welch(Spread(1, 1.0, math.nan), Spread(5, 1.0, 0.1)) is None


def test_holm_on_a_known_example():
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert holm([0.9, 0.8]) == [1.0, 1.0]
    assert holm([]) == []


@pytest.mark.parametrize("n", [2, 3, 8, 25])
def test_paired_and_welch_with_intervals_are_scipy_s(rng, n):
    from scipy import stats

    for _ in range(5):
        one, other = rng.normal(2, 1.5, n), rng.normal(1, 0.5, n)
        pair, theirs = paired_t(one, other), stats.ttest_rel(one, other)
        apart, unpaired = (
            welch(spread(one), spread(other)),
            stats.ttest_ind(one, other, equal_var=False),
        )
        for test, known in ((pair, theirs), (apart, unpaired)):
            assert (test.t, test.p) == pytest.approx((known.statistic, known.pvalue), rel=1e-9)
            assert test.interval == pytest.approx(tuple(known.confidence_interval()), rel=1e-9)
            assert test.difference == pytest.approx(one.mean() - other.mean())
        assert spread(one).interval == pytest.approx(
            stats.t.interval(0.95, n - 1, one.mean(), stats.sem(one)), rel=1e-9
        )
        assert pair.effect == pytest.approx((one - other).mean() / (one - other).std(ddof=1))
        unit = np.sqrt((one.var(ddof=1) + other.var(ddof=1)) / 2)
        assert apart.effect == pytest.approx((one.mean() - other.mean()) / unit)


@pytest.mark.parametrize("n", [2, 5, 6, 9, 17])
def test_wilcoxon_is_exact(rng, n):
    from scipy import stats

    for _ in range(5):
        one, other = rng.normal(0.5, 1, n), rng.normal(0, 2, n)
        test, known = wilcoxon(one, other), stats.wilcoxon(one, other, method="exact")
        assert (test.t, test.p) == pytest.approx((known.statistic, known.pvalue), rel=1e-12)
        low, high = test.interval
        if n < 6:  # it cannot come below 5 %, so there is no such interval
            assert math.isnan(low)
            continue
        inside, outside = 1e-9, -1e-9  # the shifts that the test does not refuse are the interval
        for end, sign in ((low, 1), (high, -1)):
            assert stats.wilcoxon(one - other - end - sign * inside, method="exact").pvalue > 0.05
            assert stats.wilcoxon(one - other - end - sign * outside, method="exact").pvalue < 0.05


@pytest.mark.parametrize("n", [3, 10])
def test_the_interval_of_an_effect_is_that_of_the_noncentral_t(rng, n):
    from scipy import stats

    one, other = rng.normal(2, 1, n), rng.normal(1, 1, n)
    test = paired_t(one, other)
    for end, chance in zip(test.effect_interval, (0.975, 0.025), strict=True):
        assert stats.nct.cdf(test.t, n - 1, end * n**0.5) == pytest.approx(chance, abs=1e-4)


def test_runs_that_hardly_differ_are_not_tested(rng):
    noisy, other = rng.normal(2, 0.3, 8).tolist(), rng.normal(1, 0.3, 8).tolist()
    fixed, near = (2 + 1e-5 * rng.normal(0, 1, (2, 8))).tolist()
    assert why_untested(noisy, other, True) is None
    assert why_untested(fixed, other, True) is None  # what the other spreads by is a spread
    assert why_untested(fixed, near, True) == "hardly any spread"
    assert why_untested(fixed, near, False) == "hardly any spread"
    assert why_untested(noisy, noisy, True) == "the same runs"
    assert why_untested([1.0], other, False) == "one run"
    assert why_untested([], other, False) == "no result"


@pytest.mark.slow
def test_intervals_and_tests_keep_what_they_promise():
    """A few hundred of the trials of `tests.tools.truth`, in the same code."""
    found = truth.measure(trials=1500, seed=3)
    for name in ("mean", "paired difference", "difference of unequal spreads"):
        assert found[f"coverage: {name}"] == pytest.approx(0.95, abs=0.02), name
    assert found["family-wise error: 6 laws, 15 paired tests"] <= 0.05 + 0.015
    shown = "22 % by three seeds is shown: paired, "
    assert found[f"{shown}alone"] > 0.9
    assert found[f"{shown}among all 66 pairs"] < 0.2


def test_effects_far_beyond_chance_have_intervals_at_once():
    """There the ends are t sqrt(chi2 / freedom), by scipy's chi-squared; the search would hang."""
    one, other = Spread(10, 1.0005, 1e-9), Spread(10, 1.0, 1e-9)
    found = welch(one, other)
    ends = found.effect * np.sqrt(chdtri(18, [1 - 0.025, 0.025]) / 18)
    np.testing.assert_allclose(found.effect_interval, np.sort(ends), rtol=1e-3)


def test_why_nothing_is_said_of_two_sets_is_said():
    assert paired_verdict([1.0], [2.0], "mm") == "1 and 2 mm over 1 pair: not tested, one run"
    assert "1.5 and 1.5 mm over 2 pairs: not tested" in paired_verdict([1, 2], [1, 2], "mm")
    told = paired_verdict([1.0, 1.2, 0.9, 1.1], [2.0, 2.3, 1.9, 2.2], "mm")
    assert "not tested" not in told
    assert "difference is -1.05 mm" in told
