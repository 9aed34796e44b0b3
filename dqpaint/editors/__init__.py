"""Text of a drawing -> colours, completion, hints and diagnostics for editors.

`vocabulary` reads the words from the language's tables; `textmate` and `pygments_lexer` make
grammars of them. `completion` explains words and suggests what may follow, `analysis` measures each
line, `symbols` finds names, blocks and calls, `swatches` colours. `server` speaks the language
server protocol, with `document` and `navigation`; `vscode` is an extension. A new word of the
language needs no line here.
"""

__all__ = ["analysis", "completion", "server", "textmate", "vocabulary"]
