"""Gathering a painting's light into lamps keeps all of it, where it was."""

import numpy as np
import pytest

from dqpaint.render.lamps import gather_lamps


def some_lights(rng, n=(500, 7, 1)):
    return [
        (rng.normal(size=(k + 1, 3)), rng.uniform(0, 1, (k, 3)) * (rng.random((k, 1)) < 0.7))
        for k in n
    ]


@pytest.mark.parametrize("most", [1, 16, 128, 4096])
def test_energy_and_its_centre_are_kept(most, rng):
    lights = some_lights(rng)
    lamps = gather_lamps(lights, most)
    energy = np.concatenate([e for _, e in lights])
    middle = np.concatenate([(p[1:] + p[:-1]) / 2 for p, _ in lights])
    np.testing.assert_allclose(lamps.total, energy.sum(axis=0), rtol=1e-12)
    weight = energy.sum(axis=1)
    np.testing.assert_allclose(lamps.middle, weight @ middle / weight.sum(), atol=1e-12)
    assert len(lamps.position) <= most


def test_lamps_share_the_light_evenly_whatever_the_samples(rng):
    points = np.linspace([0, 0, 0], [1, 0, 0], 1001)
    energy = np.ones((1000, 3)) * rng.uniform(0.5, 1.5, (1000, 1))
    lamps = gather_lamps([(points, energy)], 10)
    share = lamps.energy.sum(axis=1) / energy.sum()
    np.testing.assert_allclose(share, 0.1, atol=0.002)
    assert (np.diff(lamps.position[:, 0]) > 0).all()


def test_a_light_that_stands_still_is_one_lamp_and_darkness_none():
    still = np.tile([0.1, 0.2, 0.3], (50, 1))
    lamps = gather_lamps([(still, np.full((49, 3), 2.0))], 1)
    np.testing.assert_allclose(lamps.position, [[0.1, 0.2, 0.3]])
    np.testing.assert_allclose(lamps.energy, [[98.0] * 3])
    assert len(gather_lamps([(still, np.zeros((49, 3)))]).position) == 0
