"""A generator of random numbers -> general rotations and poses: never the identity."""

import numpy as np

from dqpaint import dq


def random_rotations(rng: np.random.Generator, n: int) -> np.ndarray:
    q = rng.normal(size=(n, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def random_poses(rng: np.random.Generator, n: int) -> np.ndarray:
    return dq.pose_from(rng.normal(size=(n, 3)), random_rotations(rng, n))
