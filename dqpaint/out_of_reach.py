"""What is said of a drawing that leaves the arm's reach: where, by how much, what would help."""

import numpy as np

from dqpaint import dq
from dqpaint.language.diagnostics import Diagnostic, ScriptError
from dqpaint.motion import Motion
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.reach import Miss, find_start

WORTH_SAYING = np.radians(0.5)
SCALES = np.arange(0.95, 0.05, -0.05)


def out_of_reach(motion: Motion, kinematics: Kinematics, row: int, miss: Miss) -> ScriptError:
    """The error for a row of the motion that no posture reaches."""
    program = motion.program
    segment = program.segments[int(motion.stroke[row])]
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
        label="on the way of this stroke",
        help=_advice(motion, kinematics, row),
    )
    return ScriptError(program.name, program.text, (problem,))


def _advice(motion: Motion, kinematics: Kinematics, row: int) -> str:
    """A scale about the drawing's origin at which the same point is reached, if there is one."""
    local = dq.mul(dq.conj(motion.canvas), motion.pose[row])
    for scale in SCALES:
        smaller = dq.pose_from(scale * dq.translation(local), dq.rotation(local))
        pose = dq.mul(motion.canvas, smaller)
        if not isinstance(find_start(kinematics, pose[None], np.zeros(1)), Miss):
            return (
                f"shift the drawing with place, or make it smaller: with scale {scale:.2g} ... end"
            )
    return "shift the drawing with place, or turn the tool another way"
