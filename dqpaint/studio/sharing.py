"""A text and choices -> a piece of an address or a file, and back; nothing in it is ever run."""

import base64
import json
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from dqpaint.errors import UsageError
from dqpaint.studio.choices import check_choices
from dqpaint.studio.folder import LARGEST_TEXT

VERSION = 1
LONGEST_LINK = 60_000  # characters: browsers and servers take about so many
LARGEST_SHARED = LARGEST_TEXT + 100_000  # bytes when unpacked


@dataclass(frozen=True)
class Shared:
    """What is passed on.

    Attributes:
        name: of the drawing.
        text: of it.
        choices: of the run, by their names in Python.
    """

    name: str
    text: str
    choices: dict[str, Any] = field(default_factory=dict)


def to_json(shared: Shared) -> str:
    """The text of a file."""
    return json.dumps({"dqpaint_studio": VERSION, **vars(shared)}, ensure_ascii=False)


def to_link(shared: Shared) -> str:
    """The value of the parameter `z` of an address.

    Raises:
        UsageError: the text is too long for an address.
    """
    packed = zlib.compress(to_json(shared).encode(), 9)
    text = base64.urlsafe_b64encode(packed).decode().rstrip("=")
    if len(text) > LONGEST_LINK:
        raise UsageError("the drawing is too long for a link: share it as a file")
    return text


def from_link(text: str, laws: Sequence[str] = ()) -> Shared:
    """What a link holds.

    Raises:
        UsageError: it is damaged, too large, or asks for what a link may not.
    """
    if len(text) > LONGEST_LINK:
        raise UsageError("the link is too long")
    try:
        packed = base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))
        unpack = zlib.decompressobj()
        data = unpack.decompress(packed, LARGEST_SHARED + 1)
    except (ValueError, zlib.error):
        raise UsageError("the link is damaged: it is not a drawing's") from None
    return from_json(data, laws)


def from_json(data: bytes, laws: Sequence[str] = ()) -> Shared:
    """What a file holds.

    Args:
        data: of the file.
        laws: files of laws that the command line named.

    Raises:
        UsageError: it is damaged, too large, or asks for what it may not.
    """
    if len(data) > LARGEST_SHARED:
        raise UsageError("the drawing is too large to be shared")
    try:
        found = json.loads(data)
        version, name, text = found["dqpaint_studio"], found["name"], found["text"]
        choices = found.get("choices", {})
    except (ValueError, KeyError, TypeError, RecursionError):
        raise UsageError("that is no drawing shared by a studio") from None
    if version != VERSION:
        raise UsageError(f"the drawing was shared by another version of the studio ({version!r})")
    if not (isinstance(name, str) and isinstance(text, str) and isinstance(choices, dict)):
        raise UsageError("that is no drawing shared by a studio")
    return Shared(name[:100], text, check_choices(choices, laws))
