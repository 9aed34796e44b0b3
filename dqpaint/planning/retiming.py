"""Motion x arm -> the motion slowed down where a joint could not keep up: `--on-limit slow`.

The kinematic arm goes along the drawing first. What its joints would need is split into the part
that shrinks with the clock, a = J^+ xi_d, and the part that does not, the pull of the null space
and what brings the arm back to the path: q_dot = a s_dot + b. On a plant with masses the
motors' share is looked at as well, the weight of the arm being the part that does not shrink.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from dqpaint import dq
from dqpaint.diagnostics import SourceLine
from dqpaint.dq import Floats
from dqpaint.motion import Motion, TimeScaling, plan, smooth
from dqpaint.robots.kinematics import (
    Dynamics,
    Kinematics,
    drift_acceleration,
    make_secondary_task,
)
from dqpaint.robots.resolvers import DEFAULT_RESOLVER, State, planning_resolver

LIMIT_SHARE = 0.9  # of a limit is planned with; the rest is for what a law adds
LEAST_SHARE = 0.3  # of that at least is taken for the drawing, whatever the rest takes
MOST_SLOWNESS = 50.0  # times
MOST_PASSES = 6
CONVERGED = 1e-3
RETURN_RATE = 20.0  # [1/s] at which the arm comes back to the path, as every law does by itself
MOST_NAMED = 3  # lines
SUDDEN_TIME = 1e-3  # [s] in which the motors of the plant `stiff` take up a new rate
ON_PATH = 1e-3  # [rad, m] from the path: it has arrived there, and what it needs now counts

Solve = Callable[[State, Sequence[Floats], Floats | None], Floats]
Motors = Literal["none", "smooth", "sudden"]


@dataclass(frozen=True)
class Retiming:
    """A drawing that was slowed down.

    Attributes:
        motion: re-timed.
        extra_time: how much longer it takes [s].
        lowest_pace: the least pace, as a part of the asked one.
        lines: of the drawing that were slowed.
    """

    motion: Motion
    extra_time: float
    lowest_pace: float
    lines: tuple[SourceLine, ...]

    @property
    def as_json(self) -> dict[str, Any]:
        """For a summary."""
        lines = [self.motion.program.line_reference(line) for line in self.lines]
        return {"longer_s": self.extra_time, "slowest": self.lowest_pace, "lines": lines}

    def __str__(self) -> str:
        if not self.lines:
            return "as asked: no joint needs more time"
        where = ", ".join(map(self.motion.program.line_name, self.lines[:MOST_NAMED]))
        more = f" and {len(self.lines) - MOST_NAMED} more" if len(self.lines) > MOST_NAMED else ""
        said = f"{self.extra_time:.3g} s longer, down to {self.lowest_pace:.2g} of the asked speed"
        return f"{said} (line{'s' if len(self.lines) > 1 else ''} {where}{more})"


def retime(
    motion: Motion,
    kinematics: Kinematics,
    start: Floats,
    null: str,
    motors: Motors,
    resolver: str = DEFAULT_RESOLVER,
) -> Retiming:
    """The motion at a pace that the arm's limits allow, as far as slowness helps.

    Position limits are not helped by it, nor is the way back to the path where an arm is off it:
    as it begins, after a jump, or where a joint at its end has held it back.

    Args:
        motion: what is asked.
        kinematics: of the arm.
        start: posture (n,) [rad] to begin from.
        null: what the arm does with its freedom.
        motors: what of their torques counts: nothing; what smooth motion needs; or also what new
            rates need that are taken up at once.
        resolver: of the run: undamped, an arm beside a singularity needs more time there.
    """
    slowness = np.ones(len(motion.t))
    for turn in range(MOST_PASSES):
        needed = _needed_slowness(
            motion, kinematics, start, null, motors, resolver, slowness, turn > 0
        )
        needed = np.clip(needed, 1, MOST_SLOWNESS)
        if turn and (needed <= slowness * (1 + CONVERGED)).all():
            break
        slowness = np.maximum(slowness, smooth(needed, motion.period))
    if (slowness == 1).all():
        return Retiming(motion, 0.0, 1.0, ())
    placed = plan(motion.program, kinematics.card.canvas.pose, TimeScaling(slowness, motion.period))
    lines = motion.source[slowness > 1 + CONVERGED].present
    longer = float(placed.t[-1] - motion.t[-1])
    return Retiming(placed, longer, float(1 / slowness.max()), tuple(lines))


def _needed_slowness(
    motion: Motion,
    kinematics: Kinematics,
    start: Floats,
    null: str,
    motors: Motors,
    resolver: str,
    slowness: Floats,
    returning: bool,
) -> Floats:
    """The slowness (N,) each row needs by itself, when the clock is as slow as given.

    What brings the arm back to the path is counted only if it is `returning`: at full speed it
    would be too much.
    """
    card, period = kinematics.card, motion.period
    wish, zero = make_secondary_task(null, card, start), np.zeros(card.joints)
    speed = LIMIT_SHARE * card.speed
    solve = planning_resolver(resolver, kinematics, period).rates
    torques = _Torques(kinematics, solve) if motors != "none" else None
    growth = np.gradient(slowness, period) if len(slowness) > 1 else np.zeros(1)
    needed = np.empty(len(motion.t))
    q, before = start, zero
    settled = False
    asked = zip(
        motion.pose, motion.twist, motion.acceleration, motion.jump, slowness, growth, strict=True
    )
    for k, (pose, twist, slope, jump, slow, grow) in enumerate(asked):
        x, J = kinematics.pose_and_jacobian(q)
        point = dq.translation(x)
        now = State(x, J, q)
        nears = [dq.nearest(part.near(pose, x), x) for part in kinematics.task.parts]
        ways = [2 * dq.log(dq.mul(near, dq.conj(x))) for near in nears]
        error, parts = ways[0], len(ways)
        settled = (settled or float(np.abs(error).max()) < ON_PATH) and not jump
        back = solve(now, ways, zero)
        along = solve(now, [twist] * parts, zero)
        pull = solve(now, [np.zeros(6)] * parts, wish(q, J, point))
        room = np.maximum(speed - np.abs(pull), LEAST_SHARE * speed)
        needed[k] = (np.abs(along) / room).max()
        if settled and returning:
            needed[k] = max(
                needed[k], (np.abs(along + slow * (pull + RETURN_RATE * back)) / speed).max()
            )
        if torques is not None:
            acceleration = slope / slow**2 - twist * (grow / slow**3)
            rates = along / slow + pull
            needed[k] = max(needed[k], slow * torques.excess(q, rates, x, J, acceleration))
            if motors == "sudden" and not jump:
                needed[k] = max(needed[k], slow * torques.jolt(q, rates, before))
            before = rates
        close = 1 - math.exp(-RETURN_RATE * period * slow)
        free = q + period * (along + slow * pull) + close * back
        q = np.clip(free, card.lower, card.upper)
        settled = settled and bool((q == free).all())  # a joint at its end: no pace helps it back
    return needed


class _Torques:
    """How much slower a motion has to be for the motors' torques."""

    def __init__(self, kinematics: Kinematics, solve: Solve) -> None:
        self._solve, self._parts = solve, kinematics.task.parts
        self._dynamics = Dynamics(kinematics)
        self._most = LIMIT_SHARE * kinematics.card.effort

    def excess(self, q: Floats, rates: Floats, x: Floats, J: Floats, slope: Floats) -> float:
        """By which factor, from joint rates (n,) and the tool's acceleration (6,)."""
        wanted = slope - drift_acceleration(J, rates)
        answers = [wanted] * len(self._parts)
        return self._slower(q, rates, self._solve(State(x, J, q), answers, np.zeros_like(q)))

    def jolt(self, q: Floats, rates: Floats, before: Floats) -> float:
        """The same, where motors take up rates (n,) that follow on others at once.

        The factor is that of a smooth motion, whose rates change with the square of the pace. At a
        corner they change with the pace itself, and it takes a few passes to get there.
        """
        return self._slower(q, rates, (rates - before) / SUDDEN_TIME)

    def _slower(self, q: Floats, rates: Floats, bend: Floats) -> float:
        weight = self._dynamics.weight(q)
        moving = np.abs(self._dynamics.torque(q, rates, bend) - weight)
        room = self._most - np.abs(weight)
        over = (
            room > LEAST_SHARE * self._most
        )  # no pace helps a motor that can hardly bear the weight
        return float(np.sqrt(np.max(moving[over] / room[over], initial=0.0)))
