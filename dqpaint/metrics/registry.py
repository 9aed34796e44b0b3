"""A function of a run -> a metric by its name: a column of its table, or a figure of its summary.

A metric is described where it is registered. From here come the CSV, the JSON,
the tables and curves of studies, `--figure`, `--colour-by`, `dqpaint list` and the pages.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray
from typing_extensions import override

from dqpaint.core import Registry
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.motion import Motion
from dqpaint.simulation import Track

Table = dict[str, Floats]  # columns (N,) by their headers, unit in the name
Values = NDArray[Any]

SCALES = {("m", "mm"): 1e3, ("m/s", "mm/s"): 1e3, ("rad", "deg"): math.degrees(1.0),
          ("", "%"): 100.0}  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Metric:
    """Name, unit and meaning of a column or a figure.

    Attributes:
        unit: of the SI; nothing if there is none.
        title: its name in legends, charts and tables, without the unit.
        meaning: a short definition.
        display_unit: the unit in which people read it, if it is another one.
        equation: what it is, a line an equation, as `dqpaint.core.texts` reads it.
    """

    unit: str
    title: str
    meaning: str
    display_unit: str = ""
    equation: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "display_unit", self.display_unit or self.unit)
        if self.display_unit != self.unit and (self.unit, self.display_unit) not in SCALES:
            raise ValueError(
                f"{self.title}: [{self.unit}] cannot be shown in [{self.display_unit}]"
            )

    @property
    def example(self) -> str:
        """A command that shows it."""
        raise NotImplementedError

    @property
    def scale(self) -> float:
        """What its value is multiplied by to be shown."""
        return SCALES.get((self.unit, self.display_unit), 1.0)

    @property
    def heading(self) -> str:
        """The title with the unit that is shown."""
        return f"{self.title} [{self.display_unit}]" if self.display_unit else self.title


@dataclass(frozen=True, kw_only=True)
class Column(Metric):
    """A column of the table, or several that belong together.

    Attributes:
        names: their headers; `q{joint}_rad` stands for one of each joint.
        measure: track -> values (N,), or (N, k) for k columns; None where the run has none. A
            column of the reference motion itself has `reference` alone.
        reference: motion -> values, where they are known without an arm.
        motion_only: whether only the table of a motion has it (`--save motion`).
        from_zero: whether a scale of it begins at 0.
        coloured: whether the light can be coloured by it.
        study: what a study does with it: keep it of first runs, or draw it over time as well.
    """

    names: tuple[str, ...]
    measure: Callable[[Track], Values | None] | None = None
    reference: Callable[[Motion], Values | None] | None = None
    motion_only: bool = False
    from_zero: bool = False
    coloured: bool = True
    study: Literal["", "kept", "drawn"] = ""

    @property
    def name(self) -> str:
        """Its first header."""
        return self.names[0].format(joint=1)

    @property
    def headers(self) -> str:
        """The headers as a person reads them: `x_m, y_m, z_m`, or `q1_rad ...`."""
        return f"{self.name} ..." if self._each_joint else ", ".join(self.names)

    def headers_for(self, joints: int) -> tuple[str, ...]:
        """The headers in the table of an arm with so many joints."""
        if not self._each_joint:
            return self.names
        return tuple(self.names[0].format(joint=i + 1) for i in range(joints))

    @property
    def colour_by(self) -> str | None:
        """What `--colour-by` calls it: its name without the unit, if it has one value a row."""
        if len(self.names) > 1 or self._each_joint or self.motion_only or not self.coloured:
            return None
        return self.name.removesuffix(unit_suffix(self.unit)).replace("_", "-")

    @property
    @override
    def example(self) -> str:
        if self.colour_by:
            return f"dqpaint draw lag --controller p --colour-by {self.colour_by}"
        return f"dqpaint draw lag --controller p{' --save motion' if self.motion_only else ''}"

    @property
    def _each_joint(self) -> bool:
        return "{joint}" in self.names[0]

    def of_run(self, track: Track) -> Values | None:
        """Its values from a run."""
        return self.of_motion(track.motion) if self.measure is None else self.measure(track)

    def of_motion(self, motion: Motion) -> Values | None:
        """Its values without an arm."""
        return None if self.reference is None else self.reference(motion)

    def by_header(self, values: Values, rows: int) -> Table:
        """The columns (N,) from what was measured.

        Raises:
            DqpaintError: it is not one value, or one for each name, a row.
        """
        columns = np.asarray(values, dtype=np.float64)
        columns = columns[None] if columns.ndim == 1 else columns.T
        names = self.headers_for(len(columns) if columns.ndim else 0)
        if columns.shape != (len(names), rows):
            raise DqpaintError(
                f"column '{self.headers}' is an array of shape {np.shape(values)}; there are "
                f"{rows} rows, and {len(names)} column{'s' if len(names) > 1 else ''}"
            )
        return dict(zip(names, columns, strict=True))


@dataclass(frozen=True, kw_only=True)
class Figure(Metric):
    """A figure of the summary: one number of a run.

    Attributes:
        name: its key in the JSON.
        measure: its value, from the run and its table; None where the run has none.
        kind: an error, of which less is better, a cost, or of the response to a step.
        listed: whether the tables of studies show it. Figures of one title share a column there.
    """

    name: str
    measure: Callable[[Track, Table], float | None]
    kind: Literal["error", "cost", "step"] = "cost"
    listed: bool = False

    @property
    @override
    def example(self) -> str:
        laws = "accel,accel-decoupled" if self.unit.startswith("Nm") else "p,hinf"
        drawing = "step" if self.kind == "step" else "lag"
        return f"dqpaint compare {drawing} --controllers {laws} --figure {self.name}"


def _not_registered(name: str, _thing: Any) -> Column | Figure:
    raise UsageError(f"its module registers none of that name with @column or @figure ('{name}')")


METRICS: Registry[Column | Figure] = Registry("metric", "dqpaint.metrics", _not_registered)
"""Columns by their first headers and figures by their names, in the order of table and summary.

An entry point has the name of a metric and is loaded for its module, which may register others.
"""

RunFunction = TypeVar("RunFunction", bound=Callable[[Track], Values | None])
MotionFunction = TypeVar("MotionFunction", bound=Callable[[Motion], Values | None])
FigureFunction = TypeVar("FigureFunction", bound=Callable[[Track, Table], float | None])


def column(
    names: str, unit: str, title: str, meaning: str, **more: Any
) -> Callable[[RunFunction], RunFunction]:
    """A decorator: the function below it measures columns of a run.

    Args:
        names: their headers, with blanks between.
        unit: as `Metric` has it, and so `title` and `meaning`.
        title: see there.
        meaning: see there.
        more: what else `Column` has.

    Raises:
        ValueError: there is a metric of that name.
    """
    return _registered(lambda measure: Column(
        names=tuple(names.split()), unit=unit, title=title, meaning=meaning, measure=measure, **more
    ))  # fmt: skip


def motion_column(
    names: str, unit: str, title: str, meaning: str, **more: Any
) -> Callable[[MotionFunction], MotionFunction]:
    """The same for what was asked, which is known before there is a run."""
    return _registered(lambda reference: Column(
        names=tuple(names.split()), unit=unit, title=title, meaning=meaning,
        reference=reference, **more
    ))  # fmt: skip


def figure(
    name: str, unit: str, title: str, meaning: str, **more: Any
) -> Callable[[FigureFunction], FigureFunction]:
    """The same for a figure: the function below takes the run and its table."""
    return _registered(lambda measure: Figure(
        name=name, unit=unit, title=title, meaning=meaning, measure=measure, **more
    ))  # fmt: skip


def _registered(make: Callable[[Any], Column | Figure]) -> Callable[[Any], Any]:
    def record(function: Any) -> Any:
        one = make(function)
        METRICS.add(one.name)(one)
        return function

    return record


def all_columns() -> tuple[Column, ...]:
    """All columns, in the order of the tables."""
    return tuple(one for one in METRICS.values() if isinstance(one, Column))


def all_figures() -> dict[str, Figure]:
    """All figures by their names, in the order of the summary."""
    return {name: one for name, one in METRICS.items() if isinstance(one, Figure)}


def unit_suffix(unit: str) -> str:
    """The ending of a name for a unit: `_rad_s` of rad/s, `_m_s2` of m/s^2."""
    return f"_{unit}".replace("/", "_").replace(" ", "_").replace("^", "") if unit else ""
