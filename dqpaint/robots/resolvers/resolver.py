"""`--resolver NAME[,KEY=VALUE...]` -> what turns commanded twists into joint rates in a run.

A new resolver is a class under `@RESOLVERS.add(name)` in a module of this folder.
"""

from collections.abc import Sequence
from typing import ClassVar, NamedTuple, Protocol

from pydantic import BaseModel, ConfigDict

from dqpaint.core import Registry, make_choice, read_choice
from dqpaint.dq import Floats
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.model import POSE, Task
from dqpaint.robots.walls import Walls

DEFAULT_RESOLVER = "filter"


class State(NamedTuple):
    """The measured state that rates are worked out for; arrays may have any leading shape.

    Attributes:
        pose: of the tool (..., 8).
        jacobian: J_w (..., 6, n), spatial.
        posture: (..., n) [rad].
        t: of the run [s].
    """

    pose: Floats
    jacobian: Floats
    posture: Floats
    t: float = 0.0


class Setup(NamedTuple):
    """What a resolver knows of a run.

    Attributes:
        kinematics: the law's model of the arm.
        period: of the control [s].
        task: which part of the pose is controlled.
        walls: of the drawing, where they stand.
    """

    kinematics: Kinematics
    period: float
    task: Task = POSE
    walls: Walls | None = None


class Values(BaseModel):
    """The values of a resolver, each with its default and a description."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


class Resolver(Protocol):
    """A resolver of one run.

    Attributes:
        options: the model of its values.
        batched: whether it takes many arms at once, as arrays of any leading shape.
        holds_rates: whether it changes joint rates that a law commands by itself, too.
    """

    options: ClassVar[type[Values]]
    batched: ClassVar[bool]
    holds_rates: ClassVar[bool]

    def __init__(self, setup: Setup, values: Values) -> None: ...

    def rates(self, state: State, twists: Sequence[Floats], wish: Floats | None) -> Floats:
        """The joint rates (..., n) [rad/s].

        Args:
            state: measured.
            twists: spatial (..., 6) [rad/s, m/s], one for each part of the task.
            wish: of the null space (..., n) [rad/s]; None is the least motion.
        """

    def null_motion(self, state: State, wish: Floats) -> Floats:
        """The rates (..., n) of a wish of the null space alone: the tool stays."""

    def allowed(self, state: State, rates: Floats) -> Floats:
        """The rates (..., n) that are given in place of some that a law commands."""


RESOLVERS: Registry[type[Resolver]] = Registry("resolver")


def read_resolver(text: str) -> tuple[type[Resolver], Values]:
    """The resolver and its values of a text like `filter` or `qp,eta=5`.

    Raises:
        UsageError: an unknown resolver, or no such value.
    """
    name, values = read_choice("resolver", text, "uniform,factor=0.1")
    kind = RESOLVERS[name]
    return kind, make_choice("resolver", name, kind.options, values)


def planning_resolver(text: str, kinematics: Kinematics, period: float) -> Resolver:
    """What foresees a run: its resolver, but the default one for a resolver that holds back.

    What that would hold back is what is to be foreseen.

    Raises:
        UsageError: as `read_resolver`.
    """
    foreseen = DEFAULT_RESOLVER if read_resolver(text)[0].holds_rates else text
    return make_resolver(foreseen, Setup(kinematics, period, kinematics.task))


def make_resolver(text: str, setup: Setup) -> Resolver:
    """The resolver of a run.

    Raises:
        UsageError: as `read_resolver`; a value that does not go with the period.
    """
    kind, values = read_resolver(text)
    return kind(setup, values)
