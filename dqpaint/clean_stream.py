"""A stream -> one on which texts of others are shown and never obeyed.

A drawing, a table or the name of a file may hold characters that move a terminal's cursor, set its
title or turn a line round. All that is printed goes through here; what the program itself wants of
a terminal, it sends by `send_raw`.
"""

import re
from io import TextIOWrapper
from typing import TextIO

COMMANDS = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069]")
"""Control characters but tab and newline, and marks that change the direction of writing."""


def printable(text: str) -> str:
    r"""The text with each such character as its number: `\x1b`."""
    return COMMANDS.sub(_number, text)


def _number(found: re.Match[str]) -> str:
    return (
        found[0].encode("ascii", "backslashreplace").decode()
        if found[0] > "\xff"
        else (f"\\x{ord(found[0]):02x}")
    )


class CleanStream(TextIOWrapper):
    """A text stream that writes what is printable of each text.

    Args:
        under: the stream whose bytes it writes; that stays open.
    """

    def __init__(self, under: TextIOWrapper) -> None:
        under.flush()
        self._under = under
        self._fault: OSError | None = None  # of a write: told again at the next flush
        super().__init__(
            under.buffer, under.encoding, "backslashreplace", line_buffering=under.line_buffering,
            write_through=under.write_through,
        )  # fmt: skip

    def write(self, text: str, /) -> int:
        """Write a text; other characters come as their numbers."""
        try:
            super().write(printable(text))
        except OSError as fault:
            self._fault = fault
            raise
        return len(text)

    def flush(self) -> None:
        """Write what waits; a write that failed fails again."""
        if self._fault is not None:
            raise self._fault
        super().flush()

    def send(self, text: str) -> None:
        """Write a text as it is."""
        super().write(text)

    def close(self) -> None:
        """Write what waits; the bytes are those of the other stream."""
        if not self.closed and self._fault is None:
            self.flush()


def cleaned(stream: TextIO) -> TextIO:
    """The same stream, cleaned; one that is not over bytes stays as it is."""
    return CleanStream(stream) if isinstance(stream, TextIOWrapper) else stream


def send_raw(text: str, stream: TextIO) -> None:
    """Send a text to a terminal as it is, and at once."""
    (stream.send if isinstance(stream, CleanStream) else stream.write)(text)
    stream.flush()
