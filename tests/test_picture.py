"""One film for what was asked and what was reached; the exposure of lines, dots and jumps."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.errors import DqpaintError
from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.picture import take
from dqpaint.robots.card import read_card
from dqpaint.scene import SETTLING
from dqpaint.settings import make_settings

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
    line = asked(f"period 5 ms\nlaw constant\nline to (80, 0) mm in {SETTLING} s\n")
    exposures = [take(m, m.pose, SETTINGS).exposure for m in (jump, line)]
    assert exposures[0] == pytest.approx(exposures[1], rel=0.02)


def test_light_is_counted_in_full():
    motion = asked("hold 0.3 s\nline to (80, 0) mm light red 50%\n")
    film = take(motion, motion.pose, SETTINGS).film
    np.testing.assert_allclose(
        film.on_film + film.lost, motion.light.sum(0) * motion.period, rtol=1e-9
    )


def test_a_picture_without_light_is_refused():
    with pytest.raises(DqpaintError, match="no light is on anywhere"):
        take(dark := asked("light off\nline to (80, 0) mm\n"), dark.pose, SETTINGS)


def test_a_picture_shows_itself():
    motion = asked("line to (80, 0) mm\n")
    picture = take(motion, motion.pose, SETTINGS)
    assert picture._repr_png_()[:8] == b"\x89PNG\r\n\x1a\n"
