"""Findings for GitHub and code scanners, and the commands that need few libraries."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from dqpaint.diagnostics import Annotation, github_commands, sarif_log
from dqpaint.planning import check as checking

ROOT = Path(__file__).parents[2]
BAD = "lin to (0, 0) mm\nline to (0, 0, 70)\n"


@pytest.fixture
def bad(tmp_path):
    (tmp_path / "bad.traj").write_text(BAD)
    (tmp_path / "good one.traj").write_text("line to (30, 10) mm in 400 ms\n")
    return tmp_path


def test_github_shows_each_finding_at_its_place(answer, bad):
    done = answer("check", "bad.traj", "gone.traj", "good one.traj", "--format", "github")
    assert done.returncode == 1
    lines = done.stdout.splitlines()
    assert len(lines) == 3
    assert lines[0].startswith(
        "::error file=bad.traj,title=dqpaint E120,line=1,col=1,endLine=1,endColumn=4::"
    )
    assert "line=2" in lines[1]
    assert lines[2].startswith("::error file=gone.traj,title=dqpaint E001::")


def test_a_text_does_not_end_a_command_of_github():
    one = Annotation("a,b:c.traj", "warning", "W1", "100 %\n::error::x", "", (1, 2))
    said = github_commands([one])
    assert said == (
        "::warning file=a%2Cb%3Ac.traj,title=dqpaint W1,line=1,col=2::100 %25%0A::error::x"
    )


# What the standard (OASIS SARIF 2.1.0, sections 3.13 to 3.30) allows of each object we write, and
# what it demands; an object has nothing else.
STRUCTURE = {
    "log": ({"$schema": str, "version": str, "runs": ["run"]}, {"version", "runs"}),
    "run": ({"tool": "tool", "columnKind": str, "results": ["result"]}, {"tool"}),
    "tool": ({"driver": "driver"}, {"driver"}),
    "driver": ({"name": str, "semanticVersion": str, "rules": ["rule"]}, {"name"}),
    "rule": ({"id": str, "shortDescription": "message"}, {"id"}),
    "message": ({"text": str}, {"text"}),
    "result": (
        {
            "ruleId": str, "ruleIndex": int, "level": str, "message": "message",
            "locations": ["location"],
        },
        {"message"},
    ),
    "location": ({"physicalLocation": "place"}, set()),
    "place": ({"artifactLocation": "artifact", "region": "region"}, set()),
    "artifact": ({"uri": str}, set()),
    "region": (dict.fromkeys(("startLine", "startColumn", "endLine", "endColumn"), int), set()),
}  # fmt: skip


def check_structure(thing, kind):
    if isinstance(kind, list):
        assert isinstance(thing, list)
        for one in thing:
            check_structure(one, kind[0])
    elif isinstance(kind, type):
        assert isinstance(thing, kind)
        assert kind is not int or thing >= 0
    else:
        allowed, demanded = STRUCTURE[kind]
        assert demanded <= thing.keys() <= allowed.keys(), (kind, thing.keys())
        for key, value in thing.items():
            check_structure(value, allowed[key])


def test_sarif_has_the_published_structure(answer, bad):
    done = answer("check", "bad.traj", "gone.traj", "good one.traj", "--format", "sarif")
    assert done.returncode == 1
    log = json.loads(done.stdout)
    check_structure(log, "log")
    assert log["version"] == "2.1.0"
    (run,) = log["runs"]
    assert run["columnKind"] == "unicodeCodePoints"
    rules = run["tool"]["driver"]["rules"]
    for result in run["results"]:
        assert rules[result["ruleIndex"]]["id"] == result["ruleId"]
        assert result["level"] in ("none", "note", "warning", "error")
        region = result["locations"][0]["physicalLocation"].get("region", {"startLine": 1})
        assert all(number >= 1 for number in region.values())
    assert [one["ruleId"] for one in run["results"]] == ["E120", "E218", "E001"]


def test_sarif_names_files_as_addresses():
    found = [Annotation(file, "note", "W1", "x") for file in ("a b/ä.traj", str(ROOT / "x.traj"))]
    (run,) = sarif_log(found, {}, "1")["runs"]
    places = [one["locations"][0]["physicalLocation"] for one in run["results"]]
    assert places[0] == {"artifactLocation": {"uri": "a%20b/%C3%A4.traj"}}
    assert places[1]["artifactLocation"]["uri"].startswith("file:///")


def test_annotations_are_of_the_file_that_is_at_fault(tmp_path):
    (tmp_path / "part.traj").write_text("\n\nlin to (0, 0) mm\n")
    (tmp_path / "main.traj").write_text('include "part.traj"\n')
    found = checking.annotations([checking.check(str(tmp_path / "main.traj"))])
    assert [(Path(one.file).name, one.begin) for one in found] == [("part.traj", (3, 1))]


def test_an_unknown_form_is_refused(answer, bad):
    done = answer("check", "bad.traj", "--format", "sarf")
    assert done.returncode == 2
    assert "'sarif'?" in done.stderr


@pytest.mark.slow
def test_verify_has_forms_too(dqpaint, tmp_path):
    (tmp_path / "all").mkdir()
    (tmp_path / "all/line.traj").write_text("line to (30, 10) mm in 400 ms\n")
    done = dqpaint("verify", "all", "--format", "github", "--jobs", "1")
    assert done.returncode == 1
    assert re.match(r"::error file=\S*line\.traj,title=dqpaint verify::line: ", done.stdout)
    done = dqpaint("verify", "all", "--format", "sarif", "--jobs", "1")
    check_structure(json.loads(done.stdout), "log")


BLOCKED = """
import sys
class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in %r:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
sys.meta_path.insert(0, Absent())
sys.argv[0] = "dqpaint"
from dqpaint.cli import main
main.run()
"""
HEAVY = {"cv2", "pinocchio", "coal", "eigenpy", "pybullet", "mujoco", "scipy", "matplotlib",
         "jinja2", "pygls"}  # fmt: skip


@pytest.mark.parametrize(
    "words",
    [["check", "bad.traj"], ["check", "star"], ["fmt", "good one.traj"], ["explain", "E120"],
     ["new", "wish"], ["grammar"], ["--help"]],
)  # fmt: skip
def test_a_light_install_is_enough(words, bad):
    done = subprocess.run(
        [sys.executable, "-c", BLOCKED % (HEAVY,), *words], cwd=bad, capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)}, check=False,
    )  # fmt: skip
    assert "internal error" not in done.stderr
    assert "No module" not in done.stderr
    assert done.returncode == (1 if "bad.traj" in words else 0)
    assert done.stdout


def test_hooks_and_action_call_commands_that_are_there(answer):
    hooks = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())
    assert {hook["id"] for hook in hooks} == {"dqpaint-check", "dqpaint-fmt"}
    for hook in hooks:
        program, command, *options = hook["entry"].split()
        assert program == "dqpaint"
        page = answer(command, "--help").stdout
        assert all(option in page for option in options)
        assert re.search(hook["files"], "drawings/star.traj")
    action = yaml.safe_load((ROOT / "action.yml").read_text())
    used = set(re.findall(r"inputs\.(\w+)", json.dumps(action["runs"])))
    assert used == set(action["inputs"])
    script = action["runs"]["steps"][-1]["run"]
    assert "inputs." not in script  # they come as variables: nothing in them is run
    subprocess.run(["bash", "-n", "-c", script], check=True)
