"""The recipes of CONTRIBUTING, carried out: a package outside the repository, as they have it."""

import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.support.plugins import install

ROOT = Path(__file__).parents[2]
RECIPES = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
TEXT = "period 10 ms\nline to (60, 20, 5) mm tool rot(y, 20 deg) in 1 s\n"
pytestmark = pytest.mark.slow


def blocks(kind):
    """The blocks of code of a language, in their order."""
    return re.findall(rf"^```{kind}\n(.*?)^```$", RECIPES, re.DOTALL | re.MULTILINE)


def files():
    """The files that the blocks say they are: name -> text; one may come in several blocks."""
    found = {}
    for block in blocks("python"):
        first, _, text = block.partition("\n")
        name = first.removeprefix("# ").strip()
        found[name] = found.get(name, "") + text
    return found


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

    def run(*words):
        done = subprocess.run(
            [sys.executable, *words], cwd=folder, env={**os.environ, "PYTHONPATH": path},
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        return done.stdout

    run.folder = folder
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
    (table,) = (outside.folder / "swept").glob("*.csv")
    for number in found:
        assert number.removeprefix("np.float64(").rstrip(")") in table.read_text()


def test_the_exported_checks_pass_on_it(outside):
    outside("check.py")
