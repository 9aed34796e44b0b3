"""The optimiser against optima known in closed form; stopped, gone on with, seeded."""

import csv
import json
import math
import os
import signal
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from dqpaint.errors import DqpaintError, UsageError
from dqpaint.settings import make_settings
from dqpaint.studies.declared import run_study
from dqpaint.studies.experiment.cells import Cell
from dqpaint.studies.experiment.gain_range import Range, parse_range
from dqpaint.studies.kinds import tuning
from dqpaint.studies.kinds.tune import generation
from dqpaint.studies.runner.journal import NAME
from dqpaint.studies.runner.run import Result
from tests.support.processes import start, wait_for_lines, wait_for_the_end

STEP = "period 20 ms\nstart at (0, 0) mm\nhold 40 ms\nstep to (10, 0) mm\nhold 300 ms\n"
RING = """period 20 ms
profile constant
start at (20, 0) mm
arc center (0, 0) mm angle 720 deg in 2 s
"""
OMEGA, PERIOD = 2 * math.pi, 0.02  # [rad/s, s]


def way(k, feed_forward):
    """The way of a light on the ring, a sum of steps k T (x_d - x), and T v_d where fed."""
    asked = np.exp(1j * OMEGA * PERIOD * np.arange(100))
    x, total = asked[0], 0.0
    for x_d in asked:
        step = PERIOD * (k * (x_d - x) + feed_forward * 1j * OMEGA * x_d)
        total += abs(step)
        x += step
    return total


def gain_of(share):
    """The gain that makes the way of a lagging light a share of that of one that is fed forward."""
    low, high = 1.0, 50.0
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if way(middle, 0) < share * way(20, 1) else (low, middle)
    return low


def tune(drawing, vary, folder, **choices):
    given = {"controller": "p", "plant": "ideal", "jobs": 1, "vary": vary, **choices}
    return run_study("tune", str(drawing), given, folder)


@pytest.mark.slow
def test_an_optimum_within_is_found(tmp_path):
    """e(k+1) = (1 - k T) e(k): no error is left after one period where k T = 1."""
    (tmp_path / "step.traj").write_text(STEP)
    found = tune(tmp_path / "step.traj", ["k=10..300"], tmp_path / "s", effort=3.0)
    assert found.settled
    assert float(found.best.choice["k"]) == pytest.approx(1 / 0.02, rel=0.005)
    rings = [c for c in found.cells if float(c.choice["k"]) > 2 / 0.02]
    assert all(not cell.stable for cell in rings)
    assert rings
    table = list(csv.DictReader(found.save()[2].read_text().splitlines()))
    errors = [float(row["error_integral_mean"]) for row in table if row["status"] == "done"]
    assert found.best.spread(found.error).mean == min(errors)


@pytest.mark.slow
def test_an_optimum_at_the_bound_is_found_and_a_search_that_was_killed_finds_it_too(tmp_path):
    """What lags on a circle draws it smaller, and needs the less effort for it."""
    (tmp_path / "ring.traj").write_text(RING)
    bound = 0.8
    words = ("tune", "ring.traj", "--controller", "p", "--plant", "ideal", "--vary", "k=4..30",
             "--effort", f"{bound}", "--effort-figure", "speed_integral_m", "--budget", "50",
             "--jobs", "1", "--out", "killed")  # fmt: skip
    killed = start(tmp_path, *words)
    record = tmp_path / "killed" / NAME
    wait_for_lines(record, 12)
    os.kill(killed.pid, signal.SIGKILL)
    killed.communicate(timeout=30)
    wait_for_the_end(killed.pid)
    before = record.read_bytes()
    again = start(tmp_path, *words)
    out, err = again.communicate(timeout=100)
    assert again.returncode == 0, err
    after = record.read_bytes()
    assert after.startswith(before[: before.rfind(b"\n") + 1])
    keys = Counter(json.loads(line)["key"] for line in after.splitlines())
    assert set(keys.values()) == {1}
    count = before.count(b"\n")
    assert f"note: {count} of {len(keys)} runs were done before" in err

    whole = tune(tmp_path / "ring.traj", ["k=4..30"], tmp_path / "whole", effort=bound,
                 effort_figure="speed_integral_m", budget=50, jobs=2)  # fmt: skip
    for path in whole.save():
        assert (tmp_path / "killed" / path.name).read_bytes() == path.read_bytes()
    k = float(whole.best.choice["k"])
    assert k == pytest.approx(gain_of(bound), rel=2e-3)
    assert f"Best: --gain k={k:g}\n" in out
    assert whole.best.spread(whole.effort).mean <= whole.bound

    # the trade-off: nothing tried has both less error and less effort
    front = [(c.spread(whole.effort).mean, c.spread(whole.error).mean) for c in whole.front]
    for cell in whole.cells:
        effort, error = cell.spread(whole.effort).mean, cell.spread(whole.error).mean
        assert any(e <= effort and f <= error for e, f in front)
    assert np.all(np.diff(front, axis=0) * [1, -1] > 0)


@pytest.mark.slow
def test_a_bound_that_nothing_keeps_is_told(tmp_path):
    (tmp_path / "step.traj").write_text(STEP)
    given = tmp_path / "s"
    choices = {"effort": 0.1, "budget": 25}
    found = tune(tmp_path / "step.traj", ["k=20..49"], given, **choices)
    assert found.best is None
    assert "No gains that were tried keep to it: the least was" in tuning.answer(found)
    other = tune(tmp_path / "step.traj", ["k=20..49"], given, seed=1, **choices)
    assert {c.label for c in other.cells} != {c.label for c in found.cells}  # seeded


def test_ranges():
    assert parse_range("k = 1..100") == Range("k", 1.0, 100.0, True)
    assert parse_range("k=0..5") == Range("k", 0.0, 5.0, False)
    assert parse_range("k=1..5:lin") == Range("k", 1.0, 5.0, False)
    log = Range("k", 1.0, 100.0, True)
    assert [log.value(part) for part in (0.0, 0.5, 1.0)] == [1.0, 10.0, 100.0]
    assert log.value(1 / 3) == 4.642  # what is tried can be written
    assert log.part(10.0) == pytest.approx(0.5)
    for text in ("k", "k=", "k=1", "k=1..x", "k=5..1", "k=0..5:log", "k=1..inf", "k=1..2:9", ""):
        with pytest.raises(UsageError, match=r"\.\.|above"):
            parse_range(text)
    assert [generation(n) for n in (1, 2, 3, 4)] == [8, 16, 32, 32]


@pytest.mark.parametrize(
    ("texts", "choices", "fault"),
    [
        (["q=1..2"], {}, "'q'"),
        (["k=1..2", "k=1..3"], {}, "'k' .*twice"),
        (["k=1..2"], {"gains": {"k": 3.0}}, "'k' .*twice"),
        ([], {"gains": {"k": 3.0}}, "0 gains"),
        (["k=1..2"], {"budget": 24}, "24 runs"),
        (["k=1..2"], {"effort": math.nan}, "is no bound"),
        (["k=1..2"], {"runs": 2}, "random"),
        (["k=-2..2"], {}, "'k' .*'p' is -2"),
    ],
)
def test_slips_are_told_before_anything_runs(tmp_path, texts, choices, fault):
    (tmp_path / "step.traj").write_text(STEP)
    with pytest.raises(UsageError, match=fault):
        tune(tmp_path / "step.traj", texts, tmp_path / "s", **choices)
    assert not (tmp_path / "s").exists()


def test_what_is_told_of_made_up_results(tmp_path):
    def cell(k, error, effort, status="done"):
        figures = {"error_integral": error, "command_integral_rad": effort}
        return Cell({"k": str(k)}, (Result(str(k), status, "why", figures),))

    from dqpaint.studies.experiment.cells import listed_figures

    (error, *_), (command, *_) = listed_figures("error"), listed_figures("cost")
    tried = (cell(1, 9.0, 2.0), cell(5, 4.0, 3.0), cell(6, 5.0, 3.5), cell(8, 2.0, 4.5),
             cell(9, 0.1, 3.0, "oscillates"))  # fmt: skip
    made = tuning.Tuning(
        name="a.traj", cells=tried, folder=tmp_path, settings=make_settings(controller="p"),
        ranges=(parse_range("k=1..5"),), usual=tried[2], error=error, effort=command,
        needed=2.0, factor=2.0, settled=False,
    )  # fmt: skip
    assert made.best is tried[1]  # the one that oscillates does not count
    assert made.front == [tried[0], tried[1], tried[3]]
    told = made.table_text(200)
    assert "Best: --gain k=5\nk lies at the end of its range, 5" in told
    assert "The budget was spent" in told
    assert [row[:2] for row in tuning.rows(made)[1:]] == [
        ["usual", "6"], ["best", "5"], ["trade-off", "1"], ["trade-off", "8"]
    ]  # fmt: skip
    assert [row[-1] for row in tuning.rows(made)[1:]] == [
        "done", "done", "done", "done, beyond the bound"
    ]  # fmt: skip
    trade, over = tuning.panels(made)
    assert (trade.wall, trade.limit) == (4.0, "most allowed")
    assert (trade.x_label, over.x_label) == ("command", "k [1/s]")
    lost = Cell({"k": "5"}, (Result("x", "failed", "too far"),))
    with pytest.raises(DqpaintError, match="every run failed; the first: too far"):
        replace(made, cells=(lost,), usual=None).table_text(80)
