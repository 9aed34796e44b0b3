"""The language for editors: text -> colours, completion, hints and messages while one types.

`vocabulary` reads the words from the language's tables; `textmate` and `pygments_lexer` make
grammars of them, `completion` says what a word means and what may follow, `analysis` how long each
line takes, `server` speaks the language server protocol. A new word of the language needs no line
here.
"""

__all__ = ["server", "textmate", "vocabulary"]
