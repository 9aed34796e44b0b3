"""Files: read back as they were, written whole or not at all."""

import csv as csv_reader
import io
import json
import os
import stat

import cv2
import numpy as np
import pytest

import dqpaint
from dqpaint.core import atomic_files
from dqpaint.core.version import LIBRARIES
from dqpaint.errors import OutputError
from dqpaint.outputs import files as outputs
from dqpaint.robots.model.card import read_card

TEXT = (
    "period 20 ms\nstart at (0, 0) mm\nline to (30, 10) mm\nline by (0, -20) mm light red to blue\n"
)


@pytest.fixture(scope="module")
def painting(tmp_path_factory):
    path = tmp_path_factory.mktemp("drawing") / "corner.traj"
    path.write_text(TEXT)
    return dqpaint.draw(path, plant="ideal", size=(160, 90))


@pytest.mark.parametrize("name", outputs.OUTPUTS)
def test_every_output_is_the_same_twice(painting, name):
    assert outputs.OUTPUTS[name](painting) == outputs.OUTPUTS[name](painting) != b""


def test_png_reads_back(painting):
    image = cv2.imdecode(np.frombuffer(outputs.png(painting), np.uint8), cv2.IMREAD_COLOR)
    np.testing.assert_array_equal(image[..., ::-1], painting.image)
    assert painting._repr_png_() == outputs.png(painting)


@pytest.mark.parametrize("name", ["csv", "motion"])
def test_tables_read_back(painting, name):
    rows = list(csv_reader.reader(io.StringIO(outputs.OUTPUTS[name](painting).decode())))
    assert len(rows) == 1 + len(painting.motion.t)
    values = np.array(rows[1:], dtype=float)
    assert np.isfinite(values).all()
    column = dict(zip(rows[0], values.T, strict=True))
    np.testing.assert_allclose(column["t_s"], painting.motion.t, rtol=1e-11)
    np.testing.assert_allclose(column["desired_y_m"], painting.motion.points[:, 1], atol=1e-12)
    assert rows[1][1] == "3"  # whole numbers are written as such


def test_summary_says_what_was_run_and_what_came_out(painting):
    facts = json.loads(outputs.summary(painting))
    assert facts["schema"] == outputs.SCHEMA
    assert facts["file"] == "corner.traj"
    assert facts["controller"] == "hinf"
    assert facts["gains"]["K_O"] == pytest.approx(40)
    assert facts["settings"]["width"] == 160
    assert set(facts["versions"]) == {"dqpaint", "python", *LIBRARIES}
    for figure in ("error_integral", "command_integral_rad", "effort_integral", "speed_integral_m",
                   "acceleration_integral", "position_error_rms_m", "position_error_std_m",
                   "position_error_max_m", "orientation_error_rms_rad"):  # fmt: skip
        assert facts[figure] >= 0
    light = facts["light"]
    total = np.add(light["on_film"], light["lost"])
    np.testing.assert_allclose(total, light["emitted"], rtol=1e-9)
    np.testing.assert_allclose(light["emitted"], painting.motion.light.sum(0) * 0.02, rtol=1e-12)
    assert set(facts["wall_s"]) == {
        "language",
        "place",
        "motion",
        "start",
        "arm",
        "metrics",
        "light",
    }


def test_files_are_written_beside_each_other_and_nothing_else_is_left(tmp_path):
    written = outputs.write(tmp_path / "a", {".png": b"1", ".csv": b"2"})
    assert [path.name for path in written] == ["a.png", "a.csv"]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "a.png"]
    assert stat.S_IMODE(written[0].stat().st_mode) == 0o666 & ~atomic_files._umask()


def test_nothing_is_half_written(tmp_path, monkeypatch):
    (tmp_path / "a.png").write_bytes(b"before")
    (tmp_path / "a.csv").mkdir()
    with pytest.raises(OutputError, match="it is a folder"):
        outputs.write(tmp_path / "a", {".png": b"after", ".csv": b"2"})
    assert (tmp_path / "a.png").read_bytes() == b"before"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "a.png"]

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(OutputError, match="No space left on device"):
        outputs.write(tmp_path / "b", {".png": b"after"})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "a.png"]


def test_places_for_files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert outputs.stem_for(None, "star-p").resolve() == tmp_path / "star-p"
    assert outputs.stem_for(str(tmp_path), "star-p") == tmp_path / "star-p"
    assert outputs.stem_for("new/folder/", "star-p").resolve() == tmp_path / "new/folder/star-p"
    assert outputs.stem_for("mine", "star-p").resolve() == tmp_path / "mine"
    assert outputs.stem_for("new/mine", "star-p").resolve() == tmp_path / "new/mine"
    with pytest.raises(OutputError, match="folder 'no/such' does not exist"):
        outputs.stem_for("no/such/stem", "star-p")
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot be written"):
        outputs.stem_for("file/", "star-p")


def test_limits_are_written_in_si_with_their_unit(tmp_path):
    (tmp_path / "fast.traj").write_text("line to (200, 0) mm speed 3 m/s\nhold 1 s\n")
    fast = dqpaint.draw(tmp_path / "fast.traj", plant="ideal", size=(64, 36))
    limit = next(limit for limit in outputs.summarise(fast)["limits"] if limit["kind"] == "speed")
    assert limit["unit"] == "rad/s"
    speeds = read_card("iiwa").speed
    assert limit["wanted"] > limit["limit"] == pytest.approx(speeds[limit["joint"] - 1])
    assert len(fast.limits) == len(outputs.summarise(fast)["limits"])


def test_saving_from_python(painting, tmp_path):
    written = dqpaint.save(painting, f"{tmp_path}/made/", "png,json")
    assert [path.name for path in written] == ["corner-hinf.png", "corner-hinf.json"]
    assert repr(painting).startswith("<Painting of ")
    assert len(repr(painting)) < 200
    with pytest.raises(dqpaint.DqpaintError, match="size '3x3' is not"):
        dqpaint.draw("star", size="3x3")


@pytest.fixture(scope="module")
def stepped(tmp_path_factory):
    """A run that is disturbed, and has a jump in both place and orientation."""
    path = tmp_path_factory.mktemp("drawing") / "jump.traj"
    path.write_text(
        "period 8 ms\nstart at (10, 5, 0) mm tool rpy(10 deg, 0, 0)\nhold 0.2 s light off\n"
        "step to (30, 20, -10) mm tool rpy(0, 10 deg, 20 deg)\nhold 1 s\n"
    )
    return dqpaint.draw(
        path, plant="ideal", size=(64, 36), seed=11,
        disturb={"twist": {"form": "noise", "x": 0.02, "wy": 0.1, "frequency": 3.0}},
    )  # fmt: skip


def test_the_summary_tells_the_disturbances_what_came_through_and_the_steps(stepped):
    said = outputs.summarise(stepped)
    one = stepped.disturbances["twist"]
    assert said["disturbances"] == {"twist": one.model_dump()}
    assert said["seed"] == 11
    assert said["law"]["commands"] == stepped.controller.commands
    for part in ("rotation", "translation"):
        found = stepped.attenuation[part]
        assert said["attenuation"][part] == {
            "ratio_s": found.ratio, "bound_s": found.bound, "kept": found.kept
        }  # fmt: skip
        assert found.ratio != found.bound
    (jump,), (told,) = stepped.set_points, said["set_points"]
    assert (told["time_s"], told["line"]) == (jump.time, 4)
    assert jump.time == pytest.approx(0.208)
    for part, unit in (("translation", "m"), ("rotation", "rad")):
        response = getattr(jump, part)
        assert told[part] == {
            f"size_{unit}": response.size, "settling_s": response.settling,
            "overshoot": response.overshoot, f"steady_error_{unit}": response.steady,
        }  # fmt: skip
        assert len(set(told[part].values())) == 4
