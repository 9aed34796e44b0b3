"""The house: modules in one written order, imports upstream only, each library behind its door."""

import ast
import re
import sys
from functools import cache
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parent.parent / "dqpaint"

# Data moves down this list and never up. A folder's modules may import each other.
ORDER = [
    "errors",
    "files",
    "registry",
    "choices",
    "examples",
    "papers",
    "dq",
    "language",
    "build",
    "formatting",
    "catalogue",
    "motion",
    "robots",
    "plants",
    "disturbances",
    "controllers",
    "nullspace",
    "driving",
    "sensing",
    "stopping",
    "slowing",
    "tracking",
    "recorded",
    "metrics",
    "attenuation",
    "set_points",
    "settings",
    "light",
    "stage",
    "shining",
    "telling",
    "scene",
    "settings_file",
    "picture",
    "sketch",
    "hiding",
    "changes",
    "following",
    "forecast",
    "placing",
    "advice",
    "out_of_reach",
    "paint",
    "negative",
    "video",
    "outputs",
    "exports",
    "terminal",
    "report",
    "posing",
    "forewarning",
    "checking",
    "editors",
    "listing",
    "starter",
    "api",
    "charts",
    "studies",
    "gallery",
    "cli_options",
    "cli_language",
    "cli_arm",
    "watching",
    "cli",
    "studying",
    "answering",
    "__main__",
]

DOORS = {
    "pinocchio": ["robots/kinematics.py", "robots/dynamics.py", "robots/collisions.py"],
    "coal": ["robots/collisions.py"],
    "eigenpy": ["robots/inverse.py"],
    "pybullet": ["plants/bullet.py"],
    "matplotlib": ["charts.py"],
    "cv2": ["light", "stage", "picture.py", "negative.py", "video.py"],
    "scipy": ["studies/tune.py"],
    "distributed": ["studies/cluster.py"],
    "svgelements": ["language/drawings.py"],
    "typer": ["cli.py", "cli_options.py", "cli_language.py", "cli_arm.py", "studying.py"],
    "pygments": ["editors/highlighting.py"],
    "pygls": ["editors/server.py"],
    "lsprotocol": ["editors/server.py"],
    "pydantic": [
        "robots/card.py",
        "robots/chain.py",
        "robots/files.py",
        "robots/parts.py",
        "choices.py",
        "disturbances",
        "nullspace.py",
        "plants/compliant.py",
        "plants/plant.py",
        "controllers",
        "settings.py",
        "light/brushes.py",
        "negative.py",
        "papers",
    ],
}
EVERYWHERE = {"numpy", "dqpaint", "typing_extensions"}
LONGEST = 400  # lines of one file

FILES = sorted(PACKAGE.rglob("*.py"))


parsed = cache(ast.parse)


def imports(path):
    """The module of every import of a file."""
    for node in ast.walk(parsed(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: a relative import"
            if node.module == "dqpaint":  # from dqpaint import dq
                names = [alias.name for alias in node.names if alias.name != "__version__"]
                yield from (f"dqpaint.{name}" for name in names)
            else:
                yield node.module


def room(path):
    parts = path.relative_to(PACKAGE).parts
    return parts[0].removesuffix(".py")


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_imports_go_upstream_only(path):
    if room(path) == "__init__":
        return  # the public names are loaded on first use
    here = ORDER.index(room(path))
    for module in imports(path):
        if module.startswith("dqpaint."):
            there = module.split(".")[1]
            assert ORDER.index(there) <= here, f"{path.name} imports {module}"


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_each_library_has_its_door(path):
    name = str(path.relative_to(PACKAGE))
    for module in imports(path):
        library = module.split(".")[0]
        if library in sys.stdlib_module_names or library in EVERYWHERE:
            continue
        assert library in DOORS, f"{name} imports {library}, which has no door"
        assert any(name.startswith(door) for door in DOORS[library]), f"{name} imports {library}"


def test_the_order_names_every_room_and_no_other():
    rooms = {room(path) for path in FILES} - {"__init__"}
    assert rooms == set(ORDER)


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_files_are_short_and_say_what_they_are(path):
    text = path.read_text("utf-8")
    assert len(text.splitlines()) <= LONGEST
    assert ast.get_docstring(parsed(text)), "no docstring"


def test_a_code_means_one_thing():
    """Each diagnostic code belongs to one room."""
    rooms = {}
    for path in FILES:
        for code in re.findall(r'"([EW]\d{3})"', path.read_text("utf-8")):
            rooms.setdefault(code, set()).add(room(path))
    assert len(rooms) > 60
    assert not {code: where for code, where in rooms.items() if len(where) > 1}


def test_no_attic():
    for path in FILES:
        assert path.stem not in {"utils", "helpers", "common", "misc", "manager"}


def test_public_names_are_real():
    import dqpaint

    assert all(callable(getattr(dqpaint, name)) for name in dqpaint.__all__)
    with pytest.raises(AttributeError, match="no attribute 'paintings'"):
        dqpaint.paintings  # noqa: B018
