"""Whether another run leaves the first: by 1 um or 0.001 deg, in any row."""

from types import SimpleNamespace

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.errors import DqpaintError
from dqpaint.simulation.effects import has_effect
from tests.support.random_poses import random_poses

ROWS = 5


@pytest.fixture
def poses(rng):
    return random_poses(rng, ROWS)


def differs(first, other):
    """Whether it is found, and how many rows of the other run were looked at."""
    seen = []

    def again(watch):
        for k, pose in enumerate(other):
            seen.append(k)
            watch(k, pose)

    run = SimpleNamespace(pose=first, points=dq.translation(first))
    return has_effect(run, again), len(seen)


def changed(poses, row, shift=(0.0, 0.0, 0.0), turn=0.0):
    """The poses with one of them moved by a shift [m], then turned about the tool [deg]."""
    other = poses.copy()
    place = dq.translation(poses[row]) + shift
    axis = np.array([0.6, 0.0, 0.8])
    by = dq.exp(np.radians(turn) / 2 * np.concatenate([axis, np.zeros(3)]))
    other[row] = dq.pose_from(place, dq.rotation(dq.mul(by, poses[row])))
    return other


@pytest.mark.parametrize(("change", "found"), [
    ({}, False),
    ({"shift": (0.0, 0.9e-6, 0.0)}, False), ({"shift": (0.0, -1.1e-6, 0.0)}, True),
    ({"shift": (0.6e-6, 0.6e-6, 0.6e-6)}, True),
    ({"turn": 0.9e-3}, False), ({"turn": 1.1e-3}, True), ({"turn": -1.1e-3}, True),
])  # fmt: skip
@pytest.mark.parametrize("row", [0, 2, ROWS - 1])
def test_a_shift_or_a_turn_of_any_row_is_found_and_ends_the_other_run(poses, change, found, row):
    other = changed(poses, row, **change)
    assert differs(poses, other) == (found, row + 1 if found else ROWS)
    assert differs(poses, -other) == (found, row + 1 if found else ROWS)  # the same poses


def test_a_run_that_cannot_be_carried_out_without_it_is_not_the_same(poses):
    run = SimpleNamespace(pose=poses, points=dq.translation(poses))

    def again(watch):
        watch(0, poses[0])
        raise DqpaintError("beyond a limit")

    assert has_effect(run, again)
