"""Tables of points -> arrays: CSV with two or three columns, or one file for each axis.

Columns are parted by commas, semicolons, tabs or blanks, as the first row of numbers shows; with
semicolons or tabs a comma may be the decimal sign. A first line that holds no numbers is a
heading; empty lines and what follows a # are passed over.
"""

import io
from collections.abc import Iterator
from functools import lru_cache

import numpy as np

from dqpaint.diagnostics import Problem, Span, problem
from dqpaint.language.imports.file_access import contents, too_large
from dqpaint.language.pen.pen import Pen
from dqpaint.language.syntax.tree import Quoted
from dqpaint.program import Floats

MOST_ROWS = 500_000
MOST_BYTES = 100_000_000
FARTHEST = 1e12  # in the file's unit


def read(nodes: list[Quoted], pen: Pen) -> Floats:
    """The points (N, 3) of one file, or of a file for each axis, in the file's unit."""
    if len(nodes) == 1:
        points = _table(nodes[0], pen)
        count = points.shape[1]
        if count not in (2, 3):
            columns = f"{count} column{'s' if count > 1 else ''}"
            help = 'a point has 2 or 3; an axis to a file is written: path "x.txt" "y.txt"'
            message = f"{nodes[0].text} has {columns}"
            raise problem("E296", message, nodes[0].span, "", help)
        return _with_z(points)
    axes = [_table(node, pen) for node in nodes]
    for node, axis in zip(nodes, axes, strict=True):
        if axis.shape[1] != 1:
            message = f"{node.text} has {axis.shape[1]} columns"
            help = "of several files each is one axis: one value a line"
            raise problem("E296", message, node.span, "", help)
        if len(axis) != len(axes[0]):
            message = f"{node.text} has {len(axis):,} values, {nodes[0].text} has {len(axes[0]):,}"
            raise problem("E296", message, node.span, "", "each file needs a value for each point")
    return _with_z(np.concatenate(axes, axis=1))


def _with_z(points: Floats) -> Floats:
    return np.concatenate([points, np.zeros((len(points), 3 - points.shape[1]))], axis=1)


def _table(node: Quoted, pen: Pen) -> Floats:
    """The numbers (N, columns) of one file."""
    return _numbers_in(node.text, contents(node, pen, MOST_BYTES), node.span)


@lru_cache(maxsize=4)  # as in a `repeat`
def _numbers_in(name: str, data: bytes, span: Span) -> Floats:
    node = Quoted(name, span)  # where messages about it point
    if data.count(b"\n") > MOST_ROWS + 10_000:
        raise _too_many(node)
    if data.startswith((b"\xff\xfe", b"\xfe\xff")) or b"\0" in data:
        help = "save it as plain text in UTF-8"
        raise problem("E295", f"{node.text} is not a plain text", node.span, "", help)
    text = data.decode("utf-8-sig", errors="replace").replace("\r\n", "\n").replace("\r", "\n")
    heading, first = _first(text)
    if not first:
        raise problem("E295", f"there are no numbers in {node.text}", node.span)
    parted, comma = _style(first)
    text = text.replace(",", ".") if comma else text
    try:
        points = np.loadtxt(io.StringIO(text), delimiter=parted, ndmin=2, skiprows=heading)
    except ValueError:  # perhaps a line of blanks alone
        lines = list(_lines(text))[heading > 0 :]
        try:
            points = np.loadtxt((row for _, row in lines), delimiter=parted, ndmin=2)
        except ValueError:
            raise _fault(node, lines, parted) from None
    if len(points) > MOST_ROWS:
        raise _too_many(node)
    if max(points.max(), -points.min()) < FARTHEST:
        return points
    raise _fault(node, list(_lines(text))[heading > 0 :], parted)


def _first(text: str) -> tuple[int, str]:
    """The number of lines up to the heading, if there is one, and the first row after it."""
    lines = _lines(text)
    number, line = next(lines, (0, ""))
    if not line or any(map(_is_number, _numbers(line, *_style(line)))):
        return 0, line
    return number, next(lines, (0, ""))[1]


def _lines(text: str) -> Iterator[tuple[int, str]]:
    """The lines that are not blank, with their numbers."""
    for number, line in enumerate(text.split("\n"), 1):
        line = line.partition("#")[0].strip() if "#" in line else line.strip()
        if line:
            yield number, line


def _style(line: str) -> tuple[str | None, bool]:
    """The column separator (None: blanks), and whether the comma is the decimal sign."""
    for sign in ";\t":
        if sign in line:
            return sign, "," in line
    return ("," if "," in line else None), False


def _numbers(line: str, parted: str | None, comma: bool) -> list[str]:
    return (line.replace(",", ".") if comma else line).split(parted)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return "_" not in text


def _fault(node: Quoted, lines: list[tuple[int, str]], parted: str | None) -> Problem:
    """E295: the first invalid line."""
    rows = [(number, line.split(parted)) for number, line in lines]
    wanted = len(rows[0][1])
    faults = ((number, _wrong(fields, wanted)) for number, fields in rows)
    line, what = next((f for f in faults if f[1]), (rows[0][0], "can't be read"))
    message = f"{node.text}, line {line}: this row {what}"
    help = "a row is 2 or 3 numbers; a comma as decimal sign needs semicolons between the columns"
    return problem("E295", message, node.span, "", help)


def _wrong(fields: list[str], wanted: int) -> str:
    """The error in a row; empty if there is none."""
    bad = [field.strip() for field in fields if not _is_number(field)]
    if bad:
        return f"has '{bad[0][:40]}' where a number should be" if bad[0] else "lacks a number"
    if len(fields) != wanted:
        return f"has {len(fields)} numbers, the first has {wanted}"
    if not all(abs(float(field)) < FARTHEST for field in fields):
        return "has a number that is not finite, or far too large"
    return ""


def _too_many(node: Quoted) -> Problem:
    help = f"at most {MOST_ROWS:,} points are drawn; leave out some"
    return too_large(node, f"too long: more than {MOST_ROWS:,} rows", help)
