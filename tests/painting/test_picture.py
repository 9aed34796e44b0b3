"""One film for what was asked and what was reached; the exposure of lines, dots and jumps."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.diagnostics import SourceLine
from dqpaint.errors import DqpaintError
from dqpaint.language import parse
from dqpaint.light.camera.camera import FRAME_FILL
from dqpaint.light.sources.from_motion import FILL_WITH_ARM
from dqpaint.light.sources.sweep import ALL_SAMPLES
from dqpaint.motion import plan
from dqpaint.painting.picture import photograph
from dqpaint.painting.scene import JUMP_TIME, make_scene
from dqpaint.robots.model.card import read_card
from dqpaint.settings.model import make_settings
from tests.support.pictures import take

CANVAS = read_card("iiwa").canvas.pose
SETTINGS = make_settings(width=320, height=180)


def asked(text):
    return plan(parse(text, "test.traj"), CANVAS)


def test_what_was_asked_alone_chooses_camera_and_exposure():
    motion = asked("line to (80, 0) mm\nline to (80, 60) mm\n")
    reached = dq.mul(dq.pose_from([0.0, 0.01, 0.02], [1.0, 0, 0, 0]), motion.pose)
    one, other = take(motion, motion.pose, SETTINGS), take(motion, reached, SETTINGS)
    assert one.exposure == other.exposure
    np.testing.assert_array_equal(one.camera.position, other.camera.position)
    assert not np.array_equal(one.image, other.image)


def test_x_is_to_the_right_and_y_up():
    motion = asked("line to (80, 0) mm light red\nline to (80, 60) mm light lime\n")
    image = take(motion, motion.pose, SETTINGS).image
    red = np.argwhere((image[..., 0] > 200) & (image[..., 1] < 150))
    green = np.argwhere((image[..., 1] > 200) & (image[..., 0] < 150))
    assert red[:, 0].mean() > green[:, 0].mean()  # red lies below
    assert green[:, 1].mean() > red[:, 1].mean()  # green stands at its right end


def test_a_placed_drawing_is_seen_from_the_robot_s_own_front():
    flat = "place at (0, 0, 0)\nstart at (600, -50, 500) mm\nline by (0, 100, 0) mm\n"
    camera = take(asked(flat), asked(flat).pose, SETTINGS).camera
    front = dq.rotate(dq.rotation(CANVAS), np.array([0.0, 0, 1]))
    np.testing.assert_allclose(camera.rotation[2], front, atol=1e-12)


def test_a_jump_is_exposed_as_a_line_drawn_while_the_arm_settles():
    jump = asked("period 5 ms\nhold 0.5 s\nstep to (80, 0) mm\nhold 2 s\n")
    line = asked(f"period 5 ms\nprofile constant\nline to (80, 0) mm in {JUMP_TIME} s\n")
    exposures = [take(m, m.pose, SETTINGS).exposure for m in (jump, line)]
    assert exposures[0] == pytest.approx(exposures[1], rel=0.02)


def test_light_is_counted_in_full():
    motion = asked("hold 0.3 s\nline to (80, 0) mm light red 50%\n")
    film = take(motion, motion.pose, SETTINGS).film
    np.testing.assert_allclose(
        film.on_film + film.lost, motion.light.sum(0) * motion.period, rtol=1e-9
    )


class Screen:
    """A stage on which the arm hides what is right of the middle, and looks like a grey wall."""

    can_occlude = True
    remarks = ()

    def __init__(self, motion):
        self.source = motion.source

    def visible(self, time, places, lit, eye):
        self.time, self.lit = time, lit
        right = places[..., 1]  # of the iiwa's canvas, seen from its front
        return (right < eye[1]).astype(float)

    def render_still(self, camera, lights, exposure, falloff):
        self.lights, self.falloff = lights, falloff
        return np.full((camera.height, camera.width, 3), 0.1 / exposure, np.float32)


HALF = "hold 0.3 s\nline by (40, 0) mm light red 50%\nline by (40, 0) mm light lime\n"
GHOST = make_settings(width=320, height=180, ghost=True)


def staged(motion, settings=GHOST, screen=None):
    scene = make_scene(motion, motion.pose, settings)
    return next(photograph(scene, settings, Screen(motion) if screen is None else screen))


def test_what_the_arm_hides_is_counted_line_by_line():
    motion = asked(HALF)
    picture = staged(motion)
    emitted = motion.light[:-1].sum(0) * motion.period
    together = picture.film.on_film + picture.film.lost + picture.occluded.energy
    np.testing.assert_allclose(together, emitted, rtol=1e-9)
    np.testing.assert_allclose(picture.emitted, emitted, rtol=1e-9)
    (line, share), *rest = picture.occluded.lines
    assert line == SourceLine(0, 3)
    assert sum(part for _, part in rest) < 0.02
    assert share == pytest.approx(picture.occluded.energy.sum() / emitted.sum(), abs=0.02)
    assert 0.2 < share < 0.9


def test_each_step_is_traced_at_its_middle():
    motion = asked(HALF)
    screen = Screen(motion)
    staged(motion, screen=screen)
    np.testing.assert_allclose(screen.time, motion.t[:-1] + 0.5 * motion.period)
    np.testing.assert_array_equal(screen.lit, motion.light[:-1].any(axis=1))


@pytest.mark.parametrize(
    ("ghost", "occlusion", "seen", "traced"),
    [
        (False, None, False, False),
        (True, None, True, True),
        (True, False, True, False),
        (False, True, False, True),
    ],
)
def test_ghost_and_occlusion_are_chosen_apart(ghost, occlusion, seen, traced):
    motion = asked(HALF)
    picture = staged(motion, make_settings(width=64, height=36, ghost=ghost, occlusion=occlusion))
    assert (picture.arm is not None) == seen
    assert (picture.occluded is not None) == traced
    if not traced:
        film = picture.film
        np.testing.assert_allclose(film.on_film + film.lost, picture.emitted, rtol=1e-9)


def test_what_cannot_be_traced_in_full_is_not_counted_at_all():
    motion = asked(HALF)
    screen = Screen(motion)
    screen.can_occlude, screen.remarks = False, ("warning: a mesh",)
    picture = staged(motion, screen=screen)
    assert picture.occluded is None
    assert picture.remarks == ("warning: a mesh",)


def test_the_arm_is_lit_by_all_light_and_leaves_the_film_alone():
    motion = asked(HALF)
    screen = Screen(motion)
    with_arm = staged(motion, screen=screen)
    bare = take(motion, motion.pose, GHOST)
    np.testing.assert_allclose(
        sum(e.sum(0) for _, e in screen.lights(ALL_SAMPLES)), bare.emitted, rtol=1e-9
    )
    assert with_arm.film.on_film[0] == pytest.approx(bare.film.on_film[0], rel=1e-9)
    assert with_arm.image.min() > 20
    assert bare.image.min() < 5
    assert not screen.falloff
    staged(motion, make_settings(width=64, height=36, ghost=True, exposure="f/8,1cd"), screen)
    assert screen.falloff


def test_the_camera_leaves_room_for_the_arm_whether_or_not_it_is_there():
    motion = asked(HALF)
    far_away, close = (take(motion, motion.pose, s).camera for s in (GHOST, SETTINGS))
    wide, narrow = (np.ptp(c.project(motion.points)[0][:, 0]) / 319 for c in (far_away, close))
    assert wide == pytest.approx(FILL_WITH_ARM, rel=0.02)
    assert narrow == pytest.approx(FRAME_FILL, rel=0.02)


def test_a_picture_without_light_is_refused():
    with pytest.raises(DqpaintError, match="no light"):
        take(dark := asked("light off\nline to (80, 0) mm\n"), dark.pose, SETTINGS)


def test_a_picture_shows_itself():
    motion = asked("line to (80, 0) mm\n")
    picture = take(motion, motion.pose, SETTINGS)
    assert picture._repr_png_()[:8] == b"\x89PNG\r\n\x1a\n"
