"""Defaults of a project: found upwards, told, beneath what is typed, and never run."""

import json
import os

import pytest

from dqpaint.settings import find_project
from tests.support.commands import LINE

LAW = 'raise SystemExit("it was run")\n'


@pytest.fixture
def dqpaint(answer, tmp_path, monkeypatch):
    """A command, in this process, in a folder of the project."""

    def call(*words):
        monkeypatch.setattr(monkeypatch, "chdir", lambda _folder: os.chdir(tmp_path / "sub"))
        return answer(*words)

    before = os.getcwd()
    yield call
    os.chdir(before)


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A project with a drawing in a folder of it; files are written by name."""
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub/line.traj").write_text(LINE)

    def write(text, name="dqpaint.toml"):
        (tmp_path / name).write_text(text)
        return tmp_path / name

    return write


def drawn(dqpaint, *words):
    done = dqpaint("draw", "line.traj", "--json", *words)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["settings"], done.stderr


DEFAULTS = 'plant = "ideal"\nsize = "64x36"\ncontroller = "p"\ngain.k = 7\nseed = 3\n'


@pytest.mark.parametrize("name", ["dqpaint.toml", "pyproject.toml"])
def test_defaults_are_found_upwards_and_told(name, project, dqpaint, tmp_path):
    project(("[tool.dqpaint]\n" if name == "pyproject.toml" else "") + DEFAULTS, name)
    settings, said = drawn(dqpaint)
    assert (settings["plant"], settings["width"], settings["seed"]) == ("ideal", 64, 3)
    assert (settings["controller"], settings["gains"]) == ("p", {"k": 7})
    told = [line for line in said.splitlines() if line.startswith("note: defaults of ")]
    assert len(told) == 1
    assert name in told[0]
    for word in ("plant", "size", "controller", "gain", "seed"):
        assert word in told[0].split(": ", 2)[2].split(", ")


def test_what_is_typed_wins(project, dqpaint, tmp_path):
    project(DEFAULTS)
    settings, _ = drawn(dqpaint, "--controller", "pff", "--size", "32x32")
    assert (settings["controller"], settings["gains"]) == ("pff", {})
    assert (settings["width"], settings["height"]) == (32, 32)
    settings, _ = drawn(dqpaint, "--gain", "k=9")
    assert (settings["controller"], settings["gains"]) == ("p", {"k": 9})


def test_a_settings_file_or_no_project_leaves_them_out(project, dqpaint, tmp_path):
    project(DEFAULTS)
    (tmp_path / "sub/mine.toml").write_text('plant = "ideal"\n')
    settings, said = drawn(dqpaint, "--settings", "mine.toml", "--size", "64x36")
    assert (settings["controller"], settings["seed"]) == ("hinf", 0)
    assert "defaults of" not in said
    settings, said = drawn(dqpaint, "--no-project", "--plant=ideal", "--size=64x36")
    assert settings["controller"] == "hinf"
    assert "defaults of" not in said


@pytest.mark.parametrize("key", ["controller", "plant", "brush"])
def test_code_is_refused_with_its_line(key, project, dqpaint, tmp_path):
    (tmp_path / "mine.py").write_text(LAW)
    project(f'seed = 1\n{key} = "mine.py:Thing"\n')
    done = dqpaint("draw", "line.traj")
    assert done.returncode == 1
    assert "dqpaint.toml:2" in done.stderr
    assert f"--{key}" in done.stderr
    assert "it was run" not in done.stdout + done.stderr


def test_code_that_is_replaced_by_what_is_typed_is_not_run(project, dqpaint, tmp_path):
    (tmp_path / "mine.py").write_text(LAW)
    project('controller = "mine.py"\ngain.own = 3\nplant = "ideal"\nsize = "64x36"\n')
    settings, said = drawn(dqpaint, "--controller", "p")
    assert (settings["controller"], settings["gains"], settings["plant"]) == ("p", {}, "ideal")
    assert "it was run" not in said


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("\nplnat = 'ideal'\n", "dqpaint.toml:2"),
        ("out = 'elsewhere'\n", "command line"),
        ("seed = [\n", "TOML"),
        ("seed = -1\n", "dqpaint.toml:1"),
    ],
)
def test_what_is_wrong_is_told(text, told, project, dqpaint, tmp_path):
    project(text)
    done = dqpaint("check", "line.traj")
    assert done.returncode == 1
    assert told in done.stderr


def test_a_command_takes_what_it_knows(project, dqpaint, tmp_path):
    project('view = "iso"\nrobot = "panda"\nlook = "agx"\n')
    done = dqpaint("check", "line.traj")
    assert done.returncode == 0, done.stderr
    assert "panda" in done.stdout
    assert "look" not in done.stderr


def test_other_projects_are_passed_over(project, tmp_path):
    assert find_project(tmp_path / "sub") in (None, find_project(tmp_path.parent))
    outer = project("[tool.dqpaint]\nseed = 1\n", "pyproject.toml")
    (tmp_path / "sub/pyproject.toml").write_text("[tool.other]\n")
    assert find_project(tmp_path / "sub") == outer
    own = project("seed = 2\n")
    assert find_project(tmp_path / "sub") == own
