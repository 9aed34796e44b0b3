"""Python calls -> drawing: the language for drawings that are computed.

    d = Drawing(period=0.008)
    d.speed(0.06)
    d.move(to=(0.08, 0))
    for i in range(1, 6):
        with d.block(rotate=i, light="cyan"):
            d.line(to=(0.08, 0), in_=1.5)
    print(d)

Every statement is a method and every part a keyword, as the tables of the language have them; words
that Python keeps for itself end with an underscore (`in_`), and `with` is `block`. Numbers are in
SI units: metres, radians, seconds. A string is text of the language: `angle="90 deg"`.
"""

import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from html import escape
from keyword import iskeyword
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from dqpaint.diagnostics import file_at
from dqpaint.errors import UsageError
from dqpaint.language import Program, ScriptError, parse, render
from dqpaint.language.vocabulary.words import RENAMED, STATEMENTS
from dqpaint.language.writing.formatter import STEP, formatted
from dqpaint.language.writing.values_to_text import (
    Unwritable,
    example_as_call,
    quoted,
    written_head,
    written_part,
)

if TYPE_CHECKING:
    from dqpaint.language.writing.statements import Statements
else:
    Statements = object

_BLOCKS = {"with": "block", "def": "define"}  # as methods
METHODS = {
    _BLOCKS.get(word, f"{word}_" if iskeyword(word) else word): word
    for word in STATEMENTS
    if word != "end"
}
_CALLS = {**METHODS, **RENAMED}  # names of earlier versions work but are not listed
_OF_FORM = "E1"  # prefix of the codes of syntax errors


def example_call(word: str) -> str:
    """The example of a statement, as it would be typed."""
    method = next(method for method, known in METHODS.items() if known == word)
    return f"d.{example_as_call(word, method)}"


class Call(NamedTuple):
    """The place of a call in a Python file."""

    file: str
    line: int
    function: str

    def __str__(self) -> str:
        inside = f", in {self.function}" if self.function != "<module>" else ""
        return f"{Path(self.file).name}:{self.line}{inside}"


class DrawingError(ScriptError):
    """Errors of a drawing made by calls; each message names its call."""

    def __init__(self, problem: ScriptError, calls: dict[int, Call]) -> None:
        super().__init__(problem.name, problem.text, problem.diagnostics)
        self.calls = calls  # by the line of the text, from 1

    def __str__(self) -> str:
        texts = []
        for diagnostic in self.diagnostics:
            shown = render(diagnostic, self.name, self.text)
            if diagnostic.span is not None and not file_at(self.text, diagnostic.span.start, "")[0]:
                line = self.text.count("\n", 0, diagnostic.span.start) + 1
                margin = " " * (len(str(line)) + 1)
                shown += self._call(line, margin, diagnostic.code)
            texts.append(shown)
        return "\n\n".join(texts)

    def _call(self, line: int, margin: str, code: str) -> str:
        """The call of a message, with its usage if an argument is missing."""
        if line not in self.calls:
            return ""
        word = self.text.split("\n")[line - 1].split()[0]
        form = (
            f"; for example: {example_call(word)}"
            if code.startswith(_OF_FORM) and word in STATEMENTS
            else ""
        )
        return f"\n{margin}= call: {self.calls[line]}{form}"


class Drawing(Statements):
    """A drawing made by calls: `str` gives its .traj text, `program` its Program.

    Args:
        name: what messages and files are called after it.
        folder: where the files lie that it names (`include`, `path`, `svg`).
        settings: first statements with one value, such as `period=0.008`.
    """

    def __init__(self, name: str = "drawing", folder: str | Path = ".", **settings: Any) -> None:
        self.name = name
        self.folder = Path(folder)
        self._lines: list[str] = []
        self._calls: dict[int, Call] = {}
        self._depth = 0
        for method, value in settings.items():
            self._add(_word(method), (value,), {})

    def __repr__(self) -> str:
        return f"<Drawing '{self.name}': {len(self._lines)} lines>"

    def _repr_html_(self) -> str:
        """The text, for a notebook, or what is wrong with it; `dqpaint.preview` has the picture."""
        try:
            return f"<pre>{escape(self.source())}</pre>"
        except DrawingError as problem:
            return f"<pre>{escape(str(problem))}</pre>"

    if not TYPE_CHECKING:  # the stub has the methods: editors report unknown words

        def __getattr__(self, method: str) -> Callable[..., Any]:
            if method not in _CALLS:
                raise AttributeError(self._no_method(method))
            word = _CALLS[method]

            def statement(*values: Any, **parts: Any) -> AbstractContextManager[None] | None:
                self._add(word, values, parts)
                return self._block() if STATEMENTS[word].block else None

            statement.__name__ = method
            meaning = STATEMENTS[word].meaning
            statement.__doc__ = f"{meaning[0].upper()}{meaning[1:]}: `{example_call(word)}`."
            return statement

    def _no_method(self, method: str) -> str:
        if f"def {method}(" in "\n".join(self._lines):
            return f"'{method}' is drawn by a line of the language: d.write(\"{method}(...)\")"
        return f"a drawing has no '{method}'; it has: {', '.join(METHODS)}"

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *METHODS})

    def write(self, line: str) -> None:
        """Adds a line of the language, such as the call of a `def`."""
        if len(line.splitlines()) > 1:
            raise UsageError(f"{_caller()}: one line at a time")
        self._line(line)

    def comment(self, text: str) -> None:
        """Adds a comment on lines of its own."""
        for line in text.splitlines():
            self._lines.append(f"{STEP * self._depth}# {line}".rstrip())

    def source(self) -> str:
        """The drawing as a .traj file, in the layout of `dqpaint fmt`; open blocks are closed.

        Raises:
            DrawingError: a string of a call is no text of the language.
        """
        text = "\n".join([*self._lines, *["end"] * self._depth, ""])
        with self.places():
            return formatted(text, self.name)

    def __str__(self) -> str:
        return self.source()

    def program(self) -> Program:
        """The drawing, parsed and checked as if read from a file.

        Raises:
            DrawingError: with every mistake, and the call that made it.
        """
        with self.places():
            return parse(self.source(), self.name, self.folder / "drawing.traj")

    @contextmanager
    def places(self) -> Iterator[None]:
        """Errors about this drawing raised inside this context name their calls."""
        try:
            yield
        except DrawingError:
            raise
        except ScriptError as problem:
            raise DrawingError(problem, self._calls) from None

    def _add(self, word: str, values: tuple[Any, ...], parts: dict[str, Any]) -> None:
        try:
            line = " ".join([word, *written_head(word, values), *_parts(word, parts)])
        except Unwritable as problem:
            example = (
                "" if "for example" in str(problem) else f"; for example: {example_call(word)}"
            )
            raise UsageError(f"{_caller()}: {word}: {problem}{example}") from None
        self._line(line)

    def _line(self, line: str) -> None:
        self._lines.append(STEP * self._depth + line)
        self._calls[len(self._lines)] = _caller()

    @contextmanager
    def _block(self) -> Iterator[None]:
        self._depth += 1
        try:
            yield
        finally:
            self._depth -= 1
            self._lines.append(f"{STEP * self._depth}end")


def _word(method: str) -> str:
    if method not in _CALLS:
        raise UsageError(f"no statement named '{method}'; known: {', '.join(METHODS)}")
    return _CALLS[method]


def _parts(word: str, parts: dict[str, Any]) -> Iterator[str]:
    for name, value in parts.items():
        part = name.removesuffix("_")
        yield from written_part(word, RENAMED.get(part, part), value)


def _caller() -> Call:
    """The nearest stack frame outside this file."""
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename == __file__:
        frame = frame.f_back
    return Call(frame.f_code.co_filename, frame.f_lineno, frame.f_code.co_name)


__all__ = ["Call", "Drawing", "DrawingError", "quoted"]
