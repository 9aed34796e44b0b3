"""Process -> one that reads only the files of a drawing's folder and of Python itself.

A text may name files: includes, SVG, images, robots. A text that came by a link is a stranger's. So
the workers, which alone read such files, refuse every other one, whoever opens it: an audit hook
sees each `open` of Python.
"""

import errno
import os
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from dqpaint.core import examples_folder

REFUSED = "the studio reads nothing outside the folder it was started in"
OF_SYSTEM = ("/proc", "/sys", "/dev/null", "/dev/urandom", "/etc/localtime", "/usr", "/lib")
WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC


def confine(folders: Iterable[Path]) -> None:
    """Let this process open files only in some folders, and in those of Python; for good.

    Args:
        folders: whose files may be read.
    """
    own = Path(__file__).resolve().parents[2]
    python = {Path(one).resolve() for one in (sys.prefix, sys.base_prefix, *sys.path) if one}
    python.discard(Path.cwd().resolve())  # a script's folder is not Python's
    temporary = os.path.realpath(tempfile.gettempdir())
    readable = [*map(str, (own, examples_folder().resolve(), *python)), *OF_SYSTEM, temporary]
    readable += [str(Path(folder).resolve()) for folder in folders]

    def check(event: str, arguments: tuple[Any, ...]) -> None:
        if event != "open":
            return
        path, mode, flags = arguments
        if not isinstance(path, str | bytes | os.PathLike):
            return  # a handle that is open
        real = os.path.realpath(os.fsdecode(path))
        writes = bool(isinstance(flags, int) and flags & WRITING) or (
            isinstance(mode, str) and mode.strip("rbtU") != ""
        )
        allowed = [temporary, "/dev/null"] if writes else readable
        if not any(real == one or real.startswith(one + os.sep) for one in allowed):
            raise PermissionError(errno.EACCES, REFUSED, os.fsdecode(path))

    sys.addaudithook(check)
