"""Denavit-Hartenberg rows against published poses and the algebra of dqrobotics."""

import dqrobotics as dqr
import numpy as np
import pytest
from dqrobotics.robot_modeling import DQ_SerialManipulatorDH, DQ_SerialManipulatorMDH

from dqpaint import dq
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from tests.support.jacobians import jacobian8, jacobian8_rate
from tests.support.robot_cards import IIWA, PANDA

ROWS = {
    "iiwa": IIWA,
    "panda": PANDA,
    **{n: read_card(n).denavit_hartenberg for n in ("viper850", "lwr4", "meka-a2", "iiwa7")},
}
BARE = {name: rows.model_copy(update={"base": type(rows.base)()}) for name, rows in ROWS.items()}


@pytest.fixture(params=BARE)
def chain(request):
    return BARE[request.param].chain


def test_pham_s_viper_stands_where_the_paper_says():
    """Pham 2010 [36] and T_init, to the four decimals printed there."""
    x = BARE["viper850"].chain.pose(np.radians([20.0, -110, 190, 25, 45, 20]))
    printed = [0.3530, 0.0651, 0.8660, 0.3482, -0.2192, -0.2526, -0.0098, 0.2938]
    np.testing.assert_allclose(x, printed, atol=5.1e-5)
    np.testing.assert_allclose(
        dq.matrix_from_pose(x)[:3],
        [
            [-0.7423, -0.1331, 0.6567, 0.3658],
            [0.3585, 0.7491, 0.5570, 0.1586],
            [-0.5661, 0.6489, -0.5083, 0.7963],
        ],
        atol=5.1e-5,
    )


@pytest.mark.parametrize(("q", "t", "r"), [
    (np.zeros(7), (0.00502, -0.60018, 0.2164), (-0.5, 0.5, -0.5, 0.5)),
    (
        np.arange(1, 8) / 10,
        (0.16312, -0.51352, 0.39538),
        (-0.56549, 0.48278, 0.31079, 0.59207),
    ),
])  # fmt: skip
def test_the_meka_stands_where_its_sources_say(q, t, r):
    x = BARE["meka-a2"].chain.pose(q)
    np.testing.assert_allclose(dq.translation(x), t, atol=5.1e-6)
    np.testing.assert_allclose(dq.rotation(dq.nearest(x, np.array([*r, 0, 0, 0, 0]))), r, atol=6e-6)


def test_the_lwr_stretches_to_eleven_tenths_of_a_metre():
    T = dq.matrix_from_pose(BARE["lwr4"].chain.pose(np.zeros(7)))
    np.testing.assert_allclose(T[:3, 3], [0, 0, 1.1], atol=1e-15)


def peer(rows):
    """The same rows in dqrobotics, which knows no base and flange of its own here."""
    chain = rows.chain
    kind = DQ_SerialManipulatorMDH if chain.modified else DQ_SerialManipulatorDH
    arm = kind(np.vstack([chain.theta, chain.d, chain.a, chain.alpha, np.zeros(len(chain.d))]))
    arm.set_effector(dqr.DQ(chain.flange))
    return arm


@pytest.mark.parametrize("name", BARE)
def test_poses_and_jacobians_are_those_of_dqrobotics(name, rng):
    chain, other = BARE[name].chain, peer(BARE[name])
    for q in rng.uniform(-3, 3, (20, len(chain.d))):
        rates = rng.normal(size=len(q))
        x = chain.pose(q)
        np.testing.assert_allclose(x, other.fkm(q).vec8(), atol=1e-12)
        np.testing.assert_allclose(chain.jacobian8(q), other.pose_jacobian(q), atol=1e-12)
        np.testing.assert_allclose(
            jacobian8_rate(chain.jacobian(q), x, rates),
            other.pose_jacobian_derivative(q, rates),
            atol=1e-12,
        )


def test_pham_s_jacobian_is_that_of_the_twist(chain, rng):
    """J8 = H-(x) E6 J_w / 2, for any leading shape."""
    q = rng.uniform(-3, 3, (3, 4, len(chain.d)))
    J8 = jacobian8(chain.jacobian(q), chain.pose(q))
    assert J8.shape == (3, 4, 8, len(chain.d))
    np.testing.assert_allclose(J8, chain.jacobian8(q), atol=1e-14)
    np.testing.assert_allclose(chain.jacobian8(q)[1, 2], chain.jacobian8(q[1, 2]), atol=1e-15)


def test_a_base_carries_the_whole_arm(rng):
    rows = ROWS["meka-a2"]
    base = rows.base.pose
    q = rng.uniform(-1, 1, (5, 7))
    moved, still = rows.chain, BARE["meka-a2"].chain
    np.testing.assert_allclose(moved.pose(q), dq.mul(base, still.pose(q)), atol=1e-15)
    columns = dq.adjoint(base, still.jacobian(q).swapaxes(-1, -2)).swapaxes(-1, -2)
    np.testing.assert_allclose(moved.jacobian(q), columns, atol=1e-15)


def test_the_iiwa_7_is_the_iiwa_14_with_shorter_links(rng):
    """By PyBullet's model of the 14: 20 mm less to the shoulder and on either side of the elbow."""
    small, large = Kinematics(read_card("iiwa7")), Kinematics(read_card("iiwa"))
    for q in rng.uniform(small.card.lower, small.card.upper, (20, 7)):
        ours, model = (dq.matrix_from_pose(arm.pose(q)) for arm in (small, large))
        wrist, there = model[:3, 3] - 0.161 * model[:3, 2], np.array([0, 0, 0.36])
        upper = np.array([np.cos(q[0]) * np.sin(q[1]), np.sin(q[0]) * np.sin(q[1]), np.cos(q[1])])
        lower = (wrist - there - 0.42 * upper) / 0.4
        assert np.linalg.norm(lower) == pytest.approx(1.0)
        place = np.array([0, 0, 0.34]) + 0.4 * upper + 0.4 * lower + 0.161 * model[:3, 2]
        np.testing.assert_allclose(ours[:3, 3], place, atol=1e-12)
        np.testing.assert_allclose(ours[:3, :3], model[:3, :3], atol=1e-12)
