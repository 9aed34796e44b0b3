"""The first limit that a run meets -> the error that ends it, with `--on-limit stop`."""

import numpy as np

from dqpaint.dq import Floats
from dqpaint.language import Diagnostic, ScriptError
from dqpaint.motion import Motion
from dqpaint.robots.kinematics import LIMIT_TOLERANCE, Clamp
from dqpaint.robots.model import Card

VERB_UNIT_FIX = {
    "position": ("go to", "deg", "turn the tool less, or move the drawing with place"),
    "speed": ("turn at", "deg/s", "draw it slower, or let --on-limit slow do it"),
    "torque": ("bear", "Nm", "a lower speed or lower gains need less torque"),
}


def meets_limit(
    card: Card, posture: Floats, wanted: Floats, command: Floats, effort: Floats, torques: bool
) -> bool:
    """Whether a row of a run (n,) met a limit; arguments as those of `limits.clamps`."""
    held = (wanted != command).any() or (
        np.abs(effort) >= card.effort * (1 - LIMIT_TOLERANCE)
    ).any()
    beyond = torques and ((posture > card.upper) | (posture < card.lower)).any()
    return bool(held or beyond)


def limit_error(motion: Motion, clamp: Clamp) -> ScriptError:
    """The error that names a limit: joint, time, line and amount."""
    verb, unit, fix = VERB_UNIT_FIX[clamp.kind]
    limit, wanted = clamp.amounts
    amount = f"more than {limit}" if limit == wanted else wanted
    problem = Diagnostic(
        "E312",
        f"at {clamp.start:.3f} s joint {clamp.joint} would have to {verb} {amount} {unit}, "
        f"its limit is {limit} {unit}",
        motion.program.segments[int(motion.stroke[_row(motion, clamp)])].span,
        label="drawn at that time",
        help=f"{fix}; --on-limit clip holds the joint back and goes on",
    )
    return ScriptError(motion.program.name, motion.program.text, (problem,))


def _row(motion: Motion, clamp: Clamp) -> int:
    return int(np.searchsorted(motion.t, clamp.start - 0.5 * motion.period))
