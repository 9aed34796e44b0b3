"""Time laws: ends, peaks, boundary rates, and the cruising time."""

import numpy as np
import pytest

from dqpaint.language.vocabulary import words
from dqpaint.motion.profiles import LAWS, PEAK, cruise_time, peak_rate, scale_rates

TAU = np.linspace(0, 1, 100_001)
RATES = {"constant": (), "trapezoid": (), "cubic": (0.3, -0.4), "quintic": (0.3, -0.4, 0.7, -0.2)}


def test_the_language_and_the_laws_know_the_same_names():
    assert set(LAWS) == set(words.LAWS) == set(PEAK)


@pytest.mark.parametrize("name", LAWS)
def test_laws_run_from_0_to_1_and_peak_as_stated(name):
    law = LAWS[name](TAU, ())
    assert law.value[0] == 0
    assert law.value[-1] == pytest.approx(1, abs=1e-14)
    assert law.rate.max() == pytest.approx(PEAK[name], abs=1e-8)
    np.testing.assert_allclose(np.gradient(law.value, TAU)[1:-1], law.rate[1:-1], atol=1e-4)


@pytest.mark.parametrize("name", ["cubic", "quintic"])
def test_boundary_rates_are_kept(name):
    rates = RATES[name]
    law = LAWS[name](TAU, rates)
    assert (law.value[0], law.value[-1]) == pytest.approx((0, 1), abs=1e-13)
    assert (law.rate[0], law.rate[-1]) == pytest.approx(rates[:2], abs=1e-13)
    if name == "quintic":
        assert (law.slope[0], law.slope[-1]) == pytest.approx(rates[2:], abs=1e-12)
    assert peak_rate(name, rates) == pytest.approx(np.abs(law.rate).max(), rel=1e-7)


@pytest.mark.parametrize(("name", "rates"), [
    ("constant", ()), ("trapezoid", ()), ("cubic", ()), ("quintic", ()),
    ("cubic", (0.2, 0.0)), ("cubic", (0.9, 0.9)), ("cubic", (-0.9, -0.9)), ("cubic", (-0.5, 0.1)),
    ("quintic", (0.1, 0.3, 0.05, -0.1)),
])  # fmt: skip
def test_cruising_never_exceeds_the_speed_and_wastes_no_time(name, rates):
    least = np.array(1.7)  # path over speed: the speed is 1 / 1.7 of the path a second
    time = cruise_time(name, tuple(r / least for r in rates), least)
    end_rates = tuple(r / least for r in rates)
    rate = np.abs(LAWS[name](TAU, scale_rates(end_rates, time)).rate).max() / time
    assert rate <= 1 / least * (1 + 1e-6)
    assert rate >= 1 / least * (1 - 1e-6)


@pytest.mark.parametrize("rates", [(-3.0, 0.5), (0.5, -3.0)])
def test_the_peak_of_a_law_that_runs_backwards_is_its_fastest_either_way(rates):
    assert peak_rate("cubic", rates) == pytest.approx(np.abs(LAWS["cubic"](TAU, rates).rate).max())


def test_an_end_faster_than_the_speed_has_no_time():
    assert np.isnan(cruise_time("cubic", (2.0, 0.0), np.array(1.0)))
