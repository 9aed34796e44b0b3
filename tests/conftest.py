"""Fixtures for all tests: seeded random numbers; a command -> what it answers, in this process."""

import os
import subprocess
import sys

if "PYTEST_XDIST_WORKER" in os.environ:  # one of several, which would fight for the cores
    for library in ("OPENBLAS", "OMP", "MKL"):  # read when numpy is
        os.environ[f"{library}_NUM_THREADS"] = "1"

import numpy as np
import pytest


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20161122)


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
