import tracemalloc

import numpy as np
import pytest

from dqpaint.light.camera.camera import NEAREST_DEPTH
from dqpaint.light.film.film import PAD, expose
from dqpaint.light.sources.emission import Light
from tests.support.film_scene import HEIGHT, WIDTH, at_pixels, drawn, flat_camera, line

ENERGY_TOLERANCE = 1e-9  # relative
CAMERA = flat_camera()
INNER = slice(PAD, -PAD)


def assert_conserved(film):
    np.testing.assert_allclose(
        film.on_film + film.lost, film.emitted, rtol=ENERGY_TOLERANCE, atol=0.0
    )
    assert (film.planes >= 0).all()
    assert (film.lost >= 0).all()


def scribble(rng, count, scale):
    pixels = np.cumsum(rng.normal(size=(count, 2)) * scale, axis=0) + CAMERA.centre
    return drawn(
        pixels, rng.uniform(0, 1, (count - 1, 3)) * rng.choice([0, 1], (count - 1, 1)), CAMERA
    )


@pytest.mark.parametrize("scale", [0.01, 1.0, 30.0, 3000.0])
def test_all_energy_is_on_film_or_lost(scale):
    film = expose(scribble(np.random.default_rng(3), 4000, scale), CAMERA)
    assert_conserved(film)
    assert (film.lost > 0).all() == (scale >= 30.0)


def test_film_is_where_the_light_was():
    """Energy, centroid and the B-spline's variance of 1/4 px^2, between pixels as on them."""
    for place in ([100.0, 70.0], [30.25, 120.4], [0.5, 0.5], [200.49, 3.51]):
        plane = expose(drawn([place, place], [[1, 2, 3]], CAMERA), CAMERA).planes[1] / 2
        y, x = np.mgrid[: plane.shape[0], : plane.shape[1]] - PAD
        centre = np.array([(x * plane).sum(), (y * plane).sum()])
        np.testing.assert_allclose(centre, place, atol=1e-9)
        np.testing.assert_allclose(((x - place[0]) ** 2 * plane).sum(), 0.25, atol=1e-9)
        np.testing.assert_allclose(((y - place[1]) ** 2 * plane).sum(), 0.25, atol=1e-9)


def test_a_standing_light_loses_nothing():
    still = [[50.3, 60.7]] * 200
    film = expose(drawn(still, np.full((199, 3), 0.5), CAMERA), CAMERA)
    np.testing.assert_allclose(film.on_film, 99.5, rtol=1e-12)
    assert np.count_nonzero(film.planes[0]) == 9


def test_a_pause_at_a_corner_stays_in_the_corner():
    corner = np.array([80.37, 90.81])
    pixels = np.vstack([[[20.0, 90.81]], np.tile(corner, (500, 1)), [[80.37, 20.0]]])
    energy = np.full((501, 3), 1.0)
    film = expose(drawn(pixels, energy, CAMERA), CAMERA)
    assert_conserved(film)
    plane = film.planes[0]
    column, row = np.rint(corner).astype(int) + PAD
    patch = plane[row - 2 : row + 3, column - 2 : column + 3]
    assert patch.sum() > 499.0
    x = np.arange(column - 2, column + 3) - PAD
    assert abs((patch.sum(axis=0) * x).sum() / patch.sum() - corner[0]) < 0.01


def test_brightness_is_inverse_to_speed():
    """A lamp that moves three times as fast leaves a third, within 0.1 %."""
    slow, fast = np.linspace(20, 110, 901), np.linspace(110, 200, 301)[1:]
    x = np.concatenate([slow, fast])
    pixels = np.column_stack([x, 50.0 + 0.1 * x])
    film = expose(drawn(pixels, np.ones((1200, 3)), CAMERA), CAMERA)
    columns = film.planes[0].sum(axis=0)[INNER]
    np.testing.assert_allclose(columns[25:105], 10.0, rtol=1e-3)
    np.testing.assert_allclose(columns[115:195], 10.0 / 3.0, rtol=1e-3)


def test_it_does_not_matter_into_how_many_samples_a_path_is_cut():
    few = expose(line([10.2, 20.9], [200.1, 150.3], [1, 1, 1], CAMERA, 1), CAMERA).planes
    for steps in (7, 230, 20_000):
        many = expose(line([10.2, 20.9], [200.1, 150.3], [1, 1, 1], CAMERA, steps), CAMERA).planes
        assert np.abs(many - few).max() < 1e-9 * few.max()


def test_colours_are_kept_apart_and_change_in_place():
    pixels = np.column_stack([np.linspace(20, 220, 201), np.full(201, 90.0)])
    energy = np.zeros((200, 3))
    energy[:100, 0], energy[100:, 2] = 1.0, 1.0
    planes = expose(drawn(pixels, energy, CAMERA), CAMERA).planes
    red, green, blue = planes.sum(axis=1)[:, INNER]
    assert not green.any()
    np.testing.assert_allclose(red[25:115], 1.0, rtol=1e-9)
    assert not red[125:].any()
    assert not blue[:115].any()


def test_a_dark_move_leaves_no_trace_and_a_lit_jump_leaves_a_line():
    pixels = [[20, 30], [20, 30], [220, 150], [220, 150]]
    dark = expose(drawn(pixels, [[1] * 3, [0] * 3, [1] * 3], CAMERA), CAMERA).planes[0]
    assert np.count_nonzero(dark) == 18
    lit = expose(drawn(pixels, [[1] * 3, [7] * 3, [1] * 3], CAMERA), CAMERA).planes[0]
    np.testing.assert_allclose(lit.sum(axis=0)[INNER][30:210], 7 / 200, rtol=0.012)


def test_a_long_step_keeps_exactly_its_share_on_the_film():
    """It is a million pixels long; the film sees the columns from -63 to W+62."""
    light = drawn([[-5e5, 80.0], [5e5, 80.0]], [[1e6, 2e6, 0]], CAMERA)
    tracemalloc.start()
    film = expose(light, CAMERA)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert_conserved(film)
    np.testing.assert_allclose(film.on_film, np.array([1, 2, 0]) * (WIDTH - 1 + 2 * (PAD - 1)))
    assert peak < 2 * film.planes.nbytes


def test_ten_thousand_wild_steps_need_little_memory():
    rng = np.random.default_rng(8)
    light = drawn(rng.uniform(-1e6, 1e6, (10_000, 2)), np.ones((9_999, 3)), CAMERA)
    tracemalloc.start()
    film = expose(light, CAMERA)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert_conserved(film)
    assert peak < 60e6


@pytest.mark.parametrize(
    ("a", "b", "share"),
    [
        ([-200, 10], [-100, 10], 0),  # beside
        ([100, -64], [100, -62], 0.5),  # across the upper edge at -63
        ([WIDTH + 61, 5], [WIDTH + 63, 5], 0.5),
        ([50, HEIGHT + 60], [50, HEIGHT + 64], 0.5),
        ([-163, 80], [-63, -20], 0),  # past the corner's outside, touching the edge in a point
        ([0, 0], [10, 10], 1),
    ],
)
def test_steps_are_cut_at_the_edge(a, b, share):
    film = expose(drawn([a, b], [[1, 1, 1]], CAMERA), CAMERA)
    assert_conserved(film)
    np.testing.assert_allclose(film.on_film, share, atol=1e-9)


def test_what_is_left_of_a_cut_step_lies_where_the_step_did():
    edge, inside = np.array([-63.0, 80.0]), np.array([120.0, 20.0])
    outside = edge - 9 * (inside - edge)
    cut = expose(drawn([outside, inside], [[10, 20, 30]], CAMERA), CAMERA).planes
    whole = expose(drawn([edge, inside], [[1, 2, 3]], CAMERA), CAMERA).planes
    np.testing.assert_allclose(cut, whole, atol=1e-8)


def test_light_behind_the_camera_is_lost_as_whole_steps():
    """The camera stands at z = 1; the third and the fourth step have an end behind it."""
    z = [0.0, 0.1, 0.2, 1.5, 0.2, 0.1, 1.0 - NEAREST_DEPTH / 2]
    points = np.column_stack([np.zeros((7, 2)), z])
    film = expose(Light(points, np.diag([1, 2, 4, 8, 16, 32])[:, :3] + 1.0), CAMERA)
    assert_conserved(film)
    np.testing.assert_allclose(film.lost, [3.0, 3.0, 7.0])


def test_crossing_strokes_add():
    first = line([20, 30], [200, 150], [1, 0, 2], CAMERA)
    second = line([20, 150], [200, 20], [0, 1, 3], CAMERA)
    pixels = np.array([[20, 30], [200, 150], [20, 150], [200, 20]])
    energy = [first.energy[0], [0, 0, 0], second.energy[0]]
    both = expose(Light(at_pixels(pixels, CAMERA), energy), CAMERA).planes
    apart = expose(first, CAMERA).planes + expose(second, CAMERA).planes
    np.testing.assert_allclose(both, apart, rtol=1e-12, atol=1e-15)


def test_x_goes_right_and_y_goes_down():
    planes = expose(drawn([[200, 20], [200, 20]], [[1, 1, 1]], CAMERA), CAMERA).planes
    assert np.unravel_index(planes[0].argmax(), planes[0].shape) == (20 + PAD, 200 + PAD)
    above = expose(Light([[0.0, 0.05, 0.0]] * 2, [[1, 1, 1]]), CAMERA).planes[0]
    assert above.sum(axis=1).argmax() < above.shape[0] // 2


@pytest.mark.parametrize("energy", [np.zeros((0, 3)), np.zeros((5, 3))])
def test_no_light_leaves_the_film_empty(energy):
    film = expose(Light(np.zeros((len(energy) + 1, 3)), energy), CAMERA)
    assert not film.planes.any()
    assert not film.emitted.any()
    assert_conserved(film)


def test_two_runs_are_identical_to_the_bit():
    light = scribble(np.random.default_rng(4), 50_000, 3.0)
    assert np.array_equal(expose(light, CAMERA).planes, expose(light, CAMERA).planes)


def test_the_film_is_read_only():
    film = expose(line([20, 30], [200, 150], [1, 0, 2], CAMERA), CAMERA)
    with pytest.raises(ValueError, match="read-only"):
        film.planes[0] = 0.0
