"""A URDF -> the visual shapes of an arm, loaded into a PyBullet world without physics."""

import tempfile
import xml.etree.ElementTree as Xml
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.render.meshes import with_fine_meshes
from dqpaint.robots.bullet import Client, bullet, joint_indices, quiet

WHITE = [1.0, 1.0, 1.0, 1.0]


@dataclass(frozen=True)
class Shape:
    """One visual shape of a link, as in the URDF.

    Attributes:
        link: its number; -1 is the base.
        kind: of PyBullet's geometries.
        size: (3,) of a mesh its scale, else its dimensions [m].
        mesh: the file it was read from, if any.
        frame: pose (8,) in the frame of its link.
        colour: (3,) as the file has it.
    """

    link: int
    kind: int
    size: tuple[float, float, float]
    mesh: str
    frame: Floats
    colour: tuple[float, float, float]


class Arm(Client):
    """An arm that can be put into a posture and rendered.

    Where a mesh is not there, or of a kind that cannot be read, all meshes are left out.

    Args:
        urdf: its description.

    Attributes:
        whole: whether all shapes of the file are there.
    """

    def __init__(self, urdf: str | PathLike[str]) -> None:
        super().__init__()
        with quiet():
            here = {"physicsClientId": self.client}
            self.body = self._load(urdf)
            self.shapes = [_shape(data) for data in bullet.getVisualShapeData(self.body, **here)]
            self._use_fine_meshes(urdf)
        self.joints = joint_indices(self.body, self.client)
        self.links = list(range(bullet.getNumJoints(self.body, **here)))

    def _load(self, urdf: str | PathLike[str]) -> int:
        how: dict[str, Any] = {"useFixedBase": True, "physicsClientId": self.client}
        how["flags"] = bullet.URDF_IGNORE_COLLISION_SHAPES
        self.whole = True
        try:
            body: int = bullet.loadURDF(str(urdf), **how)
        except bullet.error:  # one mesh that is missing is enough for that
            self.whole = False
            with tempfile.NamedTemporaryFile("wb", suffix=".urdf") as bare:
                bare.write(_without_meshes(urdf))
                bare.flush()
                body = bullet.loadURDF(bare.name, **how)
        return body

    def _use_fine_meshes(self, urdf: str | PathLike[str]) -> None:
        """Replace the body by one with finer shapes, if it has no meshes."""
        files = with_fine_meshes(Path(urdf).read_bytes())
        if files is None:
            return
        bullet.removeBody(self.body, physicsClientId=self.client)
        with tempfile.TemporaryDirectory() as folder:
            for name, data in files.items():
                (Path(folder) / name).write_bytes(data)
            self.body = self._load(Path(folder) / "arm.urdf")

    def set_posture(self, posture: Floats) -> None:
        """Move the arm to a posture (n,) [rad]."""
        angles = [(angle,) for angle in posture.tolist()]
        bullet.resetJointStatesMultiDof(self.body, self.joints, angles, physicsClientId=self.client)

    def frames(self, postures: Floats) -> Floats:
        """The poses (M, L + 1, 8) of base and links at postures (M, n), in the base frame."""
        here = {"physicsClientId": self.client}
        rows = np.empty((len(postures), len(self.links) + 1, 7))
        rows[:, 0] = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0
        for row, posture in zip(rows, postures, strict=True):
            self.set_posture(posture)
            if self.links:
                states = bullet.getLinkStates(
                    self.body, self.links, computeForwardKinematics=1, **here
                )
                row[1:] = [(*state[4], *state[5]) for state in states]
        return dq.pose_from(rows[..., :3], rows[..., [6, 3, 4, 5]])  # PyBullet has w last

    def whiten(self) -> None:
        """Paint every shape white, so that its picture shows only the lighting."""
        for shape in self.shapes:
            bullet.changeVisualShape(
                self.body, shape.link, rgbaColor=WHITE, textureUniqueId=-1,
                physicsClientId=self.client,
            )  # fmt: skip


def _without_meshes(urdf: str | PathLike[str]) -> bytes:
    """The description without shapes from mesh files."""
    tree = Xml.parse(urdf).getroot()
    for link in tree.iter("link"):
        for shape in [*link.findall("visual"), *link.findall("collision")]:
            if shape.find("geometry/mesh") is not None:
                link.remove(shape)
    text: bytes = Xml.tostring(tree)
    return text


def _shape(data: Any) -> Shape:
    _, link, kind, size, mesh, place, turn, colour = data[:8]
    return Shape(link, kind, size, mesh.decode(), _pose(place, turn), colour[:3])


def _pose(place: Any, turn: Any) -> Floats:
    """A dual quaternion (8,) from PyBullet's position and (x, y, z, w)."""
    x, y, z, w = turn
    q = np.array([w, x, y, z])
    return dq.pose_from(place, q / np.linalg.norm(q))
