"""The URDF of an arm that is built: the same text each time, and exact angles."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.robots.model.card import read_card
from dqpaint.robots.model.fields import Mount
from dqpaint.robots.urdf.prepare import urdf_file
from dqpaint.robots.urdf.write import roll_pitch_yaw, write_urdf
from tests.support.random_poses import random_rotations
from tests.support.robot_cards import CARDS


def turn(angles):
    return dq.matrix_from_pose(Mount(rpy_deg=tuple(np.degrees(angles))).pose)[:3, :3]


def test_angles_give_the_rotation_back(rng):
    for R in dq.matrix_from_quaternion(random_rotations(rng, 200)):
        np.testing.assert_allclose(turn(roll_pitch_yaw(R)), R, atol=1e-14)


@pytest.mark.parametrize("pitch", [90, -90, 89.9999999, 90 - 1e-13])
def test_angles_are_exact_where_roll_and_yaw_are_one(pitch, rng):
    for roll, yaw in rng.uniform(-180, 180, (50, 2)):
        R = turn(np.radians([roll, pitch, yaw]))
        np.testing.assert_allclose(turn(roll_pitch_yaw(R)), R, atol=1e-14)


def test_the_same_card_gives_the_same_text():
    card = read_card("meka-a2")
    assert write_urdf(card) == write_urdf(card.model_copy(deep=True))
    assert write_urdf(card) != write_urdf(CARDS["baxter"])


def test_a_card_s_limits_and_masses_are_in_the_text():
    text = write_urdf(read_card("lwr4"))
    assert text.count('<mass value="2.3"') == 4
    assert f'upper="{np.radians(170)!r}"'.replace("np.float64(", "").replace(")", "") in text
    assert 'effort="200.0"' in text


def test_a_file_is_there_for_as_long_as_it_is_needed(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with urdf_file(read_card("lwr4")) as path:
        with open(path, encoding="utf-8") as file:
            assert file.read() == write_urdf(read_card("lwr4"))
        with urdf_file(read_card("lwr4")) as other:
            assert other != path  # PyBullet remembers what it has read by its name
    assert not list(tmp_path.iterdir())
