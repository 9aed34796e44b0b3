import numpy as np
import pytest

from dqpaint.errors import DqpaintError, UsageError
from dqpaint.light.camera.camera import DEFAULT_LENS, FRAME_FILL, VIEWS, Camera, View, frame_points

SIZES = [(1280, 720), (500, 500), (360, 640)]
ANGLES = [*VIEWS.values(), View(-37.0, 12.0), View(200.0, -64.0), View(10.0, 89.9)]


def turned(rng):
    """A random rotation matrix."""
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return q * np.linalg.det(q)


def box(camera, points):
    pixels, _ = camera.project(points)
    return pixels.min(axis=0), pixels.max(axis=0)


def test_projection_is_the_textbook_matrix():
    """Hartley and Zisserman, Multiple View Geometry, 6.1: x ~ K [R | -R c], axes x, y down, z."""
    rng = np.random.default_rng(1)
    rotation, place = turned(rng), rng.normal(size=3)
    camera = Camera(place, rotation, 700.0, [310.0, 220.0], 640, 480)
    points = place + rng.uniform(0.3, 2.0, (50, 1)) * (
        -rotation[2] + 0.4 * rng.uniform(-1, 1, (50, 2)) @ rotation[:2]
    )
    to_opencv = np.diag([1.0, -1.0, -1.0]) @ rotation
    K = np.array([[700.0, 0, 310.0], [0, 700.0, 220.0], [0, 0, 1]])
    P = K @ np.column_stack([to_opencv, -to_opencv @ place])
    seen = np.column_stack([points, np.ones(50)]) @ P.T
    pixels, depth = camera.project(points)
    np.testing.assert_allclose(depth, seen[:, 2], rtol=1e-12)
    np.testing.assert_allclose(pixels, seen[:, :2] / seen[:, 2:], rtol=1e-11, atol=1e-9)


def test_points_behind_have_no_pixel():
    camera = Camera([0, 0, 1], np.eye(3), 100.0, [50, 50], 101, 101)
    pixels, depth = camera.project([[0, 0, 0], [0, 0, 1], [0, 0, 2]])
    np.testing.assert_allclose(depth, [1, 0, -1])
    np.testing.assert_array_equal(pixels[0], [50, 50])
    assert np.isnan(pixels[1:]).all()


def test_right_is_right_and_up_is_up_on_a_turned_canvas():
    rotation = np.array(
        [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    )  # stands in the y-z plane
    canvas = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]])
    camera = frame_points(canvas @ rotation.T, rotation, VIEWS["front"], (640, 480))
    pixels, _ = camera.project(canvas @ rotation.T)
    assert pixels[1, 0] > pixels[0, 0] + 100
    assert pixels[2, 1] < pixels[0, 1] - 100
    np.testing.assert_allclose(pixels[1, 1], pixels[0, 1], atol=1e-9)
    np.testing.assert_allclose(camera.rotation, rotation.T, atol=1e-12)


@pytest.mark.parametrize(
    ("name", "direction"),
    [("front", [0, 0, 1]), ("side", [1, 0, 0]), ("top", [0, 1, 0]), ("iso", [1, 1, 1])],
)
def test_views_look_from_where_they_say(name, direction):
    camera = frame_points(np.eye(3), np.eye(3), VIEWS[name], (640, 480))
    np.testing.assert_allclose(
        camera.rotation[2], np.array(direction) / np.linalg.norm(direction), atol=1e-12
    )
    level = camera.rotation[0] @ [0, 1, 0]
    assert abs(level) < 1e-12
    assert camera.rotation[1] @ ([0, 1, 0] if name != "top" else [0, 0, -1]) > 0.0


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("view", ANGLES, ids=str)
def test_any_cloud_fills_the_frame_to_the_pixel(view, size):
    rng = np.random.default_rng([*size, round(view.azimuth) % 360, round(view.elevation) + 90])
    for count in (2, 3, 40, 1000):
        spans = rng.uniform(0.4, 1.0, 3) * rng.choice([0.15, 0.4, 3.0])
        points = rng.normal(size=3) + rng.uniform(-0.5, 0.5, (count, 3)) * spans
        canvas = turned(rng)
        camera = frame_points(points, canvas, view, size)
        low, high = box(camera, points)
        np.testing.assert_allclose((low + high) / 2, camera.centre, atol=1e-6)
        share = (high - low) / np.array(size)
        assert share.max() <= FRAME_FILL + 1e-9
        if count > 3:  # few points may be seen nearly in line
            np.testing.assert_allclose(share.max(), FRAME_FILL, atol=1e-9)
        assert camera.focal == DEFAULT_LENS * max(size)
        assert camera.centre.tolist() == [(size[0] - 1) / 2, (size[1] - 1) / 2]


@pytest.mark.parametrize("view", VIEWS.values(), ids=VIEWS)
def test_what_has_no_extent_is_framed_as_something_small(view):
    dot = frame_points([[0.5, 0.1, 0.7]] * 3, np.eye(3), view, (640, 360))
    pixels, depth = dot.project([[0.5, 0.1, 0.7]])
    np.testing.assert_allclose(pixels[0], dot.centre, atol=1e-9)
    np.testing.assert_allclose(
        0.04 / depth[0] * dot.focal, FRAME_FILL * 360
    )  # 4 cm fill the height
    for axis in np.eye(3):
        points = [0.5, 0.1, 0.7] + np.linspace(0, 0.3, 20)[:, None] * axis
        camera = frame_points(points, np.eye(3), view, (640, 360))
        low, high = box(camera, points)
        np.testing.assert_allclose((low + high) / 2, camera.centre, atol=1e-6)
        assert camera.project(points)[1].min() > 0.05
        assert ((high - low) / [640, 360]).max() <= FRAME_FILL + 1e-9


def test_the_camera_and_the_drawing_may_stand_anywhere():
    """Moved together with the world, the picture is the same."""
    rng = np.random.default_rng(5)
    points, canvas, move, turn = (
        rng.normal(size=(30, 3)),
        turned(rng),
        rng.normal(size=3),
        turned(rng),
    )
    here = frame_points(points, canvas, VIEWS["iso"], (640, 480))
    moved = points @ turn.T + move
    there = frame_points(moved, turn @ canvas, VIEWS["iso"], (640, 480))
    np.testing.assert_allclose(here.project(points)[0], there.project(moved)[0], atol=1e-8)


def test_nothing_or_no_number_cannot_be_framed():
    with pytest.raises(DqpaintError, match="nothing is lit"):
        frame_points(np.zeros((0, 3)), np.eye(3), VIEWS["front"], (640, 480))
    with pytest.raises(DqpaintError, match="not finite"):
        frame_points([[0, np.nan, 0]], np.eye(3), VIEWS["front"], (640, 480))
    with pytest.raises(UsageError, match="0x480"):
        frame_points([[0, 0, 0]], np.eye(3), VIEWS["front"], (0, 480))
    with pytest.raises(ValueError, match="reflection"):
        Camera([0, 0, 1], np.diag([1.0, 1.0, -1.0]), 100.0, [1, 1], 3, 3)
    with pytest.raises(ValueError, match="orthonormal"):
        Camera([0, 0, 1], 2 * np.eye(3), 100.0, [1, 1], 3, 3)


def test_coarser_pixels_cover_the_same_places(rng):
    camera = frame_points(rng.uniform(-0.2, 0.2, (50, 3)), np.eye(3), View(20, 10), (641, 361))
    points = rng.uniform(-0.1, 0.1, (20, 3))
    for scale in (0.5, 0.37, 1.0):
        coarse = camera.scaled(scale)
        assert (coarse.width, coarse.height) == (
            int(np.ceil(641 * scale)), int(np.ceil(361 * scale)),
        )  # fmt: skip
        edge = camera.project(points)[0] + 0.5  # from the picture's corner
        np.testing.assert_allclose(coarse.project(points)[0] + 0.5, scale * edge, atol=1e-9)


@pytest.mark.parametrize("focal", [0.0, -1.0, np.nan, np.inf])
def test_no_focal_length_is_refused(focal):
    with pytest.raises(ValueError, match="must be positive"):
        Camera([0, 0, 1], np.eye(3), focal, [0, 0], 8, 8)


def test_a_reflection_is_no_rotation():
    with pytest.raises(ValueError, match="reflection"):
        Camera([0, 0, 1], np.diag([1.0, 1.0, -1.0]), 100.0, [0, 0], 8, 8)


def test_one_pixel_is_a_picture():
    camera = frame_points(np.array([[0.1, 0.2, 0.3]]), np.eye(3), View(0, 0), (1, 1))
    assert (camera.width, camera.height) == (1, 1)
