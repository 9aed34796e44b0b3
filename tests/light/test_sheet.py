"""A swept line of light against the Jacobian of its map, by differences."""

import cv2
import numpy as np
import pytest

from dqpaint import dq
from dqpaint.brushes import read_brush
from dqpaint.light.film.film import PAD, expose
from dqpaint.light.sources.sheet import Sheet, sheet_cells
from tests.support.camera_motion import camera_for, screw, swept
from tests.support.film_scene import at_pixels, flat_camera, sampled

JACOBIAN_TOLERANCE = 0.01
CORE = 1.25  # [px] with the film's own spline it is what the sharpest spread leaves


def on_sensor(film):
    return cv2.GaussianBlur(film.planes[0], (0, 0), CORE)


@pytest.mark.parametrize("view", ["front", "60,20", "-75,-30"])
def test_irradiance_is_one_over_the_jacobian(view):
    """A turning ribbon in perspective, where one layer of it lies, away from folds and rims."""
    length, samples, fine = 0.15, 300, 299 * 64 + 1
    sweep = swept(
        read_brush(f"ribbon:length={length}m").emitters(),
        samples,
        colours=np.ones((samples - 1, 3)),
    )
    camera = camera_for(sweep, view, (960, 540))
    image = on_sensor(expose(sweep, camera))
    T = dq.matrix_from_pose(screw(fine))

    def pixels(u, t):
        """Where the map (u, t) leads; t in steps of a fine screw."""
        return camera.project(T[t, :3, 3] + length * (u - 0.5)[:, None] * T[t, :3, 0])[0]

    u, t = (
        a.ravel() for a in np.meshgrid(np.linspace(0.06, 0.94, 21), np.arange(640, fine - 640, 240))
    )
    h, k = 1e-3, 16
    du = (pixels(u + h, t) - pixels(u - h, t)) / (2 * h)
    dt = (pixels(u, t + k) - pixels(u, t - k)) / (2 * k) * (fine - 1)
    jacobian = np.abs(du[:, 0] * dt[:, 1] - du[:, 1] * dt[:, 0])
    flat = jacobian > 0.7 * np.linalg.norm(du, axis=1) * np.linalg.norm(dt, axis=1)

    net_u, net_t = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, 60), np.arange(0, fine, 80)))
    net, at = pixels(net_u, net_t), pixels(u, t)
    alone = np.empty(len(at), dtype=bool)
    for i, place in enumerate(at):
        near = ((net - place) ** 2).sum(axis=1) < 12.0**2
        alone[i] = (np.abs(net_t[near] - t[i]) < 1200).all()
    good = flat & alone
    assert good.sum() > 100
    value = sampled(image, at[good] + PAD)
    truth = sweep.period * (samples - 1) / jacobian[good]
    assert np.abs(value / truth - 1).max() < JACOBIAN_TOLERANCE


def test_a_plain_rectangle_is_even_to_a_part_in_a_thousand():
    camera = flat_camera(400, 300)
    a, b = (
        at_pixels([[50.3, 40.2], [50.3, 240.7]], camera),
        at_pixels([[350.9, 40.2], [350.9, 240.7]], camera),
    )
    ends = np.stack([a, b])
    sheet = Sheet(ends, np.array([[6.0, 3.0, 0.0]]), np.full((1, 4, 3), 0.25), np.zeros(1, int))
    parts = list(sheet_cells(sheet, camera, 30.0))
    energy = np.concatenate([p.energy for p in parts], axis=1)
    np.testing.assert_allclose(energy.sum(axis=1), [6, 3, 0], rtol=1e-12)

    where = np.concatenate([p.position for p in parts], axis=1)
    centroid = (where * energy[0]).sum(axis=1) / energy[0].sum()
    np.testing.assert_allclose(centroid, [(50.3 + 350.9) / 2, (40.2 + 240.7) / 2], atol=1e-6)

    class Once:
        def emission_to(self, _camera, falloff=False):
            yield sheet

    image = on_sensor(expose(Once(), camera))[PAD:-PAD, PAD:-PAD]
    even = image[60:220, 70:330]
    np.testing.assert_allclose(even, 6.0 / (300.6 * 200.5), rtol=2e-3)


def test_colours_along_the_line_stay_where_they_are():
    camera = flat_camera(200, 100)
    corners = at_pixels([[20, 50], [180, 50], [20, 60], [180, 60]], camera).reshape(2, 2, 3)
    tints = np.zeros((1, 2, 3))
    tints[0, 0, 0] = tints[0, 1, 2] = 0.5
    sheet = Sheet(corners, np.ones((1, 3)), tints, np.zeros(1, int))
    parts = list(sheet_cells(sheet, camera, 30.0))
    x = np.concatenate([p.position[0] for p in parts])
    energy = np.concatenate([p.energy for p in parts], axis=1)
    assert energy[0, x > 101].sum() == 0
    assert energy[2, x < 99].sum() == 0
    np.testing.assert_allclose(energy.sum(axis=1), [0.5, 0, 0.5], rtol=1e-12)


def test_what_is_behind_the_camera_or_outside_is_lost():
    camera = flat_camera()
    behind = Sheet(
        np.array([[[0, 0, 0.0], [0.01, 0, 0]], [[0, 0, 2.0], [0.01, 0, 0]]]),
        np.ones((1, 3)), np.ones((1, 1, 3)), np.zeros(1, int),
    )  # fmt: skip
    beside = Sheet(
        np.array([[[5, 0, 0.0], [6, 0, 0]], [[5, 1, 0.0], [6, 1, 0]]]),
        np.ones((1, 3)), np.ones((1, 1, 3)), np.zeros(1, int),
    )  # fmt: skip
    for sheet in (behind, beside):
        parts = list(sheet_cells(sheet, camera, 30.0))
        np.testing.assert_allclose(sum(p.lost for p in parts), 1.0)
        assert sum(p.energy.size for p in parts) == 0


def test_a_huge_sheet_needs_little_time_and_loses_nothing():
    camera = flat_camera()
    corners = at_pixels([[-1e5, -1e5], [1e5, -1e5], [-1e5, 1e5], [1e5, 1e5]], camera)
    sheet = Sheet(corners.reshape(2, 2, 3), np.ones((1, 3)), np.ones((1, 1, 3)), np.zeros(1, int))
    total = sum(p.lost + p.energy.sum(axis=1) for p in sheet_cells(sheet, camera, 30.0))
    np.testing.assert_allclose(total, 1.0, rtol=1e-9)


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("far", [False, True])
@pytest.mark.parametrize(("begin", "end", "lost"), [
    (-5.5, -1.0, 0.0), (-9.0, -6.5, 1.0), (-8.0, 3.0, 2 / 11), (-20.0, -6.1, 1.0),
    (2.0, 400.0, None),
])  # fmt: skip
def test_light_up_to_the_margin_counts(axis, far, begin, end, lost):
    """A line that sweeps across one side of the picture, with 6 pixels of margin beyond it."""
    camera = flat_camera(200, 160)
    size = (200, 160)[axis]
    sweep = [begin, end] if not far else [size - 1 - begin, size - 1 - end]
    if lost is None:
        lost = (400.0 - (size - 1 + 6)) / 398.0
    corners = np.full((2, 2, 2), 40.0)
    corners[0, :, axis], corners[1, :, axis] = sweep
    corners[:, 1, 1 - axis] = 90.0
    ends = at_pixels(corners.reshape(4, 2), camera).reshape(2, 2, 3)
    sheet = Sheet(ends, np.ones((1, 3)), np.full((1, 2, 3), 0.5), np.zeros(1, int))
    parts = list(sheet_cells(sheet, camera, 6.0))
    whole = 1.0 / max(abs(end - begin), 1.0)  # of a cell, which is in or out as a whole
    assert sum(p.lost[0] for p in parts) == pytest.approx(lost, abs=whole)
    assert sum(p.energy[0].sum() + p.lost[0] for p in parts) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("joined", [0.0, 0.1, 0.5, 1.0])
def test_a_bar_gives_the_same_light_however_its_lamps_are_joined(joined):
    bar = read_brush(f"bar:length=60mm,leds=6,joined={joined}").emitters()
    sweep = swept(bar, 60, colours=np.ones((59, 3)))
    camera = camera_for(sweep, "front", (320, 200))
    film = expose(sweep, camera)
    assert film.planes[0].sum() == pytest.approx(59 * sweep.period, rel=1e-3)


@pytest.mark.parametrize("axis", [0, 1])
def test_of_a_line_longer_than_the_picture_what_is_in_it_is_kept(axis):
    camera = flat_camera(200, 160)
    size = (200, 160)[axis]
    corners = np.full((2, 2, 2), 50.0)
    corners[:, :, axis] = -100.0, 300.0
    corners[1, :, 1 - axis] = 60.0
    ends = at_pixels(corners.reshape(4, 2), camera).reshape(2, 2, 3)
    sheet = Sheet(ends, np.ones((1, 3)), np.full((1, 2, 3), 0.5), np.zeros(1, int))
    parts = list(sheet_cells(sheet, camera, 6.0))
    inside = (size - 1 + 2 * 6.0) / 400.0
    assert sum(p.energy[0].sum() for p in parts) == pytest.approx(inside, abs=1.01 / 400)
