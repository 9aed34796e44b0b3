import numpy as np
import pytest

from dqpaint.errors import DqpaintError
from dqpaint.light.sources.emission import Light
from tests.support.film_scene import flat_camera


def test_light_keeps_its_own_read_only_arrays():
    points = np.zeros((2, 3))
    light = Light(points, np.ones((1, 3)))
    points[0] = 7.0
    assert not light.points.any()
    with pytest.raises(ValueError, match="read-only"):
        light.energy[0] = 0.0


def test_lit_points_are_the_ends_of_lit_steps():
    points = np.arange(15.0).reshape(5, 3)
    light = Light(points, [[0, 0, 0], [0, 1, 0], [0, 0, 0], [0, 0, 0]])
    np.testing.assert_array_equal(light.lit_points, points[1:3])


def test_one_instant_emits_nothing():
    light = Light([[0.0, 0.0, 0.0]], np.zeros((0, 3)))
    assert light.energy.shape == (0, 3)
    assert light.lit_points.shape == (0, 3)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_numbers_that_are_none_are_refused(bad):
    points, energy = np.zeros((3, 3)), np.ones((2, 3))
    points[1, 2] = bad
    with pytest.raises(DqpaintError, match=r"position (nan|inf) at \(1, 2\)"):
        Light(points, energy)
    with pytest.raises(DqpaintError, match=r"lamp energy (nan|inf) at \(1, 2\) is not finite"):
        Light(np.zeros((4, 3)), points)


def test_wrong_shapes_and_negative_light_are_refused():
    with pytest.raises(DqpaintError, match=r"lamp energy -1.0 is negative"):
        Light(np.zeros((2, 3)), [[0, -1, 0]])
    with pytest.raises(ValueError, match="shape"):
        Light(np.zeros((2, 3)), np.zeros((2, 3)))
    with pytest.raises(ValueError, match="no positions"):
        Light(np.zeros((0, 3)), np.zeros((0, 3)))


def test_light_falls_off_with_the_square_from_the_middle_of_each_step(rng):
    camera = flat_camera()
    points, energy = rng.normal(0.0, 0.2, (5, 3)), rng.random((4, 3))
    (light,) = Light(points, energy).emission_to(camera, falloff=True)
    for k in range(4):
        away = np.linalg.norm(0.5 * (points[k] + points[k + 1]) - camera.position)
        np.testing.assert_allclose(light.energy[k], energy[k] / away**2, rtol=1e-12)
