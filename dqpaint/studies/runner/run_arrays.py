"""A painting -> the arrays that a study keeps besides figures, in one file by the run's key."""

import io
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from dqpaint.core import Registry
from dqpaint.errors import DqpaintError
from dqpaint.metrics import all_columns, step_curves
from dqpaint.outputs import files
from dqpaint.painting import paint, picture
from dqpaint.simulation import body_errors, check_repeats

Arrays = dict[str, NDArray[Any]]
KEEPERS: Registry[Callable[[paint.Painting], Arrays]] = Registry("thing to keep")


@KEEPERS.add("series")
def series(painting: paint.Painting) -> Arrays:
    """Time, errors and what else is kept of every control step (N,)."""
    names = [one.name for one in all_columns() if one.study and one.name in painting.table]
    return {name: np.asarray(painting.table[name]) for name in names}


@KEEPERS.add("errors")
def errors(painting: paint.Painting) -> Arrays:
    """Time and the errors that charts draw (N,), with the digits that a chart can show."""
    names = ["t_s", *(one.name for one in all_columns() if one.study == "drawn")]
    return {n: painting.table[n].astype(np.float32) for n in names if n in painting.table}


@KEEPERS.add("steps")
def steps(painting: paint.Painting) -> Arrays:
    """How many steps of the set point there were, and the way of the tool (N,) at each."""
    curves = step_curves(painting.track)
    name = painting.motion.program.line_name
    kept: Arrays = {"steps": np.array(len(curves))}
    for i, one in enumerate(curves):
        kept |= {
            f"step{i}_t": one.t, f"step{i}_angle": one.turned, f"step{i}_size": one.step,
            f"step{i}_turn": np.array(one.turn), f"step{i}_line": np.array(name(one.line)),
            **{f"step{i}_{axis}": one.moved[:, k] for k, axis in enumerate("xyz")},
        }  # fmt: skip
    return kept


CURVES = (
    "t_s", "x_m", "y_m", "z_m", "q", "invariant_error", "command", "effort_rad", "speed_m_s",
    "acceleration_m_s2", "torque", "twist_error_",
)  # fmt: skip


@KEEPERS.add("curves")
def curves(painting: paint.Painting) -> Arrays:
    """What papers show over time: poses, rates or torques, speeds, twist errors (N,)."""
    return {
        name: np.asarray(painting.table[name])
        for name in painting.table
        if name.startswith(CURVES) and "rad_s2" not in name
    }


@KEEPERS.add("trial")
def trial(painting: paint.Painting) -> Arrays:
    """What a rehearsal learns from: the errors (N, 6) along the reference, poses, clipped rows."""
    run, motion = painting.track, painting.motion
    check_repeats(motion)
    clipped = (run.unclipped != run.command) & np.isfinite(run.unclipped)  # of recordings unknown
    return {
        "t_s": motion.t, "period": np.array(motion.period), "canvas": motion.canvas,
        "eps": body_errors(motion.pose, run.pose), "pose_d": motion.pose, "pose": run.pose,
        "free": ~clipped.any(axis=1),
    }  # fmt: skip


@KEEPERS.add("light")
def light(painting: paint.Painting) -> Arrays:
    """The linear light on the sensor (H, W, 3) and the exposure, to be developed together."""
    shot = painting.picture
    image = picture.linear_image(
        painting.scene, shot.film, shot.exposure, shot.camera, painting.settings
    )
    return {"light": image, "exposure": np.array(shot.exposure)}


@KEEPERS.add("film")
def film(painting: paint.Painting) -> Arrays:
    """The bare film (3, H, W) with its guard band, what was emitted and lost, and the picture.

    `balance` is what is neither on the film nor lost, by what was emitted.
    """
    picture, film = painting.picture, painting.picture.film
    gap = np.abs(film.on_film + film.lost - film.emitted).max() / film.emitted.max()
    sums = {"emitted": film.emitted, "lost": film.lost, "balance": np.array(gap)}
    return {"planes": film.planes.astype(np.float32), "picture": picture.image, **sums}


def arrays_path(folder: Path, key: str) -> Path:
    """Where the arrays of a run lie."""
    return folder / "kept" / f"{key[:24]}.npz"


def write_arrays(painting: paint.Painting, names: tuple[str, ...], folder: Path, key: str) -> None:
    """Write what is to be kept of a run, whole or not at all.

    Raises:
        OutputError: the folder cannot be written.
    """
    arrays: Arrays = {}
    for name in names:
        arrays.update(KEEPERS[name](painting))
    file = io.BytesIO()
    np.savez(file, allow_pickle=False, **arrays)
    write_encoded(folder, key, file.getvalue())


def write_encoded(folder: Path, key: str, data: bytes) -> None:
    """Write the file of a run's arrays.

    Raises:
        OutputError: the folder cannot be written.
    """
    files.write(arrays_path(folder, key).with_suffix(""), {".npz": data})


def read_arrays(folder: Path, key: str) -> Mapping[str, NDArray[Any]]:
    """The arrays of a run by their names.

    Raises:
        DqpaintError: the file is damaged.
    """
    path = arrays_path(folder, key)
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as arrays:
            return {name: arrays[name] for name in arrays.files}
    except (OSError, ValueError, BadZipFile, EOFError, zlib.error) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else None
        raise DqpaintError(
            f"'{path}' cannot be read: {reason or 'it is damaged'}; "
            "remove it, and its run is done again"
        ) from None
