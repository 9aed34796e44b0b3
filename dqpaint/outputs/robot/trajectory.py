"""A painting's run -> a joint trajectory: times, angles, rates and a description."""

import hashlib
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from dqpaint import __version__
from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.outputs.registry import WRITERS, Need, Writer

if TYPE_CHECKING:
    from dqpaint.painting import paint
    from dqpaint.robots.kinematics import Kinematics


@dataclass(frozen=True, repr=False)
class Trajectory:
    """The joint motion of a run, for a real arm; it begins and ends at rest.

    Attributes:
        name: of the drawing.
        robot: the arm's.
        joints: their names (n), as the arm's description has them.
        base: the arm's base link.
        period: between two rows [s].
        t: times (N,) [s], from 0.
        positions: joint angles (N, n) [rad].
        velocities: joint rates (N, n) [rad/s], differences about each row; none at both ends.
        about: lines that describe the file.
    """

    name: str
    robot: str
    joints: tuple[str, ...]
    base: str
    period: float
    t: Floats
    positions: Floats
    velocities: Floats
    about: tuple[str, ...]


T = TypeVar("T")

CAUTION = (
    "Simulated, and found within the arm's limits of position, speed and torque.",
    "Nothing here looks after people or machines: clear the space, and watch the first run slowly.",
    "Go to the first posture before you begin: the arm must be there, and at rest, at t = 0.",
)


def for_arm(
    name: str,
    ending: str,
    *needs: Need,
    export_name: str | None = None,
    made_of: "Callable[[paint.Painting], T] | None" = None,
) -> Callable[[Callable[[T], str]], Callable[[T], str]]:
    """A decorator that registers the function below it as a writer of `draw` and of `export`.

    Its file is written beside the cue sheet of the light, for a simulated run within the limits of
    its arm.

    Args:
        name: as `draw --save` takes it.
        ending: of its file, after the stem.
        needs: what it needs besides.
        export_name: as `export --format` takes it, if that is not `name`.
        made_of: what the function is given, from the painting: else its `Trajectory`.
    """
    prepared: Callable[[Any], Any] = made_of or trajectory_of

    def record(function: Callable[[T], str]) -> Callable[[T], str]:
        def written(painting: "paint.Painting") -> dict[str, bytes]:
            from dqpaint.outputs.robot.light_cues import cue_sheet

            made = prepared(painting)
            cues = cue_sheet(painting.motion, trajectory_of(painting).about[:1])
            return {ending: function(made).encode(), "-cues.csv": cues.encode()}

        written.__doc__ = function.__doc__
        every = (SIMULATED, *needs, WITHIN_LIMITS)
        WRITERS.add(name)(Writer(name, ending, written, every, export_name or name))
        return function

    return record


def _check_simulated(run: "paint.PreparedRun | paint.Painting") -> None:
    if run.recording is not None:
        raise UsageError("a recorded run is not exported: it comes from an arm")


def _check_limits(painting: "paint.Painting") -> None:
    from dqpaint.outputs.robot.limit_check import check_limits

    check_limits(painting)


SIMULATED = Need("a simulated run", _check_simulated, before=True)
WITHIN_LIMITS = Need("a run from rest to rest within the limits of its arm", _check_limits)


def trajectory_of(painting: "paint.Painting") -> Trajectory:
    """The joint trajectory of a painting's simulated run."""
    model = kinematics_of(painting).model
    motion, posture = painting.motion, painting.track.posture
    velocities = np.zeros_like(posture)
    velocities[1:-1] = (posture[2:] - posture[:-2]) / (2 * motion.period)
    drawing = motion.program
    digest = hashlib.sha256(drawing.text.encode()).hexdigest()
    about = (
        f"{Path(drawing.name).name} (sha256 {digest[:16]}), as dqpaint {__version__} ran it on "
        f"{painting.robot}, plant {painting.plant}, law {painting.controller.name}.",
        f"{len(motion.t)} points, one every {motion.period * 1e3:g} ms, "
        f"{motion.t[-1]:.9g} s in all; angles in rad.",
        *CAUTION,
    )
    return Trajectory(
        name=Path(drawing.name).stem,
        robot=painting.robot,
        joints=tuple(model.names)[1:],
        base=model.frames[1].name,
        period=motion.period,
        t=motion.t,
        positions=posture,
        velocities=velocities,
        about=about,
    )


def kinematics_of(run: "paint.PreparedRun | paint.Painting") -> "Kinematics":
    """The kinematics of a run's arm."""
    from dqpaint.robots.kinematics import Kinematics
    from dqpaint.robots.loading import card_for

    settings = run.settings
    return Kinematics(card_for(run.motion.program, settings.robot, settings.tool))


def program_name(drawing: str, longest: int | None = None) -> str:
    """The name of a drawing as a controller's language has names; cut where that has a limit."""
    return ("dqpaint_" + re.sub(r"\W", "_", drawing, flags=re.ASCII))[:longest]


def comment_lines(about: tuple[str, ...], mark: str = "#") -> str:
    """Comment lines; most formats accept those of #."""
    return "".join(f"{mark} {line}\n" for line in about)
