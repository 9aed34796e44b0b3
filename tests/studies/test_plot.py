"""Curves of a run: what they show, where limits are, and what is no CSV of a run."""

import json

import numpy as np
import pytest

import dqpaint
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.robots.loading import find_card
from dqpaint.studies.plot import read_forms
from dqpaint.studies.report.run_charts import Choice, RunTable, charts_of_run

CARD = find_card("iiwa")
T = np.linspace(0, 2, 41)


def table():
    found = {"t_s": T, "position_error_m": 1e-3 * T, "orientation_error_rad": 0.1 * T,
             "speed_m_s": 0.2 + 0 * T, "effort_rad": 1e-3 + 0 * T}  # fmt: skip
    for k, axis in enumerate("xyz"):
        found[f"desired_{axis}_m"], found[f"{axis}_m"] = k + 0.1 * T, k + 0.09 * T
    for joint in range(1, 8):
        found[f"q{joint}_rad"] = CARD.upper[joint - 1] * (0.5 + 0.25 * T)
        found[f"command{joint}_rad_s"] = CARD.speed[joint - 1] * np.cos(T)
    return found


def by_title(charts):
    return {panel.title: panel for panel in charts.panels}


def test_curves_are_columns_in_the_units_that_axes_name():
    held = [("speed", 3, 0.2, 0.4), ("torque", 1, 1.0, 1.1)]
    panels = by_title(charts_of_run(RunTable("r", table(), CARD, held), Choice()))
    np.testing.assert_allclose(panels["position error"].lines[0].y, T)
    np.testing.assert_allclose(panels["orientation error"].lines[0].y, np.degrees(0.1 * T))
    reference, run = panels["y of the light"].lines
    np.testing.assert_allclose([reference.y[-1], run.y[-1]], [1200, 1180])
    joints, commands = panels["joint angles"], panels["commanded joint rates"]
    assert joints.allowed == commands.allowed == (-100, 100)
    assert len(joints.lines) == len({line.colour for line in joints.lines}) == 7
    for k, line in enumerate(joints.lines):  # at the end it stands at its upper limit
        assert line.y[-1] == pytest.approx(100)
        middle = (CARD.upper[k] + CARD.lower[k]) / 2
        at = CARD.upper[k] * 0.5
        assert line.y[0] == pytest.approx(100 * (at - middle) / (CARD.upper[k] - middle))
    np.testing.assert_allclose(commands.lines[4].y, 100 * np.cos(T))
    assert (list(commands.held), list(joints.held)) == ([(0.2, 0.4)], [])
    assert "motor torques" not in panels
    each = charts_of_run(RunTable("r", table(), CARD, held), Choice(("commands",), each=True))
    third = each.panels[2]
    np.testing.assert_allclose(third.lines[0].y, np.degrees(CARD.speed[2]) * np.cos(T))
    assert third.allowed == pytest.approx((-100, 100))  # deg/s of this joint
    assert (list(third.held), list(each.panels[3].held)) == ([(0.2, 0.4)], [])


def test_without_an_arm_there_are_units_and_no_limits():
    panels = by_title(charts_of_run(RunTable("r", table()), Choice()))
    joints = panels["joint angles"]
    assert joints.allowed is None
    assert joints.y_label.endswith("[deg]")
    np.testing.assert_allclose(joints.lines[0].y[-1], np.degrees(CARD.upper[0]))
    other = find_card("viper850")  # of six joints, not seven
    assert by_title(charts_of_run(RunTable("r", table(), other), Choice()))[
        "joint angles"
    ].allowed is None  # fmt: skip


def test_axes_are_those_that_are_asked_for():
    run = RunTable("r", table(), CARD)
    made = charts_of_run(run, Choice(("error", "speed"), "log", (0.5, 1.0)))
    assert [panel.title for panel in made.panels] == [
        "position error", "orientation error", "speed",
    ]  # fmt: skip
    assert all(panel.log_y and panel.x_span == (0.5, 1.0) for panel in made.panels)
    assert not any(panel.log_y for panel in charts_of_run(run, Choice()).panels)
    for form, head in (("png", b"\x89PNG"), ("pdf", b"%PDF"), ("svg", b"<?xml")):
        assert made.encoded(form).startswith(head)
        assert made.encoded(form) == made.encoded(form)


@pytest.mark.parametrize(
    ("choice", "said"),
    [
        (Choice(("colour",)), "colour"), (Choice(("torques",)), "torques"),
        (Choice(span=(3.0, 4.0)), "2 s"),
    ],
)  # fmt: skip
def test_what_is_not_there_is_told(choice, said):
    with pytest.raises(UsageError, match=said):
        charts_of_run(RunTable("r", table()), choice)


def written(tmp_path, found, name="run.csv"):
    rows = [",".join(found), *(",".join(map(repr, row)) for row in
                               np.stack(list(found.values()), axis=1).tolist())]  # fmt: skip
    (tmp_path / name).write_text("\n".join(rows))
    return tmp_path / name


@pytest.mark.slow
def test_a_csv_has_its_limits_from_the_summary_beside_it(tmp_path):
    path = written(tmp_path, table())
    alone = dqpaint.plot(path)
    assert "run.json" in alone.notes[0]
    assert "joint angles" in repr(alone)
    limit = {"kind": "speed", "joint": 2, "start": 0.5, "seconds": 0.25}
    facts = {"schema": "dqpaint-run-1", "robot": "iiwa", "settings": {}, "limits": [limit]}
    (tmp_path / "run.json").write_text(json.dumps(facts))
    made = dqpaint.plot(path)
    assert made.notes == ()
    commands = by_title(made.charts)["commanded joint rates"]
    assert (commands.allowed, list(commands.held)) == ((-100, 100), [(0.5, 0.75)])
    (tmp_path / "run.json").write_text('{"a": 1}')
    assert by_title(dqpaint.plot(path).charts)["joint angles"].allowed is None
    assert by_title(dqpaint.plot(path, robot="iiwa").charts)["joint angles"].allowed is not None
    assert made.save(tmp_path / "out", "svg,png") == [tmp_path / "out.png", tmp_path / "out.svg"]
    assert made._repr_png_() == (tmp_path / "out.png").read_bytes()


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"a,b\n1,2\n", "t_s"), (b"t_s,x_m\n1,2\n0,3\n", "row 3"), (b"", "empty"),
        (b"t_s,zz\n0,1\n1,2\n", "no columns"), (b"t_s,x_m\n0,nan\n1,2\n", "row 2, column x_m"),
        (b"\xff\xfe\x00", "UTF-8"), (b"t_s,x_m\n0,1\n1\n", "row 3"), (b"t_s,x_m\n", "no rows"),
    ],
)  # fmt: skip
def test_a_foreign_or_damaged_csv_is_a_sentence(tmp_path, data, said):
    (tmp_path / "x.csv").write_bytes(data)
    with pytest.raises(DqpaintError, match=said):
        dqpaint.plot(tmp_path / "x.csv")


def test_choices_of_a_run_are_refused_for_one_that_is_over(tmp_path):
    path = written(tmp_path, table())
    with pytest.raises(UsageError, match="controller"):
        dqpaint.plot(path, controller="p")
    with pytest.raises(UsageError, match="'jpg'"):
        read_forms("png,jpg")
    with pytest.raises(UsageError, match="span"):
        dqpaint.plot(path, span="2..1")
    with pytest.raises(UsageError, match="gold"):
        dqpaint.plot(path, robot="gold")


@pytest.mark.slow
def test_a_painting_its_csv_and_its_drawing_have_the_same_curves(tmp_path):
    text = "period 10 ms\nstart at (0, 0) mm\nhold 0.2 s\nstep to (60, 30) mm\nhold 1 s\n"
    (tmp_path / "s.traj").write_text(text)
    painting = dqpaint.draw(tmp_path / "s.traj", controller="p", size=(64, 36))
    dqpaint.save(painting, tmp_path / "s-p", "csv,json")
    several = [dqpaint.plot(painting), dqpaint.plot(tmp_path / "s-p.csv"),
               dqpaint.plot(tmp_path / "s.traj", controller="p")]  # fmt: skip
    first, *others = (made.charts.panels for made in several)
    assert len(painting.limits) > 0
    for panels in others:
        for one, other in zip(first, panels, strict=True):
            assert (one.title, one.allowed, list(one.held)) == (
                other.title, other.allowed, [pytest.approx(ends) for ends in other.held],
            )  # fmt: skip
            for a, b in zip(one.lines, other.lines, strict=True):
                np.testing.assert_allclose(a.y, b.y, rtol=1e-9, atol=1e-9)
