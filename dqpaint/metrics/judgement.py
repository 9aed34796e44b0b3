"""Track -> whether a run is a result, and if not why: it oscillates, was clipped or went astray.

One rule for every command. Figures of a run that is no result mean nothing: they say where its
limits ended it. Only the second half counts, so that a far start is no fault.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.diagnostics import SourceLine
from dqpaint.dq import Floats
from dqpaint.metrics.oscillation import find_oscillation
from dqpaint.robots.kinematics import CHARACTERISTIC_LENGTH
from dqpaint.simulation import Track

FaultKind = Literal["oscillates", "clipped", "astray"]
CLIPPED_SHARE = 0.2  # of the second half, in which limits may clip commands
LONGEST_PATH = 2.0  # times the reference path
LEAST_OSCILLATION = 0.1  # rms speed of an oscillation that counts, by the mean speed of the drawing
LEAST_SPEED = 1e-3  # [m/s] of a drawing: one that is slower, or rests, is taken for this fast
LEAST_SPAN = 0.05  # [m] an arm may be off in a drawing that is smaller than this
LEAST_ROWS = 16  # rows of which anything can be told

ALTERNATING = -0.6  # correlation of successive changes; of white noise it is -0.5
GROWING = 1.5  # from the third quarter of a run to the last, of the rms change
ALTERNATING_SHARE = 0.05  # of the run in which limits clip commands that alternate
LONGEST_SWING = 64  # periods from one end of a swing to the other
AT_LIMIT_SHARE = 0.025  # part of the run's end that a swinging joint is at either of its limits
ROUNDING = 1e-9  # [rad/s, Nm] of change is rounding
MOST_NAMED = 5  # lines


@dataclass(frozen=True)
class Fault:
    """One reason why a run is no result: its kind, a sentence, and the line where it is worst."""

    kind: FaultKind
    says: str
    line: SourceLine


@dataclass(frozen=True)
class Judgement:
    """What a run is worth.

    Attributes:
        faults: why it is no result, the most telling first; none for a result.
    """

    faults: tuple[Fault, ...]

    @property
    def is_result(self) -> bool:
        """Whether its figures stand for what law and arm do."""
        return not self.faults

    @property
    def status(self) -> Literal["done"] | FaultKind:
        """`done`, or the kind of the first fault."""
        return self.faults[0].kind if self.faults else "done"

    @property
    def why(self) -> str:
        """All faults in a line; empty for a result."""
        return "; ".join(fault.says for fault in self.faults)


def judge(track: Track, swinging: Sequence[str] = ()) -> Judgement:
    """Whether a run is a result, by the rules of this module.

    Args:
        track: the run.
        swinging: names of disturbances that may swing by themselves: an arm may swing with them.
    """
    if len(track.command) < LEAST_ROWS:
        return Judgement(())
    found = (_oscillates(track, swinging), _clipped(track), _long_path(track), _far_off(track))
    return Judgement(tuple(fault for fault in found if fault is not None))


def clipped_rows(track: Track) -> NDArray[np.bool_] | None:
    """Whether a limit clipped some joint in a row (N,); None where it is not known."""
    if track.clipped is None:
        return None
    found = np.zeros(len(track.command), bool)
    for where in track.clipped.values():
        found |= where.any(axis=1)
    return found


def _oscillates(track: Track, swinging: Sequence[str]) -> Fault | None:
    """A tool that swings as nothing asked it to, or commands that alternate or swing."""
    motion = track.motion
    line = motion.source.at(len(motion.t) - 1)
    perhaps = ""
    if swinging:
        perhaps = f", perhaps with the disturbance that acts in time ({', '.join(swinging)})"
    if said := _alternates(track):
        return Fault("oscillates", said + perhaps, line)
    rows = slice(_settled_from(motion.jump), len(motion.t))
    lever = CHARACTERISTIC_LENGTH
    least = LEAST_OSCILLATION * _mean_speed(track)
    for name, unit, scale, size, (deviation, excitation) in (
        ("the tool", "mm", 1e3, 1.0, _translations(track, rows)),
        ("the tool's orientation", "deg", np.degrees(1), lever, _rotations(track, rows)),
    ):
        found = find_oscillation(deviation, excitation, motion.period, least / size)
        if found is not None:
            line = motion.source.at(rows.start + found.row)
            amount = f"{float(f'{scale * found.amplitude:.2g}'):g} {unit}"  # 230, not 2.3e+02
            where = motion.program.line_name(line)
            said = f"{name} oscillates at {found.frequency:.3g} Hz by {amount}, line {where}"
            return Fault("oscillates", said + perhaps, line)
    return None


def _settled_from(jump: NDArray[np.bool_]) -> int:
    """The first row that is judged: of the second half, and of the second half since a step."""
    half, steps = len(jump) // 2, np.flatnonzero(jump)
    return max(half, (int(steps[-1]) + 1 + len(jump)) // 2) if len(steps) else half


def _translations(track: Track, rows: slice) -> tuple[Floats, Floats]:
    """The deviation (N, 3) of the tool's velocity, and velocities (N, 9) that may explain it."""
    motion = track.motion
    drift = dq.point_velocity(_carried(track), track.points)[rows][:-1]
    measured = dq.translation(track.measured_pose) - track.points
    parts = (track.points - motion.points, motion.points, measured)
    deviation, reference, sensed = (np.diff(part[rows], axis=0) / motion.period for part in parts)
    return deviation, np.hstack([reference, drift, sensed])


def _rotations(track: Track, rows: slice) -> tuple[Floats, Floats]:
    """The same of the angular velocity [rad/s]."""
    motion = track.motion
    turned = _turns(motion.pose[:-1], motion.pose[1:])[rows][: len(motion.t[rows]) - 1]
    errors = (_turns(motion.pose, track.pose), _turns(track.pose, track.measured_pose))
    deviation, sensed = (np.diff(part[rows], axis=0) / motion.period for part in errors)
    return deviation, np.hstack([turned / motion.period, _carried(track)[rows][:-1, :3], sensed])


def _turns(start: Floats, end: Floats) -> Floats:
    """The rotation vectors (N, 3) [rad] from orientations to others, the short way."""
    return np.asarray(2 * dq.log(dq.mul(dq.nearest(start, end), dq.conj(start)))[..., :3])


def _carried(track: Track) -> Floats:
    """The spatial twists (N, 6) that carry the tool besides the arm."""
    return np.asarray(track.disturbance + track.pose_disturbance)


def _mean_speed(track: Track) -> float:
    """The speed [m/s] of a drawing on the whole, its jumps and the way to its start included."""
    motion = track.motion
    way = float(np.linalg.norm(np.diff(motion.points, axis=0), axis=1).sum())
    way += float(np.linalg.norm(track.points[0] - motion.points[0]))
    return max(LEAST_SPEED, way / motion.seconds)


def _clipped(track: Track) -> Fault | None:
    """Commands at limits for more than a fifth of the second half."""
    clipped = clipped_rows(track)
    if not track.clipped or clipped is None:
        return None
    motion, half = track.motion, len(clipped) // 2
    share = float(clipped[half:].mean())
    if share <= CLIPPED_SHARE:
        return None
    worst, where = max(
        ((kind, where[half:]) for kind, where in track.clipped.items()),
        key=lambda one: int(one[1].sum(axis=0).max()),
    )
    joint = int(where.sum(axis=0).argmax())
    lines = motion.source.index[half:][where[:, joint]]
    line = motion.source.lines[int(np.bincount(lines).argmax())]
    said = (
        f"limits clip commands for {share:.0%} of the second half, mostly the {worst} limit of "
        f"joint {joint + 1}, line {motion.program.line_name(line)}"
    )
    return Fault("clipped", said, line)


def _long_path(track: Track) -> Fault | None:
    """More than twice the reference path, from the first stroke on, while the reference moves.

    Steps of the reference, the error at the first stroke, unmodelled twists and sensor noise
    explain as much again.
    """
    motion = track.motion
    reference, moved = (
        np.linalg.norm(np.diff(points, axis=0), axis=1) for points in (motion.points, track.points)
    )
    first = int(motion.lit.argmax())  # 0 of a drawing without light
    moves = (reference > ROUNDING * motion.period) & ~motion.jump[:-1]
    moves[:first] = False
    if not moves.any():
        return None
    sensed = np.diff(dq.translation(track.measured_pose) - track.points, axis=0)
    drift = motion.period * dq.point_velocity(_carried(track), track.points)[:-1][moves]
    changing = drift - drift.mean(axis=0)  # a constant one is the law's to reject
    others = float(np.linalg.norm(sensed[moves], axis=1).sum())
    others += float(np.linalg.norm(changing, axis=1).sum())
    others += float(reference[motion.jump[:-1]].sum())
    others += float(np.linalg.norm(track.points[first] - motion.points[first]))
    asked, gone = float(reference[moves].sum()), float(moved[moves].sum())
    if gone <= LONGEST_PATH * (asked + others):
        return None
    excess = np.where(moves, moved - reference, 0.0)
    line = motion.source.lines[int(np.bincount(motion.source.index[:-1], excess).argmax())]
    said = (
        f"the tool travels {gone:.3g} m for {asked:.3g} m of strokes, most of the excess on line "
        f"{motion.program.line_name(line)}"
    )
    return Fault("astray", said, line)


def _far_off(track: Track) -> Fault | None:
    """An arm that is farther off at the end than the drawing is large."""
    motion = track.motion
    late = 3 * len(motion.t) // 4
    span = max(LEAST_SPAN, float(np.linalg.norm(np.ptp(motion.points, axis=0))))
    errors = np.linalg.norm((track.points - motion.points)[late:], axis=1)
    if errors.max() <= span:
        return None
    line = motion.source.at(late + int(errors.argmax()))
    return Fault("astray", "the arm is farther off than the drawing is large", line)


def _alternates(track: Track) -> str | None:
    """How commands alternate or swing between limits at the end of a run, or None.

    A loop in steps that is too fast answers each error with a larger one of the other sign. Where
    the arm's limits hold it, that ends in numbers that look tame. So it is told by its commands:
    successive changes oppose each other, and they grow, or limits clip them. A loop that hears of
    its arm late does the same more slowly: between the limits for some periods one way, then for
    as many the other.
    """
    n = len(track.command)
    third, last = track.command[n // 2 : 3 * n // 4], track.command[3 * n // 4 :]
    held = sum(clamp.seconds for clamp in track.clamps if clamp.kind != "position")
    if _alternation(last) < ALTERNATING:
        if held > ALTERNATING_SHARE * track.motion.t[-1]:
            return "commands alternate between the arm's limits"
        if _rms_change(last) > max(ROUNDING, GROWING * _rms_change(third)):
            return "commands alternate and grow"
    if _swings_between_limits(track):
        return "commands swing between the arm's limits"
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


def limits_text(track: Track) -> str:
    """The limits that clipped a run: `speed of joints 1, 4 (lines 3, 5); torque of joint 2 (3)`."""
    where = track.motion.program.line_name
    kinds: dict[str, tuple[set[int], dict[str, None]]] = {}
    for clamp in track.clamps:
        joints, lines = kinds.setdefault(clamp.kind, (set(), {}))
        joints.add(clamp.joint)
        lines[str(where(clamp.line))] = None
    return "; ".join(
        f"{kind} limit of joint{'s' if len(joints) > 1 else ''} "
        f"{', '.join(map(str, sorted(joints)))} (line{'s' if len(lines) > 1 else ''} "
        f"{_few(list(lines))})"
        for kind, (joints, lines) in kinds.items()
    )


def _few(names: list[str]) -> str:
    more = f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
    return ", ".join(names[:MOST_NAMED]) + more
