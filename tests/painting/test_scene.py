"""Scenes: brushes of a drawing, light that tells, deviations magnified."""

from dataclasses import replace

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.language import parse, read
from dqpaint.light.camera.views import parse_views
from dqpaint.light.film.film import expose
from dqpaint.metrics import reference_columns
from dqpaint.motion import plan
from dqpaint.painting.colour_by import colour_columns, common_delay, magnified_poses, scale_limits
from dqpaint.painting.picture import camera_of_view, photograph
from dqpaint.painting.preview import make_preview
from dqpaint.painting.scene import check_light_settings, make_scene
from dqpaint.program.program import Brush, Strobe
from dqpaint.robots.model.card import read_card
from dqpaint.settings.model import make_settings
from tests.support.pictures import take

CANVAS = read_card("iiwa").canvas.pose
SMALL = {"width": 320, "height": 180}
TEXT = "period 10 ms\nline to (80, 0) mm light red\nline to (80, 60) mm light blue\n"


def program(text=TEXT, *changes):
    made = parse(text, "test.traj")
    segments = tuple(
        replace(segment, **change) for segment, change in zip(made.segments, changes, strict=False)
    )
    return replace(made, segments=segments + made.segments[len(segments) :])


def motion_of(*changes, text=TEXT):
    return plan(program(text, *changes), CANVAS)


BAR = Brush("bar", (("length", 0.1), ("along", (0.0, 1.0, 0.0))), several=True)


def test_each_brush_of_a_drawing_shines_in_its_own_strokes():
    motion = motion_of({"brush": BAR}, {"brush": Brush()})
    scene = make_scene(motion, motion.pose, make_settings(**SMALL))
    bar, point = scene.light
    assert len(bar.emitters.positions) == 14
    assert point.emitters.single
    assert not bar.colours[:, 2].any()
    assert not point.colours[:, 0].any()
    camera = camera_of_view(scene, make_settings(**SMALL), parse_views("front")[0])
    film = expose(scene.light, camera)
    np.testing.assert_allclose(film.emitted, motion.light.sum(axis=0) * motion.period, rtol=1e-9)
    np.testing.assert_allclose(film.on_film + film.lost, film.emitted, rtol=1e-9)


def test_the_option_beats_the_drawing_s_brush():
    motion = motion_of({"brush": BAR})
    scene = make_scene(motion, motion.pose, make_settings(brush="ball:size=10mm", **SMALL))
    assert [s.emitters.size for s in scene.light] == [0.01]


@pytest.mark.parametrize(("option", "words"), [
    ("ball:size=8mm", "ball 8 mm"),
    ("bar:length=90mm,leds=5,along=y", "bar 90 mm leds 5 along y"),
    ("ribbon:length=90mm,colours=red/blue", "ribbon 90 mm colours red to blue"),
    ("pixelstick:length=90mm,leds=9,times=2", "pixelstick 90 mm leds 9 times 2"),
    ("fibre:fibres=7,seed=3", "fibre fibres 7 seed 3"),
])  # fmt: skip
def test_a_brush_of_the_drawing_and_of_the_option_have_one_picture(option, words):
    plain = "period 10 ms\nstart at (0, 0) mm\nscrew about (0, 9) mm along y angle 90 deg in 0.4 s"
    films = []
    for text, choice in ((f"brush {words}\n{plain}", None), (plain, option)):
        motion, settings = plan(parse(text, "a"), CANVAS), make_settings(brush=choice, **SMALL)
        scene = make_scene(motion, motion.pose, settings)
        films.append(expose(scene.light, camera_of_view(scene, settings, parse_views("iso")[0])))
    assert films[0].on_film.any()
    np.testing.assert_array_equal(films[0].planes, films[1].planes)


def test_a_strobe_of_the_drawing_flashes_by_the_run_s_clock():
    motion = motion_of({}, {"strobe": Strobe(8.0, 0.25)})
    sweep = make_scene(motion, motion.pose, make_settings(**SMALL)).light[0]
    first = np.flatnonzero(motion.stroke == 1)[0]
    begin, end = motion.t[first], motion.t[-1]
    fine = begin + (np.arange(400_000) + 0.5) / 400_000 * (end - begin)
    on = ((fine * 8.0) % 1.0 < 0.25).mean() * (end - begin)
    scene_camera = camera_of_view(
        make_scene(motion, motion.pose, make_settings(**SMALL)),
        make_settings(**SMALL),
        parse_views("front")[0],
    )
    film = expose(sweep, scene_camera)
    assert film.emitted[2] == pytest.approx(on, rel=1e-4)
    assert film.emitted[0] == pytest.approx(motion.light[:, 0].sum() * motion.period, rel=1e-12)


@pytest.mark.parametrize("endless", [{"pwm": 1e5}, {}])
def test_more_flashes_than_anyone_would_wait_for_are_refused(endless):
    strobed = {} if endless else {"strobe": Strobe(1e9, 0.5)}
    motion = motion_of({}, strobed, text=TEXT + "hold 60 s\n")
    with pytest.raises(DqpaintError, match=r"2,000,000 flashes"):
        make_scene(motion, motion.pose, make_settings(**endless, **SMALL))


def test_a_bar_is_in_the_picture_with_its_ends():
    settings = make_settings(brush="bar:length=300mm,along=y", **SMALL)
    picture = take(motion_of(), motion_of().pose, settings)
    assert not picture.film.lost.any()


@pytest.mark.parametrize("by", ["speed", "line"])
def test_colours_tell_and_every_millimetre_is_equally_bright(by):
    text = "period 10 ms\nprofile constant\nline by (80, 0) mm in 1 s\nline by (0, 40) mm in 4 s\n"
    motion = motion_of(text=text)
    scene = make_scene(motion, motion.pose, make_settings(colour_by=by, **SMALL))
    colours = scene.light[0].colours
    first, second = colours[:100], colours[100:]
    assert np.ptp(first, axis=0).max() < 1e-6 * first.max()
    a, b = first[50] / 0.8, second[50] / 0.1  # over mm a step
    for tint in (a / a.max(), b / b.max()):
        assert tint.max() == 1.0
    assert np.abs(a / a.max() - b / b.max()).max() > 0.2
    assert scene.legend.title.startswith({"speed": "speed [mm/s]", "line": "line"}[by])
    even = make_scene(motion, motion.pose, make_settings(colour_by="line", **SMALL)).light[0]
    lightness = even.colours.sum(axis=1) / even.lamp_travel
    assert lightness[50] == pytest.approx(lightness[150], rel=0.5)


def test_lines_of_included_files_have_colours_of_their_own(tmp_path):
    """The same numbers in two files are two lines, each named with its own words."""
    (tmp_path / "petal.traj").write_text("line by (0, 9) mm light red\n")
    main = tmp_path / "a.traj"
    main.write_text('line by (9, 0) mm light lime\ninclude "petal.traj"\nline by (9, 9) mm\n')
    motion = plan(read(main), CANVAS)
    scene = make_scene(motion, motion.pose, make_settings(colour_by="line", **SMALL))
    assert scene.legend.labels == (
        "1  line by (9, 0) mm light lime",
        "3  line by (9, 9) mm",
        f"{tmp_path}/petal.traj:1  line by (0, 9) mm light red",
    )
    colours = scene.light[0].colours
    shown = colours / np.maximum(colours.max(axis=1, keepdims=True), 1e-9)
    kinds = {}
    for line, colour in zip(motion.source.index[:-1].tolist(), shown.tolist(), strict=False):
        kinds.setdefault(line, set()).add(tuple(np.round(colour, 6)))
    assert [len(kinds[i]) for i in range(3)] == [1, 1, 1]
    assert len(set.union(*kinds.values())) == 3


@pytest.mark.parametrize("by", [n for n in colour_columns() if n not in ("speed", "line")])
def test_what_only_an_arm_has_is_refused_without_one(by):
    with pytest.raises(UsageError, match=f"colour by {by} needs an arm: use draw; .*: line, speed"):
        make_preview(program(), make_settings(colour_by=by, **SMALL))


@pytest.mark.parametrize(("choice", "says"), [
    ({"view": "back"}, "'back'"),
    ({"look": "velvia"}, "'velvia'"),
    ({"brush": "broom"}, "'broom'"),
    ({"exposure": "f8"}, "'f8'"),
    ({"colour_by": "mood:3"}, "'mood'"),
    ({"colour_by": "position-error:"}, "mm"),
    ({"colour_by": "position-error:-1"}, "for position-error, orientation-error, invariant"),
    ({"colour_by": "speed:nan"}, "mm/s"),
    ({"colour_by": "line:3"}, "scale"),
    ({"colour_by": "mood"}, "'mood'"),
])  # fmt: skip
def test_slips_are_told_first(choice, says):
    with pytest.raises(UsageError, match=says):
        check_light_settings(make_settings(**choice))


@pytest.mark.parametrize(
    "choice", [{"starburst": 2}, {"starburst": 99}, {"pwm": -1.0}, {"magnify": 0.0}]
)
def test_numbers_out_of_bounds(choice):
    with pytest.raises(UsageError, match=next(iter(choice))):
        check_light_settings(make_settings(**choice))


def test_a_deviation_is_magnified_about_the_asked_path():
    motion = motion_of()
    aside = dq.pose_from([0.0, 0.0, 1e-4], [1.0, 0, 0, 0])
    near = dq.mul(aside, motion.pose)
    far = magnified_poses(motion, near, 50.0)
    np.testing.assert_allclose(
        dq.translation(far) - motion.points, [[0, 0, 5e-3]] * len(far), atol=1e-9
    )
    assert np.array_equal(magnified_poses(motion, motion.pose, 7.0).shape, motion.pose.shape)
    np.testing.assert_allclose(
        dq.translation(magnified_poses(motion, motion.pose, 7.0)), motion.points, atol=1e-9
    )


def test_an_orientation_is_magnified_too():
    motion = motion_of()
    turn = dq.pose_from(np.zeros(3), [np.cos(5e-4), 0.0, np.sin(5e-4), 0.0])
    far = magnified_poses(motion, dq.mul(motion.pose, turn), 30.0)
    angle = 2 * np.linalg.norm(dq.log(dq.mul(dq.conj(motion.pose), far))[:, :3], axis=1)
    np.testing.assert_allclose(angle, 0.03, rtol=1e-6)


@pytest.mark.parametrize("rows", [0.0, 3.0, 7.4])
def test_what_only_comes_late_is_on_the_path_however_magnified(rows):
    motion = motion_of(text="period 10 ms\narc centre (40, 0) mm angle 300 deg in 4 s\n")
    at = np.maximum(np.arange(len(motion.t)) - rows, 0)
    below = np.minimum(at.astype(int), len(at) - 2)
    late = dq.sclerp(motion.pose[below], motion.pose[below + 1], at - below)
    assert common_delay(motion, dq.translation(late)) == pytest.approx(rows, abs=0.05)
    far = dq.translation(magnified_poses(motion, late, 20.0))
    centre = dq.translation(dq.mul(CANVAS, dq.pose_from([0.04, 0, 0], [1.0, 0, 0, 0])))
    np.testing.assert_allclose(np.linalg.norm(far - centre, axis=1), 0.04, atol=3e-4)


def test_scales_are_round():
    assert scale_limits(np.array([0.0, 0.013, 0.017]), True) == (0.0, 0.02)
    assert scale_limits(np.array([3.0, 3.0]), False)[0] <= 3.0
    low, high = scale_limits(np.linspace(0.051, 0.0932, 500), False)
    assert (low, high) == (pytest.approx(0.05, abs=0.006), pytest.approx(0.093, abs=0.006))
    assert scale_limits(np.zeros(4), True)[1] > 0


def test_the_asked_drawing_lies_beneath():
    motion = motion_of()
    settings = make_settings(overlay=True, **SMALL)
    aside = dq.mul(dq.pose_from([0.0, 0.0, 0.02], [1.0, 0, 0, 0]), motion.pose)
    with_it = take(motion, aside, settings)
    without = take(motion, aside, make_settings(**SMALL))
    np.testing.assert_allclose(
        with_it.film.emitted, without.film.emitted
    )  # it is no light of the lamp
    pixels, _ = with_it.camera.project(motion.points[motion.lit])
    column, row = np.rint(np.median(pixels[:50], axis=0)).astype(int)
    assert with_it.image[row, column].max() > without.image[row, column].max() + 40
    assert with_it.image.max() <= 255


def test_several_views_are_of_one_scene_and_a_series_has_one_exposure():
    motion = motion_of()
    settings = make_settings(view="front,top,stereo,orbit:3", **SMALL)
    pictures = list(photograph(make_scene(motion, motion.pose, settings), settings))
    assert [p.name for p in pictures] == [
        "front", "top", "stereo-left", "stereo-right", "orbit-0", "orbit-1", "orbit-2",
    ]  # fmt: skip
    for picture in pictures:
        film = picture.film
        np.testing.assert_allclose(film.on_film + film.lost, film.emitted, rtol=1e-9)
    exposures = [p.exposure for p in pictures]
    assert exposures[2] == exposures[3]
    assert len(set(exposures[4:])) == 1
    assert exposures[0] != exposures[1]


def test_speed_of_a_motion_is_what_was_asked():
    motion = motion_of(text="period 10 ms\nprofile constant\nline by (80, 0) mm in 2 s\n")
    np.testing.assert_allclose(reference_columns(motion)["speed_m_s"][:-1], 0.04, rtol=1e-9)


def test_a_dark_drawing_is_refused():
    with pytest.raises(DqpaintError, match="no light is on anywhere"):
        make_preview(program("light off\nline to (80, 0) mm\n"), make_settings(**SMALL))
