"""Where the arm begins a drawing; what is said of one that leaves its reach."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.language.diagnostics import Diagnostic, ScriptError
from dqpaint.motion import Motion
from dqpaint.nullspace import DEFAULT_NULL, make_pull
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.reach import Miss, Start, find_start, to_start, waypoints

if TYPE_CHECKING:
    from dqpaint.tracking import Track  # brings in the simulator, and a forecast needs none

WORTH_A_LOOK = 1e-3  # [m]
LOOKS = 9  # at a stroke, for its farthest point
WORTH_SAYING = np.radians(0.5)
SCALES = np.arange(0.95, 0.05, -0.05)


def begin(motion: Motion, kinematics: Kinematics, null: str = DEFAULT_NULL) -> Start:
    """The posture that leaves the most margin over the whole drawing.

    Args:
        motion: what is asked.
        kinematics: of the arm.
        null: what the arm does with its freedom.

    Raises:
        ScriptError: the drawing leaves the arm's reach, wherever it begins.
    """
    rows = waypoints(motion.stroke)
    pull = to_start if null == DEFAULT_NULL else make_pull(null, kinematics)
    found = find_start(kinematics, motion.pose[rows], motion.t[rows], pull)
    if isinstance(found, Miss):
        raise out_of_reach(motion, kinematics, int(rows[found.index]), found)
    return found


def check_worst(track: "Track", kinematics: Kinematics) -> None:
    """Look again where a run strayed most: the forecast sees a drawing at some of its rows alone.

    A pose that is out of reach keeps the arm at least as far away as its shortfall.

    Raises:
        ScriptError: no posture reaches the pose of that row.
    """
    row = worst_row(track)
    if row is not None:
        check_row(track.motion, kinematics, row)


def worst_row(track: "Track") -> int | None:
    """Where a run strayed most; None if that is not worth a look."""
    stray = np.linalg.norm(track.points - track.motion.points, axis=1)
    row = int(np.argmax(stray))
    return row if stray[row] >= WORTH_A_LOOK else None


def check_row(motion: Motion, kinematics: Kinematics, row: int) -> None:
    """See that the arm reaches the pose of a row.

    Raises:
        ScriptError: no posture does.
    """
    found = find_start(kinematics, motion.pose[row : row + 1], motion.t[row : row + 1])
    if isinstance(found, Miss):
        raise out_of_reach(motion, kinematics, row, found)


def out_of_reach(motion: Motion, kinematics: Kinematics, row: int, miss: Miss) -> ScriptError:
    """The error for a stroke of the motion, one of whose rows no posture reaches."""
    program = motion.program
    segment = program.segments[int(motion.stroke[row])]
    row, miss = _farthest(motion, kinematics, row, miss)
    name = kinematics.card.name
    far, turned = miss.shortfall * 1e3, np.degrees(miss.turned)
    if far < 0.5 and miss.turned > WORTH_SAYING:
        fault = f"can be reached by {name} only with the tool turned by {turned:.0f} deg"
    elif miss.turned > WORTH_SAYING:
        fault = f"is {far:.0f} mm and {turned:.0f} deg outside the reach of {name}"
    else:
        fault = f"is {far:.0f} mm outside the reach of {name}"
    problem = Diagnostic(
        "E310",
        f"sample {row} ({motion.t[row]:.2f} s) {fault}",
        segment.span,
        label="farthest point of this stroke",
        help=_advice(motion, kinematics, row),
    )
    return ScriptError(program.name, program.text, (problem,))


def _farthest(motion: Motion, kinematics: Kinematics, row: int, miss: Miss) -> tuple[int, Miss]:
    """Of some rows of the same stroke the one that is missed most."""
    stroke = np.flatnonzero(motion.stroke == motion.stroke[row])
    for other in np.linspace(stroke[0], stroke[-1], LOOKS).astype(int):
        found = find_start(kinematics, motion.pose[other : other + 1], np.zeros(1))
        if isinstance(found, Miss) and found.badness > miss.badness:
            row, miss = int(other), found
    return row, miss


def _advice(motion: Motion, kinematics: Kinematics, row: int) -> str:
    """A scale about the drawing's origin at which the arm reaches all of it, if there is one."""
    rows = waypoints(motion.stroke)
    local = dq.mul(dq.conj(motion.canvas), motion.pose)
    places, turns = dq.translation(local), dq.rotation(local)

    def reached(scale: float, these: NDArray[np.intp]) -> bool:
        poses = dq.mul(motion.canvas, dq.pose_from(scale * places[these], turns[these]))
        return isinstance(find_start(kinematics, poses, motion.t[these]), Start)

    worst = np.array([row])
    for scale in SCALES:  # the worst point first: it is soon answered
        if reached(scale, worst) and reached(scale, np.unique(np.append(rows, row))):
            return (
                f"shift the drawing with place, or make it smaller: with scale {scale:.2g} ... end"
            )
    return "shift the drawing with place, or turn the tool another way"
