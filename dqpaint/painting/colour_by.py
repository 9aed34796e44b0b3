"""Light that tells: the colour of the light says a figure of the run; errors are magnified.

In such a picture every millimetre is equally bright, so that nothing but the colour tells.
"""

import math
from typing import NamedTuple

import numpy as np

from dqpaint import dq
from dqpaint.core import Registry
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.light.images import Legend, amounts, colour_amounts, colour_kinds
from dqpaint.metrics import Table, asked_columns
from dqpaint.motion import Motion


class ColourBy(NamedTuple):
    """A figure that colours can show: its column, its title, from SI to what is shown."""

    column: str
    title: str
    unit: str
    scale: float
    from_zero: bool


TELLINGS: Registry[ColourBy] = Registry("colour-by")
for _name, _telling in {
    "position-error": ColourBy("position_error_m", "position error", "mm", 1e3, True),
    "orientation-error": ColourBy(
        "orientation_error_rad", "orientation error", "°", math.degrees(1.0), True
    ),
    "speed": ColourBy("speed_m_s", "speed", "mm/s", 1e3, True),
    "manipulability": ColourBy("manipulability", "manipulability", "", 1.0, False),
    "line": ColourBy("line", "line of the drawing", "", 1.0, False),
}.items():
    TELLINGS.add(_name)(_telling)

MOST = 98.0
"""Percentile of the lit values that gets the last colour: a peak does not hide the rest."""
LEAST, GREATEST = 1e-6, 1e6
"""Ends that a scale can be given."""
NICE = (1.0, 2.0, 2.5, 5.0, 10.0)


def read_telling(text: str) -> tuple[str, float | None]:
    """A figure's name, and the end of its scale in the unit that is shown, of `position-error:20`.

    Raises:
        UsageError: an unknown figure, or an end that is none.
    """
    name, colon, end = text.partition(":")
    unit = TELLINGS[name].unit
    if not colon:
        return name, None
    known = [name for name, telling in TELLINGS.items() if telling.from_zero]
    try:
        high = float(end)
    except ValueError:
        high = math.nan
    if name not in known or not LEAST <= high <= GREATEST:
        raise UsageError(
            f"colour by '{text[:40]}': what follows the colon is the end of its scale"
            f"{f' in {unit}' if unit else ''}, for {', '.join(known)}, as in position-error:20"
        )
    return name, high


def colours_of(motion: Motion, table: Table, by: str) -> tuple[Floats, Legend]:
    """The colour (N, 3) of each row by a figure of the run, dark where it is dark, and the legend.

    Raises:
        UsageError: an unknown figure, or one that only an arm has.
    """
    by, end = read_telling(by)
    telling = TELLINGS[by]
    if telling.column not in table:
        known = ", ".join(name for name, t in TELLINGS.items() if t.column in table)
        raise UsageError(f"colour by {by} needs an arm: use draw; without one: {known}")
    values = table[telling.column] * telling.scale
    lit = motion.lit
    if by == "line":
        lines = np.unique(values[lit])
        colours = colour_kinds(len(lines))
        shown = colours[np.searchsorted(lines, values).clip(0, len(lines) - 1)]
        labels = tuple(_labelled(motion, int(line)) for line in lines)
        legend = Legend(telling.title, labels, _tuples(colours), amounts=False)
    else:
        low, high = limits(values[lit], telling.from_zero) if end is None else (0.0, end)
        shown = colour_amounts((values - low) / (high - low))
        title = telling.title + (f" [{telling.unit}]" if telling.unit else "")
        more = "≥ " if values[lit].max() > high * (1.0 + 1e-9) else ""
        labels = (f"{low:g}", f"{more}{high:g}")
        legend = Legend(title, labels, _tuples(amounts()), amounts=True)
    return np.where(lit[:, None], shown, 0.0), legend


def asked_table(motion: Motion) -> Table:
    """The columns that a motion has without an arm."""
    speed = np.zeros(len(motion.t))
    speed[:-1] = np.sqrt((np.diff(motion.points, axis=0) ** 2).sum(axis=1)) / motion.period
    return {**asked_columns(motion), "speed_m_s": speed}


def _labelled(motion: Motion, line: int) -> str:
    words = motion.program.text.splitlines()[line - 1].split("#")[0].split()
    text = " ".join(words)
    return f"{line}  {text if len(text) <= 28 else text[:27] + '…'}"


def _tuples(colours: Floats) -> tuple[tuple[float, float, float], ...]:
    return tuple((float(r), float(g), float(b)) for r, g, b in colours)


def limits(values: Floats, from_zero: bool) -> tuple[float, float]:
    """Round ends of a scale for values (N,)."""
    high = float(np.percentile(values, MOST))
    low = 0.0 if from_zero else float(values.min())
    span = max(high - low, 1e-12, 1e-6 * abs(high))
    decade = 10.0 ** math.floor(math.log10(span))
    step = next(n * decade for n in NICE if n * decade >= span * (1.0 - 1e-9))
    if from_zero:
        return 0.0, step
    unit = step / 10.0
    return math.floor(low / unit) * unit, math.ceil(high / unit + 1e-9) * unit


LONGEST_DELAY = 0.5  # [s] that is taken out
MOST_ROWS = 500  # and so many rows


def magnified(motion: Motion, pose: Floats, times: float) -> Floats:
    """Poses (N, 8) whose deviation from what was asked is so many times as large.

    One delay, the same all along, is taken out before: a light that only comes late draws the right
    path, and magnified it does, too.

    Raises:
        DqpaintError: The poses leave the numbers.
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
        raise DqpaintError(f"deviations magnified {times:g} times leave the numbers")
    return dq.continuous(dq.pose_from(moved, rotation))


def common_delay(motion: Motion, points: Floats) -> float:
    """By how many rows the places (N, 3) are most nearly what was asked, while it is lit.

    The least mean square over whole rows, then the vertex of the parabola through its neighbours.
    """
    asked, lit = motion.points, np.flatnonzero(motion.lit)
    most = int(min(MOST_ROWS, LONGEST_DELAY / motion.period, len(points) - 1))
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
