"""The detector on signals of known truth: how often it finds, and how often it is fooled."""

import numpy as np
import pytest
from scipy.signal import lfilter

from dqpaint.metrics.oscillation import find_oscillation

PERIOD = 0.008
TRIALS = 200


def trials(rng, rows, make, excite=lambda rows: np.zeros((rows, 3)), least=0.1):
    """The share of trials in which an oscillation is found."""
    found = [find_oscillation(make(rows), excite(rows), PERIOD, least) for _ in range(TRIALS)]
    return np.mean([one is not None for one in found])


def cycle(rng, frequency, rms=1.0, wander=0.0):
    """A sine in a random direction whose phase wanders by so many radians in each cycle."""

    def make(rows):
        steps = wander * np.sqrt(frequency * PERIOD) * rng.standard_normal(rows)
        phase = 2 * np.pi * (frequency * PERIOD * np.arange(rows) + rng.uniform()) + steps.cumsum()
        way = rng.standard_normal(3)
        return rms * np.sqrt(2) * np.sin(phase)[:, None] * way / np.linalg.norm(way)

    return make


@pytest.mark.parametrize("frequency", [2.0, 5.0, 12.0, 31.0, 60.0])
@pytest.mark.parametrize("rows", [320, 1500])
def test_cycles_are_found_beside_as_much_noise(rng, rows, frequency):
    make = cycle(rng, frequency, wander=0.15)
    noise = 0.5 / np.sqrt(3)
    assert trials(rng, rows, lambda n: make(n) + noise * rng.standard_normal((n, 3))) > 0.97


@pytest.mark.parametrize("rows", [64, 320, 1500])
def test_white_noise_is_none(rng, rows):
    assert trials(rng, rows, lambda n: rng.standard_normal((n, 3))) < 0.01


@pytest.mark.parametrize("pole", [0.5, -0.5, 0.9])
def test_noise_through_a_damped_loop_is_none(rng, pole):
    def make(rows):
        return lfilter([1 - abs(pole)], [1, -pole], rng.standard_normal((rows, 3)), axis=0)

    assert trials(rng, 600, make) < 0.02


def test_ringing_that_dies_away_is_none_and_one_that_grows_is(rng):
    sine = cycle(rng, 12.0)

    def shaped(rate):
        return lambda rows: np.exp(rate * PERIOD * np.arange(rows))[:, None] * sine(rows)

    assert trials(rng, 600, shaped(-1.0), least=1e-3) < 0.01
    assert trials(rng, 600, shaped(1.0), least=1e-3) > 0.99
    assert trials(rng, 600, shaped(0.0), least=1e-3) > 0.99


def test_ringing_after_corners_is_none(rng):
    def corners(rows):
        hits = np.zeros((rows, 3))
        hits[rng.choice(rows - 60, 4, replace=False)] = rng.standard_normal((4, 3))
        pole = np.exp((-0.1 + 1j) * 60 * PERIOD)  # springs of 60 rad/s, damping 0.1
        return lfilter([1.0], [1, -2 * pole.real, abs(pole) ** 2], hits, axis=0)

    assert trials(rng, 1200, corners, least=1e-3) < 0.05


def test_the_answer_to_an_excitation_is_none_up_to_four_times_as_large(rng):
    excitation = cycle(rng, 12.0)(600)
    for gain, found in ((0.9, False), (3.0, False), (12.0, True)):
        deviation = gain * excitation + 0.01 * rng.standard_normal((600, 3))
        assert (find_oscillation(deviation, excitation, PERIOD, 0.1) is not None) == found


def test_frequency_and_amplitude_are_those_of_the_sine(rng):
    found = find_oscillation(cycle(rng, 12.0)(600), np.zeros((600, 3)), PERIOD, 0.1)
    assert found.frequency == pytest.approx(12.0, abs=0.5 / (600 * PERIOD))
    assert found.speed == pytest.approx(1.0, rel=0.05)
    assert found.amplitude == pytest.approx(np.sqrt(2) / (2 * np.pi * 12.0), rel=0.06)


def test_too_few_rows_or_cycles_are_not_judged(rng):
    assert find_oscillation(cycle(rng, 12.0)(40), np.zeros((40, 3)), PERIOD, 0.1) is None
    slow = 3 / (600 * PERIOD)  # three cycles
    assert find_oscillation(cycle(rng, slow)(600), np.zeros((600, 3)), PERIOD, 0.1) is None
