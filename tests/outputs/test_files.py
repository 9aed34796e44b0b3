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
from dqpaint.core.libraries import LIBRARIES
from dqpaint.errors import OutputError, UnknownNameError, UsageError
from dqpaint.outputs import WRITERS, files, registry, summary
from dqpaint.outputs.registry import Need, Writer, writer
from dqpaint.robots.model.card import read_card
from tests.support.plugins import install

TEXT = (
    "period 20 ms\nstart at (0, 0) mm\nline to (30, 10) mm\nline by (0, -20) mm light red to blue\n"
)


@pytest.fixture(scope="module")
def painting(tmp_path_factory):
    path = tmp_path_factory.mktemp("drawing") / "corner.traj"
    path.write_text(TEXT)
    return dqpaint.draw(path, plant="ideal", size=(160, 90))


def made(painting, name):
    return registry.make_files(registry.choose_writers(name), painting)


@pytest.mark.parametrize("name", ["csv", "film", "hdr", "jpeg", "json", "motion", "png"])
def test_every_format_is_the_same_twice(painting, name):
    files = made(painting, name)
    assert files == made(painting, name)
    assert all(files.values())
    assert WRITERS[name].ending in files


def test_png_reads_back(painting):
    png = made(painting, "png")[".png"]
    image = cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR)
    np.testing.assert_array_equal(image[..., ::-1], painting.image)
    assert painting._repr_png_() == png


def test_jpeg_reads_back_nearly(painting):
    image = cv2.imdecode(np.frombuffer(made(painting, "jpeg")[".jpg"], np.uint8), cv2.IMREAD_COLOR)
    off = np.abs(image[..., ::-1].astype(int) - painting.image)
    assert off.mean() < 1
    assert off.max() < 40


@pytest.fixture
def own():
    """Room for writers of a test: the registry as it was after the start, and later as before."""
    before = dict(vars(WRITERS))
    vars(WRITERS).update(_things=dict(WRITERS), _origins={})
    for found in ("_plugins", "_faults"):
        vars(WRITERS).pop(found, None)
    yield
    vars(WRITERS).clear()
    vars(WRITERS).update(before)


def test_progress_is_told_to_a_writer_that_wants_it(painting, own):
    @writer("slow", "-slow.txt")
    def slow(painting, progress):
        progress(0.5)
        return b"done"

    @writer("quick", "-quick.txt")
    def quick(painting):
        """Quick."""
        return {"-a.txt": b"a", "-b.txt": painting.sha256.encode()}

    told = []
    files = registry.make_files(registry.choose_writers("slow, quick"), painting, told.append)
    assert told == [0.5]
    assert files == {"-slow.txt": b"done", "-a.txt": b"a", "-b.txt": painting.sha256.encode()}
    assert WRITERS["quick"] == Writer("quick", "-quick.txt", quick)
    assert WRITERS["quick"].about == "Quick."


def test_what_a_writer_needs_is_asked_before_any_writes(painting, own):
    def none(_painting):
        raise UsageError("no tulips in it")

    written = []
    writer("first", ".a")(lambda painting: written.append(1) or b"a")
    writer("tulip", ".b", Need("tulips", none))(lambda painting: written.append(2) or b"b")
    with pytest.raises(UsageError, match="no tulips"):
        registry.make_files(registry.choose_writers("first,tulip"), painting)
    assert not written
    registry.make_files(registry.choose_writers("first"), painting)
    assert written == [1]


PLUGIN = """
from dqpaint.outputs import writer

@writer("tulip", "-tulip.txt")
def tulip(painting):
    "Flowers."
    return painting.robot.encode()

bare = len
"""


def test_another_package_brings_a_format(painting, own, tmp_path, monkeypatch):
    points = "[dqpaint.formats]\ntulip = bulbs:tulip\nrose = bulbs:bare\npng = bulbs:tulip\n"
    install(tmp_path, "bulbs", {"__init__": PLUGIN}, points)
    monkeypatch.syspath_prepend(tmp_path)
    assert made(painting, "tulip,png") == {"-tulip.txt": b"iiwa", ".png": painting.picture.png}
    assert WRITERS.origin("tulip") == "bulbs 1.2"
    hidden, bare = WRITERS.faults
    assert hidden == "format 'png' of bulbs 1.2 is not used: dqpaint has its own"
    assert "'rose' is not registered by @dqpaint.outputs.writer under that name" in bare


def test_formats_for_arms_are_those_of_export():
    assert {one.export_name: one.name for one in WRITERS.values() if one.export_name} == {
        "csv": "trajectory", "krl": "krl", "rapid": "rapid", "ros2": "ros2", "urscript": "urscript"
    }  # fmt: skip
    assert registry.choose_export_writer("csv") is WRITERS["trajectory"]
    for unknown in ("gcode", "png", "trajectory"):
        with pytest.raises(
            UnknownNameError, match=f"named '{unknown}'; known: csv, krl, rapid, ros2"
        ):
            registry.choose_export_writer(unknown)


@pytest.mark.parametrize("name", ["csv", "motion"])
def test_tables_read_back(painting, name):
    rows = list(csv_reader.reader(io.StringIO(made(painting, name)[WRITERS[name].ending].decode())))
    assert len(rows) == 1 + len(painting.motion.t)
    values = np.array(rows[1:], dtype=float)
    assert np.isfinite(values).all()
    column = dict(zip(rows[0], values.T, strict=True))
    np.testing.assert_allclose(column["t_s"], painting.motion.t, rtol=1e-11)
    np.testing.assert_allclose(column["desired_y_m"], painting.motion.points[:, 1], atol=1e-12)
    assert rows[1][1] == "3"  # whole numbers are written as such


def test_summary_says_what_was_run_and_what_came_out(painting):
    facts = json.loads(made(painting, "json")[".json"])
    assert facts["schema"] == summary.RUN_SCHEMA
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
        "photos",
        "motion",
        "start",
        "arm",
        "metrics",
        "effects",
        "light",
    }


def test_files_are_written_beside_each_other_and_nothing_else_is_left(tmp_path):
    written = files.write(tmp_path / "a", {".png": b"1", ".csv": b"2"})
    assert [path.name for path in written] == ["a.png", "a.csv"]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "a.png"]
    assert stat.S_IMODE(written[0].stat().st_mode) == 0o666 & ~atomic_files._umask()


def test_nothing_is_half_written(tmp_path, monkeypatch):
    (tmp_path / "a.png").write_bytes(b"before")
    (tmp_path / "a.csv").mkdir()
    with pytest.raises(OutputError, match="it is a folder"):
        files.write(tmp_path / "a", {".png": b"after", ".csv": b"2"})
    assert (tmp_path / "a.png").read_bytes() == b"before"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "a.png"]

    def full(*_):
        raise OSError(28, "No space left")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(OutputError, match="No space left"):
        files.write(tmp_path / "b", {".png": b"after"})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "a.png"]


def test_places_for_files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert files.stem_for(None, "star-p").resolve() == tmp_path / "star-p"
    assert files.stem_for(str(tmp_path), "star-p") == tmp_path / "star-p"
    assert files.stem_for("new/folder/", "star-p").resolve() == tmp_path / "new/folder/star-p"
    assert files.stem_for("mine", "star-p").resolve() == tmp_path / "mine"
    assert files.stem_for("new/mine", "star-p").resolve() == tmp_path / "new/mine"
    for end in ("png", "csv", "json", "webm", "webp", "hdr", "script"):
        assert files.stem_for(f"new/mine.{end}", "star-p").resolve() == tmp_path / "new/mine"
    assert files.stem_for("new/mine.2", "star-p").resolve() == tmp_path / "new/mine.2"
    with pytest.raises(OutputError, match="'no/such'"):
        files.stem_for("no/such/stem", "star-p")
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot be written"):
        files.stem_for("file/", "star-p")


def test_limits_are_written_in_si_with_their_unit(tmp_path):
    (tmp_path / "fast.traj").write_text("line to (200, 0) mm speed 3 m/s\nhold 1 s\n")
    fast = dqpaint.draw(tmp_path / "fast.traj", plant="ideal", size=(64, 36))
    limit = next(limit for limit in summary.summarise(fast)["limits"] if limit["kind"] == "speed")
    assert limit["unit"] == "rad/s"
    speeds = read_card("iiwa").speed
    assert limit["wanted"] > limit["limit"] == pytest.approx(speeds[limit["joint"] - 1])
    assert len(fast.limits) == len(summary.summarise(fast)["limits"])


def test_saving_from_python(painting, tmp_path):
    written = dqpaint.save(painting, f"{tmp_path}/made/", "png,json")
    assert [path.name for path in written] == ["corner-hinf.png", "corner-hinf.json"]
    assert repr(painting).startswith("<Painting of ")
    assert len(repr(painting)) < 200
    with pytest.raises(dqpaint.DqpaintError, match="width 3 should be greater"):
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
    said = summary.summarise(stepped)
    one = stepped.disturbances["twist"]
    assert said["disturbances"] == {"twist": one.model_dump()}
    assert said["seed"] == 11
    assert said["law"]["commands"] == stepped.controller.commands
    for part in ("rotation", "translation"):
        found = stepped.attenuation[part]
        assert said["attenuation"][part] == {
            "ratio_s": found.ratio, "bound_s": found.bound, "kept": found.bound_holds,
            "bound_in_steps_s": found.in_steps,
            "of_gammas": found.of_gammas,
        }  # fmt: skip
        assert found.ratio != found.bound
    (jump,), (told,) = stepped.step_responses, said["set_points"]
    assert (told["time_s"], told["line"]) == (jump.time, 4)
    assert jump.time == pytest.approx(0.208)
    for part, unit in (("translation", "m"), ("rotation", "rad")):
        response = getattr(jump, part)
        assert told[part] == {
            f"size_{unit}": response.size, "settling_s": response.settling,
            "overshoot": response.overshoot, f"steady_error_{unit}": response.steady,
        }  # fmt: skip
        assert len(set(told[part].values())) == 4
