"""A painting's run -> an error if it is beyond the limits of its real arm."""

import numpy as np

from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError
from dqpaint.motion import Motion
from dqpaint.outputs.robot.trajectory import kinematics_of
from dqpaint.painting import paint
from dqpaint.planning import motion_advice
from dqpaint.robots.kinematics import Dynamics
from dqpaint.robots.model import Card

LARGEST_END_ACCELERATION = (
    10.0  # [rad/s^2] at the start or end; of a Panda's joints Franka allows 7.5 to 20
)
ROUNDING = 1e-6  # relative, of numbers that went through a simulation
MOST_NAMED = 6
FIX = "--on-limit slow gives what is too fast the time it needs"
DEG = float(np.degrees(1.0))


def check_limits(painting: paint.Painting) -> None:
    """Check a run against the limits of the arm that is to repeat it.

    The limits that were met while it ran count, and, whatever the plant made of them, positions,
    speeds, and the torques that inverse dynamics finds for the run, which begins and ends at rest.

    Raises:
        DqpaintError: something of it is beyond the arm; all of it is listed.
    """
    kinematics = kinematics_of(painting)
    card, motion, q = kinematics.card, painting.motion, painting.track.posture
    where = motion.program.line_name
    reasons = [
        f"line {where(one.line)}: the {one.kind} limit held {one}" for one in painting.limits
    ]
    rates = np.diff(q, axis=0, prepend=q[:1], append=q[-1:]) / motion.period  # N + 1, at rest first
    bends = np.diff(rates, axis=0) / motion.period
    reasons += _position_and_speed_excess(painting, card, q, rates[1:])
    torques = _torques(Dynamics(kinematics), q, rates, bends)
    joint, row = _row_of_largest(np.abs(torques) / card.effort)
    if abs(torques[row, joint]) > card.effort[joint] * (1 + ROUNDING):
        reasons.append(
            f"{_line(motion, row)}: joint {joint + 1} needs {abs(torques[row, joint]):.4g} Nm "
            f"at {motion.t[row]:.3f} s, but has {card.effort[joint]:.4g} Nm"
        )
    for when, row in (("start", 0), ("end", len(q) - 1)):
        joint = int(np.abs(bends[row]).argmax())
        if abs(bends[row, joint]) > LARGEST_END_ACCELERATION:
            # retiming looks at what is within a drawing: no pace is found for its ends
            softer = motion_advice.advise(motion, float(motion.t[row]), slowed=True)
            reasons.append(
                f"{_line(motion, row)}: a sudden {when}: joint {joint + 1} changes its speed by "
                f"{abs(bends[row, joint]) * motion.period * DEG:.3g} deg/s within "
                f"{motion.period * 1e3:g} ms ({abs(bends[row, joint]):.3g} rad/s^2, at most "
                f"{LARGEST_END_ACCELERATION:g}); {softer}"
            )
    if reasons:
        more = len(reasons) - MOST_NAMED
        shown = reasons[:MOST_NAMED] + ([f"and {more} more"] if more > 0 else [])
        fast = not painting.retiming and any(one.kind != "position" for one in painting.limits)
        told = "\n  ".join(shown + ([f"= help: {FIX}"] if fast else []))
        raise DqpaintError(f"not exported: {card.name} could not do this:\n  {told}")


def _position_and_speed_excess(
    painting: paint.Painting, card: Card, q: Floats, rates: Floats
) -> list[str]:
    """The worst position and the worst speed beyond a limit; rates (N, n) after each row."""
    motion = painting.motion
    found = []
    over = np.maximum(card.lower - q, q - card.upper)
    joint, row = _row_of_largest(over)
    if over[row, joint] > ROUNDING:
        found.append(
            f"{_line(motion, row)}: joint {joint + 1} is {over[row, joint] * DEG:.3g} deg "
            f"beyond its limit at {motion.t[row]:.3f} s"
        )
    joint, row = _row_of_largest(np.abs(rates) / card.speed)
    if abs(rates[row, joint]) > card.speed[joint] * (1 + ROUNDING):
        found.append(
            f"{_line(motion, row)}: joint {joint + 1} goes at "
            f"{abs(rates[row, joint]) * DEG:.4g} deg/s at {motion.t[row]:.3f} s, but can go at "
            f"{card.speed[joint] * DEG:.4g} deg/s"
        )
    return found


def _torques(dynamics: Dynamics, q: Floats, rates: Floats, bends: Floats) -> Floats:
    """For each row (N, n) [Nm], at its mean rate."""
    middle = 0.5 * (rates[:-1] + rates[1:])
    rows = zip(q, middle, bends, strict=True)
    return np.array([dynamics.torque(*row) for row in rows])


def _row_of_largest(values: Floats) -> tuple[int, int]:
    """Joint and row of the largest of values (N, n)."""
    row, joint = np.unravel_index(values.argmax(), values.shape)
    return int(joint), int(row)


def _line(motion: Motion, row: int) -> str:
    return f"line {motion.program.line_name(motion.source.at(row))}"
