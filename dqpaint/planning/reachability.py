"""Motion x arm -> the start posture, or an error that names the lines out of reach."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dqpaint.diagnostics import Diagnostic, ScriptError
from dqpaint.motion import Motion
from dqpaint.planning.ideal_run import find_start_posture
from dqpaint.planning.suggestions import suggest
from dqpaint.robots.kinematics import (
    DEFAULT_OBJECTIVE,
    PATH_TOLERANCE,
    Kinematics,
    NoPosture,
    StartPosture,
    least_errors,
    shortfall,
    waypoints,
)

if TYPE_CHECKING:
    from dqpaint.simulation import Track

ROWS_A_STROKE, MOST_ROWS = 9, 96  # at a stroke, for its farthest point; at a drawing
MOST_MESSAGES, MOST_NAMED = 5, 6  # lines with a message of their own; further ones by their numbers
LEAST_ANGLE_SHOWN = np.radians(0.5)


@dataclass(frozen=True)
class Unreachable:
    """A point of a line that leaves the reach: its row of the motion, and by how much.

    `miss` is None where it was not worked out; `alone` is whether no posture reaches the point at
    all, or only none on the way of the drawing.
    """

    row: int
    miss: NoPosture | None = None
    alone: bool = True


def reachable_start_posture(
    motion: Motion, kinematics: Kinematics, null: str = DEFAULT_OBJECTIVE
) -> StartPosture:
    """The start posture with the most joint margin over the whole drawing.

    Args:
        motion: what is asked.
        kinematics: of the arm.
        null: what the arm does with its freedom.

    Raises:
        ScriptError: the drawing leaves the arm's reach, wherever it begins.
    """
    found = find_start_posture(motion, kinematics, null)
    if isinstance(found, StartPosture) and found.margin >= 0:
        return found
    rows = waypoints(motion.stroke)
    outside = _find_unreachable(motion, kinematics, rows)
    if outside:
        raise reach_error(motion, kinematics, outside, null)
    if isinstance(found, NoPosture):
        at = Unreachable(int(rows[found.index]), found, alone=found.index == 0)
        raise reach_error(motion, kinematics, [at], null)
    return found


def check_largest_error(
    track: "Track", kinematics: Kinematics, null: str = DEFAULT_OBJECTIVE
) -> None:
    """Check the reach at a run's largest path error: the forecast looks at some rows only.

    A pose that is out of reach keeps the arm at least as far away as its shortfall.

    Raises:
        ScriptError: no posture reaches the pose of that row.
    """
    row = largest_error_row(track)
    if row is not None:
        check_row_reached(track.motion, kinematics, row, null)


def largest_error_row(track: "Track") -> int | None:
    """The row of a run's largest path error; None if that is small."""
    stray = np.linalg.norm(track.points - track.motion.points, axis=1)
    row = int(np.argmax(stray))
    return row if stray[row] >= PATH_TOLERANCE else None


def check_row_reached(
    motion: Motion, kinematics: Kinematics, row: int, null: str = DEFAULT_OBJECTIVE
) -> None:
    """Check that the arm reaches the pose of a row.

    Raises:
        ScriptError: no posture does; it names all lines that are out of reach.
    """
    if least_errors(kinematics, motion.pose[row : row + 1])[0] >= PATH_TOLERANCE:
        rows = np.unique(np.append(waypoints(motion.stroke), row))
        outside = _find_unreachable(motion, kinematics, rows)
        if outside:
            raise reach_error(motion, kinematics, outside, null)


def _find_unreachable(
    motion: Motion, kinematics: Kinematics, rows: NDArray[np.intp]
) -> list[Unreachable]:
    """The lines of which no posture reaches all, in order; looked at in some rows and between."""
    strokes = np.unique(motion.stroke[rows])
    looks = min(ROWS_A_STROKE, max(2, MOST_ROWS // len(strokes)))
    for stroke in strokes:
        its = np.flatnonzero(motion.stroke == stroke)
        rows = np.append(rows, its[np.linspace(0, len(its) - 1, looks).astype(int)])
    rows = np.unique(rows)
    left = least_errors(kinematics, motion.pose[rows])
    beyond = np.flatnonzero(left >= PATH_TOLERANCE)
    found: list[Unreachable] = []
    source = motion.source.index[rows[beyond]]
    for line in np.unique(source):
        its = beyond[source == line]
        worst = its[left[its].argmax()]
        if len(found) >= MOST_MESSAGES:
            found.append(Unreachable(int(rows[worst])))
            continue
        few = rows[np.unique([its[0], worst, its[-1]])].tolist()
        misses = [(shortfall(kinematics, motion.pose[row]), row) for row in few]
        miss, row = max(misses, key=lambda pair: pair[0].combined_error)
        if miss.combined_error >= PATH_TOLERANCE:
            found.append(Unreachable(row, miss))
    return found


def reach_error(
    motion: Motion,
    kinematics: Kinematics,
    unreachable: list[Unreachable],
    null: str = DEFAULT_OBJECTIVE,
) -> ScriptError:
    """The error for lines of a motion, some of whose rows no posture reaches."""
    program = motion.program
    told, others = unreachable[:MOST_MESSAGES], unreachable[MOST_MESSAGES:]
    advice = suggest(motion, kinematics, np.array([one.row for one in told]), null)
    problems = []
    for one in told:
        last = one is told[-1]
        label = "farthest point of this line"
        if last and others:
            lines = [program.line_name(motion.source.at(other.row)) for other in others]
            more = f" and {len(lines) - MOST_NAMED} more" if len(lines) > MOST_NAMED else ""
            label += f"; likewise line{'s' if len(lines) > 1 else ''} "
            label += ", ".join(lines[:MOST_NAMED]) + more
        fault = _describe(one, kinematics.card.name)
        problems.append(
            Diagnostic(
                "E310",
                f"sample {one.row} ({motion.t[one.row]:.2f} s) {fault}",
                program.segments[int(motion.stroke[one.row])].span,
                label=label,
                help=advice if last else "",
            )
        )
    return ScriptError(program.name, program.text, tuple(problems))


def _describe(one: Unreachable, name: str) -> str:
    """The distance to the reach, as text."""
    assert one.miss is not None
    far, angle = one.miss.shortfall * 1e3, np.degrees(one.miss.angle)
    turned = one.miss.angle > LEAST_ANGLE_SHOWN
    if not one.alone:
        away = f"{far:.0f} mm" + (f" and {angle:.0f} deg" if turned else "")
        return f"is not reached by {name} from the strokes before it: it stays {away} away"
    if far < 0.5 and turned:
        return f"can be reached by {name} only with the tool turned by {angle:.0f} deg"
    amount = f"{far:.0f} mm" if far >= 1 else f"{far:.1f} mm"
    return f"is {amount}{f' and {angle:.0f} deg' if turned else ''} outside the reach of {name}"
