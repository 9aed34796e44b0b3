"""What a person is told after a run."""

import pytest

import dqpaint
from dqpaint.cli import listing, report
from dqpaint.diagnostics import SourceLine
from dqpaint.language import read
from dqpaint.metrics import reference_columns
from dqpaint.motion import plan
from dqpaint.outputs.summary import summarise
from dqpaint.robots.model.card import read_card


def remarks(tmp_path, period, controller):
    path = tmp_path / "dot.traj"
    path.write_text(f"period {period}\nhold 40 ms\n")
    plant = None if controller.startswith("accel") else "ideal"
    return report.remarks(dqpaint.draw(path, controller=controller, plant=plant, size=(64, 36)))


@pytest.mark.slow
@pytest.mark.parametrize("controller", ["accel", "accel-decoupled"])
def test_torques_held_for_long_are_warned_of(tmp_path, controller):
    (text,) = remarks(tmp_path, "8 ms", controller)
    assert text == (
        "warning: torques are held for 8 ms; laws that command them are made for 5 ms (200 Hz) or "
        "less\n  = help: write period 5 ms in the drawing"
    )
    assert remarks(tmp_path, "5 ms", controller) == []


def test_joint_rates_held_for_long_are_not(tmp_path):
    assert remarks(tmp_path, "20 ms", "hinf") == []


def test_a_gain_without_a_default_is_listed_without_one():
    text = listing.text(listing.lists("controllers"))
    assert "  K_O  1/s, in place of gamma_O: a number," in text
    assert "None" not in text


def test_rows_of_disturbances_and_set_points_have_their_figures_and_units(tmp_path):
    from dataclasses import replace

    from dqpaint.metrics.attenuation import Attenuation
    from dqpaint.metrics.step_response import PartResponse, StepResponse

    path = tmp_path / "dot.traj"
    path.write_text("period 8 ms\nhold 80 ms\n")
    painting = dqpaint.draw(path, plant="ideal", size=(64, 36), disturb={"twist": {"x": 0.01}})
    jump = StepResponse(
        0.2,
        SourceLine(0, 7),
        PartResponse(0.04, 1.25, 0.125, 0.002),
        PartResponse(0.5, None, 0.25, 0.1),
    )
    none = StepResponse(
        0.4,
        SourceLine(0, 9),
        PartResponse(0.01, 0.5, 0.0, 1e-15),
        PartResponse(0.0, None, 0.0, 0.0),
    )
    told = replace(
        painting,
        attenuation={"translation": Attenuation(0.3, 0.1), "rotation": Attenuation(0.05, 0.1)},
        step_responses=(jump, none),
    )
    text = report.of_painting(told, [])
    assert "bound 0.1 s: exceeded, 3 times" in text
    assert "bound 0.1 s: holds" in text
    assert "line 7: 40 mm, settles in 1.25 s, overshoot 12.5%, steady error 2 mm" in text
    assert "step on line 7: 28.6 deg, never settles, overshoot 25.0%, steady error 5.7 deg" in text
    assert text.count("line 9") == 1
    assert "steady error 0 mm" in text


def test_torques_are_told_in_nm_s():
    for figures, told in (
        ({"torque_integral_Nm_s": 12.0}, "12 Nm s, joints' norm integrated over time"),
        ({"command_integral_rad": 3.0}, "3 rad, joints' norm integrated over time"),
    ):
        assert report._commanded(figures) == [("command", told)]
    assert report._commanded({}) == []  # of a recorded run


@pytest.mark.slow
def test_lines_of_included_files_are_named(tmp_path):
    """In the reports by the file's name, in the CSV by a column of its own."""
    (tmp_path / "petal.traj").write_text(
        "# petal\n\nline by (30, 0) mm speed 2 m/s profile constant\n"
    )
    main = tmp_path / "a.traj"
    main.write_text('include "petal.traj"\nhold 40 ms\nline by (0, 9) mm\nhold 1 s\n')
    painting = dqpaint.draw(main, size=(64, 36))
    petal = str(tmp_path / "petal.traj")
    rows = zip(painting.table["file"].tolist(), painting.table["line"].tolist(), strict=True)
    assert list(dict.fromkeys(rows)) == [(1, 3), (0, 2), (0, 3), (0, 4)]
    assert {clamp.line for clamp in painting.limits} >= {SourceLine(1, 3)}
    assert f"warning: line {petal}:3 reaches speed limits" in "\n".join(report.remarks(painting))
    summary = summarise(painting)
    assert summary["included"] == ["petal.traj"]
    assert summary["limits"][0]["line"] == f"{petal}:3"
    alone = tmp_path / "b.traj"
    alone.write_text("line by (0, 9) mm\n")
    program = read(alone)
    line = SourceLine(0, 12)
    assert (program.line_name(line), program.line_reference(line)) == ("12", 12)
    assert "file" not in reference_columns(plan(program, read_card("iiwa").canvas.pose))
