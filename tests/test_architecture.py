"""The house: contracts that hold and can break, rooms entered by their faces, files of one idea."""

import ast
import re
import shutil
import subprocess
import sys
import tomllib
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "dqpaint"
FILES = sorted(PACKAGE.rglob("*.py"))
FOLDERS = sorted({path.parent for path in FILES})
ROOMS = sorted(path.name for path in PACKAGE.iterdir() if (path / "__init__.py").is_file())
MOST_ROOMS, MOST_LOOSE_FILES, MOST_FILES, MOST_LINES = 24, 6, 14, 500

CONTRACTS = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"]
BREAKS = {
    "data moves down this list and never up": ("motion/summary.py", "dqpaint.robots.model"),
    "inside language": ("language/vocabulary/units.py", "dqpaint.language.expansion.expander"),
    "inside light": ("light/camera/views.py", "dqpaint.light.film.film"),
    "inside robots": ("robots/model/screws.py", "dqpaint.robots.urdf.tree"),
    "inside studies": ("studies/runner/run.py", "dqpaint.studies.report.page"),
    "light knows no robot": ("light/film/develop.py", "dqpaint.robots.model.card"),
    "the door to pinocchio": ("plants/ideal.py", "pinocchio"),
    "the door to pybullet": ("plants/stiff.py", "pybullet"),
    "the door to daqp": ("motion/plan.py", "daqp"),
    "the door to mujoco": ("plants/rigid_arm.py", "mujoco"),
    "the door to cv2": ("motion/plan.py", "cv2"),
    "the door to pillow": ("motion/plan.py", "PIL"),
    "the door to mcap": ("motion/plan.py", "mcap"),
    "the door to typer": ("planning/check.py", "typer"),
    "the door to matplotlib": ("studies/kinds/sweep.py", "matplotlib"),
    "the door to jinja2": ("studies/report/page.py", "jinja2"),
    "the door to the studio's page": ("studio/folder.py", "nicegui"),
    "the doors of editors and clusters": ("cli/language.py", "pygls"),
}
"""Contract -> a file and an import in it that breaks that contract."""

parsed = cache(lambda path: ast.parse(path.read_text("utf-8")))


def verdicts(folder):
    """The verdict of import-linter on the package in a folder, by contract."""
    said = subprocess.run(
        [sys.executable, "-c", "from importlinter.cli import lint_imports_command as c; c()",
         "--no-cache"],
        cwd=folder, env={"PYTHONPATH": str(folder), "COLUMNS": "200"}, capture_output=True,
        text=True, check=False,
    ).stdout  # fmt: skip
    return dict(re.findall(r"^(.+?) (KEPT|BROKEN)(?: \(.*\))?$", said, re.MULTILINE))


@pytest.mark.slow
def test_contracts_hold_and_each_can_break(tmp_path):
    names = [contract["name"] for contract in CONTRACTS["contracts"]]
    assert verdicts(ROOT) == dict.fromkeys(names, "KEPT")

    assert set(BREAKS) == set(names)
    copy = tmp_path / "dqpaint"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    for file, module in BREAKS.values():
        with (copy / file).open("a", encoding="utf-8") as text:
            text.write(f"\nimport {module}\n")
    assert verdicts(tmp_path) == dict.fromkeys(names, "BROKEN")


def face(package):
    """What a folder's first page names."""
    path = PACKAGE.joinpath(*package.split(".")[1:], "__init__.py")
    if not path.is_file():
        return None  # a module
    for node in parsed(path).body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__all__":
            return set(ast.literal_eval(node.value))
    return set()


def bypasses(path):
    """The imports of a file that enter another room by a window."""
    room = path.relative_to(PACKAGE).parts[0]
    for node in ast.walk(parsed(path)):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names if alias.name.startswith("dqpaint")]
            yield from names
        elif isinstance(node, ast.ImportFrom) and node.module.startswith("dqpaint."):
            other = node.module.split(".")[1]
            if other in ROOMS and other != room:
                named = face(node.module)
                names = {alias.name for alias in node.names}
                if named is None or not names <= named:
                    yield f"{node.module}: {', '.join(sorted(names - (named or set())))}"


@pytest.mark.parametrize(
    "path",
    [path for path in FILES if path.parent != PACKAGE or path.name == "api.py"],
    ids=lambda p: str(p.relative_to(PACKAGE)),
)
def test_other_rooms_are_entered_by_their_faces(path):
    assert not list(bypasses(path))


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda p: str(p.relative_to(ROOT)))
def test_first_pages_say_what_comes_in_and_what_goes_out(folder):
    first = ast.get_docstring(parsed(folder / "__init__.py"))
    assert first
    assert "->" in first, "say what comes in and what goes out"


def test_a_face_names_what_is_there():
    import importlib

    for folder in FOLDERS:
        package = ".".join(folder.relative_to(ROOT).parts)
        for name in face(package) or ():
            module = importlib.import_module(package)
            if not hasattr(module, name):
                importlib.import_module(f"{package}.{name}")


def test_the_package_is_small_at_the_top():
    assert len(ROOMS) <= MOST_ROOMS
    assert len(list(PACKAGE.glob("*.py"))) <= MOST_LOOSE_FILES


def test_large_files_and_folders_say_why():
    page = (ROOT / "docs/architecture.md").read_text("utf-8")
    for folder in FOLDERS:
        if len(list(folder.glob("*.py"))) > MOST_FILES:
            assert f"`{folder.relative_to(ROOT)}/`" in page
    for path in FILES:
        if len(path.read_text("utf-8").splitlines()) > MOST_LINES:
            assert f"`{path.relative_to(ROOT)}`" in page


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_files_say_what_they_are(path):
    assert ast.get_docstring(parsed(path)), "no docstring"
    assert path.stem not in {"utils", "helpers", "common", "misc", "manager"}
    for node in ast.walk(parsed(path)):
        assert not (isinstance(node, ast.ImportFrom) and node.level), "a relative import"


def test_a_code_means_one_thing():
    """Each diagnostic code belongs to one room."""
    rooms = {}
    for path in FILES:
        for code in re.findall(r'"([EW]\d{3})"', path.read_text("utf-8")):
            rooms.setdefault(code, set()).add(path.relative_to(PACKAGE).parts[0])
    assert len(rooms) > 60
    assert not {code: where for code, where in rooms.items() if len(where) > 1}


TESTS = sorted((ROOT / "tests").rglob("*.py"))
RUN_ON_PURPOSE = {
    "tests.tools": {
        "test_documents.py",
        "test_security.py",
        "test_snapshots.py",
        "plants/test_compliant_loop.py",
        "studies/test_statistics.py",
    },
    "tests.bench": set(),
}
"""Programs of their own -> the tests that run them, to see that what they make is current."""


def imported(path):
    """The modules a test file imports, also in the programs that it holds as texts."""
    text = path.read_text("utf-8")
    found = set(re.findall(r"\b(?:from|import) ((?:tests|dqpaint)\b[\w.]*)", text))
    for names in re.findall(r"\bfrom dqpaint import ([\w, ]+)", text):
        found |= {f"dqpaint.{name}" for name in re.findall(r"\w+", names.split(" as ")[0])}
    return found - {f"dqpaint.{name}" for name in face("dqpaint") | {"__version__"}}


def is_there(module):
    file = ROOT.joinpath(*module.split("."))
    return file.is_dir() or file.with_suffix(".py").is_file()


def test_no_test_imports_a_test():
    for path in TESTS:
        name = str(path.relative_to(ROOT / "tests"))
        for module in imported(path):
            said = f"{name}: {module}"
            assert is_there(module), said
            assert not re.search(r"\.(test_\w+|conftest)(\.|$)", module), said
            program = ".".join(module.split(".")[:2])
            if program in RUN_ON_PURPOSE and name.split("/")[0] != program.split(".")[1]:
                assert name in RUN_ON_PURPOSE[program], said


def test_public_names_are_real():
    import dqpaint

    assert all(callable(getattr(dqpaint, name)) for name in dqpaint.__all__)
    with pytest.raises(AttributeError, match="no attribute 'paintings'"):
        dqpaint.paintings  # noqa: B018


@pytest.mark.parametrize("page", ["docs/architecture.md", "CONTRIBUTING.md"])
def test_files_that_pages_name_are_there(page):
    text = (ROOT / page).read_text("utf-8")
    for name in set(re.findall(r"`((?:dqpaint|tests|docs)/[\w./-]+\.\w+)`", text)):
        assert (ROOT / name).is_file(), name


def test_the_table_of_rooms_has_them_in_the_order_of_the_contract():
    page = (ROOT / "docs/architecture.md").read_text("utf-8")
    rows = [set(re.findall(r"`(\w+)`", row)) for row in page.splitlines() if row[:3] == "| `"]
    layers = CONTRACTS["contracts"][0]["layers"]
    order = [set(re.findall(r"dqpaint\.(\w+)", layer)) for layer in reversed(layers)]
    assert (
        set().union(*rows) == set().union(*order) == {*ROOMS, "dq", "errors", "clean_stream", "api"}
    )
    place = {name: i for i, layer in enumerate(order) for name in layer}
    places = [place[name] for row in rows for name in sorted(row, key=place.get)]
    assert places == sorted(places)
