"""Charts and heat maps -> the data that a page's scripts draw, thinned to what can be seen."""

from itertools import cycle
from typing import Any

import numpy as np

from dqpaint.dq import Floats
from dqpaint.studies.report.charts import COLOURS, HeatMap, Line, Panel

MOST_POINTS = 1500  # of a line: two a pixel, the least and the largest of a stretch
DIGITS = 6


def of_panel(panel: Panel, most: int = MOST_POINTS) -> dict[str, Any]:
    """A chart of lines of at most about so many points."""
    colours = cycle(COLOURS)
    lines = [_of_line(thinned(line, most), next(colours)) for line in panel.lines]
    names = (
        "title", "x_label", "y_label", "log_x", "log_y", "decades", "bound", "wall", "limit",
        "span", "x_span", "ticks",
    )  # fmt: skip
    return {"kind": "curves", **{name: getattr(panel, name) for name in names}, "lines": lines}


def of_map(given: HeatMap) -> dict[str, Any]:
    """A heat map."""
    return {
        "kind": "heat", "title": given.title, "x_label": given.x_label, "y_label": given.y_label,
        "x": list(given.x), "y": list(given.y), "log": given.log,
        "values": [_numbers(row) for row in given.values], "marked": given.marked.tolist(),
    }  # fmt: skip


def _of_line(line: Line, following: str) -> dict[str, Any]:
    return {
        "label": line.label, "colour": line.colour or following, "width": line.width,
        "x": _numbers(line.x), "y": _numbers(line.y),
        "marks": None if line.marks is None else line.marks.tolist(),
        "bars": None if line.bars is None else _numbers(line.bars),
        "band": None if line.band is None else list(map(_numbers, line.band)),
    }  # fmt: skip


def thinned(line: Line, most: int = MOST_POINTS) -> Line:
    """A line of few enough points; no peak is lost."""
    count = len(line.x)
    if count <= most or line.marks is not None:
        return line
    edges = np.linspace(0, count, most // 2 + 1).astype(int)
    kept = {0, count - 1}
    for low, high in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        stretch = line.y[low:high]
        kept |= {low + int(np.argmin(stretch)), low + int(np.argmax(stretch))}
    at = np.array(sorted(kept))
    band = None if line.band is None else (line.band[0][at], line.band[1][at])
    return Line(line.x[at], line.y[at], line.label, line.colour, band=band, width=line.width)


def _numbers(values: Floats) -> list[float | None]:
    return [float(f"{v:.{DIGITS}g}") if np.isfinite(v) else None for v in values.tolist()]
