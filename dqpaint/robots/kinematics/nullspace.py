"""`--null NAME[,gain=VALUE]` -> the secondary task of a redundant arm in its null space.

Each objective is a number h(q) that should become small; the null space is given its negative
gradient, z = -gain dh/dq. A new objective is a class here under `@OBJECTIVES.add(name)`.
"""

import math
from collections.abc import Callable
from typing import ClassVar, Protocol

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from dqpaint import dq
from dqpaint.core import Registry, make_choice, read_choice
from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.robots.kinematics.differential_ik import START_GAIN, tool_jacobian_map
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import Card

DEFAULT_OBJECTIVE = "start"
MOST_GAIN = 20.0  # times the period must stay below 1, or the null space swings


class Objective(Protocol):
    """An objective for one arm and start posture; arrays may have any leading shape.

    Attributes:
        default_gain: its gain where none is given.
        unit: of the gain.
    """

    default_gain: ClassVar[float]
    unit: ClassVar[str]

    def __init__(self, card: Card, start: Floats) -> None: ...

    def value(self, posture: Floats, jacobian: Floats, point: Floats) -> float:
        """The value to be minimised, at a posture (n,) [rad].

        Given are J_w (6, n) and the tool's place (3,) [m] there.
        """

    def gradient(self, posture: Floats, jacobian: Floats, point: Floats) -> Floats:
        """The gradient dh/dq (n,)."""


OBJECTIVES: Registry[type[Objective]] = Registry("null-space objective")


@OBJECTIVES.add("start")
class Start:
    """Back to the start posture, so that a closed drawing is closed in joint space, too."""

    default_gain: ClassVar[float] = START_GAIN
    unit: ClassVar[str] = "1/s"

    def __init__(self, card: Card, start: Floats) -> None:
        self._goal = start

    def value(self, posture: Floats, jacobian: Floats, point: Floats) -> float:
        """Half the squared distance [rad^2]."""
        return float(0.5 * ((posture - self._goal) ** 2).sum())

    def gradient(self, posture: Floats, jacobian: Floats, point: Floats) -> Floats:
        """The displacement from the start posture (n,) [rad]."""
        return posture - self._goal


@OBJECTIVES.add("home")
class Home(Start):
    """Towards the arm's home posture."""

    def __init__(self, card: Card, start: Floats) -> None:
        super().__init__(card, card.home)


@OBJECTIVES.add("limits")
class Limits:
    """Away from the joint limits.

    h = 1/4 sum r^2 u^4, with r half a joint's range and u its place in it from -1 to 1: flat in the
    middle, steep near a limit (after Liegeois 1977, who has u^2).
    """

    default_gain: ClassVar[float] = 2.0
    unit: ClassVar[str] = "1/s"

    def __init__(self, card: Card, start: Floats) -> None:
        self._middle, self._half = (card.upper + card.lower) / 2, (card.upper - card.lower) / 2

    def value(self, posture: Floats, jacobian: Floats, point: Floats) -> float:
        """The sum over the joints [rad^2]."""
        u = (posture - self._middle) / self._half
        return float(0.25 * (self._half**2 * u**4).sum())

    def gradient(self, posture: Floats, jacobian: Floats, point: Floats) -> Floats:
        """R u^3 of each joint (n,) [rad]."""
        u = (posture - self._middle) / self._half
        return np.asarray(self._half * u**3)


@OBJECTIVES.add("manipulability")
class Manipulability:
    """Away from singularities, towards good mobility in all directions.

    h = -sqrt(det(J J')), J at the tool with lengths in units of 0.3 m (Yoshikawa 1985).
    """

    default_gain: ClassVar[float] = 1.0
    unit: ClassVar[str] = "rad^2/s"

    def __init__(self, card: Card, start: Floats) -> None:
        pass

    def value(self, posture: Floats, jacobian: Floats, point: Floats) -> float:
        """The negative manipulability, without unit."""
        J = tool_jacobian_map(point) @ jacobian
        return -float(np.sqrt(max(np.linalg.det(J @ J.T), 0.0)))

    def gradient(self, posture: Floats, jacobian: Floats, point: Floats) -> Floats:
        """-w tr((J J')^-1 dJ/dq_k J') for each k (n,); zero in a singular posture.

        The determinant is the same about every point, and column j of J_w changes with a joint k
        before it by s_k x s_j.
        """
        shift = tool_jacobian_map(point)
        J = shift @ jacobian
        square = J @ J.mT
        volume = np.linalg.det(square)
        singular = volume < 1e-18
        if singular.any():
            square = np.where(singular[..., None, None], np.eye(6), square)
            volume = np.where(singular, 0.0, volume)
        inverse = np.linalg.solve(square, J)  # (..., 6, n)
        columns, n = jacobian.mT, jacobian.shape[-1]
        change = dq.spatial_cross(columns[..., :, None, :], columns[..., None, :, :])
        change *= _BEFORE[:n, :n, None]  # (..., k, j, 6)
        along = change @ shift.mT[..., None, :, :]
        trace = (along * inverse.mT[..., None, :, :]).sum(axis=(-2, -1))
        return np.asarray(-np.sqrt(volume)[..., None] * trace)


@OBJECTIVES.add("none")
class NoObjective:
    """Least joint motion only: there is no objective, and the joints may drift."""

    default_gain: ClassVar[float] = 0.0
    unit: ClassVar[str] = "1/s"

    def __init__(self, card: Card, start: Floats) -> None:
        self._zero = np.zeros(card.joints)

    def value(self, posture: Floats, jacobian: Floats, point: Floats) -> float:
        """Always zero."""
        return 0.0

    def gradient(self, posture: Floats, jacobian: Floats, point: Floats) -> Floats:
        """Zero (n,)."""
        return self._zero


_BEFORE = np.triu(np.ones((64, 64)), 1)


class SecondaryTask:
    """An objective with its gain."""

    def __init__(self, objective: Objective, gain: float) -> None:
        self._objective, self._gain = objective, -gain

    def __call__(self, posture: Floats, jacobian: Floats, point: Floats) -> Floats:
        """The joint rates -gain dh/dq (n,) [rad/s] for the null space."""
        return self._gain * self._objective.gradient(posture, jacobian, point)

    def displacement(
        self, seconds: float, posture: Floats, jacobian: Floats, point: Floats
    ) -> Floats:
        """The displacement of the joints (n,) [rad] in a time, without other motion.

        As though h were half a squared distance, which it is for pulls towards a posture: however
        long the time, none goes too far.
        """
        part = math.expm1(self._gain * seconds)
        return part * self._objective.gradient(posture, jacobian, point)


class _Gain(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)
    gain: float | None = Field(
        None, ge=0, le=MOST_GAIN, allow_inf_nan=False, description="how strongly, 0 to 20"
    )


def read_null(text: str) -> tuple[str, float]:
    """Parse the name and gain of a text like `limits` or `limits,gain=3`.

    Raises:
        UsageError: an unknown objective, or no such gain.
    """
    name, values = read_choice("null-space objective", text, "limits,gain=3")
    usual = OBJECTIVES[name].default_gain
    if values and name == "none":
        raise UsageError("null-space objective 'none' takes no gain")
    given = make_choice("null-space objective", name, _Gain, values).gain
    return name, usual if given is None else given


def make_secondary_task(text: str, card: Card, start: Floats) -> SecondaryTask:
    """The secondary task of an arm with start posture (n,) [rad].

    Raises:
        UsageError: as `read_null`.
    """
    name, gain = read_null(text)
    return SecondaryTask(OBJECTIVES[name](card, start), gain)


def make_batched_task(
    text: str, kinematics: Kinematics
) -> Callable[[Floats, Floats, float], Floats]:
    """The same for many postures, in the form that `find_start` takes.

    Raises:
        UsageError: as `read_null`.
    """
    name, gain = read_null(text)
    card = kinematics.card

    def pull(postures: Floats, starts: Floats, seconds: float) -> Floats:
        ways = []
        for posture, start in zip(postures, starts, strict=True):
            x, J = kinematics.pose_and_jacobian(posture)
            wish = SecondaryTask(OBJECTIVES[name](card, start), gain)
            ways.append(wish.displacement(seconds, posture, J, dq.translation(x)))
        return np.array(ways)

    return pull
