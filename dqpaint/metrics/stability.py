"""Track -> why a run was unstable, or None; a sweep marks such runs, whose figures mean nothing.

A loop in steps that is too fast answers each error with a larger one of the other sign. Where the
arm's limits hold it, that ends in numbers that look tame. So it is told by its commands: successive
changes oppose each other, and they grow, or limits hold them. A loop that hears of its arm late
does the same more slowly: between the limits for some periods one way, then for as many the other.
"""

import numpy as np

from dqpaint.dq import Floats
from dqpaint.simulation import Track

ALTERNATING = -0.6  # correlation of successive changes; of white noise it is -0.5
GROWING = 1.5  # from the third quarter of a run to the last, of the rms change
CLIPPED_SHARE = 0.05  # part of the run that limits hold a joint
LONGEST_SWING = 64  # periods from one end of a swing to the other
AT_LIMIT_SHARE = 0.025  # part of the run's end that a swinging joint is at either of its limits
LEAST_SPAN = 0.05  # [m] an arm may be off in a drawing that is smaller than this
LEAST_ROWS = 16  # rows of which this can be told
ROUNDING = 1e-9  # [rad/s, Nm] of change is rounding


def instability(track: Track) -> str | None:
    """Why a run is not stable, or None.

    Only its second half counts, so that a far start is no fault.
    """
    n = len(track.command)
    if n < LEAST_ROWS:
        return None
    third, last = track.command[n // 2 : 3 * n // 4], track.command[3 * n // 4 :]
    held = sum(clamp.seconds for clamp in track.clamps if clamp.kind != "position")
    if _alternation(last) < ALTERNATING:
        if held > CLIPPED_SHARE * track.motion.t[-1]:
            return "commands alternate between the arm's limits"
        if _rms_change(last) > max(ROUNDING, GROWING * _rms_change(third)):
            return "commands alternate and grow"
    if _swings_between_limits(track):
        return "commands swing between the arm's limits"
    span = max(LEAST_SPAN, float(np.linalg.norm(np.ptp(track.motion.points, axis=0))))
    astray = np.linalg.norm((track.points - track.motion.points)[3 * n // 4 :], axis=1).max()
    if astray > span:
        return "the arm is farther off than the drawing is large"
    return None


def _alternation(command: Floats) -> float:
    """Correlation of successive changes of commands (N, n): -1 where they alternate."""
    change = np.diff(command, axis=0)
    power = float((change * change).sum())
    return float((change[1:] * change[:-1]).sum() / power) if power > 0 else 0.0


def _swings_between_limits(track: Track) -> bool:
    """Whether commands come and go between both limits of a joint, and not as the drawing does."""
    n = len(track.command)
    end = track.command[3 * n // 4 :]
    kind = "torque" if track.torques else "speed"
    limits = {c.joint - 1: c.limit for c in track.clamps if c.kind == kind}
    if not any(_at_both(end[:, joint], limit) for joint, limit in limits.items()):
        return False
    given, asked = np.diff(end, axis=0), np.diff(track.motion.twist[3 * n // 4 :], axis=0)
    return any(
        _correlation(given, lag) < ALTERNATING < 2 * _correlation(asked, lag)
        for lag in range(1, min(LONGEST_SWING, len(given) // 4) + 1)
    )


def _at_both(command: Floats, limit: float) -> bool:
    """Whether a joint's command (N,) is often enough at its upper and at its lower limit."""
    at = limit * (1 - 1e-6)
    return min(float((command >= at).mean()), float((command <= -at).mean())) > AT_LIMIT_SHARE


def _correlation(change: Floats, lag: int) -> float:
    """Correlation of changes (N, n) with those `lag` rows before, from -1 to 1."""
    late, early = change[lag:], change[:-lag]
    power = float(np.linalg.norm(late) * np.linalg.norm(early))
    return float((late * early).sum()) / power if power > 0 else 0.0


def _rms_change(command: Floats) -> float:
    """The rms change of commands (N, n) from row to row."""
    return float(np.sqrt((np.diff(command, axis=0) ** 2).mean()))
