"""Painting -> files: pictures, tables and summaries, written whole or not at all."""

import json
import os
import platform
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dqpaint import __version__
from dqpaint.core import Registry, library_versions, stage
from dqpaint.errors import OutputError, UnknownNameError, UsageError
from dqpaint.robots.kinematics import UNITS, read_null

if TYPE_CHECKING:
    from dqpaint.metrics import Response, Table
    from dqpaint.painting import paint, picture

SCHEMA = "dqpaint-run-1"

Files = bytes | dict[str, bytes]
"""One file with the output's own ending, or several by their endings."""
Output = Callable[["paint.Painting"], Files]
OUTPUTS: Registry[Output] = Registry("output")
Told = Callable[[float], None]
Movie = Callable[["paint.Painting", Told], bytes]
MOVIES: Registry[Movie] = Registry("output")
"""Outputs that take so long that they tell how far they are."""


@OUTPUTS.add("png")
def png(painting: "paint.Painting") -> Files:
    """The pictures, one a view."""
    return pictures(painting.pictures)


def pictures(taken: "Sequence[picture.Picture]") -> Files:
    """Pictures as PNG; if there are several, each with the name of its view."""
    if len(taken) == 1:
        return taken[0].png
    return {f"-{shot.name}.png": shot.png for shot in taken}


@OUTPUTS.add("csv")
def csv(painting: "paint.Painting") -> bytes:
    """One row a control step: what was asked, what was measured, the command then given."""
    return encode_csv(painting.table)


@OUTPUTS.add("json")
def summary(painting: "paint.Painting") -> bytes:
    """What was run and what came out, in figures."""
    return (json.dumps(summarise(painting), indent=2, allow_nan=False) + "\n").encode()


@OUTPUTS.add("motion")
def motion(painting: "paint.Painting") -> bytes:
    """What was asked, with twist and acceleration: a CSV."""
    from dqpaint.metrics import motion_columns

    return encode_csv(motion_columns(painting.motion))


@OUTPUTS.add("film")
def film(painting: "paint.Painting") -> Files:
    """The light, camera and settings, to develop again, and the linear film as a float TIFF."""
    from dqpaint.painting import film_file

    scene, settings = painting.scene, painting.settings
    exact = film_file.encode_linear(scene, painting.picture, settings, ".tiff")
    worked = painting.picture.worked(settings.ghost)
    kept = film_file.encode(scene, settings, painting.cast, worked)
    return {"-film.npz": kept, "-film.tiff": exact}


@OUTPUTS.add("hdr")
def hdr(painting: "paint.Painting") -> bytes:
    """The linear film as Radiance HDR, which picture editors open."""
    from dqpaint.painting import film_file

    return film_file.encode_linear(painting.scene, painting.picture, painting.settings, ".hdr")


@MOVIES.add("video")
def video(painting: "paint.Painting", progress: Told) -> bytes:
    """The painting as it grows: VP9 in WebM."""
    from dqpaint.painting import video as movies

    with painting.staged() as staging:
        return movies.webm(painting.scene, painting.picture, painting.settings, progress, staging)


@MOVIES.add("webp")
def webp(painting: "paint.Painting", progress: Told) -> bytes:
    """The same as an animation for a page."""
    from dqpaint.painting import video as movies

    with painting.staged() as staging:
        return movies.webp(painting.scene, painting.picture, painting.settings, progress, staging)


CHUNK = 8192  # rows of a table that are written at once
SUFFIXES = {".png", ".csv", ".json", ".webm", ".webp", ".hdr"}


def choose(what: str) -> list[str]:
    """The names of a list of outputs with commas.

    Raises:
        UsageError: an unknown output, or none at all.
    """
    names = [name.strip() for name in what.split(",") if name.strip()]
    known = [*OUTPUTS, *MOVIES]
    if not names:
        raise UsageError(f"nothing to save in '{what}'; known: {', '.join(known)}")
    for name in names:
        if name not in known:
            raise UnknownNameError("output", name, known)
    return names


def make(
    names: Sequence[str], painting: "paint.Painting", progress: Told = lambda _done: None
) -> dict[str, bytes]:
    """The files of some outputs by their endings.

    Args:
        names: of the outputs, from `choose`.
        painting: what to write.
        progress: called while a movie is made, with the part done, 0 to 1.
    """
    files: dict[str, bytes] = {}
    for name in names:
        made = OUTPUTS[name](painting) if name in OUTPUTS else MOVIES[name](painting, progress)
        files.update(made if isinstance(made, dict) else {ending(name): made})
    return files


def ending(name: str) -> str:
    """How the file of an output ends, after the stem."""
    return {"motion": "-motion.csv", "video": ".webm"}.get(name, f".{name}")


def encode_csv(table: "Table") -> bytes:
    """Columns as a CSV file with 12 digits."""
    row = ",".join(["%.12g"] * len(table)) + "\n"
    parts = [",".join(table) + "\n"]
    columns = list(table.values())
    for first in range(0, len(columns[0]), CHUNK):  # text of its own size, not lists of numbers
        rows = np.stack([column[first : first + CHUNK] for column in columns], axis=1).tolist()
        parts.append("".join([row % tuple(values) for values in rows]))
    return "".join(parts).encode()


def summarise(painting: "paint.Painting") -> dict[str, Any]:
    """The JSON summary: what was run, what came out."""
    motion, film = painting.motion, painting.picture.film
    program, settings, hidden = motion.program, painting.settings, painting.picture.hidden
    return {
        "schema": SCHEMA,
        "file": Path(program.name).name,
        "included": [Path(name).name for _, name in getattr(program.text, "included", ())],
        "sha256": painting.sha256,
        "versions": {
            "dqpaint": __version__,
            "python": platform.python_version(),
            **library_versions(),
        },
        **_plugins(painting),
        "robot": painting.robot,
        "plant": painting.plant,
        "recording": painting.recording and painting.recording.as_json,
        "plant_values": painting.plant_values,
        "controller": painting.controller.name,
        "law": _law(painting),
        "gains": painting.gains,
        "disturbances": {name: one.model_dump() for name, one in painting.disturbances.items()},
        "null_space": dict(zip(("objective", "gain"), read_null(settings.null), strict=True)),
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
        "pace": _pace(painting),
        **painting.metrics.figures,
        "attenuation": {
            part: {"ratio_s": one.ratio, "bound_s": one.bound, "kept": one.kept}
            for part, one in painting.attenuation.items()
        },
        "set_points": [
            {
                "time_s": jump.time,
                "line": program.told(jump.line),
                "translation": _response(jump.translation, "m"),
                "rotation": _response(jump.rotation, "rad"),
            }
            for jump in painting.set_points
        ],
        "limits": [
            {**vars(clamp), "line": program.told(clamp.line), "unit": UNITS[clamp.kind]}
            for clamp in painting.limits
        ],
        "light": {
            "unit": "lamp seconds, linear RGB",
            "emitted": painting.picture.emitted.tolist(),
            "on_film": film.on_film.tolist(),
            "lost": film.lost.tolist(),
            "occluded": None if hidden is None else hidden.energy.tolist(),  # None: not traced
            "exposure": painting.picture.exposure,
        },
        "wall_s": {stage: round(seconds, 4) for stage, seconds in painting.seconds.items()},
    }


def _plugins(painting: "paint.Painting") -> dict[str, dict[str, str]]:
    """The packages beside dqpaint that had a part in the run, if there are any."""
    from dqpaint.painting import plugins

    found = plugins.plugins_of(painting.settings, painting.motion.program)
    return {"plugins": found} if found else {}


def _response(part: "Response", unit: str) -> dict[str, float | None]:
    return {
        f"size_{unit}": part.size,
        "settling_s": part.settling,
        "overshoot": part.overshoot,
        f"steady_error_{unit}": part.steady,
    }


def _law(painting: "paint.Painting") -> dict[str, str | None]:
    """Where a law comes from: a paper, or a file and its hash."""
    law = painting.controller
    return {
        "source": Path(law.source).name if hasattr(law.law, "sha256") else law.source,
        "sha256": getattr(law.law, "sha256", None),
        "commands": law.commands,
    }


def _pace(painting: "paint.Painting") -> dict[str, Any] | None:
    """How the drawing was slowed down; None where its clock ran as asked, come what may."""
    return None if painting.slowed is None else painting.slowed.as_json


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
    if target.exists() and not target.is_file():  # such as /dev/null
        raise OutputError(f"'{target}' is neither a folder nor a file")
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
    made: list[tuple[Path, Path]] = []
    try:
        for end, data in contents.items():
            path = stem.with_name(stem.name + end)
            made.append((stage(path, data), path))
        for _, path in made:
            if path.is_dir():
                raise OutputError(f"'{path}' cannot be written: it is a folder")
        for temporary, path in made:
            os.replace(temporary, path)
    except OSError as problem:
        raise OutputError(f"'{stem}' cannot be written: {problem.strerror}") from None
    finally:
        for temporary, _ in made:
            temporary.unlink(missing_ok=True)
    return [path for _, path in made]


def write_pictures(stem: Path, taken: "Sequence[picture.Picture]") -> list[Path]:
    """Write pictures alone, as `write` does."""
    made = pictures(taken)
    return write(stem, made if isinstance(made, dict) else {".png": made})
