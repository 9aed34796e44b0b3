"""An editor's bytes -> its messages, one after the other, also behind one whose length is wrong.

A message is a header, `Content-Length: N`, an empty line, and N bytes of JSON. JSON ends by itself
and a header cannot stand in it, for its line ends would be escaped; so where a length is wrong, the
end of the message is found without it.
"""

import io
import json
import re
from collections.abc import Iterator
from typing import Protocol

HEADER = re.compile(rb"Content-Length: *(\d{1,18})\r\n(?:[!-9;-~]+:[ -~]*\r\n)*\r\n", re.IGNORECASE)
CHUNK = 65536
LARGEST = 64_000_000  # bytes of a message; a drawing has at most 2 MB
_decoder = json.JSONDecoder()


class Source(Protocol):
    """What bytes come from."""

    def read1(self, size: int, /) -> bytes:
        """Some bytes, as soon as there are some; none at the end."""


class Frames:
    """A stream for a server: each message with its true length.

    Args:
        source: what the editor writes.
    """

    def __init__(self, source: Source) -> None:
        self._messages = messages(source)
        self._out = io.BytesIO()

    def readline(self) -> bytes:
        """The next line of a header; empty at the end."""
        if line := self._out.readline():
            return line
        body = next(self._messages, None)
        if body is None:
            return b""
        self._out = io.BytesIO(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        return self._out.readline()

    def read(self, size: int) -> bytes:
        """The body of a message."""
        return self._out.read(size)


def messages(source: Source) -> Iterator[bytes]:
    """The bodies of messages; of a broken one, what there is of it."""
    data = b""
    while True:
        header = HEADER.search(data)
        if header is None:
            more = source.read1(CHUNK)
            if not more:
                return
            data = data[-CHUNK:] + more  # a header is shorter
            continue
        data, told = data[header.end() :], int(header[1])
        size = _size(data, told)
        while size is None and (more := source.read1(CHUNK)):
            data += more
            size = _size(data, told)
        size = len(data) if size is None else size
        yield data[:size] or b"{}"
        data = data[size:]


def _size(data: bytes, told: int) -> int | None:
    """How long the message is at the beginning of data; None if more has to come first."""
    if told <= len(data) and _is_json(data[:told]):
        return told
    if data.rstrip().endswith(b"}") or told <= len(data):
        text = data.decode("utf-8", "surrogateescape")
        try:
            _, end = _decoder.raw_decode(text.lstrip())
        except (ValueError, RecursionError):
            pass
        else:
            whole = text[: len(text) - len(text.lstrip()) + end]
            return len(whole.encode("utf-8", "surrogateescape"))
    following = HEADER.search(data)
    if following is not None:
        return following.start()
    return len(data) if len(data) > LARGEST else None


def _is_json(data: bytes) -> bool:
    try:
        json.loads(data)
    except (ValueError, RecursionError):
        return False
    return True
