"""Shapes of an arm and rays -> hits."""

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.render.arm_shapes import Arm
from dqpaint.robots.kinematics import Solid

MOST_RAYS = 20_000
"""Rays that are asked at once."""


class RayCaster:
    """The shapes of an arm's links as solids that rays meet; meshes are taken as they are.

    Args:
        arm: whose visual shapes they are.

    Attributes:
        unread: the mesh files of which no solid can be made.
    """

    def __init__(self, arm: Arm) -> None:
        self._arm = arm
        built = [(shape, Solid.of(shape.kind, shape.size, shape.mesh)) for shape in arm.shapes]
        self.unread = [shape.mesh for shape, solid in built if solid is None]
        self._solids = [
            (shape.link + 1, shape.frame, solid) for shape, solid in built if solid is not None
        ]

    def blocked(self, postures: Floats, start: Floats, end: Floats) -> NDArray[np.bool_]:
        """Whether the arm is in the way of rays (M, K), K in each posture.

        A solid that a ray begins in is not: it holds the lamp.

        Args:
            postures: (M, n) [rad].
            start: of the rays (M, K, 3) [m].
            end: likewise.
        """
        hit = np.zeros(start.shape[:2], dtype=bool)
        most = max(1, MOST_RAYS // max(start.shape[1], 1))
        for first in range(0, len(postures), most):
            rows = slice(first, first + most)
            frames = self._arm.frames(postures[rows])
            for link, frame, solid in self._solids:
                pose = dq.mul(frames[:, link], frame)
                hit[rows] |= solid.blocks(pose, start[rows], end[rows], ~hit[rows])
        return hit
