"""A run of one's own: what comes back is what was recorded, and every slip is named."""

import csv
import io

import numpy as np
import pytest

import dqpaint
from dqpaint import dq
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.outputs.summary import summarise
from dqpaint.outputs.tables import encode_csv
from dqpaint.painting import film_file
from dqpaint.simulation.recorded_run import along_cubics, along_screws, read_recording
from tests.support.random_poses import random_poses

TEXT = (
    "period 10 ms\nspeed 80 mm/s\nstart at (-40, 0) mm\n"
    "line to (40, 0) mm light red\narc centre (40, 30) mm angle 180 deg light blue\n"
)
SMALL = {"size": (160, 90), "plant": "ideal"}


@pytest.fixture(scope="module")
def drawing(tmp_path_factory):
    path = tmp_path_factory.mktemp("recorded") / "hook.traj"
    path.write_text(TEXT)
    return path


@pytest.fixture(scope="module")
def simulated(drawing):
    return dqpaint.draw(drawing, controller="p", gains={"k": 8}, **SMALL)


def write(path, table, rows=slice(None), names=None, sign=","):
    names = names or list(table)
    file = io.StringIO()
    writer = csv.writer(file, delimiter=sign)
    writer.writerow(names)
    for row in np.stack([table[name] for name in names], axis=1)[rows]:
        writer.writerow([f"{x:.12g}" for x in row])
    path.write_text(file.getvalue())
    return path


def test_a_simulated_run_recorded_gives_the_same_figures_and_picture(drawing, simulated, tmp_path):
    path = tmp_path / "run.csv"
    path.write_bytes(encode_csv(simulated.table))
    again = dqpaint.draw(drawing, recorded=path, size=(160, 90))
    assert again.plant == "recorded"
    np.testing.assert_array_equal(again.track.measured_posture, again.track.posture)
    np.testing.assert_array_equal(again.track.measured_pose, again.track.pose)
    assert "clipped_share" not in again.metrics.figures  # of a recording limits are not known
    for name, value in simulated.metrics.figures.items():
        if name == "clipped_share":
            continue
        assert again.metrics.figures[name] == pytest.approx(value, rel=1e-6, abs=1e-12), name
    assert again.metrics.figures["position_error_max_m"] > 1e-3
    measured = [name for name in simulated.table if name.startswith(("rate", "twist_error"))]
    assert len(measured) == 13  # of a law, which a recording has not
    assert [*again.table, *measured] == list(simulated.table)
    for name, column in again.table.items():
        np.testing.assert_allclose(column, simulated.table[name], atol=1e-6, err_msg=name)
    np.testing.assert_array_equal(again.image, simulated.image)
    facts = summarise(again)
    assert (facts["plant"], facts["controller"]) == ("recorded", "recorded")
    assert facts["recording"]["rows"] == len(simulated.motion.t)


def test_degrees_odd_times_and_a_comment(drawing, simulated, tmp_path):
    """Every third row or so, with joints in degrees, and no commands: joints and picture hold."""
    table = {"t_s": simulated.table["t_s"]}
    for i in range(7):
        table[f"q{i + 1}_deg"] = np.degrees(simulated.table[f"q{i + 1}_rad"])
    rng = np.random.default_rng(4)
    rows = np.unique(np.append(rng.choice(len(table["t_s"]), 120, replace=False),
                               [0, len(table["t_s"]) - 1]))  # fmt: skip
    path = write(tmp_path / "run.csv", table, rows, sign=";")
    path.write_text("# logged by hand\n\n" + path.read_text())
    again = dqpaint.draw(drawing, recorded=path, size=(160, 90))
    gap = np.abs(again.track.posture - simulated.track.posture).max()
    assert 0 < gap < 2e-4
    rates = np.diff(again.track.posture, axis=0) / 0.01
    np.testing.assert_allclose(again.track.command[:-1], rates, atol=1e-12)


def test_poses(drawing, simulated, tmp_path):
    names = ["t_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"]
    path = write(tmp_path / "poses.csv", simulated.table, slice(0, None, 2), names)
    again = dqpaint.draw(drawing, recorded=path, size=(160, 90))
    figures, truth = again.metrics.figures, simulated.metrics.figures
    assert figures["position_error_rms_m"] == pytest.approx(truth["position_error_rms_m"], rel=1e-3)
    assert "command_integral_rad" not in figures
    assert "manipulability" not in again.table
    assert not any(name.startswith("q1") for name in again.table)
    assert encode_csv(again.table)
    assert summarise(again)


def test_poses_alone_leave_the_arm_out_of_the_picture(drawing, simulated, tmp_path):
    names = ["t_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"]
    path = write(tmp_path / "poses.csv", simulated.table, names=names)
    again = dqpaint.draw(drawing, recorded=path, size=(160, 90), occlusion=True)
    plain = dqpaint.draw(drawing, recorded=path, size=(160, 90))
    assert "the arm and its occlusion are left out" in " ".join(again.notes)
    assert "left out" not in " ".join(plain.notes)
    assert again.picture.occluded is None
    np.testing.assert_array_equal(again.image, plain.image)
    film = tmp_path / "hook-film.npz"
    film.write_bytes(film_file.encode(again.scene, again.settings, again.arm_motion))
    (developed,) = dqpaint.develop(film)
    np.testing.assert_array_equal(developed.image, again.image)
    assert "does not say how its joints moved" in " ".join(developed.remarks)
    with pytest.raises(DqpaintError, match="manipulability"):
        dqpaint.draw(drawing, recorded=path, size=(160, 90), colour_by="manipulability")


def test_times_that_do_not_cover_the_drawing_are_held_and_said(drawing, simulated, tmp_path):
    path = write(tmp_path / "run.csv", simulated.table, slice(30, 150))
    again = dqpaint.draw(drawing, recorded=path, size=(160, 90))
    np.testing.assert_allclose(
        again.track.posture[:30], again.track.posture[30][None].repeat(30, 0)
    )
    said = " ".join(again.notes)
    assert "lacks 0.3 s before the first row" in said
    assert "after its end: the arm stands still" in said
    table = {name: column[::9] for name, column in simulated.table.items()}
    assert "gap of 0.09 s" in " ".join(
        dqpaint.draw(drawing, recorded=write(path, table), size=(160, 90)).notes
    )


def test_cubics_are_smooth_and_never_leave_their_rows():
    rng = np.random.default_rng(6)
    t = np.cumsum(rng.uniform(0.02, 0.2, 30))
    values = rng.normal(size=(30, 3))
    values[10:14] = values[10]  # standing still stays so
    at = np.linspace(t[0], t[-1], 4001)
    found = along_cubics(t, values, at)
    np.testing.assert_allclose(along_cubics(t, values, t), values, atol=1e-14)
    k = np.clip(np.searchsorted(t, at, side="right") - 1, 0, 28)
    low, high = np.minimum(values[k], values[k + 1]), np.maximum(values[k], values[k + 1])
    assert (found >= low - 1e-12).all()
    assert (found <= high + 1e-12).all()
    slopes = np.diff(found, axis=0) / np.diff(at)[:, None]
    assert np.abs(np.diff(slopes, axis=0)).max() < 0.08 * np.ptp(slopes)  # no corners


def test_cubics_begin_and_end_along_the_secants():
    t, values = np.array([0.0, 0.1, 0.3, 0.4]), np.array([[0.0], [0.3], [0.4], [0.0]])
    step = 1e-6
    first, last = along_cubics(t, values, np.array([step, 0.4 - step]))[:, 0]
    assert first / step == pytest.approx(3.0, rel=1e-4)
    assert last / step == pytest.approx(4.0, rel=1e-4)
    # between them as by hand: slope (3 * 0.5) / ((1 - 5/9) * 3 + 5/9 * 0.5) in the second row
    slope = 1.5 / (4 / 9 * 3 + 5 / 9 * 0.5)
    middle = 0.5 * 0.3 + 0.1 / 8 * (3.0 - slope)
    assert along_cubics(t, values, np.array([0.05]))[0, 0] == pytest.approx(middle, abs=1e-12)
    between = along_cubics(t[:2], values[:2], np.array([0.0, 0.025, 0.1]))
    np.testing.assert_allclose(between[:, 0], [0.0, 0.075, 0.3], atol=1e-12)


def test_cubics_of_a_smooth_way_converge():
    errors = []
    for n in (20, 40, 80):
        t = np.linspace(0, 1, n) ** 1.2
        at = np.linspace(0.1, 0.9, 1001)
        found = along_cubics(t, np.exp(t)[:, None], at)[:, 0]
        errors.append(np.abs(found - np.exp(at)).max())
    assert errors[0] / errors[1] > 6
    assert errors[1] / errors[2] > 6  # order 3, while it is monotone


def test_screws_between_poses_are_those_between_poses(rng):
    poses = dq.continuous(random_poses(rng, 3))
    t = np.array([0.0, 0.7, 1.0])
    twist = 2 * dq.log(dq.mul(poses[1], dq.conj(poses[0]))) / 0.7
    at = np.array([0.0, 0.2, 0.55, 0.7])
    expected = dq.mul(dq.exp(0.5 * at[:, None] * twist), poses[0])
    found = along_screws(t, poses, at)
    np.testing.assert_allclose(dq.matrix_from_pose(found), dq.matrix_from_pose(expected), atol=1e-9)


HEAD = "t_s,q1_rad,q2_rad,q3_rad,q4_rad,q5_rad,q6_rad,q7_rad\n"
ROW = ",0,0.4,0,-1.5,0,-0.4,1.5\n"


@pytest.mark.parametrize(("text", "words"), [
    ("", ["run.csv is empty"]),
    ("# nothing\n", ["run.csv is empty"]),
    (HEAD, ["no rows"]),
    ("0,0.1,0.2\n0,1,2\n", ["no column 't_s'"]),
    ("t_s,a\n0,1\n", ["neither joints", "q1_deg", "x_m"]),
    (HEAD + "0" + ROW + "0.1,0,0,0,x,0,0,0\n", ["row 3", "column q4_rad", "'x'"]),
    (HEAD + "# c\n0" + ROW + "nan" + ROW, ["row 4", "column t_s", "'nan'"]),
    (HEAD + "0" + ROW + "0.1,1\n", ["row 3", "2 values, but 8 columns"]),
    (HEAD + "0" + ROW + "0.1" + ROW + "0.1" + ROW, ["row 4", "column t_s", "does not come after"]),
    (HEAD + "0" + ROW + "1e-9" + ROW, ["row 3", "column t_s", "less than a microsecond after 0 s"]),
    (HEAD + "0" + ROW + "1e300" + ROW, ["row 3", "column t_s", "1e+300 is more than any arm does"]),
    (HEAD + "0" + ROW.replace("0", "1e300", 1), ["row 2", "is more than any arm does"]),
    (HEAD.replace("q3_rad", "q3_deg") + "0" + ROW, ["rad and in deg"]),
    (HEAD.replace("q3_rad", "q9_rad") + "0" + ROW, ["no column 'q3_rad'"]),
    (HEAD.replace("q3_rad", "q2_rad") + "0" + ROW, ["row 1", "'q2_rad' is there twice"]),
    (HEAD.replace(",q7_rad", "") + "0,0,0,0,0,0,0\n", ["6 joints", "arm has 7"]),
    ("t_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,1,0,0,1,1,0,0\n", ["row 2", "column qw", "length 1.41421"]),
    ("t_s,x_m,y_m,z_m,qw,qx,qy\n0,1,0,0,1,1,0\n", ["no column 'qz'"]),
])  # fmt: skip
def test_slips(tmp_path, text, words):
    path = tmp_path / "run.csv"
    path.write_text(text)
    with pytest.raises(DqpaintError) as caught:
        read_recording(str(path), tuple("1234567"))
    assert "run.csv" in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def test_other_slips(drawing, tmp_path):
    with pytest.raises(UsageError, match="cannot be read"):
        read_recording(str(tmp_path / "none.csv"), tuple("1234567"))
    (tmp_path / "bytes.csv").write_bytes(b"\xff\xfe\x00t")
    with pytest.raises(DqpaintError, match="UTF-8"):
        read_recording(str(tmp_path / "bytes.csv"), tuple("1234567"))
    late = tmp_path / "late.csv"
    late.write_text(HEAD + "1700000000" + ROW + "1700000001" + ROW)
    with pytest.raises(DqpaintError, match="t_s "):
        dqpaint.draw(drawing, recorded=late)
    for choice, option in (
        ({"controller": "p"}, "--controller"), ({"gains": {"k": 3}}, "--gain"),
        ({"plant": "ideal"}, "--plant"), ({"start": "home"}, "--from"),
        ({"disturb": {"twist": {"x": 0.1}}}, "--disturb"), ({"null": "none"}, "--null"),
        ({"on_limit": "stop"}, "--on-limit"), ({"resolver": "none"}, "--resolver"),
        ({"task": "point"}, "--task"),
    ):  # fmt: skip
        with pytest.raises(UsageError, match=f"leave out {option}"):
            dqpaint.draw(drawing, recorded=late, **choice)
