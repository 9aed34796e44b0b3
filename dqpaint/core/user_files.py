"""`FILE.py` or `FILE.py:NAME` -> a function or class of a user's file, with readable faults."""

import hashlib
import linecache
import os
import sys
import threading
import traceback
from collections.abc import Callable
from inspect import ismethod
from os.path import exists
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any, NoReturn

from dqpaint.core.examples import examples_folder
from dqpaint.core.inputs import read_regular
from dqpaint.errors import DqpaintError, TimeLimitError, UsageError

LARGEST_FILE = 1_000_000  # bytes of a file
LONGEST_LINE = 120  # columns of a line that is shown
_running_files: set[Path] = set()  # files that are being run
_running_in = (0, 0)  # process and thread of the latest
_exit = os._exit


def split_spec(spec: str) -> tuple[Path, str | None] | None:
    """File and name of `FILE.py` or `FILE.py:NAME`; None for a registered name."""
    head, sign, name = spec.rpartition(":")
    if sign and head.endswith(".py"):
        return Path(head), name or None
    return (Path(spec), None) if spec.endswith(".py") else None


def find_file(path: Path) -> Path:
    """A file, else the example of that name."""
    example = examples_folder() / path.name
    return example if str(path) == path.name and not exists(path) and exists(example) else path


def short_name(spec: str) -> str:
    """What a thing is called in the names of files: its own name, else its file's."""
    parts = split_spec(spec)
    return spec if parts is None else parts[1] or parts[0].stem


def find_in_file(
    kind: str, spec: str, fits: Callable[[Any], bool], help_text: str
) -> tuple[Any, Path, str]:
    """The function or class that `FILE.py` or `FILE.py:NAME` means, its path and SHA-256.

    Without a name it is the one that is called as the file is, else the only one.

    Args:
        kind: what it should be, for messages.
        spec: the file and the name.
        fits: whether a function or class is of that kind.
        help_text: a sentence on how to write one.

    Raises:
        UsageError: the file has none, not the named one, or several and none was named.
        DqpaintError: the file cannot be read or run.
    """
    parts = split_spec(spec)
    assert parts is not None
    path, name = find_file(parts[0]), parts[1]
    things, digest = read_definitions(path, kind)
    fitting = {word: thing for word, thing in things.items() if fits(thing)}
    if name is None:
        known = fitting or things  # the only class is what is meant, even if it does not fit
        name = path.stem if path.stem in known else next(iter(known)) if len(known) == 1 else ""
    if name not in things:
        fault = f"has no {kind} named '{name}'" if name else f"has {len(fitting)} {kind}s"
        fix = "" if name or not fitting else f"; choose one: {path.name}:NAME"
        names = ", ".join(fitting) or "none"
        raise UsageError(f"{path.name} {fault}{fix}; its {kind}s: {names}; {help_text}")
    return things[name], path, digest


def file_digest(spec: str | None) -> str:
    """The SHA-256 of the file that a choice names; empty for a registered name."""
    parts = split_spec(spec or "")
    return _text(find_file(parts[0]), "file")[1] if parts else ""


def read_definitions(path: Path, kind: str) -> tuple[dict[str, Any], str]:
    """The functions and classes a file defines, by their names, and its SHA-256.

    Those whose names begin with _ are the file's own.

    Raises:
        DqpaintError: the file cannot be read or run, or is being run.
    """
    if path.absolute() in _running_files:
        raise DqpaintError(f"{path.name} draws with itself: a {kind} can't be loaded while it runs")
    text, digest = _text(path, kind)
    module = ModuleType(f"dqpaint_own_{path.stem}")
    module.__file__ = str(path)
    sys.modules[module.__name__] = module  # where classes of the file look for themselves
    folder = str(path.resolve().parent)
    if folder not in sys.path:
        sys.path.append(folder)  # its neighbours can be imported, as in a script
    with UserCode(path):
        exec(compile(text, str(path), "exec"), vars(module))
    found = {
        name: thing
        for name, thing in vars(module).items()
        if isinstance(thing, FunctionType | type)
        and thing.__module__ == module.__name__
        and not name.startswith("_")
    }
    return found, digest


class AnswerError(DqpaintError):
    """A user's function returned a value of the wrong kind; the message names file and line."""


def _told_exit(status: int) -> NoReturn:
    """`os._exit` while a user's code runs; other threads and processes end as they ask."""
    if _running_in == (os.getpid(), threading.get_ident()):
        raise SystemExit(f"os._exit({status})")
    _exit(status)


class UserCode:
    """Context of a user's code: any fault but Ctrl-C becomes an error with the file's own line.

    Raises:
        DqpaintError: any fault.
    """

    def __init__(self, path: Path) -> None:
        self._path, self._place = path, path.absolute()

    def __enter__(self) -> None:
        global _running_in
        _running_files.add(self._place)
        _running_in = os.getpid(), threading.get_ident()
        os._exit = _told_exit  # it would end all without a word, and as if all were well

    def __exit__(self, kind: object, fault: BaseException | None, trace: object) -> None:
        _running_files.discard(self._place)
        if not _running_files:
            os._exit = _exit
        if fault is not None and not isinstance(fault, KeyboardInterrupt | AnswerError):
            late = isinstance(fault, TimeLimitError)
            kind = TimeLimitError if late else DqpaintError
            raise kind(_located_fault(fault, self._path)) from None


class Guarded:
    """A user's class or object: its faults become errors with the lines of the user's file.

    Args:
        thing: a class or an object.
        path: its file.
    """

    def __init__(self, thing: Any, path: Path) -> None:
        self._thing, self._running = thing, UserCode(path)
        self._path = path
        self.__doc__ = thing.__doc__

    def __call__(self, *args: Any, **named: Any) -> Any:
        """Make an object, or call a method."""
        with self._running:
            made = self._thing(*args, **named)
        return Guarded(made, self._path) if isinstance(self._thing, type) else made

    def __getattr__(self, name: str) -> Any:
        with self._running:
            found = getattr(self._thing, name)
        return Guarded(found, self._path) if ismethod(found) else found


def _text(path: Path, kind: str) -> tuple[str, str]:
    """The text of a file and its SHA-256."""
    try:
        data = read_regular(path, LARGEST_FILE)
        return data.decode("utf-8-sig"), hashlib.sha256(data).hexdigest()
    except OSError as problem:
        raise DqpaintError(f"{kind} '{path}' cannot be read: {problem.strerror}") from None
    except UnicodeDecodeError:
        raise DqpaintError(f"{kind} '{path}' is not a text in UTF-8") from None


def _located_fault(fault: BaseException, path: Path) -> str:
    """The message of a fault, with the last line of the user's file that led to it."""
    try:
        text = str(fault)
    except Exception:  # it is the user's own
        text = ""
    message = f"{type(fault).__name__}: {text}" if text else type(fault).__name__
    if isinstance(fault, TimeLimitError):
        message = text
    if isinstance(fault, SyntaxError) and fault.filename == str(path):
        number: int | None = fault.lineno
        message = f"{type(fault).__name__}: {fault.msg}"
    else:
        frames = traceback.extract_tb(fault.__traceback__)
        number = next((f.lineno for f in reversed(frames) if f.filename == str(path)), None)
    if number is None:
        return f"{path.name}: {message}"
    code = linecache.getline(str(path), number).lstrip("\ufeff").rstrip()
    code = code if len(code) <= LONGEST_LINE else f"{code[:LONGEST_LINE]} ..."
    edge = " " * len(str(number))
    return f"{path.name}:{number}: {message}\n{edge} |\n{number} | {code}"
