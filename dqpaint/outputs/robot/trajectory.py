"""A painting's run as a joint trajectory: times, angles, rates, and a few words about it."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from dqpaint import __version__
from dqpaint.core import Folder, Registry
from dqpaint.dq import Floats
from dqpaint.painting import paint
from dqpaint.robots.kinematics import Kinematics


@dataclass(frozen=True, repr=False)
class Trajectory:
    """What an arm did, to be done again; it begins and ends at rest.

    Attributes:
        name: of the drawing.
        robot: the arm's.
        joints: their names (n), as the arm's description has them.
        base: the link the arm stands on.
        period: between two rows [s].
        t: times (N,) [s], from 0.
        positions: joint angles (N, n) [rad].
        velocities: joint rates (N, n) [rad/s], differences about each row; none at both ends.
        about: what the file is, a line each.
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


class ExportFile(NamedTuple):
    """A file: how its name ends, and its text."""

    ending: str
    text: str


Format = Callable[[Trajectory], ExportFile]
FORMATS: Registry[Format] = Folder("format", "dqpaint.outputs.robot")

CAUTION = (
    "Simulated, and found within the arm's limits of position, speed and torque.",
    "Nothing here looks after people or machines: clear the space, and watch the first run slowly.",
    "Go to the first posture before you begin: the arm must be there, and at rest, at t = 0.",
)


def trajectory_of(painting: paint.Painting, kinematics: Kinematics) -> Trajectory:
    """What the arm of a painting did.

    Args:
        painting: of a simulated run.
        kinematics: of the arm that did it.
    """
    motion, posture = painting.motion, painting.track.posture
    velocities = np.zeros_like(posture)
    velocities[1:-1] = (posture[2:] - posture[:-2]) / (2 * motion.period)
    model = kinematics.model
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


def commented(about: tuple[str, ...]) -> str:
    """Lines that every one of the formats takes for a comment."""
    return "".join(f"# {line}\n" for line in about)
