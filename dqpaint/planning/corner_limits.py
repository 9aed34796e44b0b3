"""Motion x arm -> the motion with accelerations at corners that the arm's motors can bear.

A drawing says how fast its strokes may change their velocity where they run through corners; an arm
may be able to do less. What its joints need for that is looked at along the drawing, row by row:
the change of the rates, J^+ times that of the tool's twist, and the torques for it, H times that.
Both grow with the acceleration, so the acceleration of a stroke is divided by what is too much.
It is the arm's, whatever plant it runs on: motors that take up new rates at once, as drives do.
"""

from dataclasses import dataclass, replace

import numpy as np

from dqpaint import dq
from dqpaint.core import replaced
from dqpaint.dq import Floats
from dqpaint.motion import Motion, plan
from dqpaint.planning.ideal_run import follow
from dqpaint.planning.retiming import SUDDEN_TIME
from dqpaint.program import ContinuousStroke, Program, Segment
from dqpaint.robots.kinematics import (
    Dynamics,
    Kinematics,
    make_secondary_task,
)
from dqpaint.robots.resolvers import DEFAULT_RESOLVER

MOST_LOOKS = 1500  # postures at which inertia and Jacobian are worked out
MOST_PASSES = 5
SHARE = 0.7  # of what a motor has beside the weight; a law answers its error by a third as much
LEAST_ROOM = 0.05  # of a torque: the weight takes the rest, and no pace helps
CLOSE = 1.01  # a load that is larger by less has converged
LEAST = 1e-3  # of the acceleration that the drawing allows


@dataclass(frozen=True)
class CornerPace:
    """A motion whose accelerations the arm can bear.

    Attributes:
        motion: it.
        allowed: the acceleration [m/s^2] that the drawing allows.
        least: the least that a stroke has [m/s^2].
    """

    motion: Motion
    allowed: float
    least: float

    @property
    def as_json(self) -> dict[str, float]:
        """For a summary."""
        return {"least_m_s2": self.least, "allowed_m_s2": self.allowed}

    def __str__(self) -> str:
        return (
            f"from {self.least:.2g} m/s2 on in place of {self.allowed:.2g}: the motors bear no more"
        )


def within_torques(
    motion: Motion,
    kinematics: Kinematics,
    start: Floats,
    null: str,
    resolver: str = DEFAULT_RESOLVER,
) -> CornerPace | None:
    """The motion at accelerations that the motors can bear; None if it needs no change.

    Args:
        motion: what is asked.
        kinematics: of the arm.
        start: posture (n,) [rad] to begin from.
        null: what the arm does with its freedom.
        resolver: of the run.
    """
    segments = motion.program.segments
    allowed = np.array([segment.profile.acceleration for segment in segments])
    if not allowed.any():
        return None
    owner = _strokes(segments)
    acceleration = allowed
    for _ in range(MOST_PASSES):
        load = np.ones(owner[-1] + 1)
        loads = _loads(motion, kinematics, start, null, resolver)
        np.maximum.at(load, owner[motion.stroke], loads)
        load = np.where(allowed > 0.0, load[owner], 1.0)
        if (load <= CLOSE).all():
            break
        acceleration = np.maximum(acceleration / load, LEAST * allowed)
        program = _with_accelerations(motion.program, acceleration)
        motion = plan(program, kinematics.card.canvas.pose)
    if acceleration is allowed:
        return None
    least = acceleration[allowed > 0.0]
    return CornerPace(motion, float(allowed.max()), float(least.min()))


def _strokes(segments: tuple[Segment, ...]) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """The stroke of each segment (M,), from 0."""
    numbers = np.array([s.stroke.number if s.stroke else 0 for s in segments])
    begins = np.concatenate([[True], (numbers[1:] != numbers[:-1]) | (numbers[1:] == 0)])
    return np.cumsum(begins) - 1


def _loads(
    motion: Motion, kinematics: Kinematics, start: Floats, null: str, resolver: str
) -> Floats:
    """The torques for changes of the rates at each row (N,), as a part of the room for them."""
    n, period = len(motion.t), motion.period
    looks = np.arange(0, n, -(-n // MOST_LOOKS))
    wish = make_secondary_task(null, kinematics.card, start)
    postures, _, jacobians = follow(motion, kinematics, start, looks, wish, resolver)
    dynamics = Dynamics(kinematics)
    most = kinematics.card.effort
    free = most - np.abs([dynamics.weight(q) for q in postures])
    room = np.where(free > LEAST_ROOM * most, SHARE * free, np.inf)
    inertia = np.array([dynamics.inertia(q) for q in postures])
    controlled = kinematics.task_jacobian(kinematics.poses(postures), jacobians)
    to_part = inertia @ np.linalg.pinv(controlled) / room[:, :, None]
    way = 2 * dq.log(dq.mul(motion.pose[1:], dq.conj(motion.pose[:-1]))) / period
    way[motion.jump[:-1]] = 0.0  # a jump is the law's own
    still = np.zeros((1, 6))
    change = np.diff(np.concatenate([still, way, still]), axis=0)
    change /= min(period, SUDDEN_TIME)
    at = np.minimum((np.arange(n) + (looks[1] // 2 if len(looks) > 1 else 0))
                    // (looks[1] if len(looks) > 1 else n), len(looks) - 1)  # fmt: skip
    asked = kinematics.task_map(motion.pose)
    change = change if asked is None else np.matvec(asked, change)
    return np.asarray(np.abs(np.matvec(to_part[at], change)).max(axis=1))


def _with_accelerations(program: Program, acceleration: Floats) -> Program:
    """The drawing with other accelerations of its segments (M,)."""
    strokes: dict[int, ContinuousStroke] = {}
    segments = []
    for segment, value in zip(program.segments, acceleration.tolist(), strict=True):
        if value == segment.profile.acceleration:
            segments.append(segment)
            continue
        profile = replaced(segment.profile, acceleration=value)
        stroke = segment.stroke
        if stroke is not None:
            stroke = strokes.setdefault(stroke.number, replaced(stroke, profile=profile))
        segments.append(replaced(segment, profile=profile, stroke=stroke))
    return replace(program, segments=tuple(segments))
