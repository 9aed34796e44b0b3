"""The motion ghost: light adds up over the moments, each as long as it lasted."""

from dataclasses import replace

import numpy as np
import pytest

from dqpaint.render import motion_blur
from dqpaint.render.arm_shapes import Arm
from dqpaint.render.motion_blur import MOST_MOMENTS, blurred_arm, moments
from dqpaint.render.still import gather_glow, render_arm
from tests.support.ring_of_light import ring, seen
from tests.support.urdf_shapes import urdf

A, B = np.array([0.3, -0.4]), np.array([-0.5, 0.6])
N = 400


def test_moments_follow_each_other_over_the_whole_run(rng):
    edges = moments(np.cumsum(rng.normal(size=(900, 3)), axis=0))
    assert (edges[0], edges[-1]) == (0, 899)
    assert (np.diff(edges) > 0).all()
    assert len(edges) == MOST_MOMENTS + 1


def test_where_the_arm_moves_it_is_looked_at_more_often():
    turned = np.concatenate([np.zeros(900), np.linspace(0, 1, 100)])[:, None]
    edges = moments(turned)
    assert (edges > 900).sum() > 0.7 * MOST_MOMENTS
    assert (edges < 900).sum() >= 3  # and where it stands, too


@pytest.mark.parametrize("n", [1, 2, 3])
def test_short_runs_have_few_moments(n):
    assert moments(np.zeros((n, 2))).tolist() == list(range(max(n, 2)))


def shining(energy):
    points, _ = ring(n=N)

    def shine(samples):
        rows = np.arange(N)[samples]
        return [(points[rows[0] : rows[-1] + 2], energy[rows])]

    return shine


def veil(tmp_path, postures, energy, **choices):
    arm = Arm(urdf(tmp_path))
    return blurred_arm(arm, postures, seen(size=(480, 360)), shining(energy), 2.0, **choices)


EVEN = np.full((N, 3), 1.0 / N)
HERE, THERE = (np.tile(posture, (N + 1, 1)) for posture in (A, B))
JUMPS = np.where(np.arange(N + 1)[:, None] <= N // 2, A, B)


@pytest.mark.slow
def test_it_is_the_same_every_time(tmp_path):
    one, two = (veil(tmp_path, JUMPS, EVEN) for _ in range(2))
    np.testing.assert_array_equal(one, two)
    assert one.dtype == np.float32
    assert np.isfinite(one).all()
    assert one.min() >= 0.0


@pytest.mark.slow
@pytest.mark.parametrize("part", [0.5, 0.2])
def test_each_place_is_as_bright_as_the_arm_was_there_long(part, tmp_path, monkeypatch):
    """In the room's light alone; where it stood a fifth of the time it is a fifth as bright."""
    monkeypatch.setattr(
        motion_blur, "gather_glow", lambda lights: replace(gather_glow(lights), gain=0.0)
    )
    postures = np.where(np.arange(N + 1)[:, None] <= part * N, A, B)
    both = veil(tmp_path, postures, EVEN)
    parts = part * veil(tmp_path, HERE, EVEN) + (1 - part) * veil(tmp_path, THERE, EVEN)
    assert both.mean() == pytest.approx(parts.mean(), rel=0.01)
    assert np.abs(both - parts).mean() < 0.08 * parts.mean()  # outlines are tried elsewhere


@pytest.mark.slow
def test_an_arm_that_stands_still_is_as_bright_as_one_that_is_flashed(tmp_path):
    camera = seen(size=(480, 360))
    arm = Arm(urdf(tmp_path))
    arm.set_posture(A)
    flashed = render_arm(arm, camera, gather_glow(shining(EVEN)(slice(None))), 2.0)
    still = veil(tmp_path, HERE, EVEN)
    assert still.mean() == pytest.approx(flashed.mean(), rel=0.03)
    body = flashed.max(axis=2) > 0.05 * flashed.max()
    assert still[body].mean() == pytest.approx(flashed[body].mean(), rel=0.08)


@pytest.mark.slow
def test_a_lamp_lights_the_arm_as_it_stands_then(tmp_path):
    """Light that is emitted while the arm is at B alone falls on B alone."""
    late, early = EVEN.copy(), EVEN.copy()
    late[: N // 2] = 0.0
    early[N // 2 :] = 0.0
    here = veil(tmp_path, HERE, EVEN) > 1.1 * veil(tmp_path, THERE, EVEN)
    by_late, by_early = (veil(tmp_path, JUMPS, energy) for energy in (late, early))
    brighter = (by_early > by_late) & here
    assert brighter.sum() > 0.7 * here.sum()
