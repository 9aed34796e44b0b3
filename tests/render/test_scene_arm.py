"""A whole run with its arm on the stage: what is hidden, shown, said and written."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import dqpaint
from dqpaint.cli import report
from dqpaint.diagnostics import SourceLine
from dqpaint.motion import RowLines
from dqpaint.outputs.summary import summarise
from dqpaint.painting import video
from dqpaint.painting.picture import lamp_paths
from dqpaint.render.arm_shapes import Arm
from dqpaint.render.scene_arm import SceneArm, hidden_by_line
from tests.support.shadow import EYE, Wall
from tests.support.urdf_shapes import urdf

SMALL = {"size": (160, 90), "controller": "p"}
VIEWS = "front,180,5,150,10"
BRUSHES = [
    "point",
    "ball:size=30mm",
    "bar:length=80mm,leds=9,colours=red/lime",
    "ribbon:length=50mm,along=y",
    "pixelstick:length=60mm,along=y,lobe=2",
    "fibre",
]
TEXT = "speed 200 mm/s\nlight white\nline to (60, 0) mm\nlight off\nmove to (0, 0) mm\n"


def test_hidden_light_is_accounted_to_its_lines():
    hidden = np.array([[1.0, 0, 0], [0, 2, 0], [0, 0, 0], [3, 0, 0]])
    seven, three, five = SourceLine(0, 7), SourceLine(1, 3), SourceLine(0, 5)
    source = RowLines.from_lines([seven, three, five, seven])
    found = hidden_by_line(hidden, np.full((4, 3), 2.0), source)
    np.testing.assert_array_equal(found.energy, [4, 2, 0])
    assert found.lines == ((seven, 4 / 24), (three, 2 / 24))


def test_no_light_hides_nothing():
    found = hidden_by_line(
        np.zeros((2, 3)),
        np.zeros((2, 3)),
        RowLines.from_lines([SourceLine(0, 1), SourceLine(0, 2)]),
    )
    assert found.lines == ()


def test_nothing_is_loaded_before_it_is_needed(tmp_path):
    staging = SceneArm(tmp_path / "nothing.urdf", np.zeros((3, 2)), 0.01)
    assert staging is not None


def test_the_posture_is_that_of_the_time():
    """A wall from x = 1/2 on hides lamps from x = 1 on; the posture moves it along."""
    time = np.array([0.05, 0.15, 0.25, 0.35])
    places = np.zeros((4, 1, 3))
    places[:, 0, 0] = [0.45, 1.1, 1.65, 2.5]
    for posture, expected in (([0] * 5, [1, 0, 0, 0]), ([0, 0, 0.2, 0.6, 0.6], [1, 1, 1, 0])):
        staging = SceneArm("", np.array(posture, float)[:, None], 0.1)
        staging.__dict__["ray_caster"] = Wall(0.5, 9)
        share = staging.visible(time, places, np.ones(4, bool), EYE)
        np.testing.assert_array_equal(share[:, 0], expected)


@pytest.fixture(scope="module")
def drawing(tmp_path_factory):
    path = tmp_path_factory.mktemp("stage") / "line.traj"
    path.write_text(TEXT)
    return path


@pytest.mark.slow
@pytest.mark.parametrize("exposure", ["auto", "f/8,iso100,35mm,0.1cd"])
@pytest.mark.parametrize("brush", BRUSHES)
def test_energy_is_on_the_film_lost_or_hidden(brush, exposure, drawing):
    """Against the film of the same light with no arm: all of what that counted is found again."""
    choices = {"brush": brush, "exposure": exposure, "view": VIEWS, "plant": "ideal", **SMALL}
    bare = dqpaint.draw(drawing, **choices)
    traced = dqpaint.draw(drawing, occlusion=True, **choices)
    for one, other in zip(traced.pictures, bare.pictures, strict=True):
        film = one.film
        np.testing.assert_allclose(
            film.on_film + film.lost + one.occluded.energy,
            other.film.emitted,
            rtol=1e-9,
            atol=1e-15,
        )
        np.testing.assert_allclose(one.emitted, other.film.emitted, rtol=1e-9, atol=1e-15)
        assert one.occluded.energy.min() >= 0.0
    assert traced.picture.occluded.energy.sum() < 0.01 * traced.picture.emitted.sum()
    if "lobe" not in brush:  # of a beam nothing goes that way
        assert traced.pictures[1].occluded.energy.sum() > 0.5 * traced.pictures[1].emitted.sum()


@pytest.mark.slow
def test_the_summary_has_what_is_hidden(drawing):
    painting = dqpaint.draw(drawing, view="180,5", occlusion=True, **SMALL)
    light = summarise(painting)["light"]
    emitted = painting.motion.light[:-1].sum(0) * painting.motion.period
    np.testing.assert_allclose(light["emitted"], emitted, rtol=1e-9)
    parts = [light["on_film"], light["lost"], light["occluded"]]
    np.testing.assert_allclose(np.sum(parts, axis=0), emitted, rtol=1e-9)


@pytest.mark.slow
def test_an_arm_before_its_light_is_a_warning_with_lines_and_help(drawing):
    painting = dqpaint.draw(drawing, view="180,5", occlusion=True, **SMALL)
    (said,) = [text for text in report.remarks(painting) if "the arm hides" in text]
    assert said.startswith("warning: the arm hides 100% of the light: line 3 (100%)")
    assert "--no-occlusion" in said
    assert "100.0% hidden by the arm" in report.light_line(painting.picture)


@pytest.mark.slow
@pytest.mark.parametrize("choices", [{}, {"ghost": True, "occlusion": False}], ids=["bare", "no"])
def test_untraced_light_is_said_to_be_untraced(drawing, choices):
    painting = dqpaint.draw(drawing, view="180,5", **choices, **SMALL)
    assert summarise(painting)["light"]["occluded"] is None
    assert "hidden" not in report.light_line(painting.picture)
    assert not any("the arm hides" in text for text in report.remarks(painting))


@pytest.mark.slow
def test_the_arm_is_seen_in_the_picture_alone_and_the_same_each_time(drawing):
    one, two = (dqpaint.draw(drawing, ghost=True, **SMALL) for _ in range(2))
    bare = dqpaint.draw(drawing, **SMALL)
    np.testing.assert_array_equal(one.image, two.image)
    np.testing.assert_allclose(one.film.on_film, bare.film.on_film, rtol=1e-9)
    assert (one.image.max(axis=2) > 12).mean() > 2 * (bare.image.max(axis=2) > 12).mean()
    assert one.picture.occluded is not None  # what is seen hides


@pytest.mark.slow
def test_a_film_with_its_arm_is_developed_as_it_was_and_from_elsewhere(drawing, tmp_path):
    painting = dqpaint.draw(drawing, ghost=True, view="150,10", **SMALL)
    dqpaint.save(painting, f"{tmp_path}/a", "film")
    (again,) = dqpaint.develop(tmp_path / "a-film.npz")
    np.testing.assert_array_equal(again.image, painting.image)
    assert again.occluded.lines == painting.picture.occluded.lines
    (front,) = dqpaint.develop(tmp_path / "a-film.npz", view="front")
    drawn = dqpaint.draw(drawing, ghost=True, view="front", **SMALL)
    np.testing.assert_array_equal(front.image, drawn.image)


@pytest.mark.slow
@pytest.mark.parametrize("ghost", [True, "motion"])
def test_what_was_worked_out_of_the_arm_is_not_asked_again(ghost, drawing, tmp_path, monkeypatch):
    painting = dqpaint.draw(drawing, ghost=ghost, view="150,10", **SMALL)
    dqpaint.save(painting, f"{tmp_path}/a", "film")
    asked = []
    load = Arm.__init__
    monkeypatch.setattr(Arm, "__init__", lambda self, urdf: asked.append(1) or load(self, urdf))
    for choices in ({}, {"look": "aces", "ev": 1.5}, {"starburst": 6}):
        (again,) = dqpaint.develop(tmp_path / "a-film.npz", **choices)
        drawn = dqpaint.draw(drawing, ghost=ghost, view="150,10", **SMALL, **choices)
        np.testing.assert_array_equal(again.image, drawn.image)
        assert again.occluded.lines == painting.picture.occluded.lines
        asked_by_draw = len(asked)
        dqpaint.develop(tmp_path / "a-film.npz", **choices)
        assert len(asked) == asked_by_draw
    dqpaint.develop(tmp_path / "a-film.npz", view="front")
    assert len(asked) > asked_by_draw


@pytest.mark.slow
def test_a_film_without_its_arm_can_show_it_and_the_other_way_round(drawing, tmp_path):
    dqpaint.save(dqpaint.draw(drawing, **SMALL), f"{tmp_path}/a", "film")
    for ghost in (True, "motion"):
        (shown,) = dqpaint.develop(tmp_path / "a-film.npz", ghost=ghost)
        painting = dqpaint.draw(drawing, ghost=ghost, **SMALL)
        np.testing.assert_array_equal(shown.image, painting.image)
    dqpaint.save(painting, f"{tmp_path}/b", "film")
    (bare,) = dqpaint.develop(tmp_path / "b-film.npz", ghost=False)
    np.testing.assert_array_equal(bare.image, dqpaint.draw(drawing, **SMALL).image)
    (flashed,) = dqpaint.develop(tmp_path / "b-film.npz", ghost=True)
    drawn = dqpaint.draw(drawing, ghost=True, **SMALL)
    np.testing.assert_array_equal(flashed.image, drawn.image)
    (open_,) = dqpaint.develop(tmp_path / "b-film.npz", occlusion=False)
    assert open_.occluded is None
    assert open_.arm is not None


@pytest.mark.slow
def test_a_film_whose_arm_is_gone_is_developed_without_and_that_is_said(drawing, tmp_path):
    painting = dqpaint.draw(drawing, ghost=True, **SMALL)
    for robot, reason in (("xarm6", "xarm6 has 6 joints"), ("gone.urdf", "gone.urdf")):
        other = replace(painting, arm_motion=replace(painting.arm_motion, robot=robot))
        dqpaint.save(other, f"{tmp_path}/a", "film")
        (without,) = dqpaint.develop(tmp_path / "a-film.npz")
        (said,) = report.of_arm([without])
        assert said.startswith("warning: the arm is left out, and what it hides is not traced: ")
        assert reason in said
        assert without.arm is None
        assert without.occluded is None


@pytest.mark.slow
def test_a_movie_ends_with_the_arm(drawing):
    painting = dqpaint.draw(drawing, ghost=True, view="150,10", plant="ideal", **SMALL)
    films = list(
        video.frames(painting.scene, painting.picture, painting.settings, 5, lambda _done: None)
    )
    np.testing.assert_array_equal(films[-1], painting.image)
    bare = np.abs(films[-2].astype(int) - painting.image).max(axis=2)
    lit = painting.picture.arm.max(axis=2) * painting.picture.exposure > 0.01
    assert (bare[lit] > 0).mean() > 0.9


@pytest.mark.slow
def test_the_arm_moves_in_a_movie_and_stands_in_each_frame_as_it_stood_then(drawing):
    """Against the pictures of runs that end there: their arm is where the frame's is."""
    painting = dqpaint.draw(drawing, ghost=True, view="120,10", plant="ideal", **SMALL)
    scene, picture, posture = painting.scene, painting.picture, painting.arm_motion.posture
    rows = [len(posture) * k // 4 for k in (1, 2, 3)]
    camera, exposure = picture.camera, picture.exposure
    shine = partial(lamp_paths, scene)
    with painting.scene_arm() as staging:
        moving = list(staging.render_frames(camera, shine, exposure, False, rows))
        for row, frame in zip(rows, moving, strict=True):
            staging._posture = posture[: row + 1]
            still = staging.render_still(camera, shine, exposure)
            a, b = (image.max(axis=2) * exposure > 0.01 for image in (frame, still))
            assert (a & b).sum() > 0.9 * (a | b).sum()
    assert np.abs(moving[0] - moving[-1]).max() * exposure > 0.05
    with painting.scene_arm() as staging:
        films = list(
            video.frames(scene, picture, painting.settings, 4, lambda _done: None, staging)
        )
    np.testing.assert_array_equal(films[-1], painting.image)
    assert (films[0].max(axis=2) > 12).mean() > 0.05  # it is there from the first


@pytest.mark.slow
def test_meshes_that_are_not_there_are_a_remark(tmp_path):
    mesh = '<visual><geometry><mesh filename="nothere.stl"/></geometry></visual>'
    (tmp_path / "junk.stl").write_text("junk")
    junk = mesh.replace("nothere", "junk")
    for second, said in ((mesh, "nothere.stl"), (junk, "junk.stl"), ("", "no shape")):
        staging = SceneArm(urdf(tmp_path, "", "", second), np.zeros((3, 2)), 0.01)
        (remark,) = staging.remarks
        assert remark.startswith("warning: ")
        assert said in remark
        assert not staging.can_occlude
    staging = SceneArm(urdf(tmp_path), np.zeros((3, 2)), 0.01)
    assert staging.remarks == []
    assert staging.can_occlude
