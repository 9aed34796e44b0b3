"""This machine -> what works on it: versions, engines, extras, cores, colour.

Libraries are really imported: one that is installed may still be broken.
"""

import json
import os
import platform
import re
import sys
from collections.abc import Sequence
from typing import Annotated, Any, NamedTuple

import typer

from dqpaint import __version__
from dqpaint.cli.front.colours import GREEN, RED, labels, paint, show, takes_colour
from dqpaint.cli.front.help_pages import Page

EXAMPLES = "Examples:\n\n  dqpaint doctor\n\n  dqpaint doctor --json"
OK, MISSING = "ok", "missing"
PLUGGED = ("controllers", "plants", "disturbances", "brushes", "robots", "metrics", "formats",
           "studies")  # fmt: skip


class Library(NamedTuple):
    """A library that is looked for.

    Attributes:
        module: as it is imported.
        packages: distributions that may bring it.
        serves: what needs it.
    """

    module: str
    packages: tuple[str, ...]
    serves: str


ENGINES = (
    Library("pybullet", ("pybullet", "pybullet-arm64"), "plants with masses"),
    Library("mujoco", ("mujoco-core", "mujoco"), "plants with masses"),
)
"""Physics engines: a line each."""

LIBRARIES = (
    Library("numpy", ("numpy",), "everything"),
    Library("pydantic", ("pydantic",), "settings"),
    Library("pinocchio", ("pin",), "arms: kinematics and dynamics"),
    Library("coal", ("coal",), "distances and lines of sight"),
    Library("cv2", ("opencv-python-headless", "opencv-python"), "pictures"),
    Library("scipy", ("scipy",), "studies"),
    Library("matplotlib", ("matplotlib",), "charts of studies"),
    Library("jinja2", ("jinja2",), "pages of studies"),
)


class Found(NamedTuple):
    """What a library turned out to be.

    Attributes:
        name: of its module.
        version: as installed; empty where it is not.
        fault: why it cannot be used; empty where it can.
        serves: what needs it.
    """

    name: str
    version: str
    fault: str
    serves: str


class Ability(NamedTuple):
    """Something dqpaint does, and the modules that it needs."""

    command: str
    needs: tuple[str, ...]
    engine: bool = False


ABILITIES = (
    Ability("check, fmt, explain, new", ("numpy",)),
    Ability("preview", ("numpy", "pydantic", "pinocchio", "cv2")),
    Ability("draw --plant ideal, check --robot", ("numpy", "pydantic", "pinocchio", "cv2")),
    Ability("draw, export", ("numpy", "pydantic", "pinocchio", "coal", "cv2"), engine=True),
    Ability("compare, sweep, tune, replay",
            ("numpy", "pydantic", "pinocchio", "coal", "cv2", "scipy", "matplotlib", "jinja2"),
            engine=True),
)  # fmt: skip


def add_to(app: typer.Typer) -> None:
    """Add the command to an application."""
    app.command(cls=Page, epilog=EXAMPLES, rich_help_panel="Set up")(doctor)


def doctor(
    as_json: Annotated[bool, typer.Option("--json", help="as JSON, for programs")] = False,
) -> None:
    """Tell what works on this machine: versions, engines, extras, cores, colour.

    The exit code is 1 if dqpaint draw cannot work.
    """
    report = examine()
    if as_json:
        print(json.dumps(report, indent=2))
    else:
        show(as_text(report), painter=_painted)
    if not report["works"]["draw, export"]:
        raise typer.Exit(1)


def examine() -> dict[str, Any]:
    """All that is told, as JSON has it."""
    engines, libraries = look_for(ENGINES), look_for(LIBRARIES)
    usable = {one.name for one in (*engines, *libraries) if not one.fault}
    engine = any(one.name in usable for one in engines)
    return {
        "dqpaint": __version__,
        "python": f"{platform.python_version()} ({sys.executable})",
        "platform": f"{platform.system()} {platform.machine()}",
        "cores": cores(),
        "engines": [one._asdict() for one in engines],
        "libraries": [one._asdict() for one in libraries],
        "extras": extras(),
        "plugins": plugins(),
        "terminal": terminal(),
        "works": {
            one.command: usable.issuperset(one.needs) and (engine or not one.engine)
            for one in ABILITIES
        },
    }


def look_for(wanted: Sequence[Library]) -> list[Found]:
    """Import libraries, each in a process of its own: one that is broken ends that one alone."""
    import subprocess
    from importlib.util import find_spec

    started = {
        one: subprocess.Popen(
            [sys.executable, "-c", f"import {one.module}"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
        )
        for one in wanted
        if find_spec(one.module)
    }  # fmt: skip
    found = []
    for one in wanted:
        fault = f"pip install {one.packages[0]}"
        if one in started:
            said = started[one].communicate()[1].strip()
            code = started[one].returncode
            last = said.splitlines()[-1][:200] if said else f"its import ended with {code}"
            fault = f"it cannot be imported: {last}" if code else ""
        found.append(Found(one.module, _version(one.packages), fault, one.serves))
    return found


def _version(packages: Sequence[str]) -> str:
    from importlib.metadata import PackageNotFoundError, version

    for package in packages:
        try:
            return version(package)
        except PackageNotFoundError:
            continue
    return ""


def extras() -> dict[str, list[str]]:
    """The extras of this package, each with the packages that it lacks."""
    from importlib.metadata import PackageNotFoundError, requires

    try:
        declared = requires("dqpaint") or []
    except PackageNotFoundError:  # from a source tree that is not installed
        return {}
    lacking: dict[str, list[str]] = {}
    for line in declared:
        extra = re.search(r"extra\s*==\s*[\"']([\w.-]+)[\"']", line)
        name = re.match(r"[\w.-]+", line)
        if extra and name:
            lacks = lacking.setdefault(extra[1], [])
            if not _version([name[0]]) and name[0] != "dqpaint":
                lacks.append(name[0])
    return lacking


def plugins() -> list[str]:
    """Packages that bring laws, plants and the like."""
    from importlib.metadata import entry_points

    return sorted({
        f"{one.dist.name} {one.dist.version}"
        for kind in PLUGGED
        for one in entry_points(group=f"dqpaint.{kind}")
        if one.dist
    })  # fmt: skip


def cores() -> int:
    """The cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def terminal() -> str:
    """How output will look."""
    import shutil

    from dqpaint.cli.terminal import shows_pictures

    if not sys.stdout.isatty():
        return "not a terminal: no colours"
    columns = f"{shutil.get_terminal_size().columns} columns"
    if not takes_colour(sys.stdout):
        why = "NO_COLOR" if os.environ.get("NO_COLOR") else f"TERM={os.environ.get('TERM', '')}"
        return f"{columns}, no colours ({why})"
    pictures = "with" if shows_pictures(sys.stdout) else "without"
    return f"{columns}, colours, {pictures} pictures (COLORTERM=truecolor)"


def as_text(report: dict[str, Any]) -> str:
    """The report as a table."""
    from dqpaint.cli.terminal import table

    def rows(heading: str, lines: list[str]) -> list[tuple[str, str]]:
        return [("" if i else heading, line) for i, line in enumerate(lines)]

    found = {kind: [Found(**one) for one in report[kind]] for kind in ("engines", "libraries")}
    of_names = max(len(one.name) for every in found.values() for one in every)

    def lines(kind: str) -> list[str]:
        return [
            f"{one.name:<{of_names}}  {one.version or '-':<10} "
            + (f"{MISSING}: {one.fault} (for {one.serves})" if one.fault else OK)
            for one in found[kind]
        ]

    works = {True: OK, False: MISSING}
    wide = max(len(name) for name in report["works"])
    return table([
        ("dqpaint", report["dqpaint"]),
        ("Python", report["python"]),
        ("platform", f"{report['platform']}, {report['cores']} cores"),
        ("terminal", report["terminal"]),
        *rows("engines", lines("engines")),
        *rows("libraries", lines("libraries")),
        *rows("extras", [
            f"{name:<10} " + (f"{MISSING}: {', '.join(lacks)}" if lacks else OK)
            for name, lacks in report["extras"].items()
        ] or ["not known: dqpaint is not installed as a package"]),
        *rows("plugins", report["plugins"] or ["none"]),
        *rows("works", [f"{name:<{wide}}  {works[yes]}" for name, yes in report["works"].items()]),
    ])  # fmt: skip


def _painted(text: str) -> str:
    text = re.sub(rf"(?<=  ){OK}$|(?<= ){OK}$", paint(OK, GREEN), text, flags=re.MULTILINE)
    return labels(re.sub(rf"\b{MISSING}(?=:|$)", paint(MISSING, RED), text, flags=re.MULTILINE))
