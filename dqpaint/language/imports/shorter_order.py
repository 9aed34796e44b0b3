"""An order of lines -> a shorter one, by local search: 2-opt and Or-opt over nearest ends.

2-opt reverses a stretch of the order, Or-opt moves up to three lines elsewhere, reversed where that
is shorter (Lin, Computer solutions of the traveling salesman problem, 1965; Or, 1976). Only ends
that are nearest to each other are tried, and only next to what has changed, as in Bentley, Fast
algorithms for geometric traveling salesman problems, 1992. The first line stays where it is.
"""

import math
from collections import deque
from itertools import pairwise

import numpy as np

from dqpaint.program import Floats

NEAR = 10  # ends next to one that are tried
LONGEST_MOVED = 3  # lines
GAIN = 1e-9  # of the first way: a smaller gain is none
MOST_WORK = 15_000_000  # lines that are turned round or moved, in all: about two seconds
FEW = 300  # lines: for fewer of them all distances are worked out


def shorter(ends: Floats, order: list[int], flipped: list[bool]) -> tuple[list[int], list[bool]]:
    """An order with shorter ways between lines.

    Args:
        ends: of the lines (N, 2, 3).
        order: which line comes when.
        flipped: whether it is drawn from its second end.

    Returns:
        The same for the order that was found; the first line is the same, drawn the same way.
    """
    if len(order) < 3:
        return order, flipped
    search = _Search(ends, [2 * line + back for line, back in zip(order, flipped, strict=True)])
    search.run()
    return [end >> 1 for end in search.tour], [bool(end & 1) for end in search.tour]


def _neighbours(points: Floats) -> list[list[int]]:
    """The nearest points of each (2N), without those of its own line."""
    count = min(NEAR + 2, len(points))
    if len(points) <= 2 * FEW:
        far = np.linalg.norm(points[:, None] - points[None], axis=2)
        found = np.argsort(far, axis=1, kind="stable")[:, :count]
    else:
        from scipy.spatial import cKDTree  # slow to import

        found = cKDTree(points).query(points, count)[1]
    return [[p for p in row if p >> 1 != own >> 1] for own, row in enumerate(found.tolist())]


class _Search:
    """A tour of line ends: 2 line + side is a line that begins at that side."""

    def __init__(self, ends: Floats, tour: list[int]) -> None:
        flat = ends.reshape(-1, 3)
        self.tour = tour
        self._points = flat.tolist()
        self._near = _neighbours(flat)
        self._at = [0] * len(tour)
        for place, end in enumerate(tour):
            self._at[end >> 1] = place
        self._work = 0
        ways = sum(self._far(a ^ 1, b) for a, b in pairwise(tour))
        self._least = GAIN * ways

    def run(self) -> None:
        """Changes the tour until nothing that is tried makes it shorter."""
        waiting = deque(end >> 1 for end in self.tour[1:])
        asleep = [False] * len(self.tour)
        while waiting and self._work < MOST_WORK:
            line = waiting.popleft()
            asleep[line] = True
            while touched := self._improve(self._at[line]):
                for other in touched:
                    if asleep[other]:
                        asleep[other] = False
                        waiting.append(other)

    def _far(self, a: int, b: int) -> float:
        return math.dist(self._points[a], self._points[b])

    def _improve(self, i: int) -> list[int]:
        """Makes the ways at place i > 0 shorter; the lines next to changed ways, if any."""
        if i == 0:
            return []
        tour, last = self.tour, len(self.tour) - 1
        into, first = tour[i - 1] ^ 1, tour[i]
        now = self._far(into, first)
        if now - self._far(into, tour[last] ^ 1) > self._least:  # the end is free
            return self._reverse(i, last)
        for end in self._near[into]:
            gain = now - self._far(into, end)
            if gain <= self._least:
                break
            k = self._at[end >> 1]
            if tour[k] == end ^ 1:  # it ends there
                low, high = (i, k) if k >= i else (k + 1, i - 1)
                if 0 < low < high + 1 and self._reversed_gain(low, high) > self._least:
                    return self._reverse(low, high)
            if k and (moved := self._move(i, k, end, gain)):
                return moved
        for end in self._near[first]:
            gain = now - self._far(first, end)
            if gain <= self._least:
                break
            k = self._at[end >> 1]
            if tour[k] == end:
                low, high = (k, i - 1) if k < i else (i, k - 1)
                if low > 0 and self._reversed_gain(low, high) > self._least:
                    return self._reverse(low, high)
        return []

    def _reversed_gain(self, low: int, high: int) -> float:
        """What reversing a stretch of the tour saves."""
        tour = self.tour
        into, begin, end = tour[low - 1] ^ 1, tour[low], tour[high] ^ 1
        gain = self._far(into, begin) - self._far(into, end)
        if high + 1 < len(tour):
            gain += self._far(end, tour[high + 1]) - self._far(begin, tour[high + 1])
        return gain

    def _reverse(self, low: int, high: int) -> list[int]:
        tour = self.tour
        tour[low : high + 1] = [end ^ 1 for end in reversed(tour[low : high + 1])]
        self._renumber(low, high)
        edge = (low - 1, low, high, min(high + 1, len(tour) - 1))
        return [tour[place] >> 1 for place in edge]

    def _renumber(self, low: int, high: int) -> None:
        self._work += high - low + 1
        for place in range(low, high + 1):
            self._at[self.tour[place] >> 1] = place

    def _move(self, i: int, k: int, end: int, gain: float) -> list[int]:
        """Moves a few lines, that which begins or ends at `end` first, before place i."""
        tour, last = self.tour, len(self.tour) - 1
        forward = tour[k] == end
        for size in range(1, LONGEST_MOVED + 1):
            low, high = (k, k + size - 1) if forward else (k - size + 1, k)
            if low < 1 or high > last or low - 1 <= i - 1 <= high:
                break
            before, begin, stop = tour[low - 1] ^ 1, tour[low], tour[high] ^ 1
            saved = self._far(before, begin)
            if high < last:
                saved += self._far(stop, tour[high + 1]) - self._far(before, tour[high + 1])
            tail = stop if forward else begin
            if gain + saved - self._far(tail, tour[i]) > self._least:
                return self._carry(low, high, i, forward)
        return []

    def _carry(self, low: int, high: int, i: int, forward: bool) -> list[int]:
        """Takes a stretch out and puts it before place i, reversed if not `forward`."""
        tour = self.tour
        part = tour[low : high + 1]
        part = part if forward else [end ^ 1 for end in reversed(part)]
        touched = [tour[low - 1] >> 1, tour[min(high + 1, len(tour) - 1)] >> 1]
        touched += [tour[i - 1] >> 1, tour[i] >> 1, part[0] >> 1, part[-1] >> 1]
        if low > i:
            tour[i : high + 1] = part + tour[i:low]
            self._renumber(i, high)
        else:
            tour[low:i] = tour[high + 1 : i] + part
            self._renumber(low, i - 1)
        return touched
