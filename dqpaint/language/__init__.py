"""Text of a `.traj` file -> Program, or diagnostics of every mistake.

In: the text of a file. Out: a `Program` (see `dqpaint.program`), or a `ScriptError` with every
diagnostic. `compile` runs these steps in order:

    syntax      lexer -> parser (statements, clauses, expressions; statement_rules checks which
                parts go together) -> syntax tree
    expansion   includes -> expander (blocks, definitions)
    values      evaluate -> typed_values, in a scope of names
    strokes     lines, arcs, curves, imported_strokes and modal_words -> segments -> corner_blending
    pen         the pose and the stroke state between statements
    imports     lettering, point_files, svg and stroke_order, for `text`, `path` and `svg`

`vocabulary` has the tables of words and units that all of them read; `writing` is the way back:
formatter, drawing builder, template. A new statement is an entry in `vocabulary.words.STATEMENTS`
and a function in `strokes.strokes`; a new function an entry in `vocabulary.words.FUNCTIONS` and
one in `values.functions.TABLE`.
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
    """Import on first use: formatting a text needs no numerical library."""
    if name in _ROOMS:
        return getattr(importlib.import_module(_ROOMS[name]), name)
    raise AttributeError(f"module 'dqpaint.language' has no attribute '{name}'")
