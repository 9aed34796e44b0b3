import numpy as np
import pytest

from dqpaint.errors import UsageError
from dqpaint.light.camera.camera import FRAME_FILL, VIEWS, View, frame_points
from dqpaint.light.camera.views import EYE_DISTANCE_RATIO, camera_for_shot, parse_views
from tests.support.camera_motion import FRONT

POINTS = np.random.default_rng(4).uniform(-0.2, 0.2, (200, 3)) * [1.0, 0.5, 0.3] + [0.5, 0, 0.4]
SIZE = (640, 360)


def test_names_and_numbers_share_the_comma():
    shots = parse_views("front, 20,30,iso,-5.5,0")
    assert [shot.name for shot in shots] == ["front", "az20-el30", "iso", "az-5.5-el0"]
    assert shots[1].view == View(20.0, 30.0)


@pytest.mark.parametrize("name", VIEWS)
def test_one_view_is_the_camera_it_always_was(name):
    a = camera_for_shot(parse_views(name)[0], POINTS, FRONT, SIZE)
    b = frame_points(POINTS, FRONT, VIEWS[name], SIZE)
    assert np.array_equal(a.position, b.position)
    assert a.focal == b.focal


def test_the_eyes_of_a_pair_stand_side_by_side_and_see_the_middle_in_one_place():
    left, right = (camera_for_shot(s, POINTS, FRONT, SIZE) for s in parse_views("stereo:iso"))
    base = frame_points(POINTS, FRONT, VIEWS["iso"], SIZE)
    apart = right.position - left.position
    np.testing.assert_allclose(apart @ base.rotation[0], np.linalg.norm(apart), rtol=1e-12)
    depth = base.project(POINTS)[1]
    middle = 0.5 * (depth.min() + depth.max())
    np.testing.assert_allclose(np.linalg.norm(apart), EYE_DISTANCE_RATIO * middle, rtol=1e-12)
    a, b = left.project(POINTS)[0], right.project(POINTS)[0]
    np.testing.assert_allclose(a[:, 1], b[:, 1], atol=1e-9)  # nothing is higher in one eye
    disparity = a[:, 0] - b[:, 0]
    assert (np.sign(disparity) == np.sign(middle - depth)).all()  # what is near is left of itself
    at_middle = base.position - middle * base.rotation[2]
    np.testing.assert_allclose(left.project(at_middle[None])[0], right.project(at_middle[None])[0])


def test_an_orbit_keeps_its_distance_and_everything_in_the_picture():
    cameras = [camera_for_shot(s, POINTS, FRONT, SIZE) for s in parse_views("orbit:9:30")]
    local = POINTS @ FRONT
    middle = FRONT @ (0.5 * (local.min(axis=0) + local.max(axis=0)))
    away = [np.linalg.norm(c.position - middle) for c in cameras]
    np.testing.assert_allclose(away, away[0], rtol=1e-12)
    for camera in cameras:
        pixels, _ = camera.project(POINTS)
        share = np.abs(pixels - camera.centre).max(axis=0) * 2 / SIZE
        assert share.max() <= FRAME_FILL + 1e-9
        up = camera.rotation[2] @ FRONT[:, 1]
        assert up == pytest.approx(np.sin(np.radians(30)))
    names = [s.name for s in parse_views("orbit")]
    assert (names[0], names[-1], len(names)) == ("orbit-00", "orbit-11", 12)


@pytest.mark.parametrize("text", ["at:1.7:-0.9:0.9:0.4:0.1:0.3", "at:-0.5:0.6:0.1:0.4:0.1:0.3"])
def test_a_camera_that_is_put_somewhere_stands_there_upright_and_looks_there(text):
    place, target = np.split(np.array(text.split(":")[1:], float), 2)
    camera = camera_for_shot(parse_views(text)[0], POINTS, FRONT, SIZE, lens=2.0)
    np.testing.assert_allclose(camera.position, place)
    pixel, depth = camera.project(target[None])
    np.testing.assert_allclose(pixel[0], camera.centre, atol=1e-9)
    np.testing.assert_allclose(depth, np.linalg.norm(place - target))
    assert camera.rotation[0] @ FRONT[:, 1] == pytest.approx(0, abs=1e-12)  # level
    assert camera.rotation[1] @ FRONT[:, 1] > 0  # not upside down
    assert camera.focal == 2.0 * max(SIZE)


def test_without_a_target_it_looks_at_the_middle_of_the_drawing_even_from_right_above():
    local = POINTS @ FRONT
    middle = FRONT @ (0.5 * (local.min(axis=0) + local.max(axis=0)))
    for away in (FRONT[:, 1], FRONT @ [0.3, -0.4, 1.2]):
        x, y, z = middle + away
        camera = camera_for_shot(parse_views(f"at:{x}:{y}:{z}")[0], POINTS, FRONT, SIZE)
        np.testing.assert_allclose(camera.project(middle[None])[0][0], camera.centre, atol=1e-6)


def test_a_camera_with_the_drawing_at_its_back_is_refused():
    (shot,) = parse_views("at:3:0:0.4:4:0:0.4")
    with pytest.raises(UsageError, match="looks away"):
        camera_for_shot(shot, POINTS, FRONT, SIZE)


@pytest.mark.parametrize(("text", "says"), [
    ("back", "no view named 'back'; known: front, iso, side, top, AZ,EL in degrees, stereo[:VIEW]"),
    ("20", "no view named '20'; known"),
    ("front,20", "no view named 'front,20'"),
    ("20,iso", "no view named '20,iso'"),
    ("", "no view named ''"),
    ("front,front", "front is given twice"),
    ("0,91", "view elevation 91 deg must be from -90 to 90"),
    ("nan,0", "no view named 'nan'"),
    ("orbit:1", "an orbit has 2 to 360 views"),
    ("orbit:9999", "an orbit has 2 to 360 views"),
    ("orbit:2.5", "is not orbit, orbit:N or orbit:N:EL"),
    ("orbit:x", "is not orbit, orbit:N or orbit:N:EL"),
    ("orbit:1:2:3", "is not orbit, orbit:N or orbit:N:EL"),
    ("orbit:8:99", "view elevation 99"),
    ("at:1:2", "is not at:X:Y:Z or at:X:Y:Z:X:Y:Z, the positions of the camera and of its target"),
    ("at:1:2:3:4", "is not at:X:Y:Z"),
    ("at:1:2:x", "is not at:X:Y:Z"),
    ("at:1:2:inf", "is not at:X:Y:Z"),
    ("at:1:2:101", "at most 100"),
    ("at:1:2:3:1:2:3", "the camera is at its target"),
    ("stereo:back", "is not stereo, stereo:NAME or stereo:AZ:EL"),
])  # fmt: skip
def test_wrong_views(text, says):
    with pytest.raises(UsageError) as caught:
        parse_views(text)
    assert says in str(caught.value)
