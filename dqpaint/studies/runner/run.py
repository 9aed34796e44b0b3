"""A drawing and its settings -> a run with a key, and its result; both are lines of JSON.

A run has a key, the hash of everything that decides its result: the drawing's text, the settings,
the files both name, this package's own code and the versions of its libraries. So a result that is
kept can be trusted to be what the run would give again, and a study that was stopped goes on.
"""

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cache, lru_cache
from pathlib import Path
from typing import Any, Literal

from dqpaint import __version__
from dqpaint.brushes import read_brush
from dqpaint.controllers import find_controller
from dqpaint.core import (
    choice_name,
    file_digest,
    find_drawing,
    library_versions,
    read_regular,
)
from dqpaint.disturbances import find_files, make_disturbances
from dqpaint.errors import TimeLimitError, UsageError, is_no_memory
from dqpaint.language import parse, read
from dqpaint.language.imports import files_of
from dqpaint.language.writing import builder
from dqpaint.painting import plugins, validate
from dqpaint.program import Program
from dqpaint.robots.loading import card_for
from dqpaint.settings import Settings

LARGEST_NAMED = 100_000_000  # bytes of a file that a choice names
Status = Literal["done", "oscillates", "clipped", "astray", "diverged", "failed", "died"]
"""`died`: its process or its time ended, or its machine had no room; it is tried again."""


OF_ALL = {"errors", "steps"}
"""What is kept of every run of a choice, by names in `run_arrays`; all else is of the first one."""


@dataclass(frozen=True)
class Run:
    """One painting to be made.

    Attributes:
        name: the drawing's path, or what messages call its text.
        text: of the drawing.
        settings: everything besides the text.
        keep: what is kept besides figures, by the names in `run_arrays.KEEPERS`.
    """

    name: str
    text: str
    settings: Settings
    keep: tuple[str, ...] = ()

    @property
    def data(self) -> dict[str, Any]:
        """The run as JSON would hold it."""
        settings = self.settings.model_dump(mode="json")
        return {"name": self.name, "text": self.text, "settings": settings, "keep": self.keep}

    @property
    def key(self) -> str:
        """The hash of all that decides the result."""
        data = {
            **self.data,
            "name": Path(self.name).name,
            "files": self.files(),
            "code": code_versions(),
        }
        for limit in ("timeout", "max_memory"):  # it decides whether there is a result, not which
            del data["settings"][limit]
        data["plugins"] = plugins.plugins_of(self.settings, self.program())
        return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()

    def files(self) -> dict[str, str]:
        """The hashes of files: those the drawing names, a law, an arm or an image of one's own."""
        settings = self.settings
        arm = settings.robot or ""
        brush = read_brush(settings.brush) if settings.brush else None
        return {
            **{name: _sha256(path) for name, path in _named(self.name, self.text)},
            "law": find_controller(settings.controller).sha256 or "",
            "arm": _sha256(arm) if arm.endswith((".urdf", ".toml")) else "",
            **{
                kind: file_digest(choice_name(text or ""))
                for kind, text in (("plant", settings.plant), ("brush", settings.brush))
            },
            "recorded": _sha256(settings.recorded or ""),
            "learned": _sha256(settings.learned or ""),
            **{
                f"disturb {name}": _sha256(str(values["file"]))
                for name, values in find_files(settings.disturb, Path(self.name).parent).items()
                if values.get("file")
            },
            "image": _sha256(getattr(brush, "image", "")),
        }

    def program(self) -> Program:
        """The drawing, understood; from its file where that still says the same."""
        return _program(self.name, self.text)

    def check(self) -> None:
        """Raise what is wrong with the choices, before anything is simulated.

        Raises:
            UsageError: an unknown name, a value out of its range, or an arm of a package that is
                not installed: in the journal that would outlast the installation.
            ScriptError: a mistake in the drawing.
        """
        validate.check_run(self.settings, folder=Path(self.name).parent)
        card_for(self.program(), self.settings.robot, self.settings.tool).check_installed()


def run_from_data(data: dict[str, Any]) -> Run:
    """The run that `Run.data` wrote."""
    settings = Settings.model_validate(data["settings"])
    return Run(data["name"], data["text"], settings, tuple(data["keep"]))


def drawing_text(drawing: str | builder.Drawing) -> tuple[str, str]:
    """Path and text of a drawing: a file, an example's name, or one made by calls."""
    if isinstance(drawing, builder.Drawing):
        return str(drawing.folder / f"{drawing.name}.traj"), str(drawing)
    path = find_drawing(drawing)
    return str(path), read(path).text


@dataclass(frozen=True)
class Result:
    """What came of a run.

    Attributes:
        key: of the run.
        status: `done` for a result; else what kind of fault took it out of means and tests.
        message: why it is no result.
        figures: of the summary, in SI units; none where it failed.
        limits: which limits clipped which joints on which lines; empty for none.
        without_effect: disturbances that did not move the tool, and why.
        wall: the seconds it took; not a part of any table.
    """

    key: str
    status: Status
    message: str = ""
    figures: dict[str, float] = field(default_factory=dict)
    limits: str = ""
    without_effect: dict[str, str] = field(default_factory=dict)
    wall: float = 0.0


def is_of_the_machine(fault: BaseException | None) -> bool:
    """Whether a fault comes from a full disk, memory, time or the like: another may not have it.

    A file that is missing is a fault of the run: its key changes when the file is there.
    """
    while fault is not None:
        if is_no_memory(fault) or isinstance(fault, OSError | TimeLimitError):
            return not isinstance(fault, FileNotFoundError)
        fault = fault.__cause__ or fault.__context__
    return False


def seeded(run: Run, count: int) -> list[Run]:
    """Repetitions of a run with the seeds that follow its own; the first alone keeps its picture.

    Raises:
        UsageError: there is nothing random in it.
    """
    if count < 1:
        raise UsageError(f"{count} runs; at least 1 is needed")
    if count > 1 and not _is_random(run):
        raise UsageError(
            f"{count} runs would all be the same: nothing in them is random; "
            "add a disturbance, for example --disturb twist=noise,x=0.01,y=0.01,frequency=5, "
            "or --spread posture,place"
        )
    first = run.settings.seed
    return [
        replace(
            run,
            settings=run.settings.model_copy(update={"seed": first + i}),
            keep=run.keep if i == 0 else tuple(name for name in run.keep if name in OF_ALL),
        )
        for i in range(count)
    ]


def _is_random(run: Run) -> bool:
    """Whether anything in a run differs with its seed."""
    given = make_disturbances(run.settings.disturb).values()
    return bool(run.settings.spread) or any(one.is_random for one in given)


def check_seeds(runs: Sequence[Run]) -> None:
    """Check that runs that differ in their seeds have something random in them.

    Raises:
        UsageError: they have not.
    """
    if not any(map(_is_random, runs)):
        raise UsageError(
            "the seed is varied, but nothing in these runs is random: all would be the same; add "
            "--disturb noise=0.0005 or --disturb twist=noise,x=0.01,frequency=5"
        )


def repeated(runs: Sequence[Run], count: int) -> list[list[Run]]:
    """Repetitions of each run; one among disturbed ones in which nothing is random stays alone.

    Raises:
        UsageError: there is nothing random in any.
    """
    random = [_is_random(run) for run in runs]
    counts = [count if one or not any(random) else 1 for one in random]
    return [seeded(run, of_run) for run, of_run in zip(runs, counts, strict=True)]


@lru_cache(maxsize=8)
def _program(name: str, text: str) -> Program:
    path = Path(name)
    if path.is_file():
        found = read(path)
        if found.text == text:
            return found
    return parse(text, name)


@lru_cache(maxsize=8)
def _named(name: str, text: str) -> list[tuple[str, Path]]:
    """What a drawing may read, seen from its folder; the text holds those of included files."""
    path = Path(name)
    others = sorted(files_of(path) - {path}) if text else []
    return [
        (f"./{one.relative_to(path.parent).as_posix()}", one)
        for one in others
        if one.is_relative_to(path.parent)
    ]


@cache
def code_versions() -> dict[str, str]:
    """The hash of this package's code, and the versions of its libraries."""
    package = Path(__file__).parent.parent.parent
    whole = hashlib.sha256()
    for path in sorted(package.rglob("*")):
        if path.is_file() and path.suffix != ".pyc":
            whole.update(path.relative_to(package).as_posix().encode())
            whole.update(path.read_bytes())
    return {"dqpaint": f"{__version__} {whole.hexdigest()}", **library_versions()}


def _sha256(path: str | Path) -> str:
    """The digest of a file; "" where there is none, for a text in quotes need not name a file."""
    try:
        return hashlib.sha256(read_regular(path, LARGEST_NAMED)).hexdigest()
    except OSError:
        return ""
