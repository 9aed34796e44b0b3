"""A finished painting's light as a file, to be developed again without simulating.

It is NumPy's .npz: arrays that can be read with `numpy.load`, and the rest as JSON under `about`.
"""

import io
import json
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from pydantic import ValidationError

from dqpaint import __version__
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError
from dqpaint.light.emitters import Emitters
from dqpaint.light.legend import Legend
from dqpaint.light.sweep import Sweep
from dqpaint.picture import Picture, linear
from dqpaint.scene import Scene
from dqpaint.settings import Settings
from dqpaint.stage.staging import Cast

SCHEMA = "dqpaint-film-1"
GROUPS = ("light", "asked", "under")
TIFF = [cv2.IMWRITE_TIFF_COMPRESSION, 8]  # deflate


def encode(scene: Scene, settings: Settings, cast: Cast | None = None) -> bytes:
    """A scene and how it was photographed, as a file; with the arm, if the settings use it."""
    arrays: dict[str, Any] = {"front": scene.front}
    about: dict[str, Any] = {
        "schema": SCHEMA,
        "version": __version__,
        "name": scene.name,
        "settings": settings.model_dump(),
        "dimmer": scene.dimmer,
        "legend": None if scene.legend is None else vars(scene.legend),
    }
    for group in GROUPS:
        about[group] = []
        for i, sweep in enumerate(getattr(scene, group)):
            key, e = f"{group}{i}", sweep.emitters
            about[group].append(
                {
                    "period": sweep.period, "pwm": sweep.pwm, "size": e.size, "joined": e.joined,
                    "lobe": e.lobe, "strobe": sweep.strobe is not None,
                }
            )  # fmt: skip
            parts = {
                "pose": sweep.pose, "colours": sweep.colours, "places": e.places,
                "tints": e.tints, "normal": e.normal,
            }  # fmt: skip
            if sweep.strobe is not None:
                parts["strobe"] = sweep.strobe
            arrays.update({f"{key}-{name}": array for name, array in parts.items()})
    if cast is not None and settings.staged:
        about["arm"] = {"robot": cast.robot, "period": cast.period}
        arrays.update({"arm-posture": cast.posture, "arm-line": cast.line})
    arrays["about"] = np.array(json.dumps(about))
    file = io.BytesIO()
    np.savez_compressed(file, **arrays)
    return file.getvalue()


def read(path: str) -> tuple[Scene, Settings, Cast | None]:
    """The scene, the settings and, if they use it, the arm of a file that `encode` made.

    Raises:
        DqpaintError: There is none, or it is something else.
    """
    place = Path(path)
    if place.suffix in (".tiff", ".hdr"):  # the pictures that lie beside it
        place = place.with_suffix(".npz")
    try:
        with np.load(io.BytesIO(place.read_bytes()), allow_pickle=False) as arrays:
            about = json.loads(str(arrays["about"]))
            if about["schema"] != SCHEMA:
                raise ValueError(about["schema"])
            groups = [tuple(_sweeps(arrays, about, group)) for group in GROUPS]
            legend = about["legend"]
            if legend is not None:
                shades = tuple(tuple(shade) for shade in legend["colours"])
                words = tuple(legend["labels"])
                legend = Legend(legend["title"], words, shades, legend["amounts"])
            light, asked, under = groups
            front, dimmer = np.array(arrays["front"]), float(about["dimmer"])
            scene = Scene(about["name"], light, asked, under, front, legend, dimmer)
            settings = Settings.model_validate(about["settings"])
            return scene, settings, _cast(arrays, about.get("arm"), light[0])
    except OSError as problem:
        reason = problem.strerror or "it is not a film"
        raise DqpaintError(f"film '{path[:60]}' cannot be read: {reason}") from None
    except (ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile, ValidationError):
        raise DqpaintError(
            f"'{path[:60]}' is not a film of dqpaint; draw with --save film makes one"
        ) from None


def _cast(arrays: Any, facts: dict[str, Any] | None, sweep: Sweep) -> Cast | None:
    if facts is None:
        return None
    posture = np.array(arrays["arm-posture"], np.float64)
    line = np.array(arrays["arm-line"], np.int64)
    if posture.ndim != 2 or line.shape != sweep.time.shape or len(posture) != len(line):
        raise ValueError("arm")
    if not np.isfinite(posture).all():
        raise ValueError("arm")
    return Cast(str(facts["robot"]), posture, line, float(facts["period"]))


def _sweeps(arrays: Any, about: dict[str, Any], group: str) -> Iterator[Sweep]:
    for i, facts in enumerate(about[group]):

        def array(name: str, key: str = f"{group}{i}") -> Floats:
            return np.asarray(arrays[f"{key}-{name}"], dtype=np.float64)

        emitters = Emitters(
            array("places"), array("tints"), facts["size"], facts["joined"], array("normal"),
            facts["lobe"],
        )  # fmt: skip
        strobe = array("strobe") if facts["strobe"] else None
        yield Sweep(
            facts["period"], array("pose"), array("colours"), emitters, strobe, facts["pwm"]
        )


def encode_linear(scene: Scene, picture: Picture, settings: Settings, ending: str) -> bytes:
    """The linear light on the sensor as a picture file: .tiff (float, exact) or .hdr (Radiance).

    It is brought near to 1 for saturation by a power of two, which loses nothing.
    """
    image = linear(scene, picture.film, picture.exposure, picture.camera, settings, arm=picture.arm)
    stops = round(np.log2(picture.exposure) + settings.ev)
    image = image * np.float32(2.0**stops)
    options = TIFF if ending == ".tiff" else []
    done, data = cv2.imencode(ending, np.ascontiguousarray(image[..., ::-1]), options)
    if not done:
        raise DqpaintError(f"the film could not be encoded as {ending}")
    return bytes(data.tobytes())
