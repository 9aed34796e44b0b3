"""Lines of a drawing -> the same lines, joined where they touch and ordered for short moves.

Joined are ends of one colour that touch, those that go straight on first. Then each line is
followed by the one whose nearer end is nearest, and local search makes that shorter.
"""

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dqpaint.language.imports.shorter_order import shorter
from dqpaint.program import Colour, Floats, PiecewiseCurve, piecewise

ColouredCurve = tuple[PiecewiseCurve, Colour | None]

TOUCHING = 1e-5  # of the size of the drawing
SAME = 1e-12  # [m]
MOST_SEARCHED = 50_000  # lines, up to which a shorter order is sought
RINGS = 6  # of cells that are searched before all lines are


class OrderedLines(NamedTuple):
    """Lines, and the length of the dark ways between them, in their own unit."""

    lines: list[ColouredCurve]
    dark: float


def as_drawn(lines: list[ColouredCurve]) -> OrderedLines:
    """The lines as they are."""
    ends = piecewise.all_ends([curve for curve, _ in lines])
    return OrderedLines(lines, _dark(ends, np.arange(len(lines)), np.zeros(len(lines), dtype=bool)))


def order_lines(lines: list[ColouredCurve]) -> OrderedLines:
    """The same lines, joined and in an order whose dark ways are no longer than before."""
    return as_drawn(_routed(_merged(lines)))


# Joined.


def _merged(lines: list[ColouredCurve]) -> list[ColouredCurve]:
    """The lines, with those whose ends touch joined to one."""
    ends = piecewise.all_ends([curve for curve, _ in lines])
    tolerance = max(TOUCHING * float(np.ptp(ends.reshape(-1, 3), axis=0).max()), SAME)
    ends_at: dict[tuple[object, ...], list[tuple[int, int]]] = defaultdict(list)
    for number, knots in enumerate(_knots(ends, tolerance)):
        if knots[0] != knots[1]:  # a closed line has no ends
            for side in (0, 1):
                ends_at[(lines[number][1], knots[side])].append((number, side))
    directions = piecewise.directions([curve for curve, _ in lines])
    partner: dict[tuple[int, int], tuple[int, int]] = {}
    for meeting in ends_at.values():
        for one, other in _pairs(meeting, directions):
            partner[one], partner[other] = other, one
    return _strung(lines, partner)


def _knots(ends: Floats, tolerance: float) -> list[tuple[int, int]]:
    """A number for the position of each end; ends that touch share one."""
    cells: dict[tuple[int, int], list[int]] = defaultdict(list)
    flat = ends.reshape(-1, 3)[:, :2]
    spots = flat.tolist()
    around = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    knots: list[int] = []
    for number, (x, y) in enumerate(np.floor(flat / tolerance).astype(np.int64).tolist()):
        near = (k for i, j in around for k in cells.get((x + i, y + j), ()))
        here = spots[number]
        same = next((k for k in near if math.dist(spots[k], here) <= tolerance), number)
        if same == number:
            cells[x, y].append(number)
        knots.append(same)
    return list(zip(knots[::2], knots[1::2], strict=True))


def _pairs(
    meeting: list[tuple[int, int]], directions: Floats
) -> list[tuple[tuple[int, int], tuple[int, int]]]:
    """The pairs of meeting ends that are joined: the straightest first."""
    meeting = meeting[:16]
    choices = sorted(
        (float(directions[a] @ directions[b]), a, b)
        for i, a in enumerate(meeting)
        for b in meeting[i + 1 :]
        if a[0] != b[0]
    )
    taken: set[tuple[int, int]] = set()
    out = []
    for _, a, b in choices:
        if a not in taken and b not in taken:
            taken |= {a, b}
            out.append((a, b))
    return out


def _strung(
    lines: list[ColouredCurve], partner: dict[tuple[int, int], tuple[int, int]]
) -> list[ColouredCurve]:
    """Joins lines by following the partners of their ends."""
    out: list[ColouredCurve] = []
    done: set[int] = set()
    for number in range(len(lines)):
        if number in done:
            continue
        first, side = number, 0  # back to where this string begins
        while (first, side) in partner:
            first, side = partner[first, side]
            side = 1 - side
            if first == number:
                break
        parts: list[PiecewiseCurve] = []
        at: tuple[int, int] | None = (first, side)
        while at is not None and at[0] not in done:
            line, entry = at
            done.add(line)
            curve = lines[line][0]
            parts.append(curve if entry == 0 else piecewise.reverse(curve))
            at = partner.get((line, 1 - entry))
        out.append((piecewise.join(parts), lines[number][1]))
    return out


# Ordered.


def _routed(lines: list[ColouredCurve]) -> list[ColouredCurve]:
    ends = piecewise.all_ends([curve for curve, _ in lines])
    order, flipped = _nearest(ends)
    if len(lines) <= MOST_SEARCHED:
        better = shorter(ends, order.tolist(), flipped.tolist())
        order, flipped = np.array(better[0]), np.array(better[1])
    as_given = np.arange(len(lines)), np.zeros(len(lines), dtype=bool)
    if _dark(ends, order, flipped) > _dark(ends, *as_given):
        order, flipped = as_given
    return [
        (piecewise.reverse(lines[i][0]) if back else lines[i][0], lines[i][1])
        for i, back in zip(order.tolist(), flipped.tolist(), strict=True)
    ]


def _placed(
    ends: Floats, order: NDArray[np.int64], flipped: NDArray[np.bool_]
) -> tuple[Floats, Floats]:
    """Starts and stops (N, 3) in an order."""
    back = flipped.astype(np.int64)
    return ends[order, back], ends[order, 1 - back]


def _dark(ends: Floats, order: NDArray[np.int64], flipped: NDArray[np.bool_]) -> float:
    """The length of the moves between the lines."""
    starts, stops = _placed(ends, order, flipped)
    return float(np.linalg.norm(starts[1:] - stops[:-1], axis=1).sum())


def _nearest(ends: Floats) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Nearest-neighbour order of the lines, each reversed if its end is nearer."""
    left = _RemainingEnds(ends)
    order, flipped = [0], [False]
    left.take(0)
    while len(order) < len(ends):
        line, side = left.nearest(ends[order[-1], 0 if flipped[-1] else 1])
        left.take(line)
        order.append(line)
        flipped.append(side == 1)
    return np.array(order), np.array(flipped)


class _RemainingEnds:
    """The ends of the lines not yet drawn, in a grid with about one line per cell."""

    def __init__(self, ends: Floats) -> None:
        self._ends = ends
        self._spots = ends.tolist()
        self._least = ends.reshape(-1, 3).min(axis=0)
        size = np.ptp(ends.reshape(-1, 3)[:, :2], axis=0)
        self._cell = max(float(size.max()) / math.sqrt(len(ends)), SAME)
        self._alive = np.ones(len(ends), dtype=bool)
        self._cells: dict[tuple[int, int], set[tuple[int, int]]] = defaultdict(set)
        self._at = [[self._cell_of(end) for end in pair] for pair in ends[:, :, :2].tolist()]
        for line, pair in enumerate(self._at):
            for side, cell in enumerate(pair):
                self._cells[cell].add((line, side))

    def _cell_of(self, point: Sequence[float]) -> tuple[int, int]:
        x, y = ((point[i] - float(self._least[i])) / self._cell for i in (0, 1))
        return int(x), int(y)

    def take(self, line: int) -> None:
        """Removes a line."""
        self._alive[line] = False
        for side, cell in enumerate(self._at[line]):
            self._cells[cell].discard((line, side))

    def nearest(self, point: Floats) -> tuple[int, int]:
        """The nearest line and which of its ends; searches ring by ring, then all cells."""
        here = point.tolist()
        x, y = self._cell_of(here)
        best, found = math.inf, (-1, -1)
        for ring in range(RINGS):
            for line, side in self._ring(x, y, ring):
                far = math.dist(self._spots[line][side], here)
                if far < best:
                    best, found = far, (line, side)
            if best <= ring * self._cell:
                return found
        (some,) = np.nonzero(self._alive)
        far_all = np.linalg.norm(self._ends[some] - point, axis=2)
        near, side = divmod(int(np.argmin(far_all)), 2)
        return int(some[near]), side

    def _ring(self, x: int, y: int, ring: int) -> Iterator[tuple[int, int]]:
        for i in range(-ring, ring + 1):
            step = 1 if abs(i) == ring else 2 * ring
            for j in range(-ring, ring + 1, step or 1):
                yield from self._cells.get((x + i, y + j), ())
