"""Names of drawings in one folder -> their texts, read and written; nothing outside of it."""

from pathlib import Path, PurePosixPath

from dqpaint.core import example_names, find_drawing, read_regular, write_together
from dqpaint.errors import DqpaintError, UsageError

ENDING = ".traj"
LARGEST_TEXT = 2_000_000  # bytes of a drawing that is opened or saved here
MOST_LISTED = 500
DEEPEST = 3  # folders below the one it was started in
NEW = "untitled.traj"


class DrawingFolder:
    """The drawings of a folder and those below it.

    Args:
        root: the folder.
    """

    def __init__(self, root: Path) -> None:
        self.root = root.resolve()

    def names(self) -> list[str]:
        """The drawings, by their path in the folder, sorted."""
        found: list[str] = []
        folders = [self.root]
        while folders and len(found) < MOST_LISTED:
            here = folders.pop(0)
            try:
                entries = sorted(here.iterdir())
            except OSError:
                continue
            for entry in entries:
                if entry.name.startswith(".") or entry.is_symlink():
                    continue
                depth = len(entry.relative_to(self.root).parts)
                if entry.is_dir() and depth <= DEEPEST:
                    folders.append(entry)
                elif entry.suffix == ENDING and entry.is_file():
                    found.append(entry.relative_to(self.root).as_posix())
        return sorted(found)[:MOST_LISTED]

    def path(self, name: str) -> Path:
        """The file of a name.

        Raises:
            UsageError: it is not a drawing's name, or lies outside.
        """
        parts = PurePosixPath(name)
        if not name or parts.is_absolute() or ".." in parts.parts or "\\" in name or "\0" in name:
            raise UsageError(f"'{name[:60]}' is outside the folder the studio was started in")
        if parts.suffix != ENDING:
            raise UsageError(f"'{name[:60]}' does not end with {ENDING}")
        path = self.root / parts
        if not path.parent.resolve().is_relative_to(self.root) or path.is_symlink():
            raise UsageError(f"'{name[:60]}' leads outside the folder the studio was started in")
        return path

    def read(self, name: str) -> str:
        """The text of a drawing.

        Raises:
            DqpaintError: it cannot be read, or is too large.
        """
        path = self.path(name)
        return _text(path, name)

    def save(self, name: str, text: str) -> None:
        """Write the text of a drawing: whole, or not at all.

        Raises:
            DqpaintError: it cannot be written.
        """
        path = self.path(name)
        data = text.encode()
        if len(data) > LARGEST_TEXT:
            raise UsageError(f"the text has more than {LARGEST_TEXT:,} bytes")
        try:
            write_together(path.parent, {path.name: data})
        except OSError as problem:
            raise DqpaintError(f"'{name}' cannot be written: {problem.strerror}") from None


def read_example(name: str) -> str:
    """The text of an example.

    Raises:
        DqpaintError: there is none of that name.
    """
    if name not in example_names():
        raise UsageError(f"no example '{name[:40]}'")
    return _text(find_drawing(name), name)


def _text(path: Path, name: str) -> str:
    try:
        return read_regular(path, LARGEST_TEXT).decode()
    except UnicodeDecodeError:
        raise DqpaintError(f"'{name}' is not UTF-8") from None
    except OSError as problem:
        raise DqpaintError(f"'{name}' cannot be read: {problem.strerror}") from None
