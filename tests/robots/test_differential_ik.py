"""From twist to joint rates: exact where it can be, bounded where it cannot."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.robots.kinematics.differential_ik import (
    CHARACTERISTIC_LENGTH,
    DAMPING_THRESHOLD,
    damped_inverse,
    resolve,
    tool_jacobian_map,
)
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card


@pytest.fixture(scope="module")
def arm():
    return Kinematics(read_card("iiwa"))


def healthy(arm, rng, n):
    """Postures far from every singularity."""
    out = []
    while len(out) < n:
        q = rng.uniform(arm.card.lower, arm.card.upper)
        x, J = arm.pose_and_jacobian(q)
        if (
            np.linalg.svd(tool_jacobian_map(dq.translation(x)) @ J, compute_uv=False).min()
            > 1.5 * DAMPING_THRESHOLD
        ):
            out.append(q)
    return np.array(out)


def test_the_twist_comes_out_exactly_and_is_the_pseudo_inverse(arm, rng):
    for q in healthy(arm, rng, 20):
        x, J = arm.pose_and_jacobian(q)
        u, z = rng.normal(size=6), rng.normal(size=7)
        rates = resolve(J, dq.translation(x), u, z)
        np.testing.assert_allclose(J @ rates, u, atol=1e-9)
        pinv = np.linalg.pinv(J)
        np.testing.assert_allclose(rates, pinv @ u + (np.eye(7) - pinv @ J) @ z, atol=1e-8)


def test_any_leading_shape_gives_the_same(arm, rng):
    q = rng.uniform(arm.card.lower, arm.card.upper, (12, 7))
    x, J = arm.poses_and_jacobians(q)
    u, z = rng.normal(size=(12, 6)), rng.normal(size=(12, 7))
    one_by_one = [resolve(J[i], dq.translation(x[i]), u[i], z[i]) for i in range(12)]
    together = resolve(
        J.reshape(3, 4, 6, 7),
        dq.translation(x).reshape(3, 4, 3),
        u.reshape(3, 4, 6),
        z.reshape(3, 4, 7),
    )
    np.testing.assert_allclose(together.reshape(12, 7), one_by_one, atol=1e-10)


def test_shift_measures_the_twist_at_the_tool(rng):
    p, twist = rng.normal(size=3), rng.normal(size=6)
    moved = tool_jacobian_map(p) @ twist
    np.testing.assert_allclose(moved[:3], twist[:3])
    np.testing.assert_allclose(
        moved[3:] * CHARACTERISTIC_LENGTH, dq.point_velocity(twist, p), atol=1e-14
    )


def test_rates_stay_bounded_into_a_singularity_and_change_smoothly(arm):
    """The elbow stretches: without damping the rates grow without limit."""
    bends = np.radians(np.concatenate([np.linspace(20, 0.5, 400), np.linspace(0.5, 0, 50)]))
    rates = []
    for bend in bends:
        q = np.array([0.3, 0.5, -0.2, -bend, 0.4, 0.7, 0.1])
        x, J = arm.pose_and_jacobian(q)
        outward = dq.translation(x) / np.linalg.norm(dq.translation(x))
        u = dq.twist_from_point(np.zeros(3), 0.1 * outward, dq.translation(x))
        rates.append(resolve(J, dq.translation(x), u, np.zeros(7)))
    size = np.linalg.norm(rates, axis=1)
    assert np.isfinite(rates).all()
    assert (
        size.max() <= 0.1 / CHARACTERISTIC_LENGTH / DAMPING_THRESHOLD * 1.3
    )  # 1/s of the largest damped gain
    assert np.abs(np.diff(size)).max() < 0.2 * size.max()
    assert size[-1] < 0.2 * size.max()


def test_damping_is_what_it_says():
    t = DAMPING_THRESHOLD
    squares = np.array([0.0, (0.5 * t) ** 2, t**2, (2 * t) ** 2])
    damped = [4 / t**2, 1 / (0.25 * t**2 + 0.25 * 0.75 * t**2), 1 / t**2, 0.25 / t**2]
    np.testing.assert_allclose(damped_inverse(squares), damped, rtol=1e-12)
    np.testing.assert_allclose(damped_inverse(squares[2:]), damped[2:], rtol=1e-12)


def test_directions_that_are_healthy_stay_exact_at_a_singularity(arm):
    q = np.array([0.3, 0.5, -0.2, 0.0, 0.4, 0.7, 0.1])  # stretched: one direction is lost
    x, J = arm.pose_and_jacobian(q)
    shifted = tool_jacobian_map(dq.translation(x)) @ J
    axes, singular, _ = np.linalg.svd(shifted)
    assert singular[-1] < 0.05 * DAMPING_THRESHOLD
    for i in np.flatnonzero(singular > DAMPING_THRESHOLD):
        u = np.linalg.solve(tool_jacobian_map(dq.translation(x)), axes[:, i])
        rates = resolve(J, dq.translation(x), u, np.zeros(7))
        np.testing.assert_allclose(shifted @ rates, axes[:, i], atol=1e-9)
