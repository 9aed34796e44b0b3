"""Light on surfaces against its equations, written out one lamp and one point at a time."""

import numpy as np
import pytest

from dqpaint.render import shading
from dqpaint.render.lamps import Lamps
from dqpaint.render.shading import (
    NEAREST_LAMP,
    fresnel,
    points_seen_from,
    shade_by_direction,
    shade_by_lamps,
)


def unit(rng, n):
    v = rng.normal(size=(n, 3))
    return (v / np.linalg.norm(v, axis=1)[:, None]).astype(np.float32)


@pytest.fixture
def scene(rng):
    place = rng.uniform(-0.5, 0.5, (1300, 3)).astype(np.float32)  # more than two batches
    points = points_seen_from(np.array([1.0, -2.0, 1.5]), place, unit(rng, 1300))
    return points, Lamps(rng.uniform(-1, 1, (40, 3)), rng.uniform(0, 2, (40, 3)))


def test_dull_and_glossy_light_follow_their_equations(scene):
    points, lamps = scene
    dull, glossy = shade_by_lamps(points, lamps, 16)
    for i in range(0, 1300, 37):
        n, x = points.normal[i].astype(float), points.position[i].astype(float)
        v = points.to_eye[i].astype(float)
        r = 2 * max(n @ v, 0.0) * n - v
        expected = np.zeros((2, 3))
        for at, energy in zip(lamps.position, lamps.energy, strict=True):
            squared = (at - x) @ (at - x) + NEAREST_LAMP**2
            to = (at - x) / np.sqrt(squared)
            if n @ to > 0:
                expected[0] += energy * (n @ to) / squared / np.pi
                expected[1] += energy * max(r @ to, 0) ** 16 / squared * 18 / (2 * np.pi)
        np.testing.assert_allclose(dull[i], expected[0], rtol=2e-4, atol=1e-5)
        np.testing.assert_allclose(glossy[i], expected[1], rtol=2e-3, atol=1e-5)


def test_the_coat_reflects_what_glass_does():
    share = fresnel(np.array([1.0, 0.0], np.float32))
    np.testing.assert_allclose(share, [((1.5 - 1) / (1.5 + 1)) ** 2, 1.0], rtol=1e-6)


def test_a_far_lamp_is_the_limit_of_near_ones(scene):
    points, _ = scene
    way = np.array([0.3, -0.5, 0.8])
    far = Lamps(1e3 * way[None] / np.linalg.norm(way), np.full((1, 3), 1e6))
    dull, glossy = shade_by_direction(points, way, 4)
    limit = shade_by_lamps(points, far, 4)
    np.testing.assert_allclose(limit[0] * np.pi, np.repeat(dull, 3, axis=1), atol=3e-3)
    front = dull[:, 0] > 0.01  # what is turned away has no gloss from near lamps
    expected = np.repeat(glossy, 3, axis=1)[front] * 6 / (2 * np.pi)
    np.testing.assert_allclose(limit[1][front], expected, atol=3e-3)


@pytest.mark.parametrize("threads", [1, 3])
def test_threads_change_no_bit(threads, scene, monkeypatch):
    points, lamps = scene
    before = shade_by_lamps(points, lamps, 64)
    monkeypatch.setattr(shading, "THREADS", threads)
    for old, new in zip(before, shade_by_lamps(points, lamps, 64), strict=True):
        np.testing.assert_array_equal(old, new)


def test_no_lamp_no_light(scene):
    points, _ = scene
    dull, glossy = shade_by_lamps(points, Lamps(np.zeros((0, 3)), np.zeros((0, 3))), 64)
    assert not dull.any()
    assert not glossy.any()
