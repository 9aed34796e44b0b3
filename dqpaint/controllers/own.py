"""A control law of one's own: a function in a Python file, `--controller mylaw.py[:NAME]`.

    from dqpaint import dq

    def mylaw(seen, k=20.0):
        error = dq.mul(seen.pose_d, dq.conj(dq.nearest(seen.pose, seen.pose_d)))
        return seen.twist_d + 2 * k * dq.log(error)

It sees a `Seen` and returns a spatial twist; `@commands("rates")` or `@commands("torque")` above it
says that it returns joint rates or torques. Further parameters with a number each are its gains.
"""

import hashlib
import inspect
import linecache
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Annotated, Any, TypeVar, get_args, get_type_hints

import numpy as np
from pydantic import Field, create_model

from dqpaint.controllers.gains import Gains
from dqpaint.controllers.law import CONTROLLERS, Commands, Controller, Seen
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.examples import examples_folder

Function = TypeVar("Function", bound=Callable[..., Any])
Finite = Annotated[float, Field(allow_inf_nan=False)]
WORDS = {
    "twist": "a twist",
    "rates": "joint rates",
    "acceleration": "an acceleration",
    "torque": "joint torques",
}
HOW = "a law is a function of what it sees, and of gains with a number each: def law(seen, k=20.0)"


def commands(kind: Commands) -> Callable[[Function], Function]:
    """A decorator that says what a law returns; one without it returns a spatial twist.

    Args:
        kind: `twist`, `rates` [rad/s], `acceleration` or `torque` [Nm].
    """
    if kind not in get_args(Commands):
        raise ValueError(f"a law can't command '{kind}'; known: {', '.join(get_args(Commands))}")

    def record(function: Function) -> Function:
        vars(function)["commands"] = kind
        return function

    return record


def is_file(spec: str) -> bool:
    """Whether the name of a controller means a Python file."""
    return _split(spec) is not None


def short_name(spec: str) -> str:
    """What a controller is called in the names of files: its function, else its file."""
    parts = _split(spec)
    return spec if parts is None else parts[1] or parts[0].stem


def find_controller(spec: str) -> Controller[Any]:
    """The law of a name, or of a file `mylaw.py` or `mylaw.py:NAME`.

    Raises:
        UsageError: no law has that name; the file has none, or several and none was named.
        DqpaintError: the file cannot be read or run.
    """
    parts = _split(spec)
    if parts is None:
        return CONTROLLERS[spec]
    path, name = _found(parts[0]), parts[1]
    laws = _functions(path)
    if name is None:
        name = path.stem if path.stem in laws else next(iter(laws), None) if len(laws) == 1 else ""
    if name not in laws:
        known = ", ".join(laws) or "none"
        fault = f"has no function named '{name}'" if name else f"has {len(laws)} functions"
        cure = "" if name or len(laws) < 2 else f"; choose one: {path.name}:NAME"
        raise UsageError(f"{path.name} {fault}{cure}; its functions: {known}; {HOW}")
    return make_controller(laws[name], short_name(spec), path)


def make_controller(
    function: Callable[..., Any], name: str, path: Path | None = None
) -> Controller[Any]:
    """The law of a function.

    Args:
        function: of what a law sees, and its gains.
        name: as the law is to be called.
        path: of the file it stands in, for messages; found by itself if not given.

    Raises:
        UsageError: its parameters are not those of a law.
    """
    path = path or Path(inspect.getsourcefile(function) or "?")
    where = f"law '{getattr(function, '__name__', name)}' in {path.name}"
    model = _gains(function, where)
    kind: Commands = getattr(function, "commands", "twist")
    return Controller(name, str(path), model, OwnLaw(function, kind, path), kind)


class OwnLaw:
    """A user's function as a law: its faults are told with its own lines, its answers checked."""

    def __init__(self, function: Callable[..., Any], kind: Commands, path: Path) -> None:
        self.__doc__ = inspect.getdoc(function) or f"The law of {path.name}"
        self._function, self._kind, self._path = function, kind, path

    @property
    def sha256(self) -> str:
        """Of the file."""
        return hashlib.sha256(self._path.read_bytes()).hexdigest() if self._path.is_file() else ""

    def __call__(self, seen: Seen, gains: Gains) -> Floats:
        """What the function returns, (6,) or (n,)."""
        for array in (seen.pose, seen.jacobian, seen.posture, seen.rates):
            array.flags.writeable = False  # what the arm did is not for a law to change
        try:
            said = self._function(seen, **dict(gains))
        except (Exception, SystemExit) as fault:
            raise DqpaintError(_told(fault, self._path)) from None
        joints = seen.posture.shape[-1]
        size = 6 if self._kind in ("twist", "acceleration") else joints
        try:
            if np.iscomplexobj(said):
                raise DqpaintError(f"{self._at()}: the law returned complex numbers, not real ones")
            answer = np.array(said, dtype=np.float64)
        except (TypeError, ValueError):
            answer = np.zeros(0)
        if answer.shape != (size,):
            raise DqpaintError(
                f"{self._at()}: a law that commands {WORDS[self._kind]} returns {size} numbers, "
                f"this one returned {_shape(said)}"
            )
        if not np.isfinite(answer).all():
            raise DqpaintError(
                f"{self._at()}: at {seen.time:.3f} s the law returned {answer}, not finite numbers"
            )
        return answer

    def _at(self) -> str:
        line = inspect.unwrap(self._function).__code__.co_firstlineno
        return f"{self._path.name}:{line}"


def _split(spec: str) -> tuple[Path, str | None] | None:
    """File and name of `mylaw.py` or `mylaw.py:NAME`; None for the name of a law."""
    head, sign, name = spec.rpartition(":")
    if sign and head.endswith(".py"):
        return Path(head), name or None
    return (Path(spec), None) if spec.endswith(".py") else None


def _found(path: Path) -> Path:
    """A file, else the example of that name."""
    example = examples_folder() / path.name
    return example if not path.exists() and str(path) == path.name and example.exists() else path


def _functions(path: Path) -> dict[str, FunctionType]:
    """The functions a file defines, by their names; private ones have an underscore."""
    try:
        text = path.read_text("utf-8")
    except OSError as problem:
        raise DqpaintError(f"controller '{path}' cannot be read: {problem.strerror}") from None
    except UnicodeDecodeError:
        raise DqpaintError(f"controller '{path}' is not a text in UTF-8") from None
    module = ModuleType(f"dqpaint_own_{path.stem}")
    module.__file__ = str(path)
    sys.modules[module.__name__] = module  # where classes of the file look for themselves
    folder = str(path.resolve().parent)
    if folder not in sys.path:
        sys.path.append(folder)  # its neighbours can be imported, as in a script
    try:
        exec(compile(text, str(path), "exec"), vars(module))
    except (Exception, SystemExit) as fault:
        raise DqpaintError(_told(fault, path)) from None
    return {
        name: thing
        for name, thing in vars(module).items()
        if isinstance(thing, FunctionType)
        and thing.__module__ == module.__name__
        and not name.startswith("_")
    }


def _gains(function: Callable[..., Any], where: str) -> type[Gains]:
    """A model of the gains a function takes after what it sees."""
    parameters = list(inspect.signature(function).parameters.values())
    if not parameters:
        raise UsageError(f"{where} takes nothing; {HOW}")
    fields: dict[str, Any] = {}
    hints = _hints(function)
    for parameter in parameters[1:]:
        default = parameter.default
        is_number = isinstance(default, int | float) and not isinstance(default, bool)
        if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD) or not is_number:
            raise UsageError(f"{where}: parameter '{parameter.name}' has no number; {HOW}")
        if parameter.name.startswith("_") or hasattr(Gains, parameter.name):
            raise UsageError(
                f"{where}: a gain can't be called '{parameter.name}'; choose another name"
            )
        unit = getattr(hints.get(parameter.name), "__metadata__", ("",))[0]
        fields[parameter.name] = (Finite, Field(float(default), description=unit or "no unit said"))
    return create_model("OwnGains", __base__=Gains, **fields)


def _hints(function: Callable[..., Any]) -> dict[str, Any]:
    """The annotations, also where the file puts their evaluation off."""
    try:
        return get_type_hints(function, include_extras=True)
    except (NameError, TypeError, AttributeError):
        return {}


def _told(fault: BaseException, path: Path) -> str:
    """A fault with the file's own last line in it, without the lines of this package."""
    said = f"{type(fault).__name__}: {fault}" if str(fault) else type(fault).__name__
    if isinstance(fault, SyntaxError) and fault.filename == str(path):
        number: int | None = fault.lineno
        said = f"{type(fault).__name__}: {fault.msg}"
    else:
        frames = traceback.extract_tb(fault.__traceback__)
        number = next((f.lineno for f in reversed(frames) if f.filename == str(path)), None)
    if number is None:
        return f"{path.name}: {said}"
    code = linecache.getline(str(path), number).rstrip()
    edge = " " * len(str(number))
    return f"{path.name}:{number}: {said}\n{edge} |\n{number} | {code}"


def _shape(said: Any) -> str:
    if said is None:
        return "nothing"
    shape = getattr(said, "shape", None)
    if shape is None and isinstance(said, list | tuple):
        shape = (len(said),)
    return f"an array of shape {tuple(shape)}" if shape else f"a {type(said).__name__}"
