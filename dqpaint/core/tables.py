"""Rows of cells -> a table as aligned text, Markdown or CSV."""

import csv
import io
import math
from collections.abc import Iterable, Sequence

Row = Sequence[str]


def align(rows: Sequence[Row]) -> list[str]:
    """Lines of text in which columns stand below each other; the first row may be headings."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]


def fit(rows: Sequence[Row], width: int) -> list[str]:
    """The same, turned round where it would be wider: one line a column."""
    lines = align(rows)
    return lines if max(map(len, lines)) <= width else align(list(zip(*rows, strict=True)))


def markdown(rows: Sequence[Row]) -> str:
    """A table in Markdown; the first row has the headings."""
    lines = ["| " + " | ".join(word.replace("|", "\\|") for word in row) + " |" for row in rows]
    return "\n".join([lines[0], "|" + "---|" * len(rows[0]), *lines[1:]])


def page(title: str, *parts: str) -> bytes:
    """A page in Markdown: a heading, and parts below each other."""
    return ("\n\n".join([f"# {title}", *parts]) + "\n").encode()


def encode_csv(rows: Iterable[Iterable[object]]) -> bytes:
    """A CSV file with all digits of each number; nan is an empty cell."""
    file = io.StringIO()
    csv.writer(file, lineterminator="\n").writerows(
        ["" if isinstance(cell, float) and math.isnan(cell) else cell for cell in row]
        for row in rows
    )
    return file.getvalue().encode()
