"""Errors and warnings with their position in a text -> messages with line, mark and fix.

A `Diagnostic` has a code, a message, spans and help; `catalogue` explains each code. A new code
needs an entry in `catalogue.toml` with an example.
"""

from dqpaint.diagnostics import catalogue
from dqpaint.diagnostics.annotations import Annotation, github_commands, sarif_log
from dqpaint.diagnostics.catalogue import url
from dqpaint.diagnostics.collector import DiagnosticCollector, ErrorLimitError
from dqpaint.diagnostics.diagnostic import (
    Diagnostic, Fix, Problem, ScriptError, Severity, Source, SourceLine, Span,
    UnknownPositionProblem, at_call, file_at, file_number, line_name, locate, problem, render,
    text_of_line,
)
from dqpaint.diagnostics.did_you_mean import closest, did_you_mean, join_words

__all__ = [
    "Annotation", "Diagnostic", "DiagnosticCollector", "ErrorLimitError", "Fix",
    "Problem", "ScriptError", "Severity", "Source", "SourceLine", "Span", "UnknownPositionProblem",
    "at_call", "catalogue", "closest", "did_you_mean", "file_at", "file_number", "github_commands",
    "join_words", "line_name", "locate", "problem", "render", "sarif_log", "text_of_line", "url",
]
