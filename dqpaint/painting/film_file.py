"""Scene, settings and arm motion <-> a file, to be developed again without a simulation.

It is NumPy's .npz: arrays that can be read with `numpy.load`, and the rest as JSON under `about`.
"""

import errno
import io
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple
from zipfile import ZipFile

import cv2
import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from dqpaint import __version__
from dqpaint.brushes import Emitters
from dqpaint.core import read_regular
from dqpaint.diagnostics import SourceLine
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError
from dqpaint.light.images import Legend
from dqpaint.light.sources import Sweep
from dqpaint.motion import RowLines
from dqpaint.painting.picture import Picture, RenderCache, linear_image
from dqpaint.painting.scene import Scene
from dqpaint.render import ArmMotion
from dqpaint.settings import Settings

SCHEMA = "dqpaint-film-1"
GROUPS = {"light": "light", "asked": "reference", "under": "overlay"}  # in a file: of a scene
ROTATION_TOLERANCE = 1e-6  # how far a rotation may be from one
LARGEST_NUMBER = 1e6  # of any number of an array
LARGEST_FILE = 200_000_000  # bytes
LARGEST_UNPACKED = 400_000_000  # bytes of its arrays
SPARE = 1_000_000  # bytes for the heads of the arrays
LARGEST_LAMP = 10.0  # [m] as a brush's
Number = Annotated[float, Field(ge=0, le=LARGEST_NUMBER, allow_inf_nan=False)]
Part = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]
Arrays = dict[str, NDArray[Any]]
LinearColour = tuple[Number, Number, Number]


class SweepFacts(BaseModel):
    """The values of one sweep in a film file, besides its arrays."""

    model_config = ConfigDict(extra="forbid", strict=True)
    period: Annotated[float, Field(ge=1e-6, le=LARGEST_NUMBER, allow_inf_nan=False)]
    pwm: Number
    size: Annotated[float, Field(ge=0, le=LARGEST_LAMP, allow_inf_nan=False)]
    joined: Part
    lobe: Number
    strobe: bool


class LegendFacts(BaseModel):
    """The legend of a film."""

    model_config = ConfigDict(extra="forbid")
    title: str
    labels: Annotated[tuple[str, ...], Field(min_length=1)]
    colours: Annotated[tuple[LinearColour, ...], Field(min_length=1)]
    amounts: bool


class ArmFacts(BaseModel):
    """The arm of a film file."""

    model_config = ConfigDict(extra="forbid", strict=True)
    robot: str
    period: Annotated[float, Field(ge=1e-6, le=LARGEST_NUMBER, allow_inf_nan=False)]


class RenderFacts(BaseModel):
    """The rendered arm of a film file, and the occlusion it caused."""

    model_config = ConfigDict(extra="forbid")
    shares: Annotated[int, Field(ge=0)]
    remarks: tuple[str, ...]


class About(BaseModel):
    """The values of a film file besides its arrays."""

    model_config = ConfigDict(extra="forbid", populate_by_name=True)
    schema_: Literal["dqpaint-film-1"] = Field(alias="schema")
    version: str
    name: str
    settings: Settings
    dimmer: Annotated[float, Field(ge=0, le=LARGEST_NUMBER, allow_inf_nan=False)] = 1.0
    """Of films before 0.2; the legend says as much."""
    legend: LegendFacts | None
    light: Annotated[tuple[SweepFacts, ...], Field(min_length=1)]
    asked: tuple[SweepFacts, ...]
    under: tuple[SweepFacts, ...]
    exposure: Annotated[float, Field(gt=0, allow_inf_nan=False)] | None = None
    arm: ArmFacts | None = None
    shown: RenderFacts | None = None


TIFF = [cv2.IMWRITE_TIFF_COMPRESSION, 8]  # deflate


class FilmFile(NamedTuple):
    """The contents of a film file: scene, settings, the arm's motion and its rendering."""

    scene: Scene
    settings: Settings
    arm_motion: ArmMotion | None = None
    render_cache: RenderCache | None = None


def encode(
    scene: Scene,
    settings: Settings,
    arm_motion: ArmMotion | None = None,
    render_cache: RenderCache | None = None,
) -> bytes:
    """The bytes of a film file; with the arm, if its motion is known."""
    arrays: dict[str, Any] = {"front": scene.front}
    if len(scene.corners):
        arrays["corners"] = scene.corners
    about: dict[str, Any] = {
        "schema": SCHEMA,
        "version": __version__,
        "name": scene.name,
        "settings": settings.model_dump(),
        "legend": None if scene.legend is None else vars(scene.legend),
        "exposure": scene.exposure,
    }
    for group, attribute in GROUPS.items():
        about[group] = []
        for i, sweep in enumerate(getattr(scene, attribute)):
            key, e = f"{group}{i}", sweep.emitters
            about[group].append(
                {
                    "period": sweep.period, "pwm": sweep.pwm, "size": e.size, "joined": e.joined,
                    "lobe": e.lobe, "strobe": sweep.strobe is not None,
                }
            )  # fmt: skip
            parts = {
                "pose": sweep.pose, "colours": sweep.colours, "places": e.positions,
                "tints": e.tints, "normal": e.normal,
            }  # fmt: skip
            if sweep.strobe is not None:
                parts["strobe"] = sweep.strobe
            arrays.update({f"{key}-{name}": array for name, array in parts.items()})
    if arm_motion is not None and arm_motion.has_joints:
        about["arm"] = {"robot": arm_motion.robot, "period": arm_motion.period}
        arrays.update({"arm-posture": arm_motion.posture, "arm-line": arm_motion.source.line})
        if arm_motion.source.file.any():
            arrays["arm-file"] = arm_motion.source.file
    if render_cache is not None and settings.staged:
        about["shown"] = {"shares": len(render_cache.shares), "remarks": render_cache.remarks}
        arrays["shown-key"] = render_cache.key
        arrays.update({f"shown-share{i}": share for i, share in enumerate(render_cache.shares)})
        if render_cache.arm is not None:
            arrays["shown-arm"] = render_cache.arm
    arrays["about"] = np.array(json.dumps(about))
    size = sum(np.asarray(array).nbytes for array in arrays.values())
    if size > LARGEST_UNPACKED - SPARE:
        raise DqpaintError(
            f"the film would take {size / 1e6:.0f} MB, and none of more than "
            f"{LARGEST_UNPACKED // 10**6} MB is read again: a longer period makes it smaller"
        )
    file = io.BytesIO()
    np.savez_compressed(file, **arrays)
    return file.getvalue()


def read(path: str) -> FilmFile:
    """The contents of a film file that `encode` made.

    Raises:
        DqpaintError: it cannot be read, or is not a film file.
    """
    place = Path(path)
    if place.suffix in (".tiff", ".hdr"):  # the pictures beside it
        place = place.with_suffix(".npz")
    try:
        return _film(_arrays(read_regular(place, LARGEST_FILE)))
    except OSError as problem:
        raise DqpaintError(f"film '{path[:60]}' cannot be read: {problem.strerror}") from None
    except (ValueError, DqpaintError):  # among them pydantic's
        raise DqpaintError(
            f"'{path[:60]}' is not a film of dqpaint; draw with --save film makes one"
        ) from None


def _arrays(data: bytes) -> Arrays:
    """The arrays of an .npz file by their names.

    Raises:
        ValueError: it is none.
        OSError: they are too large.
    """
    try:
        with ZipFile(io.BytesIO(data)) as packed:
            size = sum(member.file_size for member in packed.infolist())
        if size <= LARGEST_UNPACKED:
            with np.load(io.BytesIO(data), allow_pickle=False) as file:
                found = dict(file)
            if any(isinstance(one, bytes) for one in found.values()):
                raise ValueError("a member that is no array")
            return found
    except Exception as problem:  # whatever numpy, zipfile and zlib make of bytes of others
        raise ValueError("no arrays") from problem
    raise OSError(errno.EFBIG, f"unpacked it is larger than {LARGEST_UNPACKED // 10**6} MB")


def _film(arrays: Arrays) -> FilmFile:
    about = About.model_validate_json(str(arrays.get("about")))
    light, reference, overlay = (
        tuple(_sweeps(arrays, group, getattr(about, group))) for group in GROUPS
    )
    legend = None if about.legend is None else Legend(**dict(about.legend))
    front = _numbers(arrays, "front")
    if front.shape != (3, 3) or np.abs(front @ front.T - np.eye(3)).max() > ROTATION_TOLERANCE:
        raise ValueError("front")
    corners = _numbers(arrays, "corners") if "corners" in arrays else np.empty((0, 3))
    if corners.ndim != 2 or corners.shape[1] != 3:
        raise ValueError("corners")
    exposure = about.exposure if len(corners) else None
    scene = Scene(about.name, light, reference, overlay, front, legend, corners, exposure)
    cast = _arm_motion(arrays, about.arm, light[0])
    return FilmFile(scene, about.settings, cast, _render_cache(arrays, about, light))


def _arm_motion(arrays: Arrays, facts: ArmFacts | None, sweep: Sweep) -> ArmMotion | None:
    if facts is None:
        return None
    posture = _numbers(arrays, "arm-posture")
    line = _array(arrays, "arm-line")
    file = arrays.get("arm-file", np.zeros_like(line))
    if posture.ndim != 2 or len(posture) != len(sweep.time):
        raise ValueError("arm")
    if any(part.dtype.kind != "i" or part.shape != sweep.time.shape for part in (line, file)):
        raise ValueError("arm")
    source = RowLines.from_lines(list(map(SourceLine, file.tolist(), line.tolist())))
    return ArmMotion(facts.robot, posture, source, facts.period)


def _render_cache(arrays: Arrays, about: About, light: tuple[Sweep, ...]) -> RenderCache | None:
    if about.shown is None:
        return None
    key = _numbers(arrays, "shown-key")
    arm = _numbers(arrays, "shown-arm") if "shown-arm" in arrays else None
    shares = tuple(_numbers(arrays, f"shown-share{i}") for i in range(about.shown.shares))
    size = (about.settings.height, about.settings.width, 3)
    if key.shape != (18,) or (arm is not None and (arm.shape != size or arm.min() < 0.0)):
        raise ValueError("shown")
    if shares and len(shares) != len(light):
        raise ValueError("shown")
    for share, sweep in zip(shares, light, strict=False):
        if share.ndim != 2 or len(share) != len(sweep.colours) or not share.shape[1]:
            raise ValueError("share")
        if share.min() < 0.0 or share.max() > 1.0:
            raise ValueError("share")
    seen = None if arm is None else arm.astype(np.float32)
    return RenderCache(key, about.settings.ghost, seen, shares, about.shown.remarks)


def _array(arrays: Arrays, name: str) -> NDArray[Any]:
    if name not in arrays:
        raise ValueError(f"no array {name}")
    return arrays[name]


def _numbers(arrays: Arrays, name: str) -> Floats:
    """An array of a file as floats, each of which a picture can come from."""
    array = _array(arrays, name)
    if array.dtype.kind != "f" or not (np.abs(array) <= LARGEST_NUMBER).all():
        raise ValueError(name)
    return np.asarray(array, dtype=np.float64)


def _sweeps(arrays: Arrays, group: str, sweeps: tuple[SweepFacts, ...]) -> Iterator[Sweep]:
    for i, facts in enumerate(sweeps):

        def array(name: str, key: str = f"{group}{i}") -> Floats:
            return _numbers(arrays, f"{key}-{name}")

        emitters = Emitters(
            array("places"), array("tints"), facts.size, facts.joined, array("normal"),
            facts.lobe,
        )  # fmt: skip
        strobe = array("strobe") if facts.strobe else None
        colours = array("colours")
        sweep = Sweep(facts.period, array("pose"), colours, emitters, strobe, facts.pwm)
        if (np.abs(np.linalg.norm(sweep.rotations, axis=1) - 1) > ROTATION_TOLERANCE).any():
            raise ValueError("pose")
        yield sweep


def encode_linear(scene: Scene, picture: Picture, settings: Settings, ending: str) -> bytes:
    """The linear light on the sensor as a picture file: .tiff (float, exact) or .hdr (Radiance).

    It is scaled by a power of two, so that saturation is near 1 and no bit is lost.
    """
    image = linear_image(
        scene, picture.film, picture.exposure, picture.camera, settings, arm=picture.arm
    )
    stops = round(np.log2(picture.exposure) + settings.ev)
    image = image * np.float32(2.0**stops)
    options = TIFF if ending == ".tiff" else []
    done, data = cv2.imencode(ending, np.ascontiguousarray(image[..., ::-1]), options)
    if not done:
        raise DqpaintError(f"the film could not be encoded as {ending}")
    return bytes(data.tobytes())
