"""Between samples: arcs that are arcs, corners that are corners, and nothing lost."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.brushes import Emitters, read_brush
from dqpaint.light.film.film import expose
from dqpaint.light.sources import interpolation
from dqpaint.light.sources.sweep import Sweep
from tests.support.camera_motion import camera_for, swept
from tests.support.film_scene import at_pixels, drawn, flat_camera

CAMERA = flat_camera(500, 360)


def moving(pixels, period=0.005):
    pose = dq.pose_from(at_pixels(pixels, CAMERA), np.tile([1.0, 0, 0, 0], (len(pixels), 1)))
    return Sweep(period, pose, np.ones((len(pixels) - 1, 3)), Emitters())


def ring(samples, radius=120.0):
    t = np.linspace(0, 2 * np.pi, samples)
    return CAMERA.centre + radius * np.column_stack([np.cos(t), np.sin(t)])


@pytest.mark.parametrize("samples", [13, 25, 61])
def test_a_coarse_circle_is_round(samples):
    """Chords of 25 samples are off by a pixel; the smooth way by a twentieth."""
    steps = next(moving(ring(samples)).steps(1e-4))
    pixels, _ = CAMERA.project(steps.position)
    inner = pixels[len(pixels) // samples : -len(pixels) // samples]  # the ends have one neighbour
    radius = np.linalg.norm(inner - CAMERA.centre, axis=1)
    sagitta = 120.0 * (1 - np.cos(np.pi / (samples - 1)))
    assert np.abs(radius - 120.0).max() < 0.06 * sagitta


def test_a_fine_circle_is_left_as_it_is():
    sweep = moving(ring(721))
    steps = next(sweep.steps(sweep.chord_tolerance(CAMERA)))
    assert np.array_equal(steps.position, sweep.positions)
    plain = drawn(ring(721), np.full((720, 3), 0.005), CAMERA)
    assert np.array_equal(expose(sweep, CAMERA).planes, expose(plain, CAMERA).planes)


def test_corners_stay_sharp_and_straight_lines_straight():
    corner = np.array([[50, 50], [150, 50], [250, 50], [250, 150], [250, 250]], float)
    steps = next(moving(corner).steps(1e-7))
    pixels, _ = CAMERA.project(steps.position)
    off = np.minimum(np.abs(pixels[:, 1] - 50), np.abs(pixels[:, 0] - 250))
    assert off.max() < 1e-9


def test_smoothing_keeps_all_energy_and_every_sample():
    rng = np.random.default_rng(5)
    pixels = CAMERA.centre + np.cumsum(rng.normal(0, 1, (300, 2)).cumsum(axis=0), axis=0) * 0.1
    sweep = moving(pixels)
    steps = list(sweep.steps(1e-6))
    assert sum(len(s.energy) for s in steps) > 600
    total = sum(s.energy.sum(axis=0) for s in steps)
    np.testing.assert_allclose(total, 299 * 0.005, rtol=1e-12)
    places = np.concatenate([s.position for s in steps])
    assert all((np.abs(places - p).max(axis=1) < 1e-15).any() for p in sweep.positions)


def test_a_fast_turning_bar_has_no_chords():
    """Its ends go round in 13 samples; they stay on the circle."""
    turn = np.linspace(0, 2 * np.pi, 13)
    rotation = np.column_stack([np.cos(turn / 2), 0 * turn, 0 * turn, np.sin(turn / 2)])
    pose = dq.pose_from(np.zeros((13, 3)), rotation)
    emitters = read_brush("bar:length=200mm,leds=2,joined=0").emitters()
    sweep = Sweep(0.01, pose, np.ones((12, 3)), emitters)
    steps = next(sweep.steps(1e-5))
    lamps = sweep.base_positions(steps.position, steps.rotation, emitters.positions)
    np.testing.assert_allclose(np.linalg.norm(lamps, axis=2), 0.05, rtol=1e-12)
    gaps = np.linalg.norm(np.diff(lamps, axis=0), axis=2)
    assert (0.05 - np.sqrt(0.05**2 - gaps**2 / 4)).max() < 1.1e-5


def test_slerp_goes_the_short_way_whatever_the_sign():
    a = np.array([[1.0, 0, 0, 0], [-np.cos(0.4), 0, -np.sin(0.4), 0]])
    half = interpolation.rotation_at(a, np.array([0]), np.array([0.5]))[0]
    np.testing.assert_allclose(np.abs(half), [np.cos(0.2), 0, np.sin(0.2), 0], atol=1e-12)


@pytest.mark.parametrize("brush", ["point", "bar", "ribbon"])
def test_light_is_inverse_to_speed_for_every_brush(brush):
    """Half of the way is gone three times as fast: a third of the light, within 0.1 %."""
    x = np.concatenate([np.linspace(60, 220, 1201), np.linspace(220, 380, 401)[1:]])
    pixels = np.column_stack([x, np.full(len(x), 180.0)])
    sweep = moving(pixels)
    emitters = read_brush(brush if brush == "point" else f"{brush}:length=80mm,along=y").emitters()
    sweep = Sweep(sweep.period, sweep.pose, sweep.colours, emitters)
    columns = expose(sweep, CAMERA).planes[0].sum(axis=0)[64:-64]
    columns = np.convolve(columns, [0.25, 0.5, 0.25], mode="same")  # far less than any spread
    slow, fast = columns[70:210], columns[230:370]
    np.testing.assert_allclose(slow, slow.mean(), rtol=1e-3)
    np.testing.assert_allclose(fast, slow.mean() / 3, rtol=1e-3)


def test_batches_do_not_show():
    """A bar of many lamps is worked on in parts; the film is what it is in one."""
    emitters = read_brush("bar:leds=900,joined=0.4").emitters()
    sweep = swept(emitters, 400)
    assert len(list(sweep.steps(1.0))) > 1
    camera = camera_for(sweep)
    whole = expose(sweep, camera)
    parts = [slice(0, 150), slice(150, 151), slice(151, 399)]

    class Parts:
        def emission_to(self, camera, falloff=False):
            for part in parts:
                yield from sweep.emission_to(camera, falloff, part)

    cut = expose(Parts(), camera)
    np.testing.assert_allclose(cut.emitted, whole.emitted, rtol=1e-12)
    assert np.abs(cut.planes - whole.planes).sum() < 0.02 * whole.planes.sum()


def test_tangents_are_those_of_parabolas_over_uneven_chords():
    points = np.array([[0, 0, 0], [10, 1, 0], [40, 9, 2], [52, 16, 2]]) * 1e-3
    begin, end = interpolation.tangents(points)
    length = np.linalg.norm(np.diff(points, axis=0), axis=1)
    for k in (1, 2):
        way = np.polyfit([-length[k - 1], 0.0, length[k]], points[k - 1 : k + 2], 2)[1]
        np.testing.assert_allclose(begin[k], way / np.linalg.norm(way), rtol=1e-12)
        np.testing.assert_array_equal(end[k - 1], begin[k])


def test_a_step_turns_the_short_way_at_a_constant_rate(rng):
    """Against exponentials of quaternions, also for small angles and the other sign."""
    for angle in (3e-7, 1e-3, 0.12, 1.0, 3.0):
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        a = rng.normal(size=4)
        a /= np.linalg.norm(a)

        def turned(part, a=a, axis=axis, angle=angle):
            half = 0.5 * part * angle
            return dq.quaternion_mul(np.array([np.cos(half), *(np.sin(half) * axis)]), a)

        for sign in (1.0, -1.0):
            path = np.array([a, sign * turned(1.0)])
            part = np.array([0.0, 0.3, 0.7, 1.0])
            found = interpolation.rotation_at(path, np.zeros(4, int), part)
            expected = np.array([turned(one) for one in part])
            np.testing.assert_allclose(found, expected, atol=1e-12)
