"""A motion out of an arm's reach -> changes that make it reachable, each tried before.

Each change is made to the poses that were asked, and the arm is led along them. What is tried last,
as it takes longest, is tried only where nothing before it helps.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dqpaint.core import replaced
from dqpaint.motion import Motion, plan, scaled, straight
from dqpaint.planning.ideal_run import can_draw
from dqpaint.planning.placement import TRIED_SCALES, can_be_placed
from dqpaint.program import Screw
from dqpaint.robots.kinematics import DEFAULT_OBJECTIVE, PATH_TOLERANCE, Kinematics, least_errors
from dqpaint.robots.model import installed_names, read_card
from dqpaint.settings import Settings

SMALLER_SCALES = np.arange(0.95, 0.05, -0.05)
SMALLER_ANGLES = (315, 270, 225, 180, 135, 90, 60, 45, 30, 15)  # [deg] of a screw
HUGE = 5.0  # [m]: a drawing of this size has metres where millimetres are meant
NO_SUGGESTION = (
    "no smaller scale, other place, straight tool or other arm helps: draw it another way"
)


def suggest(
    motion: Motion, kinematics: Kinematics, rows: NDArray[np.intp], null: str = DEFAULT_OBJECTIVE
) -> str:
    """Changes to the drawing, each of which removes the error.

    Args:
        motion: that leaves the reach.
        kinematics: of the arm.
        rows: of the motion that are out of reach.
        null: what the arm does with its freedom.
    """
    if motion.box.max() > HUGE and _draws(scaled(motion, 1e-3), kinematics, rows, null):
        return "in millimetres it is reached: (100, 0) mm; numbers of Python are metres: (0.1, 0)"
    settings = Settings(null=null)
    said = []
    scale = _reachable_scale(motion, kinematics, rows, null)
    if scale is not None:
        said.append(f"make it smaller: with scale {scale:.2g} ... end")
    if can_be_placed(motion, kinematics, settings):
        said.append("move it: place auto finds room")
    held = straight(motion)
    if held is not None and _draws(held, kinematics, rows, null):
        said.append("hold the tool straight: without 'tool' it is reached")
    angle = _reachable_angle(motion, kinematics, rows, null)
    if angle:
        said.append(f"a screw turns the tool with it: with angle {angle} deg it is reached")
    return "; or ".join(said) or next(
        _costly_suggestions(motion, held, kinematics, rows, settings), NO_SUGGESTION
    )


def _reachable_scale(
    motion: Motion, kinematics: Kinematics, rows: NDArray[np.intp], null: str
) -> float | None:
    """The largest scale about the drawing's origin at which the arm draws all of it."""
    poses = np.concatenate([scaled(motion, scale).pose[rows] for scale in SMALLER_SCALES])
    reached = (least_errors(kinematics, poses) < PATH_TOLERANCE).reshape(
        len(SMALLER_SCALES), len(rows)
    )
    for scale in SMALLER_SCALES[reached.all(axis=1)]:
        if can_draw(scaled(motion, scale), kinematics, null):
            return float(scale)
    return None


def _reachable_angle(
    motion: Motion, kinematics: Kinematics, rows: NDArray[np.intp], null: str
) -> int:
    """The largest angle [deg] of the first screw out of reach with which it is reached; 0: none.

    The drawing is looked at up to there.
    """
    number = int(motion.stroke[rows.min()])
    segments = motion.program.segments
    path = segments[number].path
    if not isinstance(path, Screw):
        return 0
    for degrees in SMALLER_ANGLES:
        part = np.radians(degrees) / abs(path.angle)
        if part >= 1.0:
            continue
        less = replaced(path, angle=part * path.angle, advance=part * path.advance)
        shorter = (*segments[:number], replaced(segments[number], path=less))
        tried = plan(replace(motion.program, segments=shorter), motion.canvas)
        if can_draw(tried, kinematics, null):
            return int(np.copysign(degrees, path.angle))
    return 0


def _costly_suggestions(
    motion: Motion,
    held: Motion | None,
    kinematics: Kinematics,
    rows: NDArray[np.intp],
    settings: Settings,
) -> Iterator[str]:
    """Suggestions where no single change helps: two changes at once, or another arm."""
    for scale in TRIED_SCALES:
        if can_be_placed(scaled(motion, scale), kinematics, settings):
            yield f"make it smaller and move it: with scale {scale:g} ... end, and place auto"
    if held is not None and can_be_placed(held, kinematics, settings):
        yield "hold the tool straight, without 'tool', and move it: place auto finds room"
    for name in installed_names():
        if name == kinematics.card.name:
            continue
        arm = Kinematics(read_card(name))
        if _draws(plan(motion.program, arm.card.canvas.pose), arm, rows, settings.null):
            yield f"take another arm: {name} reaches it"


def _draws(motion: Motion, kinematics: Kinematics, rows: NDArray[np.intp], null: str) -> bool:
    """Whether an arm can draw a motion; a few rows are looked at first, which is quicker."""
    reached = least_errors(kinematics, motion.pose[rows]) < PATH_TOLERANCE
    return bool(reached.all()) and can_draw(motion, kinematics, null)
