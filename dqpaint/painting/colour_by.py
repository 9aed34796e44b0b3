"""A column of a run -> colours of its light with a legend; poses with magnified errors.

In such a picture every millimetre is equally bright: only the colour shows the value.
"""

import math

import numpy as np

from dqpaint import dq
from dqpaint.diagnostics import SourceLine, text_of_line
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UnknownNameError, UsageError
from dqpaint.light.images import Legend, categorical_colours, sequential_colours, sequential_map
from dqpaint.metrics import Column, Table, all_columns
from dqpaint.motion import Motion

SCALE_PERCENTILE = 98.0
"""Percentile of the lit values that has the last colour, so that a peak does not hide the rest."""
LEAST_SCALE_END, LARGEST_SCALE_END = 1e-6, 1e6
"""Ends that a scale can be given."""
ROUND_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)


def colour_columns() -> dict[str, Column]:
    """The columns that a light can be coloured by, by the names they have there."""
    return {one.colour_by: one for one in all_columns() if one.colour_by is not None}


def read_colour_by(text: str) -> tuple[str, float | None]:
    """A column's name, and the end of its scale in the unit that is shown, of `position-error:20`.

    Raises:
        UsageError: an unknown column, or an end that is not a number in range.
    """
    name, colon, end = text.partition(":")
    known = colour_columns()
    if name not in known:
        raise UnknownNameError("colour-by", name, list(known))
    if not colon:
        return name, None
    unit, scaled = _unit(known[name]), [name for name, one in known.items() if one.from_zero]
    try:
        high = float(end)
    except ValueError:
        high = math.nan
    if name not in scaled or not LEAST_SCALE_END <= high <= LARGEST_SCALE_END:
        raise UsageError(
            f"colour by '{text[:40]}': what follows the colon is the end of its scale"
            f"{f' in {unit}' if unit else ''}, for {', '.join(scaled)}, as in position-error:20"
        )
    return name, high


def colours_by_column(motion: Motion, table: Table, by: str) -> tuple[Floats, Legend]:
    """The colour (N, 3) of each row by a column of the run, dark where it is dark, and the legend.

    Raises:
        UsageError: an unknown column, or one that this run lacks.
    """
    by, end = read_colour_by(by)
    column = colour_columns()[by]
    if column.name not in table:
        known = ", ".join(name for name, one in colour_columns().items() if one.name in table)
        raise UsageError(f"colour by {by} needs an arm: use draw; without one: {known}")
    lit = motion.lit
    if by == "line":
        shown, legend = _by_line(motion, column.title)
    else:
        values = table[column.name] * column.scale
        low, high = scale_limits(values[lit], column.from_zero) if end is None else (0.0, end)
        shown = sequential_colours((values - low) / (high - low))
        title = column.title + (f" [{_unit(column)}]" if column.display_unit else "")
        more = "≥ " if values[lit].max() > high * (1.0 + 1e-9) else ""
        labels = (f"{low:g}", f"{more}{high:g}")
        legend = Legend(title, labels, _tuples(sequential_map()), amounts=True)
    return np.where(lit[:, None], shown, 0.0), legend


def _by_line(motion: Motion, title: str) -> tuple[Floats, Legend]:
    """A colour (N, 3) for each line of the drawing that shines."""
    lines = motion.source[motion.lit].present
    colours = categorical_colours(len(lines))
    place = {line: i for i, line in enumerate(lines)}
    kinds = np.array([place.get(line, 0) for line in motion.source.lines])  # others are dark
    labels = tuple(_labelled(motion, line) for line in lines)
    return colours[kinds[motion.source.index]], Legend(
        title, labels, _tuples(colours), amounts=False
    )


def _unit(column: Column) -> str:
    return column.display_unit.replace("deg", "°")


def _labelled(motion: Motion, line: SourceLine) -> str:
    program = motion.program
    text = " ".join(text_of_line(program.text, line).split("#")[0].split())
    return f"{program.line_name(line)}  {text if len(text) <= 28 else text[:27] + '…'}"


def _tuples(colours: Floats) -> tuple[tuple[float, float, float], ...]:
    return tuple((float(r), float(g), float(b)) for r, g, b in colours)


def scale_limits(values: Floats, from_zero: bool) -> tuple[float, float]:
    """Round ends of a scale for values (N,)."""
    high = float(np.percentile(values, SCALE_PERCENTILE))
    low = 0.0 if from_zero else float(values.min())
    span = max(high - low, 1e-12, 1e-6 * abs(high))
    decade = 10.0 ** math.floor(math.log10(span))
    step = next(n * decade for n in ROUND_STEPS if n * decade >= span * (1.0 - 1e-9))
    if from_zero:
        return 0.0, step
    unit = step / 10.0
    return math.floor(low / unit) * unit, math.ceil(high / unit + 1e-9) * unit


LONGEST_DELAY = 0.5  # [s] that is taken out
MOST_DELAY_ROWS = 500  # and so many rows


def magnified_poses(motion: Motion, pose: Floats, times: float) -> Floats:
    """Poses (N, 8) with their deviation from the reference multiplied.

    One delay, the same all along, is taken out before: a light that only comes late draws the right
    path, and magnified it does, too.

    Raises:
        DqpaintError: The poses are not finite.
    """
    rows = common_delay(motion, dq.translation(pose))
    at = np.maximum(np.arange(len(pose)) - rows, 0.0)
    before = np.minimum(at.astype(np.int64), max(len(pose) - 2, 0))
    after = np.minimum(before + 1, len(pose) - 1)
    asked = dq.sclerp(motion.pose[before], motion.pose[after], at - before)
    moved = dq.translation(asked) + times * (dq.translation(pose) - dq.translation(asked))
    turn = dq.log(dq.mul(dq.conj(asked), pose))
    turn[:, 3:] = 0.0
    rotation = dq.quaternion_mul(dq.rotation(asked), dq.rotation(dq.exp(times * turn)))
    if not np.isfinite(moved).all():
        raise DqpaintError(f"deviations magnified {times:g} times are not finite")
    return dq.continuous(dq.pose_from(moved, rotation))


def common_delay(motion: Motion, points: Floats) -> float:
    """The delay in rows of positions (N, 3) behind the reference, from the lit rows.

    The least mean square over whole rows, then the vertex of the parabola through its neighbours.
    """
    asked, lit = motion.points, np.flatnonzero(motion.lit)
    most = int(min(MOST_DELAY_ROWS, LONGEST_DELAY / motion.period, len(points) - 1))
    cost = [
        float(((points[lit] - asked[np.maximum(lit - rows, 0)]) ** 2).sum(axis=1).mean())
        for rows in range(most + 1)
    ]
    best = int(np.argmin(cost))
    if not 0 < best < most:
        return float(best)
    left, least, right = cost[best - 1 : best + 2]
    bend = left - 2.0 * least + right
    return best + (0.5 * (left - right) / bend if bend > 0.0 else 0.0)
