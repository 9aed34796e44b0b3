"""The map from energies to the image is the film's; what is solved for is met."""

import numpy as np
import pytest

from dqpaint.light.camera import Camera
from dqpaint.light.film import expose, point_spread, spread
from dqpaint.light.film.looks import LOOKS
from dqpaint.light.inverse import Box, Exposing, light_for, solve, solving
from dqpaint.light.inverse.developing import developed, own_slope, slope_back
from dqpaint.light.inverse.exposing import boxed
from dqpaint.light.inverse.solving import WHITE
from dqpaint.light.sources.emission import Light

BOX = Box(40, 30, 120, 90)


def steps(count=3000, seed=1, reach=4.0):
    chance = np.random.default_rng(seed)
    start = np.array([BOX.left, BOX.top]) + chance.random((count, 2)) * (BOX.width, BOX.height)
    return start, start + chance.normal(0.0, reach, (count, 2))


def hatch(gap=2.7, length=2.0):
    rows = np.arange(BOX.top + 2.0, BOX.top + BOX.height - 2.0, gap)
    x = np.arange(BOX.left + 1.0, BOX.left + BOX.width - 3.0, length)
    start = np.array([(a, b) for b in rows for a in x])
    return start, start + np.array([length, 0.0])


@pytest.mark.parametrize("rows", [360, 720, 1080])
@pytest.mark.parametrize("lamps", [1, 3])
def test_the_transpose_is_one(rows, lamps):
    exposing = Exposing(*steps(), BOX, point_spread(rows), np.float64)
    chance = np.random.default_rng(2)
    energy, image = chance.random((3000, lamps)), chance.normal(size=(90, 120, lamps))
    there = float((exposing.expose(energy) * image).sum())
    back = float((energy * exposing.back(image)).sum())
    assert there == pytest.approx(back, rel=1e-12)


def test_it_is_the_film():
    """The same light through the film itself: a path on a plane before a camera."""
    camera = Camera(
        np.array([0.0, 0.0, 1.0]), np.eye(3), 200.0, np.array([99.5, 74.5]), 200, 150
    )  # fmt: skip
    turn = np.linspace(0.0, 9.0, 400)
    pixels = np.stack([100.0 + 5.0 * turn * np.cos(turn), 75.0 + 4.0 * turn * np.sin(turn)], axis=1)
    flat = (pixels - camera.centre) / camera.focal * (1.0, -1.0)
    energy = np.random.default_rng(3).random((399, 3))
    psf = point_spread(720)
    film = expose(Light(np.column_stack([flat, np.zeros(400)]), energy), camera)
    seen = spread(film, psf)[BOX.top : BOX.top + BOX.height, BOX.left : BOX.left + BOX.width]
    mine = Exposing(pixels[:-1], pixels[1:], BOX, psf).expose(energy)
    # the film gathers the light of random steps in pieces of a pixel
    assert np.abs(mine - seen).max() < 0.03 * seen.max()
    assert np.abs(mine - seen).sum() < 0.015 * seen.sum()
    assert mine.sum() == pytest.approx(seen.sum(), rel=1e-4)


def test_the_curve_is_the_look():
    light = np.random.default_rng(4).random((40, 50, 3)).astype(np.float32) * 4.0
    shown = LOOKS["film"](light, 1.0, 0.0).astype(np.float64) / 255.0
    assert np.abs(developed(light.astype(np.float64))[0] - shown).max() < 1.5 / 255.0


def test_the_slope_of_the_curve():
    chance = np.random.default_rng(5)
    light, change = chance.random((8, 9, 3)) * 3.0, chance.normal(size=(8, 9, 3))
    _, slopes = developed(light)
    back, h = slope_back(slopes, change), 1e-3
    for channel in range(3):
        step = np.zeros(3)
        step[channel] = h
        by_difference = (developed(light + step)[0] - developed(light - step)[0]) / (2 * h)
        wanted = (by_difference * change).sum(axis=2)
        assert back[..., channel] == pytest.approx(wanted, rel=1e-3, abs=1e-3)


def test_the_weights_bound_the_curvature():
    """W - J' J has no negative eigenvalue at any pixel."""
    light = np.random.default_rng(6).random((6, 7, 3)) * 3.0
    _, slopes = developed(light)
    J = np.stack([slope_back(slopes, np.broadcast_to(row, (6, 7, 3))) for row in np.eye(3)], axis=2)
    bound = own_slope(slopes)[..., None] * np.eye(3) - np.swapaxes(J, 2, 3) @ J
    assert np.linalg.eigvalsh(bound).min() > -1e-12


def test_the_light_of_a_picture_develops_to_it():
    light = np.random.default_rng(7).random((5, 6, 3)) * 2.0
    picture = developed(light)[0]
    assert light_for(picture, 1.0) == pytest.approx(light, abs=1e-6)


def test_a_film_of_known_energies_is_met_again():
    box = Box(BOX.left, BOX.top, 56, 42)
    start, end = hatch()
    inside = (end < (box.left + box.width - 2, box.top + box.height - 1)).all(axis=1)
    start, end = start[inside], end[inside]
    exposing = Exposing(start, end, box, point_spread(720), np.float64)
    middle = 0.5 * (start + end)
    wave = 0.1 * middle[:, :1] + np.arange(3) + 0.05 * middle[:, 1:]
    known = 2.0 + 1.2 * np.sin(wave)  # slower than the core
    picture = developed(exposing.expose(known))[0]
    photo = to_photo(picture)
    found = solve(exposing, photo, np.ones(len(known)), np.full(len(known), 20.0), steps=400)
    again, wanted = exposing.expose(found.energy), exposing.expose(known)
    assert np.sqrt(((again - wanted) ** 2).mean()) < 1e-3 * wanted.mean()
    assert np.sqrt(((found.energy - known) ** 2).mean()) < 0.05 * known.mean()
    assert (np.diff(found.costs) <= 0.0).all()


def to_photo(picture):
    """The photograph whose wanted picture this is: its display light over the film's white."""
    linear = np.where(picture <= 0.04045, picture / 12.92, ((picture + 0.055) / 1.055) ** 2.4)
    light = linear / WHITE
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def test_energies_keep_their_bounds_and_the_cost_never_rises():
    chance = np.random.default_rng(8)
    start, end = hatch()
    exposing = Exposing(start, end, BOX, point_spread(1080))
    photo = np.clip(chance.random((90, 120, 3)) * 1.5 - 0.25, 0.0, 1.0)
    most = chance.random(len(start)) * 6.0
    first = np.where(chance.random(len(start)) < 0.1, 0.0, 1.0)
    found = solve(exposing, photo, first, most)
    assert found.energy.min() >= 0.0
    assert (found.energy <= most[:, None] * (1 + 1e-6)).all()
    assert (np.diff(found.costs) <= 0.0).all()
    assert found.costs[-1] < 0.9 * found.costs[0]


def test_a_lamp_of_one_colour_keeps_it():
    start, end = hatch()
    exposing = Exposing(start, end, BOX, point_spread(720))
    colour = np.array([1.0, 0.5, 0.0])
    known = 2.0 + 1.2 * np.sin(0.1 * start[:, :1] + 0.05 * start[:, 1:])
    wanted = exposing.expose(known * colour)
    photo = to_photo(developed(wanted)[0])
    found = solve(exposing, photo, np.ones(len(start)), np.full(len(start), 9.0), colour)
    assert found.energy[:, 1] == pytest.approx(0.5 * found.energy[:, 0])
    assert (found.energy[:, 2] == 0.0).all()
    again = exposing.expose(found.energy)
    assert np.sqrt(((again - wanted) ** 2).mean()) < 0.02 * wanted.mean()
    assert (np.diff(found.costs) <= 0.0).all()


def test_a_step_is_the_same_as_its_parts():
    """Longer than a pixel: it is deposited in pieces, wherever it is cut."""
    start, end = np.array([[70.3, 60.2]]), np.array([[72.1, 60.8]])
    middle = 0.5 * (start + end)
    whole = Exposing(start, end, BOX, point_spread(720), np.float64).expose(np.ones((1, 3)))
    halves = Exposing(
        np.vstack([start, middle]), np.vstack([middle, end]), BOX, point_spread(720), np.float64
    ).expose(np.full((2, 3), 0.5))
    np.testing.assert_allclose(whole, halves, atol=1e-12)


def test_a_box_is_no_larger_than_it_needs_to_be():
    points = np.array([[10.2, 20.0], [13.0, 25.7]])
    assert boxed(points, (100, 80)) == Box(10, 20, 4, 7)
    assert boxed(points - 12.0, (100, 80)) == Box(0, 8, 2, 7)
    assert boxed(points * 10.0, (100, 80)) == Box(99, 79, 1, 1)


def test_it_begins_at_the_best_scale(rng):
    """Least squares: what is missing is at right angles to what is there."""
    exposing = Exposing(*hatch(), BOX, point_spread(720), np.float64)
    target = rng.random((90, 120, 3)) * 0.3
    problem = solving._Problem(exposing, developed(target)[0], None, None, np.float64)
    first, bound = rng.random(len(hatch()[0])), np.full((len(hatch()[0]), 3), 1e6)
    light = problem.exposed(problem.start(target, first, bound))
    assert abs((light * (target - light)).sum()) < 1e-9 * (light * light).sum()
    low = np.full_like(bound, 1e-3)
    assert problem.start(target, first, low).max() == 1e-3
