"""Motion x arm -> Forecast: limits and torques of each line of a drawing, before it is simulated.

The arm follows what was asked without error and without limits, through the same resolver and with
the same wish in its null space as a run. So where nothing is beyond a limit, a run goes the same
way; where something is, the forecast says what would have been needed. Of a plant it is foreseen
what its motors bear, and how far springs give way. Disturbances are what nobody foresees, and how
an arm that begins elsewhere comes to the drawing is its law's own.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dqpaint.diagnostics import SourceLine
from dqpaint.dq import Floats
from dqpaint.motion import Motion
from dqpaint.planning.ideal_run import follow, jumps_between
from dqpaint.planning.occlusion import (
    DEFAULT_SETTINGS,
    MOST_OCCLUSION_ROWS,
    OcclusionForecast,
    forecast_occlusion,
    sampled_rows,
)
from dqpaint.planning.retiming import SUDDEN_TIME
from dqpaint.plants import ConfiguredPlant
from dqpaint.robots.kinematics import (
    CHARACTERISTIC_LENGTH,
    DEFAULT_OBJECTIVE,
    Dynamics,
    Kinematics,
    Nearest,
    collision_shapes,
    make_secondary_task,
    manipulability,
    tool_jacobian_map,
)
from dqpaint.robots.resolvers import DEFAULT_RESOLVER, resolver_of
from dqpaint.robots.walls import Walls, walls_of
from dqpaint.settings import Settings

MOST_ROWS = 20_000  # that are followed; of a longer drawing every second, third ... one


@dataclass(frozen=True)
class Extreme:
    """The extreme of a quantity on a line: its value, the joint (from 1) and the time [s]."""

    value: float
    joint: int
    time: float


@dataclass(frozen=True)
class Forecast:
    """Rates, torques and distances that one line of a drawing needs of an arm.

    Attributes:
        line: of the drawing.
        start: time of its first row [s].
        margin: least distance of a joint to its limits [rad]; negative beyond them.
        relative_margin: the same, divided by half the joint's range: 0 at a limit, 1 in the middle.
        speed: largest joint rate [rad/s].
        speed_part: the same as a part of the joint's limit; both of the joint nearest to its own.
        effort: largest torque of the motion itself, of the joint nearest to its limit [Nm]; None
            on a plant without masses.
        effort_part: the same as a part of that limit.
        jolt: largest torque [Nm] where the speed changes at once: motors of the plant `stiff` reach
            each new rate within a millisecond; where motors wind springs, the dampers bear it. None
            where the law decides how fast the rate changes.
        jolt_part: the same as a part of that limit.
        weight_part: the largest part of a joint's torque that the arm's weight takes, at rest.
        sag: the largest distance [m] that the light sinks because springs yield to the arm's
            weight; None without springs.
        singular_value: the smallest singular value of the Jacobian at the tool [rad/rad].
        manipulability: the least sqrt(det(J J')).
        path_error: largest distance of the arm from the path [m]: it is damped at a singularity.
        path_error_row: the row of the motion where that is.
        clearance: least distance between two links [m]; None where no links can meet.
        closest_links: these two links.
        occluded: largest share of the line's light that the arm hides in one view; None for a dark
            line.
        view: that view.
        wall: how near the nearest wall is [m], or how much of a cone's angle is left [rad]; None
            without walls.
        wall_number: which of the drawing's it is, from 0.
    """

    line: SourceLine
    start: float
    margin: Extreme
    relative_margin: float
    speed: Extreme
    speed_part: float
    effort: Extreme | None
    effort_part: float | None
    jolt: Extreme | None
    jolt_part: float | None
    weight_part: float
    sag: float | None
    singular_value: float
    manipulability: float
    path_error: float
    path_error_row: int
    clearance: float | None
    closest_links: tuple[str, str] | None
    occluded: float | None
    view: str
    wall: Extreme | None = None
    wall_number: int = 0


def forecast(
    motion: Motion,
    kinematics: Kinematics,
    start: Floats,
    settings: Settings = DEFAULT_SETTINGS,
    plant: ConfiguredPlant | None = None,
) -> tuple[Forecast, ...]:
    """Predict the joint motion of an arm along a drawing.

    Args:
        motion: what is asked.
        kinematics: of the arm.
        start: posture (n,) [rad] it begins in.
        settings: of the run: what the arm does with its freedom, what shines, and from where it is
            looked at.
        plant: whose motors bear it; None is `stiff`.

    Returns:
        One entry for each line of the file that moves, in the order they are first drawn.
    """
    resolver = resolver_of(settings, motion.program)
    run = _Run(motion, kinematics, start, settings.null, resolver, plant)
    shapes = collision_shapes(kinematics)
    looks = sampled_rows(run.source.index, MOST_OCCLUSION_ROWS)
    near = shapes.nearest(run.posture[looks])
    run.measure_walls(walls_of(motion, kinematics), looks)
    hiding = forecast_occlusion(shapes, motion, run.rows, run.posture, settings)
    _, first = np.unique(run.source.index, return_index=True)
    return tuple(_forecast_line(run, row, looks, near, hiding) for row in np.sort(first).tolist())


class _Run:
    """The arm along the drawing: rows of the motion, and arrays with one entry for each.

    The speed and the torque of a jump of the set point are a law's own: they count as none.
    """

    def __init__(
        self,
        motion: Motion,
        kinematics: Kinematics,
        start: Floats,
        null: str = DEFAULT_OBJECTIVE,
        resolver: str = DEFAULT_RESOLVER,
        plant: ConfiguredPlant | None = None,
    ) -> None:
        self.card = kinematics.card
        stride = -(-len(motion.t) // MOST_ROWS)
        self.rows = np.arange(0, len(motion.t), stride)
        self.t, self.source = motion.t[self.rows], motion.source[self.rows]
        self.period = stride * motion.period
        joined = jumps_between(motion, self.rows)
        self.posture, self.points, J = follow(
            motion, kinematics, start, self.rows, make_secondary_task(null, self.card, start),
            resolver,
        )  # fmt: skip
        self.path_error = np.linalg.norm(self.points - motion.points[self.rows], axis=1)
        poses = motion.pose[self.rows]  # of a whole pose nothing depends on them
        if not kinematics.task.is_whole:
            poses = kinematics.poses(self.posture)
        self.manipulability = manipulability(kinematics.task_jacobian(poses, J))
        at_tool = tool_jacobian_map(self.points) @ J
        rows = kinematics.task.rows(poses)
        controlled = at_tool if rows is None else rows @ at_tool
        self.singular_value = np.linalg.svd(controlled, compute_uv=False)[:, -1]
        self.rates = np.zeros_like(self.posture)
        self.rates[:-1] = np.diff(self.posture, axis=0) / self.period
        self.rates[joined] = 0.0
        change = np.diff(self.rates, axis=0, prepend=0.0)
        change[joined] = 0.0
        change[-1] = 0.0  # a run ends there: nothing is asked any more
        change[1:][joined[:-1]] = 0.0
        dynamics = Dynamics(kinematics)
        self.weight = np.array([dynamics.weight(q) for q in self.posture])
        self._set_loads(change, motion, dynamics, at_tool, plant)
        self.margin = np.minimum(self.posture - self.card.lower, self.card.upper - self.posture)
        self.relative_margin = 2 * self.margin / (self.card.upper - self.card.lower)

    def _set_loads(
        self,
        change: Floats,
        motion: Motion,
        dynamics: Dynamics,
        at_tool: Floats,
        plant: ConfiguredPlant | None,
    ) -> None:
        """Set motor torques (N, n) [Nm] for changes of rates (N, n), where the plant has motors."""
        self.effort: Floats | None = None
        self.jolt: Floats | None = None
        self.sag: Floats | None = None
        motors = plant.motor_torque_use if plant else "sudden"
        if motors == "none":
            return
        if motors == "sudden":
            self.effort = self._torques(dynamics, change / self.period)
            self.jolt = self._torques(dynamics, change / min(self.period, SUDDEN_TIME))
            return
        smooth = _without_corners(change, motion.stroke[self.rows])
        self.effort = self._torques(dynamics, smooth / self.period)
        springs = plant.springs_for(self.card) if plant else None
        if springs is not None:
            # at first only the dampers answer a motor that turns at a new rate
            self.jolt = self.effort + springs.damping * (change - smooth)
            sunk = np.matvec(at_tool, (1 - springs.share) * self.weight / springs.stiffness)
            self.sag = CHARACTERISTIC_LENGTH * np.linalg.norm(sunk[:, 3:], axis=1)

    def measure_walls(self, walls: Walls | None, looks: NDArray[np.intp]) -> None:
        """Measure the distances (L, W) to walls at some rows (L,)."""
        self._wall_time = self.t[looks]
        self._walls = (
            np.zeros((len(looks), 0))
            if walls is None
            else walls.least(self.posture[looks], self.t[looks])
        )

    def nearest_wall(self, looked: NDArray[np.intp]) -> Extreme | None:
        """The least distance to a wall at some of the rows that were looked at."""
        if not self._walls.shape[1]:
            return None
        k = int(self._walls[looked].min(axis=1).argmin())
        return Extreme(float(self._walls[looked[k]].min()), 0, float(self._wall_time[looked[k]]))

    def nearest_wall_number(self, looked: NDArray[np.intp]) -> int:
        """The number of the wall that is nearest there, from 0."""
        return int(self._walls[looked].min(axis=0).argmin()) if self._walls.shape[1] else 0

    def _torques(self, dynamics: Dynamics, accelerations: Floats) -> Floats:
        rows = zip(self.posture, self.rates, accelerations, strict=True)
        return np.array([dynamics.torque(*row) for row in rows])


def _without_corners(change: Floats, stroke: NDArray[np.int64]) -> Floats:
    """Changes of rates (N, n) without those at once: there they are taken as in the next row."""
    first = np.flatnonzero(np.diff(stroke, prepend=-1))
    smooth = change.copy()
    smooth[first] = change[np.minimum(first + 1, len(change) - 1)]
    return smooth


def _forecast_line(
    run: _Run, first: int, looks: NDArray[np.intp], near: Nearest, hiding: OcclusionForecast
) -> Forecast:
    """The forecast of the line whose first row is given."""
    rows = np.flatnonzero(run.source.index == run.source.index[first])
    card = run.card
    speed, speed_part = _worst(run, rows, run.rates, card.speed)
    effort, effort_part = _worst_if_any(run, rows, run.effort, card.effort)
    jolt, jolt_part = _worst_if_any(run, rows, run.jolt, card.effort)
    k, joint = np.unravel_index(run.margin[rows].argmin(), (len(rows), card.joints))
    margin = Extreme(float(run.margin[rows[k], joint]), int(joint) + 1, float(run.t[rows[k]]))
    looked = np.flatnonzero(np.isin(looks, rows))
    closest = looked[near.distance[looked].argmin()]
    meets = bool(np.isfinite(near.distance[closest]))
    hidden, view = hiding.largest_share(rows)
    return Forecast(
        line=run.source.at(first),
        start=float(run.t[rows[0]]),
        margin=margin,
        relative_margin=float(run.relative_margin[rows].min()),
        speed=speed,
        speed_part=speed_part,
        effort=effort,
        effort_part=effort_part,
        jolt=jolt,
        jolt_part=jolt_part,
        weight_part=_worst(run, rows, run.weight, card.effort)[1],
        sag=None if run.sag is None else float(run.sag[rows].max()),
        singular_value=float(run.singular_value[rows].min()),
        manipulability=float(run.manipulability[rows].min()),
        path_error=float(run.path_error[rows].max()),
        path_error_row=int(run.rows[rows[run.path_error[rows].argmax()]]),
        clearance=float(near.distance[closest]) if meets else None,
        closest_links=near.pair[closest] if meets else None,
        occluded=hidden,
        view=view,
        wall=run.nearest_wall(looked),
        wall_number=run.nearest_wall_number(looked),
    )


def _worst(
    run: _Run, rows: NDArray[np.intp], values: Floats, limit: Floats
) -> tuple[Extreme, float]:
    """Where some values come nearest to their limits, and that as a part of the limit."""
    parts = np.abs(values[rows]) / limit
    k, joint = np.unravel_index(parts.argmax(), parts.shape)
    row = rows[k]
    worst = Extreme(float(abs(values[row, joint])), int(joint) + 1, float(run.t[row]))
    return worst, float(parts[k, joint])


def _worst_if_any(
    run: _Run, rows: NDArray[np.intp], values: Floats | None, limit: Floats
) -> tuple[Extreme | None, float | None]:
    return (None, None) if values is None else _worst(run, rows, values, limit)
