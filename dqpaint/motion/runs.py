"""Several strokes as one: the shape of a run, over the fraction of its whole length.

Over its length each part runs evenly, so the speed of the point is the same on both sides of a
joint; where the parts meet in a straight line its velocity does not jump either.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.motion.lengths import Extent, flow_by_length
from dqpaint.motion.shapes import Flow, Shape


@dataclass(frozen=True)
class Joined:
    """Shapes end to end; `edges` (M + 1,) are the fractions of the length where they meet."""

    shapes: tuple[Shape, ...]
    extents: tuple[Extent, ...]
    edges: Floats

    def flow(self, f: Floats) -> Flow:
        """Pose, twist per unit of f and its derivative; at a joint, of the part that begins."""
        part = part_at(self.edges, f)
        pose, twist, slope = np.empty((len(f), 8)), np.empty((len(f), 6)), np.empty((len(f), 6))
        order = np.argsort(part, kind="stable")
        numbers, begins = np.unique(part[order], return_index=True)
        for i, rows in zip(numbers, np.split(order, begins[1:]), strict=True):
            flow = self.part_flow(
                i, (f[rows] - self.edges[i]) / (self.edges[i + 1] - self.edges[i])
            )
            pose[rows], twist[rows], slope[rows] = flow.pose, flow.twist, flow.slope
        return Flow(pose, twist, slope)

    def part_flow(self, i: int, fraction: Floats) -> Flow:
        """One part at fractions (N,) of its own length; twist and slope per unit of the whole."""
        flow = flow_by_length(self.shapes[i], self.extents[i], fraction)
        rate = np.full(len(fraction), 1.0 / (self.edges[i + 1] - self.edges[i]))
        return flow.at_rates(rate, np.zeros_like(rate))

    def speeds(self, f: Floats) -> tuple[Floats, Floats]:
        """Of the point, the same everywhere, and of the tool's turning."""
        length = sum(extent.length for extent in self.extents)
        return np.full(len(f), length), np.linalg.norm(self.flow(f).twist[:, :3], axis=1)


def joined(shapes: list[Shape], extents: list[Extent]) -> tuple[Joined, Extent]:
    """Shapes as one, and its extent; each has a length."""
    ends = np.concatenate([[0.0], np.cumsum([extent.length for extent in extents])])
    length = float(ends[-1])
    edges = ends / length
    angle = sum(extent.angle for extent in extents)
    shape = Joined(tuple(shapes), tuple(extents), edges)
    return shape, Extent(length, angle, edges, ends, even=True)


def part_at(edges: Floats, f: Floats) -> NDArray[np.intp]:
    """Which part (N,) fractions lie in; the outer ones for what lies beyond."""
    return np.clip(np.searchsorted(edges, f, side="right") - 1, 0, len(edges) - 2)


def end_velocities(shape: Joined) -> tuple[Floats, Floats]:
    """Velocities (M, 3) [m per unit of f] of the point where each part begins, and ends."""
    velocities = np.empty((2, len(shape.shapes), 3))
    for i in range(len(shape.shapes)):
        flow = shape.part_flow(i, np.array([0.0, 1.0]))
        velocities[:, i] = dq.point_velocity(flow.twist, dq.translation(flow.pose))
    return velocities[0], velocities[1]
