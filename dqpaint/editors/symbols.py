"""Text of a drawing -> its names, where each is defined and used, and its blocks.

It works on tokens, not on the syntax tree: an editor asks while a line is half written. A name is
known from its line to the end of its block; what `for` and a formula's brackets name, on that line.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

from dqpaint.diagnostics import Span
from dqpaint.language.syntax import Token, lines, meaning
from dqpaint.language.vocabulary import FREE, PARTS, STATEMENTS


class Name(NamedTuple):
    """A name that a drawing defines.

    Attributes:
        text: the name.
        kind: `let`, `function`, `def`, `frame`, `counter` or `parameter`.
        span: of the name where it is defined.
        whole: of the line or block that defines it.
        known: where the name means this.
        parameters: of a function or a `def`.
    """

    text: str
    kind: str
    span: Span
    whole: Span
    known: Span
    parameters: tuple[str, ...] = ()


@dataclass
class Block:
    """Lines up to an `end`, or a whole text.

    Attributes:
        head: the text of its first line.
        span: of all of it.
        names: that its first line and its lines define, in order.
        blocks: within it.
    """

    head: str
    span: Span
    names: list[Name] = field(default_factory=list)
    blocks: list["Block"] = field(default_factory=list)


class Outline(NamedTuple):
    """A text's blocks, names, and the tokens that may use names.

    Attributes:
        root: the text as a block.
        names: all of them, in the order of the text.
        uses: name tokens; whether each is in the place of a frame.
        files: the names that `include` lines have, in quotes.
    """

    root: Block
    names: tuple[Name, ...]
    uses: tuple[tuple[Token, bool], ...]
    files: tuple[str, ...]

    def meant(self, offset: int) -> Name | None:
        """The definition of the name at an offset; None where there is none in this text."""
        for token, of_frame in self.uses:
            if token.start <= offset <= token.end:
                return self.resolve(token, of_frame)
        return None

    def resolve(self, token: Token, of_frame: bool) -> Name | None:
        """The definition that a token uses, or is."""
        there = [
            name
            for name in self.names
            if name.text == token.text
            and (name.kind == "frame") == of_frame
            and (name.known.start <= token.start < name.known.end or name.span == token.span)
        ]
        before = [name for name in there if name.span.start <= token.start]
        return before[-1] if before else next(iter(there), None)

    def occurrences(self, name: Name) -> list[Span]:
        """Where a name is written: its definition and its uses."""
        return [t.span for t, of_frame in self.uses if self.resolve(t, of_frame) == name]


def outline(text: str) -> Outline:
    """The names and blocks of a text, of faulty ones as far as they can be told."""
    root = Block("", Span(0, len(text)))
    stack, names, files = [root], [], []
    uses: list[tuple[Token, bool]] = []
    for line in lines(text):
        if not line.tokens:
            continue
        first, whole = line.tokens[0], Span(line.tokens[0].start, line.tokens[-1].end)
        uses += _uses(line.tokens)
        if first.text == "end" and len(line.tokens) <= 2:
            if len(stack) > 1:
                names += _closed(stack.pop(), whole.end)
            continue
        if first.text == "include":
            files += [token.text for token in line.tokens if token.kind == "text"]
        known = STATEMENTS.get(first.text)
        block = None
        if known is not None and known.block:
            block = Block(text[whole.start : whole.end], whole)
            stack[-1].blocks.append(block)
        for token, kind, parameters in _defined(line.tokens):
            begin = 0 if kind == "def" else whole.end
            name = Name(token.text, kind, token.span, whole, Span(begin, begin), parameters)
            if kind in ("counter", "parameter") and block is not None:
                block.names.append(name._replace(known=whole))
            elif kind == "parameter":
                names.append(name._replace(known=whole))
            else:
                stack[-1].names.append(name)
        if block is not None:
            stack.append(block)
    while stack:
        names += _closed(stack.pop(), len(text))
    return Outline(
        root, tuple(sorted(names, key=lambda n: n.span.start)), tuple(uses), tuple(files)
    )


def _closed(block: Block, end: int) -> list[Name]:
    """The names of a block that ends here: they are known up to there."""
    block.span = Span(block.span.start, end)
    block.names = [name._replace(known=Span(name.known.start, end)) for name in block.names]
    return block.names


def _defined(tokens: list[Token]) -> Iterator[tuple[Token, str, tuple[str, ...]]]:
    """The names that a line defines, with their kinds; a function's parameters after it."""
    first, *rest = tokens
    named = rest[0] if rest and rest[0].kind == "name" else None
    if named is not None and first.text in ("let", "def"):
        handed = _handed(rest[1:])
        words = tuple(token.text for token in handed)
        kind = "def" if first.text == "def" else "function" if handed else "let"
        yield named, kind, words
        yield from ((token, "parameter", ()) for token in handed)
    elif named is not None and first.text == "frame":
        yield named, "frame", ()
    elif named is not None and first.text == "repeat" and rest[1:2] and rest[1].text == "from":
        yield named, "counter", ()
    if first.text == "curve":
        for before, token in pairwise(rest):
            if before.text == "for" and token.kind == "name":
                yield token, "parameter", ()


def _handed(tokens: list[Token]) -> list[Token]:
    """The names in the brackets right after a name, where a formula or a block follows."""
    found: list[Token] = []
    if not tokens or tokens[0].text != "(":
        return found
    for token in tokens[1:]:
        if token.text == ")":
            return found
        if token.kind == "name":
            found.append(token)
    return []


def _uses(tokens: list[Token]) -> Iterator[tuple[Token, bool]]:
    """The tokens of a line that may be names of the drawing; whether each is a frame's."""
    before: Token | None = None
    for token in tokens:
        after_value = before is not None and (
            before.kind in ("number", "text")
            or before.text == ")"
            or (before.kind == "name" and before.text not in {*PARTS, *STATEMENTS})
        )
        if token.kind == "name" and token is not tokens[0]:
            of_frame = before is not None and before.text == "frame"
            if not meaning(token.text) or of_frame or _may_be_free(token, after_value):
                yield token, of_frame
        elif token.kind == "name" and token.text not in STATEMENTS and token.text != "end":
            yield token, False  # a line that calls a def
        before = token


def _may_be_free(token: Token, after_value: bool) -> bool:
    """Whether a word that is a part's, too, or `x`, stands where a value is wanted."""
    return (token.text in FREE or token.text in ("x", "y", "z")) and not after_value


def folds(text: str) -> list[tuple[int, int, bool]]:
    """First and last lines, from 0, that can be folded; whether they are comments."""
    found = [(*_rows(text, block.span), False) for block in _all_blocks(outline(text).root)]
    begin: int | None = None
    for row, line in enumerate([*text.split("\n"), ""]):
        if line.lstrip().startswith("#"):
            begin = row if begin is None else begin
        elif begin is not None:
            if row - begin > 1:
                found.append((begin, row - 1, True))
            begin = None
    return sorted(one for one in found if one[1] > one[0])


def _all_blocks(block: Block) -> Iterable[Block]:
    for inner in block.blocks:
        yield inner
        yield from _all_blocks(inner)


def _rows(text: str, span: Span) -> tuple[int, int]:
    return text.count("\n", 0, span.start), text.count("\n", 0, span.end)


class Call(NamedTuple):
    """A call that is being written.

    Attributes:
        name: of the function.
        argument: which of its values, from 0.
    """

    name: str
    argument: int


def call_at(text: str, offset: int) -> Call | None:
    """The innermost call whose brackets are open at an offset."""
    begin = text.rfind("\n", 0, offset) + 1
    open_calls: list[Call] = []
    before: Token | None = None
    for line in lines(text[begin:offset]):
        for token in line.tokens:
            if token.text == "(" and token.kind == "sign":
                named = before is not None and before.kind == "name" and before.end == token.start
                open_calls.append(Call(before.text if named and before else "", 0))
            elif token.text == ")" and token.kind == "sign" and open_calls:
                open_calls.pop()
            elif token.text == "," and token.kind == "sign" and open_calls:
                name, argument = open_calls.pop()
                open_calls.append(Call(name, argument + 1))
            before = token
    return open_calls[-1] if open_calls and open_calls[-1].name else None
