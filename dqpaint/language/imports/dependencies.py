"""Drawing -> the files it depends on, which are worth watching."""

from pathlib import Path

from dqpaint.errors import DqpaintError
from dqpaint.language.syntax.lexer import lines
from dqpaint.language.syntax.source import decoded, load

MOST_FILES = 100


def files_of(path: Path) -> set[Path]:
    """A drawing's file and the files it names, existing or not; the drawing may have errors."""
    found, unread = {path}, [path]
    while unread and len(found) < MOST_FILES:
        file = unread.pop()
        named = {folder / name for name in _texts(file) for folder in (file.parent, path.parent)}
        unread += [other for other in named - found if other.suffix == path.suffix]
        found |= named
    return found


def _texts(path: Path) -> list[str]:
    """The quoted texts of a drawing."""
    try:
        text = decoded(load(path), str(path))
    except DqpaintError:
        return []
    return [token.text for line in lines(text) for token in line.tokens if token.kind == "text"]
