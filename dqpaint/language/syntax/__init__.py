"""Text -> tokens -> syntax tree, each node with its span.

`statement_rules` says which clauses a statement takes.
"""

from dqpaint.language.syntax.identifiers import meaning
from dqpaint.language.syntax.lexer import NUMBER, TOKEN, Token, lines
from dqpaint.language.syntax.source import STDIN

__all__ = ["NUMBER", "STDIN", "TOKEN", "Token", "lines", "meaning"]
