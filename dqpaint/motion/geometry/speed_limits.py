"""Segments in a row -> stretches of their path, each with the speed that its bends allow.

Across the path the point needs the acceleration kappa v^2, so a bend of radius r lets it go at
sqrt(A r) at the most; the tool's turning is bounded likewise. A stretch is halved until nowhere in
it the point could be much faster than the least of that: its curvature is nearly one number, or it
is too short to gain speed on. Where the direction of travel jumps, the point stops.
"""

from dataclasses import dataclass

import numpy as np

from dqpaint.dq import Floats
from dqpaint.motion.geometry.batched_shapes import Flags, Shapes, group_equal
from dqpaint.motion.geometry.paths import Indices
from dqpaint.motion.geometry.shapes import Bends
from dqpaint.motion.look_ahead import Stretches
from dqpaint.program import CruiseSpeed

ARM = 0.1  # [m] turns an acceleration into one of the tool's turning: 2 m/s^2 are 20 rad/s^2
STOP_ANGLE = 1e-3  # [rad]: a larger turn of the direction is a corner
BRINK, NEAREST = 1e-6, 1e-14  # of a stretch, of its segment: how far inside it is looked at
SHORTEST = 1e-9  # [m]: no stretch is halved below it
ALIKE = 1.3  # limits of a stretch that differ by less are one
MOST_HALVINGS = 14
PARTS = 24  # of a segment that is neither straight nor an arc nor a piecewise curve
AT_ONCE = 8_192  # stretches, before they are halved
LEAST, LARGEST = 1e-10, 1e30  # [m^2/s^2]: at a point of a curve; no limit


@dataclass(frozen=True)
class _Spans:
    """Smooth spans (K) of segments.

    Attributes:
        row: which of the segments of the strokes (K,).
        piece: of a piecewise curve; 0 for any other segment (K,).
        begin: of the piece's parameter, or of the fraction of the segment's length (K,).
        end: and where it ends (K,).
    """

    row: Indices
    piece: Indices
    begin: Floats
    end: Floats

    def rows(self, rows: Indices | Flags | slice) -> "_Spans":
        return _Spans(self.row[rows], self.piece[rows], self.begin[rows], self.end[rows])

    def parted(self, parts: int) -> "_Spans":
        """Each in equal parts."""
        row, piece = np.repeat(self.row, parts), np.repeat(self.piece, parts)
        share = np.linspace(0.0, 1.0, parts + 1)
        edges = self.begin[:, None] + (self.end - self.begin)[:, None] * share
        edges[:, -1] = self.end
        return _Spans(row, piece, edges[:, :-1].ravel(), edges[:, 1:].ravel())


def _joined(spans: list[_Spans]) -> _Spans:
    names = ("row", "piece", "begin", "end")
    return _Spans(*(np.concatenate([getattr(part, name) for part in spans]) for name in names))


@dataclass(frozen=True)
class _Segments:
    """The segments (M) of strokes, as in `stretches_of`, and what holds for each."""

    shapes: Shapes
    number: Indices
    by_length: Flags
    acceleration: Floats
    turnspeed: Floats
    fastest: Floats

    def spans(self) -> _Spans:
        """Their smooth parts, in order."""
        found = []
        of = self.shapes.member[self.number]
        for family, rows in group_equal(self.shapes.family[self.number]):
            row = np.arange(len(of))[rows]
            pieces = self.shapes.pieces(family)
            if pieces:
                which, panel = pieces.select(of[row]).panels_of_rows()
                own = pieces.panels
                part = _Spans(row[which], own.piece[panel], own.lower[panel], own.upper[panel])
                bent = own.bent[part.piece]
                found += [part.rows(~bent), part.rows(bent).parted(2)]
            else:
                whole = _Spans(row, np.zeros_like(row), np.zeros(len(row)), np.ones(len(row)))
                found.append(whole.parted(1 if self.shapes.families[family].uniform else PARTS))
        spans = _joined(found)
        return spans.rows(np.lexsort((spans.begin, spans.piece, spans.row)))

    def look(self, row: Indices, piece: Indices, g: Floats) -> tuple[Bends, Floats, Floats]:
        """What is at places (N,), the squares of speeds they allow, and the accelerations."""
        acceleration, turnspeed = self.acceleration[row], self.turnspeed[row]
        with np.errstate(all="ignore"):
            seen = self.shapes.bends(self.number[row], piece, g, self.by_length)
            bend, turning, slope = (
                np.sqrt((a * a).sum(1)) for a in (seen.curvature, seen.turn, seen.turn_slope)
            )
            square = np.minimum(acceleration / bend, (turnspeed / turning) ** 2)
            square = np.minimum(square, acceleration / ARM / slope)
            along = np.minimum(acceleration, acceleration / ARM / turning)
        square = np.clip(np.nan_to_num(square, nan=LARGEST), LEAST, self.fastest[row] ** 2)
        return seen, square, np.where(np.isfinite(along), along, acceleration)

    def sizes(self, spans: _Spans) -> Floats:
        """The lengths of spans (K,) [m]."""
        out = np.empty(len(spans.row))
        for family, rows in group_equal(self.shapes.family[self.number[spans.row]]):
            own = spans.rows(rows)
            pieces = self.shapes.pieces(family)
            if pieces:
                out[rows] = pieces.lengths_between(own.piece, own.begin, own.end)
            else:
                out[rows] = (own.end - own.begin) * self.shapes.length[self.number[own.row]]
        return out


def stretches_of(
    shapes: Shapes,
    numbers: Indices,
    first: Indices,
    by_length: Flags,
    acceleration: Floats,
    fastest: Floats,
    period: float,
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
    """
    stroke_of = np.repeat(np.arange(len(first)), np.diff(first, append=len(numbers)))
    turnspeed = np.array([
        timing.turnspeed if isinstance(timing := shapes.segments[number].timing, CruiseSpeed)
        else np.inf for number in numbers.tolist()
    ])  # fmt: skip
    segments = _Segments(
        *(shapes, numbers, by_length, acceleration[stroke_of], turnspeed, fastest[stroke_of])
    )
    spans = segments.spans()
    parts = []
    before = np.full((2, 1, 3), np.nan)  # tangent and turning where the span before ends
    for start in range(0, len(spans.row), AT_ONCE):
        row, *values, before = _stretches(
            segments, spans.rows(slice(start, start + AT_ONCE)), period, before
        )
        parts.append((stroke_of[row], *values))
    stroke, size, most, gate, gain = (np.concatenate(part) for part in zip(*parts, strict=True))
    begins = np.searchsorted(stroke, np.arange(len(first)))
    gate[begins] = 0.0
    return Stretches(begins, size, most, gate, gain)


def _stretches(
    segments: _Segments, spans: _Spans, period: float, before: Floats
) -> tuple[Indices, Floats, Floats, Floats, Floats, Floats]:
    """Segment, size, and limits as in `Stretches`, of what is left of spans after halving."""
    count, width = len(spans.row), spans.end - spans.begin
    brink = np.minimum(np.maximum(BRINK * width, NEAREST), 0.25 * width)
    places = np.stack([spans.begin + brink, spans.begin + 0.5 * width, spans.end - brink], axis=1)
    seen, square, along = segments.look(
        np.repeat(spans.row, 3), np.repeat(spans.piece, 3), places.ravel()
    )
    ends = np.stack([seen.tangent, seen.turn]).reshape(2, count, 3, 3)
    acceleration = segments.acceleration[spans.row]
    entered = np.concatenate([before, ends[:, :-1, 2]], axis=1)
    gate = _gates(ends[:, :, 0], entered, acceleration / ARM * period)
    own = np.arange(count)
    point, square, along = seen.point.reshape(-1, 3, 3), square.reshape(-1, 3), along.reshape(-1, 3)
    done = []
    for halving in range(MOST_HALVINGS + 1):
        good = _even(point, square, along.min(axis=1)) | (halving == MOST_HALVINGS)
        done.append((own[good], spans.rows(good), square[good].min(1), along[good].min(1)))
        own, spans = own[~good], spans.rows(~good)
        if not len(own):
            break
        spans = spans.parted(2)
        middle = 0.5 * (spans.begin + spans.end)
        seen, *more = segments.look(spans.row, spans.piece, middle)
        point = _halves(point[~good], seen.point.reshape(-1, 2, 3))
        square, along = (
            _halves(old[~good], new.reshape(-1, 2))
            for old, new in zip((square, along), more, strict=True)
        )
        own = np.repeat(own, 2)
    own, most, gain = (np.concatenate([part[i] for part in done]) for i in (0, 2, 3))
    spans = _joined([part[1] for part in done])
    order = np.lexsort((spans.begin, own))
    own, spans = own[order], spans.rows(order)
    inner = np.concatenate([[False], own[1:] == own[:-1]])
    gates = np.where(inner, LARGEST, gate[own])
    return spans.row, segments.sizes(spans), most[order], gates, gain[order], ends[:, -1:, 2]


def _halves(values: Floats, between: Floats) -> Floats:
    """Values at both ends and the middle of spans (K, 3, ...) -> of their halves (2 K, 3, ...).

    `between` (K, 2, ...) are those in the middle of each half.
    """
    a, b, c = (values[:, i] for i in range(3))
    halves = np.stack([a, between[:, 0], b, b, between[:, 1], c], axis=1)
    return halves.reshape(-1, *values.shape[1:])


def _even(point: Floats, square: Floats, gain: Floats) -> Flags:
    """Whether the point can hardly be faster than the least limit anywhere in spans (K,).

    Args:
        point: at both ends and in the middle (K, 3, 3) [m].
        square: of the speeds allowed there (K, 3).
        gain: the acceleration along each (K,).
    """
    way = np.diff(point, axis=1)
    first, second = np.sqrt((way * way).sum(2)).T
    a, b, c = square.T
    up, on = 2.0 * gain * first, 2.0 * gain * second
    reached = np.stack([
        np.minimum(a, np.minimum(b, c + on) + up),
        np.minimum(b, np.minimum(a + up, c + on)),
        np.minimum(c, np.minimum(b, a + up) + on),
    ])  # fmt: skip
    alike = reached.max(axis=0) <= ALIKE * square.min(axis=1)
    return np.asarray(alike | (first + second < SHORTEST))


def _gates(begin: Floats, before: Floats, jump: Floats) -> Floats:
    """Squares of the speeds (K,) at which the point may enter spans from those before.

    Args:
        begin: tangent and turning [rad/m] where each begins (2, K, 3).
        before: and where the one before it ends (2, K, 3).
        jump: how much the tool's turning may change at once (K,) [rad/s].
    """
    turned, change = np.linalg.norm(begin - before, axis=2)
    with np.errstate(divide="ignore", over="ignore"):
        gate = np.minimum((jump / change) ** 2, LARGEST)
    return np.where(turned > STOP_ANGLE, 0.0, gate)
