"""The record of a run: its files alone give every figure and every torque command again."""

import copy
import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import dqpaint
from dqpaint import dq
from dqpaint.outputs.summary_shape import json_schema
from tests.support.json_schema import faults

ROOT = Path(__file__).parents[2]
(SCRIPT,) = re.findall(
    r"^```python\n(.*?)^```$",
    (ROOT / "docs/record.md").read_text("utf-8"),
    re.DOTALL | re.MULTILINE,
)
TEXT = (
    "period 5 ms\nstart at (20, 10, 5) mm tool rpy(10 deg, 5 deg, 0)\n"
    "line by (20, 10, 5) mm tool rpy(0, 10 deg, 30 deg) in 0.5 s\n"
    "step to (245, 25, 12) mm tool rpy(0, 12 deg, 135 deg)\nhold 0.3 s\n"
)
ERRS = {
    "noise": {"rms": 1e-5}, "links": {"part": 0.01}, "gravity": {"error": 0.1}, "base": {"z": 0.01},
}  # fmt: skip


def drawn(folder, text=TEXT, **choices):
    """A run, and the stem of its files."""
    (folder / "run.traj").write_text(text)
    painting = dqpaint.draw(folder / "run.traj", size=(32, 18), **choices)
    dqpaint.save(painting, folder / "run", "csv,json")
    return painting, folder / "run"


def said(stem):
    """What the script of the page prints, run by itself: it knows no dqpaint."""
    assert "dqpaint" not in SCRIPT
    pytest.importorskip("scipy", minversion="1.16")  # RigidTransform
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(stem)], capture_output=True, text=True, check=True
    )
    return done.stdout


def same_figures(painting, printed):
    """Every figure of a run, and no other: a time that is none in a summary is printed as inf."""
    found = dict(re.findall(r"^([a-z]\w+) +(\S+)  ", printed, re.MULTILINE))
    expected = painting.metrics.figures
    assert {name for name, value in found.items() if value != "inf"} == expected.keys()
    for name, value in expected.items():
        assert float(found[name]) == pytest.approx(value, rel=3e-7, abs=1e-15)
    return found


def test_the_page_s_script_gives_every_figure_again(tmp_path):
    """Of two steps, the worse one first: it counts; and one part of the second is none."""
    text = f"{TEXT}step to (245, 25, 90) mm\nhold 0.6 s\n"
    painting, stem = drawn(
        tmp_path, text, plant="ideal", disturb=["twist=sine,x=0.05,wy=0.4", "noise=0.001"]
    )
    found = same_figures(painting, said(stem))
    assert "step_position_settling_s" in found
    assert float(found["step_orientation_steady_rad"]) > 0


def test_error_columns_are_those_of_the_poses(tmp_path):
    """By scipy's rotations, and |1 - x* x_d| by its half angle."""
    painting, _ = drawn(tmp_path, plant="ideal", controller="p", gains="k=9")
    table = painting.table

    def parts(who):
        place = np.stack([table[f"{who}{axis}_m"] for axis in "xyz"], 1)
        return place, Rotation.from_quat(
            np.stack([table[f"{who}q{part}"] for part in "xyzw"], axis=1)
        )

    (p, r), (p_d, r_d) = parts(""), parts("desired_")
    far, angle = np.linalg.norm(p - p_d, axis=1), (r_d * r.inv()).magnitude()
    np.testing.assert_allclose(table["position_error_m"], far, atol=1e-14)
    np.testing.assert_allclose(table["orientation_error_rad"], angle, atol=1e-13)
    np.testing.assert_allclose(
        table["invariant_error"], np.hypot(2 * np.sin(angle / 4), far / 2), atol=1e-13
    )
    moved = np.linalg.norm(np.diff(p, axis=0), axis=1) / painting.motion.period
    np.testing.assert_allclose(table["speed_m_s"][:-1], moved, atol=1e-11)
    assert angle.max() > 1
    assert far.max() > 0.1


@pytest.mark.slow
@pytest.mark.parametrize(("law", "gains"), [("accel", "Kp=420"), ("accel-decoupled", "KPo=2400")])
def test_the_page_s_script_gives_every_torque_again(tmp_path, law, gains):
    """With errors of measurement and model, a far jump, and torques at their limits."""
    painting, stem = drawn(
        tmp_path, controller=law, gains=gains, disturb=ERRS, null="start,gain=1.5"
    )
    assert any(clamp.kind == "torque" for clamp in painting.limits)
    printed = said(stem)
    off, largest = re.findall(r"([\d.e+-]+) Nm", printed)
    assert float(off) < 1e-7
    assert float(largest) > 100
    same_figures(painting, printed)


@pytest.mark.slow
def test_twist_errors_and_motor_torques_are_in_the_table(tmp_path):
    """The twist error by differences of poses, on an arm that is late and turns."""
    painting, _ = drawn(tmp_path, controller="p", gains={"k": 8})
    table, track = painting.table, painting.track
    np.testing.assert_array_equal(table["motor3_Nm"], track.effort[:, 2])
    np.testing.assert_array_equal(table["rate4_rad_s"], track.measured_rates[:, 3])
    errors = np.stack([
        table[f"twist_error_{half}{axis}_{unit}"]
        for half, unit in (("w", "rad_s"), ("v", "m_s")) for axis in "xyz"
    ], axis=1)  # fmt: skip
    k = 60
    h = painting.motion.period
    apart = dq.mul(track.pose, dq.conj(painting.motion.pose))
    rate = dq.mul((apart[k + 1] - apart[k - 1]) / (2 * h), dq.conj(apart[k]))
    found = -2 * rate[[1, 2, 3, 5, 6, 7]]  # x_e_dot = 1/2 (xi - Ad(x_e) xi_d) x_e
    np.testing.assert_allclose(errors[k], found, atol=0.02 * np.abs(found).max())
    assert np.abs(found).min() > 1e-3


RUNS = {
    "step": {"plant": "ideal", "disturb": ["twist=noise,x=0.02,wy=0.3"]},
    "slow": {"on_limit": "slow", "plant": "compliant"},
    "auto": {"place": "auto", "plant": "ideal", "ghost": True},
    "torque": {"controller": "accel", "disturb": ERRS, "gains": "Kp=300..400@50%"},
}


@pytest.mark.parametrize("name", [
    "step", *(pytest.param(name, marks=pytest.mark.slow) for name in RUNS if name != "step")
])  # fmt: skip
def test_summaries_are_as_their_schema_says(tmp_path, name):
    _, stem = drawn(tmp_path, **RUNS[name])
    summary = json.loads(stem.with_suffix(".json").read_text())
    assert not list(faults(summary, json_schema()))
    columns = [header for part in summary["table"]["columns"] for header in part["names"]]
    header, *rows = stem.with_suffix(".csv").read_text().splitlines()
    assert ",".join(columns) == header
    assert summary["table"]["rows"] == len(rows)
    recorded = dqpaint.draw(tmp_path / "run.traj", size=(32, 18), recorded=f"{stem}.csv")
    dqpaint.save(recorded, tmp_path / "again", "json")
    assert not list(faults(json.loads((tmp_path / "again.json").read_text()), json_schema()))


def test_faulty_summaries_are_found(tmp_path):
    _, stem = drawn(tmp_path, plant="ideal")
    right = json.loads(stem.with_suffix(".json").read_text())

    def without(facts):
        del facts["light"]["lost"]

    def another(facts):
        facts["schema"] = "dqpaint-run-0"

    def text(facts):
        facts["error_integral"] = "0.1"

    def unknown(facts):
        facts["new"] = {"a": 1}

    def setting(facts):
        facts["settings"]["width"] = 3

    def bodies(facts):
        facts["model"]["screws"] = [1.0]

    for change in (without, another, text, unknown, setting, bodies):
        wrong = copy.deepcopy(right)
        change(wrong)
        assert list(faults(wrong, json_schema())), change.__name__


@pytest.mark.parametrize("version", ["dqpaint-run-1", "dqpaint-run-2"])
def test_summaries_of_either_version_are_settings(tmp_path, version):
    _, stem = drawn(tmp_path, plant="ideal", controller="p")
    facts = json.loads(stem.with_suffix(".json").read_text())
    (tmp_path / "old.json").write_text(json.dumps({**facts, "schema": version}))
    again = dqpaint.draw(tmp_path / "run.traj", settings=tmp_path / "old.json")
    assert again.controller.name == "p"
