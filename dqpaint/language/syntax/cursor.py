"""Reading position in the tokens of one line."""

from dqpaint.diagnostics import Problem, Span, problem
from dqpaint.language.syntax.lexer import Token
from dqpaint.language.vocabulary.words import RESERVED, STATEMENTS


class Cursor:
    """The tokens of a line and the reading position."""

    __slots__ = ("_at", "_tokens", "depth", "text", "token")

    def __init__(self, tokens: list[Token], text: str) -> None:
        self.text = text  # of the whole file
        self._tokens = tokens
        self._at = 0
        self.token = tokens[0]  # the next one to be read
        self.depth = 0  # of brackets within each other

    def take(self) -> Token:
        """Reads and returns the next token."""
        token = self.token
        if token.kind != "end":
            self._at += 1
            self.token = self._tokens[self._at]
        return token

    def peek(self) -> Token:
        """The token after the next."""
        return self._tokens[min(self._at + 1, len(self._tokens) - 1)]

    @property
    def first(self) -> Token:
        """The first token of the line."""
        return self._tokens[0]

    @property
    def before(self) -> Token:
        """The token read last."""
        return self._tokens[self._at - 1 if self._at else 0]

    def before_is(self, back: int, word: str) -> bool:
        """Whether this word was read `back` tokens ago."""
        return self._at >= back and self._tokens[self._at - back].text == word

    def is_word(self, word: str) -> bool:
        """Whether the next token is this word."""
        return self.token.kind == "name" and self.token.text == word

    def is_sign(self, sign: str) -> bool:
        """Whether the next token is this sign."""
        return self.token.kind == "sign" and self.token.text == sign

    @property
    def at_end(self) -> bool:
        """Whether all tokens are read."""
        return self.token.kind == "end"

    def span_from(self, start: int) -> Span:
        """The span from an offset to the end of the token read last."""
        end = self._tokens[self._at - 1 if self._at else 0].end
        return Span(start, end if end > start else start)


def found(token: Token) -> str:
    """The name of a token in messages: its text, not only its kind."""
    if token.kind == "end":
        return "the end of the line"
    if token.kind == "number":
        return f"the number {token.text.rstrip('.')}"
    if token.kind == "text":
        return f'the text "{token.text}"'
    return f"'{token.text}'"


def no_value(cursor: Cursor, after: str, example: str = "") -> Problem:
    """E105: a value is missing."""
    token = cursor.token
    help = f"for example: {example}" if example else ""
    if token.kind == "name" and token.text in RESERVED:
        help = f"'{token.text}' is a word of the language; it can't be used as a name"
    elif token.text == "=" and token.kind == "sign":
        help = f"only 'let' has a '='; {help}" if help else "only 'let' has a '='"
    elif token.text == after == "*":
        help = "a power is written with ^, as in t^2"
    elif after == "/" and token.text in ("/", "*"):
        help = "a comment begins with #"
    elif token.kind == "sign" and token.text in "),":
        help = "a comma stands between two numbers, as in (10, 20) mm"
    elif token.kind == "text" or (token.kind == "sign" and token.text not in ")%,"):
        help = "write a number, a name or a point in brackets"
    return problem(
        "E105",
        f"expected a value after '{after}' but found {found(token)}",
        token.span if token.kind != "end" else cursor.before.span,
        "nothing follows" if token.kind == "end" else "",
        help,
    )


def example_of(word: str) -> str:
    """A whole example line of this word's statement."""
    statement = STATEMENTS.get(word)
    return statement.example if statement else ""


def percent(cursor: Cursor, what: str, example: str) -> float:
    """A number and its % sign, as a fraction of 1."""
    share = float(cursor.take().text) / 100.0
    if not cursor.is_sign("%"):
        message = f"expected '%' after {what} but found {found(cursor.token)}"
        raise problem("E109", message, cursor.before.span, "", f"for example: {example}")
    cursor.take()
    return share
