"""The bounds of the H-infinity laws in steps, attacked in a loop of homogeneous matrices."""

import math

import numpy as np
import pinocchio
import pytest

from dqpaint.metrics.attenuation import bounds_in_steps

T = 0.008


def loop(v, K_T, K_O, push=None):
    """Errors (rotation angles about an axis, places) of a tool held at a still pose, and turns.

    By pinocchio's exponential of 4x4 matrices; `push` gives v_t from the error, where it is sought.
    """
    x, angles, places, turns, pushed = pinocchio.SE3.Identity(), [], [], [], []
    for now in v:
        log = pinocchio.log3(x.rotation)
        angle = float(np.linalg.norm(log))
        sine = log * (0.5 * np.sinc(angle / 2 / np.pi))  # Im(r_e), the short way
        w = now[:3] - K_O * sine
        v_t = now[3:] if push is None else push(x.translation, w)
        u = np.r_[v_t - K_T * x.translation, w]
        x = pinocchio.exp6(pinocchio.Motion(T * u)) * x
        pushed.append(v_t)
        turns.append(T * np.linalg.norm(w))
        angles.append(float(np.linalg.norm(pinocchio.log3(x.rotation))))
        places.append(np.array(x.translation))
    return np.array(angles), np.array(places), max(turns), np.array(pushed)


def parts_of_bounds(v, a, b, push=None):
    """What came through of v, as parts of the bounds in steps; at K_T T = a, K_O T = b."""
    angles, places, turn, pushed = loop(v, a / T, b / T, push)
    rotation, translation = bounds_in_steps((math.sqrt(2) * T / b, T / a), T, turn)
    turned = np.linalg.norm(2 * np.sin(angles / 4)) / np.linalg.norm(v[:, :3])
    moved = np.linalg.norm(places) / np.linalg.norm(pushed)
    return turned / (rotation or np.inf), moved / (translation or np.inf), turn


@pytest.mark.slow
def test_nothing_that_was_tried_exceeds_the_bounds(rng):
    """Noise, constant and alternating turns about one axis, with constant and random pushes."""
    worst = np.zeros(2)
    for trial in range(160):
        a, b = rng.uniform(0.05, 1.9), rng.uniform(0.05, 3.0)
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        size = rng.choice([0.02, 0.2, 1.0, 2.0]) / T
        shape = (
            rng.normal(size=200) * size,
            np.full(200, rng.uniform(0, 1.2) * b / T),
            (-1.0) ** np.arange(200) * size,
        )[trial % 3]
        w = np.outer(shape, axis) if trial % 4 else size * rng.normal(size=(200, 3))
        v_t = np.tile(rng.normal(size=3), (200, 1)) if trial % 2 else rng.normal(size=(200, 3))
        worst = np.maximum(worst, parts_of_bounds(np.c_[w, v_t], a, b)[:2])
    assert worst.max() <= 1.0
    assert worst.min() > 0.97


@pytest.mark.parametrize(("a", "turn"), [(0.5, 0.3), (0.5, 0.6), (0.2, 0.9), (0.95, 0.2)])
def test_the_bound_of_translation_is_nearly_reached_while_the_tool_turns(a, turn):
    """A turn of constant rate, and a push along what is left of the error after the step."""
    v = np.tile([0, 0, turn / T, 0, 0, 0], (1500, 1))

    def push(p, w):
        if not p.any():
            return np.array([1.0, 0, 0])
        half = pinocchio.exp3(T * w / 2)
        s = math.sin(turn / 2) / (turn / 2)
        left = half @ p - a * s * p
        return left / np.linalg.norm(left)

    _, part, made = parts_of_bounds(v, a, 1e-9, push)
    assert made == pytest.approx(turn, rel=1e-6)
    # such a push gains T s a step, where the bound has T: the rest of it is exact
    assert part == pytest.approx(math.sin(turn / 2) / (turn / 2), rel=4e-3)
    plain = part * bounds_in_steps((1.0, T / a), T, turn)[1] / (T / a)
    assert plain > 1 + turn**2 / (8 * (1 - a)) * 0.6  # more than the bound of continuous time


@pytest.mark.parametrize(("a", "found"), [(0.16, 1.009), (0.5, 1.035), (0.95, 1.152)])
def test_turning_to_and_fro_breaks_the_bound_of_continuous_time(a, found):
    v = np.zeros((600, 6))
    v[:, 0], v[:, 4] = 0.3 / T * (-1.0) ** np.arange(600), 0.1
    _, part, turn = parts_of_bounds(v, a, 2 * a)
    ratio = part * bounds_in_steps((1.0, T / a), T, turn)[1] * a / T
    assert ratio == pytest.approx(found, abs=1e-3)
    assert part < 1


def test_without_turns_the_bounds_are_those_of_the_linear_loop():
    for a in (0.1, 0.9, 1.0, 1.3, 1.9):
        expected = T / a if a <= 1 else T / (2 - a)
        assert bounds_in_steps((1.0, T / a), T, 0.0)[1] == pytest.approx(expected, rel=1e-12)
    assert bounds_in_steps((1.0, T / 2.1), T, 0.0)[1] is None
    assert bounds_in_steps((1.0, T / 0.5), T, 3.0)[1] is None  # half a turn a step
    for b in (0.3, 2.0, 2.3):
        assert bounds_in_steps((math.sqrt(2) * T / b, 1.0), T, 0.0)[0] == math.sqrt(2) * T / b
    assert bounds_in_steps((math.sqrt(2) * T / 3.1, 1.0), T, 0.0)[0] is None


@pytest.mark.slow
@pytest.mark.parametrize("b", [0.32, 1.0, 2.0, 2.2, 2.5, 3.0])
def test_the_bound_of_rotation_is_its_supremum_about_one_axis(b):
    """Dynamic programming over the angle: with C below the supremum a cost grows from nothing."""
    n = 241
    angle = np.linspace(-np.pi / 2, np.pi / 2, n)  # half the error's
    wraps = np.pi * np.arange(-2, 3)[:, None, None]
    v = np.abs(2 / b * (angle - angle[:, None] + wraps) + np.sin(angle)[:, None]).min(axis=0)
    gained = 4 * np.sin(angle / 2) ** 2

    def bounded(C):
        step, best = gained - 2 * (C * v) ** 2, np.zeros(n)
        for _ in range(3000):
            new = np.maximum((step + best).max(axis=1), 0)
            if new[n // 2] > 1e-7 or new.max() > 1e4:
                return False
            if np.abs(new - best).max() < 1e-10:
                return True
            best = new
        return False

    bound = math.sqrt(2) * T / b
    said = bounds_in_steps((bound, 1.0), T, 0.0)[0] / bound
    assert bounded(said * 1.002)
    assert not bounded(said * 0.997)
