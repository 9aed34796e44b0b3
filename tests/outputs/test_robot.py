"""Files for real arms, read back: each leads along the path that was executed, and is refused
where the arm could not follow."""

import csv
import io
import re

import numpy as np
import pytest
import yaml

import dqpaint
from dqpaint import dq
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.outputs.formats.ros2 import ros2
from dqpaint.outputs.formats.urscript import is_universal, urscript
from dqpaint.outputs.registry import choose_export_writer, make_files
from dqpaint.outputs.robot import Trajectory
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from tests.support.installed import BASE, JOINTS

TEXT = (
    "period 10 ms\nspeed 80 mm/s\nprofile quintic\nstart at (-40, 0) mm\n"
    "line to (40, 0) mm light red\nmove to (40, 20) mm\n"
    "line to (0, 20) mm light blue to green\nhold 0.2 s light white 50%\n"
)
SIZE = {"size": (64, 36), "plant": "ideal"}


def drawn(tmp_path_factory, text=TEXT, **choices):
    path = tmp_path_factory.mktemp("exports") / "hook.traj"
    path.write_text(text)
    return dqpaint.draw(path, **{**SIZE, **choices})


@pytest.fixture(scope="module")
def painting(tmp_path_factory):
    return drawn(tmp_path_factory)


def files_of(painting, form):
    return make_files([choose_export_writer(form)], painting)


def texts(painting, form):
    return {end: data.decode() for end, data in files_of(painting, form).items()}


def rows_of(text):
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    return list(csv.DictReader(io.StringIO("\n".join(lines))))


def places(painting, postures, robot="iiwa"):
    return dq.translation(Kinematics(read_card(robot)).poses(np.asarray(postures)))


def test_the_csv_is_what_was_executed(painting):
    rows = rows_of(texts(painting, "csv")["-trajectory.csv"])
    t = [float(row["t_s"]) for row in rows]
    q = np.array([[float(row[f"q{i}_rad"]) for i in range(1, 8)] for row in rows])
    np.testing.assert_allclose(t, painting.motion.t, atol=1e-12)
    np.testing.assert_allclose(q, painting.track.posture, atol=1e-11)
    np.testing.assert_allclose(places(painting, q), painting.track.points, atol=1e-9)


def test_the_csv_can_be_painted_again(painting, tmp_path):
    path = tmp_path / "run.csv"
    path.write_text(texts(painting, "csv")["-trajectory.csv"])
    (tmp_path / "hook.traj").write_text(TEXT)
    again = dqpaint.draw(tmp_path / "hook.traj", recorded=path, size=(64, 36))
    np.testing.assert_allclose(again.track.pose, painting.track.pose, atol=1e-9)


def test_the_ros_message_integrates_to_the_path(painting):
    message = yaml.safe_load(texts(painting, "ros2")["-trajectory.yaml"])
    assert list(message) == ["header", "joint_names", "points"]
    assert message["header"] == {
        "stamp": {"sec": 0, "nanosec": 0},
        "frame_id": BASE,
    }
    assert message["joint_names"] == list(JOINTS)
    points = message["points"]
    t = np.array([p["time_from_start"]["sec"] + p["time_from_start"]["nanosec"] * 1e-9
                  for p in points])  # fmt: skip
    q = np.array([p["positions"] for p in points])
    v = np.array([p["velocities"] for p in points])
    np.testing.assert_allclose(t, painting.motion.t, atol=1e-9)
    assert (np.diff(t) > 0).all()
    assert all(0 <= p["time_from_start"]["nanosec"] < 10**9 for p in points)
    assert not v[0].any()
    assert not v[-1].any()
    way = q[0] + np.cumsum(0.5 * (v[1:] + v[:-1]) * np.diff(t)[:, None], axis=0)
    assert np.abs(np.diff(q, axis=0)).max() > 1e-3
    np.testing.assert_allclose(way, q[1:], atol=5e-5)
    np.testing.assert_allclose(places(painting, way), painting.track.points[1:], atol=5e-5)


def test_times_beyond_a_second_and_roundings():

    t = np.array([0.0, 0.9999999999, 1.7, 12.3])
    q = np.array([[1e-12, -1e-9], [1.5, 2], [3, 4], [5, 6]])
    made = ros2(Trajectory("n", "r", ("a", "b"), "base", 0.1, t, q, 0 * q, ()))
    points = yaml.safe_load(made)["points"]
    stamps = [tuple(p["time_from_start"].values()) for p in points]
    assert stamps == [(0, 0), (1, 0), (1, 700_000_000), (12, 300_000_000)]
    assert all(isinstance(x, float) for p in points for x in p["positions"])


HEADER = {"stamp": {"sec": "int32", "nanosec": "uint32"}, "frame_id": "string"}
POINT = {
    "positions": "float64[]", "velocities": "float64[]", "accelerations": "float64[]",
    "effort": "float64[]", "time_from_start": {"sec": "int32", "nanosec": "uint32"},
}  # fmt: skip
MESSAGE = {"header": HEADER, "joint_names": "string[]", "points": [POINT]}
BOUNDS = {"int32": (-(2**31), 2**31 - 1), "uint32": (0, 2**32 - 1)}


def fill(definition, given, where="message"):
    """A message as `ros2 topic pub` fills it from YAML: known fields of their types, else zero."""
    if isinstance(definition, dict):
        assert isinstance(given, dict), where
        assert set(given) <= set(definition), f"{where}: {set(given) - set(definition)}"
        return {
            name: fill(kind, given[name], f"{where}.{name}") if name in given else None
            for name, kind in definition.items()
        }
    if isinstance(definition, list):
        assert isinstance(given, list), where
        return [fill(definition[0], one, f"{where}[{i}]") for i, one in enumerate(given)]
    if definition.endswith("[]"):
        assert isinstance(given, list), where
        return [fill(definition[:-2], one, where) for one in given]
    if definition in BOUNDS:
        assert type(given) is int, where
        assert BOUNDS[definition][0] <= given <= BOUNDS[definition][1], where
    else:
        assert type(given) is {"string": str, "float64": float}[definition], where
    return given


def test_the_ros_message_has_the_fields_of_its_type(painting):
    """Those of trajectory_msgs/JointTrajectory, JointTrajectoryPoint, Header, Time, Duration."""
    text = texts(painting, "ros2")["-trajectory.yaml"]
    message = fill(MESSAGE, yaml.safe_load(text))
    joints = len(message["joint_names"])
    for point in message["points"]:
        assert len(point["positions"]) == len(point["velocities"]) == joints
        assert point["accelerations"] is point["effort"] is None  # may be left out, as all or none
    assert not any(isinstance(value, int) for p in message["points"] for value in p["positions"])
    with pytest.raises(AssertionError, match="names"):
        fill(MESSAGE, yaml.safe_load(text.replace("joint_names", "names")))
    with pytest.raises(AssertionError, match=r"stamp\.sec"):
        fill(MESSAGE, yaml.safe_load(text.replace("{sec: 0,", "{sec: 0.5,")))


class Universal:
    """What a Universal Robots arm makes of a script, told in Python by its manual's own words.

    movej turns every joint on one trapezoid: the leading one at `a` and `v`, the others as long.
    servoj takes the posture to be in `t`; its lookahead and gain smooth what comes of it.
    """

    NAMES = ("movej", "servoj", "stopj", "textmsg")

    def __init__(self, posture):
        self.t, self.posture, self.log, self.said = 0.0, np.array(posture), [], []

    def movej(self, q, a=1.4, v=1.05, t=0, r=0):
        way = float(np.abs(np.array(q) - self.posture).max())
        self.t += t or (way / v + v / a if way > v * v / a else 2 * np.sqrt(way / a))
        self.posture = np.array(q, float)
        assert len(q) == 6
        assert a > 0 < v

    def servoj(self, q, a, v, t=0.008, lookahead_time=0.1, gain=300):
        assert len(q) == 6
        assert t >= 0.002
        assert 0.03 <= lookahead_time <= 0.2
        assert 100 <= gain <= 2000
        if not self.log:
            self.log.append((self.t, self.posture))
        self.t += t
        self.posture = np.array(q, float)
        self.log.append((self.t, self.posture))

    def stopj(self, a):
        assert a > 0

    def textmsg(self, text, more=""):
        self.said.append((self.t, text))

    def run(self, script):
        """Its blocks end with `end`, Python's with their indentation; else they are alike."""
        body = [line for line in script.splitlines() if line.strip() != "end"]
        assert len([1 for line in script.splitlines() if line.strip() == "end"]) == len(
            [1 for line in body if line.startswith("def ")]
        )
        names = {name: getattr(self, name) for name in self.NAMES}
        exec(compile("\n".join(body), "script", "exec"), {"__builtins__": {}, **names})
        return self


def obeyed(script, posture):
    arm = Universal(posture).run(script)
    (zero, _), *_ = [one for one in arm.said if "t = 0" in one[1]]
    t, postures = zip(*arm.log, strict=True)
    return np.array(t) - zero, np.array(postures)


def universal_trajectory():
    """A trajectory of an arm whose joints are named as theirs, without its package."""
    t = 0.01 * np.arange(120)
    swing = np.outer(np.sin(2 * t) ** 2, [0.3, -1e-9, 0.5, -0.4, 0.2, 1e-3])
    q = swing + np.array([0, -1, 1, 2, 3, -4])
    joints = tuple(f"{name}_joint" for name in (
        "shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3",
    ))  # fmt: skip
    return Trajectory("a b-1", "ur", joints, "base", 0.01, t, q, 0 * q, ("one", "two"))


def test_the_program_obeyed_leads_along_the_path_on_its_clock():
    trajectory = universal_trajectory()
    script = urscript(trajectory)
    t, postures = obeyed(script, trajectory.positions[0] - 0.7)
    np.testing.assert_allclose(t, trajectory.t, atol=1e-9)
    np.testing.assert_allclose(postures, trajectory.positions, atol=1e-8)
    assert script.startswith("# one\n# two\n")
    assert "def dqpaint_a_b_1():" in script
    late = script.replace("0, 0, 0.01,", "0, 0, 0.02,", 1)
    assert obeyed(late, trajectory.positions[0])[0][-1] == pytest.approx(trajectory.t[-1] + 0.01)


def read_script(text):
    """A tiny reader: the postures, the time of each servoj, and that blocks are closed."""
    body = [line.split("#")[0].strip() for line in text.splitlines()]
    body = [line for line in body if line]
    name = re.fullmatch(r"def (\w+)\(\):", body[0])[1]
    assert body[-2:] == ["end", f"{name}()"]
    number = r"[-\d.eE+]+"
    first = re.fullmatch(rf"movej\(\[([^\]]+)\], a=({number}), v=({number})\)", body[1])
    assert body[2] == 'textmsg("dqpaint: t = 0")'
    assert body[-3] == "stopj(1.0)"
    postures, times = [[float(x) for x in first[1].split(",")]], [0.0]
    for line in body[3:-3]:
        step = re.fullmatch(
            rf"servoj\(\[([^\]]+)\], 0, 0, ({number}), ({number}), ({number})\)", line
        )
        postures.append([float(x) for x in step[1].split(",")])
        times.append(times[-1] + float(step[2]))
        assert 0.03 <= float(step[3]) <= 0.2
        assert 100 <= float(step[4]) <= 2000
    return np.array(postures), np.array(times)


@pytest.fixture(scope="module")
def by_a_universal_robot(tmp_path_factory):
    """An arm whose joints are named as those of Universal Robots, without their package."""
    pytest.importorskip("dqpaint")
    if read_card("ur5").missing:
        pytest.skip("ur5 is not installed")
    return drawn(tmp_path_factory, robot="ur5")


def test_the_program_leads_along_the_path(by_a_universal_robot):
    painting = by_a_universal_robot
    made = texts(painting, "urscript")
    assert set(made) == {".script", "-cues.csv"}
    postures, times = read_script(made[".script"])
    obeyed_times, obeyed_postures = obeyed(made[".script"], painting.track.posture[0] + 0.3)
    np.testing.assert_allclose(obeyed_times, painting.motion.t, atol=1e-9)
    np.testing.assert_allclose(obeyed_postures, postures, atol=1e-12)
    np.testing.assert_allclose(times, painting.motion.t, atol=1e-9)
    np.testing.assert_allclose(postures, painting.track.posture, atol=1e-8)
    reached = places(painting, postures, "ur5")
    np.testing.assert_allclose(reached, painting.track.points, atol=1e-7)


def test_only_for_universal_robots(painting):
    with pytest.raises(UsageError, match="iiwa"):
        files_of(painting, "urscript")
    own = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")
    assert is_universal(tuple(f"left_{name}_joint" for name in own))
    assert not is_universal(own[::-1])
    assert not is_universal(own[:5])


def test_steps_too_short_for_servoj(tmp_path_factory):
    if read_card("ur5").missing:
        pytest.skip("ur5 is not installed")
    short = drawn(tmp_path_factory, TEXT.replace("10 ms", "1 ms"), robot="ur5")
    with pytest.raises(UsageError, match="2 ms"):
        files_of(short, "urscript")


def test_every_file_says_what_it_is(painting):
    for form in ("csv", "ros2"):
        for text in texts(painting, form).values():
            assert text.startswith("# hook.traj (sha256 ")
            assert "iiwa, plant ideal, law hinf" in text
        main = next(iter(texts(painting, form).values()))
        assert "Nothing here looks after people or machines" in main


def test_the_cues_give_back_the_light(painting):
    rows = rows_of(texts(painting, "csv")["-cues.csv"])
    motion = painting.motion
    t = np.array([float(row["t_s"]) for row in rows])
    light = np.array([[float(row[c]) for c in ("red", "green", "blue")] for row in rows])
    held = np.searchsorted(t, motion.t + 1e-9, side="right") - 1
    np.testing.assert_allclose(light[held], motion.light, atol=1e-6)
    assert [int(row["line"]) for row in rows][held[0]] == 5
    gone = [float(row["s_m"]) for row in rows]
    steps = np.linalg.norm(np.diff(motion.points, axis=0), axis=1)
    for second, length in zip(t.tolist(), gone, strict=True):
        assert length == pytest.approx(steps[motion.t[1:] < second + 1e-9].sum(), abs=1e-9)
    assert gone[-1] == pytest.approx(motion.length, abs=1e-4)
    lines = np.array([int(row["line"]) for row in rows])[held]
    np.testing.assert_array_equal(lines, motion.source.line)
    red = [k for k, row in enumerate(rows) if row["line"] == "5"]
    assert len(red) == 1  # a colour that stays is one cue
    assert len(rows) > 40  # a gradient is one a sample
    assert not light[-1].any()
    assert {row["strobe_Hz"] for row in rows} == {"0"}


def test_a_strobe_stands_in_its_columns(painting):
    from dataclasses import replace

    from dqpaint.outputs.robot.light_cues import cue_sheet
    from dqpaint.program.program import Strobe

    program = painting.motion.program
    first = replace(program.segments[0], strobe=Strobe(12.5, 0.25))
    motion = replace(
        painting.motion, program=replace(program, segments=(first, *program.segments[1:]))
    )
    rows = rows_of(cue_sheet(motion, ()))
    assert (rows[0]["strobe_Hz"], rows[0]["strobe_duty"]) == ("12.5", "0.25")
    assert (rows[1]["strobe_Hz"], rows[1]["strobe_duty"]) == ("0", "1")


def refused(painting):
    with pytest.raises(DqpaintError, match="not exported: iiwa") as caught:
        files_of(painting, "csv")
    return str(caught.value)


def test_refused_for_speed(tmp_path_factory):
    fast = drawn(tmp_path_factory, "start at (-120, 0) mm\nline to (120, 0) mm in 0.2 s\n")
    assert {clamp.kind for clamp in fast.limits} == {"speed"}
    said = refused(fast)
    assert "line 2: the speed limit held joint" in said
    assert said.endswith("= help: --on-limit slow gives what is too fast the time it needs")


def test_refused_for_a_sudden_start_and_end(tmp_path_factory):
    text = "period 4 ms\nprofile constant\nspeed 80 mm/s\nstart at (0, 0) mm\nline to (60, 0) mm\n"
    sudden = drawn(tmp_path_factory, text)
    assert not sudden.limits
    said = refused(sudden)
    assert "line 5: a sudden start: joint" in said
    assert "a sudden end" in said
    assert "profile trapezoid" in said
    assert "--on-limit" not in said


def moved(painting, change):
    """The same painting with an arm that went elsewhere."""
    from dataclasses import replace

    posture = painting.track.posture.copy()
    change(posture)
    return replace(painting, track=replace(painting.track, posture=posture))


def test_refused_for_what_the_plant_did_not_mind(painting):
    """No clamp is counted here: the run is looked at for itself."""
    bump = np.sin(np.linspace(0, np.pi, len(painting.motion.t))) ** 4
    card = read_card("iiwa")

    def beyond(q):
        q[:, 6] = card.upper[6] - 0.1 + 0.15 * bump

    assert "joint 7 is 2.86 deg beyond its limit" in refused(moved(painting, beyond))

    def fast(q):
        q[:, 5] += 1.2 * np.sin(np.linspace(0, 6 * np.pi, len(q))) * bump

    assert "joint 6 goes at" in refused(moved(painting, fast))

    def strong(q):
        q[:, 1] += 0.004 * np.sin(np.arange(len(q)) * 2.5) * bump

    said = refused(moved(painting, strong))
    assert "joint 2 needs" in said
    assert "but has 320 Nm" in said


def test_a_run_that_was_slowed_down_can_be_asked_of_an_arm(tmp_path_factory):
    """What is too fast is refused; with its clock slowed it is not, and the light keeps to it."""
    text = "period 8 ms\nprofile quintic\nstart at (-120, 0) mm\n"
    text += (
        "line to (0, 0) mm in 0.1 s light red\nline to (120, 0) mm in 0.1 s light blue\nhold 1 s\n"
    )
    assert "speed" in refused(drawn(tmp_path_factory, text))
    slow = drawn(tmp_path_factory, text, on_limit="slow")
    files = texts(slow, "csv")
    t = [float(row["t_s"]) for row in rows_of(files["-trajectory.csv"])]
    assert t[-1] == pytest.approx(slow.motion.t[-1])
    assert t[-1] > 1.3
    blue = next(row for row in rows_of(files["-cues.csv"]) if row["blue"] == "1")
    q = slow.track.posture[int(np.searchsorted(slow.motion.t, float(blue["t_s"])))]
    at = places(slow, q[None])[0] - dq.translation(read_card("iiwa").canvas.pose)
    assert np.linalg.norm(at) < 1e-3  # half way, where the line turns blue


def test_a_recorded_run_is_not_exported(painting, tmp_path):
    (tmp_path / "hook.traj").write_text(TEXT)
    (tmp_path / "run.csv").write_text(texts(painting, "csv")["-trajectory.csv"])
    again = dqpaint.draw(tmp_path / "hook.traj", recorded=tmp_path / "run.csv", size=(64, 36))
    with pytest.raises(UsageError, match="it comes from an arm"):
        files_of(again, "csv")


def test_what_cannot_be_saved_is_refused_before_the_run(tmp_path, painting):
    (tmp_path / "run.csv").write_text(texts(painting, "csv")["-trajectory.csv"])
    told = []
    for formats, choices, fault in (
        ("png,urscript", {}, "URScript is for the arms of Universal Robots, not for"),
        ("trajectory", {"recorded": tmp_path / "run.csv", "plant": None}, "it comes from an arm"),
        ("nothing-known", {}, "no format named 'nothing-known'"),
    ):
        with pytest.raises(UsageError, match=fault):
            dqpaint.draw("lag", formats=formats, progress=told.append, **{**SIZE, **choices})
    assert not told
    dqpaint.draw("lag", formats="png", progress=told.append, **SIZE)
    assert told
