"""A folder of drawings and references -> the cases to draw again and what they are compared with.

    cases.toml            [star-p]  drawing = "star.traj"  controller = "p"  gains = {k = 5}
    star-p.tiff           the bare linear film, float, exact
    star-p.png            the picture developed from it
    star-p.json           the figures, and what made them

Without a cases.toml each .traj of the folder is a case of its own, with the usual settings. A
drawing, a law and an arm are files of the folder, or names.
"""

import hashlib
import json
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from os.path import isdir
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dqpaint.core import library_versions, read_regular
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.light.film import PAD
from dqpaint.light.images import decode_picture, decode_planes, encode_planes
from dqpaint.settings import beside, check_code, make_settings
from dqpaint.studies.runner.run import Result, Run, drawing_text

SCHEMA = "dqpaint-reference-1"
CASES = "cases.toml"
LARGEST_TABLE, LARGEST_PICTURE = 1_000_000, 500_000_000  # bytes of a file
WIDTH, HEIGHT = 480, 270
Arrays = Mapping[str, NDArray[Any]]


@dataclass(frozen=True)
class Case:
    """One picture that is guarded."""

    name: str
    run: Run


@dataclass(frozen=True)
class Reference:
    """What is stored of a case.

    Attributes:
        facts: the JSON: figures, settings, versions, the hash of the drawing.
        planes: the film (3, H + 2 PAD, W + 2 PAD).
        picture: as it was developed (H, W, 3).
    """

    facts: dict[str, Any]
    planes: NDArray[np.float32]
    picture: NDArray[np.uint8]

    @property
    def alike(self) -> bool:
        """Whether it was made by the same versions of the libraries as are here.

        Those that it does not name took no part in it.
        """
        here = library_versions()
        return all(here.get(name) == one for name, one in self.facts["versions"].items())


def read_cases(folder: Path, trust: bool = False) -> list[Case]:
    """The cases of a folder, in the order of its cases.toml, else of their names.

    Args:
        folder: of the cases.
        trust: whether cases may name laws, plants and brushes that lie outside of the folder.

    Raises:
        DqpaintError: there is no such folder, nothing in it, or a drawing cannot be read.
        UsageError: a setting that is none, or code from elsewhere.
    """
    if not isdir(folder):
        raise DqpaintError(f"no folder '{folder}' of drawings to verify")
    table = folder / CASES
    given: dict[str, Any] = {}
    if table.is_file():
        try:
            given = tomllib.loads(read_regular(table, LARGEST_TABLE).decode("utf-8"))
        except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError, OSError) as problem:
            raise DqpaintError(f"'{table}': {problem}") from None
    else:
        given = {path.stem: {"drawing": path.name} for path in sorted(folder.glob("*.traj"))}
    if not given:
        raise DqpaintError(f"'{folder}' has neither drawings (*.traj) nor a {CASES} with some")
    return [_case(folder, name, values, trust) for name, values in given.items()]


def _case(folder: Path, name: str, values: object, trust: bool) -> Case:
    where = f"'{folder / CASES}' [{name}]"
    if not isinstance(values, dict) or not isinstance(values.get("drawing"), str):
        raise UsageError(f"{where}: a case says drawing = 'FILE.traj'")
    if Path(name).name != name or name.startswith("."):
        raise UsageError(f"{where}: a case's name is that of its files")
    choices = {word: beside(folder, value) for word, value in values.items() if word != "drawing"}
    choices = {"width": WIDTH, "height": HEIGHT, **choices}
    try:
        if not trust:
            check_code(folder, choices)
        settings = make_settings(**choices)
    except UsageError as problem:
        raise UsageError(f"{where}: {problem}") from None
    path, text = drawing_text(str(beside(folder, values["drawing"])))
    return Case(name, Run(path, text, settings, ("film",)))


def read_reference(folder: Path, case: Case) -> Reference | None:
    """The reference of a case; None if there is none yet.

    Raises:
        DqpaintError: it is damaged, or a part of it is missing.
    """
    files = {end: folder / f"{case.name}{end}" for end in (".json", ".tiff", ".png")}
    missing = [path.name for path in files.values() if not path.is_file()]
    if len(missing) == len(files):
        return None
    if missing:
        raise DqpaintError(f"'{folder}' lacks {', '.join(missing)}; --update makes it again")
    try:
        facts = json.loads(read_regular(files[".json"], LARGEST_TABLE))
        if facts["schema"] != SCHEMA or not isinstance(facts["figures"], dict):
            raise ValueError("another schema")
        facts["versions"], facts["sha256"], facts["settings"]
        planes = decode_planes(read_regular(files[".tiff"], LARGEST_PICTURE))
        picture = decode_picture(read_regular(files[".png"], LARGEST_PICTURE))
        if planes.shape[1:] != tuple(size + 2 * PAD for size in picture.shape[:2]):
            raise ValueError("film and picture differ in size")
    except (ValueError, KeyError, TypeError, RecursionError, OSError) as problem:
        said = str(problem) or type(problem).__name__
        raise DqpaintError(
            f"the reference of '{case.name}' in '{folder}' cannot be read: {said}; "
            "--update makes it again"
        ) from None
    return Reference(facts, planes, picture)


def encode_reference(case: Case, result: Result, made: Arrays, png: bytes) -> dict[str, bytes]:
    """The files of a reference by their endings."""
    facts = {
        "schema": SCHEMA,
        "file": Path(case.run.name).name,
        "sha256": sha256(case.run),
        "settings": settings_of(case.run),
        "versions": library_versions(),
        "status": result.status,
        "figures": result.figures,
        "light": {name: made[name].tolist() for name in ("emitted", "lost")},
    }
    return {
        ".json": (json.dumps(facts, indent=2, allow_nan=False) + "\n").encode(),
        ".tiff": encode_planes(made["planes"]),
        ".png": png,
    }


def settings_of(run: Run) -> dict[str, Any]:
    """The settings of a run as JSON holds them; files by their names, wherever the folder lies."""
    found: dict[str, Any] = json.loads(run.settings.model_dump_json(exclude_defaults=True))
    for name in ("controller", "robot"):
        if isinstance(found.get(name), str):
            found[name] = Path(found[name]).name
    return found


def sha256(run: Run) -> str:
    """Of the drawing."""
    return hashlib.sha256(run.text.encode()).hexdigest()
