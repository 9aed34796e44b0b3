"""Text -> statements: lines and blocks. Every line is read, whatever was wrong in those before."""

from collections.abc import Iterable

from dqpaint.language import statements
from dqpaint.language.cursor import Cursor, found
from dqpaint.language.diagnostics import Diagnostic, Fix, Problem, Span, problem
from dqpaint.language.findings import Findings
from dqpaint.language.lexer import Line, Token, lines
from dqpaint.language.names import meaning
from dqpaint.language.suggestions import closest, did_you_mean
from dqpaint.language.syntax import Statement, Word
from dqpaint.language.words import (
    FOREIGN,
    FOREIGN_BLOCKS,
    NOT_YET,
    PARTS,
    STATEMENT_ALIASES,
    STATEMENTS,
)

DEEPEST = 32  # blocks within each other
_BLOCKS = tuple(word for word, known in STATEMENTS.items() if known.block)
_NEEDLESS = ";:"  # signs of other languages that change nothing


class _Block:
    """A block whose `end` has not come yet."""

    __slots__ = ("body", "header", "known")

    def __init__(self, header: Statement, known: bool) -> None:
        self.header = header
        self.known = known  # one of our blocks, written without a mistake in its first word
        self.body: list[Statement] = []


def parse_statements(text: str, findings: Findings) -> tuple[Statement, ...]:
    """The statements of a file; what is wrong with it goes to `findings`."""
    return _Parser(text, findings).file()


class _Parser:
    def __init__(self, text: str, findings: Findings) -> None:
        self._text = text
        self._findings = findings
        self._body: list[Statement] = []  # of the innermost block
        self._open: list[_Block] = []
        self._outer: list[list[Statement]] = []  # the bodies round it
        self._spare_ends = 0  # more than our blocks need: those of misspelt ones

    def file(self) -> tuple[Statement, ...]:
        """Reads all lines."""
        found_lines = list(lines(self._text))
        self._spare_ends = _spare_ends(found_lines)
        for line in found_lines:
            try:
                self._line(line)
            except Problem as mistake:
                self._findings.add(mistake.diagnostic)
        while self._open:
            block = self._open[-1]
            if block.known:
                self._findings.add(_no_end(block.header))
            self._close()
        return tuple(self._body)

    def _line(self, line: Line) -> None:
        first = line.tokens[0]
        if first.kind == "end":  # nothing but characters that are not ours
            self._findings.add(line.problems[0])
            return
        word = first.text
        if first.kind != "name" or word not in STATEMENTS:
            self._unknown(line)
            return
        if line.problems:
            self._findings.add(line.problems[0])
        if word == "end":
            self._end(line)
            return
        statement = self._statement(line)
        if STATEMENTS[word].block:
            self._begin(statement, known=True)
        else:
            self._body.append(statement)

    def _statement(self, line: Line) -> Statement:
        """One line; a mistake in it is reported, and the statement marked as broken."""
        cursor = Cursor(line.tokens, self._text)
        needless = all(self._text[p.span.start] in _NEEDLESS for p in line.problems if p.span)
        try:
            statement = statements.statement(cursor)
        except Problem as mistake:
            if not line.problems:  # else it follows from the one that was reported
                self._findings.add(mistake.diagnostic)
            return _broken(line.tokens)
        return statement if needless else _broken(line.tokens)

    # Blocks.

    def _begin(self, header: Statement, known: bool) -> None:
        if len(self._open) == DEEPEST:
            self._findings.add(_too_deep(header))
        self._open.append(_Block(header, known))
        self._outer.append(self._body)
        self._body = []

    def _close(self) -> None:
        header, body = self._open.pop().header, self._body
        self._body = self._outer.pop()
        if len(self._open) >= DEEPEST:
            body = []  # the tree stays no deeper than its readers can go
        self._body.append(
            Statement(
                header.word,
                header.span,
                header.name,
                header.values,
                header.parts,
                tuple(body),
                header.broken,
            )
        )

    def _end(self, line: Line) -> None:
        if not self._open:
            raise problem(
                "E131",
                "'end' without a block to close",
                line.tokens[0].span,
                "",
                "only repeat and with are closed with 'end'",
            )
        self._close()
        if line.tokens[1].kind != "end" and not line.problems:
            raise problem(
                "E112",
                f"'end' stands alone on its line, but here {found(line.tokens[1])} follows",
                Span(line.tokens[1].start, line.tokens[-1].end),
            )

    # What is no statement of ours.

    def _unknown(self, line: Line) -> None:
        mistake, opens = self._unknown_statement(line.tokens)
        self._findings.add(mistake)
        broken = _broken(line.tokens)
        if opens and self._spare_ends > 0:
            self._spare_ends -= 1
            self._begin(broken, known=False)
        else:
            self._body.append(broken)

    def _unknown_statement(self, tokens: list[Token]) -> tuple[Diagnostic, bool]:
        """What to say about a line, and whether it may begin a block."""
        first, word = tokens[0], tokens[0].text
        if first.kind != "name":
            cure = "a line begins with a word, such as line, arc or let"
            message = f"expected a statement but found {found(first)}"
            return Diagnostic("E120", message, first.span, "", cure), False
        if _is_definition(tokens):
            return self._definition(tokens), False
        if word in NOT_YET:
            message = f"'{word}' is not in this version of dqpaint yet"
            return Diagnostic("E122", message, first.span), NOT_YET[word]
        if word in FOREIGN:
            message, cure = FOREIGN[word]
            return Diagnostic("E121", message, first.span, "", cure), word in FOREIGN_BLOCKS
        message = f"unknown statement '{word}'"
        if word in PARTS:
            cure = f"'{word}' belongs to a statement and stands on its line: {_user_of(word)}"
            return Diagnostic("E120", message, first.span, "", cure), False
        meant = closest(word, STATEMENTS, STATEMENT_ALIASES)
        fix = Fix(f"write {meant}", first.span, meant) if _fits(meant, tokens) else None
        cure = did_you_mean(meant)
        return Diagnostic("E120", message, first.span, "", cure, fix=fix), meant in _BLOCKS

    def _definition(self, tokens: list[Token]) -> Diagnostic:
        """`r = 3 cm`: another language's way to name a value."""
        first = tokens[0]
        if taken := meaning(first.text):
            message = f"'{first.text}' can't be used as a name"
            cure = f"choose another name, for example: let {first.text}1 = …"
            return Diagnostic("E114", message, first.span, f"'{first.text}' is {taken}", cure)
        written = " ".join(self._text[first.start : tokens[-1].end].split())
        cure = f"to name a value, write: let {written}"
        fix = Fix("write let", Span(first.start, first.start), "let ")
        return Diagnostic(
            "E120", f"unknown statement '{first.text}'", first.span, "", cure, fix=fix
        )


def _fits(meant: str, tokens: list[Token]) -> bool:
    """Whether what was meant can stand in the place of a line's first word as it is."""
    word, _, rest = meant.partition(" ")
    return word in STATEMENTS and (not rest or (rest == "to" and tokens[1].text in ("(", "polar")))


def _is_definition(tokens: list[Token]) -> bool:
    """Whether a line is `r = …`, as other languages name a value."""
    if tokens[0].text in STATEMENTS or len(tokens) < 2:
        return False
    return tokens[1].kind == "sign" and tokens[1].text == "="


def _spare_ends(found_lines: Iterable[Line]) -> int:
    """How many `end` lines there are more than lines that begin one of our blocks."""
    spare = 0
    for line in found_lines:
        word = line.tokens[0].text
        spare += (word == "end") - (word in _BLOCKS)
    return spare


def _user_of(part: str) -> str:
    """An example of a statement with this part."""
    for known in STATEMENTS.values():
        if part in known.parts:
            words = known.example.split()
            return known.example if part in words else f"{known.example} {PARTS[part].example}"
    return PARTS[part].example


def _broken(tokens: list[Token]) -> Statement:
    """What is left of a line with a mistake: the name it meant to give."""
    span = Span(tokens[0].start, tokens[-1].end)
    word, name = tokens[0].text, None
    if word == "end":
        word = ""
    if _is_definition(tokens):
        name = Word(tokens[0].text, tokens[0].span)
    elif word in ("let", "repeat", "def") and len(tokens) > 2 and tokens[1].kind == "name":
        name = Word(tokens[1].text, tokens[1].span)
    return Statement(word, span, name, broken=True)


def _no_end(header: Statement) -> Diagnostic:
    span = Span(header.span.start, header.span.start + len(header.word))
    return Diagnostic(
        "E130",
        f"this '{header.word}' has no 'end'",
        span,
        "opened here",
        "add a line 'end' after the last line of the block",
    )


def _too_deep(header: Statement) -> Diagnostic:
    span = Span(header.span.start, header.span.start + len(header.word))
    return Diagnostic(
        "E126",
        f"more than {DEEPEST} blocks within each other",
        span,
        "",
        "one 'with' can turn, shift and scale at once",
    )
