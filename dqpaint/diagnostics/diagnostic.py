"""A message about a drawing and its span -> text with the line, the rule and a fix."""

from bisect import bisect_right
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import NamedTuple

from dqpaint.core import record
from dqpaint.errors import DqpaintError


@record
class Span:
    """A stretch of the text in code points, from 0, without the end."""

    start: int
    end: int

    def text_in(self, text: str) -> str:
        """The text of the span."""
        return text[self.start : self.end]


class Source(str):
    """The text of a drawing, followed by the texts of the files that it includes.

    So an offset alone identifies its file.

    Attributes:
        included: where each further file begins, and its name; in order.
    """

    __slots__ = ("included",)
    included: tuple[tuple[int, str], ...]

    def __new__(cls, text: str, included: tuple[tuple[int, str], ...] = ()) -> "Source":
        """The whole text: one file after the other, each on its own lines."""
        source = super().__new__(cls, text)
        source.included = included
        return source

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return Source, (str(self), self.included)


class Severity(StrEnum):
    """An error prevents the drawing; a warning reports an assumption."""

    ERROR = "error"
    WARNING = "warning"


@record
class Fix:
    """An edit that corrects the text: replace `span` by `text`."""

    title: str
    span: Span
    text: str


@record
class Diagnostic:
    """One message.

    Attributes:
        code: its name in the catalogue, such as `E218`; `W…` for warnings.
        message: the error, lower case, no full stop.
        span: where; None for the file as a whole.
        label: a few words at the caret, or nothing.
        help: what would mend it, if possible text that can be pasted.
        related: other places that matter, each with its own label.
        fix: the same as `help`, for a program.
    """

    code: str
    message: str
    span: Span | None
    label: str = ""
    help: str = ""
    related: tuple[tuple[Span, str], ...] = ()
    fix: Fix | None = None

    @property
    def severity(self) -> Severity:
        """A warning if the code begins with W, otherwise an error."""
        return Severity.WARNING if self.code.startswith("W") else Severity.ERROR


class Place(NamedTuple):
    """A line and a column, counted from 1."""

    line: int
    column: int


def locate(text: str, offset: int) -> Place:
    """The line and column of an offset, in its own file."""
    line_start = text.rfind("\n", 0, offset) + 1
    first = file_at(text, offset, "")[0]
    return Place(text.count("\n", first, offset) + 1, offset - line_start + 1)


def file_at(text: str, offset: int, name: str) -> tuple[int, str]:
    """The start offset and the name of the file at an offset; `name` is that of the first file."""
    included = text.included if isinstance(text, Source) else ()
    if not included:
        return 0, name
    at = bisect_right(included, offset, key=lambda file: file[0])
    return included[at - 1] if at else (0, name)


class SourceLine(NamedTuple):
    """A line of a drawing; lines are ordered by their files, then by their numbers.

    Attributes:
        file: 0 for the main file, k for the k-th that is included.
        line: its number in that file, from 1; 0 where it is not known.
    """

    file: int
    line: int


def file_number(text: str, offset: int) -> int:
    """The file of an offset, as a `SourceLine` has it."""
    included = text.included if isinstance(text, Source) else ()
    return bisect_right(included, offset, key=lambda file: file[0])


def line_name(text: str, at: SourceLine) -> str:
    """The name of a line for people: `12`, or `petal.traj:3` in an included file."""
    if not at.file:
        return str(at.line)
    included = text.included if isinstance(text, Source) else ()
    known = at.file <= len(included)
    name = included[at.file - 1][1] if known else f"included file {at.file}"
    return f"{name}:{at.line}"


def text_of_line(text: str, at: SourceLine) -> str:
    """The text of a line of a drawing."""
    included = text.included if isinstance(text, Source) else ()
    begin = included[at.file - 1][0] if at.file else 0
    return text[begin:].split("\n", at.line)[at.line - 1]


def render(diagnostic: Diagnostic, name: str, text: str) -> str:
    """A diagnostic as terminal text, with the source line and a caret."""
    head = f"{diagnostic.severity}[{diagnostic.code}]: {diagnostic.message}"
    if diagnostic.span is None:
        lines = [head, f" --> {name}"]
        margin = " "
    else:
        at = locate(text, diagnostic.span.start)
        margin = " " * (len(str(at.line)) + 1)
        file = file_at(text, diagnostic.span.start, name)[1]
        lines = [head, f"{margin[:-1]}--> {file}:{at.line}:{at.column}"]
        lines += _excerpt(diagnostic, text, at, margin)
    for span, label in diagnostic.related:
        there = locate(text, span.start)
        file = file_at(text, span.start, name)[1]
        lines.append(f"{margin}= {label}: {file}:{there.line}:{there.column}")
    if diagnostic.help:
        lines.append(f"{margin}= help: {diagnostic.help}")
    return "\n".join(lines)


WIDEST_EXCERPT = 160  # of the source, as it is shown; a longer one is cut round the caret


def _excerpt(diagnostic: Diagnostic, text: str, at: Place, margin: str) -> list[str]:
    assert diagnostic.span is not None
    start = diagnostic.span.start - (at.column - 1)
    end = text.find("\n", start)
    source = text[start : end if end >= 0 else len(text)].rstrip("\r")
    width = max(1, min(diagnostic.span.end - diagnostic.span.start, len(source) - at.column + 1))
    column = at.column
    if len(source) > WIDEST_EXCERPT:
        cut = max(0, column - WIDEST_EXCERPT // 2)
        source, column = source[cut : cut + WIDEST_EXCERPT], column - cut
        width = min(width, len(source) - column + 1)
    source = "".join(c if c.isprintable() else " " for c in source)
    caret = " " * (column - 1) + "^" * max(1, width)
    label = f" {diagnostic.label}" if diagnostic.label else ""
    return [f"{margin}|", f"{at.line} | {source}", f"{margin}| {caret}{label}"]


@dataclass(eq=False)  # an exception stays hashable
class ScriptError(DqpaintError):
    """A drawing that cannot be drawn, with all errors of one pass."""

    name: str
    text: str
    diagnostics: tuple[Diagnostic, ...] = field(default_factory=tuple)

    def __str__(self) -> str:
        return "\n\n".join(render(d, self.name, self.text) for d in self.diagnostics)


class Problem(Exception):  # noqa: N818  a message on its way to the list, not an error of ours
    """A statement with an error; it carries the diagnostic."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


class UnknownPositionProblem(Problem):
    """A problem that depends on the tool's position: not reported if that is unknown."""


def at_call(mistake: Problem, span: Span) -> Problem:
    """The same problem, related to the call that caused it."""
    diagnostic = mistake.diagnostic
    if len(diagnostic.related) < MOST_CALLS_SHOWN:
        related = (*diagnostic.related, (span, "called from"))
        mistake.diagnostic = replace(diagnostic, related=related)
    return mistake


MOST_CALLS_SHOWN = 3


def problem(
    code: str,
    message: str,
    span: Span | None,
    label: str = "",
    help: str = "",
    fix: Fix | None = None,
    related: tuple[tuple[Span, str], ...] = (),
) -> Problem:
    """Make a problem, ready to be raised."""
    return Problem(Diagnostic(code, message, span, label, help, related, fix))
