"""`mylaw.py` or `mylaw.py:NAME` -> the functions and classes of a file, and its faults in words."""

import hashlib
import linecache
import sys
import traceback
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

from dqpaint.core import examples_folder
from dqpaint.errors import DqpaintError

LARGEST = 1_000_000  # bytes of a file
WIDEST = 120  # columns of a line that is shown
_busy: set[Path] = set()  # files that are being run


def split_spec(spec: str) -> tuple[Path, str | None] | None:
    """File and name of `mylaw.py` or `mylaw.py:NAME`; None for the name of a law."""
    head, sign, name = spec.rpartition(":")
    if sign and head.endswith(".py"):
        return Path(head), name or None
    return (Path(spec), None) if spec.endswith(".py") else None


def find_file(path: Path) -> Path:
    """A file, else the example of that name."""
    example = examples_folder() / path.name
    return example if not path.exists() and str(path) == path.name and example.exists() else path


def read_laws(path: Path) -> tuple[dict[str, Any], str]:
    """The functions and classes a file defines, by their names, and its SHA-256.

    Those whose names begin with _ are the file's own.

    Raises:
        DqpaintError: the file cannot be read or run, or is being run.
    """
    if path.absolute() in _busy:
        raise DqpaintError(f"{path.name} draws with itself: a law can't be loaded while it runs")
    text, digest = _text(path)
    module = ModuleType(f"dqpaint_own_{path.stem}")
    module.__file__ = str(path)
    sys.modules[module.__name__] = module  # where classes of the file look for themselves
    folder = str(path.resolve().parent)
    if folder not in sys.path:
        sys.path.append(folder)  # its neighbours can be imported, as in a script
    with Running(path):
        exec(compile(text, str(path), "exec"), vars(module))
    laws = {
        name: thing
        for name, thing in vars(module).items()
        if isinstance(thing, FunctionType | type)
        and thing.__module__ == module.__name__
        and not name.startswith("_")
    }
    return laws, digest


class AnswerError(DqpaintError):
    """An answer that is none; it names its place by itself."""


class Running:
    """While code of a file runs: its faults are told with its own lines, but for a Ctrl-C.

    Raises:
        DqpaintError: any fault.
    """

    def __init__(self, path: Path) -> None:
        self._path, self._place = path, path.absolute()

    def __enter__(self) -> None:
        _busy.add(self._place)

    def __exit__(self, kind: object, fault: BaseException | None, trace: object) -> None:
        _busy.discard(self._place)
        if fault is not None and not isinstance(fault, KeyboardInterrupt | AnswerError):
            raise DqpaintError(_told(fault, self._path)) from None


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
