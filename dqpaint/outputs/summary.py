"""A painting -> its JSON summary: settings, versions, figures."""

import platform
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dqpaint import __version__
from dqpaint.core import library_versions
from dqpaint.robots.kinematics import UNITS, read_null

if TYPE_CHECKING:
    from dqpaint.metrics import PartResponse
    from dqpaint.painting import paint

SCHEMA = "dqpaint-run-1"


def summarise(painting: "paint.Painting") -> dict[str, Any]:
    """The JSON summary of a painting."""
    motion, film = painting.motion, painting.picture.film
    program, settings, hidden = motion.program, painting.settings, painting.picture.occluded
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
            "place": painting.placement and painting.placement.as_json,
        },
        "pace": _retiming(painting),
        **painting.metrics.figures,
        "attenuation": {
            part: {"ratio_s": one.ratio, "bound_s": one.bound, "kept": one.bound_holds}
            for part, one in painting.attenuation.items()
        },
        "set_points": [
            {
                "time_s": jump.time,
                "line": program.line_reference(jump.line),
                "translation": _response(jump.translation, "m"),
                "rotation": _response(jump.rotation, "rad"),
            }
            for jump in painting.step_responses
        ],
        "limits": [
            {**vars(clamp), "line": program.line_reference(clamp.line), "unit": UNITS[clamp.kind]}
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
    """The packages besides dqpaint that take part in the run, if there are any."""
    from dqpaint.painting import plugins

    found = plugins.plugins_of(painting.settings, painting.motion.program)
    return {"plugins": found} if found else {}


def _response(part: "PartResponse", unit: str) -> dict[str, float | None]:
    return {
        f"size_{unit}": part.size,
        "settling_s": part.settling,
        "overshoot": part.overshoot,
        f"steady_error_{unit}": part.steady,
    }


def _law(painting: "paint.Painting") -> dict[str, str | None]:
    """The source of a law: a paper, or a file and its hash."""
    law = painting.controller
    return {
        "source": law.source if law.sha256 is None else Path(law.source).name,
        "sha256": law.sha256,
        "commands": law.commands,
    }


def _retiming(painting: "paint.Painting") -> dict[str, Any] | None:
    """How the drawing was slowed down; None where `--on-limit slow` is not set."""
    return None if painting.retiming is None else painting.retiming.as_json
