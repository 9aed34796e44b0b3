"""Light and a camera -> straight steps on the picture plane -> bins of nearly equal length."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import cast

import numpy as np
from numpy.typing import NDArray

from dqpaint.light.arrays import BATCH, Floats
from dqpaint.light.camera.camera import NEAREST_DEPTH, Camera
from dqpaint.light.film.merge_steps import merge_short_steps
from dqpaint.light.sources.emission import Light

MERGE_BATCH = 2 * BATCH
"""Steps that are examined together for merging. With twice as many, numpy would use threads for the
matrix products and lose time."""


@dataclass(frozen=True, eq=False)
class Projection:
    """M lit steps in the order of time, each a straight piece of the picture.

    Attributes:
        start: (2, M) x and y where each step begins [px].
        end: (2, M) x and y where it ends; equal to the start if the lamp does not move [px].
        energy: (3, M) linear RGB each step leaves, evenly from start to end [lamp s].
        lost: (3,) the energy that fell outside [lamp s].
    """

    start: Floats
    end: Floats
    energy: Floats
    lost: Floats

    @cached_property
    def length(self) -> Floats:
        """Lengths (M,) [px]. Unlike np.hypot this is quick; no path is long enough to overflow."""
        way = self.end - self.start
        return cast(Floats, np.sqrt(way[0] ** 2 + way[1] ** 2))

    def select(self, steps: slice) -> Projection:
        """A slice of the steps, without the energy that fell outside."""
        start, end, energy = (of[:, steps] for of in (self.start, self.end, self.energy))
        return Projection(start, end, energy, np.zeros(3))


@dataclass(frozen=True, eq=False)
class Bins:
    """A projection cut into B pieces of nearly equal length.

    Attributes:
        position: (2, B) centre of the energy in each [px].
        energy: (3, B) linear RGB in each [lamp s].
        length: (B,) of path in each; 0 where the lamp did not move [px].
        alone: (B,) whether its run was so short that it is the only piece.
    """

    position: Floats
    energy: Floats
    length: Floats
    alone: NDArray[np.bool_]


def project_light(light: Light, camera: Camera, margin: float) -> Iterator[Projection]:
    """Project light to the picture plus a margin, one batch at a time.

    A step that crosses the edge is cut there and keeps its share by length. A step with an end
    behind the pinhole has no image and is lost as a whole. Dark steps are left out.

    Args:
        light: What was emitted.
        camera: Where it is seen from.
        margin: How far outside the outermost pixel centres light still counts [px].
    """
    for first in range(0, len(light.energy), MERGE_BATCH):
        energy = light.energy[first : first + MERGE_BATCH]
        points = light.points[first : first + len(energy) + 1]
        points, energy = merge_short_steps(points, energy, camera, margin)
        for begin in range(0, len(energy), BATCH):
            some = energy[begin : begin + BATCH]
            yield _project_batch(points[begin : begin + len(some) + 1], some, camera, margin)


def _project_batch(points: Floats, energy: Floats, camera: Camera, margin: float) -> Projection:
    """Project one batch: points (N, 3), energy (N-1, 3)."""
    pixels, depth = camera.project(points)
    start, end = pixels[:-1].T, pixels[1:].T
    left = energy.T.copy()  # with a row for each channel numpy is ten times as quick
    lit = left.any(axis=0)
    seen = depth > NEAREST_DEPTH
    imaged = lit & seen[:-1] & seen[1:]
    lost = np.zeros(3)
    if not imaged.all():
        lost += left[:, lit & ~imaged].sum(axis=1)
        start, end, left = start[:, imaged], end[:, imaged], left[:, imaged]

    low = np.full((2, 1), -margin)
    high = np.array([[camera.width - 1.0], [camera.height - 1.0]]) + margin
    inside = ((start >= low) & (start <= high) & (end >= low) & (end <= high)).all(axis=0)
    if not inside.all():
        cut = ~inside
        start, end = start.copy(), end.copy()
        a, b = start[:, cut], end[:, cut]
        enter, leave = _clip(a, b, low, high)
        share = np.maximum(leave - enter, 0.0)
        lost += (left[:, cut] * (1.0 - share)).sum(axis=1)
        left[:, cut] *= share
        # rounding may carry a cut end out of the box again, by 1e-10 px if the step was very long
        start[:, cut] = np.clip(a + enter * (b - a), low, high)
        end[:, cut] = np.clip(a + leave * (b - a), low, high)
        some = left.any(axis=0)
        start, end, left = start[:, some], end[:, some], left[:, some]
    return Projection(start, end, left, lost)


def _clip(start: Floats, end: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Parameters, 0 at start and 1 at end, at which each step enters and leaves the box.

    Liang and Barsky, A new concept and method for line clipping, ACM TOG 3(1), 1984. A step that
    stays outside enters after it leaves.
    """
    step = end - start
    still = step == 0.0
    with np.errstate(over="ignore"):  # a step too short to reach an edge reaches it at infinity
        to_low = (low - start) / np.where(still, 1.0, step)
        to_high = (high - start) / np.where(still, 1.0, step)
    beside = np.where((start < low) | (start > high), np.inf, -np.inf)
    enter = np.where(still, beside, np.minimum(to_low, to_high)).max(axis=0)
    leave = np.where(still, -beside, np.maximum(to_low, to_high)).min(axis=0)
    return np.clip(enter, 0.0, 1.0), np.clip(leave, 0.0, 1.0)


def cut_into_bins(trail: Projection, step: float) -> Iterator[Bins]:
    """Cut a projection into pieces at most `step` long, one batch at a time.

    The cuts do not depend on the lamp's speed: each unbroken run of steps is cut
    evenly along its length, however many samples it came in, and each piece gets the energy that
    was left between its ends. A lamp that does not move adds all its energy to one piece.

    Args:
        trail: What to cut.
        step: The longest piece [px].
    """
    steps = len(trail.length)
    if steps == 0:
        return
    if steps + trail.length.sum() / step <= BATCH:
        yield _cut_batch(trail, step)
        return
    work = np.cumsum(1.0 + trail.length / step)
    ends = np.searchsorted(work, np.arange(BATCH, work[-1] + BATCH, BATCH))
    first = 0
    for last in sorted({*ends.tolist(), steps}):
        if last > first:
            yield _cut_batch(trail.select(slice(first, last)), step)
            first = last


def _cut_batch(trail: Projection, step: float) -> Bins:
    """Cut one batch: whole steps are summed between cuts, steps with cuts are shared."""
    start, end, energy, length = trail.start, trail.end, trail.energy, trail.length
    path = np.cumsum(length)  # walked at the end of each step
    breaks = np.ones(len(length), dtype=bool)  # where a run begins: not where the last step ended
    breaks[1:] = (start[:, 1:] != end[:, :-1]).any(axis=0)
    first = np.flatnonzero(breaks)
    last = np.append(first[1:], len(length)) - 1

    origin = path[first] - length[first]
    reach = path[last] - origin
    count = np.maximum(np.ceil(reach / step), 1.0).astype(np.int64)  # bins of each run
    nth = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    size = np.repeat(reach / count, count)
    after = np.flatnonzero(nth)  # the bin that begins at each cut
    cut = np.repeat(origin, count)[after] + (nth * size)[after]
    on = np.minimum(np.searchsorted(path, cut), len(path) - 1)  # the step each cut falls on

    held = np.empty((5, len(length)))  # by each step: energy, and twice its moments about the axes
    held[:3] = energy
    np.multiply(energy.sum(axis=0), start + end, out=held[3:])
    held[:, on] = 0.0
    begins = np.repeat(first, count)
    begins[after] = on
    total = np.add.reduceat(held, begins, axis=1)

    part = np.clip(1.0 - (path[on] - cut) / length[on], 0.0, 1.0)
    _share_cut_steps(total, after, trail, on, part)
    mass = total[:3].sum(axis=0)
    lit = mass > 0.0
    return Bins(
        total[3:, lit] / (2.0 * mass[lit]),
        total[:3, lit],
        size[lit],
        np.repeat(count == 1, count)[lit],
    )


def _share_cut_steps(
    total: Floats, after: NDArray[np.int64], trail: Projection, on: NDArray[np.int64], part: Floats
) -> None:
    """Add steps that contain cuts to the bins on both sides of each cut.

    Args:
        total: (5, B) energy of each bin, and twice its moments about the axes.
        after: (C,) the bin that begins at each cut.
        trail: Of all steps.
        on: (C,) the step each cut falls on, in order.
        part: (C,) where on it, 0 to 1.
    """
    enter, leave = np.zeros(len(on)), np.ones(len(on))
    more = np.flatnonzero(on[1:] == on[:-1])  # cuts with another one on the same step
    enter[more + 1], leave[more] = part[more], part[more]  # which gives the piece between them
    energy, start, way = (of.take(on, axis=1) for of in (trail.energy, trail.start, trail.end))
    way -= start
    for gets, a, b in ((after - 1, enter, part), (after, part, leave)):
        piece = (b - a) * energy
        moment = piece.sum(axis=0) * (2.0 * start + (a + b) * way)
        for row, amount in zip(total, (*piece, *moment), strict=True):  # no bin gets two at once
            row[gets] += amount
