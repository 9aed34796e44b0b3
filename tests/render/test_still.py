"""The picture of an arm: it adds light, always the same, where the arm is."""

from dataclasses import replace

import numpy as np
import pytest

from dqpaint.render import still
from dqpaint.render.arm_shapes import Arm
from dqpaint.render.geometry_buffer import measure_surfaces
from dqpaint.render.still import gather_glow, render_arm
from tests.support.ring_of_light import ring, seen
from tests.support.urdf_shapes import BALL, urdf

slow = pytest.mark.slow


def test_twice_the_light_with_half_the_exposure_is_the_same_glow():
    points, energy = ring()
    one, two = gather_glow([(points, energy)]), gather_glow([(points, 2 * energy)])
    np.testing.assert_allclose(two.lamps.total * two.gain, one.lamps.total * one.gain)


def test_darkness_has_no_glow():
    points, energy = ring()
    assert gather_glow([(points, 0 * energy)]).gain == 0.0


def test_rims_take_the_colours_of_either_end(rng):
    points, energy = ring()
    energy = np.where(points[:-1, :1] > 0, [1.0, 0.1, 0.0], [0.0, 0.3, 1.0])
    camera = seen()
    right, left = still._rims(gather_glow([(points, energy)]).lamps, camera)
    assert right[0] > right[2]
    assert left[2] > left[0]


@slow
def test_the_arm_adds_light_where_it_is_and_the_same_every_time(tmp_path):
    camera, light = seen(), gather_glow([ring()])
    pictures = []
    for _ in range(2):
        arm = Arm(urdf(tmp_path))
        arm.set_posture(np.array([0.3, -0.4]))
        pictures.append(render_arm(arm, camera, light, 2.0))
        cover = np.zeros((camera.height, camera.width))
        found = measure_surfaces(arm, camera)
        box = found.box
        cover[box.top : box.bottom, box.left : box.right] = found.cover
    np.testing.assert_array_equal(*pictures)
    image = pictures[0]
    assert image.dtype == np.float32
    assert np.isfinite(image).all()
    assert image.min() >= 0.0
    assert image[cover == 1].mean() > 10 * np.median(image[cover == 0])


@slow
def test_each_side_of_the_arm_has_the_colour_of_its_side(tmp_path):
    points, energy = ring()
    energy = np.where(points[:-1, :1] > 0, [1.0, 0.1, 0.0], [0.0, 0.1, 1.0]) * energy[:, :1]
    camera = seen()
    arm = Arm(urdf(tmp_path, "", "", BALL))
    arm.set_posture(np.array([-0.3, 0.0]))
    found = measure_surfaces(arm, camera)
    light = gather_glow([(points, energy)])
    colours = still.light_surfaces(arm, found, camera, replace(light, gain=0.0))
    side = found.normal @ camera.rotation[0]
    right, left = (colours[side * sign > 0.7].mean(axis=0) for sign in (1, -1))
    assert right[0] > 1.5 * right[2]
    assert left[2] > 1.5 * left[0]


@slow
def test_what_is_added_depends_on_the_exposure_as_developing_does(tmp_path):
    camera = seen()
    points, energy = ring()
    arm = Arm(urdf(tmp_path))
    one = render_arm(arm, camera, gather_glow([(points, energy)]), 2.0)
    two = render_arm(arm, camera, gather_glow([(points, 4 * energy)]), 0.5)
    np.testing.assert_allclose(0.5 * two, 2.0 * one, rtol=1e-4, atol=1e-7)


@slow
def test_an_arm_without_shapes_leaves_the_floor(tmp_path):
    arm = Arm(urdf(tmp_path, "", "", ""))
    image = render_arm(arm, seen(), gather_glow([ring()]), 2.0)
    assert np.isfinite(image).all()
    assert image.max() > 0.0


@slow
def test_outlines_have_quarters(tmp_path):
    arm = Arm(urdf(tmp_path))
    cover = measure_surfaces(arm, seen()).cover
    np.testing.assert_array_equal(np.unique(cover), [0, 0.25, 0.5, 0.75, 1])
