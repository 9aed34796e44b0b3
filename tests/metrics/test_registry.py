"""Every metric keeps what it promises, and all that shows metrics has them from the registry."""

import json
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

import dqpaint
from dqpaint import dq
from dqpaint.cli import listing
from dqpaint.diagnostics import SourceLine
from dqpaint.errors import DqpaintError
from dqpaint.metrics import METRICS, all_columns, all_figures, measure
from dqpaint.metrics.registry import Column, Figure, column, figure, unit_suffix
from dqpaint.motion import RowLines
from dqpaint.outputs.summary import summarise
from dqpaint.painting.colour_by import colour_columns
from dqpaint.plants import PLANTS
from dqpaint.studies.experiment import cells
from dqpaint.testing import check_metric
from dqpaint.testing.runs import run
from tests.support.plugins import install

SI = {"", "m", "rad", "s", "m/s", "m/s^2", "rad/s", "rad/s^2", "rad s", "Nm", "Nm s"}


@pytest.fixture(scope="module")
def ideal():
    return run(PLANTS["ideal"])


def special(name, track):
    """A run that has what only some have, made of one that has not."""
    motion = track.motion
    n = len(motion.t)
    if name == "file":
        return replace(
            track, motion=replace(motion, source=RowLines.from_lines([SourceLine(1, 1)] * n))
        )
    if name.startswith("step_"):
        still = np.full((1, 3), 1e-2)
        pose = np.tile(motion.pose[:1], (n, 1))
        turn = np.array([[np.cos(0.1), np.sin(0.1), 0.0, 0.0]])
        pose[2:] = dq.mul(dq.pose_from(still, turn), pose[2:])
        jump = np.zeros(n, bool)
        jump[1] = True
        reached = np.concatenate([pose[:4], np.tile(pose[-1:], (n - 4, 1))])
        return replace(track, motion=replace(motion, pose=pose, jump=jump), pose=reached)
    if name == "drawing_time_s":
        return replace(track, motion=replace(motion, clock=0.5 * motion.t))
    if name == "read1_rad":
        return replace(track, measured_posture=track.measured_posture + 1e-3)
    if name.startswith("offset_"):
        return replace(track, pose_disturbance=0.1 + np.zeros((n, 6)))
    if name.startswith("disturbance_"):
        return replace(track, disturbance=0.1 + np.zeros((n, 6)))
    if name == "unclipped1_rad_s":
        return replace(track, unclipped=2 * track.command)
    if name == "unclipped1_Nm":
        return replace(track, unclipped=2 * track.command, torques=True)
    if name.startswith("believed_"):
        return replace(track, measured_pose=-1.0 * track.measured_pose)
    return None


OF_WALLS = {name for name in METRICS if name.startswith("wall")}  # a drawing with walls has them


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in METRICS if name not in OF_WALLS])
def test_what_every_metric_promises(name, ideal):
    check_metric(name, special(name, ideal))
    assert METRICS[name].unit in SI


@pytest.mark.parametrize(("unit", "end"), [
    ("rad/s^2", "_rad_s2"), ("Nm s", "_Nm_s"), ("m", "_m"), ("", ""),
])  # fmt: skip
def test_a_name_says_its_unit(unit, end):
    assert unit_suffix(unit) == end


def test_no_figure_hides_what_else_a_summary_says(tmp_path):
    (tmp_path / "a.traj").write_text("hold 20 ms\nline to (1, 0) mm\n")
    painting = dqpaint.draw(tmp_path / "a.traj", plant="ideal", size=(16, 16))
    bare = replace(painting, metrics=replace(painting.metrics, figures={}))
    assert not all_figures().keys() & summarise(bare).keys()


def test_columns_and_figures_are_where_people_look_for_them():
    assert set(colour_columns()) == {
        "line", "position-error", "orientation-error", "invariant-error", "speed", "acceleration",
        "effort", "manipulability", "clipped-joints", "wall", "wall-distance", "wall-lost",
    }  # fmt: skip
    shown = listing.lists("all")
    assert [row["name"] for row in shown["figures"]] == list(all_figures())
    assert [row["name"] for row in shown["columns"]] == [one.headers for one in all_columns()]
    text = cells.figure_meanings()
    assert all(one.meaning in text for one in all_figures().values() if one.listed)
    kinds = (cells.listed_figures(kind) for kind in ("error", "step", "cost"))
    assert cells.listed_figures() == tuple(one for kind in kinds for one in kind)


@pytest.fixture
def added(monkeypatch):
    """What is registered here is gone afterwards; it is as if a package had brought it."""
    monkeypatch.setattr(METRICS, "_things", dict(METRICS))
    monkeypatch.setattr(METRICS, "_origins", {})

    def brought(name):
        METRICS._origins[name] = "gauges 1.2"

    return brought


def test_a_new_metric_is_measured_in_its_place(ideal, added):
    @column("height_m", "m", "height", "of the light", display_unit="mm")
    def height(track):
        return track.points[:, 2]

    @figure("height_max_m", "m", "height", "of the light", kind="cost")
    def highest(track, table):
        return table["height_m"].max()

    found = measure(ideal)
    np.testing.assert_array_equal(found.table["height_m"], ideal.points[:, 2])
    assert found.figures["height_max_m"] == ideal.points[:, 2].max()
    assert list(found.figures)[-1] == "height_max_m"
    assert colour_columns()["height"].heading == "height [mm]"
    assert "height_max_m" in {row["name"] for row in listing.lists("figures")["figures"]}
    cells.check_figure("height_max_m")
    for name in ("height_m", "height_max_m"):
        check_metric(name)


@pytest.mark.parametrize(("wrong", "said"), [
    (lambda track: track.points[:, 0][1:], r"shape \(120,\); there are 121 rows, and 1 column$"),
    (lambda track: track.points, r"shape \(121, 3\); there are 121 rows, and 1 column$"),
    (lambda track: 1.0, r"shape \(\); there are"),
    (lambda track: track.nothing, "metric 'x_length_m' of gauges 1.2 failed: AttributeError: "),
])  # fmt: skip
def test_a_metric_of_a_package_that_fails_is_told_in_a_sentence(ideal, added, wrong, said):
    column("x_length_m", "m", "x", "x")(wrong)
    added("x_length_m")
    with pytest.raises(DqpaintError, match=said):
        measure(ideal)


def test_a_figure_that_is_no_number_is_refused(ideal, added):
    figure("depth_m", "m", "x", "x", kind="cost")(lambda *_: np.nan)
    with pytest.raises(DqpaintError, match="metric 'depth_m' came out as nan"):
        measure(ideal)


def test_two_of_a_name_are_refused(ideal, added):
    with pytest.raises(ValueError, match="two metrics named 'speed_m_s'"):
        column("speed_m_s", "m/s", "x", "x")(lambda track: track.points[:, 0])
    with pytest.raises(ValueError, match=r"\[m\] cannot be shown in \[deg\]"):
        column("z_m", "m", "x", "x", display_unit="deg")(lambda track: None)
    column("a_m q3_rad", "m", "x", "x")(lambda track: track.points[:, :2])
    with pytest.raises(DqpaintError, match="two columns named 'q3_rad', one of them with 'a_m, q3"):
        measure(ideal)


def made(kind=Column, **changed):
    more = {"names": ("a_m",), "reference": None}
    if kind is not Column:
        more = {"name": "a_m", "kind": "cost"}
    function = (lambda track: track.points[:, 0]) if kind is Column else (lambda track, table: 1.0)
    given = {"unit": "m", "title": "a", "meaning": "b", "measure": function, **more, **changed}
    return kind(**{"display_unit": given["unit"], **given})


NOISE = np.random.default_rng(1)


@pytest.mark.slow
@pytest.mark.parametrize(("faulty", "said"), [
    (made(meaning=""), "has a title and a meaning"),
    (made(names=("a_mm",)), "'a_mm' ends with its unit: _m"),
    (made(unit=""), "'a_m' does not end with a unit, as it has none"),
    (made(names=("a-b_m",)), "is made of letters, digits and _"),
    (made(measure=lambda track: track.points[1:, 0]), "there are 121 rows"),
    (made(measure=lambda track: track.points[:, 0] / 0.0), "finite values in every row"),
    (
        made(measure=lambda track: NOISE.normal(size=len(track.points))),
        "repeats itself bit for bit",
    ),
    (made(measure=lambda track: None), "has values in some run"),
    (
        made(measure=lambda track: track.points[:, 0], reference=lambda motion: motion.t[1:]),
        "121 rows",
    ),
    (made(Figure, measure=lambda track, table: np.inf), "is a finite number"),
    (made(Figure, measure=lambda track, table: NOISE.normal()), "repeats itself bit for bit"),
    (made(Figure, unit="rad"), "ends with its unit: _rad"),
    (made(Figure, title=""), "has a title and a meaning"),
])  # fmt: skip
def test_faulty_metrics_are_found(faulty, said):
    with np.errstate(all="ignore"), pytest.raises(AssertionError, match=said):
        check_metric(faulty)


def test_faultless_metrics_pass():
    check_metric(made())
    check_metric(made(Figure))


GAUGES = """
from dqpaint.metrics import column, figure

@column("reach_m", "m", "reach", "from the base", display_unit="mm", from_zero=True,
        study="drawn")
def reach(track):
    return (track.points ** 2).sum(axis=1) ** 0.5

@figure("reach_max_m", "m", "reach largest", "from the base", display_unit="mm",
        kind="cost", listed=True)
def farthest(track, table):
    return float(table["reach_m"].max())
"""
POINTS = "[dqpaint.metrics]\nreach_m = gauges:reach\nbroken_m = gauges.nowhere:of\n"
SCRIPT = """
import json
import dqpaint
from dqpaint.cli import listing
from dqpaint.testing import check_metric

run = dqpaint.draw("a.traj", plant="ideal", size=(64, 36), colour_by="reach")
dqpaint.save(run, "a", "csv,json")
made = dqpaint.compare("a.traj", ["p", "pff"], figure="reach_max_m", size=(64, 36), folder="s")
check_metric("reach_m")
check_metric("reach_max_m")
print(json.dumps({
    "notes": run.notes, "legend": run.scene.legend.title,
    "mean": list(made.table["reach_max_m_mean"]),
    "listed": [row for row in listing.lists("columns")["columns"] if row["name"] == "reach_m"],
    "faults": listing.faults("columns"),
}))
"""


@pytest.mark.slow
def test_another_package_brings_metrics(tmp_path):
    install(tmp_path / "site", "gauges", {"__init__": GAUGES}, POINTS)
    (tmp_path / "a.traj").write_text("period 20 ms\nspeed 60 mm/s\nline to (40, 20) mm\n")
    (tmp_path / "run.py").write_text(f"if __name__ == '__main__':\n    exec({SCRIPT!r})\n")
    path = ":".join([str(tmp_path / "site"), *filter(None, sys.path)])
    done = subprocess.run(
        [sys.executable, "run.py"], cwd=tmp_path, env={"PYTHONPATH": path, "HOME": str(tmp_path)},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert not done.returncode, done.stderr
    told = json.loads(done.stdout.splitlines()[-1])
    header, *rows = (tmp_path / "a.csv").read_text().splitlines()
    assert header.endswith(",reach_m")
    reached = [float(row.rpartition(",")[2]) for row in rows]
    summary = json.loads((tmp_path / "a.json").read_text())
    assert summary["reach_max_m"] == pytest.approx(max(reached))
    assert summary["plugins"]["metric reach_m"] == "gauges 1.2"
    assert told["legend"] == "reach [mm]"
    assert told["mean"][0] == pytest.approx(max(reached), abs=0.01)
    assert told["listed"][0]["package"] == "gauges 1.2"
    assert any("metric 'broken_m' of gauges 1.2 cannot be loaded" in note for note in told["notes"])
    assert told["faults"] == [note for note in told["notes"] if "broken_m" in note]
