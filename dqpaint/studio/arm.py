"""The name of an arm -> its shapes as meshes for the 3-D view, and their places in a posture."""

from contextlib import ExitStack
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.render.arm_shapes import Arm
from dqpaint.robots.kinematics import read_mesh
from dqpaint.robots.loading import find_card
from dqpaint.robots.urdf import urdf_file

STL_HEADER = b"binary STL".ljust(80)


@dataclass(frozen=True)
class ArmView:
    """The shapes of an arm.

    Attributes:
        meshes: STL and colour of each.
        frames: (L, 8) pose of each in the frame of its link.
        links: (L,) index of its link; 0 is the base.
    """

    meshes: tuple[tuple[bytes, tuple[float, float, float]], ...]
    frames: Floats
    links: tuple[int, ...]
    arm: Arm


@lru_cache(maxsize=4)
def shapes_of(robot: str) -> ArmView:
    """The shapes of an arm; raises DqpaintError where it is not there."""
    stack = ExitStack()  # for the life of the worker
    path = stack.enter_context(urdf_file(find_card(robot)))
    arm = stack.enter_context(Arm(path))
    meshes, frames, links = [], [], []
    for shape in arm.shapes:
        if not Path(shape.mesh).is_file():
            continue
        corners, triangles = read_mesh(shape.mesh, shape.size)
        meshes.append((stl(corners, triangles), shape.colour))
        frames.append(shape.frame)
        links.append(shape.link + 1)
    return ArmView(tuple(meshes), np.array(frames).reshape(-1, 8), tuple(links), arm)


def places(view: ArmView, postures: Floats) -> Floats:
    """The poses (M, L, 8) of the shapes at postures (M, n), base frame."""
    return dq.mul(view.arm.frames(postures)[:, list(view.links)], view.frames)


def stl(corners: Floats, triangles: NDArray[np.int64]) -> bytes:
    """A mesh as binary STL."""
    places = corners[triangles]
    across = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
    normals = across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-30)
    rows = np.zeros(len(triangles), np.dtype([("numbers", "<f4", 12), ("attribute", "<u2")]))
    rows["numbers"] = np.concatenate([normals[:, None], places], axis=1).reshape(-1, 12)
    return STL_HEADER + np.uint32(len(triangles)).tobytes() + rows.tobytes()
