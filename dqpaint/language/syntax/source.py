"""File or standard input -> its text, or an error."""

import sys
from errno import EFBIG
from pathlib import Path

from dqpaint.core import read_regular
from dqpaint.errors import DqpaintError

MOST_BYTES = 2_000_000
STDIN = "-"  # as a file's name: standard input
STDIN_NAME = "<stdin>"  # and as messages call it


def load(path: str | Path) -> bytes:
    """The bytes of a file.

    Raises:
        DqpaintError: the file can't be read, or is too large.
    """
    try:
        return read_regular(path, MOST_BYTES)
    except OSError as fault:
        reason = fault.strerror or str(fault)
        reason = reason[:1].lower() + reason[1:]
        if fault.errno == EFBIG:
            raise DqpaintError(f"{path} {reason.removeprefix('it ')}") from None
        raise DqpaintError(f"can't read {path}: {reason}") from None


def load_input() -> bytes:
    """The bytes of standard input, at most one more than the limit.

    Raises:
        DqpaintError: it is closed.
    """
    if sys.stdin is None:
        raise DqpaintError("standard input is closed")
    return sys.stdin.buffer.read(MOST_BYTES + 1)


def decoded(data: bytes, name: str) -> str:
    """The text of a file, with newlines as its only line ends.

    Raises:
        DqpaintError: it is not a text in UTF-8, or too large.
    """
    if len(data) > MOST_BYTES:
        raise DqpaintError(f"{name} is larger than {MOST_BYTES // 1_000_000} MB")
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise DqpaintError(f"{name} is written in UTF-16; save it as UTF-8")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        byte = data[fault.start]
        line = data.count(b"\n", 0, fault.start) + 1
        raise DqpaintError(
            f"{name} is not written in UTF-8: line {line}, byte {fault.start + 1} is "
            f"0x{byte:02x}{_latin(byte)}; save it as UTF-8"
        ) from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _latin(byte: int) -> str:
    """The byte as Latin-1, the usual encoding of files that are not UTF-8."""
    letter = bytes([byte]).decode("latin-1")
    return f" ('{letter}' in Latin-1)" if letter.isprintable() else ""
