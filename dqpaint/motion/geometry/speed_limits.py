"""Segments in a row -> stretches of their path, each with the speed that its bends allow.

Across the path the point needs the acceleration kappa v^2, so a bend of radius r lets it go at
sqrt(A r) at the most; the tool's turning is bounded likewise. A stretch is halved until its
curvature is nearly one number. Where the direction of travel jumps, the point stops.
"""

from dataclasses import dataclass

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.motion.geometry.batched_shapes import Flags, Shapes
from dqpaint.motion.geometry.paths import Indices
from dqpaint.motion.geometry.piecewise_paths import Pieces
from dqpaint.motion.geometry.shapes import PositionAndOrientation
from dqpaint.motion.look_ahead import Stretches
from dqpaint.motion.stroke_errors import Faults
from dqpaint.program import CruiseSpeed

ARM = 0.1  # [m] turns an acceleration into one of the tool's turning: 2 m/s^2 are 20 rad/s^2
STOP_ANGLE = 1e-3  # [rad]: a larger turn of the direction is a corner
BRINK, NEAREST = 1e-6, 1e-14  # of a stretch, of its segment: how far inside it is looked at
SHORTEST = 1e-9  # [m]: no stretch is halved below it
ALIKE = 1.3  # limits of a stretch that differ by less are one
MOST_HALVINGS = 14
PARTS = 24  # of a segment that is neither straight nor an arc nor a piecewise curve
AT_ONCE = 8_192  # stretches
LEAST, LARGEST = 1e-10, 1e30  # [m^2/s^2]: at a point of a curve; no limit


@dataclass(frozen=True)
class _Ends:
    """Tangents (K, 2, 3) just inside both ends of stretches, and turning [rad/m] (K, 2, 3)."""

    tangent: Floats
    turn: Floats

    def rows(self, rows: Indices | Flags) -> "_Ends":
        return _Ends(self.tangent[rows], self.turn[rows])


def stretches_of(
    shapes: Shapes,
    numbers: Indices,
    first: Indices,
    by_length: Flags,
    acceleration: Floats,
    fastest: Floats,
    period: float,
    faults: Faults,
) -> Stretches:
    """The stretches of strokes.

    Args:
        shapes: of the drawing.
        numbers: the segments (M,) of the strokes, in order.
        first: of these (P,), where each stroke begins.
        by_length: which segments of the drawing a fraction of the length leads along.
        acceleration: of the point, by stroke (P,) [m/s^2].
        fastest: speed that no stroke needs to exceed (P,) [m/s].
        period: [s]; within one the turning may change at once.
        faults: gets errors of formulas, by segment.
    """
    stroke_of = np.repeat(np.arange(len(first)), np.diff(first, append=len(numbers)))
    cuts = [_cuts(shapes, number) for number in numbers.tolist()]
    counts = np.array([len(cut) - 1 for cut in cuts])
    at = np.repeat(np.arange(len(numbers)), counts)
    begin = np.concatenate([cut[:-1] for cut in cuts])
    end = np.concatenate([cut[1:] for cut in cuts])
    turnspeed = np.array([
        timing.turnspeed if isinstance(timing := shapes.segments[number].timing, CruiseSpeed)
        else np.inf for number in numbers.tolist()
    ])  # fmt: skip
    done: list[tuple[Indices, Floats, Floats, Floats, Floats, _Ends]] = []
    for halving in range(MOST_HALVINGS + 1):
        limits, gain, ends = _limits(
            shapes, numbers[at], begin, end, by_length,
            acceleration[stroke_of[at]], turnspeed[at], faults,
        )  # fmt: skip
        limits = np.minimum(limits, fastest[stroke_of[at], None] ** 2)
        good = (limits.max(axis=1) <= ALIKE * limits.min(axis=1)) | (halving == MOST_HALVINGS)
        good |= (end - begin) * shapes.length[numbers[at]] < SHORTEST
        done.append((at[good], begin[good], end[good], limits[good].min(1), gain[good],
                     ends.rows(good)))  # fmt: skip
        at, begin, end = at[~good], begin[~good], end[~good]
        if not len(at):
            break
        middle = 0.5 * (begin + end)
        at = np.concatenate([at, at])
        begin, end = np.concatenate([begin, middle]), np.concatenate([middle, end])
    at, begin, end, most, gain = (np.concatenate([part[i] for part in done]) for i in range(5))
    tangent = np.concatenate([part[5].tangent for part in done])
    turn = np.concatenate([part[5].turn for part in done])
    order = np.lexsort((begin, at))
    stroke = stroke_of[at[order]]
    begins = np.searchsorted(stroke, np.arange(len(first)))
    size = ((end - begin) * shapes.length[numbers[at]])[order]
    gate = _gates(tangent[order], turn[order], acceleration[stroke] / ARM * period)
    gate[begins] = 0.0
    return Stretches(begins, size, most[order], gate, gain[order])


def _cuts(shapes: Shapes, number: int) -> Floats:
    """Fractions of a segment's length, from 0 to 1, between which it is smooth."""
    shape = shapes.shape(number)
    if isinstance(shape, PositionAndOrientation) and isinstance(shape.positions, Pieces):
        return shape.positions.cuts()
    if shape.uniform:
        return np.array([0.0, 1.0])
    return np.linspace(0.0, 1.0, PARTS + 1)


def _limits(
    shapes: Shapes,
    number: Indices,
    begin: Floats,
    end: Floats,
    by_length: Flags,
    acceleration: Floats,
    turnspeed: Floats,
    faults: Faults,
) -> tuple[Floats, Floats, _Ends]:
    """Squares of the speeds (K, 3) at both ends and in the middle, accelerations (K,), and ends."""
    limits, gain = np.empty((len(number), 3)), np.empty(len(number))
    tangent, turn = np.empty((len(number), 2, 3)), np.empty((len(number), 2, 3))
    for start in range(0, len(number), AT_ONCE):
        own = slice(start, start + AT_ONCE)
        lower, width = begin[own], (end - begin)[own]
        brink = np.minimum(np.maximum(BRINK * width, NEAREST), 0.25 * width)
        f = np.stack([lower + brink, lower + 0.5 * width, lower + width - brink], axis=1)
        of = np.repeat(number[own], 3)
        with np.errstate(all="ignore"):
            flow = shapes.flow(of, f.ravel(), by_length, faults)
            length = shapes.length[of][:, None]
            point = dq.translation(flow.pose)
            way = dq.point_velocity(flow.twist, point) / length
            bend = dq.point_acceleration(flow.twist, flow.slope, point) / length**2
            t = way / np.linalg.norm(way, axis=1, keepdims=True)
            bend = np.linalg.norm(bend - (bend * t).sum(1, keepdims=True) * t, axis=1)
            w, w_slope = flow.twist[:, :3] / length, flow.slope[:, :3] / length**2
            turning = np.linalg.norm(w, axis=1)
            a, spin = np.repeat(acceleration[own], 3), np.repeat(turnspeed[own], 3)
            found = np.minimum(a / bend, (spin / turning) ** 2)
            found = np.minimum(found, a / ARM / np.linalg.norm(w_slope, axis=1))
            limits[own] = np.clip(np.nan_to_num(found, nan=LARGEST), LEAST, LARGEST).reshape(-1, 3)
            least = np.minimum(a, a / ARM / turning).reshape(-1, 3).min(axis=1)
            gain[own] = np.where(np.isfinite(least), least, acceleration[own])
        tangent[own] = t.reshape(-1, 3, 3)[:, ::2]
        turn[own] = w.reshape(-1, 3, 3)[:, ::2]
    return limits, gain, _Ends(tangent, turn)


def _gates(tangent: Floats, turn: Floats, jump: Floats) -> Floats:
    """Squares of the speeds (K,) at which the point may enter stretches from those before.

    `jump` [rad/s] (K,) is how much the tool's turning may change at once.
    """
    corner = np.linalg.norm(tangent[1:, 0] - tangent[:-1, 1], axis=1) > STOP_ANGLE
    change = np.linalg.norm(turn[1:, 0] - turn[:-1, 1], axis=1)
    with np.errstate(divide="ignore", over="ignore"):
        gate = np.minimum((jump[1:] / change) ** 2, LARGEST)
    return np.concatenate([[0.0], np.where(corner, 0.0, gate)])
