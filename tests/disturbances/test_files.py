"""Disturbances from files and several of one kind: what they do, where they lie, what is wrong."""

from pathlib import Path

import numpy as np
import pytest

import dqpaint
from dqpaint.disturbances import find_files, make_disturbances
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.plants import PLANTS
from dqpaint.settings import make_settings, read_given
from dqpaint.studies.experiment.axes import Axis, with_choice
from dqpaint.studies.runner.run import Run
from dqpaint.testing.runs import motion, run

TEXT = "period 10 ms\nstart at (40, 0) mm\nline by (-10, 20, 5) mm in 0.4 s\nhold 0.1 s\n"


def wrote(folder, text, name="wind.csv"):
    (folder / name).write_text(text)
    return str(folder / name)


def disturbed(given, plant="ideal"):
    return run(PLANTS[plant], make_disturbances(given))


def test_a_twist_from_a_file_is_the_sine_that_was_written_into_it(tmp_path):
    t = motion().t
    rows = "\n".join(f"{s!r},{float(0.03 * np.sin(4 * np.pi * s))!r}" for s in t.tolist())
    path = wrote(tmp_path, f"t_s,vy_m_s\n{rows}\n")
    sine = disturbed({"twist": {"form": "sine", "y": 0.03, "frequency": 2}})
    file = disturbed({"twist": {"": path}})
    np.testing.assert_allclose(file.pose, sine.pose, atol=1e-12)
    assert np.abs(sine.disturbance).max() > 0.02


def test_between_rows_it_goes_straight_and_outside_there_is_none(tmp_path):
    path = wrote(tmp_path, "# gust\nwz_rad_s;t_s;note\n1;0.2;7\n-1;0.6;8\n")
    course = make_disturbances({"twist": {"file": path}})["twist"].course(
        np.array([0, 0.19, 0.2, 0.3, 0.5, 0.6, 0.61])
    )
    np.testing.assert_allclose(course[:, 2], [0, 0, 1, 0.5, -0.5, -1, 0], atol=1e-12)
    assert not course[:, [0, 1, 3, 4, 5]].any()


@pytest.mark.slow
def test_a_push_from_a_file_is_the_push_that_was_written_into_it(tmp_path):
    path = wrote(tmp_path, "t_s,y_N\n0.29999,0\n0.3,60\n0.5,60\n0.50001,0\n")
    for link in (0, 4):
        plain = disturbed({"push": {"y": 60, "start": 0.3, "seconds": 0.2, "link": link}}, "torque")
        file = disturbed({"push": {"": path, "link": link}}, "torque")
        none = disturbed({}, "torque")
        np.testing.assert_array_equal(file.pose, plain.pose)
        assert np.abs(plain.points - none.points).max() > 1e-5


def test_several_of_a_kind_add_up():
    both = disturbed({"twist": {"x": 0.01, "wz": 0.1}, "twist-2": {"x": 0.02, "wz": -0.3}})
    one = disturbed({"twist": {"x": 0.03, "wz": -0.2}})
    np.testing.assert_allclose(both.pose, one.pose, atol=1e-14)
    noise = {"form": "noise", "y": 0.01, "frequency": 45}
    first, twice = disturbed({"twist": noise}), disturbed({"twist": noise, "twist-2": noise})
    ratio = np.linalg.norm(twice.disturbance[:, 4]) / np.linalg.norm(first.disturbance[:, 4])
    assert 1.2 < ratio < 1.7  # each has random numbers of its own


@pytest.mark.parametrize("given", [
    ["twist=x=0.01", "payload=2", "twist=sine,y=0.02", "twist=z=1"],
    {"twist": [{"x": 0.01}, "sine,y=0.02", "z=1"], "payload": 2},
    {"twist": {"x": 0.01}, "payload": "2", "twist-2": "sine,y=0.02", "twist-3": {"z": 1.0}},
])  # fmt: skip
def test_several_are_given_in_any_form(given):
    found = make_disturbances(make_settings(disturb=given).disturb)
    assert set(found) == {"twist", "twist-2", "twist-3", "payload"}
    assert (found["twist"].x, found["twist-2"].form, found["twist-3"].z) == (0.01, "sine", 1)


def test_several_are_given_in_settings_and_studies(tmp_path):
    wrote(tmp_path, "t_s,vx_m_s\n0,0.1\n1,0.1\n")
    file = tmp_path / "s.toml"
    file.write_text(
        'disturb.twist = ["wind.csv", "file=wind.csv", {x = 0.01}]\ndisturb.offset = "z=0.01"\n'
    )
    given = read_given(str(file), lambda _settings: None).choices["disturb"]
    assert [*given] == ["twist", "twist-2", "twist-3", "offset"]
    found = make_disturbances(given)
    assert Path(found["twist"].file) == Path(found["twist-2"].file) == tmp_path / "wind.csv"
    chosen = with_choice(make_settings(), {"disturb": "twist(x=0.1)+twist(wind.csv)"})
    assert chosen.disturb == {"twist": {"x": 0.1}, "twist-2": {"": "wind.csv"}}
    changed = with_choice(chosen, {"disturb.twist-2.x": "0.5"})
    assert changed.disturb["twist-2"]["x"] == 0.5
    assert Axis("disturb.twist-2.x", ("0.5",)).numbers == [0.5]


def test_a_file_lies_beside_the_drawing(tmp_path):
    (tmp_path / "a.traj").write_text(TEXT)
    path = wrote(tmp_path, "t_s,vx_m_s\n0,0.1\n1,0.1\n")
    there = dqpaint.draw(
        tmp_path / "a.traj", plant="ideal", size=(16, 16), disturb="twist=wind.csv"
    )
    told = there.disturbances["twist"].summary()
    assert told["file"] == "wind.csv"
    assert len(told["sha256"]) == 64
    assert find_files({"twist": {"": path}}, Path())["twist"]["file"] == path
    with pytest.raises(UsageError, match=r"'twist': no file 'gust\.csv'"):
        dqpaint.draw(tmp_path / "a.traj", disturb="twist=gust.csv")


def test_a_study_runs_again_when_a_file_changed(tmp_path):
    wrote(tmp_path, "t_s,vx_m_s\n0,0.1\n1,0.1\n")
    one = Run(str(tmp_path / "a.traj"), TEXT, make_settings(disturb=["twist=wind.csv"]))
    before = one.key
    assert one.key == before
    wrote(tmp_path, "t_s,vx_m_s\n0,0.1\n1,0.2\n")
    assert one.key != before


@pytest.mark.parametrize(("text", "said"), [
    ("t_s,vx_m_s\n0,0.1\n1,fast\n", "wind.csv, row 3, column vx_m_s: 'fast'"),
    ("t_s,vx_m_s\n0,0.1\n\n1,2000\n", "wind.csv, row 4, column vx_m_s: 2000"),
    ("t_s,vx_m_s,wz_rad_s\n0,0.1,-2000\n", "wind.csv, row 2, column wz_rad_s: -2000"),
    ("t_s,vx_m_s\n1,0.1\n0.5,0.1\n", "wind.csv, row 3, column t_s: 0.5 s"),
    ("t_s,x_N\n0,1\n", "none of the columns wx_rad_s, .* it has: t_s, x_N"),
    ("vx_m_s\n0.1\n", "no column 't_s'"),
    ("t_s,vx_m_s\n0,0.1,3\n", "row 2: 3 values, but 2 columns"),
    ("", "wind.csv is empty"),
    ("t_s,vx_m_s\n0,nan\n", "row 2, column vx_m_s: 'nan'"),
    ("t_s,vx_m_s\n50,1\n60,1\n", r"wind.csv says nothing but zeros .* \(1.2 s\)"),
])  # fmt: skip
def test_what_is_wrong_is_told_by_row_and_column(tmp_path, text, said):
    with pytest.raises(DqpaintError, match=said):
        disturbed({"twist": {"": wrote(tmp_path, text)}})


def test_a_file_and_other_values_exclude_each_other():
    for name, values in (("twist", {"x": 1.0}), ("push", {"start": 0.1}), ("offset", {"wx": 1})):
        with pytest.raises(UsageError, match=f"'{name}': .*wind.csv.*{next(iter(values))}"):
            make_disturbances({name: {"": "wind.csv", **values}})
    made = make_disturbances({"offset": {"": "a.csv", "measured": "no"}, "push": {"": "a.csv"}})
    assert not made["offset"].is_measured
    with pytest.raises(UsageError, match="form 'gust'"):
        make_disturbances({"twist": {"": "gust"}})
