"""Documents cannot lie: README's commands, tables and links, the examples and the gallery."""

import ast
import importlib
import json
import re
import shlex
import shutil
import tomllib
from pathlib import Path

import cv2
import numpy as np
import pytest
from packaging.requirements import Requirement

import dqpaint
from dqpaint.core.examples import example_names, examples_folder, find_drawing
from dqpaint.language import parse, read
from dqpaint.language.vocabulary.words import STATEMENTS
from dqpaint.motion import plan
from dqpaint.outputs import WRITERS
from dqpaint.outputs.summary import summarise
from dqpaint.planning.reachability import reachable_start_posture
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import Card, read_card
from dqpaint.studies.gallery import page, read_shots
from dqpaint.studies.kinds.verify import table_text, verify
from tests.tools import generated

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text("utf-8")
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("*/*.md")])
LONGEST_README = 150  # lines
NUMERIC_NOISE = 2  # of 255: what another processor or build of a library may change in a pixel


def page_text(name):
    return (ROOT / name).read_text("utf-8")


def blocks(kind, text=README):
    """The blocks of a kind of a page."""
    return re.findall(rf"^```{kind}\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)


MANUAL = sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md")])
COMMANDS = {
    line.removeprefix("$ "): None
    for path in MANUAL
    if path.name != "cookbook.md"  # whose commands need each other, see test_cookbook.py
    for block in blocks("console", path.read_text("utf-8"))
    for line in block.splitlines()
    if line.startswith("$ ")
}


@pytest.mark.parametrize("page", generated.PAGES, ids=lambda p: p.parent.name)
def test_generated_tables_are_current(page, monkeypatch):
    monkeypatch.setattr(Card, "is_of_numbers", False)  # as where all files are installed
    assert generated.renewed(page) == page.read_text("utf-8"), "python -m tests.tools.generated"


def test_generated_keywords_are_current():
    for place, made in (
        (generated.OPTIONS, generated.keyword_types()),
        (generated.STUDY_OPTIONS, generated.study_keyword_types()),
    ):
        assert place.read_text("utf-8") == made, "python -m tests.tools.generated"


@pytest.mark.slow
@pytest.mark.parametrize(("page", "table"), [
    (page, table) for page, tables in generated.SLOW_TABLES.items() for table in tables
    if table is not generated.springs  # is looked at beside the tests of the compliant arm
])  # fmt: skip
def test_generated_measurements_are_current(page, table):
    renewed = generated.renewed(page, {page: [table]})
    assert renewed == page.read_text("utf-8"), "python -m tests.tools.generated"


def test_the_schema_of_summaries_is_current():
    made = generated.summary_schema()
    assert generated.RECORD.read_text("utf-8") == made, "python -m tests.tools.generated"


def test_editors_know_every_statement_as_a_method():
    assert generated.STUB.read_text("utf-8") == generated.stub(), "python -m tests.tools.generated"


@pytest.mark.parametrize("path", PAGES, ids=lambda p: p.name)
def test_links_lead_somewhere(path):
    for target in re.findall(r"\]\(([^)#\s]+)\)", path.read_text("utf-8")):
        if not target.startswith("https://"):
            assert (path.parent / target).exists(), target


def test_the_readme_names_every_format():
    light, after = page_text("docs/light.md"), page_text("docs/before-and-after.md")
    table_text = light.partition("`--save` takes")[2].partition("\n\nWith `--colour-by`")[0]
    assert all(f"`{name}`" in table_text for name in WRITERS)
    forms = sorted(one.export_name for one in WRITERS.values() if one.export_name)
    assert f"`export --format {'|'.join(forms)}`" in light + after + page_text("docs/robots.md")


def test_the_readme_shows_the_star_as_it_is():
    assert blocks("")[0] == (examples_folder() / "star.traj").read_text("utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
def test_commands_of_the_documents_run(command, answer):
    name, *words = shlex.split(command)
    assert name == "dqpaint"
    done = answer(*words)
    assert done.returncode == 0, done.stderr
    assert done.stdout


@pytest.mark.slow
def test_readme_python_runs(tmp_path, monkeypatch):
    scope = {}
    monkeypatch.chdir(tmp_path)
    exec(blocks("python")[0], scope)
    assert (tmp_path / "pictures/star-hinf.png").is_file()
    assert scope["painting"].image.shape == (720, 1280, 3)


@pytest.mark.slow
def test_readme_studies_from_python_run(tmp_path, monkeypatch):
    scope = {}
    monkeypatch.chdir(tmp_path)
    exec(blocks("python", page_text("docs/studies.md"))[0], scope)
    height, width, _ = scope["compared"].pictures["overlay"].shape
    assert (width, height > 360) == (640, True)  # with a key below
    assert (tmp_path / "pictures/lag-report.html").is_file()


def test_the_readme_shows_the_laws_as_they_are():
    shown = [(examples_folder() / name).read_text("utf-8") for name in ("mylaw.py", "pi.py")]
    assert blocks("python", page_text("docs/laws.md"))[:2] == shown


def test_the_readme_shows_the_message_as_it_is():
    from dqpaint.language import ScriptError

    with pytest.raises(ScriptError) as caught:
        parse("speed 40 mm/s\nline to (0, 0, 70)\n", "lines.traj")
    assert str(caught.value) + "\n" in blocks("")


MACHINES = {"linux": "linux", "mac": "darwin", "windows": "win32"}


def test_the_table_of_platforms_is_that_of_the_markers():
    """What pip installs on each machine, and that every Python of the classifiers is there."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    markers = {one.name: one.marker for one in map(Requirement, project["dependencies"])}
    table = README.partition("<!-- platforms -->")[2].partition("\n\n")[0].strip().splitlines()
    names, rows = (
        [cell.strip() for cell in table[0].strip("|").split("|")],
        [[cell.strip() for cell in line.strip("|").split("|")] for line in table[2:]],
    )
    seen = set()
    for machine, versions, *installed in rows:
        system, _, processor = machine.partition(" ")
        for version in versions.split(", "):
            where = {"sys_platform": MACHINES[system], "platform_machine": processor,
                     "python_version": version}  # fmt: skip
            for name, said in zip(names[2:-1], installed, strict=False):
                marker = markers[name]
                assert said == ("yes" if not marker or marker.evaluate(where) else "no"), where
            seen.add(version)
    prefix = "Programming Language :: Python :: "
    told = [one.removeprefix(prefix) for one in project["classifiers"] if one.startswith(prefix)]
    assert sorted(seen) == sorted(one for one in told if re.fullmatch(r"3\.\d+", one))


def test_the_readme_is_short():
    assert len(README.splitlines()) <= LONGEST_README


def test_readme_lines_are_single_and_ci_runs_them():
    lines = [block.strip() for block in blocks("sh")]
    assert len(lines) == 2
    assert all("\n" not in line and "-c constraints.txt" in line for line in lines)
    script = (ROOT / ".ci/run").read_text("utf-8")
    for text in re.findall(r"readme_line '(.*?)'", script):
        assert sum(text in line for line in README.splitlines()) == 1, text


@pytest.mark.parametrize("name", example_names())
def test_every_example_is_planned_and_says_what_it_shows(name):
    path = find_drawing(name)
    text = path.read_text("utf-8")
    assert text.startswith(f"# {name}.traj - ")
    motion = plan(read(path), read_card("iiwa").canvas.pose)
    assert {note.code for note in motion.notes} <= {"W403"}  # a paper's corners stay corners
    assert motion.lit.any()


@pytest.mark.parametrize("word", STATEMENTS)
def test_every_statement_s_example_is_one(word, tmp_path):
    """The example lines of the words' own table, pasted, and drawn within the arm's reach."""
    example = STATEMENTS[word].example
    before = {"end": "repeat 2\nline by (1, 0) mm\n"}
    after = "\nline by (1, 0) mm\n" if word != "end" else "\n"
    if STATEMENTS[word].block:
        after += "end\nline by (1, 0) mm\n"
    (tmp_path / "f.traj").write_text("line by (5, 0) mm\n")
    for name in ("orbit.csv", "logo.svg", "astronaut.jpg"):
        shutil.copy(examples_folder() / name, tmp_path)
    text = before.get(word, "") + example + after
    here = tmp_path / "example.traj"
    program = parse(text, str(here), here)
    motion = plan(program, read_card("iiwa").canvas.pose)
    reachable_start_posture(motion, Kinematics(read_card("iiwa")))


def test_the_gallery_s_page_is_current():
    assert (ROOT / "gallery/README.md").read_text("utf-8") == page()
    assert {shot.example for shot in read_shots()} == set(example_names())


def test_the_gallery_s_cases_are_current_and_small():
    assert generated.CASES.read_text("utf-8") == generated.cases()
    files = list(generated.CASES.parent.iterdir())
    assert {path.stem for path in files} == {"cases", *(shot.name for shot in read_shots())}
    assert sum(path.stat().st_size for path in files) < 6e6


@pytest.mark.slow
def test_the_gallery_is_what_its_references_guard():
    verdicts = verify(generated.CASES.parent)
    assert not [one for one in verdicts if one.faults], table_text(verdicts)


@pytest.mark.slow
@pytest.mark.parametrize("shot", read_shots(), ids=lambda shot: shot.name)
def test_the_gallery_is_what_its_commands_paint(shot):
    painting = dqpaint.draw(shot.example, **shot.options)
    kept = cv2.imread(str(ROOT / f"gallery/{shot.name}.png"))[..., ::-1].astype(int)
    assert np.abs(kept - painting.image).max() <= NUMERIC_NOISE, "dqpaint gallery"
    facts = json.loads((ROOT / f"gallery/{shot.name}.json").read_text("utf-8"))
    now = summarise(painting)
    assert facts["sha256"] == now["sha256"]
    assert facts["settings"] == now["settings"]
    for name in ("error_integral", "position_error_rms_m", "speed_integral_m"):
        assert facts[name] == pytest.approx(now[name], rel=1e-6)


def test_the_repository_names_no_package_index():
    for path in [*ROOT.glob("*.toml"), *ROOT.glob("*.txt"), ROOT / ".ci/run", ROOT / "README.md"]:
        assert not re.search(r"index.url|find.links|/simple/", path.read_text("utf-8")), path


def test_the_names_that_recipes_import_exist():
    recipes = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    found = re.findall(r"^```python\n(.*?)^```$", recipes, re.DOTALL | re.MULTILINE)
    imported = [
        (node.module, alias.name)
        for block in found
        for node in ast.walk(ast.parse(block))
        if isinstance(node, ast.ImportFrom) and node.module.startswith("dqpaint")
        for alias in node.names
    ]
    assert len(imported) > 15
    for module, name in imported:
        if not hasattr(importlib.import_module(module), name):
            importlib.import_module(f"{module}.{name}")
