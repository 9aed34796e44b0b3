"""A track -> its table and figures: every metric of the registry."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TypeVar

from dqpaint.errors import DqpaintError
from dqpaint.metrics.registry import METRICS, Column, Table, Values, all_columns, all_figures
from dqpaint.motion import Motion
from dqpaint.simulation import Track

Value = TypeVar("Value")


@dataclass(frozen=True, repr=False)
class Metrics:
    """The metrics of a run: columns (N,) and single figures."""

    table: Table
    figures: dict[str, float]

    def __repr__(self) -> str:
        figures = ", ".join(f"{name} {value:.4g}" for name, value in self.figures.items())
        return f"<Metrics: {len(self.table)} columns; {figures}>"


def measure(track: Track) -> Metrics:
    """Columns and figures of a run.

    Raises:
        DqpaintError: a metric of another package fails.
    """
    chosen = [one for one in all_columns() if not one.motion_only]
    table = _table({one: partial(one.of_run, track) for one in chosen}, track.motion)
    found: dict[str, float] = {}
    for name, figure in all_figures().items():
        value = _guarded(name, partial(figure.measure, track, table))
        if value is None:
            continue
        if not math.isfinite(value):
            raise DqpaintError(f"metric '{name}' came out as {value}: a figure is a finite number")
        found[name] = float(value)
    return Metrics(table, found)


def reference_columns(motion: Motion) -> Table:
    """The columns that need no arm: the reference, and the speed of an ideal light."""
    return _of_motion(motion, [one for one in all_columns() if not one.motion_only])


def motion_columns(motion: Motion) -> Table:
    """The reference, with spatial twist and its derivative: the file of `--save motion`."""
    return _of_motion(motion, [one for one in all_columns() if one.measure is None])


def _of_motion(motion: Motion, chosen: list[Column]) -> Table:
    return _table({one: partial(one.of_motion, motion) for one in chosen}, motion)


def _table(measured: dict[Column, Callable[[], Values | None]], motion: Motion) -> Table:
    """Columns by their headers, of those that have values.

    Raises:
        DqpaintError: values do not fit, or two columns have the same header.
    """
    table: Table = {}
    for one, measure_it in measured.items():
        values = _guarded(one.name, measure_it)
        part = {} if values is None else one.by_header(values, len(motion.t))
        for name in part.keys() & table.keys():
            raise DqpaintError(f"two columns named '{name}', one of them with '{one.headers}'")
        table |= part
    return table


def _guarded(name: str, measured: Callable[[], Value]) -> Value:
    """A measured value; an error in another package is reported with that package's name."""
    try:
        return measured()
    except Exception as problem:
        package = METRICS.origin(name)
        if package is None:
            raise
        said = f"{type(problem).__name__}: {problem}".splitlines()[0]
        raise DqpaintError(f"metric '{name}' of {package} failed: {said}") from problem
