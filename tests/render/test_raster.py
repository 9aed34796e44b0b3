"""The nearest triangle at each sample, against one at a time."""

import numpy as np

from dqpaint.render import raster
from dqpaint.render.raster import rasterise, slopes


def one_by_one(pixels, depth, width, height):
    """Triangle and nearness (h, w): every triangle at every sample, by its barycentric shares."""
    best, nearest = np.full((height, width), -1), np.zeros((height, width))
    y, x = np.mgrid[:height, :width]
    for i, (corner, z) in enumerate(zip(pixels, depth, strict=True)):
        edges = np.column_stack([corner, np.ones(3)]).T
        share = np.einsum("ij,jhw->ihw", np.linalg.inv(edges), np.stack([x, y, np.ones(x.shape)]))
        near = np.einsum("i,ihw->hw", 1 / z, share)
        wins = (share >= 0).all(axis=0) & (near > nearest)
        best[wins], nearest[wins] = i, near[wins]
    return best, nearest


def test_each_sample_shows_the_nearest_triangle(rng, monkeypatch):
    pixels, depth = rng.uniform(-10, 60, (14, 3, 2)), rng.uniform(1, 3, (14, 3))
    best, nearest = one_by_one(pixels, depth, 48, 31)
    assert (best < 0).any()
    assert len(np.unique(best)) > 7
    for most in (raster.MOST_AT_ONCE, 50):  # at once, and row by row
        monkeypatch.setattr(raster, "MOST_AT_ONCE", most)
        found = rasterise(pixels, depth, 48, 31)
        np.testing.assert_array_equal(found.triangle, best)
        np.testing.assert_allclose(found.nearness, nearest, atol=1e-12)


def test_neighbours_leave_no_gap_and_lines_and_what_lies_behind_are_nothing():
    square = np.array([[[0, 0], [9, 0], [9, 9]], [[0, 0], [9, 9], [0, 9]]], float)
    line = np.array([[[0, 0], [5, 5], [9, 9]]], float)
    behind = np.full((1, 3, 2), np.nan)
    found = rasterise(np.concatenate([behind, line, square]), np.full((4, 3), 2.0), 10, 10)
    assert set(np.unique(found.triangle)) == {2, 3}
    np.testing.assert_allclose(found.nearness, 0.5)


def test_slopes_go_through_the_corners(rng):
    x, y, value = rng.normal(size=(5, 3)), rng.normal(size=(5, 3)), rng.normal(size=(5, 3, 2))
    a, b, c = slopes(x, y, value).transpose(1, 0, 2)[:, :, None]
    np.testing.assert_allclose(a + b * x[..., None] + c * y[..., None], value, atol=1e-10)
