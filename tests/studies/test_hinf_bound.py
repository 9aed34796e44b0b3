"""The page of the H-infinity promise: its table measured again, where the curves are highest."""

from pathlib import Path

import numpy as np
import pytest

from dqpaint.studies.kinds import hinf_bound

PAGE = (Path(__file__).parents[2] / "gallery/promise.md").read_text("utf-8")


@pytest.mark.slow
def test_the_table_is_what_is_measured():
    found = hinf_bound.curves(hinf_bound.HERTZ[[0, -1]])
    assert hinf_bound.page(found) == PAGE


@pytest.mark.slow
def test_a_curve_is_that_of_the_linear_loop():
    hertz = np.array([1.0, 20.0])
    found = hinf_bound.curves(hertz, (0.5,))
    z = np.exp(2j * np.pi * hertz * hinf_bound.PERIOD)
    wanted = 0.5 / np.abs(z - 0.5)
    np.testing.assert_allclose(found[0].of_bound, wanted, rtol=0.02)
    np.testing.assert_allclose(found[1].of_bound, wanted / np.sqrt(2), rtol=0.02)
