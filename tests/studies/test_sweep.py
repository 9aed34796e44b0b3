"""compare and sweep as a person calls them: tables that agree with draw, pictures, messages."""

import csv
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

import dqpaint as package
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.light.images.contact_sheet import hues
from dqpaint.settings.model import make_settings
from dqpaint.studies.experiment import cells
from dqpaint.studies.experiment.axes import parse_axis
from dqpaint.studies.experiment.cells import Cell, listed_figures
from dqpaint.studies.kinds import StudyRequest, compare, sweep
from dqpaint.studies.report.charts import ALARM
from dqpaint.studies.runner.run import Result

LINE = "period 10 ms\nspeed 60 mm/s\nstart at (0, 0) mm\nline to (40, 20) mm\n"
ERROR = listed_figures("error")[0]
NOISE = {"twist": {"form": "noise", "x": 0.02, "y": 0.02, "frequency": 5.0}}


@pytest.fixture
def line(tmp_path):
    (tmp_path / "line.traj").write_text(LINE)
    return tmp_path / "line.traj"


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def asked(drawing, folder, jobs):
    return StudyRequest("study", str(drawing), {}, folder, jobs)


def opened(path):
    return cv2.imread(str(path))[..., ::-1].astype(int)


def has(image, colour, least=30):
    rgb = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)])
    return (np.abs(image - rgb).max(axis=2) < 12).sum() > least


@pytest.mark.slow
def test_a_comparison_s_table_is_what_numpy_says_of_draws(line, tmp_path):
    base = make_settings(plant="ideal", disturb=NOISE, seed=5, width=320, height=180)
    axes = [parse_axis("controller=p,pff")]
    made = compare.compare(asked(line, tmp_path / "study", 2), axes, base, 3)
    paths = {path.name: path for path in made.save()}
    assert sorted(paths) == [
        f"line-{end}" for end in
        ("errors.png", "overlay.png", "runs.csv", "sheet.png", "table.csv", "table.md", "tests.csv")
    ]  # fmt: skip
    rows = read(paths["line-table.csv"])
    assert [row["controller"] for row in rows] == ["p", "pff"]
    means = []
    for row in rows:
        figures = [
            package.draw(line, controller=row["controller"], plant="ideal", disturb=NOISE,
                         seed=seed, size=(16, 16)).metrics.figures
            for seed in (5, 6, 7)
        ]  # fmt: skip
        for name in figures[0]:
            values = [one[name] for one in figures]
            assert float(row[f"{name}_mean"]) == pytest.approx(np.mean(values), rel=1e-9)
            assert float(row[f"{name}_std"]) == pytest.approx(np.std(values, ddof=1), rel=1e-9)
        means.append(np.mean([one["error_integral"] for one in figures]))
    (test,) = read(paths["line-tests.csv"])
    assert [test[k] for k in ("A", "B", "paired", "n_A", "differ")] == [
        "pff",
        "p",
        "True",
        "3",
        "yes",
    ]
    assert float(test["difference"]) == pytest.approx(means[0] - means[1], rel=1e-9)
    assert "paired" in paths["line-table.md"].read_text()
    runs = read(paths["line-runs.csv"])
    assert [(run["controller"], run["seed"], run["status"]) for run in runs] == [
        (law, seed, "done") for law in ("p", "pff") for seed in "567"
    ]
    alone = package.draw(
        line, controller="pff", plant="ideal", disturb=NOISE, seed=6, size=(16, 16)
    )
    for name, value in alone.metrics.figures.items():
        assert float(runs[4][name]) == pytest.approx(value, rel=1e-9)
    sheet = opened(paths["line-sheet.png"])
    assert sheet.shape[1] > 2 * 320
    overlay = opened(paths["line-overlay.png"])
    assert overlay.shape[1] == 320
    overlay = overlay[:180]  # the key is below
    # both begin alike, white; what lags behind leaves the front end to one hue
    assert (overlay.min(axis=2) > 120).any()
    for hue in hues(2):
        strong, weak = np.argmax(hue), np.argmin(hue)
        assert ((overlay[..., strong] - overlay[..., weak]) > 60).any()


@pytest.mark.slow
def test_one_exposure_for_all_pictures(line, tmp_path):
    """The contact sheet holds the very pictures that draw makes, whose exposure is the asked's."""
    base = make_settings(plant="ideal", width=320, height=180)
    axes = [parse_axis("controller=p,hinf")]
    made = compare.compare(asked(line, tmp_path / "study", 2), axes, base)
    made.save()
    sheet = opened(tmp_path / "study/line-sheet.png")
    for law in ("p", "hinf"):
        drawn = package.draw(line, controller=law, plant="ideal", size=(320, 180)).image.astype(int)
        row = drawn[90, :, 0]
        hits = [
            (y, x)
            for y in range(sheet.shape[0] - 179)
            for x in range(sheet.shape[1] - 319)
            if np.array_equal(sheet[y + 90, x : x + 320, 0], row)
            and np.array_equal(sheet[y : y + 180, x : x + 320], drawn)
        ]
        assert len(hits) == 1, law


@pytest.mark.slow
def test_a_sweep_marks_what_is_unstable(line, tmp_path):
    base = make_settings(controller="p", plant="ideal")
    made = sweep.sweep(asked(line, tmp_path / "s", 2), [parse_axis("k=10,20,40,400")], base)
    paths = made.save()
    rows = read(tmp_path / "s/line-k-table.csv")
    assert [row["status"] for row in rows] == ["done", "done", "done", "oscillates"]
    rms = [float(row["position_error_rms_m_mean"]) for row in rows[:3]]
    assert rms[0] > rms[1] > rms[2]  # a law without feed-forward lags by v / k
    assert rms[1] == pytest.approx(0.06 / 20, rel=0.2)
    assert has(opened(paths[0]), ALARM)
    told = made.table_text(200)
    assert "400: oscillates: commands alternate" in told

    axes = [parse_axis("k=10,400"), parse_axis("disturb.twist.x=0.01,0.02,0.04")]
    both = sweep.sweep(asked(line, tmp_path / "s", 2), axes, base)
    paths = both.save()
    assert has(opened(paths[0]), ALARM)
    assert [cell.stable for cell in both.cells] == [True] * 3 + [False] * 3
    assert [cell.choice["disturb.twist.x"] for cell in both.cells][:3] == ["0.01", "0.02", "0.04"]
    with pytest.raises(UsageError, match=r"'colour'; .*error_integral"):
        replace(both, figure="colour").table_text(200)


def test_a_sweep_has_one_axis_or_two(line, tmp_path):
    base = make_settings(controller="p")
    k, q = parse_axis("k=1,2"), parse_axis("seed=1,2")
    for axes, fault in (
        ([], "one --vary or two"), ([k, q, k], "one --vary or two"), ([k, k], "varied twice"),
        ([parse_axis("k=1..2:9999"), parse_axis("seed=1..99:99")], "100,000 runs"),
    ):  # fmt: skip
        with pytest.raises(UsageError, match=fault):
            sweep.sweep(asked(line, tmp_path / "s", 1), axes, base)


def made_up(*values, status="done", why=""):
    return tuple(
        Result(str(i), status, why, {"error_integral": value}) for i, value in enumerate(values)
    )


def test_cells_take_figures_from_runs_that_came_to_their_end():
    mixed = Cell({"k": "5"}, made_up(1.0, 3.0) + made_up(9.0, status="oscillates", why="it rings"))
    assert mixed.spread(ERROR).mean == 2.0
    assert mixed.status == "2 done, 1 oscillates"
    assert mixed.why == "it rings"
    assert not mixed.stable
    alone = Cell({"k": "9"}, made_up(9.0, status="oscillates", why="it rings"))
    assert alone.spread(ERROR).n == 0
    assert cells.means_of([mixed, alone], ERROR).tolist() == [2.0, 9.0]  # where a chart marks it
    lost = Cell({"k": "10"}, (Result("x", "failed", "too far\nand more"),))
    assert cells.rows([mixed, alone, lost])[1:] == [
        ["5", "2.0 ± 1.4", "3", "2 done, 1 oscillates"],
        ["9", "-", "1", "oscillates"],
        ["10", "-", "1", "failed"],
    ]
    lines = cells.csv([mixed, alone, lost]).decode().splitlines()
    ends = ("mean", "std", "median", "95_low", "95_high")
    figures = ",".join(f"error_integral_{end}" for end in ends)
    assert lines[0] == f"k,runs,done,status,message,{figures}"
    assert lines[1].startswith('5,3,2,"2 done, 1 oscillates",it rings,2.0,1.41421356237')
    assert lines[3] == "10,1,0,failed,too far,,,,,"
    made = swept(mixed, alone, lost, axes=["k=5,9,10"])
    assert sweep.curves(made, ERROR)[0].lines[0].marks.tolist() == [True, True, True]
    with pytest.raises(DqpaintError, match="every run failed; the first: too far"):
        replace(made, cells=(lost,)).table_text(80)


def test_an_old_report_beside_new_tables_is_told(tmp_path, capsys):
    from dqpaint.cli.studies import _finish

    report, table = tmp_path / "a-k-report.html", tmp_path / "a-k-table.csv"
    _finish("x", [table])
    assert capsys.readouterr().err == ""
    report.write_text("old")
    _finish("x", [table, report])
    assert capsys.readouterr().err == ""
    _finish("x", [table])
    assert "a-k-report.html is of an earlier run; --report" in capsys.readouterr().err
    assert report.read_text() == "old"


def swept(*cells_of, axes):
    return sweep.Sweep(
        name="a.traj", axes=tuple(map(parse_axis, axes)), cells=cells_of, folder=Path(),
        settings=make_settings(controller="p"), figure="error_integral",
    )  # fmt: skip


def test_a_curve_names_its_axes_and_joins_no_names():
    found = [Cell({"k": k}, made_up(v)) for k, v in (("20", 1.0), ("5", 3.0))]
    (panel, _) = sweep.curves(swept(*found, axes=["k=20,5"]), ERROR)
    assert (panel.title, panel.x_label) == ("error integral over k", "k [1/s]")
    assert panel.lines[0].x.tolist() == [5.0, 20.0]
    assert panel.lines[0].y.tolist() == [3.0, 1.0]
    assert panel.lines[0].width > 0
    found = [Cell({"plant": name}, made_up(1.0)) for name in ("ideal", "stiff")]
    made = swept(*found, axes=["plant=ideal,stiff"])
    assert sweep.curves(made, ERROR)[0].lines[0].width == 0
    assert sweep.axis_descriptions(made) == []
    assert sweep.axis_descriptions(swept(*found, axes=["k=1,2"]))[0].startswith("k: 1/s, the rate")


def test_a_sweep_of_two_axes_is_drawn_over_the_one_that_is_asked_for():
    found = [
        Cell({"k": k, "plant": plant}, made_up(float(k) * (1 + i)))
        for k in ("20", "5") for i, plant in enumerate(("ideal", "stiff"))
    ]  # fmt: skip
    made = swept(*found, axes=["k=20,5", "plant=ideal,stiff"])
    shaped = replace(made, shape=sweep.SweepShape(x="k", scale="log", x_scale="linear"))
    panel = sweep.curves(shaped, ERROR)[0]
    assert [line.label for line in panel.lines] == ["plant ideal", "plant stiff"]
    assert [line.x.tolist() for line in panel.lines] == [[5, 20], [5, 20]]
    assert [line.y.tolist() for line in panel.lines] == [[5, 20], [10, 40]]
    assert (panel.log_y, panel.log_x) == (True, False)
    over = replace(made, shape=sweep.SweepShape(x="plant"))
    panel = sweep.curves(over, ERROR)[0]
    assert panel.ticks == ("ideal", "stiff")
    assert [line.label for line in panel.lines] == ["k 20", "k 5"]
