"""A straight line of light along its path -> an even grid of cells on the picture.

Equal energies on an even grid of (u, t), place along the line and time, land on the film with the
density 1 / |d(x, y) / d(u, t)|: a fold, and a sheet seen edge on, are bright of themselves.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dqpaint.light.arrays import Floats
from dqpaint.light.camera.camera import NEAREST_DEPTH, Camera

CELLS_PER_BATCH = 1 << 13
"""Cells of one batch. The number is fixed, so that sums keep their order."""
MOST_CELLS_PER_SIDE = 8192
"""Largest number of cells along a line or a step; beyond it they are wider than a pixel."""
MOST_CELLS_PER_STEP = 1 << 20
"""Largest number of cells of one step, for a line that jumps close to the lens."""
CELL_SIDE = 1.0
"""Side of a cell [px]."""


@dataclass(frozen=True, eq=False)
class Sheet:
    """The light that a line emits along its path through N instants.

    Attributes:
        ends: (N, 2, 3) of the line at each instant, base frame [m].
        energy: (N-1, 3) what all of it emits from one instant to the next [lamp s].
        tints: (R, C, 3) share of the energy in each of C equal parts of the line.
        row: (N-1,) which row of the tints holds.
    """

    ends: Floats
    energy: Floats
    tints: Floats
    row: NDArray[np.int64]

    @property
    def emitted(self) -> Floats:
        """The emitted energy (3,) in total [lamp s]."""
        return np.asarray((self.energy * self.tints.sum(axis=1)[self.row]).sum(axis=0))


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells of a sheet on the picture, and the energy that fell outside.

    Attributes:
        position: (2, M) x and y [px].
        energy: (3, M) [lamp s].
        lost: (3,) what fell outside [lamp s].
    """

    position: Floats
    energy: Floats
    lost: Floats


def sheet_cells(sheet: Sheet, camera: Camera, margin: float) -> Iterator[Cells]:
    """Yield a sheet as an even grid of points at most one pixel apart.

    A step with a corner behind the pinhole has no image and is lost as a whole.

    Args:
        sheet: What was emitted.
        camera: Where it is seen from.
        margin: How far outside the outermost pixel centres light still counts [px].
    """
    pixels, depth = camera.project(sheet.ends.reshape(-1, 3))
    pixels, depth = pixels.reshape(-1, 2, 2), depth.reshape(-1, 2)
    sums = np.concatenate(
        [np.zeros((len(sheet.tints), 1, 3)), np.cumsum(sheet.tints, axis=1)], axis=1
    )
    whole = sheet.energy * sums[sheet.row, -1]
    lit = sheet.energy.max(axis=1) > 0.0
    seen = depth.min(axis=1) > NEAREST_DEPTH
    low = np.full(2, -margin)
    high = np.array([camera.width - 1.0, camera.height - 1.0]) + margin
    with np.errstate(invalid="ignore"):  # a pixel behind the pinhole is not a number
        least = np.fmin(pixels[:-1], pixels[1:]).min(axis=1)
        most = np.fmax(pixels[:-1], pixels[1:]).max(axis=1)
        inside = (most >= low).all(axis=1) & (least <= high).all(axis=1)
    some = np.asarray(lit & seen[:-1] & seen[1:] & inside)
    lost = whole[lit & ~some].sum(axis=0)
    yield Cells(np.empty((2, 0)), np.empty((3, 0)), lost)
    index = np.flatnonzero(some)
    if len(index) == 0:
        return
    moved = _length(pixels[index + 1] - pixels[index]).max(axis=1)
    long = _length(pixels[:, 1] - pixels[:, 0])
    along = _count(np.maximum(long[index], long[index + 1]))
    steps = np.minimum(_count(moved), np.maximum(MOST_CELLS_PER_STEP // along, 1))
    # one row per part of a step, which is computed as a whole
    of = np.repeat(index, steps)
    nth = np.arange(len(of)) - np.repeat(np.cumsum(steps) - steps, steps)
    when = (nth + 0.5) / np.repeat(steps, steps)
    share, across = 1.0 / np.repeat(steps, steps), np.repeat(along, steps)
    done = np.cumsum(across)
    first = 0
    while first < len(of):
        before = done[first - 1] if first else 0
        last = max(first + 1, int(np.searchsorted(done, before + CELLS_PER_BATCH, side="right")))
        part = slice(first, last)
        yield _cells(sheet, camera, sums, (of[part], when[part], share[part], across[part]), margin)
        first = last


def _cells(
    sheet: Sheet,
    camera: Camera,
    sums: Floats,
    parts: tuple[NDArray[np.int64], Floats, Floats, NDArray[np.int64]],
    margin: float,
) -> Cells:
    """The cells of parts of steps; each part has a step, a time, a share and a number of cells."""
    of, when, share, across = parts
    line = (1.0 - when)[:, None, None] * sheet.ends[of] + when[:, None, None] * sheet.ends[of + 1]
    owner = np.repeat(np.arange(len(of)), across)
    nth = np.arange(len(owner)) - np.repeat(np.cumsum(across) - across, across)
    size = np.repeat(1.0 / across, across)
    u = ((nth + 0.5) * size)[:, None]
    points = (1.0 - u) * line[owner, 0] + u * line[owner, 1]
    pixels, _ = camera.project(points)
    edge = np.repeat(np.arange(len(of)), across + 1)  # of a cell and the next, in each part
    so_far = np.arange(len(edge)) - np.repeat(np.cumsum(across + 1) - across - 1, across + 1)
    held = np.diff(
        _cumulative_light(sums, sheet.row[of][edge], so_far * (1.0 / across)[edge]), axis=0
    )[edge[1:] == edge[:-1]]
    energy = held * (sheet.energy[of] * share[:, None])[owner]
    np.maximum(energy, 0.0, out=energy)  # a difference of equal sums may be -1e-17
    low = np.full(2, -margin)
    high = np.array([camera.width - 1.0, camera.height - 1.0]) + margin
    inside = ((pixels >= low) & (pixels <= high)).all(axis=1)
    lost = energy[~inside].sum(axis=0)
    return Cells(pixels[inside].T.copy(), energy[inside].T.copy(), lost)


def _cumulative_light(sums: Floats, row: NDArray[np.int64], u: Floats) -> Floats:
    """Light (M, 3) of the line from its beginning to u (M,), from sums (R, C+1, 3)."""
    x = np.minimum(u, 1.0) * (sums.shape[1] - 1)
    cell = np.minimum(x.astype(np.int64), sums.shape[1] - 2)
    part = (x - cell)[:, None]
    return np.asarray((1.0 - part) * sums[row, cell] + part * sums[row, cell + 1])


def _count(length: Floats) -> NDArray[np.int64]:
    return np.clip(np.ceil(length / CELL_SIDE), 1, MOST_CELLS_PER_SIDE).astype(np.int64)


def _length(way: Floats) -> Floats:
    return np.asarray(np.sqrt((way * way).sum(axis=-1)))
