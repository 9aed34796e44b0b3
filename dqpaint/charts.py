"""Numbers -> charts: the only door to matplotlib."""

import io
from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.figure import Figure

from dqpaint.dq import Floats

INK, FAINT = "#222222", "#999999"
COLOURS = ("#0b6fa4", "#2a9d5c", "#d1495b", "#8d5a97", "#c98a1b", "#555555")


@dataclass(frozen=True)
class Line:
    """One line of a chart: points (N,) and what is written at it."""

    x: Floats
    y: Floats
    label: str


@dataclass(frozen=True)
class Panel:
    """One chart: lines, a bound that is drawn dashed, and what the axes say."""

    title: str
    x_label: str
    y_label: str
    lines: Sequence[Line]
    bound: float | None = None
    log_x: bool = False
    log_y: bool = False


def chart(panels: Sequence[Panel], width: float = 10.0, height: float = 4.0) -> bytes:
    """Panels side by side as a PNG file; width and height in inches of 120 dots."""
    figure = Figure(figsize=(width, height), dpi=120, layout="constrained")
    for axes, panel in zip(figure.subplots(1, len(panels), squeeze=False)[0], panels, strict=True):
        axes.set_title(panel.title, loc="left", fontsize=11, color=INK)
        for line, colour in zip(panel.lines, COLOURS, strict=False):
            axes.plot(line.x, line.y, color=colour, lw=1.8, label=line.label)
        if panel.bound is not None:
            axes.axhline(panel.bound, color=INK, lw=1, ls=(0, (4, 3)))
        axes.set_xlabel(panel.x_label)
        axes.set_ylabel(panel.y_label)
        if panel.log_x:
            axes.set_xscale("log")
        if panel.log_y:
            axes.set_yscale("log")
        axes.grid(which="major", color="#e6e6e6", lw=0.6)
        axes.set_axisbelow(True)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
        axes.legend(frameon=False, fontsize=9, labelcolor="linecolor")
    file = io.BytesIO()
    figure.savefig(file, format="png", metadata={"Software": None})
    return file.getvalue()
