"""The language in editors: colours, completion, messages while one types.

`vocabulary` reads the words off the language's tables; `textmate` and `highlighting` (Pygments)
make grammars of them, `hints` say what a word means and what may come next, `strokes` how long
each line is, `server` speaks the language server protocol. A new word of the language needs no line
here.
"""
