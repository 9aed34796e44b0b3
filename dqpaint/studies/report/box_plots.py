"""Numbers of several groups -> box plots, as lines of a chart."""

from collections.abc import Mapping, Sequence

import numpy as np

from dqpaint.dq import Floats
from dqpaint.studies.report.charts import Line, Panel

LEAST_BOXED = 4  # numbers of a group: the quartiles of fewer say nothing
FENCE = 1.5  # times the height of a box, from it: whiskers end at the farthest number within
HALF_WIDTH = 0.3  # of a box; groups stand at 0, 1, ...
SAID = "median, quartiles, farthest within 1.5 boxes"


def box_plot(title: str, y_label: str, groups: Mapping[str, Floats | Sequence[float]]) -> Panel:
    """A box a group, and a dot for each number beyond its whiskers (Tukey 1977).

    A group of fewer than four numbers is shown by its dots alone.

    Args:
        title: of the chart.
        y_label: what the numbers are, with the unit.
        groups: numbers (N,) by the names that stand below; none is nan.
    """
    boxes: list[Floats] = []
    dots: list[tuple[float, float]] = []
    for at, values in enumerate(groups.values()):
        every = np.asarray(values, dtype=np.float64)
        beyond = every
        if len(every) >= LEAST_BOXED:
            outline, beyond = _box(at, every)
            boxes += [outline, np.full((1, 2), np.nan)]  # a gap to the next
        dots += [(float(at), value) for value in beyond.tolist()]
    lines = []
    if boxes:
        x, y = np.concatenate(boxes).T
        lines.append(Line(x, y, SAID, width=1.4))
    if dots:
        name = "runs beyond" if boxes else "runs"
        x, y = np.array(dots).T
        lines.append(Line(x, y, name, width=0.0))
    return Panel(title, "", y_label, lines, ticks=list(groups))


def _box(at: float, values: Floats) -> tuple[Floats, Floats]:
    """The outline (M, 2) of a box at an x, drawn in one go, and the values beyond its whiskers."""
    low, middle, high = np.quantile(values, (0.25, 0.5, 0.75))
    reach = FENCE * (high - low)
    within = values[(values >= low - reach) & (values <= high + reach)]
    left, right = at - HALF_WIDTH, at + HALF_WIDTH
    way = [
        (at, within.min()), (at, low), (left, low), (left, middle), (right, middle), (left, middle),
        (left, high), (at, high), (at, within.max()), (at, high), (right, high), (right, low),
        (at, low),
    ]  # fmt: skip
    return np.array(way), values[(values < low - reach) | (values > high + reach)]
