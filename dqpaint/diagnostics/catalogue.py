"""A message's code -> its explanation: the rule, a wrong text and a right one.

`catalogue.toml` is the one table of all messages; the tests run its examples, and hold it to the
codes that are in use.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from typing import Any

from dqpaint.errors import UsageError

PAGE = "trajectories/MESSAGES.md"
STAGES = ("text", "motion", "arm", "other")
_INDENT = "  "


@dataclass(frozen=True, slots=True)
class Explanation:
    """The explanation of one message.

    Attributes:
        code: such as `E245`.
        title: its subject, in a few words.
        says: the reason for the rule, and what to do.
        wrong: a whole drawing that leads to this message; empty for those about no text.
        right: a corrected drawing, without any message.
        stage: what finds it: reading the `text`, planning the `motion`, trying an `arm`, or
            something `other`, where no text can show it.
        files: files next to the drawings, by name.
    """

    code: str
    title: str
    says: str
    wrong: str = ""
    right: str = ""
    stage: str = "text"
    files: Mapping[str, str] = field(default_factory=dict)


@cache
def explanations() -> Mapping[str, Explanation]:
    """All explanations by code, in order."""
    table = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
    found = {
        code: Explanation(code, **{key: _stripped(value) for key, value in row.items()})
        for code, row in table.items()
    }
    return dict(sorted(found.items()))


def _stripped(value: Any) -> Any:
    return value.strip() if isinstance(value, str) else value


def codes() -> list[str]:
    """The codes of all messages."""
    return list(explanations())


def explanation(code: str) -> Explanation:
    """The explanation of a code, in upper or lower case.

    Raises:
        UsageError: no such code; names those near it.
    """
    known = explanations()
    wanted = code.strip().upper()
    if wanted in known:
        return known[wanted]
    near = get_close_matches(wanted[:8], known, n=4, cutoff=0.6)
    about = f"; similar: {', '.join(sorted(near))}" if near else ""
    raise UsageError(f"no message has the code '{code[:40]}'{about}; all: dqpaint explain")


def url(code: str) -> str:
    """The link to a message in the documents, relative to the package's source folder."""
    return f"{PAGE}#{code.lower()}"


def format_explanation(found: Explanation) -> str:
    """An explanation as text for people."""
    parts = [f"{found.code}: {found.title}", found.says]
    if found.wrong:
        parts += ["wrong:", _indented(found.wrong), "right:", _indented(found.right)]
    for name, text in found.files.items():
        parts += [f"and {name} beside it:", _indented(text)]
    return "\n\n".join(parts)


def list_explanations() -> str:
    """All messages, one line each."""
    return "\n".join(f"{found.code}  {found.title}" for found in explanations().values())


def _indented(text: str) -> str:
    return "\n".join(_INDENT + line for line in text.splitlines())
