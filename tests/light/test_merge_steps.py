import os
import subprocess
import sys

import numpy as np
import pytest

from dqpaint.light.camera.camera import Camera
from dqpaint.light.film import merge_steps, projection
from dqpaint.light.film.film import PAD, expose
from dqpaint.light.film.merge_steps import LONGEST_MERGED, MOST_MERGED, merge_short_steps
from dqpaint.light.film.point_spread import point_spread, spread
from dqpaint.light.sources.emission import Light
from tests.support.film_scene import HEIGHT, WIDTH, drawn, flat_camera

FLAT = flat_camera()
MARGIN = PAD - 1.0


def random_camera(rng):
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    rotation *= np.sign(np.linalg.det(rotation))
    away = rng.uniform(0.5, 3.0)
    return Camera(away * rotation[2], rotation, 600.0, [150.0, 90.0], WIDTH, HEIGHT)


def walk(rng, count, step):
    return np.cumsum(rng.normal(size=(count + 1, 3)) * step, axis=0)


def seen_lengths(points, camera):
    """Of each step on the picture; those with an end off the film count nothing."""
    pixels = camera.project(points)[0]
    low, high = -MARGIN, np.array([camera.width, camera.height]) - 1.0 + MARGIN
    on = ((pixels >= low) & (pixels <= high)).all(axis=1)
    return np.linalg.norm(np.diff(pixels, axis=0), axis=1) * (on[1:] & on[:-1])


def assert_same_picture(film, other, tolerance):
    ours, theirs = (spread(one, point_spread(HEIGHT)) for one in (film, other))
    assert np.abs(ours - theirs).max() < tolerance * theirs.max()


@pytest.mark.parametrize("seed", range(12))
def test_joined_steps_are_short_wherever_they_are(seed):
    rng = np.random.default_rng(seed)
    camera = random_camera(rng)
    points = walk(rng, 3000, 10.0 ** rng.uniform(-6.5, -4.5))
    energy = rng.uniform(0, 1, (3000, 3)) * rng.integers(0, 2, (3000, 1))
    fewer, sums = merge_short_steps(points, energy, camera, MARGIN)
    many = -(-len(energy) // len(sums))
    first = np.arange(0, len(energy), many)
    assert len(fewer) == len(sums) + 1 == len(first) + 1
    np.testing.assert_array_equal(fewer, points[np.append(first, len(energy))])
    np.testing.assert_allclose(sums, np.add.reduceat(energy, first, axis=0), rtol=1e-14)
    if many > 1:
        assert np.add.reduceat(seen_lengths(points, camera), first).max() <= LONGEST_MERGED


def test_as_many_are_joined_as_may_be():
    """The bound takes the longest step along one axis for one along all: less than twice it."""
    for many in (2, 5, 30):
        pixels = np.column_stack(
            [30 + np.arange(1001) * LONGEST_MERGED / many, np.full(1001, 40.0)]
        )
        light = drawn(pixels, np.ones((1000, 3)), FLAT)
        sums = merge_short_steps(light.points, light.energy, FLAT, MARGIN)[1]
        assert many // 2 <= -(-1000 // len(sums)) <= many
    still = np.zeros((1001, 3))
    assert len(merge_short_steps(still, np.ones((1000, 3)), FLAT, MARGIN)[1]) == -(
        -1000 // MOST_MERGED
    )


def test_steps_aslant_to_the_axes_are_as_long_as_others():
    """The way goes across the picture, which is aslant in the base frame."""
    right = np.ones(3) / np.sqrt(3)
    up = np.array([1.0, -1, 0]) / np.sqrt(2)
    back = np.cross(right, up)
    camera = Camera(back, np.stack([right, up, back]), 1e5, [119.5, 89.5], WIDTH, HEIGHT)
    for many in (1, 3, 10, 20):
        points = np.arange(1001)[:, None] * (0.999 * LONGEST_MERGED / many / camera.focal) * right
        sums = merge_short_steps(points, np.ones((1000, 3)), camera, MARGIN)[1]
        assert -(-1000 // len(sums)) == many


@pytest.mark.parametrize("place", ["a long step", "behind the camera"])
def test_what_may_be_seen_is_left_as_it_is(place):
    points = walk(np.random.default_rng(1), 999, 1e-6)
    if place == "a long step":
        points[500:] += [0.001, 0, 0]
    else:
        points[:, 2] += np.linspace(0, 1.1, 1000)
    energy = np.ones((999, 3))
    same, whole = merge_short_steps(points, energy, FLAT, MARGIN)
    assert same is points
    assert whole is energy


def test_a_film_of_joined_steps_is_the_film(monkeypatch):
    """Once it is spread: where a way is cut, and so what is between two pixels, may differ."""
    rng = np.random.default_rng(2)
    turn = np.linspace(0, 4 * np.pi, 60_001)
    smooth = np.column_stack([120 + 5 * turn * np.cos(turn), 90 + 5 * turn * np.sin(turn)])
    for wobble, tolerance in ((0.0, 1e-3), (0.002, 1e-2)):
        pixels = smooth + wobble * rng.normal(size=smooth.shape)
        light = drawn(pixels, rng.uniform(0.9, 1, (60_000, 3)), FLAT)
        quick = expose(light, FLAT)
        with monkeypatch.context() as patch:
            patch.setattr(merge_steps, "LONGEST_MERGED", 0.0)
            whole = expose(light, FLAT)
        assert not np.array_equal(quick.planes, whole.planes)
        assert_same_picture(quick, whole, tolerance)
        np.testing.assert_allclose(quick.on_film, light.energy.sum(axis=0), rtol=1e-11)


def test_brightness_is_inverse_to_speed_where_steps_are_joined():
    slow, fast = np.linspace(20, 110, 9001), np.linspace(110, 200, 3001)[1:]
    x = np.concatenate([slow, fast])
    light = drawn(np.column_stack([x, 50.0 + 0.1 * x]), np.ones((12_000, 3)), FLAT)
    assert len(merge_short_steps(light.points, light.energy, FLAT, MARGIN)[1]) < 9000
    columns = expose(light, FLAT).planes[0].sum(axis=0)[PAD:-PAD]
    np.testing.assert_allclose(columns[25:105], 100.0, rtol=1e-3)
    np.testing.assert_allclose(columns[115:195], 100.0 / 3.0, rtol=1e-3)


def test_blocks_that_are_read_at_once_fit_together(monkeypatch):
    turn = np.linspace(0, 7, 10_001)
    pixels = np.column_stack([120 + 60 * np.cos(turn), 90 + 60 * np.sin(turn)])
    light = drawn(pixels, np.ones((10_000, 3)), FLAT)
    whole = expose(light, FLAT)
    monkeypatch.setattr(projection, "MERGE_BATCH", 999)
    monkeypatch.setattr(projection, "BATCH", 100)
    parts = expose(light, FLAT)
    assert_same_picture(parts, whole, 5e-3)
    np.testing.assert_allclose(parts.on_film, whole.on_film, rtol=1e-12)


HASH = """
import hashlib, numpy as np
from dqpaint.light.film import expose
from tests.support.film_scene import drawn, flat_camera
turn = np.linspace(0, 60, 300_001)
pixels = np.column_stack([120 + turn * np.cos(turn), 90 + turn * np.sin(turn)])
energy = np.random.default_rng(3).uniform(0, 1, (300_000, 3))
film = expose(drawn(pixels, energy, flat_camera()), flat_camera())
print(hashlib.sha256(film.planes.tobytes() + film.lost.tobytes()).hexdigest())
"""


@pytest.mark.slow
def test_the_number_of_threads_changes_no_bit():
    found = set()
    for threads in ("1", "2", "8"):
        environment = {**os.environ, "OPENBLAS_NUM_THREADS": threads, "OMP_NUM_THREADS": threads}
        run = subprocess.run(
            [sys.executable, "-c", HASH], env=environment, check=True, capture_output=True
        )
        found.add(run.stdout)
    assert len(found) == 1


def test_light_that_only_just_counts_is_joined_in_the_margin_too():
    """Far from the middle a step along the view is seen as long as one across."""
    camera = Camera([0, 0, 1], np.eye(3), 50.0, [119.5, 89.5], WIDTH, HEIGHT)
    along = np.linspace(0, 0.3, 4001)
    points = np.column_stack([2.9 * (1 - along), np.zeros(4001), along])
    points[:, 0] = 3.0 * np.cos(along)
    fewer, _ = merge_short_steps(points, np.ones((4000, 3)), camera, MARGIN)
    many = -(-4000 // (len(fewer) - 1))
    assert many > 1
    lengths = seen_lengths(points, camera)
    assert np.add.reduceat(lengths, np.arange(0, 4000, many)).max() <= LONGEST_MERGED
    assert Light(points, np.ones((4000, 3))).energy.sum() == 12_000


@pytest.mark.parametrize(("count", "fewest"), [(40_000, 1), (320_000, 5)])
def test_the_nearest_steps_decide(count, fewest):
    """The lamp comes five times as near, to and fro on its way."""
    points = np.zeros((count + 1, 3))
    points[1::2, 0] = 0.8 / count
    points[:, 2] = np.linspace(0, 0.8, count + 1)
    fewer, _ = merge_short_steps(points, np.ones((count, 3)), FLAT, MARGIN)
    many = -(-count // (len(fewer) - 1))
    assert many >= fewest
    assert (
        np.add.reduceat(seen_lengths(points, FLAT), np.arange(0, count, many)).max()
        <= LONGEST_MERGED
    )
