"""The words of the language -> a TextMate grammar, as VS Code and others read it."""

import re
from typing import Any

from dqpaint.editors.vocabulary import words
from dqpaint.language.syntax import NUMBER

SCOPE = "source.traj"
TEXT = r'"[^"\n]*"?'
COMMENT = r"#.*"

# The kinds of words and how editors call them, in the order in which they are tried; a statement's
# word within a line is one like `look line`.
_SCOPES = {
    "part": "keyword.other",
    "word": "keyword.other",
    "function": "support.function",
    "profile": "support.constant.profile",
    "constant": "constant.language",
    "colour": "support.constant.colour",
    "unit": "keyword.other.unit",
    "statement": "keyword.other",
    "renamed": "keyword.other",
}
_STATEMENT = "keyword.control.traj"


def grammar() -> dict[str, Any]:
    """The grammar, ready to be written as JSON."""
    unit = alternatives(words("unit"))
    return {
        "$schema": "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json",
        "name": "traj",
        "scopeName": SCOPE,
        "fileTypes": ["traj"],
        "patterns": [
            _pattern("comment.line.number-sign", COMMENT),
            _pattern("string.quoted.double", TEXT),
            {
                "match": rf"({NUMBER})\s*({unit})?(?![A-Za-z0-9_])",
                "captures": {
                    "1": {"name": "constant.numeric.traj"},
                    "2": {"name": "keyword.other.unit.traj"},
                },
            },
            {
                "match": rf"^\s*({alternatives(words('statement'))})(?![A-Za-z0-9_])",
                "captures": {"1": {"name": _STATEMENT}},
            },
            *(
                _pattern(scope, rf"(?<![A-Za-z0-9_])({alternatives(words(kind))})(?![A-Za-z0-9_])")
                for kind, scope in _SCOPES.items()
            ),
            _pattern("keyword.operator", r"[-+*/^=%]"),
        ],
    }


def alternatives(known: list[str]) -> str:
    """A pattern for any of some words."""
    return "|".join(map(re.escape, known))


def _pattern(scope: str, match: str) -> dict[str, str]:
    return {"name": f"{scope}.traj", "match": match}
