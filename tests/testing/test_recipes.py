"""The recipes of CONTRIBUTING, carried out.

A package outside the repository, as they have it; and a copy of dqpaint, changed as they say.
"""

import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

from tests.support.plugins import install

ROOT = Path(__file__).parents[2]
RECIPES = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
TEXT = "period 10 ms\nline to (60, 20, 5) mm tool rot(y, 20 deg) in 1 s\n"
CLI = ("-m", "dqpaint")
pytestmark = pytest.mark.slow


def blocks(kind):
    """The blocks of code of a language, in their order."""
    return re.findall(rf"^```{kind}\n(.*?)^```$", RECIPES, re.DOTALL | re.MULTILINE)


def named(kind):
    """The same, with the file that each says it is: (name, text)."""
    for block in blocks(kind):
        first, _, text = block.partition("\n")
        yield first.removeprefix("# ").strip(), text


def files():
    """The files of the blocks: name -> text; one may come in several blocks."""
    found = {}
    for name, text in named("python"):
        found[name] = found.get(name, "") + text
    return found


def changed(text, diff):
    """A text after a change; the lines that are kept and taken away stand in it once."""
    marked = [(line[:1], line[1:]) for line in diff.splitlines(keepends=True)]
    assert {sign for sign, _ in marked} <= set("+- "), diff
    before = "".join(line for sign, line in marked if sign != "+")
    after = "".join(line for sign, line in marked if sign != "-")
    assert text.count(before) == 1, f"not once in the file: {before}"
    return text.replace(before, after)


def entry_points():
    """The block of pyproject.toml as pip writes it."""
    (block,) = blocks("toml")
    groups = tomllib.loads(block)["project"]["entry-points"]
    lines = []
    for group, names in groups.items():
        lines += [f"[{group}]", *(f"{name} = {place}" for name, place in names.items())]
    return "\n".join(lines)


@pytest.fixture(scope="module")
def outside(tmp_path_factory):
    """A function that runs Python where the package is installed; gives what it prints."""
    folder = tmp_path_factory.mktemp("outside")
    texts = files()
    modules = {
        Path(name).stem: text for name, text in texts.items() if name.startswith("workshop/")
    }
    install(folder / "site", "workshop", modules, entry_points())
    (folder / "check.py").write_text(texts["check.py"])
    (folder / "t.traj").write_text(TEXT)
    path = os.pathsep.join([str(folder / "site"), *filter(None, [os.environ.get("PYTHONPATH")])])

    def ask(*words):
        return subprocess.run(
            [sys.executable, *words], cwd=folder,
            env={**os.environ, "PYTHONPATH": path, "COLUMNS": "300"},
            capture_output=True, text=True, check=False,
        )  # fmt: skip

    def run(*words):
        done = ask(*words)
        assert done.returncode == 0, done.stderr
        return done.stdout

    run.folder, run.ask = folder, ask
    return run


@pytest.mark.parametrize(
    ("kind", "name", "about"),
    [
        ("controllers", "workshop-pi", "Proportional and integral action on the pose error"),
        ("plants", "weak", "It moves at a share"),
        ("brushes", "pair", "Two lamps side by side"),
        ("formats", "duration", "How long the drawing takes"),
        ("controllers", "careful", "Feed-forward and proportional action"),
        ("figures", "position_error_p95_m", "95 %"),
        ("studies", "corner-cutting", "how far they cut its corners"),
    ],
)
def test_lists_say_what_it_brings(outside, kind, name, about):
    (row,) = [
        r for r in json.loads(outside("-m", "dqpaint", "list", kind, "--json")) if r["name"] == name
    ]
    assert about in row["about"]
    assert row["package"] == "workshop 1.2"
    assert "(from workshop 1.2)" in outside("-m", "dqpaint", "list", kind)


def test_it_is_drawn_with_and_recorded(outside):
    words = ["--plant", "weak:share=0.8", "--brush", "pair:apart=0.06", "--size", "64x36"]
    outside(
        "-m", "dqpaint", "draw", "t.traj", "--controller", "workshop-pi", *words,
        "--save", "json,duration", "--out", "one/",
    )  # fmt: skip
    summary = json.loads((outside.folder / "one/t-workshop-pi.json").read_text())
    assert summary["plugins"] == {
        "brush pair": "workshop 1.2",
        "controller workshop-pi": "workshop 1.2",
        "metric position_error_p95_m": "workshop 1.2",
        "plant weak": "workshop 1.2",
    }
    assert (outside.folder / "one/t-workshop-pi.duration").read_text() == "1.00"
    assert summary["position_error_p95_m"] <= summary["position_error_max_m"]


def test_a_sweep_with_two_workers_gives_the_bits_of_single_runs(outside):
    outside(
        "-m", "dqpaint", "sweep", "t.traj", "--controller", "workshop-pi", "--plant", "weak",
        "--vary", "k=10,20", "--jobs", "2", "--out", "swept/",
    )  # fmt: skip
    found = outside(
        "-c",
        "import dqpaint\n"
        "for k in (10.0, 20.0):\n"
        "    p = dqpaint.draw('t.traj', controller='workshop-pi', plant='weak', gains={'k': k},"
        " size=(64, 36))\n"
        "    print(repr(p.metrics.figures['position_error_rms_m']))\n",
    ).split()
    (table,) = (outside.folder / "swept").glob("*-table.csv")
    for number in found:
        assert number.removeprefix("np.float64(").rstrip(")") in table.read_text()


CORNER = "period 10 ms\nline to (30, 0) mm\nline to (30, 30) mm\n"


def test_a_study_is_a_command_and_a_call(outside):
    """The same numbers from two workers, from Python, and from a run by itself."""
    (outside.folder / "corner.traj").write_text(CORNER)
    said = outside(
        *CLI, "corner-cutting", "corner.traj", "--speeds", "40,80", "--plant", "ideal",
        "--jobs", "2", "--out", "corners/", "--report",
    )  # fmt: skip
    folder = outside.folder / "corners"
    rows = list(csv.DictReader((folder / "corner-table.csv").read_text().splitlines()))
    assert [(r["speed"], r["controller"]) for r in rows] == [
        ("40", "hinf"), ("40", "p"), ("80", "hinf"), ("80", "p"),
    ]  # fmt: skip
    assert "corners/corner.png" in said
    assert "Largest error over the speed" in (folder / "corner-report.html").read_text()
    errors = [float(r["position_error_max_m_mean"]) for r in rows]
    assert errors[3] > errors[1] > errors[0] > 0
    found = json.loads(
        outside(
            "-c",
            "import json, dqpaint\n"
            "made = dqpaint.study('corner-cutting', 'corner.traj', speeds='40,80', plant='ideal')\n"
            "d = dqpaint.Drawing('alone', period=0.01)\n"
            "d.speed('80 mm/s')\n"
            "d.line(to=(0.03, 0))\n"
            "d.line(to=(0.03, 0.03))\n"
            "one = dqpaint.draw(d, controller='p', plant='ideal', size=(16, 16))\n"
            "print(json.dumps([made.table['position_error_max_m_mean'].tolist(),"
            " one.metrics.figures['position_error_max_m'], list(made.pictures), str(made)]))\n",
        )
    )
    assert found[0] == errors
    assert found[1] == errors[3]
    assert found[2] == [""]
    assert found[3] in said


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--runs", "2.5"], "--runs"),
        (["--plant", "jelly"], "'jelly'"),
        (["--speds", "3"], "No such option: --speds"),
        (["--out", "c/", "--speeds", "fast"], "speed fast mm/s"),
    ],
)
def test_a_study_refuses_what_it_does_not_take(outside, words, told):
    (outside.folder / "corner.traj").write_text(CORNER)
    done = outside.ask(*CLI, "corner-cutting", "corner.traj", *words)
    assert done.returncode in (1, 2)
    assert told in done.stderr
    assert "Traceback" not in done.stderr


def test_help_of_a_study_is_made_from_its_declaration(outside):
    told = outside(*CLI, "corner-cutting", "--help")
    for words in ("Draw a drawing at several speeds", "--speeds A,B,...", "50,100,200", "--jobs N",
                  "--plant NAME", "--look NAME"):  # fmt: skip
        assert words in told
    assert "corner-cutting" not in outside(*CLI, "--help")  # the list of commands asks no plugin


def test_the_exported_checks_pass_on_it(outside):
    outside("check.py")


@pytest.fixture(scope="module")
def with_zigzag(tmp_path_factory):
    """A function that runs Python with a dqpaint that has one more statement."""
    folder = tmp_path_factory.mktemp("changed")
    shutil.copytree(ROOT / "dqpaint", folder / "dqpaint")
    for name, diff in named("diff"):
        place = folder / name
        place.write_text(changed(place.read_text("utf-8"), diff), "utf-8")
    for name, text in files().items():
        if name.startswith("dqpaint/"):
            (folder / name).write_text(text, "utf-8")

    def run(*words, code=0):
        done = subprocess.run(
            [sys.executable, *words], cwd=folder, env={**os.environ, "PYTHONPATH": str(folder)},
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == code, done.stdout + done.stderr
        return done.stdout + done.stderr

    run.folder = folder
    return run


ZIGZAG = "period 10 ms\nlet count = 2\nzigzag to (60, 0) mm height 10 mm count 2*count in 2 s\n"


def test_a_new_statement_is_drawn(with_zigzag):
    (with_zigzag.folder / "z.traj").write_text(ZIGZAG)
    ends = json.loads(
        with_zigzag(
            "-c",
            "import json, pathlib; from dqpaint.language import parse\n"
            "program = parse(pathlib.Path('z.traj').read_text(), 'z')\n"
            "print(json.dumps([segment.end.position for segment in program.segments]))",
        )
    )
    corners = [(7.5, 5), (22.5, -5), (37.5, 5), (52.5, -5), (60, 0)]
    np.testing.assert_allclose(ends, [(x / 1e3, y / 1e3, 0) for x, y in corners], atol=1e-12)
    with_zigzag(*CLI, "draw", "z.traj", "--size", "64x36", "--plant", "ideal")
    assert len((with_zigzag.folder / "z-hinf.csv").read_text().splitlines()) == 202
    assert (with_zigzag.folder / "z-hinf.png").exists()


@pytest.mark.parametrize(
    ("line", "code", "told"),
    [
        ("zigzag to (60, 0) mm height 10 mm", "E115", "'count'"),
        ("zigzag to (60, 0) mm height 10 mm count 2.5", "E221", "whole number"),
        ("zigzag to (60, 0) mm height -1 mm count 2", "E220", "greater than 0"),
        ("zigzag to (0, 0, 9) mm height 1 mm count 2", "E266", "no sides"),
        ("zigzag by (60, 0) mm height 1 mm count 2", "E110", "'by'"),
    ],
)
def test_mistakes_in_it_are_told(with_zigzag, line, code, told):
    (with_zigzag.folder / "wrong.traj").write_text(f"{line}\n")
    said = with_zigzag(*CLI, "check", "wrong.traj", code=1)
    assert code in said
    assert told in said


def test_it_is_laid_out_listed_and_explained(with_zigzag):
    (with_zigzag.folder / "f.traj").write_text("zigzag   to (60,0)mm height 10mm count 4\n")
    with_zigzag(*CLI, "fmt", "f.traj")
    text = (with_zigzag.folder / "f.traj").read_text()
    assert text == "zigzag to (60, 0) mm height 10 mm count 4\n"
    assert "drawn from side to side" in with_zigzag(*CLI, "list", "statements")
    assert "a zigzag without sides" in with_zigzag(*CLI, "explain", "E266")
