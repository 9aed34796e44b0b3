"""The command line as a person meets it, mostly in a process of its own."""

import hashlib
import json
import os
import re
import signal
import subprocess
import sys
import time

import pytest

import dqpaint as package
from dqpaint import __main__ as entry
from dqpaint.cli.listing import LISTS
from dqpaint.controllers import CONTROLLERS
from dqpaint.settings.model import Settings
from tests.support.arm_files import arm_urdf
from tests.support.commands import WRONG
from tests.support.folders import files

pytestmark = pytest.mark.slow


def test_draw_leaves_three_files_and_a_table(dqpaint, line, tmp_path):
    done = dqpaint("draw", line, "--size", "160x90")
    assert (done.returncode, done.stderr) == (0, "")
    assert files(tmp_path) == ["line-hinf.csv", "line-hinf.json", "line-hinf.png", "line.traj"]
    assert "rms 0 mm" not in done.stdout
    for word in (
        "line.traj: 32 mm",
        "iiwa, stiff",
        "K_T = 20",
        "rms",
        "none reached",
        "line-hinf.png",
    ):
        assert word in done.stdout


CHOSEN = {
    "controller": "p", "gains": {"k": 5}, "robot": "iiwa", "plant": "ideal", "start": "home",
    "disturb": {"twist": {"": "noise", "x": 0.01, "wz": -0.1, "frequency": 2}}, "seed": 7,
    "null": "limits,gain=3", "on_limit": "slow",
    "width": 320, "height": 200, "view": "20,30", "ev": 1.5, "ghost": True,
    "occlusion": False,
}  # fmt: skip


def test_options_are_all_heard(dqpaint, line, tmp_path):
    done = dqpaint(
        "draw", line, "--controller", "p", "--gain", "k=5", "--seed", "7",
        "--disturb", "twist=noise,x=0.01,wz=-0.1,frequency=2", "--plant", "ideal", "--from", "home",
        "--size", "320x200", "--view", "20,30", "--ev", "1.5", "--out", "made/", "--robot", "iiwa",
        "--save", "json,motion", "--null", "limits,gain=3", "--on-limit", "slow",
        "--ghost", "--no-occlusion", "--tool", "0,0,9cm",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert files(tmp_path / "made") == ["line-p-motion.csv", "line-p.json"]
    facts = json.loads((tmp_path / "made/line-p.json").read_text())
    assert facts["gains"] == {"k": 5, "point": "tool"}
    assert {name: facts["settings"][name] for name in CHOSEN} == CHOSEN
    assert set(facts["settings"]) == set(Settings.model_fields)


def test_the_summary_of_a_run_draws_it_again_and_what_is_typed_wins(dqpaint, line, tmp_path):
    options = ("--controller", "p", "--gain", "k=5", "--size", "160x90", "--view", "iso", "--ghost",
               "--plant", "ideal", "--overlay", "--from", "home")  # fmt: skip
    assert dqpaint("draw", line, *options).returncode == 0
    again = dqpaint("draw", line, "--settings", "line-p.json", "--out", "again/")
    assert (again.returncode, again.stderr) == (0, "")
    for end in (".png", ".csv"):
        first, second = (tmp_path / f"{place}line-p{end}" for place in ("", "again/"))
        assert first.read_bytes() == second.read_bytes()
    other = dqpaint("draw", line, "--settings", "line-p.json", "--controller", "hinf", "--no-ghost",
                    "--view", "front", "--size", "160x90", "--out", "other/")  # fmt: skip
    assert other.returncode == 0, other.stderr
    settings = json.loads((tmp_path / "other/line-hinf.json").read_text())["settings"]
    changed = ("controller", "view", "ghost", "gains", "plant", "overlay", "width", "start")
    assert [settings[name] for name in changed] == [
        "hinf", "front", False, {}, "ideal", True, 160, "home",
    ]  # fmt: skip
    (tmp_path / "a.toml").write_text("\nveiw = 3\n")
    wrong = dqpaint("preview", line, "--settings", "a.toml")
    assert (wrong.returncode, wrong.stdout) == (1, "")
    assert wrong.stderr == "error: a.toml:2: no setting named 'veiw'; did you mean 'view'?\n"


def test_gains_that_change_are_written_as_they_were_given(dqpaint, line, tmp_path):
    done = dqpaint("draw", line, "--size", "64x36", "--gain", "gamma_T=0.2..0.1@50%")
    assert "gamma_T = 0.2..0.1@50%" in done.stdout, done.stderr
    assert (
        json.loads((tmp_path / "line-hinf.json").read_text())["gains"]["K_T"]
        == "7.07107..14.1421@50%"
    )


def test_a_law_of_one_s_own(dqpaint, line, tmp_path):
    mine = (
        "from dqpaint.controllers import commands\n\n"
        "@commands('torque')\ndef still(seen, d=5.0):\n    return seen.bias - d * seen.rates\n\n"
        "def still_too(seen):\n    return 0 * seen.twist_d\n\ndef wrong(seen):\n    return k\n"
    )
    (tmp_path / "mine.py").write_text(mine)
    chosen = ("draw", line, "--size", "64x36", "--controller")
    done = dqpaint(*chosen, "mine.py:still", "--gain", "d=7")
    assert done.returncode == 0, done.stderr
    assert "iiwa, torque" in done.stdout
    facts = json.loads((tmp_path / "line-still.json").read_text())
    assert facts["law"]["commands"] == "torque"
    assert facts["law"]["source"] == "mine.py"
    assert facts["law"]["sha256"] == hashlib.sha256(mine.encode()).hexdigest()
    assert facts["torque_integral_Nm_s"] > 1
    head = (tmp_path / "line-still.csv").read_text().splitlines()[0]
    assert ",torque1_Nm,torque2_Nm,torque3_Nm," in head
    left = files(tmp_path)
    for words, code, says in (
        (
            ("mine.py",),
            2,
            "usage: mine.py has 3 laws",
        ),
        (
            ("mine.py:wrong",),
            1,
            "error: mine.py:11: NameError: name 'k' is not defined\n   |\n11 |",
        ),
        (
            ("mine.py:still", "--plant", "stiff"),
            2,
            "'stiff' takes joint rates",
        ),
        (("none.py",), 1, "law 'none.py' cannot be read"),
    ):
        done = dqpaint(*chosen, *words)
        assert done.returncode == code
        assert says in done.stderr
        assert "Traceback" not in done.stderr
    assert files(tmp_path) == left


def test_two_runs_leave_identical_pictures_and_tables(dqpaint, tmp_path):
    for folder in ("one/", "two/"):
        assert dqpaint("draw", "star", "--out", folder, "--size", "480x270").returncode == 0
    for name in ("star-hinf.png", "star-hinf.csv"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_a_file_s_name_as_out_is_its_stem(dqpaint, line, tmp_path):
    assert dqpaint("draw", line, "--size", "64x36", "--out", "a.png").returncode == 0
    assert files(tmp_path) == ["a.csv", "a.json", "a.png", "line.traj"]


def test_version(dqpaint):
    assert dqpaint("--version").stdout == f"dqpaint {package.__version__}\n"


def test_a_robot_that_is_asked_for_beats_the_file_s_own(dqpaint, tmp_path):
    (tmp_path / "other.traj").write_text("robot ur7\nline to (10, 0) mm\n")
    assert dqpaint("check", "other.traj").returncode == 1
    assert dqpaint("check", "other.traj", "--robot", "iiwa").returncode == 0


def test_a_view_that_is_unknown_is_told_before_anything_is_simulated(monkeypatch):
    monkeypatch.setattr("dqpaint.planning.prepared_motion.plan", None)
    with pytest.raises(package.DqpaintError, match="no view named 'back'"):
        package.draw("rose", view="back")


def test_check_with_a_plant_says_what_its_springs_do(dqpaint, line):
    assert "springs give way" in dqpaint("check", line, "--plant", "compliant").stdout


def test_check_with_a_robot_looks_at_the_reach(dqpaint, line, tmp_path):
    assert "iiwa reaches it" in dqpaint("check", line, "--robot", "iiwa").stdout
    assert "iiwa reaches it" in dqpaint("check", line, "--size", "640x360").stdout
    (tmp_path / "far.traj").write_text("robot iiwa\nline to (2, 0) m\n")
    done = dqpaint("check", line, "--view", "at:1:1:1", "--exposure", "f/8,2m")  # as in draw
    assert (done.returncode, done.stderr[:36]) == (2, "usage: view 'at:1:1:1' gives the cam")
    done = dqpaint("check", "far.traj", "--json")
    assert done.returncode == 1
    assert json.loads(done.stdout)["diagnostics"][0]["code"] == "E310"


def test_preview_needs_no_arm(dqpaint, line, tmp_path):
    done = dqpaint("preview", line, "--size", "160x90", "--view", "iso")
    assert (done.returncode, done.stderr) == (0, "")
    assert files(tmp_path) == ["line-preview.png", "line.traj"]
    assert "on film" in done.stdout


def test_a_kept_film_is_developed_without_an_arm(dqpaint, line, tmp_path):
    done = dqpaint(
        "draw",
        line,
        "--size",
        "160x90",
        "--save",
        "film,video,webp",
        "--brush",
        "ribbon:length=5mm",
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert files(tmp_path) == [
        "line-hinf-film.npz", "line-hinf-film.tiff", "line-hinf.webm", "line-hinf.webp",
        "line.traj",
    ]  # fmt: skip
    done = dqpaint("develop", "line-hinf-film.npz", "--view", "front,20,30", "--look", "agx")
    assert (done.returncode, done.stderr) == (0, "")
    assert "exposure  automatic, as f/8, ISO 100, 1 s, 300 mm at " in done.stdout
    names = ["line-hinf-developed-az20-el30.png", "line-hinf-developed-front.png"]
    assert [name for name in files(tmp_path) if "developed" in name] == names


def test_light_that_tells_from_the_command_line(dqpaint, line, tmp_path):
    done = dqpaint(
        "draw", line, "--size", "640x360", "--save", "png,json", "--colour-by", "position-error",
        "--overlay", "--magnify", "20", "--exposure", "auto", "--noise", "1", "--starburst", "6",
        "--pwm", "400", "--look", "clip", "--brush", "fibre",
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    settings = json.loads((tmp_path / "line-hinf.json").read_text())["settings"]
    for name, value in {"colour_by": "position-error", "overlay": True, "magnify": 20.0,
                        "noise": 1, "starburst": 6, "pwm": 400.0, "look": "clip",
                        "brush": "fibre", "exposure": "auto"}.items():  # fmt: skip
        assert settings[name] == value


def test_check_of_good_and_bad_files(dqpaint, line, tmp_path):
    (tmp_path / "bad.traj").write_text("lin to (0, 0, 70) mm\nline to (0, 0, 70)\n")
    done = dqpaint("check", line, "bad.traj", "star")
    assert done.returncode == 1
    for figure in ("line.traj: 32 mm", "0.40 s", "20 steps of 20 ms", "21 poses", "30 x 10 x 0 mm"):
        assert figure in done.stdout
    assert re.findall(r"error.(E\d+).*\n --> ([\w.:]+)", done.stdout) == [
        ("E120", "bad.traj:1:1"), ("E218", "bad.traj:2:9"),
    ]  # fmt: skip
    assert done.stderr == ""
    assert dqpaint("check", line).returncode == 0


def test_more_samples_than_usual_can_be_allowed(dqpaint, line, tmp_path):
    (tmp_path / "long.traj").write_text("line by (10, 0) mm samples 2000000\n")
    done = dqpaint("check", "long.traj")
    assert (done.returncode, done.stderr) == (1, "")
    assert "error[E302]: more than 2,000,000 samples" in done.stdout
    assert "--max-samples N" in done.stdout
    done = dqpaint("check", "long.traj", "--max-samples", "2000001")
    assert done.returncode == 0
    assert "2000000 steps of 8 ms (2000001 poses)" in done.stdout
    done = dqpaint("check", line, "--max-samples", "20")
    assert done.returncode == 1
    assert " --> line.traj:3:1" in done.stdout
    assert dqpaint("check", line, "--max-samples", "21").returncode == 0


def test_check_for_programs(dqpaint, line, tmp_path):
    (tmp_path / "bad.traj").write_text("lin to (0, 0, 70) mm\n")
    done = dqpaint("check", "--json", line, "bad.traj", "none.traj")
    facts = json.loads(done.stdout)
    assert done.returncode == 1
    assert facts["version"] == 1
    assert facts["summary"]["errors"] == 2
    assert facts["summary"]["samples"] == 21
    first = facts["diagnostics"][0]
    assert (first["code"], first["file"], first["severity"]) == ("E120", "bad.traj", "error")
    assert (first["start"], first["end"]) == ({"line": 1, "column": 1}, {"line": 1, "column": 4})


@pytest.mark.parametrize(("words", "code", "says"), WRONG)
def test_wrong_calls_are_answered_with_what_would_be_right(
    answer, line, tmp_path, words, code, says
):
    done = answer(*words)
    assert done.returncode == code, done.stderr
    assert says in done.stderr
    assert "Traceback" not in done.stderr
    assert done.stdout == ""
    assert files(tmp_path) == ["line.traj"]


BAD = {
    "word": (b"lin to (0, 0, 70) mm\n", "error[E120]: "),
    "unit": (b"line to (0, 0, 70)\n", "error[E218]: "),
    "bracket": (b"line to (0, 0, 70 mm\n", "error[E103]: "),
    "empty": (b"", "error[E140]: "),
    "binary": (bytes(range(256)) * 40, "error"),
    "far": (b"line to (0, 0, 900) mm\n", "error[E310]: "),
    "huge": (b"hold 1 s\nline by (10, 0) mm samples 1000000000000\n", "error[E302]: "),
    "robot": (b"robot ur7\nline by (10, 0) mm\n", "error[E311]: "),
    "dark": (b"light off\nline by (10, 0) mm\n", "no light"),
}


@pytest.mark.parametrize("name", BAD)
def test_wrong_files_are_answered_with_the_place(answer, tmp_path, name):
    data, says = BAD[name]
    (tmp_path / "bad.traj").write_bytes(data)
    done = answer("draw", "bad.traj")
    assert done.returncode == 1, done.stderr
    assert says in done.stderr
    assert "bad.traj" in done.stderr
    assert "Traceback" not in done.stderr
    assert files(tmp_path) == ["bad.traj"]


def test_out_of_reach_says_where_by_how_much_and_what_helps(dqpaint, tmp_path):
    (tmp_path / "far.traj").write_text("hold 1 s\nline to (0, 0, 900) mm\n")
    done = dqpaint("draw", "far.traj")
    assert "error[E310]: sample " in done.stderr
    assert "--> far.traj:2:1" in done.stderr
    assert "with scale 0." in done.stderr


def test_limits_reached_are_told_and_the_picture_is_made(dqpaint, tmp_path):
    (tmp_path / "fast.traj").write_text("hold 1 s\nline to (200, 0) mm speed 3 m/s\nhold 1 s\n")
    done = dqpaint("draw", "fast.traj", "--plant", "ideal", "--size", "160x90")
    assert done.returncode == 0
    assert re.search(r"warning: line 2 .*speed limits:\n    joint ", done.stderr)
    assert "speed (line 2)" in done.stdout
    assert "largest at 1." in done.stdout
    assert (tmp_path / "fast-hinf.png").exists()


def test_lists(answer):
    assert all(name in answer("list", "controllers").stdout for name in CONTROLLERS)
    rows = json.loads(answer("list", "controllers", "--json").stdout)
    assert [row["name"] for row in rows] == list(CONTROLLERS)
    assert rows[0]["gains"][0]["default"] > 0
    assert set(json.loads(answer("list", "--json").stdout)) == set(LISTS)
    overview = answer("list").stdout
    assert all(re.search(rf"^  {name}\b", overview, re.MULTILINE) for name in LISTS)
    assert "iiwa" in answer("list", "robots").stdout
    assert "stiff" in answer("list", "plants").stdout
    assert "star" in answer("list", "examples").stdout


@pytest.mark.parametrize(
    "command",
    [
        [],
        ["draw"],
        ["preview"],
        ["develop"],
        ["check"],
        ["list"],
        ["gallery"],
        ["compare"],
        ["sweep"],
        ["verify"],
        ["export"],
    ],
)
def test_help_ends_with_two_examples(answer, command):
    done = answer(*command, "--help")
    assert done.returncode == 0
    if command:
        assert done.stdout.count(f"  dqpaint {command[0]}") == 2


@pytest.mark.parametrize("words", [
    ["--help"], ["draw", "--help"], ["check", "star"], ["sweep", "--help"], ["tune", "--help"],
    ["replay", "--help"], ["verify", "--help"],
])  # fmt: skip
def test_help_and_check_start_without_the_heavy_libraries(dqpaint, words):
    code = (
        "import sys; from dqpaint.cli import main; sys.argv[0] = 'dqpaint'\n"
        "try: main.run()\nexcept SystemExit: pass\n"
        "heavy = ('cv2', 'pinocchio', 'pybullet', 'scipy')\n"
        "print('LOADED', [m for m in heavy if m in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, *words], capture_output=True, text=True, check=True
    )
    assert done.stdout.splitlines()[-1] == "LOADED []"


@pytest.mark.slow
def test_a_run_loads_what_it_uses(tmp_path):
    """Each of these takes a tenth of a second or more, and a plain run uses none of them."""
    code = (
        "import sys; from dqpaint.cli import main; sys.argv[0] = 'dqpaint'\n"
        "try: main.run()\nexcept SystemExit as stop: assert not stop.code\n"
        "heavy = ('scipy', 'matplotlib', 'mujoco', 'jinja2', 'nicegui', 'distributed')\n"
        "print('LOADED', [m for m in heavy if m in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, "draw", "star", "--size", "64x36"],
        capture_output=True, text=True, check=True, cwd=tmp_path,
    )  # fmt: skip
    assert done.stdout.splitlines()[-1] == "LOADED []"


def test_looking_ahead_needs_neither_the_simulator_nor_the_image_library(dqpaint):
    code = (
        "import sys; from dqpaint.planning.check import check\n"
        "assert check('star', robot='iiwa').forecast\n"
        "print('LOADED', [m for m in ('cv2', 'pybullet') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "LOADED []"


def test_export_writes_a_trajectory_and_its_cues(dqpaint, line, tmp_path):
    done = dqpaint("export", line, "--format", "ros2", "--plant", "ideal")
    assert (done.returncode, done.stderr) == (0, "")
    assert files(tmp_path) == ["line-hinf-cues.csv", "line-hinf-trajectory.yaml", "line.traj"]
    assert "from rest to rest, within the arm's limits" in done.stdout


def test_a_run_comes_back(dqpaint, line, tmp_path):
    """Exported, painted again: the option of its own, the names of the files."""
    assert dqpaint("export", line, "--format", "csv").returncode == 0
    done = dqpaint("draw", line, "--recorded", "line-hinf-trajectory.csv", "--size", "64x36")
    assert done.returncode == 0, done.stderr
    assert "note: line-hinf-trajectory.csv: 21 rows" in done.stderr
    assert "iiwa, recorded" in done.stdout
    assert (tmp_path / "line-recorded.json").is_file()


def test_streams_that_cannot_say_everything(dqpaint, tmp_path):
    (tmp_path / "ümlaut.traj").write_text("light ümlaut\n", "utf-8")
    narrow = {"PYTHONIOENCODING": "ascii"}
    done = dqpaint("check", "ümlaut.traj", env=narrow)
    assert done.returncode == 1
    assert "error[E101]: unexpected character '\\xfc'" in done.stdout
    assert json.loads(dqpaint("check", "ümlaut.traj", "--json", env=narrow).stdout)


@pytest.mark.parametrize(("redirect", "code"), [(">&-", 0), ("2>&-", 0), (">/dev/full", 1)])
def test_streams_that_are_closed_or_full(line, tmp_path, redirect, code):
    command = f"'{sys.executable}' -m dqpaint draw line.traj --size 64x36 {redirect}"
    for unbuffered in ("", "1"):
        done = subprocess.run(
            ["sh", "-c", command], cwd=tmp_path, capture_output=True, text=True,
            env={**os.environ, "PYTHONUNBUFFERED": unbuffered},
        )  # fmt: skip
        check_streams(done, code)
    assert (tmp_path / "line-hinf.png").exists()


def check_streams(done, code):
    assert done.returncode == code
    assert "Traceback" not in done.stderr
    if code:
        assert "error: standard output cannot be written" in done.stderr


def test_ctrl_c_while_libraries_are_imported(monkeypatch, capsys):
    def interrupted():
        raise KeyboardInterrupt

    monkeypatch.setattr("dqpaint.cli.main.run", interrupted)
    with pytest.raises(SystemExit) as stopped:
        entry.main()
    assert stopped.value.code == 130
    assert capsys.readouterr().err == "interrupted\n"


def test_ctrl_c_leaves_nothing_half_written(tmp_path):
    (tmp_path / "long.traj").write_text("period 4 ms\nline to (100, 0) mm in 600 s\n")
    process = subprocess.Popen(
        [sys.executable, "-m", "dqpaint", "draw", "long.traj"],
        cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # a parent may ignore it
    )  # fmt: skip
    try:
        time.sleep(4)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=20)
    finally:
        process.kill()
    assert process.returncode == 130, err
    assert (out, err) == ("", "interrupted\n")
    assert files(tmp_path) == ["long.traj"]


def test_pose_tells_numbers_and_warnings_apart(dqpaint):
    done = dqpaint("pose", "viper850", "--deg=20,-110,190,25,45,20", "--flange", "--json")
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout)["pose"][0] == pytest.approx(0.3530, abs=5e-5)
    done = dqpaint("pose", "iiwa", "--deg", "-180,0,0,0,0,0,0")
    assert done.returncode == 0
    assert re.fullmatch("warning: joint 1 at -180 deg .*-170 to 170 deg\n", done.stderr)
    assert "manipulability" in done.stdout


def test_an_arm_of_one_s_own_draws_and_says_what_was_assumed(dqpaint, line, tmp_path):
    (tmp_path / "arm.urdf").write_text(arm_urdf())
    done = dqpaint("draw", line, "--robot", "arm.urdf:l6", "--size", "160x90")
    assert done.returncode == 0
    assert [text.partition(":")[0] for text in done.stderr.splitlines()] == ["note"] * 3
    assert "arm, stiff" in done.stdout
    done = dqpaint("check", line, "--robot", "arm.urdf:l6")
    assert done.returncode == 0
    assert "arm reaches it" in done.stdout
    (tmp_path / "arm.urdf").write_text(arm_urdf()[:300])
    done = dqpaint("draw", line, "--robot", "arm.urdf:l6")
    assert done.returncode == 1
    assert done.stderr.startswith("error: arm.urdf ")
