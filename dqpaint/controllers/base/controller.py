"""A function or class, its gains and what it commands -> a named law, started for each run."""

from collections.abc import Callable, Mapping
from copy import deepcopy
from dataclasses import dataclass, field
from typing import Any, Generic, Literal, Protocol, TypeVar, cast

import numpy as np

from dqpaint.controllers.base.arm import Arm
from dqpaint.controllers.base.gain_schedule import GainText, Schedule, read_schedule
from dqpaint.controllers.base.gains import G, Gains, list_gains
from dqpaint.controllers.base.seen import Seen
from dqpaint.controllers.base.signs import SignRule
from dqpaint.core import Folder, Registry
from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.motion import Motion

Commands = Literal["twist", "rates", "acceleration", "torque"]
Sense = Literal["light", "push"]
Controls = Literal["pose", "position", "orientation", "nothing"]
PAPER = "paper"  # what a gain is given as to get those of the law's paper
Law = Callable[[Seen, G], Floats]
GainsOf = TypeVar("GainsOf", bound=Gains, contravariant=True)


class LawClass(Protocol[GainsOf]):
    """A law with state: a class without arguments, of which each run makes an object.

    Before the first step its `start(arm, motion, gains)` is called, if it has one: with the `Arm`,
    the whole `Motion` and the `Schedule` of the gains. It returns nothing.
    """

    def __init__(self) -> None: ...

    def __call__(self, seen: Seen, gains: GainsOf) -> Floats:
        """The command."""


@dataclass(frozen=True)
class Controller(Generic[G]):
    """A named law.

    Attributes:
        name: by which it is chosen.
        source: the paper and its equation.
        gains: the model of its gains.
        law: `Seen` and gains -> a command: a function, which has no state, or a class, which may.
        commands: the kind of the command: a spatial `twist` (..., 6), joint `rates` (..., n), a
            spatial `acceleration` (..., 6) or joint `torque` (..., n).
        leaves_null: whether its joint rates have no part in the null space, so that the
            objective of `--null` is added to them. A twist or an acceleration always leaves it.
        batched: whether it can drive many arms at once, as arrays of any leading shape.
        sha256: of the file of a user's law.
        controls: what it brings to a set point: the `pose`, the `position` or the `orientation`
            alone, or `nothing`.
        paper: the gains of its paper's experiments, as texts and numbers; empty where it prints
            none.
        paper_source: where the paper has them.
        heeds_sign: whether it goes to the side of the double cover that `--sign` chooses; None of a
            user's law, which may.
        senses: what it is given of `Seen.light` and `Seen.push`.
        sign: what makes the sign rule of a run; None is the nearest side.
    """

    name: str
    source: str
    gains: type[G]
    law: Law[G] | type[LawClass[G]]
    commands: Commands = "twist"
    leaves_null: bool = False
    batched: bool = False
    sha256: str | None = None
    controls: Controls = "pose"
    paper: Mapping[str, GainText] = field(default_factory=dict)
    paper_source: str = ""
    heeds_sign: bool | None = True
    senses: tuple[Sense, ...] = ()
    sign: Callable[[], SignRule] | None = None

    @property
    def summary(self) -> str:
        """The first sentence of the law's own docstring."""
        return (self.law.__doc__ or "").strip().splitlines()[0].rstrip(".")

    @property
    def docstring(self) -> str:
        """The law's own docstring, see `dqpaint.core.texts.explanations`."""
        return self.law.__doc__ or ""

    @property
    def is_resolved(self) -> bool:
        """Whether it commands the tool, and a resolver finds what the joints do for it."""
        return self.commands in ("twist", "acceleration")

    @property
    def drives_torque(self) -> bool:
        """Whether it needs a plant that takes torques."""
        return self.commands in ("acceleration", "torque")

    def start(self, arm: Arm, motion: Motion, gains: Schedule[G]) -> Law[G]:
        """The law of one run, which shares no state with that of any other.

        Args:
            arm: the law's model of the arm.
            motion: the reference.
            gains: over the drawing.

        Raises:
            DqpaintError: a user's law has a fault.
        """
        law = for_one_run(self.law)
        if hasattr(type(law), "start"):
            law.start(arm, motion, gains)
        return self.with_sign_rule(cast(Law[G], law))

    def with_sign_rule(self, law: Law[G]) -> Law[G]:
        """The law of one run, seeing the desired pose on the side that `sign` chooses."""
        if self.sign is None:
            return law
        choose = self.sign()
        return lambda seen, gains: law(choose(seen), gains)

    def read_gains(self, given: Mapping[str, GainText]) -> Schedule[G]:
        """The gains with the given ones replaced, over the drawing.

        `{"paper": "paper"}` stands for those of the law's paper; others have precedence over them.

        Raises:
            UsageError: an unknown name, no value, or one outside its range; lists the law's own.
                The paper prints no gains.
        """
        if given.get(PAPER) == PAPER:
            if not self.paper:
                raise UsageError(
                    f"the paper of controller '{self.name}' ({self.source}) states no gains; "
                    f"laws with gains of their papers: {', '.join(_with_paper_gains())}"
                )
            chosen = {name: value for name, value in given.items() if name != PAPER}
            given = {**self.paper, **chosen}
        return read_schedule(self.gains, given, f"controller '{self.name}'")

    def list_gains(self) -> str:
        """Name, default and unit of every gain, as text."""
        return list_gains(self.gains)


def for_one_run(law: Any) -> Any:
    """The law of one run: of a class a new object, of an object a deep copy, else what is given.

    Arrays, lists, dictionaries and sets that a class keeps are copied, too: `self.sum += error`
    would otherwise change one that all its objects share.
    """
    fresh = law() if isinstance(law, type) else deepcopy(law)  # a function's copy is itself
    own = getattr(fresh, "__dict__", {})
    for base in type(fresh).__mro__:
        for name, value in vars(base).items():
            if isinstance(value, np.ndarray | list | dict | set) and not name.startswith("__"):
                own.setdefault(name, deepcopy(value))
    return fresh


def _with_paper_gains() -> list[str]:
    return [name for name, one in CONTROLLERS.items() if one.paper]


def _from_plugin(name: str, law: Any) -> Controller[Any]:
    """The law of an entry point: a `Controller`, or a law as in a user's file."""
    if isinstance(law, Controller):
        return law
    from dqpaint.controllers.base.user_controller import make_controller

    return make_controller(law, name)


CONTROLLERS: Registry[Controller[Any]] = Folder(
    "controller", "dqpaint.controllers.laws", "dqpaint.controllers", _from_plugin
)
L = TypeVar("L", bound=Callable[..., Any])


def controller(
    name: str,
    source: str,
    gains: type[G],
    commands: Commands = "twist",
    leaves_null: bool = False,
    controls: Controls = "pose",
    paper: Mapping[str, GainText] | None = None,
    paper_source: str = "",
    heeds_sign: bool | None = None,
    senses: tuple[Sense, ...] = (),
) -> Callable[[L], L]:
    """A decorator that registers the function or class below it; arguments as in `Controller`.

    Its docstring is its explanation, see `dqpaint.core.texts.explanations`.

    A law that brings an orientation home heeds `--sign`, if `heeds_sign` does not say otherwise.
    A function goes in batches; a class, whose state may be that of one arm, where it says
    `batched = True`.
    """

    def record(law: L) -> L:
        batched = getattr(law, "batched", not isinstance(law, type))
        heeds = controls in ("pose", "orientation") if heeds_sign is None else heeds_sign
        CONTROLLERS.add(name)(Controller(
            name, source, gains, law, commands, leaves_null, batched, None, controls,
            paper or {}, paper_source, heeds, senses,
        ))  # fmt: skip
        return law

    return record
