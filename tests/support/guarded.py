"""A folder with one guarded drawing by a law of its own, and the faults that may befall it."""

LAW = """import numpy as np
from dqpaint import dq

SHIFT = dq.pose_from(np.array([0.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0, 0.0]))


def mylaw(seen, k=20.0):
    asked = dq.mul(SHIFT, seen.pose_d)
    error = dq.mul(asked, dq.conj(dq.nearest(seen.pose, asked)))
    return seen.twist_d + 2 * k * dq.log(error)
"""
DRAWING = """period 8 ms
profile constant
start at (-60, -20) mm
line by (60, 60) mm samples 200 light orange
line by (60, -60) mm samples 200 light cyan
"""
GAP = """line by (30, -30) mm samples 100 light cyan
line by (3, -3) mm samples 10 light off
line by (27, -27) mm samples 90 light cyan
"""
CASES = '[corner]\ndrawing = "corner.traj"\ncontroller = "mylaw.py"\nplant = "ideal"\n'


def make(folder):
    folder.mkdir()
    (folder / "corner.traj").write_text(DRAWING)
    (folder / "mylaw.py").write_text(LAW)
    (folder / "cases.toml").write_text(CASES)
    return folder


def shifted(folder, metres):
    """The arm is off, sideways in the picture."""
    (folder / "mylaw.py").write_text(LAW.replace("[0.0, 0.0, 0.0])", f"[0.0, {metres}, 0.0])", 1))


def with_gap(folder):
    """The light is off for 10 samples, on the same way."""
    lines = DRAWING.splitlines(keepends=True)
    (folder / "corner.traj").write_text("".join(lines[:-1]) + GAP)


def with_gain(folder, factor):
    (folder / "mylaw.py").write_text(LAW.replace("k=20.0", f"k={20.0 * factor}"))
