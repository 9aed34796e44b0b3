"""Rounded corners of pieces: they touch, stay within the deviation, and leave the rest alone."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from dqpaint.program import piece_corners, piecewise

DEVIATION = 2e-4


def polyline(rng, count=7):
    return piecewise.straight(np.cumsum(rng.normal(size=(count, 3)) * 0.02, axis=0))


def beziers(rng, count=6):
    """Bent pieces with a corner at each end."""
    points, at = [], np.zeros(3)
    for _ in range(count):
        control = at + np.concatenate([np.zeros((1, 3)), rng.normal(size=(3, 3)) * 0.02])
        points.append(piecewise.bezier(control))
        at = control[-1]
    return piecewise.join(points)


def mixed(rng):
    """A line, an arc, a line: corners between straight and round."""
    u, v = np.array([0.03, 0, 0.01]), np.array([0, 0.03, -0.02])
    arc = piecewise.arc(np.zeros(3), u, v, 0.3, 2.0)
    start, end = map(np.array, piecewise.ends(arc))
    before = piecewise.straight(np.stack([start + rng.normal(size=3) * 0.03, start]))
    after = piecewise.straight(np.stack([end, end + rng.normal(size=3) * 0.03]))
    return piecewise.join([before, arc, after])


def dense(curve, count=400):
    every = np.repeat(np.arange(len(curve.cubic)), count)
    return piecewise.derivatives(curve, every, np.tile(np.linspace(0, 1, count), len(curve.cubic)))


def distance(points, to):
    """The largest distance of points (N, 3) from densely sampled others."""
    return cKDTree(to).query(points)[0].max()


@pytest.mark.parametrize("made", [polyline, beziers, mixed])
def test_a_rounded_curve_is_smooth_and_within_its_deviation(rng, made):
    for _ in range(6):
        curve = made(rng)
        found, starts = piece_corners.rounded(curve, np.array([0]), DEVIATION)
        assert starts.tolist() == [0]
        assert len(found.cubic) > len(curve.cubic)
        np.testing.assert_allclose(piecewise.ends(found), piecewise.ends(curve), atol=1e-15)
        every = np.arange(len(found.cubic))
        begin, end = (piecewise.derivatives(found, every, np.full(len(every), g)) for g in (0, 1))
        np.testing.assert_allclose(begin[0][1:], end[0][:-1], atol=1e-14)
        ways = [v[1] / np.linalg.norm(v[1], axis=1, keepdims=True) for v in (begin, end)]
        np.testing.assert_allclose(ways[0][1:], ways[1][:-1], atol=1e-7)
        old, new = dense(curve)[0], dense(found)[0]
        grain = 0.5 * np.linalg.norm(np.diff(old, axis=0), axis=1).max()
        assert distance(old, new) < DEVIATION * 1.001 + grain**2 / DEVIATION
        assert distance(new, old) < DEVIATION * 1.001 + grain


def test_between_lines_it_is_the_arc_of_that_deviation():
    angle = np.radians(70.0)
    points = np.array(
        [[0, 0, 0], [0.05, 0, 0], [0.05 + 0.04 * np.cos(angle), 0.04 * np.sin(angle), 0]]
    )
    found, _ = piece_corners.rounded(piecewise.straight(points), np.array([0]), DEVIATION)
    assert len(found.cubic) == 3
    at, first, second = dense(found)[:3]
    assert np.linalg.norm(at - points[1], axis=1).min() == pytest.approx(DEVIATION, rel=1e-3)
    arc = slice(400, 800)
    bend = np.linalg.norm(np.cross(first[arc], second[arc]), axis=1)
    bend /= np.linalg.norm(first[arc], axis=1) ** 3
    radius = DEVIATION / (1 / np.cos(angle / 2) - 1)
    np.testing.assert_allclose(bend, 1 / radius, rtol=1e-9)


def test_lines_too_short_for_it_are_rounded_by_half_of_each():
    turn = np.arange(0, 361, 1.0)
    ring = np.stack([np.cos(np.radians(turn)), np.sin(np.radians(turn)), 0 * turn], axis=1) * 0.03
    found, _ = piece_corners.rounded(piecewise.straight(ring), np.array([0]), 1e-3)
    first, second = dense(found)[1:3]
    bend = np.linalg.norm(np.cross(first, second), axis=1) / np.linalg.norm(first, axis=1) ** 3
    inner = slice(400, -400)
    np.testing.assert_allclose(bend[inner], 1 / 0.03, rtol=1e-3)  # a circle again


def test_smooth_joints_ways_back_and_other_curves_stay_as_they_are():
    points = np.array([[0, 0, 0], [0.05, 0, 0], [0.02, 0, 0]])
    back = piecewise.straight(points)
    assert piece_corners.rounded(back, np.array([0]), 1e-4)[0] is back
    smooth = piecewise.straight(np.array([[0, 0, 0], [0.05, 0, 0], [0.08, 1e-6, 0]]))
    assert piece_corners.rounded(smooth, np.array([0]), 1e-4)[0] is smooth
    whole, starts, _ = piecewise.concatenate([smooth, polyline(np.random.default_rng(1)), back])
    found, begins = piece_corners.rounded(whole, starts, 1e-4)
    parts = list(piecewise.split(found, begins))
    np.testing.assert_allclose(parts[0].cubic, smooth.cubic)
    np.testing.assert_allclose(parts[2].cubic, back.cubic)
    assert len(parts[1].cubic) == 11


def test_a_distance_takes_that_much_of_each_side():
    points = np.array([[0, 0, 0], [0.05, 0, 0], [0.05, 0.004, 0], [0.0, 0.004, 0]])
    found, _ = piece_corners.rounded(piecewise.straight(points), np.array([0]), 0.0, 5e-3)
    at = dense(found)[0]
    assert np.abs(at - [0.048, 0, 0]).sum(1).min() < 1e-9  # half of the short side
    found, _ = piece_corners.rounded(piecewise.straight(points[:3] * 10), np.array([0]), 0.0, 5e-3)
    np.testing.assert_allclose(dense(found)[0][399], [0.495, 0, 0], atol=1e-12)
