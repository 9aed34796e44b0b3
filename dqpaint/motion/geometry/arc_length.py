"""A stroke -> its length and angle; a distance along it -> its parameter.

Straight lines, screws, arcs of one radius and curves run evenly: their length is a speed. What does
not, such as a curve or an arc that grows, is integrated by Gauss-Legendre quadrature, panel by
panel, and turned round by Newton's method; the derivatives of the way back are exact.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats
from dqpaint.motion.geometry.paths import Indices
from dqpaint.motion.geometry.shapes import Flow, PositionAndOrientation, Shape
from dqpaint.program import NODES, WEIGHTS

MOST_PANELS = 1024
MOST_ANGLE_PANELS = 32  # panels, of a stroke whose length needs none
ANGLE_TOLERANCE = 1e-12  # relative
SPEED_BATCH = 16_384  # positions for which speeds are computed together
PARAMETER_BATCH = 512  # places whose parameters are sought together: ten nodes each
LENGTH_TOLERANCE = 1e-13  # relative, of a length
CONVERGED = 0.01  # relative: a length that still changes by more at `MOST_PANELS` did not converge
LAST_STEP = 1e-10  # of Newton's method: the next would be about the square of it
CUSP_SPEED = 1e-6  # of the mean speed: a curve that is slower somewhere has a point there


@dataclass(frozen=True)
class Extent:
    """The length [m] of a stroke's path and the angle [rad] its tool turns through.

    Attributes:
        length: of the point's path.
        angle: of the tool's turning, added up.
        edges: of the panels of `f`, (M + 1,).
        lengths: from the start to each edge [m], (M + 1,).
        uniform: whether the point's speed over `f` is one number.
        converged: whether finer panels give the same length; near a pole it grows each time.
    """

    length: float
    angle: float
    edges: Floats
    lengths: Floats
    uniform: bool
    converged: bool = True


def measure_stroke(shape: Shape) -> Extent:
    """Length and angle of one stroke, to rounding or as exact as `MOST_PANELS` allows."""
    panels, change = 16, 0.0
    before = _integrate(shape, panels)
    while panels < MOST_PANELS:
        panels *= 2
        after = _integrate(shape, panels)
        change = abs(after.length - before.length)
        before = after
        if change <= LENGTH_TOLERANCE * after.length:
            break
    return replace(before, converged=bool(change <= CONVERGED * before.length))


def measure_uniform(shape: Shape, count: int) -> tuple[Floats, Floats]:
    """Lengths [m] (K,) of strokes with uniform speed, and their angles [rad] (K,).

    Args:
        shape: of all of them.
        count: how many there are.
    """
    length = np.asarray(shape.speeds(np.zeros(count))[0])
    angle, left = _angles(shape, np.arange(count), 1), np.arange(count)
    panels = 1
    while panels < MOST_ANGLE_PANELS and len(left):
        panels *= 2
        before, angle[left] = angle[left], _angles(shape, left, panels)
        left = left[np.abs(angle[left] - before) > ANGLE_TOLERANCE * angle[left]]
    return length, angle


def _angles(shape: Shape, rows: Indices, panels: int) -> Floats:
    """Angles (N,) of some strokes, in batches."""
    _, f, weights = _quadrature(panels)
    out = np.empty(len(rows))
    at_once = max(1, SPEED_BATCH // len(f))
    for begin in range(0, len(rows), at_once):
        own = slice(begin, begin + at_once)
        part = shape.select(np.repeat(rows[own], len(f)))
        turning = part.speeds(np.tile(f, len(rows[own])))[1].reshape(-1, len(f))
        out[own] = turning @ weights
    return out


def _quadrature(panels: int) -> tuple[Floats, Floats, Floats]:
    """Edges (M + 1,) of panels from 0 to 1, and the nodes (10 M,) with their weights."""
    edges = np.linspace(0.0, 1.0, panels + 1)
    weights = np.tile(0.5 * WEIGHTS / panels, panels)
    return edges, _nodes(edges[:-1], edges[1:]).ravel(), weights


def _integrate(shape: Shape, panels: int) -> Extent:
    edges, f, weights = _quadrature(panels)
    speed, turning = shape.speeds(f)
    parts = (speed * weights).reshape(panels, -1).sum(1)
    length = float(parts.sum())
    even = bool(np.ptp(speed) <= 1e-12 * length)
    lengths = np.concatenate([[0.0], np.cumsum(parts)])
    return Extent(length, float(turning @ weights), edges, lengths, even)


def has_cusp(shape: Shape, extent: Extent) -> bool:
    """Whether the point comes to rest within the path, as at the cusp of a cardioid.

    Looks for the least speed ever closer: around the slowest of 17 places, eight times.
    """
    least, width = _slowest(shape, extent.edges)
    for _ in range(8):
        around = np.clip(np.linspace(least - width, least + width, 17), 0.0, 1.0)
        least, width = _slowest(shape, around)
    speed = shape.speed(np.array([least]))[0]
    return bool(speed < CUSP_SPEED * extent.length)


def _slowest(shape: Shape, f: Floats) -> tuple[float, float]:
    """The parameter of f (N,) at the least speed, and the distance to its neighbours."""
    return float(f[np.argmin(shape.speed(f))]), float(np.diff(f).max())


def _nodes(lower: Floats, upper: Floats) -> Floats:
    """The nodes (M, K) of the quadrature from `lower` to `upper` (M,)."""
    return 0.5 * (lower + upper)[:, None] + 0.5 * (upper - lower)[:, None] * NODES


def parameter_at(shape: Shape, extent: Extent, distance: Floats) -> Floats:
    """The parameter f (N,) at distances (N,) along the path, also beyond its ends."""
    f = np.interp(distance, extent.lengths, extent.edges)
    for begin in range(0, len(f), PARAMETER_BATCH):
        own = slice(begin, begin + PARAMETER_BATCH)
        f[own] = _newton(shape, extent, distance[own], f[own])
    return f


def _newton(shape: Shape, extent: Extent, distance: Floats, f: Floats) -> Floats:
    """Refine estimates f (N,) to the accuracy of `parameter_at`."""
    before, beyond = distance < 0, distance > extent.length
    panel = _panel(distance, extent.lengths)
    start = extent.edges[panel]
    lower, upper = np.where(before, -np.inf, 0.0), np.where(beyond, np.inf, 1.0)
    for _ in range(20):
        so_far = extent.lengths[panel] + _length(shape, start, f)
        step = (so_far - distance) / shape.speed(f)
        f = np.clip(f - step, lower, upper)
        if np.abs(step).max(initial=0.0) < LAST_STEP:
            break
    return f


def _panel(values: Floats, edges: Floats) -> NDArray[np.intp]:
    """The panel (N,) of each value; values outside belong to the outer panels."""
    inside = np.searchsorted(edges, values, side="right") - 1
    return np.clip(inside, 0, len(edges) - 2)


def _length(shape: Shape, start: Floats, end: Floats) -> Floats:
    """The lengths (N,) between two parameters within a panel or close to one."""
    at = _nodes(start, end)
    speed = shape.speed(at.ravel()).reshape(at.shape)
    return np.asarray((speed @ WEIGHTS) * 0.5 * (end - start))


def flow_by_length(shape: Shape, extent: Extent, fraction: Floats) -> Flow:
    """The stroke over the fraction of its length instead of its own parameter.

    With S(f) = fraction L and S' = |p'|: f' = L / |p'| and f'' = -(p' . p'') L^2 / |p'|^4.
    """
    if extent.uniform:
        return shape.flow(fraction)
    assert isinstance(shape, PositionAndOrientation)
    f = parameter_at(shape, extent, fraction * extent.length)
    p = shape.positions(f)
    square = (p[1] ** 2).sum(1)
    rate = extent.length / np.sqrt(square)
    slope = -(p[1] * p[2]).sum(1) * extent.length**2 / square**2
    return shape.flow(f).reparametrised(rate, slope)


def length_fraction(shape: Shape, extent: Extent, f: Floats) -> Floats:
    """The fraction of the length (N,) before the parameters f (N,)."""
    if extent.uniform or extent.length == 0:
        return f
    panel = _panel(f, extent.edges)
    so_far = extent.lengths[panel] + _length(shape, extent.edges[panel], f)
    return np.asarray(so_far / extent.length)
