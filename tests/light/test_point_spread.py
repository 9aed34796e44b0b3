import cv2
import numpy as np
import pytest

from dqpaint.light.film.film import PAD, Film, expose
from dqpaint.light.film.point_spread import NARROWEST_CORE, point_spread, spread
from tests.support.film_scene import drawn, flat_camera, line, sampled

ENERGY_TOLERANCE = 1e-6
RIPPLE_TOLERANCE = 0.01
HEIGHT = 360
CAMERA = flat_camera(500, HEIGHT)
PSF = point_spread(HEIGHT)


def pixel_film(width, height, at=None):
    planes = np.zeros((3, height + 2 * PAD, width + 2 * PAD))
    row, column = at or (height // 2, width // 2)
    planes[:, PAD + row, PAD + column] = [1.0, 2.0, 0.5]
    return Film(planes, planes.sum(axis=(1, 2)), np.zeros(3))


@pytest.mark.parametrize("size", [(1280, 720), (641, 363), (96, 54), (1000, 250)])
def test_energy_is_kept(size):
    image = spread(pixel_film(*size), point_spread(size[1]))
    assert image.shape == (size[1], size[0], 3)
    assert image.dtype == np.float32
    assert (image >= 0).all()
    total = image.sum(axis=(0, 1), dtype=np.float64)
    np.testing.assert_allclose(total, [1, 2, 0.5], rtol=ENERGY_TOLERANCE)


@pytest.mark.parametrize("size", [(1120, 720), (1121, 723)])
def test_pyramid_equals_the_gaussians_themselves(size):
    """Seen round a single pixel, which lacks the variance that a deposit brings along."""
    width, height = size
    psf = point_spread(height)
    image = spread(pixel_film(width, height), psf)[..., 0]
    y, x = np.mgrid[:height, :width]
    square = (x - width // 2) ** 2.0 + (y - height // 2) ** 2
    truth = sum(
        w / (2 * np.pi * (s * s - 0.25)) * np.exp(-square / (2 * (s * s - 0.25)))
        for s, w in zip(psf.widths, psf.weights, strict=True)
    )
    ring = np.sqrt(square).astype(int).ravel()
    error = np.bincount(ring, image.ravel()) / np.bincount(ring, truth.ravel()) - 1
    assert np.abs(error[:200]).max() < 0.012
    assert np.abs(error[12:200]).max() < 0.006
    inner = square < 200**2
    assert np.abs(image / truth - 1)[inner & (square > 144)].max() < 0.012  # no blocks
    np.testing.assert_allclose((x * image).sum() / image.sum(), width // 2, atol=0.01)


@pytest.mark.parametrize("angle", [0.0, 0.5, 1, 3, 7, 15, 26.565, 30, 45, 60, 80, 89, 90, 135])
def test_a_line_has_an_even_ridge_of_the_height_foretold(angle):
    along = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    for offset in (0.0, 0.13, 0.5):
        middle = CAMERA.centre + np.array([offset, 0.7 * offset])
        light = line(middle - 170 * along, middle + 170 * along, [1, 1, 1], CAMERA, 7)
        image = spread(expose(light, CAMERA), PSF)[..., 1].astype(float)
        ridge = sampled(image, middle + np.linspace(-80, 80, 481)[:, None] * along)
        assert np.ptp(ridge) / ridge.mean() < RIPPLE_TOLERANCE
        np.testing.assert_allclose(ridge.mean(), PSF.line_peak, rtol=0.01)


def test_the_peak_of_a_point_is_foretold():
    for offset in ([0.0, 0.0], [0.5, 0.5], [0.2, -0.4]):
        place = np.array([250.0, 180.0]) + offset
        image = spread(expose(drawn([place, place], [[1, 1, 1]], CAMERA), CAMERA), PSF)[..., 0]
        np.testing.assert_allclose(sampled(image, place[None]), PSF.point_peak, rtol=0.025)


def test_joints_leave_no_beads():
    """A path of many straight pieces of odd lengths equals one step from end to end."""
    rng = np.random.default_rng(2)
    a, b = np.array([60.3, 100.2]), np.array([430.8, 190.9])
    cuts = np.sort(np.concatenate([[0, 1], rng.uniform(0, 1, 60)]))
    pixels = a + cuts[:, None] * (b - a)
    energy = np.diff(cuts)[:, None] * np.full(3, 380.0)
    joined = spread(expose(drawn(pixels, energy, CAMERA), CAMERA), PSF)
    many = spread(
        expose(line(a, b, [380.0 / np.hypot(*(b - a))] * 3, CAMERA, 200_000), CAMERA), PSF
    )
    whole = spread(expose(drawn([a, b], [[380.0] * 3], CAMERA), CAMERA), PSF)
    assert np.abs(joined - whole).max() < 0.003 * whole.max()
    assert np.abs(many - whole)[:, 70:420].max() < 0.01 * whole.max()


def test_a_ring_of_chords_is_as_even_as_a_line():
    turn = np.linspace(0, 2 * np.pi, 721)
    pixels = CAMERA.centre + 120 * np.column_stack([np.cos(turn), np.sin(turn)])
    image = spread(expose(drawn(pixels, np.ones((720, 3)), CAMERA), CAMERA), PSF)[..., 0]
    t = np.linspace(0.1, 2 * np.pi - 0.1, 2000)
    ridge = sampled(image, CAMERA.centre + 120 * np.column_stack([np.cos(t), np.sin(t)]))
    assert np.ptp(ridge) / ridge.mean() < 2 * RIPPLE_TOLERANCE


def test_halos_have_the_same_share_of_every_picture():
    """Widths grow with the picture; beside the ridge of a line each halo is as high."""
    big, small = point_spread(1080), point_spread(360)
    np.testing.assert_allclose(np.array(big.widths[2:]) / small.widths[2:], 3.0)
    heights = [np.array(p.weights) / p.widths for p in (big, small)]
    heights = [h / h[0] for h in heights]
    np.testing.assert_allclose(heights[0][2:], heights[1][2:], rtol=0.01)
    for height in (36, 360, 720, 1080, 2160, 4320):
        psf = point_spread(height)
        assert psf.widths[0] >= NARROWEST_CORE
        np.testing.assert_allclose(sum(psf.weights), 1.0, rtol=1e-12)


def test_light_in_the_guard_band_blooms_into_the_picture():
    image = spread(pixel_film(200, 150, at=(75, -10)), point_spread(720))
    assert image[75, 0, 0] > 1.5 * image[75, 20, 0] > 0


def test_light_that_leaves_the_film_does_not_come_back():
    """The halos of what is near the film's border are what they would be on a larger film."""
    psf = point_spread(720)
    small = spread(pixel_film(200, 150, at=(180, 100)), psf)[..., 0]  # 34 px from the border
    large = spread(pixel_film(200, 550, at=(180, 100)), psf)[:150, :, 0]
    assert (small < 1.05 * large).all()
    assert small.sum() < 1.02 * large.sum()


@pytest.mark.parametrize("threads", [1, 2])
def test_threads_change_nothing(threads):
    light = line([60.3, 100.2], [430.8, 190.9], [1, 2, 3], CAMERA, 77)
    film = expose(light, CAMERA)
    reference = spread(film, PSF)
    before = cv2.getNumThreads()
    try:
        cv2.setNumThreads(threads)
        assert np.array_equal(spread(film, PSF), reference)
    finally:
        cv2.setNumThreads(before)
