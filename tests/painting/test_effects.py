"""A disturbance that does not move the tool is told as such, with the reason."""

import json

import numpy as np
import pytest

import dqpaint
from dqpaint.disturbances import DISTURBANCES, make_disturbances
from dqpaint.errors import UsageError
from dqpaint.settings import make_settings
from dqpaint.studies.experiment import cells
from dqpaint.studies.experiment.cells import Cell
from dqpaint.studies.runner.run import Run, check_seeds
from dqpaint.studies.runner.worker import carry_out

LINE = "period 10 ms\nspeed 60 mm/s\nstart at (0, 0) mm\nline to (40, 20) mm\n"
PUSH = {"x": 80.0, "start": 0.3, "seconds": 0.2}


@pytest.fixture
def line(tmp_path):
    (tmp_path / "line.traj").write_text(LINE)
    return tmp_path / "line.traj"


def idle(line, **how):
    painting = dqpaint.draw(line, size=(16, 16), **how)
    return painting, set(painting.without_effect)


@pytest.mark.parametrize(
    ("plant", "given", "expected"),
    [
        ("stiff", {"push": PUSH, "payload": {"mass": 2.0}}, {"push", "payload"}),
        ("stiff", {"push": PUSH, "noise": {"rms": 1e-3}}, {"push"}),
        ("stiff", {"push": {**PUSH, "x": 2000.0}}, set()),
        ("compliant", {"push": PUSH}, set()),
        ("ideal", {"twist": {"x": 1e-8}, "latency": {"periods": 3}}, {"twist"}),
        ("ideal", {"base": {"wz": 1e-3}}, set()),
    ],
)
def test_what_does_not_move_the_tool_is_found_one_by_one(line, plant, given, expected):
    assert idle(line, plant=plant, disturb=given)[1] == expected


def test_a_disturbance_without_effect_leaves_the_run_as_it_was_and_the_summary_says_why(
    line, tmp_path
):
    pushed, found = idle(line, disturb={"push": PUSH})
    plain, none = idle(line)
    assert (found, none) == ({"push"}, set())
    np.testing.assert_allclose(pushed.track.points, plain.track.points, atol=1e-6)
    (path,) = (p for p in dqpaint.save(pushed, tmp_path / "run", "json"))
    said = json.loads(path.read_text())["without_effect"]["push"]
    assert "bandwidth" in said
    assert "--plant compliant" in said


def test_a_study_tells_it_beneath_its_table(line, tmp_path):
    run = Run(str(line), LINE, dqpaint.draw(line, disturb={"push": PUSH}, size=(16, 16)).settings)
    result = carry_out(run, "key", tmp_path)
    told = "\n".join(cells.what_means_hide([Cell({"plant": "stiff"}, (result,))]))
    assert "without effect" in told
    assert "stiff: push: the motors of 'stiff'" in told


def test_seeds_are_varied_only_where_something_is_random(line):
    def runs(**disturb):
        return [Run(str(line), LINE, make_settings(disturb=disturb, plant="compliant"))]

    for disturb in ({}, {"push": PUSH}, {"twist": {"x": 0.01}}, {"links": {"part": 0.0}}):
        with pytest.raises(UsageError, match="nothing in these runs is random"):
            check_seeds(runs(**disturb))
    check_seeds(runs(noise={"rms": 1e-4}))
    check_seeds(runs(twist={"form": "noise", "x": 0.01}))


def test_every_built_in_disturbance_says_whether_it_is_random():
    for name in DISTURBANCES:
        values = {"x": 0.01} if name in ("twist", "offset") else {}
        assert not make_disturbances({name: values})[name].is_random
