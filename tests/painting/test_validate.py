"""One validator of settings, one way from a drawing to the start of a run."""

import numpy as np
import pytest

import dqpaint
from dqpaint.errors import UsageError
from dqpaint.language import parse
from dqpaint.painting.paint import prepare
from dqpaint.painting.validate import check_run, check_settings
from dqpaint.planning.forecast_report import make_report
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.settings.model import make_settings
from dqpaint.studies.runner.run import Run

FAST = "period 10 ms\nstart at (0, 0) mm\nline to (120, 0) mm speed 2 m/s\nhold 100 ms\n"

ALONE = {
    "view": ("back", "no view named 'back'"),
    "look": ("flim", "no look named 'flim'"),
    "starburst": (2, "an aperture has 3 to 24 blades"),
    "brush": ("broom", "no brush named 'broom'"),
    "exposure": ("f8", "'f8' is not a part"),
    "colour_by": ("mood", "no colour-by named 'mood'"),
    "robot": ("ur7", "no robot named 'ur7'"),
    "tool": ("x", "tool 'x' is not X,Y,Z"),
    "null": ("elbow", "no null-space objective named 'elbow'"),
    "resolver": ("soft", "no resolver named 'soft'"),
    "controller": ("pd", "no controller named 'pd'"),
    "gains": ("k=1", "'hinf' has no gain named 'k'"),
    "plant": ("rubber", "no plant named 'rubber'"),
    "disturb": ("wind=3", "no disturbance named 'wind'"),
}


@pytest.mark.parametrize("name", ALONE)
def test_what_is_wrong_by_itself_is_told_to_every_caller(name):
    value, says = ALONE[name]
    settings = make_settings(**{name: value})
    run = Run("line.traj", FAST, settings)
    for check in (check_settings, check_run, lambda one: run.check()):
        with pytest.raises(UsageError, match=says):
            check(settings)


@pytest.mark.parametrize(("choices", "says"), [
    ({"controller": "accel", "plant": "stiff"}, "'stiff' takes joint rates"),
    ({"disturb": "gravity=0.1"}, "has no effect on plant 'stiff'"),
    ({"recorded": "run.csv", "seed": 1, "start": "home"}, "not simulated: leave out --from"),
    ({"recorded": "run.csv", "gains": "gamma_T=1"}, "not simulated: leave out --gain"),
])  # fmt: skip
def test_what_excludes_each_other_is_told_of_a_run(choices, says, tmp_path):
    settings = make_settings(**choices)
    check_settings(settings)  # another choice may follow
    with pytest.raises(UsageError, match=says):
        check_run(settings)
    with pytest.raises(UsageError, match=says):
        dqpaint.compare("star", folder=tmp_path / "s", jobs=1, **choices)
    assert not (tmp_path / "s").exists()


@pytest.mark.parametrize("choices", [
    {}, {"start": "home"}, {"on_limit": "slow", "null": "limits"}, {"plant": "ideal"},
])  # fmt: skip
def test_a_forecast_and_a_run_begin_alike(choices):
    settings = make_settings(**choices)
    program = parse(FAST, "fast")
    ready = prepare(program, settings).prepared
    report = make_report(program, Kinematics(read_card("iiwa")), settings)
    np.testing.assert_array_equal(report.start, ready.start)
    np.testing.assert_array_equal(report.motion.pose, ready.motion.pose)
    assert (report.retiming is not None) == (ready.retiming is not None) == ("on_limit" in choices)
    if ready.retiming:
        assert ready.motion.seconds > 0.2


def test_a_resolver_and_a_task_are_refused_where_a_law_has_no_use_for_them():
    for choices in (
        {"controller": "accel", "resolver": "qp"}, {"controller": "translation", "task": "point"},
    ):  # fmt: skip
        with pytest.raises(UsageError, match=choices["controller"]):
            check_run(make_settings(**choices))
    check_run(make_settings(controller="accel", task="beam", resolver="wampler"))
    check_run(make_settings(controller="translation", resolver="qp"))
