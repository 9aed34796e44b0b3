"""Real exposure settings against the photometry they come from."""

import math
import re

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.brushes import read_brush
from dqpaint.errors import UsageError
from dqpaint.light.camera.camera import VIEWS, View, frame_points
from dqpaint.light.camera.exposure_settings import (
    CAMERA_CLEARANCE,
    Exposure,
    equivalent_exposure,
    parse_exposure,
)
from dqpaint.light.film.film import expose
from dqpaint.light.film.point_spread import point_spread, spread
from dqpaint.light.sources.sweep import Sweep
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import installed_names, read_card


def line(metres=0.4, speed=0.23, samples=400):
    x = np.linspace(-metres / 2, metres / 2, samples)
    pose = dq.pose_from(np.column_stack([x, 0 * x, 0 * x]), np.tile([1.0, 0, 0, 0], (samples, 1)))
    period = metres / speed / (samples - 1)
    return Sweep(period, pose, np.ones((samples - 1, 3)), read_brush("point").emitters())


def ridge(text, size=(1920, 1081), view=VIEWS["front"]):  # the line lies on a row
    real, sweep = parse_exposure(text), line()
    camera = frame_points(sweep.lit_points, np.eye(3), view, size, real.lens, real.distance)
    image = spread(expose(sweep, camera, falloff=True), point_spread(size[1]))
    return float(image[size[1] // 2 - 3 : size[1] // 2 + 3, size[0] // 2, 0].max()) * real.factor(
        camera
    )


def test_a_led_at_photographers_settings_is_four_stops_over():
    """1 cd at 0.23 m/s from 2.2 m, 35 mm, f/8, ISO 100, 1920 px: 18 times saturation or so.

    That is with a core of 1 px, of which a line's ridge is 0.35; ours is a little wider.
    """
    sharper = 0.35 / point_spread(1081).line_peak
    assert ridge("f/8,iso100,35mm,1cd,2.2m") * sharper == pytest.approx(18.0, rel=0.1)
    # and by hand: illuminance on the sensor times time, over H = 78 / S, times the core's ridge
    pitch, r = 0.036 / 1920, 2.2
    lux_seconds = math.pi / 4 * (0.035 / 8) ** 2 * 0.9 / r**2 / pitch**2
    seconds_a_pixel = 1 / (0.23 * 0.035 / 0.036 * 1920 / r)
    by_hand = lux_seconds * seconds_a_pixel * 100 / 78 * point_spread(1081).line_peak
    assert ridge("35mm,2.2m") == pytest.approx(by_hand, rel=0.01)


def test_stops_are_stops():
    base = ridge("f/8,iso100,35mm,2.2m")
    for text, factor in {
        "f/16,35mm,2.2m": 1 / 4, "iso400,35mm,2.2m": 4.0, "nd3,35mm,2.2m": 1 / 8,
        "0.05cd,35mm,2.2m": 0.05,
    }.items():  # fmt: skip
        assert ridge(text) == pytest.approx(base * factor, rel=1e-6), text


def test_twice_as_far_a_line_is_half_as_bright():
    """A quarter of the light, but half as many pixels a second."""
    near, far = ridge("35mm,1m"), ridge("35mm,2m")
    assert far / near == pytest.approx(0.5, rel=0.01)


def test_a_step_nearer_to_the_camera_is_brighter_by_its_distance_squared():
    sweep = line()
    camera = frame_points(sweep.lit_points, np.eye(3), View(60.0, 0.0), (640, 360))
    plain, real = (
        [p.energy for p in sweep.emission_to(camera, falloff)] for falloff in (False, True)
    )
    middle = 0.5 * (sweep.positions[1:] + sweep.positions[:-1])
    r = np.linalg.norm(middle - camera.position, axis=1)
    np.testing.assert_allclose(real[0][:, 0], plain[0][:, 0] / r**2, rtol=1e-12)
    assert r.max() > 1.3 * r.min()


def test_distance_and_focal_length_are_those_of_the_camera():
    sweep = line()
    real = parse_exposure("50mm,1.5m")
    camera = frame_points(
        sweep.lit_points, np.eye(3), VIEWS["front"], (900, 600), real.lens, real.distance
    )
    assert camera.focal == pytest.approx(50 / 36 * 900)
    np.testing.assert_allclose(camera.position, [0, 0, 1.5], atol=1e-12)
    left, right = camera.project([[-0.2, 0, 0], [0.2, 0, 0]])[0][:, 0]
    assert (right - left) / 900 * 36 == pytest.approx(0.4 / 1.5 * 50)  # mm on the sensor


def test_advice_gives_back_what_it_was_asked():
    """The automatic's factor, taken as real settings, is the same picture."""
    real = Exposure(candela=0.13)
    sweep = line()
    camera = frame_points(sweep.lit_points, np.eye(3), VIEWS["front"], (1280, 720))
    distance = float(camera.position[2])
    factor = real.factor(camera) / distance**2
    middle = np.zeros(3)
    assert equivalent_exposure(factor, camera, middle, 31.2, fixed=True) == (
        f"as f/8, ISO 100, 32 s (bulb), 40 mm at {distance:.2g} m, "
        "LED of 0.13 cd (or 1.04 cd behind 3 stops of ND)"
    )
    assert "13 mcd" in equivalent_exposure(0.1 * factor, camera, middle, 3.0, fixed=True)


@pytest.mark.parametrize("middle", [[0.0, 0.0, 0.0], [0.3, 0.1, 0.6]])
def test_the_advised_camera_stands_out_of_reach_and_takes_the_same_picture(middle):
    middle = np.array(middle)
    sweep = line()
    points = sweep.lit_points + middle
    camera = frame_points(points, np.eye(3), VIEWS["front"], (1280, 720))
    factor = 3.0 * Exposure().factor(camera)
    text = equivalent_exposure(factor, camera, middle, 9.5)
    seconds, lens, distance, led = re.search(
        r"(\d+) s, (\d+) mm at ([\d.]+) m, LED of ([\d.]+ m?cd)", text
    ).groups()
    lens, distance = float(lens) / 1000, float(distance)
    assert seconds == "10"
    assert np.linalg.norm(middle + np.array([0, 0, distance])) > 0.99 * CAMERA_CLEARANCE
    near = float(camera.position[2] - middle[2])
    assert lens / distance == pytest.approx(0.04 / near, rel=0.05)
    intensity = float(led.split()[0]) * (1e-3 if "mcd" in led else 1.0)
    far = Exposure(focal=lens, candela=intensity)
    assert far.factor(camera) / distance**2 == pytest.approx(factor, rel=0.1)


@pytest.mark.parametrize("name", installed_names())
def test_no_arm_reaches_an_advised_camera(name):
    arm = Kinematics(read_card(name))
    low, high = arm.card.lower, arm.card.upper
    postures = np.random.default_rng(7).uniform(low, high, (300, len(low)))
    tools = dq.translation(arm.poses(postures))
    assert 0.5 < np.linalg.norm(tools, axis=1).max() < CAMERA_CLEARANCE


def test_settings_read_as_they_are_written():
    assert parse_exposure("auto") is None
    assert parse_exposure(" F/5.6 , ISO200,50mm,nd1.5,.2cd,3m") == Exposure(
        5.6, 200.0, 0.05, 1.5, 0.2, 3.0
    )
    assert parse_exposure("f/8,30s") == Exposure(shutter=30.0)
    assert str(parse_exposure("0.5s")) == "f/8, ISO 100, 40 mm, 0.5 s, LED of 1 cd"
    assert str(parse_exposure("nd3,1cd")) == "f/8, ISO 100, 40 mm, ND 3 stops, LED of 1 cd"


@pytest.mark.parametrize(("text", "says"), [
    ("", "'' is not a part of an exposure; its parts: f/8 (aperture), iso100, 35mm"),
    ("f8", "'f8' is not a part"),
    ("f/8,,iso100", "'' is not a part"),
    ("f/8,f/11", "a part like f/8 is given twice"),
    ("f/0", "'f/0' must be from 0.5 to 128, as in f/8"),
    ("iso0", "'iso0' must be from 1 to 1e+06"),
    ("f/8,2200mm", "'2200mm' must be from 4 to 2000"),
    ("f/-8", "'f/-8' is not a part"),
    ("infcd", "'infcd' is not a part"),
    ("nd99", "'nd99' must be from 0 to 30"),
])  # fmt: skip
def test_wrong_settings_name_the_part(text, says):
    with pytest.raises(UsageError) as caught:
        parse_exposure(text)
    assert says in str(caught.value)
