"""Powers rounded to those that a lamp has, without losing light along the path."""

import numpy as np
import pytest

from dqpaint.brushes import read_lamp
from dqpaint.errors import UsageError


def test_an_ideal_lamp_changes_nothing():
    powers = np.random.default_rng(1).random((50, 3))
    assert read_lamp("ideal").rounded(powers, np.ones(50), np.ones(50, bool)) is powers


@pytest.mark.parametrize("text", ["dimmed", "dimmed:bits=3", "dimmed:bits=5,gamma=2.2", "switched"])
def test_the_light_of_a_stretch_is_kept(text):
    lamp = read_lamp(text)
    powers = np.random.default_rng(2).random((4000, 3)) * 0.8 + 0.05
    weights = np.random.default_rng(3).random(4000) + 0.5
    made = lamp.rounded(powers, weights, np.arange(4000) > 0)
    assert set(np.unique(made)) <= set(lamp.levels)
    lost = np.cumsum((powers - made) * weights[:, None], axis=0)
    assert np.abs(lost).max() <= 0.5 * np.diff(lamp.levels).max() * weights.max() + 1e-9


def test_nothing_is_owed_over_a_gap_and_dark_stays_dark():
    powers = np.full((6, 3), 0.4)
    powers[3] = 0.0
    joined = np.array([False, True, True, True, False, True])
    made = read_lamp("switched").rounded(powers, np.ones(6), joined)
    assert made[:, 0].tolist() == [0.0, 1.0, 0.0, 0.0, 0.0, 1.0]


def test_below_its_least_power_it_is_off():
    lamp = read_lamp("ideal:least=0.2")
    made = lamp.rounded(np.full((400, 3), 0.05), np.ones(400), np.arange(400) > 0)
    assert set(np.unique(made.round(3))) == {0.0, 0.2}
    assert made.mean() == pytest.approx(0.05, abs=1e-3)


@pytest.mark.parametrize("text", ["neon", "dimmed:bits=17", "dimmed:colour=3", "ideal:least=1"])
def test_wrong_lamps(text):
    with pytest.raises(UsageError, match=text.partition(":")[2].partition("=")[0] or text):
        read_lamp(text)
