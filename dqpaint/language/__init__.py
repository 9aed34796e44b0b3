"""Text -> Program: a `.traj` file, understood, checked and written out as strokes.

In goes the text of a file; out comes a `Program` (see `program`), or a `ScriptError` with every
mistake that was found. The text passes through

    lexer -> parser (statements, clauses, forms, expressions) -> syntax tree -> includes
          -> expand (evaluate, reading, settings, blocks, definitions)
          -> strokes (arcs, curves, tools, timing, and for what comes from elsewhere
             letters, tables, drawings) -> blends

and `words` and `units` hold the tables all of them read. A new statement is a line in
`words.STATEMENTS` and a function in `strokes`; a new function a line in `words.FUNCTIONS` and one
in `functions.TABLE`.
"""

import importlib
from typing import TYPE_CHECKING, Any

from dqpaint.diagnostics import Diagnostic, ScriptError, render

if TYPE_CHECKING:
    from dqpaint.language.compile import parse, read, read_input
    from dqpaint.program import Program

__all__ = ["Diagnostic", "Program", "ScriptError", "parse", "read", "read_input", "render"]

_ROOMS = {
    "Program": "dqpaint.program.program",
    "parse": "dqpaint.language.compile",
    "read": "dqpaint.language.compile",
    "read_input": "dqpaint.language.compile",
}


def __getattr__(name: str) -> Any:
    """Import on first use: a text can be laid out without the numbers that it stands for."""
    if name in _ROOMS:
        return getattr(importlib.import_module(_ROOMS[name]), name)
    raise AttributeError(f"module 'dqpaint.language' has no attribute '{name}'")
