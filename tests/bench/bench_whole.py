"""The whole process against a bare PyBullet program: `python tests/bench/bench_whole.py [ROUNDS]`.

The bare program imports the same libraries, loads the same arm, gives as many motor commands and
steps the same 24,000 times, as PyBullet does by itself. A second one is tuned as ours is: no shapes
and the faster solver. Rounds are interleaved, as the clock of a shared machine swings. The target
is at most 1.8 times the bare program for the 24 s spiral at 1280x720 without the arm in the
picture. On a busy machine the time of all processors together tells more.
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time

TUNED = """
import cv2, numpy, pinocchio, typer
from pydantic import BaseModel
import os, pybullet as p, pybullet_data
client = p.connect(p.DIRECT)
solver = p.CONSTRAINT_SOLVER_LCP_DANTZIG
p.setPhysicsEngineParameter(fixedTimeStep=0.001, constraintSolverType=solver)
p.setGravity(0, 0, -9.81)
flags = p.URDF_USE_INERTIA_FROM_FILE | p.URDF_IGNORE_VISUAL_SHAPES | p.URDF_IGNORE_COLLISION_SHAPES
urdf = os.path.join(pybullet_data.getDataPath(), "kuka_iiwa/model.urdf")
arm = p.loadURDF(urdf, useFixedBase=True, flags=flags)
joints, how = list(range(7)), {"targetVelocities": [0.01] * 7, "forces": [300.0] * 7}
for _ in range(3000):
    p.setJointMotorControlArray(arm, joints, p.VELOCITY_CONTROL, **how)
    for _ in range(8):
        p.stepSimulation()
"""
BARE = TUNED.replace(", flags=flags", "").replace(", constraintSolverType=solver", "")
DRAW = [sys.executable, "-m", "dqpaint", "draw", "spiral"]


def seconds(command, folder):
    environment = {**os.environ, "PYTHONPYCACHEPREFIX": folder}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # compiled files are kept, as for a user
    begin = time.perf_counter()
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    child = subprocess.Popen(command, cwd=folder, env=environment, **quiet)
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        raise SystemExit(f"{command[:3]} ends with {child.returncode}")
    return time.perf_counter() - begin, used.ru_utime + used.ru_stime


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 9
    with tempfile.TemporaryDirectory() as folder:
        programs = {
            "bare": [sys.executable, "-c", BARE],
            "bare, tuned": [sys.executable, "-c", TUNED],
            "draw": DRAW,
            "draw, occlusion": [*DRAW, "--occlusion"],
            "draw, ghost": [*DRAW, "--ghost"],
        }
        times = {name: [] for name in programs}
        for _ in range(rounds + 1):
            for name, command in programs.items():
                times[name].append(seconds(command, folder))
    for which, kind in enumerate(("by the clock", "of all processors together")):
        print(f"{kind}:")
        medians = {  # the first round warms the caches
            name: statistics.median(pair[which] for pair in pairs[1:])
            for name, pairs in times.items()
        }
        for name, middle in medians.items():
            ratios = ", ".join(f"{middle / medians[f]:.2f} x {f}" for f in ("bare", "bare, tuned"))
            print(f"  {name:16} {middle:.3f} s   {ratios}")


if __name__ == "__main__":
    main()
