"""Manners of the command line: help pages, colours, completion, streams, doctor."""

import json
import os
import pty
import re
import struct
import subprocess
import sys
from fcntl import ioctl
from pathlib import Path
from termios import TIOCSWINSZ

import pytest

from dqpaint.cli.front import colours, completion, doctor, help_pages
from dqpaint.core import example_names, find_drawing
from dqpaint.errors import DqpaintError, UnknownNameError
from tests.support.commands import LINE

ROOT = Path(__file__).parents[2]
COMMANDS = [
    *("draw", "preview", "develop", "gallery", "check", "list", "fmt", "explain", "new", "plot"),
    *("compare", "sweep", "tune", "worst", "replay", "verify", "pose", "export", "grammar"),
    *("lsp", "doctor", "cite"),
]
CODE = re.compile(r"\x1b\[[0-9;]*m")


def at_terminal(*words, cwd, env=None, columns=80):
    """What a command writes to a terminal, both streams."""
    near, far = pty.openpty()
    ioctl(far, TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    usual = {k: v for k, v in os.environ.items() if k not in ("NO_COLOR", "COLUMNS", "COLORTERM")}
    with subprocess.Popen(
        [sys.executable, "-m", "dqpaint", *words], cwd=cwd, stdout=far, stderr=far, stdin=far,
        env={**usual, "TERM": "xterm-256color", "PYTHONPATH": str(ROOT), **(env or {})},
    ) as process:  # fmt: skip
        os.close(far)
        said = b""
        while True:
            try:
                more = os.read(near, 1 << 16)
            except OSError:  # Linux says so when the other side has closed
                break
            if not more:
                break
            said += more
    os.close(near)
    return process.returncode, said.decode().replace("\r", "")


@pytest.mark.parametrize("columns", ["80", "120"])
@pytest.mark.parametrize("command", ["", *COMMANDS])
def test_help_is_whole_and_fits(command, columns, answer, monkeypatch):
    monkeypatch.setenv("COLUMNS", columns)
    done = answer(*filter(None, [command]), "--help")
    assert done.returncode == 0
    lines = done.stdout.splitlines()
    assert max(map(len, lines)) <= min(int(columns), help_pages.WIDEST)
    assert not [line for line in lines if re.search(r"\w\.\.\.$", line)]  # a sentence that was cut
    first = done.stdout.index("  dqpaint ")
    assert first < done.stdout.index("Every command:" if command else "Draw:")
    for name in re.findall(r"[\w/-]+\.md", done.stdout.rpartition("More:")[2]):
        assert (ROOT / name).is_file(), name


def test_examples_of_help_can_be_copied(monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    epilog = "Examples:\n\n  dqpaint draw star --controller p --gain k=15 --out somewhere/else/"
    (shown,) = help_pages.examples(epilog)
    assert max(map(len, shown.split("\n"))) <= 60
    assert shown.replace("\\\n", "").split() == epilog.split()[1:]


def test_every_command_has_a_group(answer):
    assert "Others:" not in answer("--help").stdout


@pytest.mark.slow
def test_colours_on_a_terminal_are_of_the_same_words(tmp_path):
    (tmp_path / "bad.traj").write_text("lin to (0, 0) mm\n")
    code, plain = at_terminal("check", "bad.traj", cwd=tmp_path, env={"NO_COLOR": "1"})
    assert code == 1
    assert "\x1b" not in plain
    dumb = at_terminal("check", "bad.traj", cwd=tmp_path, env={"TERM": "dumb"})[1]
    assert dumb == plain
    coloured = at_terminal("check", "bad.traj", cwd=tmp_path, env={"NO_COLOR": ""})[1]
    assert "\x1b[1;31merror[E120]:\x1b[0m" in coloured
    assert CODE.sub("", coloured) == plain


@pytest.mark.slow
def test_a_drawing_does_not_colour_the_terminal(tmp_path):
    (tmp_path / "bad.traj").write_text("lin \x1b[31m to (0, 0) mm\n")
    said = at_terminal("check", "bad.traj", cwd=tmp_path)[1]
    assert "\x1b[31m to" not in said


@pytest.mark.slow
def test_a_picture_is_not_written_to_a_terminal(tmp_path):
    code, said = at_terminal("draw", "star", "--out", "-", cwd=tmp_path)
    assert code == 2
    assert "terminal" in said
    assert "PNG" not in said


def test_colours_add_nothing_but_codes():
    finding = (
        "error[E120]: no statement 'lin'\n  --> a.traj:1:1\n  |\n1 | lin to\n  | ^^^ here\n"
        "  = help: did you mean 'line'?\n\nwarning[W403]: fast\nnote: b: c\n  drawing  star"
    )
    for painter in (colours.findings, colours.labels, colours.headings):
        painted = painter(finding)
        assert painted != finding
        assert CODE.sub("", painted) == finding
    painted = colours.findings(finding)
    assert "\x1b[1;31m^^^ here" in painted
    assert "\x1b[1;33mwarning[W403]:" in painted


@pytest.mark.parametrize(
    ("environment", "is_terminal", "coloured"),
    [
        ({"TERM": "xterm"}, True, True),
        ({"TERM": "xterm"}, False, False),
        ({"TERM": "dumb"}, True, False),
        ({}, True, os.name == "nt"),
        ({"TERM": "xterm", "NO_COLOR": "1"}, True, False),
        ({"TERM": "xterm", "NO_COLOR": ""}, True, True),
    ],
)
def test_who_gets_colours(environment, is_terminal, coloured, monkeypatch):
    class Stream:
        def isatty(self):
            return is_terminal

    for name in ("TERM", "NO_COLOR"):
        monkeypatch.delenv(name, raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    assert colours.takes_colour(Stream()) is coloured


IDEAL = ("--size", "64x36", "--plant", "ideal")


def draws(dqpaint, *words):
    return dqpaint("draw", "line.traj", *IDEAL, *words)


def test_the_summary_as_json_is_the_file_s(dqpaint, line, tmp_path):
    done = draws(dqpaint, "--json")
    assert done.returncode == 0
    assert json.loads(done.stdout) == json.loads((tmp_path / "line-hinf.json").read_text())


def test_a_picture_goes_to_a_pipe(line, tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "dqpaint", "draw", line, *IDEAL, "--out", "-"],
        cwd=tmp_path, capture_output=True, check=True, env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    from dqpaint.core.inputs import picture_size

    assert picture_size(done.stdout) == ("PNG", 64, 36)
    assert b"position error" in done.stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == ["line.traj"]


@pytest.mark.parametrize("words", [("--save", "png,csv"), ("--json",), ("--view", "front,side")])
def test_only_one_file_goes_to_standard_output(words, dqpaint, line):
    done = draws(dqpaint, "--out", "-", *words)
    assert (done.returncode, done.stdout) == (2, "")
    assert "--out -" in done.stderr


@pytest.mark.slow
def test_quiet_and_verbose(dqpaint, line, tmp_path):
    quiet = draws(dqpaint, "-q")
    assert (quiet.returncode, quiet.stdout, quiet.stderr) == (0, "", "")
    assert (tmp_path / "line-hinf.png").exists()
    loud = dqpaint("-v", "check", "line.traj")
    assert loud.stdout.splitlines()[-1] == "1 drawing checked: no errors or warnings"
    told = draws(dqpaint, "-v")
    assert re.search(r"^ *\d+ ms  dqpaint\.[\w.]+: ", told.stderr, re.MULTILINE)


def test_check_counts(dqpaint, line, tmp_path):
    (tmp_path / "bad.traj").write_text("lin to (0, 0) mm\nlnie to (0, 0) mm\n")
    done = dqpaint("check", "bad.traj", line, "gone.traj")
    assert done.stdout.splitlines()[-1] == "3 drawings checked: 3 errors"
    quiet = dqpaint("check", "-q", "bad.traj", line)
    assert "error[E120]" in quiet.stdout
    assert "checked" not in quiet.stdout
    assert "line.traj:" not in quiet.stdout


def test_the_overview_fits_a_screen(answer, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    lines = answer("list").stdout.splitlines()
    assert len(lines) <= 24
    assert max(map(len, lines)) <= 80
    assert any(line.split()[:1] == ["robots"] and "iiwa" in line for line in lines)


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        (("draw", "star", "--robot", "UR5"), "'ur5'"),
        (("draw", "star", "--robot", "kuka"), "'iiwa'"),
        (("draw", "star", "--robot", "franka"), "'panda'"),
        (("draw", "star", "--robot", "franke"), "'panda'"),
        (("pose", "Panda"), "'panda'"),
        (("draw", "star", "--plant", "stif"), "'stiff'"),
        (("draw", "star", "--controller", "hinv"), "'hinf'"),
        (("list", "robot"), "'robots'"),
        (("draw", "Star"), "'star'"),
        (("draw", "star", "--view", "fornt"), "'front'"),
    ],
)
def test_did_you_mean(words, meant, answer):
    done = answer(*words)
    assert done.returncode in (1, 2)
    assert f"did you mean {meant}?" in done.stderr


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("car.png", "picture"), ("car.JPG", "picture"), ("logo.svg", "svg"),
        ("star-film.npz", "develop"), ("run.csv", "--recorded"), ("run.json", "--settings"),
        ("arm.urdf", "--robot"), ("law.py", "--controller"),
    ],
)  # fmt: skip
def test_what_is_no_drawing_is_told_what_it_is_for(name, hint, tmp_path):
    (tmp_path / name).write_bytes(b"\x89PNG")
    with pytest.raises(DqpaintError) as told:
        find_drawing(str(tmp_path / name))
    assert hint in str(told.value)


def test_an_unknown_name_survives_a_process():
    import pickle

    problem = UnknownNameError("robot", "kuka", ["iiwa"], {"kuka": "iiwa"})
    again = pickle.loads(pickle.dumps(problem))
    assert str(again) == str(problem)
    assert "'iiwa'?" in str(again)


def completed(*words, cwd):
    """What bash is given for the last word."""
    done = subprocess.run(
        [sys.executable, "-m", "dqpaint"], cwd=cwd, capture_output=True, text=True, check=True,
        env={**os.environ, "PYTHONPATH": str(ROOT), "_DQPAINT_COMPLETE": "complete_bash",
             "COMP_WORDS": " ".join(["dqpaint", *words]), "COMP_CWORD": str(len(words))},
    )  # fmt: skip
    return done.stdout.split()


@pytest.mark.slow
def test_the_tab_key(tmp_path):
    (tmp_path / "mine.traj").write_text(LINE)
    (tmp_path / "notes.txt").write_text("")
    assert completed("pre", cwd=tmp_path) == ["preview"]
    assert completed("draw", "st", cwd=tmp_path) == [n for n in example_names() if n[:2] == "st"]
    assert completed("draw", "m", cwd=tmp_path) == ["mine.traj"]
    assert completed("draw", "star", "--robot", "pan", cwd=tmp_path) == [
        "panda", "panda-identified"
    ]  # fmt: skip
    assert completed("compare", "star", "--controllers", "p,pf", cwd=tmp_path) == ["p,pff"]
    assert "--magnify" in completed("draw", "star", "--mag", cwd=tmp_path)


def test_completers_know_the_registries(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub/a.traj").write_text(LINE)
    assert completion.drawings("su") == ["sub/"]
    assert completion.drawings("sub/") == ["sub/a.traj"]
    assert completion.drawings("nowhere/") == []
    assert completion.plants("comp") == ["compliant"]
    assert completion.disturbances("pay") == ["payload="]
    assert completion.formats("png,js") == ["png,json"]
    assert "hinf" in completion.explained("h")
    assert completion.of_setting("gain") is None
    for complete in completion.OF_SETTINGS.values():
        assert complete("")


@pytest.mark.slow
def test_the_doctor_s_report(answer):
    report = json.loads(answer("doctor", "--json").stdout)
    assert all(report["works"].values())
    assert report["cores"] >= 1
    found = {one["name"]: one for one in report["libraries"]}
    assert found["numpy"]["version"].count(".") >= 1
    assert "engines" in answer("doctor").stdout


def test_the_doctor_sees_what_is_missing_and_what_is_broken(tmp_path, monkeypatch):
    (tmp_path / "broken_one.py").write_text("import os; os.abort()")
    (tmp_path / "unfit.py").write_text("raise OSError('no libfoo.so')")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.syspath_prepend(tmp_path)
    found = doctor.look_for(
        [
            doctor.Library("nowhere_here", ("some-package",), "tests"),
            doctor.Library("broken_one", ("broken",), "tests"),
            doctor.Library("unfit", ("unfit",), "tests"),
            doctor.Library("numpy", ("numpy",), "tests"),
        ]
    )
    assert [bool(one.fault) for one in found] == [True, True, True, False]
    assert "pip install some-package" in found[0].fault
    assert "-6" in found[1].fault
    assert "no libfoo.so" in found[2].fault


@pytest.mark.slow
def test_without_an_engine_the_doctor_says_what_is_left(monkeypatch):
    monkeypatch.setattr(doctor, "ENGINES", (doctor.Library("no_engine", ("x",), "plants"),))
    works = doctor.examine()["works"]
    assert works["draw --plant ideal, check --robot"]
    assert not works["draw, export"]
    assert "missing" in doctor.as_text(doctor.examine())


def test_long_lines_are_folded_between_words():
    table = (
        "  light      99.9% on film, 0.1% lost; 0.00% of the picture is white\n"
        + " " * 13
        + "x " * 30
    )
    folded = colours.fold(table, 40)
    assert max(map(len, folded.split("\n"))) <= 40
    assert folded.split() == table.split()
    assert all(line.startswith(" " * 13) for line in folded.split("\n")[1:])
    excerpt = "12 | " + "line to (0, 0) mm " * 9
    assert colours.fold(excerpt, 40) == excerpt
