"""Motion x arm -> Forecast: what a drawing asks of an arm, line by line, before it is simulated.

The arm follows what was asked without error and without limits, through the same resolver and with
the same pull in its null space as a run. So where nothing is beyond a limit, a run goes the same
way; where something is, the forecast says what would have been needed.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.light.camera import VIEWS, frame
from dqpaint.light.light import shine
from dqpaint.motion import Motion
from dqpaint.robots.collisions import Shapes
from dqpaint.robots.dynamics import Dynamics
from dqpaint.robots.kinematics import Kinematics, manipulability
from dqpaint.robots.reach import ON_THE_WAY, solve
from dqpaint.robots.resolver import PULL, resolve, to_tool

MOST_ROWS = 20_000  # that are followed; of a longer drawing every second, third ... one
LOOKS = 400  # at the arm's shapes in a whole drawing
TAKEN_UP = 1e-3  # [s] in which the motors of the plant `stiff` take up a new rate


@dataclass(frozen=True)
class Worst:
    """The worst of something on a line: its value, the joint (from 1) and the time [s]."""

    value: float
    joint: int
    time: float


@dataclass(frozen=True)
class Forecast:
    """What one line of a drawing asks of an arm.

    Attributes:
        line: of the file.
        start: time of its first row [s].
        margin: least distance of a joint to its limits [rad]; negative beyond them.
        room: the same as a part of half the joint's range: 0 at a limit, 1 in the middle.
        speed: largest joint rate [rad/s].
        speed_part: and as a part of the joint's limit; both of the joint nearest to its own.
        effort: largest torque of the motion itself, of the joint nearest to its limit [Nm].
        effort_part: and as a part of that limit.
        jolt: the same where motors take up each new rate within a millisecond, as those of the
            plant `stiff` do; and as a part.
        singular: the smallest singular value of the Jacobian at the tool [rad/rad].
        manipulability: the least sqrt(det(J J')).
        clearance: least distance between two links [m], and which; None where none can meet.
        between: these two links.
        hidden: part of the line's light that the arm stands before, seen from the front; None for
            a dark line.
    """

    line: int
    start: float
    margin: Worst
    room: float
    speed: Worst
    speed_part: float
    effort: Worst
    effort_part: float
    jolt: Worst
    jolt_part: float
    singular: float
    manipulability: float
    clearance: float | None
    between: tuple[str, str] | None
    hidden: float | None


def forecast(motion: Motion, kinematics: Kinematics, start: Floats) -> tuple[Forecast, ...]:
    """Look ahead along a drawing.

    Args:
        motion: what is asked.
        kinematics: of the arm.
        start: posture (n,) [rad] it begins in.

    Returns:
        One entry for each line of the file that moves, in the order they are first drawn.
    """
    run = _Run(motion, kinematics, start)
    near, hidden = _shapes(run, motion, kinematics)
    lines, first = np.unique(run.line, return_index=True)
    return tuple(
        _of_line(run, int(line), near, hidden, motion.light[run.rows])
        for line in lines[np.argsort(first)]
    )


class _Run:
    """The arm along the drawing: rows of the motion, and arrays with one entry for each.

    The speed and the torque of a jump of the set point are a law's own: they count as none.
    """

    def __init__(self, motion: Motion, kinematics: Kinematics, start: Floats) -> None:
        self.card = kinematics.card
        stride = -(-len(motion.t) // MOST_ROWS)
        self.rows = np.arange(0, len(motion.t), stride)
        self.t, self.line = motion.t[self.rows], motion.line[self.rows]
        self.period = stride * motion.period
        joined = np.add.reduceat(motion.jump, self.rows) > 0
        self.posture, self.points, J = _follow(motion, kinematics, start, self.rows, joined)
        self.manipulability = manipulability(J)
        at_tool = to_tool(self.points) @ J
        self.singular = np.linalg.svd(at_tool, compute_uv=False)[:, -1]
        self.rates = np.zeros_like(self.posture)
        self.rates[:-1] = np.diff(self.posture, axis=0) / self.period
        self.rates[joined] = 0.0
        change = np.diff(self.rates, axis=0, prepend=0.0)
        change[joined] = 0.0
        change[-1] = 0.0  # a run ends there: nothing is asked any more
        change[1:][joined[:-1]] = 0.0
        dynamics = Dynamics(kinematics)
        self.effort = _torques(dynamics, self.posture, self.rates, change / self.period)
        self.jolt = _torques(
            dynamics, self.posture, self.rates, change / min(self.period, TAKEN_UP)
        )
        self.margin = np.minimum(self.posture - self.card.lower, self.card.upper - self.posture)
        self.room = 2 * self.margin / (self.card.upper - self.card.lower)


def _torques(dynamics: Dynamics, postures: Floats, rates: Floats, accelerations: Floats) -> Floats:
    rows = zip(postures, rates, accelerations, strict=True)
    return np.array([dynamics.torque(*row) for row in rows])


def _follow(
    motion: Motion,
    kinematics: Kinematics,
    start: Floats,
    rows: NDArray[np.intp],
    jump: NDArray[np.bool_],
) -> tuple[Floats, Floats, Floats]:
    """Postures (N, n), places (N, 3) and Jacobians (N, 6, n); one Newton step leads to each row."""
    period = motion.period * (rows[1] - rows[0] if len(rows) > 1 else 1)
    pull = 1.0 - np.exp(-PULL * period)
    postures, jacobians = np.empty((len(rows), len(start))), np.empty((len(rows), 6, len(start)))
    points = np.empty((len(rows), 3))
    q = start
    for k in range(len(rows)):
        x, J = kinematics.pose_and_jacobian(q)
        p = dq.translation(x)
        postures[k], jacobians[k], points[k] = q, J, p
        if k + 1 == len(rows):
            break
        ahead, wish = motion.pose[rows[k + 1]], pull * (start - q)
        if jump[k]:
            q = solve(kinematics, ahead, q[None], wish[None], ON_THE_WAY)[0][0]
        else:
            way = 2 * dq.log(dq.mul(dq.nearest(ahead, x), dq.conj(x)))
            q = q + resolve(J, p, way, wish)
    return postures, points, jacobians


@dataclass(frozen=True)
class _Near:
    """The arm's shapes at some of the rows."""

    rows: NDArray[np.intp]
    distance: Floats
    pair: list[tuple[str, str]]


def _shapes(run: _Run, motion: Motion, kinematics: Kinematics) -> tuple[_Near, dict[int, bool]]:
    """How near the links come, and at which lit rows the arm hides the light."""
    n = len(run.rows)
    ends = np.flatnonzero(np.diff(run.line)) + 1
    middles = (np.append(0, ends) + np.append(ends, n)) // 2  # every line is looked at
    looks = np.unique(np.concatenate([np.linspace(0, n - 1, min(n, LOOKS)).astype(int), middles]))
    shapes = Shapes(kinematics)
    nearest = shapes.nearest(run.posture[looks])
    near = _Near(looks, nearest.distance, nearest.pair)
    lit = looks[motion.light[run.rows[looks]].any(axis=1)]
    if not len(lit):
        return near, {}
    shown = shine(motion.points, motion.light, motion.period).lit_points
    eye = frame(shown, dq.matrix_from_quaternion(motion.front), VIEWS["front"], (1280, 720))
    hides = shapes.hides(run.posture[lit], run.points[lit], eye.position)
    return near, dict(zip(lit.tolist(), hides.tolist(), strict=True))


def _of_line(run: _Run, line: int, near: _Near, hidden: dict[int, bool], light: Floats) -> Forecast:
    rows = np.flatnonzero(run.line == line)
    card = run.card
    speed, speed_part = _worst(run, rows, run.rates, card.speed)
    effort, effort_part = _worst(run, rows, run.effort, card.effort)
    jolt, jolt_part = _worst(run, rows, run.jolt, card.effort)
    k, joint = np.unravel_index(run.margin[rows].argmin(), (len(rows), card.joints))
    margin = Worst(float(run.margin[rows[k], joint]), int(joint) + 1, float(run.t[rows[k]]))
    looked = np.flatnonzero(np.isin(near.rows, rows))
    closest = looked[near.distance[looked].argmin()]
    meets = bool(np.isfinite(near.distance[closest]))
    seen = {row: hides for row, hides in hidden.items() if run.line[row] == line}
    return Forecast(
        line=line,
        start=float(run.t[rows[0]]),
        margin=margin,
        room=float(run.room[rows].min()),
        speed=speed,
        speed_part=speed_part,
        effort=effort,
        effort_part=effort_part,
        jolt=jolt,
        jolt_part=jolt_part,
        singular=float(run.singular[rows].min()),
        manipulability=float(run.manipulability[rows].min()),
        clearance=float(near.distance[closest]) if meets else None,
        between=near.pair[closest] if meets else None,
        hidden=_share(seen, light),
    )


def _share(hidden: dict[int, bool], light: Floats) -> float | None:
    """The part of the light that is hidden, by its energy."""
    energy = {row: float(light[row].sum()) for row in hidden}
    total = sum(energy.values())
    return sum(energy[row] for row, hides in hidden.items() if hides) / total if total else None


def _worst(run: _Run, rows: NDArray[np.intp], values: Floats, limit: Floats) -> tuple[Worst, float]:
    """Where some values come nearest to their limits, and that as a part of the limit."""
    parts = np.abs(values[rows]) / limit
    k, joint = np.unravel_index(parts.argmax(), parts.shape)
    row = rows[k]
    worst = Worst(float(abs(values[row, joint])), int(joint) + 1, float(run.t[row]))
    return worst, float(parts[k, joint])
