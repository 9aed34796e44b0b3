"""Forecast -> warnings with their lines, and a table of the lines close to a limit."""

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

from dqpaint.core import tables
from dqpaint.diagnostics import Diagnostic, SourceLine, Span
from dqpaint.motion import Motion
from dqpaint.planning.corner_limits import CornerPace
from dqpaint.planning.forecast import Extreme, Forecast, forecast
from dqpaint.planning.motion_advice import advise
from dqpaint.planning.occlusion import DEFAULT_SETTINGS
from dqpaint.planning.placement import Placement
from dqpaint.planning.prepared_motion import prepare_motion
from dqpaint.planning.reachability import check_row_reached
from dqpaint.planning.retiming import Retiming
from dqpaint.plants import DEFAULT_PLANTS, find_plant
from dqpaint.program import Program, walls
from dqpaint.robots.kinematics import (
    DAMPING_THRESHOLD,
    PATH_TOLERANCE,
    Kinematics,
    collision_shapes,
)
from dqpaint.robots.model import Card
from dqpaint.settings import Settings

CLOSE_SHARE = 0.9  # of a limit
CLOSE_ANGLE = math.radians(5.0)
CLOSE_SINGULAR = 2 * DAMPING_THRESHOLD
CLOSE_LINKS = 5e-3  # [m]
CLOSE_OCCLUDED = 0.005  # of a line's light
MOST_OCCLUDED = 0.01
MOST_WEIGHT = 0.8  # of a torque: with more a change of the motion does not help
MOST_LINES = 12  # of the table
MOST_NAMED = 6  # lines in a warning
DIRECTIONS = ("front", "side", "top")  # views that have a name
DEG = math.degrees(1)


@dataclass(frozen=True)
class ForecastReport:
    """The forecast of a drawing on an arm: figures, warnings, placement and retiming.

    Attributes:
        motion: what was asked, at its place.
        placement: where `place auto` put it.
        retiming: how it was slowed down, where it may be.
        corners: their accelerations, where the arm can do less than the drawing allows.
        robot: its name.
        plant: the name of the plant whose motors were asked.
        sag_measured: whether its encoders see how far springs give way, where it has any.
        start: the posture it begins in [rad].
        lines: the forecast of each line.
        warnings: for the limits it would run into.
        notes: what was assumed of the arm.
    """

    motion: Motion
    placement: Placement | None
    retiming: Retiming | None
    corners: CornerPace | None
    robot: str
    plant: str
    sag_measured: bool
    start: tuple[float, ...]
    lines: tuple[Forecast, ...]
    warnings: tuple[Diagnostic, ...]
    notes: tuple[str, ...]

    @property
    def text(self) -> str:
        """The text that follows the drawing's figures."""
        worst = min(self.lines, key=lambda line: line.margin.value)
        margin = worst.margin.value * DEG
        said = (
            f"but a joint has to go {-margin:.0f} deg beyond its limit"
            if margin < 0
            else f"every joint {margin:.0f} deg or more from its limits"
        )
        notes = "".join(f"\nnote: {note}" for note in self.notes)
        placed = (
            f"  {self.placement.statement}\n  {self.placement.figures}\n" if self.placement else ""
        )
        slowed = f"  pace: {self.retiming}\n" if self.retiming else ""
        slowed += f"  corners: {self.corners}\n" if self.corners else ""
        program = self.motion.program
        figures = (
            f"{_extremes(self.lines, program, self.sag_measured)}{_table(self.lines, program)}"
        )
        return f"; {self.robot} reaches it, {said}\n{placed}{slowed}{figures}{notes}"

    @property
    def as_json(self) -> dict[str, Any]:
        """All figures of all lines, in SI units."""
        return {
            "robot": self.robot,
            "plant": self.plant,
            "place": self.placement and self.placement.as_json,
            "pace": self.retiming and self.retiming.as_json,
            "corners": self.corners and self.corners.as_json,
            "start_rad": list(self.start),
            "lines": [_figures(line, self.motion.program) for line in self.lines],
        }


def make_report(
    program: Program, kinematics: Kinematics, settings: Settings = DEFAULT_SETTINGS
) -> ForecastReport:
    """The forecast of a drawing on an arm, with warnings.

    Args:
        program: the drawing.
        kinematics: of the arm.
        settings: of the run that is looked ahead to.

    Raises:
        ScriptError: the drawing leaves the arm's reach.
        UsageError: an unknown plant, or values it does not take.
    """
    plant = find_plant(settings.plant) if settings.plant else None
    springs = plant.springs_for(kinematics.card) if plant else None
    motor_torque_use = plant.motor_torque_use if plant else "sudden"
    ready = prepare_motion(program, kinematics, settings, motor_torque_use)
    motion, start = ready.motion, ready.start
    lines = forecast(motion, kinematics, start, settings, plant)
    farthest = max(lines, key=lambda one: one.path_error)
    if farthest.path_error >= PATH_TOLERANCE:
        check_row_reached(motion, kinematics, farthest.path_error_row, settings.null)
    return ForecastReport(
        motion,
        ready.placement,
        ready.retiming,
        ready.corners,
        kinematics.card.name,
        plant.name if plant else DEFAULT_PLANTS["rates"],
        springs is None or springs.seen,
        tuple(start.tolist()),
        lines,
        tuple(_warnings(motion, kinematics.card, lines, slowed=ready.retiming is not None)),
        kinematics.notes
        + collision_shapes(kinematics).notes
        + (plant.notes(kinematics.card) if plant else ()),
    )


class _Rule(NamedTuple):
    """A limit: its warning, how bad a line is (1 is at the limit), and what is said of it.

    Without a `help` what would be softer is found at the time of the `extreme`.
    """

    code: str
    badness: Callable[[Forecast], float]
    message: Callable[[Forecast, Card], str]
    help: str = ""
    extreme: Callable[[Forecast], Extreme | None] = lambda one: None


def _position(one: Forecast, _card: Card) -> str:
    at = one.margin
    return (
        f"joint {at.joint} has to go {-at.value * DEG:.3g} deg beyond its limit{_at_time(at.time)}"
    )


def _speed(one: Forecast, card: Card) -> str:
    at = one.speed
    most = card.speed[at.joint - 1] * DEG
    return (
        f"joint {at.joint} has to turn at {at.value * DEG:.4g} deg/s{_at_time(at.time)}, "
        f"but goes to {most:.4g} deg/s"
    )


def _effort(one: Forecast, card: Card) -> str:
    at = one.effort
    assert at is not None
    limit = _torque_limit(at, card)
    return f"joint {at.joint} needs {at.value:.4g} Nm{_at_time(at.time)}, but {limit}"


def _jolt(one: Forecast, card: Card) -> str:
    at = one.jolt
    assert at is not None
    how = "to follow within 1 ms" if one.sag is None else "with its spring's damper"
    return (
        f"the speed changes at once{_at_time(at.time)}: {how} joint {at.joint} needs "
        f"{at.value:.4g} Nm, but {_torque_limit(at, card)}"
    )


def _torque_limit(at: Extreme, card: Card) -> str:
    return f"has {card.effort[at.joint - 1]:.4g} Nm"


def _singular(one: Forecast, _card: Card) -> str:
    beside = (
        f", up to {one.path_error * 1e3:.1f} mm beside" if one.path_error >= PATH_TOLERANCE else ""
    )
    return (
        f"the arm comes close to a singularity (smallest singular value {one.singular_value:.2g}, "
        f"below {DAMPING_THRESHOLD:g}): there it follows inexactly{beside}"
    )


def _collision(one: Forecast, _card: Card) -> str:
    first, second = one.closest_links or ("", "")
    depth = -(one.clearance or 0.0) * 1e3
    return f"link '{first}' runs into link '{second}' (by {depth:.0f} mm)"


def _hidden(one: Forecast, _card: Card) -> str:
    where = f"from the {one.view}" if one.view in DIRECTIONS else f"in the view {one.view}"
    return f"the arm hides {one.occluded or 0:.0%} of the light, seen {where}"


def _into_wall(one: Forecast, _card: Card) -> str:
    assert one.wall is not None
    return f"an arm without walls would be inside of one{_at_time(one.wall.time)}"


def _at_time(time: float) -> str:
    return f" at {time:.2f} s"


RULES = (
    _Rule(
        "W501",
        lambda one: 1.0 - one.margin.value,
        _position,
        "turn the tool less, or move the drawing with place",
    ),
    _Rule(
        "W502",
        lambda one: one.speed_part,
        _speed,
        "draw it slower (speed, in, samples), or let --on-limit slow do it",
    ),
    _Rule(
        "W503",
        lambda one: one.effort_part or 0.0,
        _effort,
        extreme=lambda one: one.effort,
    ),
    _Rule(
        "W504",
        lambda one: (one.jolt_part or 0.0) if (one.effort_part or 0.0) <= 1 else 0.0,
        _jolt,
        extreme=lambda one: one.jolt,
    ),
    _Rule(
        "W505",
        lambda one: 2.0 - one.singular_value / DAMPING_THRESHOLD,
        _singular,
        "move the drawing with place, or hold the tool another way",
    ),
    _Rule(
        "W506",
        lambda one: 1.0 if one.clearance is None else 1.0 - one.clearance,
        _collision,
        "move the drawing with place, or hold the tool another way",
    ),
    _Rule(
        "W507",
        lambda one: (one.occluded or 0.0) / MOST_OCCLUDED,
        _hidden,
        "point the tool's z axis at the viewer, or move the drawing with place",
    ),
    _Rule(
        "W508",
        lambda one: 1.0 if one.wall is None else 1.0 - one.wall.value,
        _into_wall,
        "resolver qp holds the arm out: the light leaves the path there",
    ),
)


def _warnings(
    motion: Motion, card: Card, lines: Sequence[Forecast], slowed: bool = False
) -> list[Diagnostic]:
    """One warning for each limit, at the line that is worst; the others are named."""
    spans = _spans(motion)
    found = []
    for rule in RULES:
        bad = [one for one in lines if rule.badness(one) > 1.0]
        if not bad:
            continue
        worst = max(bad, key=rule.badness)
        others = [motion.program.line_name(one.line) for one in bad if one is not worst]
        found.append(
            Diagnostic(
                rule.code,
                rule.message(worst, card) + _which_wall(rule, worst, motion.program),
                spans.get(worst.line),
                label=f"likewise {_named(others)}" if others else "",
                help=_help(rule, worst, motion, slowed),
            )
        )
    return found


def _which_wall(rule: _Rule, worst: Forecast, program: Program) -> str:
    """Which wall, and how deep, where a rule is of walls."""
    if rule.code != "W508" or worst.wall is None:
        return ""
    wall, inside = program.walls[worst.wall_number], -worst.wall.value
    deep = f"{inside * DEG:.3g} deg" if isinstance(wall.shape, walls.Cone) else _far(inside)
    return f": by {deep}, line {program.line_name(wall.line)}: {wall.text}"


def _far(distance: float) -> str:
    return f"{distance * 1e3:.3g} mm"


def _help(rule: _Rule, worst: Forecast, motion: Motion, slowed: bool) -> str:
    at = rule.extreme(worst)
    if at is None:
        return rule.help
    if worst.weight_part > MOST_WEIGHT:
        return "the weight alone takes most of it: move the drawing with place"
    return advise(motion, at.time, slowed)


def _spans(motion: Motion) -> dict[SourceLine, Span]:
    spans: dict[SourceLine, Span] = {}
    for segment in motion.program.segments:
        spans.setdefault(segment.line, segment.span)
    return spans


def _named(lines: Sequence[str]) -> str:
    listed = ", ".join(lines[:MOST_NAMED])
    more = f" and {len(lines) - MOST_NAMED} more" if len(lines) > MOST_NAMED else ""
    return f"line{'s' if len(lines) > 1 else ''} {listed}{more}"


def _extremes(lines: Sequence[Forecast], program: Program, seen: bool) -> str:
    """The worst of the whole drawing in a sentence."""
    speed = max(lines, key=lambda one: one.speed_part)
    least = min(lines, key=lambda one: one.manipulability)
    parts = [
        f"joint {speed.speed.joint} at {speed.speed_part:.0%} of its speed "
        f"(line {program.line_name(speed.line)})",
        *_loads(lines, program, seen),
        f"manipulability {least.manipulability:.2g} (line {program.line_name(least.line)})",
    ]
    clear = [one for one in lines if one.clearance is not None]
    if clear:
        near = min(clear, key=lambda one: one.clearance or 0.0)
        parts.append(f"links {max(near.clearance or 0.0, 0.0) * 1e3:.0f} mm apart")
    return f"  at most: {', '.join(parts)}"


def _loads(lines: Sequence[Forecast], program: Program, seen: bool) -> list[str]:
    """Torques of motors and yielding of springs, where a plant has them."""
    parts = []
    most = max(lines, key=lambda one: one.effort_part or 0.0)
    if most.effort is not None:
        part, line = most.effort_part or 0.0, program.line_name(most.line)
        parts.append(f"joint {most.effort.joint} at {part:.0%} of its torque (line {line})")
    sunk = max(lines, key=lambda one: one.sag or 0.0)
    if sunk.sag is not None:
        how = "" if seen else ", which no encoder sees"
        millimetres, line = sunk.sag * 1e3, program.line_name(sunk.line)
        parts.append(f"springs give way by {millimetres:.2g} mm{how} (line {line})")
    return parts


def _cells(one: Forecast) -> dict[str, str]:
    """The quantities of a line that are close to a limit, or beyond it."""
    cells: dict[str, str] = {}
    if one.margin.value < CLOSE_ANGLE:
        cells["off limits"] = f"{one.margin.value * DEG:.1f} deg (joint {one.margin.joint})"
    if one.speed_part > CLOSE_SHARE:
        cells["speed"] = f"{one.speed_part:.0%} (joint {one.speed.joint})"
    if one.effort is not None and (one.effort_part or 0.0) > CLOSE_SHARE:
        cells["torque"] = f"{one.effort_part:.0%} (joint {one.effort.joint})"
    if one.jolt is not None and (one.jolt_part or 0.0) > CLOSE_SHARE:
        head = "torque within 1 ms" if one.sag is None else "torque at once"
        cells[head] = f"{one.jolt_part:.0%} (joint {one.jolt.joint})"
    if one.singular_value < CLOSE_SINGULAR:
        cells["singular value"] = f"{one.singular_value:.2g}"
    if one.clearance is not None and one.clearance < CLOSE_LINKS:
        cells["links apart"] = f"{one.clearance * 1e3:.0f} mm"
    if one.occluded is not None and one.occluded > CLOSE_OCCLUDED:
        cells["hidden"] = f"{one.occluded:.1%}"
    return cells


def _table(lines: Sequence[Forecast], program: Program) -> str:
    """The lines that come close to a limit, and the limits that any of them comes close to."""
    close = {one.line: cells for one in lines if (cells := _cells(one))}
    if not close:
        return ""
    heads = list(dict.fromkeys(head for cells in close.values() for head in cells))
    rows = [["line", *heads]]
    rows += [
        [program.line_name(line), *(cells.get(head, "") for head in heads)]
        for line, cells in list(close.items())[:MOST_LINES]
    ]
    text = "".join(f"\n  {line}" for line in tables.align(rows))
    more = len(close) - MOST_LINES
    return text + (f"\n  and {more} more lines: --json has them all" if more > 0 else "")


def _figures(one: Forecast, program: Program) -> dict[str, Any]:
    """One line, each figure with its unit; nothing in it is infinite."""
    sudden = "effort_within_1_ms_Nm" if one.sag is None else "effort_at_once_Nm"
    worst = {
        "margin_rad": (one.margin, None),
        "speed_rad_s": (one.speed, one.speed_part),
        "effort_Nm": (one.effort, one.effort_part),
        sudden: (one.jolt, one.jolt_part),
    }
    return {
        "line": program.line_reference(one.line),
        "room": one.relative_margin,
        "start_s": one.start,
        **{
            name: value and asdict(value) | ({} if part is None else {"part_of_limit": part})
            for name, (value, part) in worst.items()
        },
        "sag_m": one.sag,
        "smallest_singular_value": one.singular_value,
        "manipulability": one.manipulability,
        "stray_m": one.path_error,
        "clearance_m": one.clearance,
        "between": one.closest_links,
        "hidden": one.occluded,
    }
