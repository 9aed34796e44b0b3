"""Studies from Python: the same as on the command line."""

import html
import importlib

import numpy as np
import pytest

import dqpaint
from dqpaint.errors import UsageError
from dqpaint.metrics import all_figures
from dqpaint.studies.experiment import requests
from dqpaint.studies.experiment.axes import Axis
from tests.support import guarded

LINE = "period 10 ms\nspeed 60 mm/s\nstart at (0, 0) mm\nline to (40, 20) mm\n"
FEW = {"plant": "ideal", "jobs": 1}


@pytest.mark.slow
def test_studies_return_tables_and_pictures(tmp_path, capfd):
    (tmp_path / "line.traj").write_text(LINE)
    drawing = tmp_path / "line.traj"
    compared = dqpaint.compare(drawing, ["p", "pff"], size=(160, 90), folder=tmp_path / "s", **FEW)
    assert compared.table["controller"] == ["p", "pff"]
    errors = compared.table["error_integral_mean"]
    assert errors[0] > errors[1]
    drawn = dqpaint.draw(drawing, controller="p", plant="ideal", size=(16, 16))
    assert errors[0] == drawn.metrics.figures["error_integral"]
    assert compared.pictures["overlay"].shape[0] > 90  # with its key below
    assert compared._repr_html_().count("<img ") == 3
    assert set(compared.pictures) == {"sheet", "overlay", "errors"}
    assert "pff" in str(compared)
    assert repr(compared) == "<Comparison of line.traj: 2 cells>"
    assert "| p |" in compared._repr_markdown_()
    assert compared.page.startswith("<!doctype html>")
    assert "dqpaint.compare(" in compared.page
    assert "plant='ideal')" in html.unescape(compared.page)
    assert (tmp_path / "s/runs.jsonl").is_file()
    written = compared.save(tmp_path / "out")
    assert tmp_path / "out/line-report.html" in written

    made = dqpaint.Drawing("mine", period=0.01)
    made.start(at=(0, 0))
    made.line(to=(0.04, 0.02))
    told = []
    swept = dqpaint.sweep(made, {"k": [10, 20]}, controller="p", progress=told.append, **FEW)
    assert told[-1] == 1.0
    assert swept.table["k"] == ["10", "20"]
    assert np.diff(swept.table["position_error_rms_m_mean"]) < 0
    assert capfd.readouterr() == ("", "")  # nothing is said to who did not ask
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
        with pytest.raises(UsageError, match=r"'colour'; .*error_integral"):
            study()
    assert not place.exists()


@pytest.mark.slow
@pytest.mark.parametrize(("law", "plant"), [("p", "ideal"), ("accel", "torque")])
def test_every_figure_of_a_run_may_be_asked_for(tmp_path, law, plant):
    (tmp_path / "line.traj").write_text(LINE)
    run = dqpaint.draw(tmp_path / "line.traj", controller=law, plant=plant, size=(16, 16))
    assert set(run.metrics.figures) <= set(all_figures())


@pytest.mark.slow
def test_disturbances_and_plants_are_axes(tmp_path):
    (tmp_path / "line.traj").write_text(LINE)
    drawing = tmp_path / "line.traj"
    compared = dqpaint.compare(
        drawing, "p", disturbs="none,twist(sine,x=0.02,frequency=2)", seed=1, size="64x36",
        overlay=True, magnify=2, ghost=True, colour_by="speed", **FEW,
    )  # fmt: skip
    assert compared.table["disturb"] == ["none", "twist(sine,x=0.02,frequency=2)"]
    assert compared.table["runs"].tolist() == [1, 1]
    still, moved = compared.table["error_integral_mean"]
    assert moved > still

    swept = dqpaint.sweep(
        drawing, plants=["ideal", "compliant(frequency=60)"], controllers="p", jobs=1,
        disturbs="none,latency(3)",
    )  # fmt: skip
    assert swept.table["plant"] == ["ideal"] * 2 + ["compliant(frequency=60)"] * 2
    assert swept.table["disturb"] == ["none", "latency(3)"] * 2
    assert len(set(swept.table["position_error_rms_m_mean"])) == 4


def test_what_callers_ask_is_the_same_on_both_ways(tmp_path):
    several = dict.fromkeys(("controller", "plant", "robot", "disturb"))
    axes, base = requests.read_comparison({"plant": "ideal"}, several, size=(64, 36))
    assert axes == [Axis("controller", ("hinf",))]
    assert (base.plant, base.width) == ("ideal", 64)
    listed = requests.read_comparison({}, {**several, "controller": ["p(k=5)", "hinf"]})
    assert listed == requests.read_comparison({}, {**several, "controller": "p(k=5),hinf"})
    assert listed == requests.read_comparison({"controller": ["p(k=5)", "hinf"]}, several)

    axes, base = requests.read_sweep(
        "k=1,2", {}, {**several, "plant": "ideal", "controller": "p(c=3)"}
    )
    assert axes == [Axis("k", ("1", "2"))]  # one alone is no axis
    assert (base.plant, base.controller, base.gains) == ("ideal", "p", {"c": 3})
    axes, _ = requests.read_sweep({"k": np.array([1.0, 2.0]), "plant": "stiff,ideal"}, {}, several)
    assert axes == [Axis("k", ("1.0", "2.0")), Axis("plant", ("stiff", "ideal"))]
    assert requests.vary_texts({"k": (1, 100), "c": "1..2:lin"}, span=True) == [
        "k=1..100", "c=1..2:lin",
    ]  # fmt: skip


def test_gains_of_a_file_go_with_its_law(tmp_path):
    (tmp_path / "a.toml").write_text(
        'controller = "p"\ngain.k = 7\nsize = "80x45"\nplant = "ideal"\n'
    )
    given = {"settings": str(tmp_path / "a.toml")}
    several = dict.fromkeys(("controller", "plant", "robot", "disturb"))
    axes, base = requests.read_comparison(given, several, size=(64, 36))
    assert (axes[0].texts, base.gains, base.width) == (("p",), {"k": 7.0}, 80)
    axes, base = requests.read_comparison(given, {**several, "controller": "p,p(k=3),hinf"})
    assert axes[0].texts == ("p(k=7)", "p(k=3.0)", "hinf")
    assert (base.controller, base.gains, base.plant) == ("hinf", {}, "ideal")


OWN_LAW = """from dqpaint import dq


class Pull:
    'Pulls with k.'

    def __call__(self, seen, k: float = 5.0):
        return k * dq.log(dq.mul(seen.pose_d, dq.conj(seen.pose)))


def made_within():
    def inside(seen): return seen.twist_d
    return inside
"""


def test_a_law_is_given_as_a_class(tmp_path, monkeypatch):
    (tmp_path / "own_laws.py").write_text(OWN_LAW)
    (tmp_path / "line.traj").write_text(LINE)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.chdir(tmp_path)
    own = importlib.import_module("own_laws")
    several = {"controller": [own.Pull, "p"]}
    axes, _ = requests.read_comparison({}, several)
    assert axes[0].texts == ("own_laws.py:Pull", "p")
    for choices in ({"controller": own.Pull}, {"controller": "own_laws.py:Pull"}):
        axes, base = requests.read_sweep({"k": [5, 10]}, choices, {})
        assert base.controller == "own_laws.py:Pull"
    assert requests.read_sweep({"controller": [own.Pull, "p"]}, {}, {})[0][0] == Axis(
        "controller", ("own_laws.py:Pull", "p")
    )
    for lost in (own.Pull(), own.made_within(), lambda seen: seen.twist_d):
        with pytest.raises(UsageError, match="not an object, or name it"):
            requests.read_comparison({}, {"controller": lost})
    swept = dqpaint.sweep("line.traj", {"k": [5, 10]}, controller=own.Pull, size=(16, 16), **FEW)
    named = dqpaint.sweep(
        "line.traj", {"k": [5, 10]}, controller="own_laws.py:Pull", size=(16, 16), **FEW
    )
    assert swept.study.cells[0].results[0].status == "done"
    same = "position_error_rms_m_mean"
    np.testing.assert_array_equal(swept.table[same], named.table[same])
    assert "controller=Pull" in html.unescape(swept.page)


def test_slips_are_told():
    for call, fault in (
        (lambda: dqpaint.compare("star", 3), "controllers 3 is no list of names"),
        (lambda: dqpaint.compare("star", "p,"), "at least one is needed, and none is e"),
        (lambda: dqpaint.compare("star", "p", controller="p"), "controller or controllers, not b"),
        (lambda: dqpaint.sweep("star"), "0 axes; a sweep has one --vary or two"),
        (lambda: dqpaint.sweep("star", 3), "vary 3 is not 'k=5,10,20'"),
        (lambda: dqpaint.sweep("star", {"k": 3}), "vary 'k': 3 is not a list of values"),
        (lambda: dqpaint.replay("thesis-spiral", look="film"), "replay takes no 'look'"),
        (lambda: dqpaint.replay("thesis-timing", place="auto"), "takes no --place"),
        (lambda: dqpaint.compare("star", [print]), "cannot go to the processes"),
        (lambda: dqpaint.compare("star", []), "at least one is needed"),
        (lambda: dqpaint.sweep("star", "k=1,2", controller=print), "cannot go to the proc"),
        (lambda: dqpaint.sweep("star", "k=1,2", colour=3), "sweep takes no 'colour'"),
        (lambda: dqpaint.sweep("star", "k=1", jobs=1, cluster="a:1"), "not both"),
        (lambda: dqpaint.tune("star", "k=5"), "is not NAME=LOW..HIGH"),
    ):
        with pytest.raises(UsageError, match=fault):
            call()
