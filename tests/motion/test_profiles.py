"""Profiles: ends, peaks, boundary rates, and the cruising time."""

import numpy as np
import pytest

from dqpaint.language.vocabulary import words
from dqpaint.motion.profiles import PEAK, PROFILES, cruise_time, peak_rate, scale_rates

TAU = np.linspace(0, 1, 100_001)
RATES = {"constant": (), "trapezoid": (), "cubic": (0.3, -0.4), "quintic": (0.3, -0.4, 0.7, -0.2)}


def test_the_language_and_the_profiles_know_the_same_names():
    assert set(PROFILES) == set(words.PROFILES) == set(PEAK)


@pytest.mark.parametrize("name", PROFILES)
def test_profiles_run_from_0_to_1_and_peak_as_stated(name):
    profile = PROFILES[name](TAU, ())
    assert profile.value[0] == 0
    assert profile.value[-1] == pytest.approx(1, abs=1e-14)
    assert profile.rate.max() == pytest.approx(PEAK[name], abs=1e-8)
    np.testing.assert_allclose(np.gradient(profile.value, TAU)[1:-1], profile.rate[1:-1], atol=1e-4)


@pytest.mark.parametrize("name", ["cubic", "quintic"])
def test_boundary_rates_are_kept(name):
    rates = RATES[name]
    profile = PROFILES[name](TAU, rates)
    assert (profile.value[0], profile.value[-1]) == pytest.approx((0, 1), abs=1e-13)
    assert (profile.rate[0], profile.rate[-1]) == pytest.approx(rates[:2], abs=1e-13)
    if name == "quintic":
        assert (profile.slope[0], profile.slope[-1]) == pytest.approx(rates[2:], abs=1e-12)
    assert peak_rate(name, rates) == pytest.approx(np.abs(profile.rate).max(), rel=1e-7)


@pytest.mark.parametrize(("name", "rates"), [
    ("constant", ()), ("trapezoid", ()), ("cubic", ()), ("quintic", ()),
    ("cubic", (0.2, 0.0)), ("cubic", (0.9, 0.9)), ("cubic", (-0.9, -0.9)), ("cubic", (-0.5, 0.1)),
    ("quintic", (0.1, 0.3, 0.05, -0.1)),
])  # fmt: skip
def test_cruising_never_exceeds_the_speed_and_wastes_no_time(name, rates):
    least = np.array(1.7)  # path over speed: the speed is 1 / 1.7 of the path a second
    time = cruise_time(name, tuple(r / least for r in rates), least)
    end_rates = tuple(r / least for r in rates)
    rate = np.abs(PROFILES[name](TAU, scale_rates(end_rates, time)).rate).max() / time
    assert rate <= 1 / least * (1 + 1e-6)
    assert rate >= 1 / least * (1 - 1e-6)


@pytest.mark.parametrize("rates", [(-3.0, 0.5), (0.5, -3.0)])
def test_the_peak_of_a_profile_that_runs_backwards_is_its_fastest_either_way(rates):
    assert peak_rate("cubic", rates) == pytest.approx(
        np.abs(PROFILES["cubic"](TAU, rates).rate).max()
    )


def test_an_end_faster_than_the_speed_has_no_time():
    assert np.isnan(cruise_time("cubic", (2.0, 0.0), np.array(1.0)))
