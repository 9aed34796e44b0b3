"""Files -> the same files in the standard layout, with their line ends unchanged."""

from pathlib import Path

from dqpaint.core import rewrite
from dqpaint.language.syntax.source import STDIN_NAME, decoded, load, load_input
from dqpaint.language.writing.formatter import formatted


def format_bytes(data: bytes, name: str) -> bytes:
    """The bytes of a drawing in the standard layout.

    All line ends become those of the first line: which ones it has depends on the system, and is
    no part of the layout. A byte-order mark is left out.

    Raises:
        ScriptError: the text does not parse.
        DqpaintError: it is no text.
    """
    text = formatted(decoded(data, name), name)
    first = data.partition(b"\n")[0]
    return text.replace("\n", "\r\n" if first.endswith(b"\r") else "\n").encode()


def format_file(name: str, write: bool) -> bool:
    """Whether a file differs from the standard layout; `write` rewrites it.

    Raises:
        DqpaintError: it cannot be read, understood or written; it is as it was.
    """
    data = load(name)
    made = format_bytes(data, name)
    if write and made != data:
        rewrite(Path(name), made)
    return made != data


def format_input() -> tuple[bytes, bool]:
    """Standard input in the standard layout, and whether it differed.

    Raises:
        DqpaintError: it cannot be understood.
    """
    data = load_input()
    made = format_bytes(data, STDIN_NAME)
    return made, made != data
