"""Studies from Python: the same as on the command line."""

import numpy as np
import pytest

import dqpaint
from dqpaint.errors import UsageError
from dqpaint.metrics import all_figures
from tests.support import guarded

LINE = "period 10 ms\nspeed 60 mm/s\nstart at (0, 0) mm\nline to (40, 20) mm\n"
FEW = {"plant": "ideal", "jobs": 1}


@pytest.mark.slow
def test_studies_return_tables_and_pictures(tmp_path):
    (tmp_path / "line.traj").write_text(LINE)
    drawing = tmp_path / "line.traj"
    compared = dqpaint.compare(drawing, ["p", "pff"], size=(160, 90), folder=tmp_path / "s", **FEW)
    assert compared.table["controller"] == ["p", "pff"]
    errors = compared.table["error_integral_mean"]
    assert errors[0] > errors[1]
    drawn = dqpaint.draw(drawing, controller="p", plant="ideal", size=(16, 16))
    assert errors[0] == drawn.metrics.figures["error_integral"]
    assert compared.pictures["overlay"].shape == (90, 160, 3)
    assert set(compared.pictures) == {"sheet", "overlay", "errors"}
    assert "pff" in str(compared)
    assert repr(compared) == "<Comparison of line.traj: 2 cells>"
    assert "| p |" in compared._repr_markdown_()
    assert compared.page.startswith("<!doctype html>")
    assert "dqpaint.compare(" in compared.page
    assert "plant=&#x27;ideal&#x27;)" in compared.page
    assert (tmp_path / "s/runs.jsonl").is_file()
    written = compared.save(tmp_path / "out")
    assert tmp_path / "out/line-report.html" in written

    made = dqpaint.Drawing("mine", period=0.01)
    made.start(at=(0, 0))
    made.line(to=(0.04, 0.02))
    swept = dqpaint.sweep(made, "k=10,20", controller="p", **FEW)
    assert swept.table["k"] == ["10", "20"]
    assert np.diff(swept.table["position_error_rms_m_mean"]) < 0
    assert list(tmp_path.glob("**/mine*")) == []  # nothing is written that was not asked for


@pytest.mark.slow
def test_tune_and_verify_from_python(tmp_path):
    (tmp_path / "line.traj").write_text(LINE)
    tuned = dqpaint.tune(tmp_path / "line.traj", "k=10..40", effort=2.0, budget=25,
                         controller="p", **FEW)  # fmt: skip
    assert float(tuned.study.best.choice["k"]) > 30  # what lags less errs less
    assert "Best: --gain k=" in str(tuned)
    assert len(tuned.table["k"]) <= 24

    folder = guarded.make(tmp_path / "guarded")
    (one,) = dqpaint.verify(folder, jobs=1)
    assert one.faults == ("no reference",)


def test_a_figure_that_is_none_is_refused_before_the_first_run(tmp_path):
    place = tmp_path / "s"
    for study in (
        lambda: dqpaint.compare("lag", ["p"], figure="colour", folder=place),
        lambda: dqpaint.sweep("lag", "k=1,2", controller="p", figure="colour", folder=place),
        lambda: dqpaint.tune("lag", "k=1..2", controller="p", figure="colour", folder=place),
        lambda: dqpaint.tune("lag", controller="p", effort_figure="colour", folder=place),
    ):
        with pytest.raises(UsageError, match="no figure named 'colour'; known: error_integral"):
            study()
    assert not place.exists()


@pytest.mark.slow
@pytest.mark.parametrize(("law", "plant"), [("p", "ideal"), ("accel", "torque")])
def test_every_figure_of_a_run_may_be_asked_for(tmp_path, law, plant):
    (tmp_path / "line.traj").write_text(LINE)
    run = dqpaint.draw(tmp_path / "line.traj", controller=law, plant=plant, size=(16, 16))
    assert set(run.metrics.figures) <= set(all_figures())


def test_slips_are_told():
    for call, fault in (
        (lambda: dqpaint.compare("star", "p"), "is one text; a list of names"),
        (lambda: dqpaint.compare("star", [print]), "a law of one's own is a file"),
        (lambda: dqpaint.compare("star", []), "at least one is needed"),
        (lambda: dqpaint.sweep("star", "k=1,2", controller=print), "a law of one's own is a file"),
        (lambda: dqpaint.sweep("star", "k=1,2", colour=3), "no setting named 'colour'"),
        (lambda: dqpaint.sweep("star", "k=1", jobs=1, cluster="a:1"), "not both"),
        (lambda: dqpaint.tune("star", "k=5"), "is not NAME=LOW..HIGH"),
    ):
        with pytest.raises(UsageError, match=fault):
            call()
