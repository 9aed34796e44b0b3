"""What several test files draw from: seeded random numbers, never special; the command line."""

import os
import subprocess
import sys

if "PYTEST_XDIST_WORKER" in os.environ:  # one of several, which would fight for the cores
    for library in ("OPENBLAS", "OMP", "MKL"):  # read when numpy is
        os.environ[f"{library}_NUM_THREADS"] = "1"

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


@pytest.fixture
def answer(tmp_path, monkeypatch, capfd):
    """What a command answers, in this process: as one of its own would, without its start."""

    def call(*words):
        from dqpaint.cli import main

        monkeypatch.chdir(tmp_path)
        monkeypatch.setattr(sys, "argv", ["dqpaint", *words])
        capfd.readouterr()
        with pytest.raises(SystemExit) as stop:
            main.run()
        return subprocess.CompletedProcess(words, stop.value.code or 0, *capfd.readouterr())

    return call
