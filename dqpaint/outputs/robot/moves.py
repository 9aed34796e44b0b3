"""A painting -> its geometry as moves of a robot's controller: lines, arcs, waits, light by path.

What is timed keeps the law's clock; this keeps the shapes. A controller has a speed profile of its
own, so the light is switched where the tool is, not when.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.outputs.registry import Need
from dqpaint.outputs.robot.trajectory import Trajectory, kinematics_of, trajectory_of
from dqpaint.program import (
    Arc,
    Dwell,
    FixedOrientation,
    FollowHeading,
    Segment,
    SlerpOrientation,
    Step,
    Straight,
)

if TYPE_CHECKING:
    from dqpaint.painting import paint

TOLERANCE = 1e-4  # [m] between a curve and its lines
TURN_TOLERANCE = np.radians(0.5)
CYCLE = 0.012  # [s] in which a controller thinks once
SHORTEST_ARC = 5e-4  # [m] between two of an arc's points
WIDEST = np.pi / 2  # of one arc: a full circle's ends are one point
FASTEST = 2.0  # [m/s]
SINGULAR = np.radians(5.0)  # between the axes 4 and 6
CORNER = np.radians(15.0)  # between two rows
COLOURS = 32  # steps of brightness that are told apart
DIGITS = 5  # of a colour
AXES = 6


@dataclass(frozen=True)
class Move:
    """One instruction: a line or an arc to a pose, or a wait.

    Attributes:
        end: the pose (8,) in the base frame.
        via: the point (3,) [m] half way along an arc; None on a line.
        speed: of the point [m/s].
        turn: of the tool [rad/s].
        colour: linear RGB (3,) from its beginning on.
        passing: whether the next one goes on without a stop.
        wait: [s] instead of a way.
        line: of the drawing.
    """

    end: Floats
    via: Floats | None
    speed: float
    turn: float
    colour: tuple[float, ...]
    passing: bool
    wait: float
    line: str


@dataclass(frozen=True)
class Moves:
    """The moves of a drawing.

    Attributes:
        trajectory: of the run that found them within the arm's limits.
        tool: the light's pose (8,) on the link that carries it.
        link: that link.
        start: the first pose (8,).
        moves: in order.
        about: lines that describe the file, the first says what it is.
    """

    trajectory: Trajectory
    tool: Floats
    link: str
    start: Floats
    moves: tuple[Move, ...]
    about: tuple[str, ...]


def check_geometric(run: "paint.PreparedRun | paint.Painting") -> None:
    """Refuse what has no path that a controller of six axes can follow by itself."""
    kinematics, motion = kinematics_of(run), run.motion
    if kinematics.card.joints != AXES:
        raise UsageError(
            f"this program has poses alone, which an arm of {AXES} axes can take in few ways; "
            f"{kinematics.card.name} has {kinematics.card.joints}, so its elbow would be left to "
            "chance: csv and ros2 have its joints"
        )
    for segment in motion.program.segments:
        name = motion.program.line_name(segment.line)
        if isinstance(segment.path, Step):
            raise UsageError(f"line {name}: a step jumps, and no move of an arm does: use csv")
        if segment.strobe is not None:
            raise UsageError(f"line {name}: a strobe flashes by the clock, not along the path")


def check_wrist(painting: "paint.Painting") -> None:
    """Refuse a run in which the axes 4 and 6 come to lie along each other."""
    motion = painting.motion
    _, J = kinematics_of(painting).poses_and_jacobians(painting.track.posture)
    fourth, sixth = J[:, :3, 3], J[:, :3, 5]
    angle = np.arcsin(np.clip(np.linalg.norm(np.cross(fourth, sixth), axis=1), 0, 1))
    row = int(angle.argmin())
    if angle[row] < SINGULAR:
        raise DqpaintError(
            f"line {motion.program.line_name(motion.source.at(row))}: the axes 4 and 6 are "
            f"{np.degrees(angle[row]):.2g} deg from parallel at {motion.t[row]:.3f} s, less than "
            f"{np.degrees(SINGULAR):g}: a controller that goes there along a line must turn one of "
            "them at once. Place the drawing elsewhere, or tilt the tool"
        )


GEOMETRIC = (
    Need(f"an arm of {AXES} axes, no step or strobe", check_geometric, before=True),
    Need("a wrist that is not singular", check_wrist),
)


def moves_of(painting: "paint.Painting") -> Moves:
    """The moves of a painting's drawing.

    Raises:
        DqpaintError: a line or an arc that controllers do not take; the drawing's line is named.
    """
    motion, trajectory = painting.motion, trajectory_of(painting)
    kinematics = kinematics_of(painting)
    made = tuple(move for stroke in range(len(motion.program.segments))
                 for move in _Stroke(painting, stroke).moves())  # fmt: skip
    posture = ", ".join(f"{angle:.3f}" for angle in np.degrees(trajectory.positions[0]).tolist())
    arcs = sum(move.via is not None for move in made)
    about = (
        "Geometric, not timed: lines and arcs at the controller's own speeds, light by path. "
        "Never run on a controller.",
        trajectory.about[0],
        *trajectory.about[2:-1],
        f"{len(made)} moves, {arcs} of them arcs; curves are lines within "
        f"{TOLERANCE * 1e3:g} mm. Speeds are the largest of each of the drawing's lines; where the "
        "controller slows down the line is brighter.",
        f"Begin near the first pose, in this posture of {painting.robot} [deg]: {posture}; the "
        "zeros and signs of your arm's axes may differ.",
    )
    card = kinematics.card
    start = motion.pose[0]
    return Moves(trajectory, card.tool.pose, card.link, start, made, about)


class _Stroke:
    """One segment of a painting's drawing, as moves."""

    def __init__(self, painting: "paint.Painting", number: int) -> None:
        motion = painting.motion
        self.segments, self.number = motion.program.segments, number
        self.segment: Segment = self.segments[number]
        self.name = motion.program.line_name(self.segment.line)
        rows = np.flatnonzero(motion.stroke[:-1] == number)
        self.count = len(rows)
        span = slice(rows[0], rows[-1] + 2) if self.count else slice(0, 0)
        self.period = motion.period
        self.pose = np.array(motion.pose[span])
        if self.count:
            self.pose[0] = _placed(motion.canvas, self.segment.start, self.pose[0])
            self.pose[-1] = _placed(motion.canvas, self.segment.end, self.pose[-1])
        self.points = dq.translation(self.pose)
        self.light = motion.light[rows]
        self.canvas = motion.canvas

    def moves(self) -> Iterator[Move]:
        """Its moves, a new one wherever the colour changes."""
        if not self.count:
            return
        shades = np.round(self.light * COLOURS)
        cuts = np.flatnonzero((np.diff(shades, axis=0) != 0).any(axis=1)) + 1
        edges = [0, *cuts.tolist(), self.count]
        speeds = np.linalg.norm(np.diff(self.points, axis=0), axis=1) / self.period
        turns = dq.log(dq.mul(self.pose[1:], dq.conj(self.pose[:-1])))[:, :3]
        self.speed = float(speeds.max())
        self.turn = float(2 * np.linalg.norm(turns, axis=1).max() / self.period)
        if self.speed > FASTEST:
            raise DqpaintError(f"line {self.name}: {self.speed:.3g} m/s is faster than the "
                               f"{FASTEST:g} m/s that controllers take")  # fmt: skip
        for first, last in pairwise(edges):
            self.colour = tuple(np.round(self.light[first:last].mean(axis=0), DIGITS).tolist())
            yield from self._held(first, last)

    def _held(self, first: int, last: int) -> Iterator[Move]:
        """The moves of the rows from first to last, which have one colour."""
        path, tool = self.segment.path, self.segment.tool
        if isinstance(path, Dwell):
            yield self._move(self.pose[last], None, last, (last - first) * self.period)
            return
        whole = isinstance(path, Straight) and isinstance(tool, FixedOrientation | SlerpOrientation)
        if whole:
            yield self._move(self.pose[last], None, last)
        elif isinstance(path, Arc) and self._is_flat(path) and self._turns_along(path):
            yield from self._arcs(path, first, last)
        else:
            ends = self._chords(first, last)
            for end in ends:
                yield self._move(self.pose[end], None, end)

    def _move(self, end: Floats, via: Floats | None, row: int, wait: float = 0.0) -> Move:
        stroke = self.segment.stroke
        follower = self.segments[self.number + 1] if self.number + 1 < len(self.segments) else None
        joined = stroke is not None and follower is not None and follower.stroke == stroke
        passing = (row < self.count or joined) and not wait
        return Move(end, via, self.speed, self.turn, self.colour, passing, wait, self.name)

    @staticmethod
    def _is_flat(path: Arc) -> bool:
        return path.rise == 0.0 and path.grow == 0.0

    def _turns_along(self, path: Arc) -> bool:
        """Whether the tool is held, or turns with the arc about its axis."""
        tool = self.segment.tool
        if isinstance(tool, FollowHeading):
            return bool(np.allclose(np.cross(tool.axis, path.axis), 0.0, atol=1e-9))
        return isinstance(tool, FixedOrientation)

    def _arcs(self, path: Arc, first: int, last: int) -> Iterator[Move]:
        """Arcs of at most a quarter turn; three points of each are apart."""
        axis = dq.rotate(dq.rotation(self.canvas), np.asarray(path.axis))
        centre = dq.translation(dq.mul(self.canvas, dq.pose_from(path.centre, [1.0, 0, 0, 0])))
        arm = self.points - centre
        arm = arm - np.outer(arm @ axis, axis)
        sines = np.cross(arm[0], arm) @ axis
        angle = np.unwrap(np.arctan2(sines, arm @ arm[0]))
        begin, end = float(angle[first]), float(angle[last])
        count = max(1, int(np.ceil(abs(end - begin) / WIDEST - 1e-9)))
        radius = float(np.linalg.norm(arm[0]))
        apart = radius * abs(end - begin) / count / 2
        if apart < SHORTEST_ARC:
            raise DqpaintError(
                f"line {self.name}: an arc's points would be {apart * 1e3:.2g} mm apart, and "
                f"controllers take points nearer than {SHORTEST_ARC * 1e3:g} mm for one; draw it "
                "larger, with fewer shades, or as a dot"
            )
        held = isinstance(self.segment.tool, FixedOrientation)
        for k in range(count):
            half, full = (begin + (end - begin) * (k + part) / count for part in (0.5, 1.0))
            turned = dq.mul(_about(axis, centre, full), self.pose[0])
            at = dq.translation(turned)
            pose = dq.pose_from(at, dq.rotation(self.pose[0] if held else turned))
            via = dq.translation(dq.mul(_about(axis, centre, half), self.pose[0]))
            yield self._move(pose, via, last if k == count - 1 else 0)

    def _chords(self, first: int, last: int) -> list[int]:
        """The rows at which lines along a curve end: as few as keep to it."""
        way = np.diff(self.points[first : last + 1], axis=0)
        length = np.linalg.norm(way, axis=1)
        turned = np.einsum("ij,ij->i", way[1:], way[:-1])
        sharp = turned < np.cos(CORNER) * length[1:] * length[:-1]
        corners = [first, *(first + 1 + np.flatnonzero(sharp)).tolist(), last]
        ends: list[int] = []
        for begin, end in pairwise(corners):
            ends += self._evenly(begin, end)
        walked = np.append(0.0, np.cumsum(length))
        each = np.diff(walked[np.array([first, *ends]) - first])
        if len(ends) > 1 and each.min() < self.speed * CYCLE:
            shortest = float(each.min())
            raise DqpaintError(
                f"line {self.name}: of the lines within {TOLERANCE * 1e3:g} mm of it one is "
                f"{shortest * 1e3:.2g} mm long, {shortest / self.speed * 1e3:.2g} ms at its speed, "
                f"and a controller takes one in {CYCLE * 1e3:g} ms: draw it slower, or larger"
            )
        return ends

    def _evenly(self, begin: int, end: int) -> list[int]:
        """Rows from begin to end, as evenly apart as they come, within the tolerance."""
        steps = np.linalg.norm(np.diff(self.points[begin : end + 1], axis=0), axis=1)
        walked = np.append(0.0, np.cumsum(steps))
        count = 1
        while True:
            marks = np.searchsorted(walked, walked[-1] * np.arange(count + 1) / count - 1e-12)
            rows = np.unique(np.append(begin + marks, end))
            if self._keeps(rows) or len(rows) > end - begin:
                break
            count += max(1, count // 5)
        return [int(row) for row in rows[1:]]

    def _keeps(self, rows: Floats) -> bool:
        """Whether lines between some rows, on which the tool turns evenly, keep to the curve."""
        for a, b in zip(rows[:-1].tolist(), rows[1:].tolist(), strict=True):
            inner = self.points[a : b + 1] - self.points[a]
            way = inner[-1]
            share = np.clip(inner @ way / max(way @ way, 1e-30), 0.0, 1.0)
            if np.linalg.norm(inner - np.outer(share, way), axis=1).max() > TOLERANCE:
                return False
            between = dq.sclerp(self.pose[a : a + 1], self.pose[b : b + 1], share)
            off = dq.log(dq.mul(self.pose[a : b + 1], dq.conj(between)))[:, :3]
            if 2 * np.linalg.norm(off, axis=1).max() > TURN_TOLERANCE:
                return False
        return True


def _placed(
    canvas: Floats, pose: tuple[tuple[float, ...], tuple[float, ...]], near: Floats
) -> Floats:
    """A pose of the drawing in the base frame (8,), on the side of another."""
    return dq.nearest(dq.mul(canvas, dq.pose_from(*pose)), near)


def _about(axis: Floats, centre: Floats, angle: float) -> Floats:
    """The rotation (8,) by an angle about an axis through a point."""
    return dq.exp(0.5 * angle * dq.twist_from_screw(axis, centre))
