"""A wall before every brush: what it hides, against geometry, and all of it counted."""

from dataclasses import replace

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.brushes import read_brush
from dqpaint.light.camera.camera import View, frame_points
from dqpaint.light.film.film import PAD, expose
from dqpaint.light.sources.occlusion import Occlusion
from dqpaint.light.sources.sweep import Sweep

N, PERIOD = 201, 0.01
BRUSHES = {
    "point": "point",
    "beam": "point:lobe=3",
    "ball": "ball:size=20mm",
    "bar": "bar:length=200mm,leds=20,colours=red/lime/blue,along=y",
    "dense": "bar:length=200mm,leds=80,joined=0,along=y",
    "ribbon": "ribbon:length=200mm,along=y",
    "pixels": "pixelstick:length=200mm,along=y,leds=30",
    "fibre": "fibre:width=10mm",
}


class Wall:
    """Hides what is above a height that rises with time, a + b t, or softly between."""

    def __init__(self, start, rate=0.0):
        self.start, self.rate, self.calls = start, rate, 0

    def visible(self, time, places, lit, eye):
        self.calls += 1
        self.time, self.lit = time, lit
        return (places[..., 1] < (self.start + self.rate * time)[:, None]).astype(float)


def sweep(brush, strobe=None, pwm=0.0):
    """To the right at an even pace, turning a little about the viewer's axis."""
    t = np.linspace(0.0, 1.0, N)
    turn = 0.0 if brush in ("bar", "ribbon", "dense") else 0.4
    place = np.stack([0.3 * t, 0 * t, 0 * t], axis=1)
    half = 0.5 * turn * t
    pose = dq.pose_from(place, np.stack([np.cos(half), 0 * t, 0 * t, np.sin(half)], axis=1))
    colours = np.tile([0.9, 0.5, 0.2], (N - 1, 1))
    colours[:20] = 0.0
    return Sweep(PERIOD, pose, colours, read_brush(BRUSHES[brush]).emitters(), strobe, pwm)


def camera(light):
    return frame_points(light.lit_points, np.eye(3), View(10.0, 8.0), (160, 90))


@pytest.mark.parametrize("falloff", [False, True])
@pytest.mark.parametrize("how", ["steady", "strobe", "pwm"])
@pytest.mark.parametrize("brush", BRUSHES)
def test_all_light_is_on_the_film_lost_or_hidden(brush, how, falloff):
    strobe = np.tile([37.0, 0.4], (N - 1, 1)) if how == "strobe" else None
    light = sweep(brush, strobe, 61.0 if how == "pwm" else 0.0)
    eye = camera(light)
    bare = expose(light, eye, falloff)
    wall = Wall(-0.05, 0.05)
    behind = light.occluded_by(wall, eye.position)
    film = expose(behind, eye, falloff)
    hidden = behind.occlusion.hidden
    np.testing.assert_allclose(film.on_film + film.lost + hidden.sum(0), bare.emitted, rtol=1e-9)
    np.testing.assert_allclose(behind.occlusion.emitted.sum(0), bare.emitted, rtol=1e-9)
    assert hidden.min() >= -1e-18
    assert 0.0 < hidden.sum() < bare.emitted.sum()
    assert wall.calls == 1  # however steps are cut
    np.testing.assert_allclose(wall.time, light.time[:-1] + 0.5 * PERIOD)
    np.testing.assert_array_equal(wall.lit, np.arange(N - 1) >= 20)


@pytest.mark.parametrize("brush", ["bar", "dense", "ribbon"])
def test_of_a_bar_what_is_above_the_wall_is_hidden(brush):
    """A bar of 200 mm under a wall that rises from -0.1 m to 0.1 m: its light by its height."""
    light = sweep(brush)
    eye = camera(light)
    behind = light.occluded_by(Wall(-0.1, 0.1), eye.position)
    expose(behind, eye)
    middle = (np.arange(N - 1) + 0.5) * PERIOD
    shown = 1.0 - behind.occlusion.hidden.sum(1)[20:] / behind.occlusion.emitted.sum(1)[20:]
    if brush == "bar":  # its colours are not of one brightness, so its ends are looked at
        assert shown[0] < 0.15
        assert shown[-1] > 0.99
        return
    np.testing.assert_allclose(shown, middle[20:] / 2.0, atol=0.02)
    assert abs((shown - middle[20:] / 2.0).mean()) < 0.003


def test_which_part_of_a_bar_is_dark_on_the_film():
    light = sweep("ribbon")
    eye = frame_points(light.lit_points, np.eye(3), View(0.0, 0.0), (160, 90))
    film = expose(light.occluded_by(Wall(0.02), eye.position), eye)
    lit = film.planes[0].sum(axis=1)
    rows = np.flatnonzero(lit > 0.5 * lit.max()) - PAD
    for row, height in ((rows.min(), 0.02), (rows.max(), -0.1)):
        assert row == pytest.approx(eye.project([[0.15, height, 0.0]])[0][0, 1], abs=1.5)


def test_shade_that_hides_nothing_changes_nothing():
    for brush in BRUSHES:
        light = sweep(brush)
        eye = camera(light)
        film, bare = expose(light.occluded_by(Wall(9.0), eye.position), eye), expose(light, eye)
        np.testing.assert_allclose(film.planes, bare.planes, rtol=1e-9, atol=1e-12)


def test_hidden_light_is_counted_in_its_own_step():
    light = sweep("point", np.tile([7.0, 0.3], (N - 1, 1)))
    share = np.ones((N - 1, 1))
    share[100:110] = 0.25
    behind = replace(light, occlusion=Occlusion(PERIOD, share))
    expose(behind, camera(light))
    hidden, emitted = behind.occlusion.hidden, behind.occlusion.emitted
    np.testing.assert_allclose(hidden[100:110], 0.75 * emitted[100:110], rtol=1e-12)
    assert not hidden[:100].any()
    assert not hidden[110:].any()


@pytest.mark.parametrize("brush", BRUSHES)
def test_what_lights_a_scene_is_all_of_the_brush(brush):
    light = sweep(brush, np.tile([37.0, 0.4], (N - 1, 1)))
    if light.emitters.lobe == 0.0:
        whole = expose(light, camera(light)).emitted
        found = sum(energy.sum(axis=0) for _, energy in light.lamp_paths())
        np.testing.assert_allclose(found, whole, rtol=1e-9)


def test_what_hides_the_first_step_hides_no_other():
    light = sweep("point")
    light = replace(light, colours=np.ones_like(light.colours))
    eye = camera(light)

    class First:
        def visible(self, time, places, _lit, _eye):
            shown = np.ones(places.shape[:-1])
            shown[0] = 0.0
            return shown

    behind = light.occluded_by(First(), eye.position)
    expose(behind, eye)
    hidden = behind.occlusion.hidden.sum(1)
    assert hidden[0] > 0.0
    assert not hidden[1:].any()
