"""Lines and values -> charts and heat maps as PNG, PDF, SVG; here alone is matplotlib imported.

It is imported when a chart is drawn: help and lists of studies take a third of a second less.
"""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

INK, FAINT = "#222222", "#999999"
COLOURS = ("#006aa8", "#d77e00", "#00a880", "#8328dc", "#8f5d2a", "#4b5563")
"""Told apart by those who see no red, no green or no blue, too, and dark enough for white paper."""
ALARM = "#c1121f"
MARKED = "no result"  # at marked points and cells
LONGEST, LONGEST_NOTE = 60, 160  # letters of a label
MOST_INSIDE = 6  # lines whose names find room beside them
MOST_NUMBERS = 400  # cells of a heat map that are written in
MOST_BESIDE = 3  # panels
MOST_TICKS = 6
ROOM = 0.1  # about each of several panels [inches]
ROUND = [1, 2, 2.5, 5, 10]
NEAR_LIMIT = 0.25  # of an axis: a limit that is farther off is not shown
FAR = 1e9  # beyond any axis
Form = Literal["png", "pdf", "svg"]
HEIGHT = 4.2  # of a row of panels [inches]


@dataclass(frozen=True)
class Line:
    """One line of a chart: points (N,) and what is written at it.

    `colour` is the next of the chart's own if not said; `marks` says where (N,) a point is
    no result, and has all points shown: the line leaves those out. `bars` are lengths (N,) up and
    down, `band` the lower and upper edge (N,) of an area about the line. A width of 0 leaves the
    points alone.
    """

    x: Floats
    y: Floats
    label: str
    colour: str | None = None
    marks: NDArray[np.bool_] | None = None
    bars: Floats | None = None
    band: tuple[Floats, Floats] | None = None
    width: float = 1.8


@dataclass(frozen=True)
class Panel:
    """One chart: lines, bounds that are drawn dashed, and what the axes say.

    `span` are the ends of the y axis, so that charts beside each other have the same, `x_span`
    those of x. `allowed` are the least and the largest y that are allowed: what is beyond is
    shaded. `held` are stretches of x, shaded too, in which a limit held something.
    """

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
    limit: str = ""  # what a bound is
    span: tuple[float, float] | None = None
    x_span: tuple[float, float] | None = None
    allowed: tuple[float, float] | None = None
    held: Sequence[tuple[float, float]] = ()

    @property
    def needs_legend(self) -> bool:
        """Whether it has several lines, or marked points."""
        return len(self.lines) > 1 or any(x.marks is not None and x.marks.any() for x in self.lines)


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


def wide(values: Floats, ratio: float = 20.0) -> bool:
    """Whether values are all positive and so far apart that a logarithmic axis shows them."""
    return bool(values.size and values.min() > 0 and values.max() >= ratio * values.min())


def beside(count: int) -> int:
    """How many of some panels stand beside each other."""
    return count if count <= MOST_BESIDE else 2 if count == 4 else MOST_BESIDE


def chart(
    panels: Sequence[Panel],
    width: float = 10.0,
    height: float = HEIGHT,
    shared: bool = False,
    form: Form = "png",
    columns: int | None = None,
    note: str = "",
) -> bytes:
    """Panels as a file, a few beside each other.

    Args:
        panels: from the left, row by row.
        width: of the whole [inches of 120 dots].
        height: of a row [inches].
        shared: whether their lines have the same names and colours, so that one legend does.
        form: of the file.
        columns: panels beside each other; None is what `beside` says.
        note: a line below all.
    """
    columns = columns or beside(len(panels))
    rows = -(-len(panels) // columns)
    figure = _figure(width, rows * height)
    if rows > 1:
        figure.set_layout_engine("constrained", h_pad=ROOM, w_pad=ROOM)
    places = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, panel in zip(places, panels, strict=False):
        _draw_panel(axes, panel)
        if panel.needs_legend and not shared:
            aside = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)}
            many = len(panel.lines) > MOST_INSIDE
            axes.legend(frameon=False, fontsize=9, labelcolor=INK, **(aside if many else {}))
    for axes in places[len(panels) :]:
        axes.set_axis_off()
    if shared and panels[0].needs_legend:
        handles, names = places[0].get_legend_handles_labels()
        figure.legend(
            handles, names, loc="outside upper left", ncols=min(len(names), MOST_INSIDE),
            frameon=False, fontsize=10,
        )  # fmt: skip
    if note:
        figure.supxlabel(_plain(note, LONGEST_NOTE), x=0.01, ha="left", fontsize=9, color=INK)
    return _encoded(figure, form)


def _draw_panel(axes: "Axes", panel: Panel) -> None:
    axes.set_title(_plain(panel.title), loc="left", fontsize=11, color=INK)
    for line, following in zip(panel.lines, cycle(COLOURS), strict=False):
        _draw(axes, line, line.colour or following)
    for bound, draw in ((panel.bound, axes.axhline), (panel.wall, axes.axvline)):
        if bound is not None:
            draw(bound, color=INK, lw=1, ls=(0, (4, 3)), label=_plain(panel.limit) or "_")
    _shade(axes, panel)
    axes.set_xlabel(_plain(panel.x_label))
    axes.set_ylabel(_plain(panel.y_label))
    if panel.ticks is not None:
        axes.set_xticks(range(len(panel.ticks)), list(map(_plain, panel.ticks)))
    if panel.log_x:
        axes.set_xscale("log")
    if panel.log_y:
        axes.set_yscale("log")
        top = max(float(np.nanmax(line.y, initial=0.0)) for line in panel.lines)
        axes.set_ylim(bottom=max(axes.get_ylim()[0], top * 10.0**-panel.decades))
    if panel.span is not None:
        axes.set_ylim(*panel.span)
    if panel.x_span is not None:
        axes.set_xlim(*panel.x_span)
    if panel.ticks is None:
        _number(axes.xaxis, axes.get_xlim(), panel.log_x)
    _number(axes.yaxis, axes.get_ylim(), panel.log_y)
    axes.grid(which="major", color="#e6e6e6", lw=0.6)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def _shade(axes: "Axes", panel: Panel) -> None:
    """Shade what is beyond the limits of y, where the chart comes near them, and stretches of x."""
    for begin, end in panel.held:
        axes.axvspan(begin, end, color=ALARM, alpha=0.15, lw=0)
    if panel.allowed is None:
        return
    low, high = axes.get_ylim()
    room = NEAR_LIMIT * (high - low)
    for limit, beyond in ((panel.allowed[0], -FAR), (panel.allowed[1], FAR)):
        if low - room <= limit <= high + room:
            axes.axhspan(limit, limit + beyond, color=FAINT, alpha=0.35, lw=0)
            axes.axhline(limit, color=ALARM, lw=1)
    beyond_both = min(low, panel.allowed[0] - 0.1 * room), max(high, panel.allowed[1] + 0.1 * room)
    axes.set_ylim(
        beyond_both[0] if panel.allowed[0] >= low - room else low,
        beyond_both[1] if panel.allowed[1] <= high + room else high,
    )


def _number(axis: "Axis", ends: tuple[float, float], log: bool) -> None:
    """A few round numbers at an axis; a logarithmic one of few decades has some within them."""
    from matplotlib.ticker import FuncFormatter, MaxNLocator, NullFormatter

    if not log:
        axis.set_major_locator(MaxNLocator(MOST_TICKS, steps=ROUND))
        return
    low, high = ends
    if high < 1e4 * low:
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(FuncFormatter(_two_and_five) if high < 30 * low else NullFormatter())


def _draw(axes: "Axes", line: Line, colour: str) -> None:
    dots = "o" if line.marks is not None or not line.width else ""
    kind = "-" if line.width else ""
    axes.plot(
        line.x,
        line.y if line.marks is None else np.where(line.marks, np.nan, line.y),
        kind,
        color=colour,
        lw=line.width,
        label=_plain(line.label),
        marker=dots,
        ms=4,
    )
    if line.band is not None:
        axes.fill_between(line.x, *line.band, color=colour, alpha=0.22, lw=0)
    if line.bars is not None and np.isfinite(line.bars).any():
        axes.errorbar(line.x, line.y, line.bars, fmt="none", ecolor=colour, lw=1, capsize=3)
    if line.marks is not None and line.marks.any():
        at = line.marks
        axes.plot(line.x[at], line.y[at], ls="", marker="o", ms=4, color=colour)
        axes.plot(
            line.x[at], line.y[at], ls="", marker="o", ms=9, mfc="none", mec=ALARM, mew=1.6,
            label=MARKED if MARKED not in axes.get_legend_handles_labels()[1] else None,
        )  # fmt: skip


def heat_map(given: HeatMap, width: float = 7.0, height: float = 5.0, form: Form = "png") -> bytes:
    """A table of values as colours, each with its number, as a file."""
    from matplotlib.patches import Rectangle
    from matplotlib.ticker import FuncFormatter

    figure = _figure(width, height)
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
            said = MARKED if marked else f"{value:.3g}"
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
    return _encoded(figure, form)


def _two_and_five(value: float, _: float = 0.0) -> str:
    """The text at a small tick of decades: nine in each would lie over one another."""
    return f"{value:g}" if f"{value:e}"[0] in "25" else ""


def _plain(text: str, longest: int = LONGEST) -> str:
    """What a user wrote: no formula, whatever it holds, one line, and not longer than a chart."""
    line = " ".join(text.split())
    short = line if len(line) <= longest else f"{line[: longest - 3]}..."
    return short.replace("$", r"\$")


def _figure(width: float, height: float) -> "Figure":
    """An empty figure [inches of 120 dots]."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), dpi=120, layout="constrained")


def _encoded(figure: "Figure", form: Form) -> bytes:
    """The figure as a file that is the same each time; letters of a PDF stay letters."""
    from matplotlib import rc_context

    unsaid = {"png": {"Software": None}, "pdf": {"CreationDate": None}, "svg": {"Date": None}}
    file = io.BytesIO()
    with rc_context({"svg.hashsalt": "dqpaint", "pdf.fonttype": 42}):
        figure.savefig(file, format=form, metadata=unsaid[form])
    return file.getvalue()
