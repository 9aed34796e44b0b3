"""How near links come, against PyBullet and closed forms; what they hide, against geometry."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.robots.kinematics.collisions import (
    LAMP_CLEARANCE,
    LEAST_JOINTS_BETWEEN,
    CollisionShapes,
)
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.loading.load_file import read_file
from dqpaint.robots.model.card import read_card
from dqpaint.robots.urdf.prepare import urdf_file
from tests.support.arm_files import arm_urdf
from tests.support.installed import LINK


def random_postures(card, n, seed=5):
    return np.random.default_rng(seed).uniform(card.lower, card.upper, (n, card.joints))


@pytest.mark.slow
def test_distances_are_those_of_pybullet():
    """PyBullet reads meshes as convex hulls, too; its hulls have margins of a millimetre."""
    from dqpaint.plants.engines.pybullet_client import bullet, joint_indices, quiet

    card = read_card("iiwa")
    shapes = CollisionShapes(Kinematics(card))
    postures = random_postures(card, 40)
    found = shapes.nearest(postures)
    with quiet():
        client = bullet.connect(bullet.DIRECT)
        with urdf_file(card) as path:
            body = bullet.loadURDF(path, useFixedBase=True, physicsClientId=client)
    links = [-1, *joint_indices(body, client)]
    theirs = []
    for posture in postures:
        for joint, angle in zip(links[1:], posture, strict=True):
            bullet.resetJointState(body, joint, angle, physicsClientId=client)
        bullet.performCollisionDetection(physicsClientId=client)
        near = [
            point[8]
            for i in range(len(links))
            for j in range(i + LEAST_JOINTS_BETWEEN, len(links))
            for point in bullet.getClosestPoints(
                body, body, 2.0, links[i], links[j], physicsClientId=client
            )
        ]
        theirs.append(min(near))
    bullet.disconnect(client)
    assert min(theirs) < 0 < max(theirs)
    apart = found.distance > 0
    np.testing.assert_allclose(found.distance[apart], np.array(theirs)[apart], atol=2.5e-3)
    assert (np.array(theirs)[~apart] < 1e-3).all()
    assert ((found.distance <= 0) == (np.array(theirs) < -2e-3)).all()


def segment_distance(a, b, c, d):
    """Of two segments, by a fine search: slow, and nothing like what is tested."""
    s = np.linspace(0, 1, 400)[:, None]
    p = a + s * (b - a)
    u = d - c
    t = np.clip(((p - c) @ u) / (u @ u), 0, 1)[:, None]
    return np.linalg.norm(p - (c + t * u), axis=1).min()


def test_distances_of_capsules():
    """The arm of rows is made of capsules: distance of their lines less their radii."""
    from dqpaint.robots.urdf.capsules import build_links

    card = read_card("meka-a2")
    arm = Kinematics(card)
    links = build_links(card.axes, card.body.mass_kg, card.body.radius_m)
    shapes = CollisionShapes(arm)
    looked = {
        (shapes._shapes.geometryObjects[p.first].parentJoint,
         shapes._shapes.geometryObjects[p.second].parentJoint)
        for p in shapes._shapes.collisionPairs
    }  # fmt: skip
    assert len(looked) > 10
    for posture, distance in zip(
        postures := random_postures(card, 6), shapes.nearest(postures).distance, strict=True
    ):
        carried = card.axes._carried(posture)

        def at(i, point, carried=carried):
            moved = dq.mul(carried[i], dq.pose_from(point, np.array([1.0, 0, 0, 0])))
            return dq.translation(moved)

        solids = [
            (i, at(i, s.start), at(i, s.end), s.radius)
            for i, link in enumerate(links)
            for s in link.solids
        ]
        least = min(
            segment_distance(a, b, c, d) - r - q
            for i, a, b, r in solids
            for j, c, d, q in solids
            if (i, j) in looked
        )
        assert distance == pytest.approx(least, abs=2e-4) or (distance < 0 and least < 0)


def test_the_pair_that_is_nearest_is_named():
    shapes = CollisionShapes(Kinematics(read_card("iiwa")))
    folded = np.radians([0, 60, 0, -120, 0, 118, 0])
    near = shapes.nearest(folded[None])
    assert all(name.startswith(LINK) for name in near.pair[0])


def test_home_is_free_of_collisions():
    for name in ("iiwa", "panda", "xarm6", "viper850", "meka-a2", "lwr4"):
        card = read_card(name)
        assert CollisionShapes(Kinematics(card)).nearest(card.home[None]).distance[0] > 0, name


def test_what_stands_between_hides():
    arm = Kinematics(read_card("iiwa"))
    shapes = CollisionShapes(arm)
    home = arm.card.home
    light = dq.translation(arm.pose(home))
    front, behind = light + np.array([2.0, 0.1, 0.05]), light - np.array([3.0, 0, 0])
    assert not shapes.occludes(home[None], light[None], front)[0]
    assert shapes.occludes(home[None], light[None], behind)[0]
    # a light far beside the arm is seen from everywhere; one behind the base's column is not
    aside, column = np.array([0.0, 1.5, 0.3]), np.array([-0.5, 0.0, 0.1])
    assert not shapes.occludes(home[None], aside[None], front)[0]
    assert shapes.occludes(home[None], column[None], np.array([3.0, 0.0, 0.1]))[0]


def test_the_lamp_itself_hides_nothing():
    """A line of sight ends where the lamp begins; 3 mm of housing round the light are no matter."""
    arm = Kinematics(read_card("lwr4"))
    shapes = CollisionShapes(arm)
    home = arm.card.home
    light = dq.translation(arm.pose(home))
    hidden = [
        bool(shapes.occludes(home[None], light[None], light + 2.0 * way)[0])
        for way in dq.matrix_from_pose(arm.pose(home))[:3, :3].T
    ]
    assert not hidden[2]  # along the tool's own axis
    assert LAMP_CLEARANCE < 0.02


def in_the_last_link(tmp_path, shape):
    """An arm whose light sits in the middle of a shape of its last link."""
    text = arm_urdf()
    geometry = f"<geometry>{shape}</geometry>"
    solid = f"<visual>{geometry}</visual><collision>{geometry}</collision>"
    (tmp_path / "arm.urdf").write_text(
        text.replace('<link name="tip"/>', f'<link name="tip">{solid}</link>')
    )
    return Kinematics(read_file(f"{tmp_path / 'arm.urdf'}:tip"))


@pytest.mark.parametrize("shape", [
    '<sphere radius="0.05"/>', '<box size="0.1 0.1 0.1"/>',
    '<cylinder radius="0.05" length="0.1"/>',
])  # fmt: skip
def test_a_plain_shape_that_the_lamp_sits_in_does_not_hide_it_but_one_before_it_does(
    tmp_path, shape
):
    """As the picture's rays have it, which begin inside."""
    arm = in_the_last_link(tmp_path, shape)
    home = arm.card.home[None]
    light = dq.translation(arm.pose(arm.card.home))
    shapes = CollisionShapes(arm)
    away = np.array([0.3, 0.9, 0.5])
    assert not shapes.occludes(home, light[None], light + away)[0]
    assert shapes.occludes(home, light[None] - 0.2 * away, light + away)[0]


def test_a_mesh_that_cannot_be_read_is_left_out_and_named(tmp_path):
    (tmp_path / "broken.stl").write_bytes(b"solid nonsense")
    arm = in_the_last_link(tmp_path, '<mesh filename="broken.stl"/>')
    shapes = CollisionShapes(arm)
    assert shapes.notes == ()
    assert any("mesh 'broken.stl'" in note for note in arm.notes)
    light = dq.translation(arm.pose(arm.card.home))
    assert not shapes.occludes(arm.card.home[None], light[None], light + np.array([0.3, 0.9, 0.5]))[
        0
    ]
