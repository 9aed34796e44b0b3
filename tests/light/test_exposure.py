import numpy as np
import pytest

from dqpaint.light.film.auto_exposure import (
    AREA_EXPOSURE,
    CORE_EXPOSURE,
    _weighted_quantile,
    automatic_exposure,
)
from dqpaint.light.film.film import expose
from dqpaint.light.film.point_spread import REFERENCE_HEIGHT, point_spread, spread
from dqpaint.light.sources.emission import Light
from tests.support.film_scene import at_pixels, drawn, flat_camera, line

CAMERA = flat_camera(600, REFERENCE_HEIGHT)
PSF = point_spread(REFERENCE_HEIGHT)


def exposed(light, camera=CAMERA):
    image = spread(expose(light, camera), point_spread(camera.height))
    return image * automatic_exposure(light, camera)


def hatched(spacing, camera=CAMERA):
    """Parallel lines over a square of 320 pixels."""
    rows = np.arange(200.0, 520.0, spacing)
    ends = np.array([[[100, y], [420, y]] for y in rows]).reshape(-1, 2)
    energy = np.zeros((len(ends) - 1, 3))
    energy[::2] = 320.0
    return drawn(ends, energy, camera)


@pytest.mark.parametrize("steps", [1, 50, 20_000])
@pytest.mark.parametrize("colour", [[1e-3, 0, 5e-4], [40, 700, 0]])
def test_the_core_of_a_line_is_as_bright_as_it_should(steps, colour):
    image = exposed(line([60, 100], [420, 100], colour, CAMERA, steps))
    np.testing.assert_allclose(image[100, 120:360].max(axis=1), CORE_EXPOSURE, rtol=0.01)


def test_the_median_is_by_length_and_not_by_time():
    """One eighth of the length is slow and bright, though most samples are there."""
    x = np.concatenate([np.linspace(60, 105, 5000), np.linspace(105, 420, 60)[1:]])
    pixels = np.column_stack([x, np.full(len(x), 100.0)])
    image = exposed(drawn(pixels, np.ones((len(x) - 1, 3)), CAMERA))
    np.testing.assert_allclose(image[100, 220:380], CORE_EXPOSURE, rtol=0.15)


def test_the_weighted_quantile_weighs():
    assert _weighted_quantile(np.array([3.0, 1.0, 2.0]), np.array([1.0, 1.0, 5.0]), 0.5) == 2.0
    assert _weighted_quantile(np.array([3.0, 1.0, 2.0]), np.array([1.0, 5.0, 1.0]), 0.5) == 1.0
    assert _weighted_quantile(np.array([3.0, 1.0, 2.0]), np.array([5.0, 1.0, 1.0]), 0.5) == 3.0


def test_dark_moves_and_light_off_the_picture_do_not_count():
    plain = line([60, 100], [420, 100], [1, 1, 1], CAMERA, 36)
    start = at_pixels([[-9000, 40], [-400, 40], [-400, 330]], CAMERA)
    more = Light(
        np.vstack([start, plain.points]),
        np.vstack([[[9e5] * 3, [9e5] * 3, [0] * 3], plain.energy]),
    )
    np.testing.assert_allclose(automatic_exposure(more, CAMERA), automatic_exposure(plain, CAMERA))


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
    ratio = automatic_exposure(dim, CAMERA) / automatic_exposure(bright, CAMERA)
    np.testing.assert_allclose(ratio, 10.0)


@pytest.mark.parametrize("points", [np.zeros((1, 3)), np.zeros((4, 3)), [[0, 0, 9.0]] * 4])
def test_without_light_on_the_picture_the_exposure_is_one(points):
    energy = np.full((len(points) - 1, 3), float(np.any(points)))
    assert automatic_exposure(Light(points, energy), CAMERA) == 1.0


@pytest.mark.parametrize("spacing", [2.0, 6.0, 14.0])
def test_close_lines_are_exposed_as_an_area(spacing):
    image = exposed(hatched(spacing))[250:450, 150:370]
    np.testing.assert_allclose(image.mean(), AREA_EXPOSURE, rtol=0.15)


def test_lines_apart_are_exposed_as_lines():
    """The largest exposure that leaves lines their cores is reached where they stand apart."""
    image = exposed(hatched(80.0))
    np.testing.assert_allclose(image[280, 150:370], CORE_EXPOSURE, rtol=0.02)


@pytest.mark.parametrize("light", [hatched(3.0), line([60, 100], [420, 460], [1, 2, 0], CAMERA)])
@pytest.mark.parametrize("scale", [0.125, 0.5, 3.0])
def test_the_light_on_the_film_does_not_depend_on_the_pixels(light, scale):
    """The factor is per square pixel."""
    other = automatic_exposure(light, CAMERA.scaled(scale))
    np.testing.assert_allclose(other / scale**2, automatic_exposure(light, CAMERA), rtol=1e-3)


@pytest.mark.parametrize("height", [120, 720])
def test_a_level_is_met_by_lines_at_the_size_of_the_picture(height):
    camera = flat_camera(400, height)
    light = line([60, 60], [340, 60], [3, 1, 0], camera, 10)
    image = spread(expose(light, camera), point_spread(height))
    image = image * automatic_exposure(light, camera, 0.8)
    np.testing.assert_allclose(image[60, 120:280].max(axis=1), 0.8, rtol=0.02)


def test_a_hold_does_not_darken_the_rest():
    plain = hatched(6.0)
    spot = np.vstack([plain.points, at_pixels([[500, 60], [500, 60]], CAMERA)])
    energy = np.vstack([plain.energy, [[0.0] * 3, [5e4] * 3]])
    np.testing.assert_allclose(
        automatic_exposure(Light(spot, energy), CAMERA),
        automatic_exposure(plain, CAMERA),
        rtol=0.05,
    )
