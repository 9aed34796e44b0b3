"""A metric -> whether it measures what its registration says, on runs that are real."""

import math
import re
from collections.abc import Callable
from functools import cache, partial

import numpy as np

from dqpaint.errors import DqpaintError
from dqpaint.metrics import METRICS, Column, Figure, Values, measure, unit_suffix
from dqpaint.plants import PLANTS
from dqpaint.simulation import Track
from dqpaint.testing.runs import require, run

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
UNITS = ("m", "mm", "rad", "deg", "s", "ms", "N", "Nm", "J", "W", "kg", "Hz")


def check_metric(metric: str | Column | Figure, track: Track | None = None) -> None:
    """Check what every column and every figure promises.

    It has a title and a meaning, its names end with its unit (of an integral it may be left out),
    it has finite values, one a row of a run or one in all, and they repeat bit for bit.

    Args:
        metric: its name, or itself.
        track: a run of which it has values; None are two short ones, led by rates and by torques.

    Raises:
        AssertionError: a promise that is not kept.
    """
    one = METRICS[metric] if isinstance(metric, str) else metric
    require(bool(one.title and one.meaning), f"'{one.name}' has a title and a meaning")
    for name in one.names if isinstance(one, Column) else (one.name,):
        _check_name(name.format(joint=1), one.unit)
    tracks = two_runs() if track is None else (track,)
    found = [_has_values(one, each) for each in tracks]
    require(any(found), f"'{one.name}' has values in some run")


@cache
def two_runs() -> tuple[Track, Track]:
    """A run whose law commands rates, and one whose law commands torques."""
    return run(PLANTS["ideal"]), run(PLANTS["torque"])


def _check_name(name: str, unit: str) -> None:
    require(bool(NAME.fullmatch(name)), f"'{name}' is made of letters, digits and _")
    if unit:
        said = name.endswith((unit_suffix(unit), "_integral"))
        require(said, f"'{name}' ends with its unit: {unit_suffix(unit)}")
    else:
        bare = not name.endswith(tuple(map(unit_suffix, UNITS)))
        require(bare, f"'{name}' does not end with a unit, as it has none")


def _has_values(one: Column | Figure, track: Track) -> bool:
    """Whether there are values in a run; they are checked."""
    if isinstance(one, Figure):
        return _check_figure(one, track)
    rows = len(track.motion.t)
    _check_column(one, rows, partial(one.of_motion, track.motion))
    return _check_column(one, rows, partial(one.of_run, track))


def _check_figure(one: Figure, track: Track) -> bool:
    table = measure(track).table
    value = one.measure(track, table)
    if value is None:
        return False
    require(math.isfinite(value), f"'{one.name}' is a finite number")
    require(one.measure(track, table) == value, f"'{one.name}' repeats itself bit for bit")
    return True


def _check_column(one: Column, rows: int, measured: Callable[[], Values | None]) -> bool:
    values = measured()
    if values is None:
        return False
    try:
        table = one.by_header(values, rows)
    except DqpaintError as problem:
        raise AssertionError(str(problem)) from None
    finite = all(np.isfinite(column).all() for column in table.values())
    require(finite, f"'{one.headers}' has finite values in every row")
    again = measured()
    same = again is not None and np.array_equal(values, again)
    require(same, f"'{one.headers}' repeats itself bit for bit")
    return True
