"""What every control law promises, whoever wrote it."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS, Seen
from dqpaint.errors import UnknownNameError, UsageError
from dqpaint.robots.card import installed_names, read_card
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.resolver import resolve
from tests.conftest import random_poses

LAWS = pytest.mark.parametrize("name", CONTROLLERS)


def command(name, seen):
    chosen = CONTROLLERS[name]
    return chosen.law(seen, chosen.read_gains({}).first)


def seen_by(arm, q, x_d, twist_d=None):
    x, J = arm.pose_and_jacobian(q)
    return Seen(x, x_d, np.zeros(6) if twist_d is None else twist_d, np.zeros(6), J, q, 0.0, 0.008)


@LAWS
def test_signs_of_poses_do_not_matter(name, rng):
    arm = Kinematics(read_card("iiwa"))
    for x_d in random_poses(rng, 20):
        seen = seen_by(arm, rng.uniform(-1, 1, 7), x_d, rng.normal(size=6))
        u = command(name, seen)
        np.testing.assert_allclose(command(name, seen._replace(pose=-seen.pose)), u, atol=1e-9)
        np.testing.assert_allclose(command(name, seen._replace(pose_d=-x_d)), u, atol=1e-9)


@LAWS
def test_a_batch_is_the_same_as_one_by_one(name, rng):
    arm = Kinematics(read_card("iiwa"))
    rows = [
        seen_by(arm, rng.uniform(-1, 1, 7), x, rng.normal(size=6)) for x in random_poses(rng, 6)
    ]
    stacked = [np.array([getattr(r, f) for r in rows]) for f in Seen._fields[:6]]
    together = command(name, Seen(*stacked, 0.0, 0.008))
    np.testing.assert_allclose(together, [command(name, r) for r in rows], atol=1e-10)
    shaped = Seen(*(a.reshape(2, 3, *a.shape[1:]) for a in stacked), 0.0, 0.008)
    np.testing.assert_allclose(command(name, shaped).reshape(6, 6), together, atol=1e-12)


@LAWS
@pytest.mark.parametrize("robot", installed_names())
def test_commands_are_finite_everywhere(name, robot, rng):
    arm = Kinematics(read_card(robot))
    special = [np.zeros(arm.card.joints), arm.card.home, arm.card.lower, arm.card.upper]
    for q in [*special, *rng.uniform(arm.card.lower, arm.card.upper, (20, arm.card.joints))]:
        x, J = arm.pose_and_jacobian(q)
        axis = rng.normal(size=3)
        half_turn = np.concatenate([axis / np.linalg.norm(axis) * np.pi, rng.normal(size=3)])
        for x_d in (x, -x, dq.mul(dq.exp(half_turn / 2), x), *random_poses(rng, 3)):
            u = command(name, seen_by(arm, q, x_d, rng.normal(size=6)))
            rates = resolve(J, dq.translation(x), u, arm.card.home - q)
            assert np.isfinite(u).all()
            assert np.isfinite(rates).all()


@LAWS
@pytest.mark.parametrize("robot", installed_names())
def test_every_law_converges_on_a_set_point(name, robot, rng):
    arm = Kinematics(read_card(robot))
    goal = arm.pose(arm.card.home)
    q = arm.card.home + rng.uniform(-0.3, 0.3, arm.card.joints)
    for _ in range(1500):
        seen = seen_by(arm, q, -goal)
        q = q + 0.002 * resolve(
            seen.jacobian, dq.translation(seen.pose), command(name, seen), 0 * q
        )
    assert np.abs(dq.log(dq.mul(arm.pose(q), dq.conj(goal)))).max() < 1e-6


@LAWS
def test_the_long_way_round_is_never_taken(name):
    """From 170 degrees away about x, the tool turns back through 170, not on through 190."""
    x_d = dq.pose_from([0.4, 0.1, 0.3], [1.0, 0, 0, 0])
    angle = np.radians(170)
    for sign in (1, -1):
        x = sign * dq.pose_from([0.4, 0.1, 0.3], [np.cos(angle / 2), np.sin(angle / 2), 0, 0])
        u = command(
            name, Seen(x, x_d, np.zeros(6), np.zeros(6), np.zeros((6, 7)), np.zeros(7), 0.0, 0.01)
        )
        assert u[0] < 0


@LAWS
def test_every_law_says_what_it_is(name):
    chosen = CONTROLLERS[name]
    assert chosen.summary
    assert chosen.source
    for field in chosen.gains.model_fields.values():
        assert field.description
        assert field.default is not None
    assert "q_dot" in chosen.law.__doc__


@LAWS
@pytest.mark.parametrize("value", [-1.0, 0.0, float("nan"), float("inf")])
def test_bad_gains_are_refused_with_the_law_s_own_list(name, value):
    chosen = CONTROLLERS[name]
    gain = next(iter(chosen.gains.model_fields))
    with pytest.raises(UsageError, match=f"gain '{gain}' of controller '{name}'") as caught:
        chosen.read_gains({gain: value})
    assert chosen.list_gains() in str(caught.value)


def test_unknown_names_list_the_known_ones():
    with pytest.raises(UnknownNameError, match="no controller named 'pd'; known: "):
        CONTROLLERS["pd"]
    with pytest.raises(UsageError, match=r"no gain named 'k'; its gains: gamma_O = 0.05 \(s, "):
        CONTROLLERS["hinf"].read_gains({"k": 3.0})
