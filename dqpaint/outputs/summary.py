"""A painting -> its JSON summary: settings, versions, figures."""

import platform
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dqpaint import __version__
from dqpaint.core import library_versions
from dqpaint.metrics import all_columns
from dqpaint.outputs.summary_shape import TABLE_SCHEMA, Law, Summary, TableColumn, WallShape
from dqpaint.robots.kinematics import UNITS, model_numbers, read_null
from dqpaint.robots.resolvers import task_of
from dqpaint.settings import RUN_SCHEMA

if TYPE_CHECKING:
    from dqpaint.metrics import PartResponse
    from dqpaint.painting import paint


def summarise(painting: "paint.Painting") -> dict[str, Any]:
    """The JSON summary of a painting, see `summary_shape.Summary`."""
    from dqpaint.painting import plugins

    motion, film = painting.motion, painting.picture.film
    program, settings, hidden = motion.program, painting.settings, painting.picture.occluded
    recording, placement, pace = painting.recording, painting.placement, painting.retiming
    objective, gain = read_null(settings.null)
    facts: Summary = {
        "schema": RUN_SCHEMA,
        "file": Path(program.name).name,
        "included": [Path(name).name for _, name in getattr(program.text, "included", ())],
        "sha256": painting.sha256,
        "versions": {
            "dqpaint": __version__,
            "python": platform.python_version(),
            **library_versions(),
        },
        "robot": painting.robot,
        "plant": painting.plant,
        "recording": None if recording is None else recording.as_json,
        "engine": painting.engine.name if painting.engine else None,  # None: no masses
        "plant_values": painting.plant_values,
        "controller": painting.controller.name,
        "law": _law(painting),
        "gains": painting.gains,
        "disturbances": {name: one.summary() for name, one in painting.disturbances.items()},
        "without_effect": painting.without_effect,
        "null_space": {"objective": objective, "gain": gain},
        "seed": settings.seed,
        "settings": settings.model_dump(),
        "model": model_numbers(painting.law_model),
        "drawing": {
            "samples": len(motion.t),
            "period_s": motion.period,
            "duration_s": float(motion.t[-1]),
            "length_m": motion.length,
            "box_m": motion.box.tolist(),
            "place": None if placement is None else placement.as_json,
        },
        "pace": None if pace is None else pace.as_json,  # None: --on-limit slow is not set
        "corners": None if painting.corners is None else painting.corners.as_json,
        "result": {
            "status": painting.judgement.status,
            "faults": [
                {"kind": fault.kind, "says": fault.says, "line": program.line_reference(fault.line)}
                for fault in painting.judgement.faults
            ],
        },
        "attenuation": {
            part: {
                "ratio_s": one.ratio,
                "bound_s": one.bound,
                "kept": one.bound_holds,
                "bound_in_steps_s": one.in_steps,
                "of_gammas": one.of_gammas,
            }
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
            {
                "kind": clamp.kind,
                "joint": clamp.joint,
                "start": clamp.start,
                "seconds": clamp.seconds,
                "line": program.line_reference(clamp.line),
                "limit": clamp.limit,
                "wanted": clamp.wanted,
                "unit": UNITS[clamp.kind],
            }
            for clamp in painting.limits
        ],
        "resolver": painting.resolver,
        "task": task_of(settings, program).name,
        "walls": _walls(painting),
        "light": {
            "unit": "lamp seconds, linear RGB",
            "emitted": painting.picture.emitted.tolist(),
            "on_film": film.on_film.tolist(),
            "lost": film.lost.tolist(),
            "occluded": None if hidden is None else hidden.energy.tolist(),  # None: not traced
            "exposure": painting.picture.exposure,
        },
        "table": {
            "schema": TABLE_SCHEMA,
            "rows": len(motion.t),
            "columns": _columns(painting),
        },
        "wall_s": {stage: round(seconds, 4) for stage, seconds in painting.seconds.items()},
    }
    if others := plugins.plugins_of(settings, program):
        facts["plugins"] = others
    return {**facts, **painting.metrics.figures}


def _walls(painting: "paint.Painting") -> list[WallShape]:
    """The walls of the drawing, and how near the true arm came to each."""
    among, motion = painting.track.walls, painting.motion
    if among is None:
        return []
    return [
        {
            "line": motion.program.line_reference(wall.line),
            "says": wall.text,
            "least": float(distance.min()),
            "unit": unit,
            "time_s": float(motion.t[distance.argmin()]),
            "held_s": float(active[:-1].sum() * motion.period),
        }
        for wall, unit, distance, active in zip(
            among.walls, among.units, among.distance.T, among.active.T, strict=True
        )
    ]


def _columns(painting: "paint.Painting") -> list[TableColumn]:
    """The columns that the table of a run has."""
    found: list[TableColumn] = []
    for one in all_columns():
        names = list(one.headers_for(painting.track.posture.shape[1]))
        if names and names[0] in painting.table:
            found.append({"names": names, "unit": one.unit, "meaning": one.meaning})
    return found


def _response(part: "PartResponse", unit: str) -> dict[str, float | None]:
    return {
        f"size_{unit}": part.size,
        "settling_s": part.settling,
        "overshoot": part.overshoot,
        f"steady_error_{unit}": part.steady,
    }


def _law(painting: "paint.Painting") -> Law:
    """The source of a law: a paper, or a file and its hash."""
    law = painting.controller
    return {
        "source": law.source if law.sha256 is None else Path(law.source).name,
        "sha256": law.sha256,
        "commands": law.commands,
    }
