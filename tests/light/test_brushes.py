"""Every brush of the registry: where its light goes, and what it says to a wrong text."""

import cv2
import numpy as np
import pytest

from dqpaint import dq
from dqpaint.brushes import BRUSHES, read_brush
from dqpaint.brushes.images import striped_image
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.light.camera.camera import VIEWS
from dqpaint.light.film.auto_exposure import automatic_exposure
from dqpaint.light.film.film import expose
from tests.support.camera_motion import camera_for, swept

ENERGY_TOLERANCE = 1e-9
STROBES = {"steady": {}, "strobe": {"strobe": (37.0, 0.3)}, "pwm": {"pwm": 210.0}}


def how(name, samples=400):
    given = dict(STROBES[name])
    if "strobe" in given:
        given["strobe"] = np.tile(given["strobe"], (samples - 1, 1))
    return given


@pytest.mark.parametrize("name", BRUSHES)
@pytest.mark.parametrize("flashing", STROBES)
@pytest.mark.parametrize("view", [*VIEWS, "200,-40"])
def test_all_light_is_on_film_or_lost(name, flashing, view):
    sweep = swept(read_brush(name).emitters(), 120, **how(flashing, 120))
    film = expose(sweep, camera_for(sweep, view, (160, 90)))
    np.testing.assert_allclose(film.on_film + film.lost, film.emitted, rtol=ENERGY_TOLERANCE)
    assert (film.planes >= 0).all()
    assert (film.on_film > 0).all()


@pytest.mark.parametrize("name", BRUSHES)
def test_so_it_is_where_much_of_it_misses_the_picture(name):
    sweep = swept(read_brush(name).emitters(), 120)
    far = camera_for(sweep, size=(160, 90))
    near = type(far)(
        far.position - 0.6 * (far.position - sweep.positions.mean(axis=0)),
        far.rotation, 3 * far.focal, np.add(far.centre, [70.0, 20.0]), far.width, far.height,
    )  # fmt: skip
    for falloff in (False, True):
        film = expose(sweep, near, falloff)
        np.testing.assert_allclose(film.on_film + film.lost, film.emitted, rtol=ENERGY_TOLERANCE)
        assert (film.lost > 0.05 * film.emitted).all()


@pytest.mark.parametrize("name", [n for n in BRUSHES if n != "pixelstick"])
def test_a_brush_gives_as_much_light_as_one_lamp(name):
    emitters = read_brush(name).emitters()
    np.testing.assert_allclose(emitters.tints.sum(axis=1), 1.0, rtol=1e-12)
    sweep = swept(emitters, 50)
    film = expose(sweep, camera_for(sweep))
    np.testing.assert_allclose(film.emitted, np.array([1.0, 0.6, 0.2]) * 0.49, rtol=1e-9)


@pytest.mark.parametrize("name", BRUSHES)
def test_two_runs_are_identical_to_the_bit_whatever_the_threads(name):
    sweep = swept(read_brush(name).emitters(), 200)
    camera = camera_for(sweep)
    first = expose(sweep, camera).planes
    before = cv2.getNumThreads()
    try:
        for threads in (1, 2):
            cv2.setNumThreads(threads)
            assert np.array_equal(expose(sweep, camera).planes, first)
    finally:
        cv2.setNumThreads(before)


@pytest.mark.parametrize("name", BRUSHES)
def test_a_standing_light_loses_nothing(name):
    sweep = swept(read_brush(name).emitters(), 60)
    still = type(sweep)(0.01, np.tile(sweep.pose[:1], (60, 1)), sweep.colours, sweep.emitters)
    film = expose(still, camera_for(sweep, size=(640, 360)))
    np.testing.assert_allclose(film.on_film, film.emitted, rtol=1e-9)


def test_lamps_of_a_bar_are_where_the_tool_carries_them():
    """By rotation matrices, and not by the quaternions that carry them."""
    sweep = swept(read_brush("bar:length=120mm,leds=5,along=y,joined=0").emitters(), 30)
    camera = camera_for(sweep)
    light = next(sweep.emission_to(camera))
    T = dq.matrix_from_pose(sweep.pose)
    lamps = 0.12 * ((np.arange(5) + 0.5) / 5 - 0.5)
    for lamp, run in zip(lamps, light.points.reshape(5, -1, 3), strict=True):
        truth = T[:, :3, 3] + lamp * T[:, :3, 1]
        np.testing.assert_allclose(run[0], truth[0], atol=1e-12)
        np.testing.assert_allclose(run[-1], truth[-1], atol=1e-12)
        nearest = np.linalg.norm(truth[:, None] - run[None], axis=2).min(axis=1)
        assert nearest.max() < 1e-9


def test_a_lobe_is_the_power_of_the_cosine_and_dark_behind():
    sweep = swept(read_brush("point:lobe=3").emitters(), 40)
    camera = camera_for(sweep, "front")
    plain = swept(read_brush("point").emitters(), 40)
    energy = np.concatenate([piece.energy for piece in sweep.emission_to(camera)])
    whole = np.concatenate([piece.energy for piece in plain.emission_to(camera)])
    T = dq.matrix_from_pose(sweep.pose)
    ray = camera.position - sweep.positions
    cosine = (ray * T[:, :3, 2]).sum(axis=1) / np.linalg.norm(ray, axis=1)
    expected = np.clip(cosine, 0, None) ** 3
    middle = 0.5 * (expected[1:] + expected[:-1])
    np.testing.assert_allclose(energy[:, 0] / whole[:, 0], middle, atol=2e-3)
    assert (energy[cosine[1:] < -0.05] == 0).all()


def test_a_ball_is_an_even_disc_of_its_size():
    sweep = swept(read_brush("ball:size=20mm").emitters(), 2)
    still = type(sweep)(0.01, np.tile(sweep.pose[:1], (2, 1)), sweep.colours, sweep.emitters)
    camera = camera_for(swept(read_brush("point").emitters()), size=(960, 540))
    plane = expose(still, camera).planes[0]
    _, depth = camera.project(still.positions)
    radius = 0.01 * camera.focal / depth[0]
    assert radius > 10
    y, x = np.mgrid[: plane.shape[0], : plane.shape[1]]
    centre = np.array([(y * plane).sum(), (x * plane).sum()]) / plane.sum()
    away = np.hypot(y - centre[0], x - centre[1])
    np.testing.assert_allclose((away**2 * plane).sum() / plane.sum(), radius**2 / 2, rtol=0.05)
    inner = plane[away < 0.75 * radius]
    assert np.ptp(inner) < 0.1 * inner.mean()
    assert plane[away > 1.25 * radius].sum() < 1e-9 * plane.sum()


@pytest.mark.parametrize("ground", [0, 20])  # black, and as a camera's file has it
def test_the_dark_ground_of_an_image_is_not_metered(ground, tmp_path):
    image = np.full((64, 90, 3), ground, np.uint8)
    image[24:40, 30:60] = 255
    cv2.imwrite(str(tmp_path / "mark.png"), image)
    cv2.imwrite(str(tmp_path / "white.png"), np.full_like(image, 255))
    found = []
    for name in ("mark", "white"):
        brush = read_brush(f"pixelstick:image={tmp_path}/{name}.png,leds=64,length=120mm")
        sweep = swept(brush.emitters(), 200, colours=np.ones((199, 3)))
        camera = camera_for(sweep)
        found.append(automatic_exposure(sweep, camera))
    assert 1.0 < found[0] / found[1] < 3.0  # a small mark is narrower than the areas


def test_an_image_goes_along_the_way_and_along_the_bar(tmp_path):
    image = np.zeros((8, 20, 3), np.uint8)
    image[:4, :10] = [0, 0, 255]  # OpenCV's order: red above at first
    image[4:, 10:] = [255, 0, 0]  # blue below at last
    cv2.imwrite(str(tmp_path / "image.png"), image)
    brush = read_brush(f"pixelstick:image={tmp_path}/image.png,leds=8,joined=0")
    tints = brush.emitters().tints * 8
    assert tints.shape == (20, 8, 3)
    np.testing.assert_allclose(tints[:10, 4:], np.broadcast_to([1.0, 0, 0], (10, 4, 3)), atol=1e-9)
    np.testing.assert_allclose(tints[10:, :4], np.broadcast_to([0, 0, 1.0], (10, 4, 3)), atol=1e-9)
    assert not tints[:10, :4].any()
    sweep = swept(brush.emitters(), 200, colours=np.ones((199, 3)))
    light = next(sweep.emission_to(camera_for(sweep)))
    red, blue = light.energy[:, 0], light.energy[:, 2]
    runs = (len(light.energy) + 1) // 8
    first_run = slice(7 * runs, 8 * runs - 1)  # the uppermost lamp
    way = np.cumsum(
        np.linalg.norm(np.diff(light.points[first_run.start : first_run.stop + 1], axis=0), axis=1)
    )
    half = np.searchsorted(way, way[-1] / 2)
    assert red[first_run][: half - 2].all()
    assert not red[first_run][half + 2 :].any()
    assert blue[: runs - 1][half + 2 :].all()


def test_colours_run_from_end_to_end():
    tints = read_brush("bar:leds=3,colours=red/white/0000ff").emitters().tints[0] * 3
    np.testing.assert_allclose(tints[1], 1.0)
    assert tints[0, 0] == 1.0
    assert 0.2 < tints[0, 1] < 0.5
    assert striped_image(5).shape == (110, 5, 3)


@pytest.mark.parametrize(("text", "says"), [
    ("broom", "'broom'"),
    ("bar:size=3mm", "no 'size'; "),
    ("bar:length=300", "brush 'bar': length '300'"),
    ("bar:length", "'length'"),
    ("bar:length=1mm,length=2mm", "twice"),
    ("bar:length=0mm", "length '0mm'"),
    ("bar:length=1e999m", "length '1e999m'"),
    ("bar:length=..mm", "'..mm'"),
    ("bar:along=up", "along 'up'"),
    ("bar:colours=rde", "'rde'"),
    ("bar:leds=5000", "2000"),
    ("pixelstick:leds=1", "leds '1'"),
    ("point:lobe=nan", "lobe 'nan'"),
    ("fibre:fibres=0", "fibres '0'"),
])  # fmt: skip
def test_a_wrong_text_is_answered_with_what_would_be_right(text, says):
    with pytest.raises(UsageError) as caught:
        read_brush(text)
    assert says in str(caught.value)


def test_an_image_that_is_none(tmp_path):
    (tmp_path / "a.png").write_bytes(b"no picture")
    (tmp_path / "empty.png").write_bytes(b"")
    for name, says in [
        ("a.png", "not a picture"),
        ("empty.png", "not a picture"),
        ("b", "No such"),
    ]:
        with pytest.raises(DqpaintError, match=says):
            read_brush(f"pixelstick:image={tmp_path}/{name}").emitters()
