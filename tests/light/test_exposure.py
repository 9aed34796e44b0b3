import numpy as np
import pytest

from dqpaint.light.film.auto_exposure import CORE_EXPOSURE, _weighted_median, automatic_exposure
from dqpaint.light.film.film import expose
from dqpaint.light.film.point_spread import point_spread, spread
from dqpaint.light.sources.emission import Light
from tests.support.film_scene import at_pixels, drawn, flat_camera, line

CAMERA = flat_camera(480, 360)
PSF = point_spread(360)


def exposed(light):
    image = spread(expose(light, CAMERA), PSF)
    return image * automatic_exposure(light, CAMERA, PSF)


@pytest.mark.parametrize("steps", [1, 50, 20_000])
@pytest.mark.parametrize("colour", [[1e-3, 0, 5e-4], [40, 700, 0]])
def test_the_core_of_a_line_is_as_bright_as_it_should(steps, colour):
    image = exposed(line([60, 100], [420, 100], colour, CAMERA, steps))
    np.testing.assert_allclose(image[100, 120:360].max(axis=1), CORE_EXPOSURE, rtol=0.01)


def test_the_median_is_by_length_and_not_by_time():
    """Two thirds of the length are fast, though most samples are slow."""
    x = np.concatenate([np.linspace(60, 180, 5000), np.linspace(180, 420, 60)[1:]])
    pixels = np.column_stack([x, np.full(len(x), 100.0)])
    image = exposed(drawn(pixels, np.ones((len(x) - 1, 3)), CAMERA))
    np.testing.assert_allclose(image[100, 220:380], CORE_EXPOSURE, rtol=0.02)


def test_the_weighted_median_weighs():
    assert _weighted_median(np.array([3.0, 1.0, 2.0]), np.array([1.0, 1.0, 5.0])) == 2.0
    assert _weighted_median(np.array([3.0, 1.0, 2.0]), np.array([1.0, 5.0, 1.0])) == 1.0
    assert _weighted_median(np.array([3.0, 1.0, 2.0]), np.array([5.0, 1.0, 1.0])) == 3.0


def test_dark_moves_and_light_off_the_picture_do_not_count():
    plain = line([60, 100], [420, 100], [1, 1, 1], CAMERA, 36)
    start = at_pixels([[-9000, 40], [-400, 40], [-400, 330]], CAMERA)
    more = Light(
        np.vstack([start, plain.points]),
        np.vstack([[[9e5] * 3, [9e5] * 3, [0] * 3], plain.energy]),
    )
    np.testing.assert_allclose(
        automatic_exposure(more, CAMERA, PSF), automatic_exposure(plain, CAMERA, PSF)
    )


def test_a_dot_is_exposed_by_its_peak():
    still = drawn([[240, 180]] * 5, [[0, 0.2, 0.1]] * 4, CAMERA)
    np.testing.assert_allclose(exposed(still).max(), CORE_EXPOSURE, rtol=0.03)


def test_so_is_each_dot_of_many():
    pixels = np.repeat([[60, 60], [400, 80], [200, 300]], 2, axis=0)
    stars = drawn(pixels, [[1] * 3, [0] * 3, [1] * 3, [0] * 3, [1] * 3], CAMERA)
    np.testing.assert_allclose(exposed(stars)[60, 60], CORE_EXPOSURE, rtol=0.03)


@pytest.mark.parametrize("length", [1e-6, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 12.0])
def test_between_dot_and_line_the_peak_stays_near(length):
    image = exposed(line([240, 180], [240 + length, 180], [1, 1, 1], CAMERA, 20))
    assert 0.75 * CORE_EXPOSURE < image.max() < 1.05 * CORE_EXPOSURE


def test_ten_times_the_light_needs_a_tenth_of_the_exposure():
    dim, bright = (line([60, 100], [400, 220], [k, 0, k], CAMERA, 9) for k in (1.0, 10.0))
    ratio = automatic_exposure(dim, CAMERA, PSF) / automatic_exposure(bright, CAMERA, PSF)
    np.testing.assert_allclose(ratio, 10.0)


@pytest.mark.parametrize("points", [np.zeros((1, 3)), np.zeros((4, 3)), [[0, 0, 9.0]] * 4])
def test_without_light_on_the_picture_the_exposure_is_one(points):
    energy = np.full((len(points) - 1, 3), float(np.any(points)))
    assert automatic_exposure(Light(points, energy), CAMERA, PSF) == 1.0
