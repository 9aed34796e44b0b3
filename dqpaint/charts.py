"""Numbers -> charts: the only door to matplotlib."""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import cycle

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import FuncFormatter
from numpy.typing import NDArray

from dqpaint.dq import Floats

INK, FAINT = "#222222", "#999999"
COLOURS = ("#0b6fa4", "#2a9d5c", "#d1495b", "#8d5a97", "#c98a1b", "#555555")
ALARM = "#c1121f"
LONGEST = 60  # letters of a label
MOST_INSIDE = 6  # lines whose names find room beside them
MOST_NUMBERS = 400  # cells of a heat map that are written in


@dataclass(frozen=True)
class Line:
    """One line of a chart: points (N,) and what is written at it.

    `colour` is the next of the chart's own if not said; `marks` says where (N,) a point is
    unstable, and has all points shown; `bars` are lengths (N,) up and down. A width of 0 leaves
    the points alone.
    """

    x: Floats
    y: Floats
    label: str
    colour: str | None = None
    marks: NDArray[np.bool_] | None = None
    bars: Floats | None = None
    width: float = 1.8


@dataclass(frozen=True)
class Panel:
    """One chart: lines, bounds that are drawn dashed, and what the axes say."""

    title: str
    x_label: str
    y_label: str
    lines: Sequence[Line]
    bound: float | None = None
    log_x: bool = False
    log_y: bool = False
    decades: float = 300.0  # of a logarithmic y axis, from the top: the most that is shown
    ticks: Sequence[str] | None = None  # words at 0, 1, ... of an axis of choices
    wall: float | None = None  # a bound of x


@dataclass(frozen=True)
class HeatMap:
    """Values (Y, X) over two axes of choices; cells that are `marked` (Y, X) are hatched.

    A value that is nan leaves its cell empty.
    """

    title: str
    x_label: str
    y_label: str
    x: Sequence[str]
    y: Sequence[str]
    values: Floats
    marked: NDArray[np.bool_]
    log: bool = False


def chart(panels: Sequence[Panel], width: float = 10.0, height: float = 4.0) -> bytes:
    """Panels side by side as a PNG file; width and height in inches of 120 dots."""
    figure = Figure(figsize=(width, height), dpi=120, layout="constrained")
    for axes, panel in zip(figure.subplots(1, len(panels), squeeze=False)[0], panels, strict=True):
        axes.set_title(_plain(panel.title), loc="left", fontsize=11, color=INK)
        for line, following in zip(panel.lines, cycle(COLOURS), strict=False):
            _draw(axes, line, line.colour or following)
        if panel.bound is not None:
            axes.axhline(panel.bound, color=INK, lw=1, ls=(0, (4, 3)))
        if panel.wall is not None:
            axes.axvline(panel.wall, color=INK, lw=1, ls=(0, (4, 3)))
        axes.set_xlabel(_plain(panel.x_label))
        axes.set_ylabel(_plain(panel.y_label))
        if panel.log_x:
            axes.set_xscale("log")
        if panel.log_y:
            axes.set_yscale("log")
            top = max(float(line.y.max()) for line in panel.lines)
            axes.set_ylim(bottom=max(axes.get_ylim()[0], top * 10.0**-panel.decades))
        if panel.ticks is not None:
            axes.set_xticks(range(len(panel.ticks)), list(map(_plain, panel.ticks)))
        axes.grid(which="major", color="#e6e6e6", lw=0.6)
        axes.set_axisbelow(True)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
        aside = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)}
        many = len(panel.lines) > MOST_INSIDE
        axes.legend(frameon=False, fontsize=9, labelcolor="linecolor", **(aside if many else {}))
    return _png(figure)


def _draw(axes: Axes, line: Line, colour: str) -> None:
    dots = "o" if line.marks is not None else ""
    kind = "-" if line.width else ""
    axes.plot(
        line.x,
        line.y,
        kind,
        color=colour,
        lw=line.width,
        label=_plain(line.label),
        marker=dots,
        ms=4,
    )
    if line.bars is not None and np.isfinite(line.bars).any():
        axes.errorbar(line.x, line.y, line.bars, fmt="none", ecolor=colour, lw=1, capsize=3)
    if line.marks is not None and line.marks.any():
        at = line.marks
        axes.plot(
            line.x[at], line.y[at], ls="", marker="o", ms=9, mfc="none", mec=ALARM, mew=1.6,
            label="unstable" if "unstable" not in axes.get_legend_handles_labels()[1] else None,
        )  # fmt: skip


def heat_map(given: HeatMap, width: float = 7.0, height: float = 5.0) -> bytes:
    """A table of values as colours, each with its number, as a PNG file."""
    figure = Figure(figsize=(width, height), dpi=120, layout="constrained")
    axes = figure.subplots()
    good = np.ma.masked_invalid(np.where(given.marked, np.nan, given.values))
    positive = good.compressed()
    log = given.log and positive.size > 0 and positive.min() > 0
    norm = "log" if log else None
    image = axes.imshow(good, cmap="viridis_r", norm=norm, aspect="auto", origin="lower")
    if positive.size:
        bar = figure.colorbar(image, ax=axes, format="%g")
        wide = log and positive.max() > 10 * positive.min()
        bar.ax.yaxis.set_minor_formatter(FuncFormatter(_two_and_five) if wide else "{x:g}")
    for row, col in np.ndindex(given.values.shape):
        value, marked = given.values[row, col], bool(given.marked[row, col])
        if marked:
            box = Rectangle((col - 0.5, row - 0.5), 1, 1, fc="none", ec=ALARM, hatch="///", lw=0)
            axes.add_patch(box)
        if given.values.size <= MOST_NUMBERS:
            red, green, blue, _ = image.cmap(image.norm(value)) if not marked else (1, 1, 1, 1)
            dark = 0.3 * red + 0.6 * green + 0.1 * blue < 0.5
            said = "unstable" if marked else f"{value:.3g}"
            ink = ALARM if marked else "white" if dark else INK
            axes.text(
                col, row, said, ha="center", va="center", fontsize=8, color=ink,
                bbox={"fc": "white", "ec": "none", "pad": 1} if marked else None,
            )  # fmt: skip
    axes.set_title(_plain(given.title), loc="left", fontsize=11, color=INK)
    axes.set_xticks(range(len(given.x)), list(map(_plain, given.x)))
    axes.set_yticks(range(len(given.y)), list(map(_plain, given.y)))
    axes.set_xlabel(_plain(given.x_label))
    axes.set_ylabel(_plain(given.y_label))
    return _png(figure)


def _two_and_five(value: float, _: float = 0.0) -> str:
    """The text at a small tick of decades: nine in each would lie over one another."""
    return f"{value:g}" if f"{value:e}"[0] in "25" else ""


def _plain(text: str) -> str:
    """What a user wrote: no formula, whatever it holds, one line, and not longer than a chart."""
    line = " ".join(text.split())
    short = line if len(line) <= LONGEST else f"{line[: LONGEST - 3]}..."
    return short.replace("$", r"\$")


def _png(figure: Figure) -> bytes:
    file = io.BytesIO()
    figure.savefig(file, format="png", metadata={"Software": None})
    return file.getvalue()
