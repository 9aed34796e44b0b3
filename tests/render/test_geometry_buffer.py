"""What the renderer measured, against the pinhole, rays, balls and the arm's own kinematics."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.light.camera.camera import View, frame_points
from dqpaint.render import geometry_buffer
from dqpaint.render.arm_shapes import Arm
from dqpaint.render.geometry_buffer import Box, measure_surfaces, projection_matrix, view_matrix
from dqpaint.render.ray_casting import RayCaster
from dqpaint.robots.bullet.client import bullet
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.robots.urdf.prepare import urdf_file
from tests.support.urdf_shapes import BALL, rays, urdf

MIDDLE = np.array([0, 0, 0.5])
SEEN_ELSEWHERE = 0.004  # of the arm: single pixels of the outline


def camera_at(rng, size=(320, 180), spread=0.4, fill=0.6):
    view = View(rng.uniform(-180, 180), rng.uniform(-5, 60))
    return frame_points(MIDDLE + rng.uniform(-spread, spread, (20, 3)), np.eye(3), view, size, fill)


def test_the_matrices_are_the_camera_s_own(rng):
    camera = camera_at(rng, (640, 360))
    points = MIDDLE + rng.uniform(-0.4, 0.4, (50, 3))
    box = Box(37, 11, 501, 290)
    eye = view_matrix(camera) @ np.column_stack([points, np.ones(50)]).T
    clip = projection_matrix(camera, box) @ eye
    x, y, _ = clip[:3] / clip[3]
    pixels, depth = camera.project(points)
    np.testing.assert_allclose(clip[3], depth, rtol=1e-12)
    left = box.left - 0.5 + (x + 1) / 2 * (box.right - box.left)
    top = box.top - 0.5 + (1 - y) / 2 * (box.bottom - box.top)
    np.testing.assert_allclose(np.stack([left, top], axis=1), pixels, atol=1e-9)


@pytest.mark.slow
def test_small_balls_are_where_the_camera_projects_them(rng):
    world = type("World", (), {"client": bullet.connect(bullet.DIRECT)})()
    camera = camera_at(rng, (640, 360))
    for place in MIDDLE + rng.uniform(-0.2, 0.2, (12, 3)):
        ball = bullet.createVisualShape(
            bullet.GEOM_SPHERE, radius=0.02, physicsClientId=world.client
        )
        body = bullet.createMultiBody(0, -1, ball, place.tolist(), physicsClientId=world.client)
        box = geometry_buffer._find_arm(world, camera)
        rows, columns = np.nonzero(
            geometry_buffer._render_box(world, camera, box, 1.0, (0, 0, 1)).segment >= 0
        )
        found = np.array([box.left + columns.mean(), box.top + rows.mean()])
        assert np.abs(found - camera.project([place])[0][0]).max() < 0.3  # px
        bullet.removeBody(body, physicsClientId=world.client)
    bullet.disconnect(world.client)


@pytest.mark.slow
def test_links_are_where_pinocchio_puts_the_tool(rng):
    card = read_card("iiwa")
    kinematics = Kinematics(card)
    with urdf_file(card) as path, Arm(path) as arm:
        postures = rng.uniform(card.lower, card.upper, (5, 7))
        last = arm.frames(postures)[:, -1]
    for q, frame_of_link in zip(postures, last, strict=True):
        tool = dq.nearest(dq.mul(frame_of_link, card.tool.pose), kinematics.pose(q))
        np.testing.assert_allclose(tool, kinematics.pose(q), atol=1e-6)


@pytest.mark.slow
def test_the_arm_has_the_colours_of_its_file():
    with urdf_file(read_card("iiwa")) as path, Arm(path) as arm:
        colours = {shape.colour for shape in arm.shapes}
    found = sorted(tuple(round(part, 2) for part in colour) for colour in colours)
    assert found == [(0.2, 0.2, 0.2), (0.5, 0.7, 1.0), (1.0, 0.42, 0.04)]


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["kuka_iiwa/model.urdf", "xarm/xarm6_robot.urdf", "plain"])
def test_rays_meet_what_is_seen(robot, rng, tmp_path):
    data = read_card("iiwa").urdf.path.parents[1]
    path = urdf(tmp_path, second=BALL) if robot == "plain" else data / robot
    with Arm(path) as arm, RayCaster(arm) as twins:
        arm.whiten()
        twins.set_posture(rng.normal(size=len(arm.joints)) * 0.5)
        camera = camera_at(rng, (640, 360))
        found = measure_surfaces(arm, camera)
        way = rays(camera, found.box)
        eye = np.broadcast_to(camera.position, way.shape)
        hit = twins.blocked(eye, camera.position + 20 * way).reshape(found.sure.shape)
        outline = (found.cover > 0) & (found.cover < 1)  # it may be either
        wrong = (hit != (found.cover > 0.5)) & ~outline
        assert wrong.sum() < SEEN_ELSEWHERE * found.sure.sum()
        assert found.sure.sum() > 500
        # and a ray to just before each place is free, to just behind it is not
        place = found.position.astype(float)
        to = (place - camera.position) / np.linalg.norm(place - camera.position, axis=1)[:, None]
        begin = np.broadcast_to(camera.position, place.shape)
        gap = 0.004 if robot == "plain" else 0.002  # primitives have a margin
        assert twins.blocked(begin, place - gap * to).mean() < 0.02
        assert twins.blocked(begin, place + gap * to).mean() > 0.98


@pytest.mark.slow
def test_normals_and_links_of_a_ball(rng, tmp_path):
    with Arm(urdf(tmp_path, base="", first="", second=BALL)) as arm:
        arm.whiten()
        posture = np.array([0.4, -0.7])
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
    with Arm(urdf(tmp_path)) as arm:
        assert measure_surfaces(arm, far) is None
    with Arm(urdf(tmp_path, "", "", "")) as arm:
        assert arm.shapes == []
        assert measure_surfaces(arm, far) is None


@pytest.mark.slow
@pytest.mark.parametrize("name", ["nothere.stl", "odd.ply"])
def test_a_mesh_that_cannot_be_read_leaves_the_rest(name, tmp_path):
    (tmp_path / "odd.ply").write_text("odd")
    mesh = f'<visual><geometry><mesh filename="{name}"/></geometry></visual>'
    with Arm(urdf(tmp_path, second=mesh)) as arm:
        assert not arm.whole
        assert [shape.link for shape in arm.shapes] == [-1, 0]
