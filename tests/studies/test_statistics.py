"""Means, Welch's test and Holm's correction against numpy, published tables and integrals."""

import math

import numpy as np
import pytest

from dqpaint.studies.experiment.statistics import (
    Spread,
    holm,
    spread,
    two_sided,
    welch,
)

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
