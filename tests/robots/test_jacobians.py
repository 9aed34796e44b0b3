"""Time derivatives of Jacobians: against differences, and against pinocchio's own."""

import numpy as np
import pinocchio
import pytest

from dqpaint import dq
from dqpaint.robots.kinematics.jacobians import jacobian_rate
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import installed_names, read_card
from tests.support.jacobians import jacobian8, jacobian8_rate
from tests.support.robot_cards import CARDS


@pytest.fixture(params=installed_names())
def arm(request):
    return Kinematics(read_card(request.param))


def states(arm, rng, n=10):
    q = rng.uniform(arm.card.lower, arm.card.upper, (n, arm.card.joints))
    return q, rng.normal(size=q.shape)


def test_rates_are_pinocchio_s(arm, rng):
    """Its WORLD frames, halves swapped: every column, and the frame's acceleration at rest."""
    model, data = arm.model, arm.model.createData()
    frame = model.getFrameId(arm.card.link, pinocchio.FrameType.BODY)
    world = pinocchio.ReferenceFrame.WORLD
    for q, rates in zip(*states(arm, rng), strict=True):
        dJ = jacobian_rate(arm.pose_and_jacobian(q)[1], rates)
        columns = pinocchio.computeJointJacobiansTimeVariation(model, data, q, rates)
        np.testing.assert_allclose(dJ, np.vstack([columns[3:], columns[:3]]), atol=1e-12)
        pinocchio.forwardKinematics(model, data, q, rates, np.zeros_like(q))
        drift = pinocchio.getFrameAcceleration(model, data, frame, world)
        np.testing.assert_allclose(dJ @ rates, [*drift.angular, *drift.linear], atol=1e-11)


@pytest.mark.parametrize("name", CARDS)
def test_rates_are_the_limits_of_differences(name, rng):
    """Central differences of order 2, of J_w and J8, along curved ways through the joints."""
    screws = CARDS[name].axes
    n = len(screws.axes)
    q, rates, bend = rng.uniform(-3, 3, (5, n)), rng.normal(size=(5, n)), rng.normal(size=(5, n))

    def at(s):
        where = q + s * rates + s * s * bend
        J, x = screws.jacobian(where), screws.pose(where)
        return J, jacobian8(J, x)

    J, x = screws.jacobian(q), screws.pose(q)
    exact = jacobian_rate(J, rates), jacobian8_rate(J, x, rates)
    for k in range(2):
        off = [np.abs((at(h)[k] - at(-h)[k]) / (2 * h) - exact[k]).max() for h in (2e-3, 1e-3)]
        assert 3.8 < off[0] / off[1] < 4.2


def test_j8_is_the_derivative_of_the_pose(arm, rng):
    q, rates = states(arm, rng)
    x, J = arm.poses_and_jacobians(q)
    h = 1e-6
    ahead, behind = (arm.poses_and_jacobians(q + s * h * rates)[0] for s in (1, -1))
    difference = (dq.nearest(ahead, x) - dq.nearest(behind, x)) / (2 * h)
    np.testing.assert_allclose(np.matvec(jacobian8(J, x), rates), difference, atol=1e-8)


def test_any_leading_shape_gives_the_same(rng):
    J, rates, x = (
        rng.normal(size=(2, 3, 6, 7)),
        rng.normal(size=(2, 3, 7)),
        rng.normal(size=(2, 3, 8)),
    )
    np.testing.assert_allclose(
        jacobian_rate(J, rates)[1, 2], jacobian_rate(J[1, 2], rates[1, 2]), atol=1e-14
    )
    np.testing.assert_allclose(jacobian8(J, x)[1, 0], jacobian8(J[1, 0], x[1, 0]), atol=1e-14)


def test_a_column_is_carried_by_the_links_before_it(rng):
    """xi_i x s_i by the algebra of `dq`, one column at a time."""
    J, rates = rng.normal(size=(6, 5)), rng.normal(size=5)
    for i in range(5):
        twist = J[:, : i + 1] @ rates[: i + 1]
        np.testing.assert_allclose(
            jacobian_rate(J, rates)[:, i], dq.spatial_cross(twist, J[:, i]), atol=1e-14
        )
