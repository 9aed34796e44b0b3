"""Laws that remember: what they promise beyond those that do not, on the ideal body."""

import numpy as np
import pytest

from dqpaint import dq
from tests.support.control import STILL, body_sees, law
from tests.support.random_poses import random_poses

PERIOD = 0.002


def course(t):
    """A turning reference on a circle, pose and twist, in closed form."""
    p = np.array([0.1 * np.sin(t), 0.1 * np.cos(t), 0.3])
    angle, w = 0.5 * np.sin(0.7 * t), np.array([0.0, 0.0, 0.35 * np.cos(0.7 * t)])
    pose = dq.pose_from(p, [np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2)])
    velocity = np.array([0.1 * np.cos(t), -0.1 * np.sin(t), 0.0])
    return pose, dq.twist_from_point(w, velocity, p)


def follow(name, disturbance, seconds=8.0, period=PERIOD, noise=None, **gains):
    """[2 Im r_b; p_b] (N, 6) of the ideal body with a twist of the reference's frame on top."""
    said, x = law(name, STILL, **gains), course(0.0)[0]
    errors = []
    for k in range(int(seconds / period)):
        x_d, xi_d = course(k * period)
        measured = x if noise is None else dq.mul(x, dq.exp(0.5 * noise.normal(size=6) * 1e-4))
        u = said(body_sees(measured, x_d, xi_d)._replace(period=period))
        v = dq.adjoint(x_d, disturbance(k * period))
        x = dq.mul(dq.exp(0.5 * period * (u + v)), x)
        b = dq.mul(dq.conj(course((k + 1) * period)[0]), x)
        errors.append(np.r_[2 * b[1:4] * np.sign(b[0]), dq.translation(b)])
    return np.array(errors)


SIZE = np.array([0.1, 0.0, 0.05, 0.02, 0.0, 0.01])


def test_pi_leaves_nothing_of_a_constant_twist_where_others_leave_v_over_k():
    pi = follow("pi", lambda _t: SIZE)
    log = follow("log", lambda _t: SIZE)
    np.testing.assert_allclose(np.abs(log[-1]), np.abs(SIZE) / 20.0, rtol=0.1, atol=1e-4)
    assert np.abs(pi[-1000:]).max() < 3e-6  # what is left is of the period


def test_pi_s_error_has_the_roots_of_its_polynomial(rng):
    """A small error at a set point: s^2 + K_P s + K_I = 0, from Euler's steps of its sum."""
    said, x_d = law("pi", STILL, K_P=8.0, K_I=25.0), random_poses(rng, 1)[0]
    h, first = 1e-3, 1e-4 * np.array([0.5, -0.2, 0.4, 0.3, 0.1, -0.6])
    x, s, e = dq.mul(x_d, dq.exp(0.5 * first)), np.zeros(6), first
    for _ in range(800):
        u = said(body_sees(x, x_d)._replace(period=h))
        x = dq.mul(dq.exp(0.5 * h * u), x)
        e, s = e - h * (8.0 * e + 25.0 * s), s + h * e
    found = 2 * dq.log(dq.mul(dq.conj(x_d), x))
    np.testing.assert_allclose(found, e, atol=2e-4 * np.abs(first).max())
    t, w = 0.8, 3.0  # roots -4 +- 3i
    exact = first * np.exp(-4 * t) * (np.cos(w * t) - 4 / w * np.sin(w * t))
    np.testing.assert_allclose(found, exact, atol=0.02 * np.abs(first).max())


def test_pi_does_not_add_up_while_a_limit_clips():
    x, x_d = dq.pose_from([0.1, 0, 0], [1.0, 0, 0, 0]), dq.IDENTITY
    said = law("pi", STILL)
    seen = body_sees(x, x_d)
    first = said(seen._replace(clipped=np.bool_(True)))
    np.testing.assert_array_equal(said(seen), first)
    assert np.abs(said(seen) - first).max() == pytest.approx(0.1 * 100 * seen.period)
