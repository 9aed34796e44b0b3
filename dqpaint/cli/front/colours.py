"""Text of a command and a stream -> the text in colour where the stream is a terminal that has it.

What is printed stays plain text until here: the same words go to a file, and to a terminal with
colours around them. Texts of others are made printable before colours are added.
"""

import os
import re
import shutil
import sys
import textwrap
from collections.abc import Callable, Iterator
from typing import TextIO

from dqpaint.clean_stream import printable, send_raw

RED, GREEN, YELLOW, BLUE, CYAN = "31", "32", "33", "34", "36"
BOLD, FAINT = "1", "2"
SEVERITIES = {"error": RED, "usage": RED, "warning": YELLOW, "note": CYAN, "hint": CYAN}
HEAD = re.compile(r"(error|usage|warning|note|hint)(\[[A-Z]\d+\])?:(?= )")
MARGIN = re.compile(r" *(?:\d+ )?(?:\||-->)(?= |$)")
CARETS = re.compile(r"( +)(\^+)(.*)")
HELP = re.compile(r" +(= [^:]+:)")
LABEL = re.compile(r"  (\S+(?: \S+)*)(?=  )")


def takes_colour(stream: TextIO) -> bool:
    """Whether a stream is a terminal with colours, and nobody wished for none (NO_COLOR, TERM)."""
    if os.environ.get("NO_COLOR") or not stream.isatty():
        return False
    return os.name == "nt" or os.environ.get("TERM", "dumb") != "dumb"


def paint(text: str, *codes: str) -> str:
    """A text in a colour or a weight."""
    return f"\x1b[{';'.join(codes)}m{text}\x1b[0m" if text else text


Painter = Callable[[str], str]


def findings(text: str) -> str:
    """Errors, warnings and notes, with the severity's colour on their heads and marks."""
    return "\n".join(_finding_lines(text.split("\n")))


def _finding_lines(lines: list[str]) -> Iterator[str]:
    colour, heads = RED, False  # whether a line may go on with the sentence of a finding's head
    for line in lines:
        if head := HEAD.match(line):
            colour = SEVERITIES[head[1]]
            rest, heads = line[head.end() :], bool(head[2])
            yield paint(head[0], BOLD, colour) + (paint(rest, BOLD) if heads else rest)
        elif margin := MARGIN.match(line):
            heads = False
            rest = line[margin.end() :]
            if "-->" not in margin[0] and (marks := CARETS.fullmatch(rest)):
                rest = marks[1] + paint(marks[2] + marks[3], BOLD, colour)
            yield paint(margin[0], BLUE) + rest
        elif named := HELP.match(line):
            yield line[: named.start(1)] + paint(named[1], CYAN) + line[named.end() :]
        else:
            heads = heads and line.startswith("  ")
            yield paint(line, BOLD) if heads else line


def labels(text: str) -> str:
    """A table of names and values, the names in a colour."""
    return "\n".join(
        f"  {paint(found[1], CYAN)}{line[found.end() :]}" if (found := LABEL.match(line)) else line
        for line in text.split("\n")
    )


def headings(text: str) -> str:
    """A table below headings: its first line, and the first of each block, bold."""
    blocks = (block.split("\n") for block in text.split("\n\n"))
    return "\n\n".join("\n".join([paint(first, BOLD), *rest]) for first, *rest in blocks)


def fold(text: str, columns: int) -> str:
    """Lines that are too long, broken between words; excerpts of drawings stay as they are."""
    return "\n".join(part for line in text.split("\n") for part in _folded(line, columns))


def _folded(line: str, columns: int) -> list[str]:
    if len(line) <= columns or MARGIN.match(line):
        return [line]
    label, helps = LABEL.match(line), HELP.match(line)
    indent = len(line) - len(line.lstrip()) or 2
    if label:
        indent = len(line) - len(line[label.end() :].lstrip())
    elif helps:
        indent = helps.end() + 1
    return textwrap.wrap(
        line, columns, subsequent_indent=" " * min(indent, columns // 2), break_long_words=False,
        break_on_hyphens=False, replace_whitespace=False, expand_tabs=False,
    )  # fmt: skip


def show(text: str, stream: TextIO | None = None, painter: Painter = findings) -> None:
    """Print a text; on a terminal folded to its width, and in colour where it has that.

    Args:
        text: what is printed, a line end after it.
        stream: standard output, if nothing is said.
        painter: adds the colours.
    """
    stream = stream or sys.stdout
    if stream.isatty() and painter in (findings, labels):
        text = fold(text, shutil.get_terminal_size().columns)
    if takes_colour(stream):
        send_raw(painter(printable(text)) + "\n", stream)
    else:
        print(text, file=stream)
