"""A drawing or a command -> its picture and what is said, made once and kept by its hash.

The hash covers the package, so that nothing stale is shown after it was changed. What was not asked
for in a whole build is removed after it.
"""

import hashlib
import io
import json
import logging
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Mapping
from contextlib import chdir, redirect_stderr, redirect_stdout
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
GENERATED = ROOT / "docs/generated"
PICTURES = GENERATED / "pictures"
EXAMPLES = ROOT / "trajectories"


@dataclass(frozen=True)
class Made:
    """What a drawing or a command came to.

    Attributes:
        said: its findings, or what the command printed.
        picture: the name of its file in PICTURES; empty where there is none.
        code: the exit code.
    """

    said: str
    picture: str = ""
    code: int = 0


@cache
def package_hash() -> str:
    """The SHA-256 of the package, its examples and this file."""
    found = hashlib.sha256(Path(__file__).read_bytes())
    for folder in (ROOT / "dqpaint", EXAMPLES):
        for path in sorted(folder.rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                found.update(str(path.relative_to(ROOT)).encode() + b"\0" + path.read_bytes())
    return found.hexdigest()


def answer(*words: str) -> tuple[str, int]:
    """What a command prints in this process, both streams together, and its exit code."""
    from dqpaint.cli import main

    said, argv = io.StringIO(), sys.argv
    sys.argv = ["dqpaint", *words]
    logging.disable(logging.INFO)  # Sphinx would print what a run does
    try:
        with redirect_stdout(said), redirect_stderr(said):
            main.run()
    except SystemExit as stop:
        return said.getvalue(), int(stop.code or 0)
    finally:
        sys.argv = argv
        logging.disable(logging.NOTSET)
    return said.getvalue(), 0


def of_drawing(text: str, files: Mapping[str, str], options: tuple[str, ...]) -> Made:
    """A drawing: what `check` finds, and its reference picture where there is no error."""
    from dqpaint.planning.check import check

    def make(folder: Path) -> tuple[str, int, Path | None]:
        for name, data in files.items():
            (folder / name).write_text(data, "utf-8")
        (folder / "a.traj").write_text(text, "utf-8")
        found = check("a.traj")
        if found.errors:
            return found.told(brief=True), 1, None
        _, failed = answer("preview", "a.traj", *options, "--out", "a.png")
        return found.told(brief=True), 0, None if failed else folder / "a.png"

    return _kept(json.dumps(["drawing", text, dict(files), options]), make, bool(files))


def of_command(words: tuple[str, ...]) -> Made:
    """A command beside the examples: what it prints, and its picture or contact sheet."""

    def make(folder: Path) -> tuple[str, int, Path | None]:
        before = set(folder.rglob("*.png"))
        said, code = answer(*words)
        written = sorted(set(folder.rglob("*.png")) - before)
        sheets = [one for one in written if one.stem.endswith("-sheet")]
        return said, code, next(iter(sheets or written), None)

    return _kept(json.dumps(["command", *words]), make)


def _kept(
    asked: str, make: Callable[[Path], tuple[str, int, Path | None]], bare: bool = False
) -> Made:
    key = hashlib.sha256(f"{package_hash()} {asked}".encode()).hexdigest()[:24]
    record = PICTURES / f"{key}.json"
    if record.exists():
        os.utime(record)
        return Made(**json.loads(record.read_text("utf-8")))
    PICTURES.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name, chdir(name):
        folder = Path(name)
        for path in [] if bare else EXAMPLES.iterdir():
            if path.is_file():
                shutil.copy(path, folder)
        said, code, picture = make(folder)
        if picture is not None:
            shutil.copy(picture, PICTURES / f"{key}.png")
    made = Made(said, f"{key}.png" if picture else "", code)
    record.write_text(json.dumps(asdict(made)), "utf-8")
    return made


def forget_others(begin: float) -> None:
    """Remove what no page has asked for since a time."""
    for record in PICTURES.glob("*.json"):
        if record.stat().st_mtime < begin:
            record.with_suffix(".png").unlink(missing_ok=True)
            record.unlink()
