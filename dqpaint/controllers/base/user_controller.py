"""A user's function or class -> a control law: `--controller mylaw.py[:NAME]`.

    from dqpaint import dq

    def mylaw(seen, k=20.0):
        error = dq.mul(seen.pose_d, dq.conj(dq.nearest(seen.pose, seen.pose_d)))
        return seen.twist_d + 2 * k * dq.log(error)

It takes a `Seen` and returns a spatial twist; `@commands("rates")` or `@commands("torque")` above
it says that it returns joint rates or torques. Further parameters with a number each are its gains.

A law with state is a class: `__call__(self, seen, k=20.0)` is then the law, and each run makes
an object of its own. Where the class has it, `start(self, arm, motion, gains)` is called before the
first step. An object of a class, handed over in Python, is copied for each run as it was given.
"""

import hashlib
import inspect
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Annotated, Any, TypeVar, cast, get_args, get_type_hints

import numpy as np
from pydantic import Field, create_model
from typing_extensions import override

from dqpaint.controllers.base.answers import check_answer
from dqpaint.controllers.base.arm import Arm
from dqpaint.controllers.base.controller import (
    CONTROLLERS,
    Commands,
    Controller,
    Law,
    for_one_run,
)
from dqpaint.controllers.base.gain_schedule import Schedule
from dqpaint.controllers.base.gains import Gains
from dqpaint.controllers.base.seen import Seen
from dqpaint.core import AnswerError, UserCode, find_in_file, short_name, split_spec
from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.motion import Motion

Decorated = TypeVar("Decorated", bound=Callable[..., Any])
Finite = Annotated[float, Field(allow_inf_nan=False)]

LAW_HELP = (
    "a law is a function of what it sees, and of gains with a number each: def law(seen, k=20.0); "
    "one that remembers is a class with def __call__(self, seen, k=20.0)"
)
STATE = ("pose", "jacobian", "posture", "rates", "inertia", "bias")
"""What `Seen` has of the arm's own arrays; the reference is the motion's, which is read-only."""
START_SIGNATURE = "def start(self, arm, motion, gains)"


def commands(kind: Commands) -> Callable[[Decorated], Decorated]:
    """A decorator that declares the kind of a law's command; without it, a spatial twist.

    Args:
        kind: `twist`, `rates` [rad/s], `acceleration` or `torque` [Nm].
    """
    if kind not in get_args(Commands):
        raise ValueError(f"a law can't command '{kind}'; known: {', '.join(get_args(Commands))}")

    def record(law: Decorated) -> Decorated:
        setattr(law, "commands", kind)  # noqa: B010  of a function or a class
        return law

    return record


def find_controller(spec: str) -> Controller[Any]:
    """The law of a name, or of a file `mylaw.py` or `mylaw.py:NAME`.

    Raises:
        UsageError: no law has that name; the file has none, or several and none was named.
        DqpaintError: the file cannot be read or run.
    """
    if split_spec(spec) is None:
        return CONTROLLERS[spec]
    law, path, digest = find_in_file(
        "law", spec, lambda thing: not isinstance(thing, type) or _is_callable(thing), LAW_HELP
    )
    return make_controller(law, short_name(spec), path, digest)


def make_controller(
    law: Any, name: str, path: Path | None = None, digest: str = ""
) -> Controller[Any]:
    """The law of a function, a class or an object of one.

    Args:
        law: called with what it sees, and its gains.
        name: as the law is to be called.
        path: of the file it stands in, for messages; found by itself if not given.
        digest: SHA-256 of the text that was run; of the file as it is now if not given.

    Raises:
        UsageError: it can't be called, or its parameters, its constructor, its `start` or what it
            commands are not those of a law.
    """
    title = getattr(law, "__name__", type(law).__name__)
    if not (_is_callable(law) if isinstance(law, type) else callable(law)):
        what = f"class '{title}'" if isinstance(law, type) else f"controller {str(law)[:40]!r}"
        raise UsageError(f"{what} can't be called: it has no __call__; {LAW_HELP}")
    body, owner = _body(law), _owner(law)
    code = getattr(body, "__code__", None)
    path = path or Path(code.co_filename if code and Path(code.co_filename).is_file() else "?")
    where = f"law '{title}' in {path.name}"
    _check_returns(body, where)
    _check_start(law, owner, where)
    model = _gains(law, body, where)
    kind = getattr(owner, "commands", getattr(body, "commands", "twist"))
    if not (isinstance(kind, str) and kind in get_args(Commands)):
        raise UsageError(
            f"{where} can't command {kind!r}; known: {', '.join(get_args(Commands))}; "
            'write @commands("rates") above it'
        )
    if not digest and path.is_file():
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
    return UserController(
        name, str(path), model, law, cast(Commands, kind), sha256=digest, path=path,
        place=f"{path.name}:{code.co_firstlineno}" if code else path.name,
        about=inspect.getdoc(owner) or inspect.getdoc(body) or f"The law of {path.name}.",
        batched=getattr(owner, "batched", False) is True, heeds_sign=None,
    )  # fmt: skip


@dataclass(frozen=True)
class UserController(Controller[Gains]):
    """A user's law: faults are reported with the lines of its file, returned values are checked.

    Attributes:
        path: of its file.
        place: file and line of the law, for messages.
        about: the law's docstring.
    """

    path: Path = field(kw_only=True)
    place: str = field(kw_only=True)
    about: str = field(kw_only=True)

    @property
    @override
    def summary(self) -> str:
        return self.about.splitlines()[0].rstrip(".")

    @property
    @override
    def docstring(self) -> str:
        return self.about

    @override
    def start(self, arm: Arm, motion: Motion, gains: Schedule[Gains]) -> Law[Gains]:
        with UserCode(self.path):
            law = for_one_run(self.law)
            said = law.start(arm, motion, gains) if hasattr(type(law), "start") else None
        if said is not None:
            raise AnswerError(
                f"{self.path.name}: start of law '{type(law).__name__}' returned a "
                f"{type(said).__name__}; it returns nothing: what it works out is kept in self"
            )
        return self.with_sign_rule(CheckedLaw(law, self))


class CheckedLaw:
    """The law of one run; its returned values are checked."""

    def __init__(self, law: Callable[..., Any], controller: UserController) -> None:
        self._law, self._kind, self._place = law, controller.commands, controller.place
        self._running = UserCode(controller.path)

    def __call__(self, seen: Seen, gains: Gains) -> Floats:
        """What the law returns, (..., 6) or (..., n)."""
        seen = _copied(seen)
        *batch, joints = seen.posture.shape
        size = 6 if self._kind in ("twist", "acceleration") else joints
        with self._running:
            said = self._law(seen, **dict(gains))
            answer = check_answer(said, (*batch, size), self._kind, self._place)
        if not np.isfinite(answer).all():
            raise AnswerError(
                f"{self._place}: at {seen.time:.3f} s the law returned {answer}, not finite numbers"
            )
        return answer


def _copied(seen: Seen) -> Seen:
    """What a law sees, in read-only arrays of its own: what the arm does is not its to change."""
    own: dict[str, Any] = {name: np.copy(getattr(seen, name)) for name in STATE}
    for array in own.values():
        array.flags.writeable = False
    return seen._replace(**own)


def _owner(law: Any) -> Any:
    """The function or class that declares a law: of an object, its class."""
    if isinstance(law, partial):
        return _body(law)
    return law if isinstance(law, type) or inspect.isroutine(law) else type(law)


def _body(law: Any) -> Any:
    """The function that is called at each step."""
    if isinstance(law, partial):
        return _body(law.func)
    return inspect.unwrap(law if inspect.isroutine(law) else law.__call__)


def _is_callable(kind: type) -> bool:
    """Whether objects of a class can be called."""
    return any("__call__" in vars(base) for base in kind.__mro__)


def _check_returns(body: Any, where: str) -> None:
    """Check that a law returns its command."""
    for test, word in (
        (inspect.isgeneratorfunction, "yields"),
        (inspect.iscoroutinefunction, "is async"),
        (inspect.isasyncgenfunction, "is async"),
    ):
        if test(body):
            raise UsageError(f"{where} {word}, but a law returns what it commands; {LAW_HELP}")


def _check_start(law: Any, owner: Any, where: str) -> None:
    """Check that each run can make an object of a class and start it."""
    if isinstance(law, type):
        needed = [one.name for one in _parameters(law, where) if _is_needed(one)]
        if needed:
            raise UsageError(
                f"{where}: each run makes a {law.__name__}() of its own, but '{needed[0]}' of its "
                f"constructor has no default; from Python, draw(controller={law.__name__}(...)) "
                "takes an object"
            )
    start = getattr(owner, "start", None) if isinstance(owner, type) else None
    if start is None:
        return
    try:
        inspect.signature(start).bind("self", "arm", "motion", "gains")
    except (TypeError, ValueError):
        raise UsageError(f"{where}: its start is not {START_SIGNATURE}") from None


def _parameters(called: Any, where: str) -> list[inspect.Parameter]:
    try:
        return list(inspect.signature(called).parameters.values())
    except (TypeError, ValueError):
        raise UsageError(f"{where}: its parameters can't be read; {LAW_HELP}") from None


def _is_needed(parameter: inspect.Parameter) -> bool:
    variable = parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD)
    return parameter.default is parameter.empty and not variable


def _gains(law: Any, body: Any, where: str) -> type[Gains]:
    """A model of the gains a law takes after what it sees."""
    of_class = isinstance(law, type)
    parameters = _parameters(law.__call__ if of_class else law, where)[of_class:]  # without self
    if not parameters:
        raise UsageError(f"{where} takes nothing; {LAW_HELP}")
    fields: dict[str, Any] = {}
    hints = _hints(body)
    for parameter in parameters[1:]:
        default = parameter.default
        is_number = isinstance(default, int | float) and not isinstance(default, bool)
        if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD) or not is_number:
            raise UsageError(f"{where}: parameter '{parameter.name}' has no number; {LAW_HELP}")
        if parameter.name.startswith("_") or hasattr(Gains, parameter.name):
            raise UsageError(
                f"{where}: a gain can't be called '{parameter.name}'; choose another name"
            )
        number = _finite(default)
        if number is None:
            raise UsageError(
                f"{where}: parameter '{parameter.name}' is {str(default)[:20]}, "
                f"not a finite number; {LAW_HELP}"
            )
        unit = getattr(hints.get(parameter.name), "__metadata__", ("",))[0]
        fields[parameter.name] = (Finite, Field(number, description=unit or "no unit said"))
    return create_model("OwnGains", __base__=Gains, **fields)


def _finite(default: int | float) -> float | None:
    try:
        return float(default) if math.isfinite(default) else None
    except OverflowError:  # a whole number that no float holds
        return None


def _hints(function: Callable[..., Any]) -> dict[str, Any]:
    """The annotations, also where the file puts their evaluation off."""
    try:
        return get_type_hints(function, include_extras=True)
    except (NameError, TypeError, AttributeError):
        return {}
