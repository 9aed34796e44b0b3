"""Files that a drawing names: found beside it or below, and read only so far as is allowed."""

from pathlib import Path, PurePosixPath

from dqpaint.language.diagnostics import Problem, problem
from dqpaint.language.pen import Pen
from dqpaint.language.syntax import Quoted


def path_of(node: Quoted, pen: Pen) -> Path:
    """The path of a file that the drawing may read: in its own folder or below, links followed."""
    folder = Path(pen.file[0]).parent
    written = PurePosixPath(node.text)
    if not node.text.strip() or "\0" in node.text:
        raise problem("E292", "a file has a name", node.span, "", 'for example: "points.csv"')
    if written.is_absolute() or "\\" in node.text or node.text[1:2] == ":":
        message = "a file is named from the folder of the drawing, with / between"
        raise problem("E292", message, node.span, "", f'for example: "{_last(node.text)}"')
    path = folder.joinpath(written)
    try:
        inside = path.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError):  # links that go in a circle
        inside = False
    if not inside or ".." in written.parts:
        message = "this file is outside of the drawing's folder"
        cure = "only files beside the drawing or below can be read; copy it there"
        raise problem("E292", message, node.span, "", cure)
    return path


def _last(text: str) -> str:
    return text.replace("\\", "/").rstrip("/").rpartition("/")[2] or "points.csv"


def contents(node: Quoted, pen: Pen, most_bytes: int) -> bytes:
    """What is in a file; refused, before it is read, if it is too large."""
    path = path_of(node, pen)
    try:
        if path.stat().st_size > most_bytes:
            raise too_large(node, f"larger than {most_bytes // 1_000_000} MB")
        with path.open("rb") as file:
            data = file.read(most_bytes + 1)
    except (OSError, ValueError) as fault:
        raise _unread(node, path, fault) from None
    if len(data) > most_bytes:
        raise too_large(node, f"larger than {most_bytes // 1_000_000} MB")
    return data


def _unread(node: Quoted, path: Path, fault: Exception) -> Problem:
    reason = (fault.strerror if isinstance(fault, OSError) else None) or str(fault)
    cure = ""
    if isinstance(fault, FileNotFoundError):
        there = sorted(p.name for p in path.parent.glob(f"*{path.suffix}"))[:6]
        cure = f"there are: {', '.join(there)}" if there and path.suffix else ""
    return problem("E293", f"can't read {node.text}: {reason.lower()}", node.span, "", cure)


def too_large(node: Quoted, how: str, cure: str = "") -> Problem:
    """E294."""
    return problem("E294", f"{node.text} is {how}", node.span, "", cure)
