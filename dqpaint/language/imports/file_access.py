"""File name in a drawing -> path or bytes: only files in or below its folder, of limited size.

A name is seen from the folder of the file it stands in, an included one too; what is named lies in
the folder of the main file or below, so that a drawing from elsewhere reads nothing else.
"""

from errno import EFBIG
from pathlib import Path, PurePosixPath

from dqpaint.core import read_regular, stat_regular
from dqpaint.diagnostics import Problem, file_at, problem
from dqpaint.language.pen.pen import Pen
from dqpaint.language.syntax.tree import Quoted


def is_relative(written: str) -> bool:
    """Whether a name is a relative path on every system."""
    strange = any(letter in written for letter in "\\:\0")
    return not strange and not PurePosixPath(written).is_absolute()


def below(root: Path, folder: Path, written: str) -> Path | None:
    """The path of a file named relative to a folder; None if it leaves `root`, links resolved."""
    parts = list(folder.relative_to(root).parts)
    for part in PurePosixPath(written).parts:
        if part != "..":
            parts.append(part)
        elif parts:
            parts.pop()
        else:
            return None
    path = root.joinpath(*parts)
    try:
        resolved = path.resolve()
        inside = resolved.is_relative_to(root.resolve())
        inside = inside and not resolved.is_symlink()  # Python 3.13: it goes in a circle
    except (OSError, RuntimeError):  # links that go in a circle, or a name that is too long
        inside = False
    return path if inside else None


def path_of(node: Quoted, pen: Pen) -> Path:
    """The path of a file that the drawing may read."""
    if pen.path is None:
        message = "a text that is no file can't read one"
        raise problem("E292", message, node.span, "", "save it beside the other file")
    if not node.text.strip() or "\0" in node.text:
        raise problem("E292", "a file has a name", node.span, "", 'for example: "points.csv"')
    if not is_relative(node.text):
        message = "a file is named from the folder of the drawing, with / between"
        raise problem("E292", message, node.span, "", f'for example: "{_last(node.text)}"')
    here = Path(file_at(pen.text, node.span.start, str(pen.path))[1])
    path = below(pen.path.parent, here.parent, node.text)
    if path is None:
        message = "this file is outside of the drawing's folder"
        help = "only files beside the drawing or below can be read; copy it there"
        raise problem("E292", message, node.span, "", help)
    return path


def _last(text: str) -> str:
    return text.replace("\\", "/").rstrip("/").rpartition("/")[2] or "points.csv"


def contents(node: Quoted, pen: Pen, most_bytes: int) -> bytes:
    """The bytes of a file; refused before reading if it is too large."""
    path = path_of(node, pen)
    try:
        return read_regular(path, most_bytes)
    except OSError as fault:
        raise _unread(node, path, fault) from None


def readable(node: Quoted, pen: Pen, most_bytes: int) -> Path:
    """The path of an existing file that the drawing may read and that is not too large."""
    path = path_of(node, pen)
    try:
        stat_regular(path, most_bytes)
    except OSError as fault:
        raise _unread(node, path, fault) from None
    return path


def _unread(node: Quoted, path: Path, fault: OSError) -> Problem:
    reason = fault.strerror or str(fault)
    if fault.errno == EFBIG:
        return too_large(node, reason.removeprefix("it is "))
    help = ""
    if isinstance(fault, FileNotFoundError):
        there = sorted(p.name for p in path.parent.glob(f"*{path.suffix}"))[:6]
        help = f"there are: {', '.join(there)}" if there and path.suffix else ""
    return problem(
        "E293", f"can't read {node.text}: {reason[:1].lower()}{reason[1:]}", node.span, "", help
    )


def too_large(node: Quoted, how: str, help: str = "") -> Problem:
    """E294."""
    return problem("E294", f"{node.text} is {how}", node.span, "", help)
