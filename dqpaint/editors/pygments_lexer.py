"""The words of the language -> a Pygments lexer, for documents and slides (`-l traj`).

Pygments finds it by an entry point; dqpaint itself does not need it.
"""

from typing import ClassVar

from pygments.lexer import RegexLexer, bygroups
from pygments.token import Comment, Keyword, Name, Number, Operator, Punctuation, String, Text

from dqpaint.editors.textmate import COMMENT, TEXT, alternatives
from dqpaint.editors.vocabulary import words
from dqpaint.language.syntax import NUMBER

_KINDS = {
    "part": Keyword.Declaration,
    "word": Keyword.Declaration,
    "function": Name.Function,
    "profile": Name.Builtin,
    "constant": Name.Constant,
    "colour": Name.Builtin,
    "unit": Keyword.Type,
    "statement": Keyword.Declaration,  # within a line: `look line`
    "renamed": Keyword.Declaration,
}
_END = r"(?![A-Za-z0-9_])"


class TrajLexer(RegexLexer):
    """Colours .traj drawings."""

    name = "traj"
    aliases: ClassVar[list[str]] = ["traj"]
    filenames: ClassVar[list[str]] = ["*.traj"]
    mimetypes: ClassVar[list[str]] = []
    url = ""
    version_added = ""

    tokens: ClassVar = {
        "root": [
            (
                rf"^([^\S\n]*)({alternatives(words('statement'))}){_END}",
                bygroups(Text.Whitespace, Keyword),
            ),
            (r"\n|[^\S\n]+", Text.Whitespace),
            (COMMENT, Comment.Single),
            (TEXT, String.Double),
            (
                rf"({NUMBER})(\s*)({alternatives(words('unit'))}){_END}",
                bygroups(Number, Text.Whitespace, Keyword.Type),
            ),
            (NUMBER, Number),
            *((rf"(?:{alternatives(words(kind))}){_END}", token) for kind, token in _KINDS.items()),
            (r"[A-Za-z_][A-Za-z0-9_]*", Name),
            (r"[-+*/^=%]", Operator),
            (r"[(),]", Punctuation),
        ]
    }
