"""Triangles and a camera -> for each pixel the nearest triangle and its depth.

Each triangle is cut into rows of pixels, each row from edge to edge; of all that cover a pixel's
sample the nearest stays. One over the depth is linear in a picture, so it is added up, not divided.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats

MOST_AT_ONCE = 1_000_000
"""Covered samples that are worked out at once."""
EDGE_MARGIN = 1e-9
"""By which a row reaches past an edge, so that no sample falls between two triangles [px]."""
LEAST_AREA = 1e-12
"""Twice the area of a triangle below which it is a line [px^2]."""


class Raster(NamedTuple):
    """What the samples of a picture's region show.

    Attributes:
        triangle: (h, w) the number of the nearest; -1 where there is none.
        nearness: (h, w) one over its depth [1/m]; 0 where there is none.
    """

    triangle: NDArray[np.int64]
    nearness: Floats


def rasterise(pixels: Floats, depth: Floats, width: int, height: int) -> Raster:
    """The nearest triangle at each sample, which lie at whole numbers from (0, 0) on.

    Args:
        pixels: corners (T, 3, 2), x right and y down [px]; not finite where they cannot be seen.
        depth: of the corners (T, 3) [m].
        width: of the region [px].
        height: likewise.
    """
    triangle = np.full(height * width, -1, np.int64)
    nearness = np.zeros(height * width)
    kept = np.flatnonzero(_may_be_seen(pixels, width, height))
    x, y = pixels[kept, :, 0], pixels[kept, :, 1]
    slope = slopes(x, y, 1.0 / depth[kept])
    of, row, begin, end = _rows(x, y, width, height)
    count = np.cumsum(end - begin + 1)
    first = 0
    while first < len(of):
        before = count[first - 1] if first else 0
        last = max(first + 1, int(np.searchsorted(count, before + MOST_AT_ONCE, "right")))
        part = slice(first, last)
        n = end[part] - begin[part] + 1
        column = np.arange(n.sum()) + np.repeat(begin[part] - (count[part] - n - before), n)
        a, b, c = slope[of[part]].T
        value = np.repeat(a + c * row[part], n) + np.repeat(b, n) * column
        pixel = np.repeat(row[part] * width, n) + column
        np.maximum.at(nearness, pixel, value)
        wins = value == nearness[pixel]
        triangle[pixel[wins]] = np.repeat(kept[of[part]], n)[wins]
        first = last
    return Raster(triangle.reshape(height, width), nearness.reshape(height, width))


def _may_be_seen(pixels: Floats, width: int, height: int) -> NDArray[np.bool_]:
    """Whether each triangle is before the camera, meets the region and is no line."""
    low, high = pixels.min(axis=1), pixels.max(axis=1)  # NaN where a corner has no pixel
    inside = (high >= 0).all(axis=1) & (low <= [width - 1, height - 1]).all(axis=1)
    (ax, ay), (bx, by), (cx, cy) = (pixels[:, i].T for i in range(3))
    area = np.abs((bx - ax) * (cy - ay) - (cx - ax) * (by - ay))
    return np.asarray(inside & (area > LEAST_AREA))


def slopes(x: Floats, y: Floats, value: Floats) -> Floats:
    """Per triangle (T, 3, ...) a, b, c of value = a + b x + c y through its corners (T, 3, ...)."""
    dx, dy, dv = (each[:, 1:] - each[:, :1] for each in (x, y, value))
    wide = (slice(None), *[None] * (value.ndim - 2))
    area = (dx[:, 0] * dy[:, 1] - dx[:, 1] * dy[:, 0])[wide]
    b = (dv[:, 0] * dy[:, 1][wide] - dv[:, 1] * dy[:, 0][wide]) / area
    c = (dx[:, 0][wide] * dv[:, 1] - dx[:, 1][wide] * dv[:, 0]) / area
    return np.stack([value[:, 0] - b * x[:, 0][wide] - c * y[:, 0][wide], b, c], axis=1)


def _rows(
    x: Floats, y: Floats, width: int, height: int
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """The rows of samples in triangles: of which, their y, and their first and last x."""
    top = np.maximum(np.ceil(y.min(axis=1)), 0).astype(np.int64)
    bottom = np.minimum(np.floor(y.max(axis=1)), height - 1).astype(np.int64)
    n = np.maximum(bottom - top + 1, 0)
    of = np.repeat(np.arange(len(x)), n)
    row = np.arange(len(of)) - np.repeat(np.cumsum(n) - n, n) + top[of]
    left, right = np.full(len(of), np.inf), np.full(len(of), -np.inf)
    for i in range(3):
        j = (i + 1) % 3
        ya, yb = y[of, i], y[of, j]
        meets = (np.minimum(ya, yb) <= row) & (row <= np.maximum(ya, yb)) & (ya != yb)
        part = (row[meets] - ya[meets]) / (yb[meets] - ya[meets])
        at = x[of[meets], i] + part * (x[of[meets], j] - x[of[meets], i])
        left[meets], right[meets] = np.minimum(left[meets], at), np.maximum(right[meets], at)
    some = left <= right
    of, row, left, right = of[some], row[some], left[some], right[some]
    begin = np.maximum(np.ceil(left - EDGE_MARGIN), 0).astype(np.int64)
    end = np.minimum(np.floor(right + EDGE_MARGIN), width - 1).astype(np.int64)
    some = begin <= end
    return of[some], row[some], begin[some], end[some]
