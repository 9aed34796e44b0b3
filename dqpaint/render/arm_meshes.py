"""The name of an arm -> its shapes as triangles, and where each is in a posture."""

from contextlib import ExitStack
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.render.arm_shapes import Arm
from dqpaint.robots.kinematics import read_mesh
from dqpaint.robots.loading import find_card
from dqpaint.robots.urdf import urdf_file


class Mesh(NamedTuple):
    """One shape: corners (V, 3) [m] in its own frame, triangles (T, 3), and colour, 0 to 1."""

    corners: Floats
    triangles: NDArray[np.int64]
    colour: tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class ArmView:
    """The shapes of an arm that can be read.

    Attributes:
        meshes: one a shape.
    """

    meshes: tuple[Mesh, ...]
    _frames: Floats  # (L, 8) of each in the frame of its link
    _links: tuple[int, ...]
    _arm: Arm

    def places(self, postures: Floats) -> Floats:
        """The poses (M, L, 8) of the shapes at postures (M, n) [rad], base frame."""
        return dq.mul(self._arm.frames(postures)[:, list(self._links)], self._frames)


@lru_cache(maxsize=2)
def arm_view(robot: str) -> ArmView:
    """The shapes of an arm, which stay loaded for the next time.

    Raises:
        DqpaintError: the arm's description is not there, or cannot be read.
    """
    stack = ExitStack()
    path = stack.enter_context(urdf_file(find_card(robot)))
    arm = stack.enter_context(Arm(path))
    found = []
    for shape in arm.shapes:
        if Path(shape.mesh).is_file():
            mesh = Mesh(*read_mesh(shape.mesh, shape.size), shape.colour)
            found.append((mesh, shape.frame, shape.link + 1))
    meshes, frames, links = zip(*found, strict=True) if found else ((), (), ())
    return ArmView(tuple(meshes), np.array(frames).reshape(-1, 8), tuple(links), arm)
