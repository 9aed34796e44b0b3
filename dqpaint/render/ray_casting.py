"""Shapes of an arm and rays -> hits: copies of the shapes in a world for ray casting."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.render.arm_shapes import Arm, Shape
from dqpaint.robots.bullet import Client, bullet, quiet
from dqpaint.robots.kinematics import read_mesh

MOST_RAYS = 16_000
"""Rays of one call: PyBullet loses one of 16,384 and rejects more."""
LEAST_RAYS_FOR_THREADS = 500
"""With fewer rays, starting a second thread costs more than it saves."""


class RayCaster(Client):
    """Static bodies with the shapes of an arm's links.

    Meshes are taken as they are. The convex hulls that the physics would make of them stand proud
    by some millimetres, and rays against them take eight times as long.

    Args:
        arm: whose visual shapes they copy.

    Attributes:
        unread: the shapes that have no twin, as their files cannot be read.
    """

    def __init__(self, arm: Arm) -> None:
        super().__init__()
        self._arm = arm
        with quiet():
            built = [(shape, self._build(shape)) for shape in arm.shapes]
        solid = [(shape, body) for shape, body in built if body is not None]
        self.unread = [shape for shape, body in built if body is None]
        self._bodies = [body for _, body in solid]
        self._links = [shape.link + 1 for shape, _ in solid]
        self._frames = np.array([shape.frame for shape, _ in solid]).reshape(-1, 8)

    def _build(self, shape: Shape) -> int | None:
        here = {"physicsClientId": self.client}
        try:
            made = bullet.createCollisionShape(shape.kind, **_dimensions(shape), **here)
        except bullet.error:  # of Collada files it can only make pictures
            try:
                made = bullet.createCollisionShape(shape.kind, **_triangles(shape), **here)
            except (ValueError, bullet.error):
                return None
        body: int = bullet.createMultiBody(0, made, **here)
        return body

    def set_posture(self, posture: Floats) -> None:
        """Move the bodies and the arm to a posture (n,) [rad]."""
        for _ in self.each_posture(posture[None]):
            pass

    def each_posture(self, postures: Floats) -> Iterator[int]:
        """Move through postures (M, n) [rad], one after the other, and yield the index of each."""
        poses = dq.mul(self._arm.frames(postures)[:, self._links], self._frames)
        places = dq.translation(poses).tolist()
        turns = np.roll(dq.rotation(poses), -1, axis=-1).tolist()  # PyBullet has w last
        for row, at in enumerate(zip(places, turns, strict=True)):
            for body, place, turn in zip(self._bodies, *at, strict=True):
                bullet.resetBasePositionAndOrientation(body, place, turn, self.client)
            yield row

    def blocked(self, start: Floats, end: Floats) -> NDArray[np.bool_]:
        """Whether the segments (R,) from start (R, 3) to end (R, 3) hit the arm."""
        hit = np.empty(len(start), dtype=bool)
        for first in range(0, len(start), MOST_RAYS):
            rows = slice(first, first + MOST_RAYS)
            rays: Any = bullet.rayTestBatch(
                start[rows].tolist(),
                end[rows].tolist(),
                numThreads=1 if len(hit[rows]) <= LEAST_RAYS_FOR_THREADS else 0,
                physicsClientId=self.client,
            )
            hit[rows] = [ray[0] >= 0 for ray in rays]
        return hit


def _triangles(shape: Shape) -> dict[str, Any]:
    """The vertices and triangles of a mesh.

    Raises:
        ValueError: it cannot be read, or is not a mesh.
    """
    corners, triangles = read_mesh(shape.mesh, shape.size)
    concave = bullet.GEOM_FORCE_CONCAVE_TRIMESH
    return {"vertices": corners.tolist(), "indices": triangles.ravel().tolist(), "flags": concave}


def _dimensions(shape: Shape) -> dict[str, Any]:
    """The size of a shape, as PyBullet's arguments."""
    size = shape.size
    if shape.kind == bullet.GEOM_MESH:
        concave = bullet.GEOM_FORCE_CONCAVE_TRIMESH
        return {"fileName": shape.mesh, "meshScale": size, "flags": concave}
    if shape.kind == bullet.GEOM_BOX:
        return {"halfExtents": [0.5 * side for side in size]}
    if shape.kind == bullet.GEOM_SPHERE:
        return {"radius": size[0]}
    return {"height": size[0], "radius": size[1]}
