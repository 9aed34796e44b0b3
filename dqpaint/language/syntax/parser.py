"""Text -> statements and blocks; every line is read, whatever errors come before it."""

import re
from collections.abc import Iterable
from dataclasses import replace

from dqpaint.diagnostics import (
    Diagnostic,
    DiagnosticCollector,
    Fix,
    Problem,
    Span,
    closest,
    did_you_mean,
    problem,
)
from dqpaint.language.syntax import statements
from dqpaint.language.syntax.cursor import Cursor, found
from dqpaint.language.syntax.identifiers import meaning
from dqpaint.language.syntax.lexer import Token, TokenLine, lines
from dqpaint.language.syntax.tree import Statement, Word
from dqpaint.language.vocabulary.aliases import (
    FOREIGN,
    FOREIGN_BLOCKS,
    STATEMENT_ADVICE,
    STATEMENT_ALIASES,
)
from dqpaint.language.vocabulary.words import PARTS, RENAMED, SHAPES, STATEMENTS

DEEPEST = 32  # blocks within each other
_BLOCKS = tuple(word for word, known in STATEMENTS.items() if known.block)
_FIRST_WORDS = re.compile(r"^[^\S\n]*([a-z]+)\b[^\S\n]*([A-Za-z_]\w*)?", re.ASCII | re.MULTILINE)
_NEEDLESS = ";:"  # signs of other languages that change nothing


class _Block:
    """A block that is still open."""

    __slots__ = ("body", "header", "known")

    def __init__(self, header: Statement, known: bool) -> None:
        self.header = header
        self.known = known  # one of our blocks, written without a mistake in its first word
        self.body: list[Statement] = []


def parse_statements(
    text: str, findings: DiagnosticCollector, begin: int = 0
) -> tuple[Statement, ...]:
    """The statements of a file from an offset to the end of the text.

    What is wrong with it goes to `findings`.
    """
    return _Parser(text, findings).file(begin)


class _Parser:
    def __init__(self, text: str, findings: DiagnosticCollector) -> None:
        self._text = text
        self._findings = findings
        self._body: list[Statement] = []  # of the innermost block
        self._open: list[_Block] = []
        self._outer: list[list[Statement]] = []  # the bodies round it
        self._spare_ends = 0  # more than our blocks need: those of misspelt ones
        self._defined: frozenset[str] | None = None  # what may be called; None: anything

    def file(self, begin: int) -> tuple[Statement, ...]:
        """Reads all lines."""
        first_words = list(_FIRST_WORDS.findall(self._text, begin))
        self._spare_ends = _spare_ends(first_words)
        self._defined = None if begin else _defined(first_words)
        for line in lines(self._text, begin):
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

    def _line(self, line: TokenLine) -> None:
        first = line.tokens[0]
        if first.text in RENAMED and first.kind == "name":
            first = line.tokens[0] = replace(first, text=RENAMED[first.text])
        if first.kind == "end":  # nothing but characters that are not ours
            self._findings.add(line.problems[0])
            return
        word = first.text
        if (first.kind != "name" or word not in STATEMENTS) and not self._may_be_call(line):
            self._unknown(line)
            return
        if word == "include" and line.tokens[1].kind != "text":
            raise _not_quoted(line.tokens, self._text)
        if line.problems:
            self._findings.add(line.problems[0])
        if word == "end":
            self._end(line)
            return
        statement = self._statement(line)
        if word in _BLOCKS:
            self._begin(statement, known=True)
        else:
            self._body.append(statement)

    def _statement(self, line: TokenLine) -> Statement:
        """Reads one line; an error is reported, and the statement marked as broken."""
        cursor = Cursor(line.tokens, self._text)
        word = line.tokens[0].text
        own = word in STATEMENTS and not (word in SHAPES and self._may_be_call(line))
        read = statements.statement if own else statements.call
        try:
            statement = read(cursor)
        except Problem as mistake:
            if not line.problems:  # else it follows from the one that was reported
                self._findings.add(mistake.diagnostic)
            return _broken(line.tokens)
        if all(self._text[p.span.start] in _NEEDLESS for p in line.problems if p.span):
            return statement
        return _broken(line.tokens)

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
                header.params,
            )
        )

    def _end(self, line: TokenLine) -> None:
        if not self._open:
            raise problem(
                "E131",
                "'end' without a block to close",
                line.tokens[0].span,
                "",
                f"only {', '.join(_BLOCKS[:-1])} and {_BLOCKS[-1]} are closed with 'end'",
            )
        self._close()
        if line.tokens[1].kind != "end" and not line.problems:
            raise problem(
                "E112",
                f"'end' stands alone on its line, but here {found(line.tokens[1])} follows",
                Span(line.tokens[1].start, line.tokens[-1].end),
                "",
                "write: end",
            )

    # What is no statement of ours.

    def _may_be_call(self, line: TokenLine) -> bool:
        """Whether a line is `star(…)` and a `def star` may exist."""
        name, bracket = line.tokens[0], line.tokens[1]
        if name.kind != "name" or bracket.kind != "sign" or bracket.text != "(":
            return False
        if self._defined is not None:
            return name.text in self._defined
        return not meaning(name.text) and name.text not in STATEMENT_ALIASES

    def _unknown(self, line: TokenLine) -> None:
        if line.problems and (at := line.problems[0].span) and at.start < line.tokens[0].start:
            self._findings.add(line.problems[0])
            self._body.append(_broken(line.tokens))
            return
        mistake, opens = self._unknown_statement(line.tokens)
        self._findings.add(mistake)
        broken = _broken(line.tokens)
        if opens and self._spare_ends > 0:
            self._spare_ends -= 1
            self._begin(broken, known=False)
        else:
            self._body.append(broken)

    def _unknown_statement(self, tokens: list[Token]) -> tuple[Diagnostic, bool]:
        """The diagnostic for a line, and whether the line may begin a block."""
        first, word = tokens[0], tokens[0].text
        if first.kind != "name":
            help = "a line begins with a word, such as line, arc or let"
            if _COMMENTED.match(self._text, first.start):
                help = "a comment begins with #"
            message = f"expected a statement but found {found(first)}"
            return Diagnostic("E120", message, first.span, "", help), False
        if _is_definition(tokens):
            return self._definition(tokens), False
        if word in FOREIGN:
            message, help = FOREIGN[word]
            return Diagnostic("E121", message, first.span, "", help), word in FOREIGN_BLOCKS
        if word in PARTS:
            message = f"unknown statement '{word}'"
            help = f"'{word}' belongs to a statement and stands on its line: {_user_of(word)}"
            opens = word in STATEMENTS["with"].parts and word not in STATEMENTS
            return Diagnostic("E120", message, first.span, "", help), opens
        if word == "even":
            message, help = f"unknown statement '{word}'", "it belongs to a light: light white even"
            return Diagnostic("E120", message, first.span, "", help), False
        calls = self._defined or ()
        mistake, meant = unknown_statement(first.text, first.span, calls, tokens[1].text)
        called = word if word in calls else tokens[1].text if tokens[1].text in calls else ""
        if word.lower() in STATEMENTS:  # in capital letters: what follows is its own
            called = ""
        if called or (mistake.help == _HELP and tokens[1].kind == "end"):
            given = tokens[1:] if called == word else tokens[2:]
            values = self._text[given[0].start : tokens[-1].end].strip("() ") if given else ""
            help_ = f"to draw what a 'def' names, write: {called or word}({values})"
            mistake = replace(mistake, help=help_, fix=None)
        return mistake, meant in _BLOCKS

    def _definition(self, tokens: list[Token]) -> Diagnostic:
        """`r = 3 cm`: the assignment of other languages."""
        first = tokens[0]
        if taken := meaning(first.text):
            message = f"'{first.text}' can't be used as a name"
            help = f"choose another name, for example: let {first.text}1 = …"
            return Diagnostic("E114", message, first.span, f"'{first.text}' is {taken}", help)
        written = " ".join(self._text[first.start : tokens[-1].end].split())
        help = f"to name a value, write: let {written}"
        fix = Fix("write let", Span(first.start, first.start), "let ")
        return Diagnostic(
            "E120", f"unknown statement '{first.text}'", first.span, "", help, fix=fix
        )


_COMMENTED = re.compile(r"--|//|/\*|%|\*")  # as other languages begin a comment
_HELP = "a line begins with a word such as line, arc or let, and a comment with #"


def unknown_statement(
    word: str, span: Span, calls: Iterable[str] = (), after: str = ""
) -> tuple[Diagnostic, str]:
    """E120 with the likely word; `calls` can be called, `after` is the next token's text."""
    advice = STATEMENT_ADVICE.get(f"{word} {after}") or STATEMENT_ADVICE.get(word)
    if advice and word not in calls:
        return Diagnostic("E120", f"unknown statement '{word}'", span, "", advice), ""
    meant = closest(word, (*STATEMENTS, *calls), STATEMENT_ALIASES)
    fits = meant in STATEMENTS or meant in calls
    fits = fits or (meant.endswith(" to") and after in ("(", "polar"))
    fix = Fix(f"write {meant}", span, meant) if fits else None
    message = f"unknown statement '{word}'"
    return Diagnostic("E120", message, span, "", did_you_mean(meant) or _HELP, fix=fix), meant


def _is_definition(tokens: list[Token]) -> bool:
    """Whether a line is `r = …`, the assignment of other languages."""
    if tokens[0].text in STATEMENTS or len(tokens) < 2:
        return False
    return tokens[1].kind == "sign" and tokens[1].text == "="


def _defined(first_words: Iterable[tuple[str, str]]) -> frozenset[str] | None:
    """The names after `def` and `let` in a file; None if more may come from another file."""
    names = set()
    for word, name in first_words:
        if word == "include":
            return None
        if word in ("def", "let", "frame"):
            names.add(name)
    return frozenset(names)


def _spare_ends(first_words: Iterable[tuple[str, str]]) -> int:
    """The number of `end` lines beyond those that close a block."""
    return sum((word == "end") - (word in _BLOCKS) for word, _ in first_words)


_OTHER_FORMS = {  # of `arc`: not the one of its example
    "via": "arc via (10, 10) mm to (20, 0) mm",
    "center": "arc center (30, 0) mm angle 360 deg",
    **{part: f"arc radius 20 mm to (20, 0) mm {part}" for part in ("left", "right")},
    **dict.fromkeys(("radius", "long"), "arc radius 20 mm to (20, 0) mm left long"),
}


def _user_of(part: str) -> str:
    """An example of a statement with this part."""
    if part in _OTHER_FORMS:
        return _OTHER_FORMS[part]
    for known in STATEMENTS.values():
        if part in known.parts:
            words = known.example.split()
            return known.example if part in words else f"{known.example} {PARTS[part].example}"
    return PARTS[part].example


def _broken(tokens: list[Token]) -> Statement:
    """A placeholder for a line with an error: it only defines the line's name."""
    span = Span(tokens[0].start, tokens[-1].end)
    word, name = tokens[0].text, None
    if word == "end":
        word = ""
    if _is_definition(tokens):
        name = Word(tokens[0].text, tokens[0].span)
    elif (
        word in ("let", "repeat", "def", "frame", "for")
        and len(tokens) > 2
        and tokens[1].kind == "name"
    ):
        name = Word(tokens[1].text, tokens[1].span)
    return Statement(word, span, name, broken=True)


def _not_quoted(tokens: list[Token], text: str) -> Problem:
    span = Span(tokens[1].start, tokens[-1].end)
    if span.start == span.end:
        message = "expected the name of a file but found the end of the line"
        return problem("E109", message, tokens[0].span, "", 'for example: include "f.traj"')
    message, help = "the name of a file stands in quotes", f'include "{span.text_in(text)}"'
    return problem("E109", message, span, "", f"write: {help}")


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
