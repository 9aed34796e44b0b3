"""Rows, a picture, the share done -> text for a terminal: a table, half blocks, a bar."""

import os
import sys
import time
from collections.abc import Sequence
from typing import Self, TextIO

import numpy as np
from numpy.typing import NDArray

from dqpaint.clean_stream import printable, send_raw
from dqpaint.cli.front.colours import takes_colour
from dqpaint.cli.front.streams import is_quiet, is_talkative
from dqpaint.core import tables

BAR = 30  # characters of the progress bar
WIDEST = 72  # columns of a picture
TALLEST = 40  # and its rows
SHORTEST_WORTH_A_BAR = 0.5  # [s]


def table(rows: Sequence[tuple[str, str]]) -> str:
    """Names and values in two aligned columns."""
    return "\n".join(f"  {line}".rstrip() for line in tables.align(rows))


def shows_pictures(stream: TextIO) -> bool:
    """Whether a stream is a terminal that says it has full colour."""
    return takes_colour(stream) and os.environ.get("COLORTERM", "") in ("truecolor", "24bit")


def blocks(image: NDArray[np.uint8], columns: int) -> str:
    """A picture (H, W, 3) as lines of half blocks, two pixels a character.

    A cell shows the fourth-power mean of what it covers: by the plain mean a thin line on black
    would fade away, by the brightest pixel its white core would hide its colour.
    """
    height, width = image.shape[:2]
    columns = max(1, min(columns, WIDEST, width, round(2 * TALLEST * width / height)))
    rows = 2 * max(1, min(round(columns * height / width / 2), height // 2))
    y = np.linspace(0, height, rows + 1).astype(int)
    x = np.linspace(0, width, columns + 1).astype(int)
    fourth = np.square(np.square(image / 255.0))
    sums = np.add.reduceat(np.add.reduceat(fourth, y[:-1], axis=0), x[:-1], axis=1)
    mean = sums / (np.diff(y)[:, None, None] * np.diff(x)[None, :, None])
    small = np.rint(255 * (mean / max(mean.max(), 1e-12)) ** 0.25).astype(int)
    lines = []
    for upper, lower in zip(small[::2].tolist(), small[1::2].tolist(), strict=True):
        cells = (
            f"\x1b[38;2;{a[0]};{a[1]};{a[2]}m\x1b[48;2;{b[0]};{b[1]};{b[2]}m▀"
            for a, b in zip(upper, lower, strict=True)
        )
        lines.append("".join(cells) + "\x1b[0m")
    return "\n".join(lines)


class Progress:
    """A bar on standard error with the time left; silent where that is no terminal."""

    def __init__(self, what: str) -> None:
        self._what = printable(what)
        self._shown = sys.stderr.isatty() and not (is_quiet() or is_talkative())
        self._begin = time.monotonic()
        self._drawn = False

    def __call__(self, done: float) -> None:
        """Show the share `done`, 0 to 1."""
        passed = time.monotonic() - self._begin
        if not self._shown or passed < SHORTEST_WORTH_A_BAR or done <= 0:
            return
        left = passed / done * (1 - done)
        filled = "█" * round(BAR * done)
        send_raw(f"\r{self._what} {filled:<{BAR}} {done:4.0%}  {left:.0f} s left ", sys.stderr)
        self._drawn = True

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        """Remove the bar."""
        if self._drawn:
            send_raw("\r\x1b[K", sys.stderr)
