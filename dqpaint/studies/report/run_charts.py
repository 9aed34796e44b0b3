"""The table of a run and the arm's limits -> its curves in time: errors, path, joints, ..."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.robots.model import Card
from dqpaint.studies.report.charts import COLOURS, Line, Panel
from dqpaint.studies.report.page import Charts

PERCENT = (-100.0, 100.0)
MM, DEG = 1e3, float(np.degrees(1))
DECADES = 5
FAINT_LINE = "#777777"
OF_JOINTS = (*COLOURS, "#000000")
TIME = "time [s]"
Scale = Literal["linear", "log"]


@dataclass(frozen=True)
class RunTable:
    """What curves are drawn from.

    Attributes:
        name: of the run.
        table: columns (N,) by their headers, as the CSV of a run has them.
        card: of the arm, for its limits; None where it is not known.
        held: kind of limit, joint from 1, begin and end [s] of each time that one held a joint.
    """

    name: str
    table: Mapping[str, Floats]
    card: Card | None = None
    held: Sequence[tuple[str, int, float, float]] = ()

    def joints(self, pattern: str) -> list[tuple[int, Floats]]:
        """Joint numbers, from 1, and columns of headers such as `q{}_rad`."""
        known = re.compile(re.escape(pattern).replace(r"\{\}", r"(\d+)"))
        found = [
            (match, values) for n, values in self.table.items() if (match := known.fullmatch(n))
        ]
        return [(int(match[1]), values) for match, values in found]


@dataclass(frozen=True)
class Choice:
    """Which curves are drawn, and how.

    Attributes:
        what: names in `CURVES`; empty is all that the run has.
        scale: of what is never below 0: errors, speed, effort.
        span: of time that is shown [s]; None is all.
        each: whether every joint has a panel of its own, in its unit.
    """

    what: tuple[str, ...] = ()
    scale: Scale = "linear"
    span: tuple[float, float] | None = None
    each: bool = False


def charts_of_run(run: RunTable, choice: Choice) -> Charts:
    """The curves of a run.

    Raises:
        UsageError: a name that is none, or nothing of what is asked for is in the table.
    """
    for name in choice.what:
        if name not in CURVES:
            raise UsageError(f"what '{name[:40]}' is none of: {', '.join(CURVES)}")
    found = {n: list(CURVES[n](run, choice)) for n in choice.what or CURVES}
    if missing := [name for name in choice.what if not found[name]]:
        raise UsageError(f"{run.name} has no columns of {', '.join(missing)}")
    panels = [panel for several in found.values() for panel in several]
    if not panels:
        raise UsageError(
            f"{run.name} has no columns of a run besides t_s: plot takes the CSV that draw writes"
        )
    t = run.table["t_s"]
    span = choice.span or (float(t[0]), float(t[-1]))
    if span[0] >= t[-1]:
        raise UsageError(f"span {span[0]:g}..{span[1]:g} s: {run.name} ends at {t[-1]:g} s")
    return Charts(
        run.name, [replace(panel, x_span=span) for panel in panels], note=_note(run, panels)
    )


def _note(run: RunTable, panels: Sequence[Panel]) -> str:
    """What shaded areas are; the limits that held joints."""
    said = [run.name]
    if any(panel.allowed for panel in panels):
        said.append("grey: beyond a limit of the joint")
    if any(panel.held for panel in panels):
        said.append("red: a limit held a joint there, from when it began and as long as in all")
    return "; ".join(said)


def _amount(
    title: str, header: str, unit: str, scale: float
) -> Callable[[RunTable, Choice], Sequence[Panel]]:
    """A function for curves of one column that is never below 0."""

    def panels(run: RunTable, choice: Choice) -> Sequence[Panel]:
        if header not in run.table:
            return []
        values = scale * run.table[header]
        log = choice.scale == "log" and bool((values > 0).any())
        span = None if log else (0.0, 1.05 * float(values.max()) or 1.0)
        lines = [Line(run.table["t_s"], values, title)]
        return [
            Panel(title, TIME, f"{title} [{unit}]", lines, log_y=log, decades=DECADES, span=span)
        ]

    return panels


def _errors(run: RunTable, choice: Choice) -> Sequence[Panel]:
    place = _amount("position error", "position_error_m", "mm", MM)
    turn = _amount("orientation error", "orientation_error_rad", "deg", DEG)
    return [*place(run, choice), *turn(run, choice)]


def _path(run: RunTable, choice: Choice) -> Sequence[Panel]:
    """Each coordinate with its reference."""
    panels = []
    for axis in "xyz":
        lines = [
            Line(run.table["t_s"], MM * run.table[header], label, colour, width=width)
            for header, label, colour, width in (
                (f"desired_{axis}_m", "reference", FAINT_LINE, 3.0),
                (f"{axis}_m", "run", COLOURS[0], 1.2),
            )
            if header in run.table
        ]
        if lines:
            panels.append(Panel(f"{axis} of the light", TIME, f"{axis} [mm]", lines))
    return panels


def _joint_curves(
    title: str, pattern: str, unit: str, scale: float, kind: str
) -> Callable[[RunTable, Choice], Sequence[Panel]]:
    """A function for the curves of all joints: of their limits, or each in its unit."""

    def panels(run: RunTable, choice: Choice) -> Sequence[Panel]:
        columns = run.joints(pattern)
        limits = _limits(run.card, kind, len(columns))
        t = run.table["t_s"]
        if not columns:
            return []
        if choice.each:
            return [
                Panel(f"{title}, joint {joint}", TIME, f"joint {joint} [{unit}]",
                      [Line(t, scale * values, f"joint {joint}")],
                      allowed=None if limits is None else (
                          scale * limits[0][joint - 1], scale * limits[1][joint - 1]),
                      held=_held(run, kind, joint))
                for joint, values in columns
            ]  # fmt: skip
        if limits is None:
            lines = [_line(t, scale * values, joint) for joint, values in columns]
            return [Panel(title, TIME, f"{title} [{unit}]", lines, held=_held(run, kind))]
        lines = []
        for joint, values in columns:
            low, high = limits[0][joint - 1], limits[1][joint - 1]
            part = 100 * (values - (high + low) / 2) / ((high - low) / 2)
            lines.append(_line(t, part, joint))
        head = "part of the range" if kind == "position" else "part of the limit"
        return [
            Panel(title, TIME, f"{title}, {head} [%]", lines, allowed=PERCENT,
                  held=_held(run, kind))
        ]  # fmt: skip

    return panels


def _line(t: Floats, values: Floats, joint: int) -> Line:
    return Line(t, values, f"joint {joint}", OF_JOINTS[(joint - 1) % len(OF_JOINTS)], width=1.5)


def _limits(card: Card | None, kind: str, joints: int) -> tuple[Floats, Floats] | None:
    """The least and the largest value of each joint."""
    if card is None or card.joints != joints:
        return None
    if kind == "position":
        return card.lower, card.upper
    most = card.speed if kind == "speed" else card.effort
    return -most, most


def _held(run: RunTable, kind: str, joint: int | None = None) -> list[tuple[float, float]]:
    return [(begin, end) for k, j, begin, end in run.held if k == kind and joint in (None, j)]


CURVES: dict[str, Callable[[RunTable, Choice], Sequence[Panel]]] = {
    "error": _errors,
    "path": _path,
    "speed": _amount("speed", "speed_m_s", "mm/s", MM),
    "joints": _joint_curves("joint angles", "q{}_rad", "deg", DEG, "position"),
    "commands": _joint_curves("commanded joint rates", "command{}_rad_s", "deg/s", DEG, "speed"),
    "torques": _joint_curves("commanded torques", "torque{}_Nm", "Nm", 1.0, "torque"),
    "motors": _joint_curves("motor torques", "motor{}_Nm", "Nm", 1.0, "torque"),
    "effort": _amount("effort", "effort_rad", "deg a step", DEG),
}
"""Curves by what `--what` calls them."""
