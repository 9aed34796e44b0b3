"""Joint rates and torques -> commands within an arm's limits, and a record of each clamp."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dqpaint.diagnostics import SourceLine
from dqpaint.dq import Floats
from dqpaint.motion import RowLines
from dqpaint.robots.model.card import Card

LIMIT_TOLERANCE = 1e-6  # relative: a motor this close to its largest torque is saturated
DIGITS, MOST_DIGITS = 4, 10  # of an amount; the most where it hardly differs from its limit

Clipped = Mapping[str, NDArray[np.bool_]]
"""By kinds of limits that were met: whether one of that kind clipped a joint in a row (N, n)."""
UNITS = {"position": "rad", "speed": "rad/s", "torque": "Nm"}


@dataclass(frozen=True)
class Clamp:
    """A joint limit that clipped commands for some time.

    Attributes:
        kind: `position`, `speed` or `torque`.
        joint: its number, from 1.
        start: when it began [s].
        seconds: for how long, gaps left out.
        line: of the drawing, that was being drawn.
        limit: [rad], [rad/s] or [Nm].
        wanted: the largest requested value, in the same unit; the limit itself where a motor
            with rate commands saturates, as there is no requested torque.
    """

    kind: str
    joint: int
    start: float
    seconds: float
    line: SourceLine
    limit: float
    wanted: float

    def __str__(self) -> str:
        limit, wanted = self.amounts
        unit = {"position": "deg", "speed": "deg/s", "torque": "Nm"}[self.kind]
        asked = f", {wanted} asked for" if self.wanted != self.limit else ""
        return (
            f"joint {self.joint} for {self.seconds:.3g} s from {self.start:.3f} s on "
            f"({limit} {unit}{asked})"
        )

    @property
    def amounts(self) -> tuple[str, str]:
        """The limit and the requested value in deg, deg/s or Nm, with the digits that differ."""
        scale = 1.0 if self.kind == "torque" else math.degrees(1)
        both = self.limit * scale, self.wanted * scale
        shown = ((f"{both[0]:.{d}g}", f"{both[1]:.{d}g}") for d in range(DIGITS, MOST_DIGITS))
        return next((pair for pair in shown if pair[0] != pair[1]), (f"{both[0]:.{DIGITS}g}",) * 2)


class RateBounds:
    """The bounds of joint rates at a posture for one period."""

    def __init__(self, card: Card, period: float) -> None:
        self._lower, self._upper, self._speed = card.lower, card.upper, card.speed
        self._period = period

    def clip(self, rates: Floats, posture: Floats) -> Floats:
        """Clip rates (..., n) [rad/s] to the speed limits and, after a period, position limits.

        A joint that is beyond a limit already may only come back.
        """
        low = np.maximum(-self._speed, (self._lower - posture) / self._period)
        high = np.minimum(
            self._speed, np.maximum((self._upper - posture) / self._period, -self._speed)
        )
        # `high` comes last: where `low` asks a joint to come back faster than it can, speed wins
        return np.asarray(np.minimum(np.maximum(rates, low), high))


def find_clamps(
    card: Card,
    t: Floats,
    source: RowLines,
    posture: Floats,
    wanted: Floats,
    command: Floats,
    effort: Floats,
    torques: bool,
    period: float | None = None,
) -> tuple[tuple[Clamp, ...], Clipped]:
    """All clamps of a run, one for each joint, kind and line, and the rows and joints of each kind.

    Args:
        card: with the limits.
        t: (N,) [s].
        source: the source line (N,) of each row.
        posture: (N, n) [rad], as the encoders read it where the commands are rates.
        wanted: the output of the law (N, n), rates [rad/s] or torques [Nm].
        command: what the arm was given (N, n).
        effort: motor torques (N, n) [Nm], the largest seen in the period before each row.
        torques: whether the commands are torques.
        period: of the control [s], where the times do not show it.
    """
    period = period or (float(t[1] - t[0]) if len(t) > 1 else 0.0)
    found: list[Clamp] = []
    kinds = (
        _torque_clamps(card, posture, wanted, command)
        if torques
        else _rate_clamps(card, period, posture, wanted, command, effort)
    )
    for kind, where, asked, most in kinds:
        for joint in range(where.shape[1]):
            found += _by_line(
                kind, joint, where[:, joint], asked[:, joint], most[:, joint], t, source, period
            )
    clamps = tuple(sorted(found, key=lambda clamp: clamp.start))
    return clamps, {kind: where for kind, where, _, _ in kinds if where.any()}


Held = tuple[str, NDArray[np.bool_], Floats, Floats]  # kind; where, requested value, limit (N, n)


def _rate_clamps(
    card: Card, period: float, posture: Floats, wanted: Floats, command: Floats, effort: Floats
) -> list[Held]:
    held = wanted != command
    fast = held & (np.abs(command) >= card.speed * (1 - LIMIT_TOLERANCE))
    ahead = posture + period * wanted
    limit = np.where(wanted > command, card.upper, card.lower)
    saturated = np.zeros_like(held)
    saturated[:-1] = np.abs(effort[1:]) >= card.effort * (
        1 - LIMIT_TOLERANCE
    )  # of the step from row k
    torque = np.broadcast_to(card.effort, held.shape)
    return [
        ("position", held & ~fast, ahead, limit),
        ("speed", fast, np.abs(wanted), np.broadcast_to(card.speed, held.shape)),
        ("torque", saturated, torque, torque),
    ]


def _torque_clamps(card: Card, posture: Floats, wanted: Floats, command: Floats) -> list[Held]:
    """Clamps with torque commands: position limits are mechanical stops; speed has no limit."""
    limit = np.where(posture > card.upper, card.upper, card.lower)
    beyond = (posture > card.upper) | (posture < card.lower)
    most = np.broadcast_to(card.effort, wanted.shape)
    return [
        ("position", beyond, posture, limit),
        ("torque", wanted != command, np.abs(wanted), most),
    ]


def _by_line(
    kind: str,
    joint: int,
    where: NDArray[np.bool_],
    asked: Floats,
    most: Floats,
    t: Floats,
    source: RowLines,
    period: float,
) -> list[Clamp]:
    out = []
    rows = np.flatnonzero(where)
    for line in np.unique(source.index[rows]):
        here = rows[source.index[rows] == line]
        worst = here[np.argmax(np.abs(asked[here]))]
        out.append(
            Clamp(
                kind=kind,
                joint=joint + 1,
                start=float(t[here[0]]),
                seconds=float(len(here) * period),
                line=source.at(int(here[0])),
                limit=float(most[worst]),
                wanted=float(asked[worst]),
            )
        )
    return out
