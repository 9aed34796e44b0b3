"""Painting -> files: pictures, tables and summaries, written whole or not at all."""

import hashlib
import json
import os
import platform
import tempfile
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dqpaint import __version__
from dqpaint.errors import OutputError, UsageError
from dqpaint.registry import Registry
from dqpaint.robots.limits import UNITS

if TYPE_CHECKING:
    from dqpaint.metrics import Table  # they bring in the simulator, and types need none
    from dqpaint.paint import Painting
    from dqpaint.set_points import Response

SCHEMA = "dqpaint-run-1"
LIBRARIES = ("numpy", "opencv-python-headless", "pin", "pybullet")

Output = Callable[["Painting"], bytes]
OUTPUTS: Registry[Output] = Registry("output")


@OUTPUTS.add("png")
def png(painting: "Painting") -> bytes:
    """The picture."""
    return painting.picture.png


@OUTPUTS.add("csv")
def csv(painting: "Painting") -> bytes:
    """One row a control step: what was asked, what was measured, the command then given."""
    return encode_csv(painting.table)


@OUTPUTS.add("json")
def summary(painting: "Painting") -> bytes:
    """What was run and what came out, in figures."""
    return (json.dumps(summarise(painting), indent=2, allow_nan=False) + "\n").encode()


@OUTPUTS.add("motion")
def motion(painting: "Painting") -> bytes:
    """What was asked, with twist and acceleration: a CSV."""
    from dqpaint.metrics import motion_columns

    return encode_csv(motion_columns(painting.motion))


CHUNK = 8192  # rows of a table that are written at once
SUFFIXES = {".png", ".csv", ".json"}


def choose(what: str) -> dict[str, Output]:
    """The outputs of a list with commas, by the endings of their files.

    Raises:
        UsageError: an unknown output, or none at all.
    """
    names = [name.strip() for name in what.split(",") if name.strip()]
    if not names:
        raise UsageError(f"nothing to save in '{what}'; known: {', '.join(OUTPUTS)}")
    return {ending(name): OUTPUTS[name] for name in names}


def ending(name: str) -> str:
    """How the file of an output ends, after the stem."""
    return "-motion.csv" if name == "motion" else f".{name}"


def encode_csv(table: "Table") -> bytes:
    """Columns as a CSV file with 12 digits."""
    row = ",".join(["%.12g"] * len(table)) + "\n"
    parts = [",".join(table) + "\n"]
    columns = list(table.values())
    for first in range(0, len(columns[0]), CHUNK):  # text of its own size, not lists of numbers
        rows = np.stack([column[first : first + CHUNK] for column in columns], axis=1).tolist()
        parts.append("".join([row % tuple(values) for values in rows]))
    return "".join(parts).encode()


def summarise(painting: "Painting") -> dict[str, Any]:
    """The JSON summary: what was run, what came out."""
    motion, film = painting.motion, painting.picture.film
    program, settings = motion.program, painting.settings
    return {
        "schema": SCHEMA,
        "file": Path(program.name).name,
        "sha256": hashlib.sha256(program.text.encode()).hexdigest(),
        "versions": {
            "dqpaint": __version__,
            "python": platform.python_version(),
            **{name: version(name) for name in LIBRARIES},
        },
        "robot": painting.robot,
        "plant": painting.plant,
        "recording": painting.recording and painting.recording.as_json,
        "controller": painting.controller.name,
        "law": _law(painting),
        "gains": painting.gains,
        "disturbances": settings.disturb,
        "seed": settings.seed,
        "settings": settings.model_dump(),
        "drawing": {
            "samples": len(motion.t),
            "period_s": motion.period,
            "duration_s": float(motion.t[-1]),
            "length_m": motion.length,
            "box_m": motion.box.tolist(),
            "place": painting.placed and painting.placed.as_json,
        },
        **painting.metrics.figures,
        "attenuation": {
            part: {"ratio_s": one.ratio, "bound_s": one.bound, "kept": one.kept}
            for part, one in painting.attenuation.items()
        },
        "set_points": [
            {
                "time_s": jump.time,
                "line": jump.line,
                "translation": _response(jump.translation, "m"),
                "rotation": _response(jump.rotation, "rad"),
            }
            for jump in painting.set_points
        ],
        "limits": [{**vars(clamp), "unit": UNITS[clamp.kind]} for clamp in painting.limits],
        "light": {
            "unit": "lamp seconds, linear RGB",
            "emitted": film.emitted.tolist(),
            "on_film": film.on_film.tolist(),
            "lost": film.lost.tolist(),
            "occluded": None,  # the arm's own shadow is not traced in this version
            "exposure": painting.picture.exposure,
        },
        "wall_s": {stage: round(seconds, 4) for stage, seconds in painting.seconds.items()},
    }


def _response(part: "Response", unit: str) -> dict[str, float | None]:
    return {
        f"size_{unit}": part.size,
        "settling_s": part.settling,
        "overshoot": part.overshoot,
        f"steady_error_{unit}": part.steady,
    }


def _law(painting: "Painting") -> dict[str, str | None]:
    """Where a law comes from: a paper, or a file and its hash."""
    law = painting.controller
    return {
        "source": Path(law.source).name if hasattr(law.law, "sha256") else law.source,
        "sha256": getattr(law.law, "sha256", None),
        "commands": law.commands,
    }


def stem_for(out: str | None, name: str) -> Path:
    """The path of the files to write, without their endings.

    Args:
        out: a folder (that exists, or ends with a slash) or a stem; None is the current folder.
        name: of the files, where `out` is a folder.

    Raises:
        OutputError: the folder does not exist or cannot be written.
    """
    try:
        stem, folder = _stem_and_folder(out, name)
        with tempfile.TemporaryFile(dir=folder):
            return stem
    except (OSError, ValueError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else str(problem)
        raise OutputError(f"'{(out or '.')[:60]}' cannot be written: {reason}") from None


def _stem_and_folder(out: str | None, name: str) -> tuple[Path, Path]:
    if not out:
        return Path(name), Path()
    target = Path(out)
    if out.endswith(("/", os.sep)):
        target.mkdir(parents=True, exist_ok=True)
    if target.is_dir():
        return target / name, target
    if target.suffix in SUFFIXES:  # `--out star.png` names the picture, and its stem
        target = target.with_suffix("")
    if target.parent.exists() and not target.parent.is_dir():
        raise OutputError(f"'{target.parent}' is a file, not a folder")
    if not target.parent.is_dir():
        made = "a path that ends with / is made"
        raise OutputError(f"folder '{target.parent}' does not exist; {made}")
    return target, target.parent


def write(stem: Path, contents: dict[str, bytes]) -> list[Path]:
    """Write files beside each other: each is made whole beside its place, then all move in.

    Args:
        stem: path without endings.
        contents: the bytes of each file by its ending.

    Raises:
        OutputError: a file could not be written; every file there is whole, the old or the new one.
    """
    made: list[tuple[str, Path]] = []
    try:
        for end, data in contents.items():
            handle, temporary = tempfile.mkstemp(
                prefix=".dqpaint-", suffix=".part", dir=stem.parent
            )
            made.append((temporary, stem.with_name(stem.name + end)))
            with os.fdopen(handle, "wb") as file:
                file.write(data)
            os.chmod(temporary, 0o666 & ~_umask())
        for _, path in made:
            if path.is_dir():
                raise OutputError(f"'{path}' cannot be written: it is a folder")
        for temporary, path in made:
            os.replace(temporary, path)
    except OSError as problem:
        raise OutputError(f"'{stem}' cannot be written: {problem.strerror}") from None
    finally:
        for temporary, _ in made:
            Path(temporary).unlink(missing_ok=True)
    return [path for _, path in made]


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
