"""The commands round the language as a person meets them: in a process of its own."""

import json
import os
import pty
import re
import subprocess
import sys

import pytest

from dqpaint.diagnostics.catalogue import explanations
from dqpaint.language.vocabulary.words import STATEMENTS
from tests.support.folders import files

pytestmark = pytest.mark.slow
UGLY, FAIR = "line   to (1,2)mm", "line to (1, 2) mm\n"


@pytest.fixture
def ugly(tmp_path):
    (tmp_path / "a.traj").write_text(UGLY)
    return "a.traj"


def test_fmt_lays_out_and_says_so(dqpaint, ugly, tmp_path):
    done = dqpaint("fmt", ugly)
    assert (done.returncode, done.stdout, done.stderr) == (0, "a.traj: formatted\n", "")
    assert (tmp_path / ugly).read_text() == FAIR
    assert dqpaint("fmt", ugly).stdout == "a.traj: unchanged\n"


def test_fmt_check_writes_nothing_and_names_the_files(dqpaint, ugly, tmp_path):
    (tmp_path / "b.traj").write_text(FAIR)
    done = dqpaint("fmt", "--check", ugly, "b.traj")
    assert (done.returncode, done.stdout, done.stderr) == (1, "a.traj\n", "")
    assert (tmp_path / ugly).read_text() == UGLY
    done = dqpaint("fmt", "--check", "b.traj")
    assert (done.returncode, done.stdout) == (0, "")


def test_fmt_goes_on_after_a_file_that_is_no_drawing(dqpaint, ugly, tmp_path):
    (tmp_path / "bad.traj").write_text("lin to (1, 2) mm\n")
    done = dqpaint("fmt", "bad.traj", "none.traj", ugly)
    assert done.returncode == 1
    assert done.stdout == "a.traj: formatted\n"
    assert re.search(r"error.E120.*\n --> bad.traj:1:1", done.stderr)
    assert "none.traj" in done.stderr
    assert files(tmp_path) == ["a.traj", "bad.traj"]


def test_fmt_reads_standard_input():
    def piped(data, *words):
        command = [sys.executable, "-m", "dqpaint", "fmt", "-", *words]
        return subprocess.run(command, input=data, capture_output=True, timeout=60)

    done = piped(UGLY.encode())
    assert (done.returncode, done.stdout, done.stderr) == (0, FAIR.encode(), b"")
    assert piped(b"hold 1 s\r\n").stdout == b"hold 1 s\r\n"
    assert piped(UGLY.encode(), "--check").returncode == 1
    assert piped(FAIR.encode(), "--check").returncode == 0
    done = piped(b"lin\n")
    assert (done.returncode, done.stdout) == (1, b"")
    assert b" --> <stdin>:1:1" in done.stderr


def test_explain(dqpaint):
    done = dqpaint("explain", "e245")
    assert done.returncode == 0
    assert done.stdout.startswith(f"E245: {explanations()['E245'].title}\n")
    names, messages = dqpaint("explain").stdout.split("\n\n")
    assert "accel-decoupled" in names
    assert [line[:4] for line in messages.splitlines()] == list(explanations())


def test_new(dqpaint, tmp_path):
    done = dqpaint("new", "wish")
    assert (done.returncode, done.stdout, done.stderr) == (0, "wish.traj\n", "")
    assert dqpaint("check", "wish.traj").returncode == 0
    done = dqpaint("new", "wish")
    assert (done.returncode, done.stdout) == (1, "")
    assert "'wish.traj' is there already" in done.stderr
    assert files(tmp_path) == ["wish.traj"]


def test_grammar_and_lists(dqpaint):
    assert json.loads(dqpaint("grammar").stdout)["scopeName"] == "source.traj"
    rows = json.loads(dqpaint("list", "statements", "--json").stdout)
    assert [row["name"] for row in rows] == list(STATEMENTS)
    shown = dqpaint("list", "statements").stdout
    assert "arc centre (30, 0) mm angle 360 deg\n" in shown
    assert "parts: to by" in shown
    assert "polar(RADIUS, ANGLE)" in dqpaint("list", "functions").stdout


def test_check_tells_programs_what_would_mend(dqpaint, tmp_path):
    (tmp_path / "ä.traj").write_text('robot "ä😀"\nlet ä = 1\nline to (1; 2)\n', "utf-8")
    facts = json.loads(dqpaint("check", "--json", "ä.traj").stdout)
    found = {d["code"]: d for d in facts["diagnostics"] if d["start"]["line"] == 3}
    assert found["E101"]["fix"] == {
        "title": "write a comma",
        "edits": [
            {"start": {"line": 3, "column": 11}, "end": {"line": 3, "column": 12}, "text": ","}
        ],
    }
    assert found["E101"]["explain"] == "dqpaint explain E101"
    assert found["E101"]["url"] == "trajectories/MESSAGES.md#e101"
    assert set(found["E101"]) == {
        "file", "severity", "code", "message", "start", "end", "label", "help", "explain",
        "url", "related", "fix",
    }  # fmt: skip


def test_lsp_without_its_packages_says_what_to_install(tmp_path):
    (tmp_path / "pygls.py").write_text("raise ModuleNotFoundError('gone', name='pygls')")
    done = subprocess.run(
        [sys.executable, "-m", "dqpaint", "lsp"], capture_output=True, text=True, timeout=60,
        env={**os.environ, "PYTHONPATH": f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}"},
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (1, "")
    assert "pip install 'dqpaint[lsp]'" in done.stderr


@pytest.mark.parametrize("command", ["check", "preview"])
def test_a_person_at_a_terminal_is_told_where_more_is_said(dqpaint, tmp_path, command):
    (tmp_path / "bad.traj").write_text("lin\nline to (1, 2)\n")
    assert "explain" not in dqpaint(command, "bad.traj").stderr
    near, far = pty.openpty()
    done = subprocess.run(
        [sys.executable, "-m", "dqpaint", command, "bad.traj"],
        cwd=tmp_path, stdout=far, stderr=far, timeout=60,
    )  # fmt: skip
    seen = os.read(near, 1 << 16).decode().replace("\r", "")
    os.close(near)
    os.close(far)
    assert done.returncode == 1
    assert "dqpaint explain E120" in seen.splitlines()[-1]


@pytest.mark.parametrize("command", ["fmt", "explain", "new", "grammar", "lsp"])
def test_help_ends_with_examples(dqpaint, command):
    done = dqpaint(command, "--help")
    assert done.returncode == 0
    assert done.stdout.count(f"  dqpaint {command}") >= 2


@pytest.mark.parametrize(
    "words", [["fmt", "a.traj"], ["explain", "E245"], ["new", "b"], ["grammar"]]
)
def test_they_start_without_the_numbers(words, ugly, tmp_path):
    code = (
        "import sys; from dqpaint.cli import main; sys.argv[0] = 'dqpaint'\n"
        "try: main.run()\nexcept SystemExit: pass\n"
        "print('LOADED', [m for m in ('numpy', 'cv2', 'pinocchio', 'pybullet', 'pygments')"
        " if m in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, *words], capture_output=True, text=True, check=True,
        cwd=tmp_path,
    )  # fmt: skip
    assert done.stdout.splitlines()[-1] == "LOADED []"
