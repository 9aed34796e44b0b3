"""What several test files draw from: seeded random poses, twists and quaternions, never special."""

import numpy as np
import pytest

from dqpaint import dq


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20161122)


def random_rotations(rng: np.random.Generator, n: int) -> np.ndarray:
    q = rng.normal(size=(n, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def random_poses(rng: np.random.Generator, n: int) -> np.ndarray:
    return dq.pose_from(rng.normal(size=(n, 3)), random_rotations(rng, n))
