"""The command line in a process of its own, and a drawing to give it."""

import os
import subprocess
import sys

import pytest

from tests.support.commands import LINE


@pytest.fixture
def dqpaint(tmp_path):
    def call(*words, env=None, cwd=tmp_path):
        return subprocess.run(
            [sys.executable, "-m", "dqpaint", *words],
            cwd=cwd, capture_output=True, text=True, timeout=120,
            env={**os.environ, "PYTHONWARNINGS": "error", **(env or {})},
        )  # fmt: skip

    return call


@pytest.fixture
def line(tmp_path):
    (tmp_path / "line.traj").write_text(LINE)
    return "line.traj"
