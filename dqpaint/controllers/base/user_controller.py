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
import math
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Annotated, Any, TypeVar, get_args, get_type_hints

import numpy as np
from pydantic import Field, create_model

from dqpaint.controllers.base.controller import CONTROLLERS, Commands, Controller, Seen
from dqpaint.controllers.base.gains import Gains
from dqpaint.core import examples_folder
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError

Function = TypeVar("Function", bound=Callable[..., Any])
Finite = Annotated[float, Field(allow_inf_nan=False)]
WORDS = {
    "twist": "a twist",
    "rates": "joint rates",
    "acceleration": "an acceleration",
    "torque": "joint torques",
}
LARGEST = 1_000_000  # bytes of a file
WIDEST = 120  # columns of a line that is shown
_busy: set[Path] = set()  # files that are being run

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
    laws, digest = _functions(path)
    if name is None:
        name = path.stem if path.stem in laws else next(iter(laws), None) if len(laws) == 1 else ""
    if name not in laws:
        known = ", ".join(laws) or "none"
        fault = f"has no function named '{name}'" if name else f"has {len(laws)} functions"
        cure = "" if name or len(laws) < 2 else f"; choose one: {path.name}:NAME"
        raise UsageError(f"{path.name} {fault}{cure}; its functions: {known}; {HOW}")
    return make_controller(laws[name], short_name(spec), path, digest)


def make_controller(
    function: Callable[..., Any], name: str, path: Path | None = None, digest: str = ""
) -> Controller[Any]:
    """The law of a function.

    Args:
        function: of what a law sees, and its gains.
        name: as the law is to be called.
        path: of the file it stands in, for messages; found by itself if not given.
        digest: SHA-256 of the text that was run; of the file as it is now if not given.

    Raises:
        UsageError: its parameters, or what it commands, are not those of a law.
    """
    path = path or Path(inspect.getsourcefile(function) or "?")
    where = f"law '{getattr(function, '__name__', name)}' in {path.name}"
    model = _gains(function, where)
    kind: Commands = getattr(function, "commands", "twist")
    if not isinstance(kind, str) or kind not in get_args(Commands):
        raise UsageError(
            f"{where} can't command {kind!r}; known: {', '.join(get_args(Commands))}; "
            'write @commands("rates") above it'
        )
    return Controller(name, str(path), model, OwnLaw(function, kind, path, digest), kind)


class AnswerError(DqpaintError):
    """An answer that is none."""


class OwnLaw:
    """A user's function as a law: its faults are told with its own lines, its answers checked."""

    def __init__(
        self, function: Callable[..., Any], kind: Commands, path: Path, digest: str = ""
    ) -> None:
        self.__doc__ = inspect.getdoc(function) or f"The law of {path.name}"
        self._function, self._kind, self._path = function, kind, path
        self._digest = digest
        self._place = path.absolute()
        self._time = 0.0  # [s], of the row it is asked about

    @property
    def sha256(self) -> str:
        """Of the text that was run."""
        if self._digest or not self._path.is_file():
            return self._digest
        return hashlib.sha256(self._path.read_bytes()).hexdigest()

    def __call__(self, seen: Seen, gains: Gains) -> Floats:
        """What the function returns, (6,) or (n,)."""
        for array in (seen.pose, seen.jacobian, seen.posture, seen.rates):
            array.flags.writeable = False  # what the arm did is not for a law to change
        self._time = seen.time
        _busy.add(self._place)
        try:
            said = self._function(seen, **dict(gains))
            joints = seen.posture.shape[-1]
            return self._checked(said, 6 if self._kind in ("twist", "acceleration") else joints)
        except (KeyboardInterrupt, AnswerError):
            raise
        except BaseException as fault:
            raise DqpaintError(_told(fault, self._path)) from None
        finally:
            _busy.discard(self._place)

    def _checked(self, said: Any, size: int) -> Floats:
        """An answer as (size,) finite floats; its shape is seen before anything is copied."""
        shape = _shape(said)
        answer = np.zeros(0)
        if shape in (None, (size,)):
            try:
                answer = np.asarray(said)
                shape = answer.shape or None
            except ValueError:  # a list of lists of several lengths
                shape = (size, -1)
        if shape != (size,):
            raise AnswerError(
                f"{self._at()}: a law that commands {WORDS[self._kind]} returns {size} numbers, "
                f"this one returned {_described(said, shape)}"
            )
        if answer.dtype.kind == "c":
            raise AnswerError(f"{self._at()}: the law returned complex numbers, not real ones")
        is_text = answer.dtype == object and any(isinstance(x, str | bytes) for x in answer)
        if is_text or answer.dtype.kind not in "iufO":
            kind = type(answer[0].item() if answer.dtype != object else answer[0]).__name__
            raise AnswerError(f"{self._at()}: the law returned values of type {kind}, not numbers")
        try:
            if answer.dtype == object and None in answer.tolist():
                raise TypeError
            floats = np.array(answer, dtype=np.float64)
        except OverflowError:
            floats = np.full(size, np.inf)
        except (TypeError, ValueError):
            raise AnswerError(
                f"{self._at()}: the law returned values that are not numbers"
            ) from None
        if not np.isfinite(floats).all():
            raise AnswerError(
                f"{self._at()}: at {self._time:.3f} s the law returned {floats}, not finite numbers"
            )
        return floats

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


def _text(path: Path) -> tuple[str, str]:
    """The text of a file and its SHA-256."""
    try:
        if path.exists() and not path.is_file():
            raise DqpaintError(f"controller '{path}' is not a file")
        if path.stat().st_size > LARGEST:
            raise DqpaintError(f"controller '{path}' is larger than {LARGEST // 1000} kB")
        data = path.read_bytes()
        return data.decode("utf-8-sig"), hashlib.sha256(data).hexdigest()
    except OSError as problem:
        raise DqpaintError(f"controller '{path}' cannot be read: {problem.strerror}") from None
    except UnicodeDecodeError:
        raise DqpaintError(f"controller '{path}' is not a text in UTF-8") from None


def _functions(path: Path) -> tuple[dict[str, FunctionType], str]:
    """The functions a file defines, by their names, and its SHA-256; private ones have a _."""
    if path.absolute() in _busy:
        raise DqpaintError(f"{path.name} draws with itself: a law can't be loaded while it runs")
    text, digest = _text(path)
    module = ModuleType(f"dqpaint_own_{path.stem}")
    module.__file__ = str(path)
    sys.modules[module.__name__] = module  # where classes of the file look for themselves
    folder = str(path.resolve().parent)
    if folder not in sys.path:
        sys.path.append(folder)  # its neighbours can be imported, as in a script
    place = path.absolute()
    _busy.add(place)
    try:
        exec(compile(text, str(path), "exec"), vars(module))
    except KeyboardInterrupt:
        raise
    except BaseException as fault:
        raise DqpaintError(_told(fault, path)) from None
    finally:
        _busy.discard(place)
    laws = {
        name: thing
        for name, thing in vars(module).items()
        if isinstance(thing, FunctionType)
        and thing.__module__ == module.__name__
        and not name.startswith("_")
    }
    return laws, digest


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
        number = _finite(default)
        if number is None:
            raise UsageError(
                f"{where}: parameter '{parameter.name}' is {str(default)[:20]}, "
                f"not a finite number; {HOW}"
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


def _told(fault: BaseException, path: Path) -> str:
    """A fault with the file's own last line in it, without the lines of this package."""
    try:
        text = str(fault)
    except Exception:  # it is the user's own
        text = ""
    said = f"{type(fault).__name__}: {text}" if text else type(fault).__name__
    if isinstance(fault, SyntaxError) and fault.filename == str(path):
        number: int | None = fault.lineno
        said = f"{type(fault).__name__}: {fault.msg}"
    else:
        frames = traceback.extract_tb(fault.__traceback__)
        number = next((f.lineno for f in reversed(frames) if f.filename == str(path)), None)
    if number is None:
        return f"{path.name}: {said}"
    code = linecache.getline(str(path), number).lstrip("\ufeff").rstrip()
    code = code if len(code) <= WIDEST else f"{code[:WIDEST]} ..."
    edge = " " * len(str(number))
    return f"{path.name}:{number}: {said}\n{edge} |\n{number} | {code}"


def _shape(said: Any) -> tuple[int, ...] | None:
    """Of an array or a list; None of anything else."""
    shape = getattr(said, "shape", None)
    if isinstance(shape, tuple):
        return shape or None
    return (len(said),) if isinstance(said, list | tuple) else None


def _described(said: Any, shape: tuple[int, ...] | None) -> str:
    if said is None:
        return "nothing"
    if shape and min(shape) < 0:
        return "rows of several lengths"
    return f"an array of shape {shape}" if shape else f"a {type(said).__name__}"
