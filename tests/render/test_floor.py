"""The floor under a lamp: how bright, how mirrored, and when there is none."""

import numpy as np
import pytest

from dqpaint.light.camera.camera import Camera
from dqpaint.render import floor
from dqpaint.render.floor import ALBEDO, floor_light
from dqpaint.render.lamps import Lamps
from dqpaint.render.shading import NEAREST_LAMP

DOWN = np.array([[1.0, 0, 0], [0, 0.6, 0.8], [0, -0.8, 0.6]])  # looks along y and down

LEVEL = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])


def camera(height=1.0, size=(256, 192)):
    centre = [(size[0] - 1) / 2, (size[1] - 1) / 2]
    return Camera([0.0, -1.2, height], DOWN, 200.0, centre, *size)


def lamp(place, energy=(1.0, 0.5, 0.25)):
    return Lamps(np.array([place], float), np.array([energy], float))


NONE = Lamps(np.zeros((0, 3)), np.zeros((0, 3)))


def test_the_pool_under_a_lamp_is_as_bright_as_lambert_says():
    eye = camera()
    light = floor_light(eye, lamp([0.1, 0.3, 0.5]), NONE, gain=3.0, exposure=1.0)
    for at in ([0.1, 0.3, 0], [0.3, 0.2, 0], [-0.2, 0.5, 0]):
        x, y = np.rint(eye.project([at])[0][0]).astype(int)
        way = np.array([0.1, 0.3, 0.5]) - at
        squared = way @ way + NEAREST_LAMP**2
        expected = 3.0 * ALBEDO / np.pi * 0.5 / squared**1.5 * np.array([1.0, 0.5, 0.25])
        np.testing.assert_allclose(light[y, x], expected, rtol=0.02)


def test_the_mirror_image_is_as_far_below_as_the_lamp_is_above(monkeypatch):
    monkeypatch.setattr(floor, "MIRROR_BLUR", 1e-9)
    eye, one = camera(), lamp([0.1, 0.6, 0.3])
    light = floor_light(eye, one, one, gain=0.0, exposure=1.0).sum(axis=2)
    rows, columns = np.indices(light.shape)
    found = np.array([(columns * light).sum(), (rows * light).sum()]) / light.sum()
    np.testing.assert_allclose(found, eye.project([[0.1, 0.6, -0.3]])[0][0], atol=2.0)


def test_the_haze_keeps_what_is_mirrored():
    eye, one = camera(), lamp([0.1, 0.6, 0.3])
    image = floor._mirror_image(eye, one, (48, 64))
    total = image.sum(axis=(0, 1)) * floor.FLOOR_SCALE**2
    np.testing.assert_allclose(total, [1.0, 0.5, 0.25], rtol=1e-4)


def test_what_is_mirrored_falls_with_the_square_of_its_way_if_the_film_does(monkeypatch):
    monkeypatch.setattr(floor, "MIRROR_BLUR", 1e-9)
    eye, one = camera(), lamp([0.1, 0.6, 0.3])
    plain, fallen = (floor._mirror_image(eye, one, (48, 64), falloff) for falloff in (False, True))
    away = np.array([0.1, 0.6, -0.3]) - eye.position
    np.testing.assert_allclose(plain, fallen * (away @ away), rtol=1e-5)


@pytest.mark.parametrize(
    ("eye", "lamps"),
    [
        (camera(height=-0.1), lamp([0, 0, 1])),
        (camera(), lamp([0, 0, -0.01])),
        (Camera([0, 0, 1], LEVEL, 50.0, [8, 8], 17, 5), lamp([0, 0, 1])),
    ],
    ids=["camera below", "drawn below", "looks level"],
)  # fmt: skip
def test_where_there_can_be_no_floor_there_is_none(eye, lamps):
    found = floor_light(eye, lamps, lamps, 1.0, 1.0)
    assert found is None or not found[:2].any()
