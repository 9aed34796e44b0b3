"""Drawing x arm -> where the drawing fits the arm best: `place auto`.

The drawing is tried all over the arm's reach, always facing the way it faces on the robot's canvas
(or as `place auto turned` says), so that the picture stays the same. Of each place four
things count, each the worst along the whole path: the manipulability, the room a joint has left,
from 0 at a limit to 1 in the middle of its range, the part of a joint's torque that the arm's own
weight leaves, and the pace at which every joint keeps within its speed, at most 1. Their product is
the figure of merit. Many places are followed at once on a few of the drawing's poses; the best is
then moved in ever smaller steps; what comes out is looked at along the whole drawing, and has to be
free of collisions and in sight. Places where some of the drawing would be below z = 0, on which
most arms stand, are tried last.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.diagnostics import Diagnostic, ScriptError
from dqpaint.dq import Floats
from dqpaint.language import parse
from dqpaint.motion import Motion, moved, plan, scaled, straight
from dqpaint.planning.forecast import Forecast, forecast
from dqpaint.planning.ideal_run import find_start_posture, jumps_between
from dqpaint.planning.occlusion import DEFAULT_SETTINGS
from dqpaint.program import AutoPlacement, Pose, Program
from dqpaint.robots.kinematics import (
    PATH_TOLERANCE,
    START_GAIN,
    Dynamics,
    Kinematics,
    NoPosture,
    manipulability,
    resolve,
    waypoints,
)
from dqpaint.robots.urdf import roll_pitch_yaw
from dqpaint.settings import Settings

SEED = 1988
RANDOM_POSTURES = 400  # random postures that tell how far the arm reaches
GRID_STEPS = 5  # of the reach, in the grid of places, to either side of the base
COARSE_STARTS, FINE_STARTS = 4, 12  # postures each place is begun from, at first and in the end
COARSE_POSES, FINE_POSES = 10, 32  # poses of the drawing that are looked at
HALVINGS = 6  # steps of the search, each half as long as the one before
MOST_CANDIDATES = 8  # places that are looked at along the whole drawing, at the most
NEWTON_STEPS, LARGEST_STEP = 12, 0.6  # iterations, and the largest move of a joint in one [rad]
LEAST_TORQUE_LEFT = (
    0.01  # of a torque counts as left where an arm can't bear its weight: these come last
)
TRIED_SCALES = (0.75, 0.5, 0.25)  # that are tried where there is no room
POSE_TOLERANCE = 1e-3  # [rad, m] counts as reached
MOST_OCCLUDED = 0.01  # of the light may be hidden
POOR = 0.1  # of half a joint's range, or of a torque: a place that leaves less is called poor


@dataclass(frozen=True)
class Placement:
    """The pose of a drawing, and how well it fits the arm there.

    Attributes:
        pose: the drawing frame in the base frame.
        statement: the same as a line of the language, fit to be pasted: exactly this place.
        merit: `manipulability` times `relative_margin` times `torque_left` times `pace`.
        manipulability: the least along the drawing.
        relative_margin: the least of any joint, from 0 at a limit to 1 in the middle of its range.
        torque_left: the least part of any joint's torque that the arm's weight leaves.
        pace: the part of the drawing's speed at which no joint is faster than it can, at most 1.
        occluded: the largest part of a line's light that the arm hides, seen from the front.
    """

    pose: Pose
    statement: str
    merit: float
    manipulability: float
    relative_margin: float
    torque_left: float
    pace: float
    occluded: float

    @property
    def as_json(self) -> dict[str, Any]:
        """For a summary: the origin [m], the quaternion, the figures."""
        return {
            "at_m": list(self.pose.position),
            "orientation": list(self.pose.orientation),
            "line": self.statement,
            "merit": self.merit,
            "manipulability": self.manipulability,
            "room": self.relative_margin,
            "torque": self.torque_left,
            "pace": self.pace,
        }

    @property
    def is_poor(self) -> bool:
        """Whether the arm can hardly draw it well there, though nothing better was found."""
        return min(self.relative_margin, self.torque_left) < POOR or self.pace < 1.0

    @property
    def figures(self) -> str:
        """How well the drawing fits there, in words."""
        poor = "a poor place: " if self.is_poor else ""
        slow = f", joints keep up with {self.pace:.0%} of the speed" if self.pace < 1.0 else ""
        return (
            f"{poor}manipulability at least {self.manipulability:.3g}, "
            f"{self.relative_margin:.0%} of half a joint's range and "
            f"{self.torque_left:.0%} of a torque left{slow}; merit {self.merit:.3g}"
        )


def place_program(
    program: Program, kinematics: Kinematics, settings: Settings = DEFAULT_SETTINGS
) -> tuple[Program, Placement | None]:
    """A program with its placement found, where `place auto` asks for one.

    Args:
        program: the drawing.
        kinematics: of the arm.
        settings: of the run; `pose` finds a place whatever the file says.

    Raises:
        ScriptError: the arm can draw it nowhere.
    """
    wanted = program.placement
    if settings.place == "auto" and not isinstance(wanted, AutoPlacement):
        wanted = AutoPlacement(wanted.orientation if wanted else None, None)
    if not isinstance(wanted, AutoPlacement):
        return program, None
    program = replace(program, placement=wanted)
    placed = find_placement(program, kinematics, settings)
    return replace(program, placement=placed.pose), placed


def find_placement(
    program: Program, kinematics: Kinematics, settings: Settings = DEFAULT_SETTINGS
) -> Placement:
    """Where a drawing fits an arm best; the same answer each time.

    It is to be in sight from the front, as far as can be, from wherever it is looked at: pictures
    of two views are of one run, as those of two plants are of one drawing.

    Raises:
        ScriptError: the arm can draw it nowhere.
    """
    motion = plan(program, kinematics.card.canvas.pose)
    found = []
    for origin in _Search(motion, kinematics).best_origins():
        place = _place_statement(origin, dq.rotation(motion.canvas))
        placed = _evaluate(program, kinematics, place, settings)
        if placed is not None and placed.occluded <= MOST_OCCLUDED:
            return placed
        found += [placed] if placed is not None else []
    if found:  # a tool that is turned away stands before its light everywhere
        return min(found, key=lambda one: one.occluded)
    raise _no_placement_error(program, kinematics, motion, settings)


def can_be_placed(
    motion: Motion, kinematics: Kinematics, settings: Settings = DEFAULT_SETTINGS
) -> bool:
    """Whether `place auto` finds a place for a motion, which stays turned as it is."""
    search = _Search(motion, kinematics)
    return any(
        _forecast_if_valid(moved(motion, origin), kinematics, settings)
        for origin in search.best_origins()
    )


def _evaluate(
    program: Program, kinematics: Kinematics, line: str, settings: Settings = DEFAULT_SETTINGS
) -> Placement | None:
    """The placement of a `place` statement, over the whole drawing; None if it cannot be drawn."""
    place = parse(f"{line}\nhold 1 s\n", "place").placement
    assert isinstance(place, Pose)
    motion = plan(replace(program, placement=place), kinematics.card.canvas.pose)
    lines = _forecast_if_valid(motion, kinematics, settings)
    if not lines:
        return None
    room = min(one.relative_margin for one in lines)
    worst = min(one.manipulability for one in lines)
    torque = min(_torque_left(one.weight_part) for one in lines)
    pace = min(1.0, 1.0 / max(1e-9, *(one.speed_part for one in lines)))
    hidden = max(one.occluded or 0.0 for one in lines)
    merit = worst * room * torque * pace
    return Placement(place, line, merit, worst, room, torque, pace, hidden)


def _forecast_if_valid(
    motion: Motion, kinematics: Kinematics, settings: Settings
) -> tuple[Forecast, ...]:
    """The forecast of a motion that can be drawn where it is; empty for one that cannot."""
    start = find_start_posture(motion, kinematics, settings.null)
    if isinstance(start, NoPosture) or start.margin < 0:
        return ()
    seen = DEFAULT_SETTINGS.model_copy(update={"null": settings.null, "brush": settings.brush})
    lines = forecast(motion, kinematics, start.posture, seen)
    return lines if all(_is_valid(one) for one in lines) else ()


def _is_valid(one: Forecast) -> bool:
    """Whether a line is reached, and no links meet on it."""
    apart = one.clearance is None or one.clearance >= 0
    return one.relative_margin > 0 and one.path_error < PATH_TOLERANCE and apart


def _torque_left(part: float) -> float:
    """The remaining part of a torque, at least a little: an arm may be run without masses."""
    return max(1.0 - part, LEAST_TORQUE_LEFT)


class _Search:
    """A search over many placements at once: which can be drawn, and how well."""

    def __init__(self, motion: Motion, kinematics: Kinematics) -> None:
        self._arm, self._motion = kinematics, motion
        card = kinematics.card
        rng = np.random.default_rng(SEED)
        trials = rng.uniform(card.lower, card.upper, (RANDOM_POSTURES, card.joints))
        places = dq.translation(kinematics.poses_and_jacobians(trials)[0])
        self._middle = np.median(places, axis=0)
        self._reach = float(np.linalg.norm(places - self._middle, axis=1).max())
        self._seeds = np.vstack([card.home, trials[: FINE_STARTS - 1]])
        corners = motion.points
        self._centre = 0.5 * (corners.max(axis=0) + corners.min(axis=0))
        self._lowest = float(corners[:, 2].min())
        self._origin = dq.translation(motion.canvas)

    def best_origins(self) -> Iterator[Floats]:
        """Origins (3,) of the drawing frame, the most promising first.

        Those where all of the drawing is above z = 0 come before all others.
        """
        grid = self._grid()
        above = self._above(grid)
        yield from self._best_of(grid[above], on_floor=True)
        yield from self._best_of(grid[~above], on_floor=False)

    def _above(self, shifts: Floats) -> NDArray[np.bool_]:
        return np.asarray(self._lowest + shifts[:, 2] >= 0)

    def _best_of(self, shifts: Floats, on_floor: bool) -> Iterator[Floats]:
        """Of some shifts (P, 3) the best, climbed from, and the most promising others."""
        if not len(shifts):
            return
        merits = self._merits(shifts, COARSE_POSES, COARSE_STARTS)
        order = np.argsort(-merits, kind="stable")[:MOST_CANDIDATES]
        found = [shifts[i] for i in order if merits[i] > 0]
        if found:
            yield self._origin + self._climb(found[0], on_floor)
        yield from (self._origin + shift for shift in found)

    def _grid(self) -> Floats:
        """Shifts (P, 3) [m] of the drawing; none at all is the first."""
        axis = np.linspace(-self._reach, self._reach, 2 * GRID_STEPS + 1)
        cube = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
        ball = cube[np.linalg.norm(cube, axis=1) <= self._reach]
        return np.vstack([np.zeros(3), self._middle + ball - self._centre])

    def _climb(self, shift: Floats, on_floor: bool) -> Floats:
        """Up to a place that has no better neighbour, in steps that halve."""
        merit = float(self._merits(shift[None], FINE_POSES, FINE_STARTS)[0])
        step = 0.5 * self._reach / GRID_STEPS
        directions = np.vstack([np.eye(3), -np.eye(3)])
        for _ in range(HALVINGS):
            around = shift + step * directions
            merits = self._merits(around, FINE_POSES, FINE_STARTS)
            if on_floor:
                merits[~self._above(around)] = 0.0
            best = int(np.argmax(merits))
            if merits[best] > merit:
                shift, merit = around[best], float(merits[best])
            else:
                step *= 0.5
        return shift

    def _merits(self, shifts: Floats, poses: int, starts: int) -> Floats:
        """Figures of merit (P,) of shifted drawings; 0 where one cannot be drawn."""
        rows = waypoints(self._motion.stroke)
        rows = rows[np.unique(np.linspace(0, len(rows) - 1, poses).astype(int))]
        whose = np.repeat(np.arange(len(shifts)), starts)
        moves = dq.pose_from(shifts, np.tile([1.0, 0, 0, 0], (len(shifts), 1)))[whose]
        first = np.tile(self._seeds[:starts], (len(shifts), 1))
        follow = _BatchFollower(self._arm, first)
        seconds, jump = self._motion.t[rows], jumps_between(self._motion, rows)
        for k, row in enumerate(rows):
            pause = seconds[k] - seconds[k - 1] if k else None
            jumped = k > 0 and bool(jump[k - 1])
            follow.advance(dq.mul(moves, self._motion.pose[row]), pause, jumped)
        merits = np.zeros(len(shifts))
        np.maximum.at(merits, whose[follow.alive], follow.merit[follow.alive])
        return merits


class _BatchFollower:
    """Arms (M, n) that follow the same poses from different postures, while they can."""

    def __init__(self, kinematics: Kinematics, postures: Floats) -> None:
        self._arm, self._card = kinematics, kinematics.card
        self._q, self._start = postures, postures
        self._half = 0.5 * (self._card.upper - self._card.lower)
        self._worst = np.full(len(postures), np.inf)
        self._relative_margin = np.ones(len(postures))
        self._torque_left = np.ones(len(postures))
        self._pace = np.ones(len(postures))
        self._dynamics = Dynamics(kinematics)
        self.alive = np.arange(len(postures))

    @property
    def merit(self) -> Floats:
        """Least manipulability, room, torque and pace so far, multiplied (M,)."""
        return self._worst * self._relative_margin * self._torque_left * self._pace

    def advance(self, poses: Floats, pause: float | None, jumped: bool = False) -> None:
        """Move to the next poses (M, 8) after a time [s]; None for the first poses.

        The speed of a jump of the reference is a law's own: it does not count.
        """
        if not len(self.alive):
            return
        alive = self.alive
        wish = np.zeros_like(self._q[alive])
        if pause is not None:
            wish = (1.0 - np.exp(-START_GAIN * pause)) * (self._start[alive] - self._q[alive])
        q, measure, reached = self._newton(poses[alive], self._q[alive], wish)
        if pause and not jumped:
            moved = np.abs(q - self._q[alive]) / self._card.speed
            self._pace[alive] = np.minimum(
                self._pace[alive], pause / np.maximum(moved.max(axis=1), pause)
            )
        room = np.minimum(q - self._card.lower, self._card.upper - q) / self._half
        self._q[alive] = q
        self._worst[alive] = np.minimum(self._worst[alive], measure)
        self._relative_margin[alive] = np.minimum(self._relative_margin[alive], room.min(axis=1))
        good = reached & (self._relative_margin[alive] > 0)
        self.alive = alive[good]
        for one, posture in zip(self.alive, q[good], strict=True):
            part = float(np.abs(self._dynamics.weight(posture) / self._card.effort).max())
            self._torque_left[one] = min(self._torque_left[one], _torque_left(part))
        if pause is None:
            self._start = self._q.copy()

    def _newton(
        self, poses: Floats, q: Floats, wish: Floats
    ) -> tuple[Floats, Floats, NDArray[np.bool_]]:
        """Postures, their manipulability, and whether they have reached their poses."""
        q, measure = q.copy(), np.zeros(len(q))
        busy = np.arange(len(q))
        for iteration in range(NEWTON_STEPS):
            x, J = self._arm.poses_and_jacobians(q[busy])
            near = dq.nearest(self._arm.task.near(poses[busy], x), x)
            error = 2 * dq.log(dq.mul(near, dq.conj(x)))
            measure[busy] = manipulability(self._arm.task_jacobian(x, J))
            there = (np.abs(error).max(axis=1) < POSE_TOLERANCE) & (iteration > 0)
            busy, x, J, error = busy[~there], x[~there], J[~there], error[~there]
            if not len(busy):
                break
            rows = self._arm.task.rows(x)
            step = resolve(J, dq.translation(x), error, wish[busy], rows=rows)
            wish[busy] = 0.0
            largest = np.maximum(np.abs(step).max(axis=1), 1e-12)
            q[busy] += step * np.minimum(1.0, LARGEST_STEP / largest)[:, None]
        reached = np.ones(len(q), dtype=bool)
        reached[busy] = False
        return q, measure, reached


def _place_statement(origin: Floats, orientation: Floats) -> str:
    """A `pose` line, to a tenth of a millimetre; plain where the drawing is not turned."""
    at = ", ".join(f"{x:.4f}" for x in np.round(origin, 4) + 0.0)
    angles = np.degrees(roll_pitch_yaw(dq.matrix_from_quaternion(orientation)))
    turned = ", ".join(f"{angle:.10g} deg" for angle in np.round(angles, 9) + 0.0)
    return f"place at ({at}) m turned rpy({turned})"


def _no_placement_error(
    program: Program, kinematics: Kinematics, motion: Motion, settings: Settings
) -> ScriptError:
    """The error, with suggestions that were tried."""
    assert isinstance(program.placement, AutoPlacement)
    box = " x ".join(f"{side * 1e3:.0f}" for side in motion.box)
    held = straight(motion)
    fits = (s for s in TRIED_SCALES if can_be_placed(scaled(motion, s), kinematics, settings))
    said = [f"make it smaller: with scale {scale:g} ... end" for scale in islice(fits, 1)]
    if held is not None and can_be_placed(held, kinematics, settings):
        said.append("hold the tool straight: without 'tool' there is room")
    problem = Diagnostic(
        "E313",
        f"nowhere in the reach of {kinematics.card.name} is there room for this drawing ({box} mm)",
        program.placement.span,
        help="; or ".join(said) or "make it much smaller, or take a larger arm",
    )
    return ScriptError(program.name, program.text, (problem,))
