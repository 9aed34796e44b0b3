"""Twist and acceleration of every kind of stroke against differences of the pose, order 2."""

from dataclasses import replace

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.program.program import Duration, Profile
from tests.support.strokes import KINDS, PROFILES, program, segment, strokes_of

BREAKPOINTS = np.array([0.0, 0.2, 0.25, 0.5, 0.75, 0.8, 1.0])
STEP = 0.002  # of the stroke's time; halved once


def only_stroke(*args):
    return strokes_of(program(segment(*args)))[0]


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize(("path", "tool"), KINDS)
def test_twist_and_acceleration_are_derivatives(rng, path, tool, profile):
    if path == "turn" and profile.endswith("rates"):
        pytest.skip("rates in m/s on a stroke without a length are an error, tested elsewhere")
    stroke = only_stroke(path, tool, profile)
    time = stroke.count * 0.008
    tau = rng.uniform(0, 1, 400)
    breakpoints = np.append(BREAKPOINTS, stroke.breakpoints)
    tau = tau[np.abs(tau[:, None] - breakpoints).min(axis=1) > 2 * STEP][:60]
    now = stroke.flow(tau)

    def errors(h):
        ahead, behind = (stroke.flow(tau + s * h) for s in (1, -1))
        forward, backward = dq.nearest(ahead.pose, now.pose), dq.nearest(behind.pose, now.pose)
        rate = (forward - backward) / (2 * h * time)
        slope = (ahead.twist - behind.twist) / (2 * h * time)
        pose_rate = 0.5 * dq.mul(dq.pure(now.twist), now.pose)
        return np.abs(rate - pose_rate).max(), np.abs(slope - now.slope).max()

    coarse, fine = errors(STEP), errors(STEP / 2)
    for a, b, size in zip(coarse, fine, (now.twist, now.slope), strict=True):
        scale = max(np.abs(size).max(), 1e-3)
        # where the profile and the path are low polynomials the differences are exact
        exact = a < 1e-10 * scale
        assert exact or 3.6 < a / b < 4.4, (a, b)
        assert b < 0.01 * scale


@pytest.mark.parametrize(
    ("path", "tool"), [("spiral", "keep"), ("curve", "keep"), ("line", "turn")]
)
def test_a_profile_that_runs_beyond_the_ends_takes_the_pose_along(path, tool):
    """Rates that begin backwards: place and twist agree there too."""
    back = replace(
        segment(path, tool), profile=Profile("cubic", (-0.02, 0.03)), timing=Duration(2.504)
    )
    (stroke,) = strokes_of(program(back))
    tau, h = np.linspace(0.02, 0.3, 15), 1e-4
    time = stroke.count * 0.008
    now, ahead, behind = (stroke.flow(tau + d) for d in (0, h, -h))
    rate = (dq.nearest(ahead.pose, now.pose) - dq.nearest(behind.pose, now.pose)) / (2 * h * time)
    np.testing.assert_allclose(rate, 0.5 * dq.mul(dq.pure(now.twist), now.pose), atol=1e-6)
    assert (stroke.progress(tau).value < 0).any()


@pytest.mark.parametrize(("path", "tool"), KINDS)
def test_poses_stay_unit(path, tool, rng):
    pose = only_stroke(path, tool).flow(rng.uniform(0, 1, 50)).pose
    np.testing.assert_allclose((pose[:, :4] ** 2).sum(1), 1, atol=1e-13)
    np.testing.assert_allclose((pose[:, :4] * pose[:, 4:]).sum(1), 0, atol=1e-13)
