"""Findings at places in files -> GitHub's workflow commands, or a SARIF 2.1.0 log.

Of the published structure of SARIF a log has what code scanners read: a run with its tool, a rule
for each code, and a result for each finding with level, message and region.
"""

from collections.abc import Sequence
from pathlib import PurePath
from typing import Any, Literal, NamedTuple
from urllib.parse import quote

SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"


class Annotation(NamedTuple):
    """A finding as programs read it.

    Attributes:
        file: that it is about.
        severity: `note` for what is not wrong.
        code: of its kind, such as E120.
        message: a sentence.
        help: what would help; may be empty.
        begin: line and column from 1, in code points; None where it is about the whole file.
        end: likewise, the column behind it.
    """

    file: str
    severity: Literal["error", "warning", "note"]
    code: str
    message: str
    help: str = ""
    begin: tuple[int, int] | None = None
    end: tuple[int, int] | None = None


def github_commands(found: Sequence[Annotation]) -> str:
    """A line for each finding, which GitHub's runner shows beside the line of the file."""
    return "\n".join(map(_github_command, found))


def _github_command(one: Annotation) -> str:
    places = [("file", one.file), ("title", f"dqpaint {one.code}")]
    if one.begin is not None:
        places += [("line", str(one.begin[0])), ("col", str(one.begin[1]))]
    if one.end is not None:
        places += [("endLine", str(one.end[0])), ("endColumn", str(one.end[1]))]
    word = "notice" if one.severity == "note" else one.severity
    said = one.message + (f"\nhelp: {one.help}" if one.help else "")
    joined = ",".join(f"{name}={_escaped(text, ':,')}" for name, text in places)
    return f"::{word} {joined}::{_escaped(said)}"


def _escaped(text: str, more: str = "") -> str:
    """Characters that end a command or a value of it, as their numbers."""
    for sign in "%\r\n" + more:
        text = text.replace(sign, f"%{ord(sign):02X}")
    return text


def sarif_log(found: Sequence[Annotation], rules: dict[str, str], version: str) -> dict[str, Any]:
    """A SARIF log.

    Args:
        found: findings.
        rules: what each code means, in a sentence; of codes that are found.
        version: of dqpaint.
    """
    codes = sorted({one.code for one in found})
    driver = {
        "name": "dqpaint",
        "semanticVersion": version,
        "rules": [
            {"id": code, "shortDescription": {"text": rules.get(code) or code}} for code in codes
        ],
    }
    results = [
        {
            "ruleId": one.code,
            "ruleIndex": codes.index(one.code),
            "level": one.severity,
            "message": {"text": one.message + (f"\nhelp: {one.help}" if one.help else "")},
            "locations": [{"physicalLocation": _place(one)}],
        }
        for one in found
    ]
    run = {"tool": {"driver": driver}, "columnKind": "unicodeCodePoints", "results": results}
    return {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}


def _place(one: Annotation) -> dict[str, Any]:
    place: dict[str, Any] = {"artifactLocation": {"uri": _uri(one.file)}}
    if one.begin is not None:
        region = {"startLine": one.begin[0], "startColumn": one.begin[1]}
        if one.end is not None:
            region |= {"endLine": one.end[0], "endColumn": one.end[1]}
        place["region"] = region
    return place


def _uri(file: str) -> str:
    path = PurePath(file)
    return path.as_uri() if path.is_absolute() else quote(path.as_posix())
