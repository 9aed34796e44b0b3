"""What works and what is said where libraries are not installed, each in a process of its own.

A library is away where no finder knows it: neither an import nor a look for it finds it.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
HIDE = """
import sys

away = set(filter(None, sys.argv.pop(1).split(",")))


class Without:
    def __init__(self, finder):
        self.finder = finder

    def find_spec(self, name, path=None, target=None):
        return None if name.split(".")[0] in away else self.finder.find_spec(name, path, target)

    def __getattr__(self, name):
        return getattr(self.finder, name)


sys.meta_path[:] = [Without(finder) for finder in sys.meta_path]
from dqpaint.__main__ import main

main()
"""
PYBULLET, MUJOCO = "pybullet,pybullet_data", "mujoco"
PIN = "pinocchio,coal,eigenpy"
NEITHER = f"{PYBULLET},{MUJOCO}"
NOTHING = f"{NEITHER},{PIN}"
LINE = "speed 200 mm/s\nlight white\nline to (60, 0) mm\n"
DRAW = "draw line.traj --size 64x36 --out a"
NO_PIN, NO_ENGINE = "pip install pin", "pip install mujoco-core"

TABLE = [
    # away, command, exit code, what is said
    (MUJOCO, DRAW, 0, "stiff on PyBullet"),
    (MUJOCO, f"{DRAW} --engine mujoco", 2, "pip install mujoco-core; installed: pybullet"),
    (PYBULLET, DRAW, 0, "stiff on MuJoCo"),
    (PYBULLET, f"{DRAW} --robot panda --plant compliant", 0, "on MuJoCo"),
    (PYBULLET, f"{DRAW} --robot xarm6 --plant servo", 0, "on MuJoCo"),
    (PYBULLET, f"{DRAW} --ghost", 0, "pip install pybullet"),
    (PYBULLET, f"{DRAW} --engine pybullet", 2, "pip install pybullet; installed: mujoco"),
    (PYBULLET, "check line.traj --robot iiwa", 0, "line.traj"),
    ("", DRAW, 0, "stiff on PyBullet"),
    ("", f"{DRAW} --engine mujoco", 0, "stiff on MuJoCo"),
    (NEITHER, DRAW, 2, NO_ENGINE),
    (NEITHER, f"{DRAW} --plant ideal --ghost", 0, "iiwa, ideal"),
    (NEITHER, "check line.traj --robot iiwa", 0, "line.traj"),
    (NEITHER, "pose iiwa", 0, "iiwa"),
    (NOTHING, "check line.traj", 0, "line.traj"),
    (NOTHING, "fmt --check line.traj", 0, ""),
    (NOTHING, "explain hinf", 0, "equation"),
    (NOTHING, "explain stiff", 0, "infinite bandwidth"),
    (NOTHING, "explain E218", 0, "E218"),
    (NOTHING, "new flower", 0, "flower.traj"),
    (NOTHING, "grammar", 0, "traj"),
    (NOTHING, "lsp --help", 0, "editor"),
    (NOTHING, "preview line.traj --size 64x36 --out a", 0, "exposure"),
    (NOTHING, "list controllers", 0, "hinf"),
    (NOTHING, "list plants", 0, "stiff"),
    (NOTHING, "list robots", 0, "iiwa"),
    (NOTHING, f"{DRAW} --plant ideal", 2, NO_PIN),
    (NOTHING, "pose iiwa", 2, NO_PIN),
    (NOTHING, "check line.traj --robot iiwa", 2, NO_PIN),
    (PIN, DRAW, 2, NO_PIN),
]


@pytest.mark.slow
@pytest.mark.parametrize(("away", "command", "code", "said"), TABLE)
def test_what_is_missing_is_told_and_all_else_works(away, command, code, said, tmp_path):
    (tmp_path / "line.traj").write_text(LINE)
    done = subprocess.run(
        [sys.executable, "-c", HIDE, away, *command.split()], cwd=tmp_path, text=True,
        capture_output=True, check=False, env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert done.returncode == code, done.stderr
    assert said in done.stdout + done.stderr
    assert "internal error" not in done.stderr
