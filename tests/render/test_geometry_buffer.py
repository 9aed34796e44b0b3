"""What the renderer measured, against the pinhole, rays, balls and the arm's own kinematics."""

from pathlib import Path

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.light.camera.camera import View, frame_points
from dqpaint.render.arm_shapes import Arm
from dqpaint.render.geometry_buffer import measure_surfaces
from dqpaint.render.ray_casting import RayCaster
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.robots.urdf.prepare import urdf_file
from tests.support.urdf_shapes import BALL, rays, shape, urdf

MIDDLE = np.array([0, 0, 0.5])
SEEN_ELSEWHERE = 0.004  # of the arm: single pixels of the outline


def camera_at(rng, size=(320, 180), spread=0.4, fill=0.6):
    view = View(rng.uniform(-180, 180), rng.uniform(-5, 60))
    return frame_points(MIDDLE + rng.uniform(-spread, spread, (20, 3)), np.eye(3), view, size, fill)


@pytest.mark.slow
def test_small_balls_are_where_the_camera_projects_them(rng, tmp_path):
    camera = camera_at(rng, (640, 360))
    for place in MIDDLE + rng.uniform(-0.2, 0.2, (12, 3)):
        ball = shape('<sphere radius="0.02"/>', " ".join(map(str, place)))
        found = measure_surfaces(Arm(urdf(tmp_path, ball, "", "")), camera)
        rows, columns = np.nonzero(found.cover)
        weight = found.cover[rows, columns]
        seen = np.array([found.box.left + np.average(columns, weights=weight),
                         found.box.top + np.average(rows, weights=weight)])  # fmt: skip
        assert np.abs(seen - camera.project([place])[0][0]).max() < 0.1  # px


@pytest.mark.slow
def test_links_are_where_pinocchio_puts_the_tool(rng):
    card = read_card("iiwa")
    kinematics = Kinematics(card)
    with urdf_file(card) as path:
        arm = Arm(path)
        postures = rng.uniform(card.lower, card.upper, (5, 7))
        last = arm.frames(postures)[:, -1]
    for q, frame_of_link in zip(postures, last, strict=True):
        tool = dq.nearest(dq.mul(frame_of_link, card.tool.pose), kinematics.pose(q))
        np.testing.assert_allclose(tool, kinematics.pose(q), atol=1e-6)


@pytest.mark.slow
def test_the_arm_has_the_colours_of_its_file():
    with urdf_file(read_card("iiwa")) as path:
        arm = Arm(path)
        colours = {shape.colour for shape in arm.shapes}
    found = sorted(tuple(round(part, 2) for part in colour) for colour in colours)
    assert found == [(0.2, 0.2, 0.2), (0.5, 0.7, 1.0), (1.0, 0.42, 0.04)]


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["iiwa", "xarm6", "plain"])
def test_rays_meet_what_is_seen(robot, rng, tmp_path):
    if robot == "plain":
        arm = Arm(urdf(tmp_path, second=BALL))
    else:
        with urdf_file(read_card(robot)) as path:
            arm = Arm(path)
    twins = RayCaster(arm)
    posture = rng.normal(size=len(arm.joints)) * 0.5
    arm.set_posture(posture)
    camera = camera_at(rng, (640, 360))
    found = measure_surfaces(arm, camera)
    way = rays(camera, found.box)
    eye = np.broadcast_to(camera.position, way.shape)
    far = camera.position + 20 * way
    hit = twins.blocked(posture[None], eye[None], far[None])[0].reshape(found.sure.shape)
    outline = (found.cover > 0) & (found.cover < 1)  # it may be either
    wrong = (hit != (found.cover > 0.5)) & ~outline
    assert wrong.sum() < SEEN_ELSEWHERE * found.sure.sum()
    assert found.sure.sum() > 500
    # and a ray to just before each place is free, to just behind it is not
    place = found.position.astype(float)
    to = (place - camera.position) / np.linalg.norm(place - camera.position, axis=1)[:, None]
    begin = np.broadcast_to(camera.position, place.shape)
    gap = 0.002
    assert twins.blocked(posture[None], begin[None], (place - gap * to)[None]).mean() < 0.02
    assert twins.blocked(posture[None], begin[None], (place + gap * to)[None]).mean() > 0.98


@pytest.mark.slow
def test_normals_and_links_of_a_ball(rng, tmp_path):
    arm = Arm(urdf(tmp_path, base="", first="", second=BALL))
    posture = np.array([0.4, -0.7])
    arm.set_posture(posture)
    centre = dq.translation(dq.mul(arm.frames(posture[None])[0, 2], arm.shapes[0].frame))
    camera = frame_points(
        centre + rng.uniform(-0.1, 0.1, (9, 3)), np.eye(3), View(20, 30), (320, 180)
    )
    found = measure_surfaces(arm, camera)
    outwards = found.position - centre
    outwards /= np.linalg.norm(outwards, axis=1)[:, None]
    angle = np.degrees(np.arccos(np.clip((outwards * found.normal).sum(axis=1), -1, 1)))
    assert np.median(angle) < 1.5
    assert set(found.link) == {1}
    np.testing.assert_allclose(np.linalg.norm(found.normal, axis=1), 1, atol=1e-4)


@pytest.mark.slow
def test_an_arm_out_of_the_picture_is_none(tmp_path):
    far = frame_points(np.array([[5.0, 5, 5], [5.1, 5, 5.1]]), np.eye(3), View(0, 0), (64, 64))
    arm = Arm(urdf(tmp_path))
    assert measure_surfaces(arm, far) is None
    arm = Arm(urdf(tmp_path, "", "", ""))
    assert arm.shapes == []
    assert measure_surfaces(arm, far) is None


@pytest.mark.slow
@pytest.mark.parametrize("name", ["nothere.stl", "odd.ply"])
def test_a_mesh_that_cannot_be_read_leaves_the_rest(name, tmp_path):
    (tmp_path / "odd.ply").write_text("odd")
    mesh = f'<visual><geometry><mesh filename="{name}"/></geometry></visual>'
    arm = Arm(urdf(tmp_path, second=mesh))
    assert [Path(one).name for one in arm.unread] == [name]
    assert [shape.link for shape in arm.shapes] == [-1, 0]
