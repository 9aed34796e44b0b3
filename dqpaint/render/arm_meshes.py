"""The name of an arm -> its shapes as triangles, and where each is in a posture."""

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.render.arm_shapes import Arm
from dqpaint.robots.loading import find_card
from dqpaint.robots.urdf import urdf_file


class Mesh(NamedTuple):
    """One shape: the corners (T, 3, 3) of its triangles [m], in its own frame; colour, 0 to 1."""

    corners: Floats
    colour: tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class ArmView:
    """The shapes of an arm that can be read.

    Attributes:
        meshes: one a shape.
    """

    meshes: tuple[Mesh, ...]
    _arm: Arm

    def places(self, postures: Floats) -> Floats:
        """The poses (M, L, 8) of the shapes at postures (M, n) [rad], base frame."""
        links = [shape.link + 1 for shape in self._arm.shapes]
        frames = np.array([shape.frame for shape in self._arm.shapes]).reshape(-1, 8)
        return dq.mul(self._arm.frames(postures)[:, links], frames)


@lru_cache(maxsize=2)
def arm_view(robot: str) -> ArmView:
    """The shapes of an arm, which stay loaded for the next time.

    Raises:
        DqpaintError: the arm's description is not there, or cannot be read.
    """
    with urdf_file(find_card(robot)) as path:
        arm = Arm(path)
    return ArmView(tuple(Mesh(one.surface.corners, one.colour) for one in arm.shapes), arm)
