"""Every arm: pinocchio against PyBullet and finite differences."""

import numpy as np
import pinocchio
import pytest

from dqpaint import dq
from dqpaint.plants.engines.pybullet_client import bullet, joint_indices, quiet
from dqpaint.robots.kinematics.kinematics import Kinematics, manipulability
from dqpaint.robots.model.card import installed_names, read_card
from dqpaint.robots.urdf.prepare import is_valid_inertia, urdf_file

AGREES = 1e-9  # [m, rad] between pinocchio and PyBullet

PHYSICS_STEP = 1e-3  # [s]


@pytest.fixture(params=installed_names())
def arm(request):
    return Kinematics(read_card(request.param))


def postures(arm, rng, n):
    return rng.uniform(arm.card.lower, arm.card.upper, (n, arm.card.joints))


@pytest.mark.slow
def test_poses_agree_with_pybullet(arm, rng):
    """By way of the link's centre of mass: PyBullet rounds its link frames to floats."""
    with quiet():
        client = bullet.connect(bullet.DIRECT)
        flags = bullet.URDF_USE_INERTIA_FROM_FILE
        with urdf_file(arm.card) as path:
            body = bullet.loadURDF(path, useFixedBase=True, flags=flags)
    joints = joint_indices(body, client)
    names = [
        bullet.getJointInfo(body, i, client)[12].decode()
        for i in range(bullet.getNumJoints(body, client))
    ]
    link = names.index(arm.card.link)
    tool = dq.matrix_from_pose(arm.card.tool.pose)
    for q in postures(arm, rng, 50):
        for joint, angle in zip(joints, q, strict=True):
            bullet.resetJointState(body, joint, angle, 0.0, client)
        state = bullet.getLinkState(body, link, 0, 1, client)
        inertial = _matrix(*bullet.getDynamicsInfo(body, link, client)[3:5])
        there = _matrix(*state[:2]) @ np.linalg.inv(inertial) @ tool
        np.testing.assert_allclose(dq.matrix_from_pose(arm.pose(q)), there, atol=AGREES)
    bullet.disconnect(client)


@pytest.mark.slow
def test_dynamics_agree_with_pybullet(arm, rng):
    """The mass matrix, and the torques of inverse dynamics with gravity, at random states."""
    flags = bullet.URDF_USE_INERTIA_FROM_FILE
    with quiet(), urdf_file(arm.card) as path:
        client = bullet.connect(bullet.DIRECT)
        body = bullet.loadURDF(path, useFixedBase=True, flags=flags, physicsClientId=client)
    bullet.setGravity(0, 0, -9.81, client)
    joints = joint_indices(body, client)
    model, data = arm.model, arm.model.createData()
    for q in postures(arm, rng, 30):
        rates, accelerations = rng.normal(size=(2, arm.card.joints))
        for joint, angle, rate in zip(joints, q, rates, strict=True):
            bullet.resetJointState(body, joint, angle, rate, client)
        mass = np.array(bullet.calculateMassMatrix(body, q.tolist(), physicsClientId=client))
        ours = pinocchio.crba(model, data, q)
        ours = np.triu(ours) + np.triu(ours, 1).T
        np.testing.assert_allclose(mass, ours, atol=AGREES)
        torques = bullet.calculateInverseDynamics(
            body, q.tolist(), rates.tolist(), accelerations.tolist(), physicsClientId=client
        )
        np.testing.assert_allclose(
            torques, pinocchio.rnea(model, data, q, rates, accelerations), atol=AGREES
        )
    bullet.disconnect(client)


def test_what_moves_can_be_made_of_matter(arm):
    """Each body weighs something; its moments are positive, none above the sum of the others."""
    assert len(arm.notes) == arm.card.name.startswith("baxter")  # a gripper without inertia
    weights = np.diag(pinocchio.crba(arm.model, arm.model.createData(), arm.card.home))
    assert (np.array(arm.model.damping) * PHYSICS_STEP < weights).all()  # else a step overshoots
    for inertia in list(arm.model.inertias)[1:]:
        assert inertia.mass > 0
        assert is_valid_inertia(inertia.inertia)


def _matrix(place, quaternion):
    x, y, z, w = quaternion
    return dq.matrix_from_pose(dq.pose_from(place, [w, x, y, z]))


def test_jacobian_is_the_spatial_twist_of_the_tool(arm, rng):
    """x_dot = xi x / 2 with xi = J q_dot, by central differences of order 2."""
    for q in postures(arm, rng, 10):
        rates = rng.normal(size=arm.card.joints)
        x, J = arm.pose_and_jacobian(q)
        errors = []
        for h in (2e-3, 1e-3):
            ahead = dq.nearest(arm.pose(q + h * rates), x)
            behind = dq.nearest(arm.pose(q - h * rates), x)
            rate = 0.5 * dq.mul(dq.pure(J @ rates), x)
            errors.append(np.abs((ahead - behind) / (2 * h) - rate).max())
        assert 3.8 < errors[0] / errors[1] < 4.2


def test_both_ways_to_a_pose_agree(arm, rng):
    q = postures(arm, rng, 20)
    poses, J = arm.poses_and_jacobians(q)
    assert J.shape == (20, 6, arm.card.joints)
    np.testing.assert_allclose(poses, [arm.pose(x) for x in q], atol=1e-14)
    smooth = arm.poses(np.linspace(q[0], q[1], 200))
    assert ((smooth[1:, :4] * smooth[:-1, :4]).sum(1) > 0.9).all()


def test_manipulability_is_that_of_the_tool_itself(arm, rng):
    for q in postures(arm, rng, 10):
        x, J = arm.pose_and_jacobian(q)
        at_tool = J.copy()
        at_tool[3:] += np.cross(J[:3].T, dq.translation(x)).T
        singular = np.linalg.svd(at_tool, compute_uv=False)
        assert manipulability(J) == pytest.approx(np.prod(singular), rel=1e-8, abs=1e-12)
