"""Errors and warnings at their place in a text -> messages with the line, a mark and a fix.

A `Diagnostic` has a code, a message, spans and help; `catalogue` explains each code. A new code
needs an entry in `catalogue.toml` with an example.
"""

from dqpaint.diagnostics import catalogue
from dqpaint.diagnostics.catalogue import url
from dqpaint.diagnostics.collector import EnoughError, Findings
from dqpaint.diagnostics.diagnostic import (
    Diagnostic,
    Fix,
    PlaceProblem,
    Problem,
    ScriptError,
    Severity,
    Source,
    SourceLine,
    Span,
    called_here,
    file_at,
    file_number,
    line_named,
    place,
    problem,
    render,
    text_of_line,
)
from dqpaint.diagnostics.did_you_mean import closest, did_you_mean, listed

__all__ = [
    "Diagnostic",
    "EnoughError",
    "Findings",
    "Fix",
    "PlaceProblem",
    "Problem",
    "ScriptError",
    "Severity",
    "Source",
    "SourceLine",
    "Span",
    "called_here",
    "catalogue",
    "closest",
    "did_you_mean",
    "file_at",
    "file_number",
    "line_named",
    "listed",
    "place",
    "problem",
    "render",
    "text_of_line",
    "url",
]
