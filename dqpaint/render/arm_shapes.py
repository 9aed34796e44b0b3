"""A URDF -> the visual shapes of an arm as triangles on links, and where the links are."""

import xml.etree.ElementTree as Xml
from dataclasses import dataclass, field
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.render.meshes import MeshFileError, Triangles, box_mesh, read_mesh_file, round_mesh
from dqpaint.robots.model import Mount

UNPAINTED = (0.8, 0.8, 0.8)
"""The colour of a shape to which its file gives none."""
TURNING = ("revolute", "continuous")


@dataclass(frozen=True, eq=False)
class Shape:
    """One visual shape of a link, as in the URDF.

    Attributes:
        link: its number; -1 is the base.
        kind: box, sphere, cylinder, capsule or mesh.
        size: of a mesh its scale (3,), of a box its sides [m], else its radius and length [m].
        mesh: the file it was read from, if any.
        frame: pose (8,) in the frame of its link.
        colour: (3,) as the file has it.
        surface: its triangles, in its own frame.
    """

    link: int
    kind: str
    size: tuple[float, ...]
    mesh: str
    frame: Floats
    colour: tuple[float, float, float]
    surface: Triangles = field(repr=False)


class _Joint(NamedTuple):
    parent: int
    origin: Floats
    axis: Floats | None  # (3,) of a joint that turns


class Arm:
    """An arm that can be put into a posture and rendered.

    Args:
        urdf: its description.

    Attributes:
        unread: the mesh files that are not there or cannot be read, whose shapes are left out.
        links: the numbers of its links; the base is none of them.
        joints: the numbers of the links whose joints turn, in the order of the chain.
        shapes: of base and links.
        beside: what stands beside it in pictures: poses (8,) in the base frame, and surfaces.
    """

    def __init__(self, urdf: str | PathLike[str]) -> None:
        folder, robot = Path(urdf).parent, Xml.parse(urdf).getroot()
        names, self._joints = _chain(robot)
        self.links = list(range(len(self._joints)))
        self.joints = [i for i, joint in enumerate(self._joints) if joint.axis is not None]
        elements = {one.get("name", ""): one for one in robot.findall("link")}
        colours = _named_colours(robot)
        self.shapes, self.unread = list[Shape](), list[str]()
        self.beside: list[tuple[Floats, Triangles]] = []
        for link, name in enumerate(names, start=-1):
            for visual in elements[name].findall("visual"):
                try:
                    self.shapes += _shape(visual, link, folder, colours)
                except MeshFileError as problem:
                    self.unread.append(str(problem))
        self._frames = self.frames(np.zeros((1, len(self.joints))))[0]

    def set_posture(self, posture: Floats) -> None:
        """Move the arm to a posture (n,) [rad]."""
        self._frames = self.frames(posture[None])[0]

    def frames(self, postures: Floats) -> Floats:
        """The poses (M, L + 1, 8) of base and links at postures (M, n), in the base frame."""
        found = np.empty((len(postures), len(self._joints) + 1, 8))
        found[:, 0] = dq.IDENTITY
        angles = iter(postures.T)
        for i, (parent, origin, axis) in enumerate(self._joints, start=1):
            pose = dq.mul(found[:, parent + 1], origin)
            if axis is not None:
                half = 0.5 * next(angles)[:, None]
                turn = np.zeros((len(postures), 8))
                turn[:, :1], turn[:, 1:4] = np.cos(half), np.sin(half) * axis
                pose = dq.mul(pose, turn)
            found[:, i] = pose
        return found

    @cached_property
    def _surface(self) -> tuple[Triangles, NDArray[np.int64]]:
        """All triangles in the frames of their links, and the link (T,) of each."""
        at, normals, link = [np.zeros((0, 3, 3))], [np.zeros((0, 3, 3))], []
        own = [(shape.link, shape.frame, shape.surface) for shape in self.shapes]
        for number, frame, surface in own + [(-1, *one) for one in self.beside]:
            turn = dq.matrix_from_quaternion(dq.rotation(frame))
            at.append(surface.corners @ turn.T + dq.translation(frame))
            normals.append(surface.normals @ turn.T)
            link += [number] * len(surface.corners)
        return Triangles(np.concatenate(at), np.concatenate(normals)), np.array(link, np.int64)

    def surface(self) -> tuple[Triangles, NDArray[np.int64]]:
        """All triangles in the present posture, base frame, and the link (T,) of each."""
        (corners, normals), link = self._surface
        turn = dq.matrix_from_quaternion(dq.rotation(self._frames))[link + 1]
        place = dq.translation(self._frames)[link + 1]
        moved = corners @ turn.swapaxes(1, 2) + place[:, None]
        return Triangles(moved, normals @ turn.swapaxes(1, 2)), link


def _chain(robot: Xml.Element) -> tuple[list[str], list[_Joint]]:
    """The names of base and links, and the joint that carries each link; parents come first."""
    below: dict[str, list[Xml.Element]] = {}
    children = set()
    for joint in robot.findall("joint"):
        below.setdefault(_link(joint, "parent"), []).append(joint)
        children.add(_link(joint, "child"))
    root = next(name for one in robot.findall("link") if (name := one.get("name")) not in children)
    names, joints = [str(root)], list[_Joint]()
    waiting = [(joint, -1) for joint in reversed(below.get(names[0], []))]
    while waiting:
        element, parent = waiting.pop()
        axis = None
        if element.get("type") in TURNING:
            axis = _numbers(element.find("axis"), "xyz", (1.0, 0.0, 0.0))
            axis /= np.linalg.norm(axis)
        joints.append(_Joint(parent, _origin(element), axis))
        names.append(_link(element, "child"))
        own = len(names) - 2
        waiting += [(joint, own) for joint in reversed(below.get(names[-1], []))]
    return names, joints


def _link(joint: Xml.Element, end: str) -> str:
    found = joint.find(end)
    return "" if found is None else found.get("link", "")


def _shape(
    visual: Xml.Element, link: int, folder: Path, colours: dict[str, tuple[float, float, float]]
) -> list[Shape]:
    """The shape of a visual element, if it has one.

    Raises:
        MeshFileError: its mesh is not there, or cannot be read.
    """
    for element in visual.findall("geometry/*"):
        kind, mesh = element.tag, ""
        if kind == "mesh":
            mesh = str(folder / element.get("filename", "").removeprefix("file://"))
            size = tuple(_numbers(element, "scale", (1.0, 1.0, 1.0)).tolist())
            surface = read_mesh_file(mesh, size)
        elif kind == "box":
            size = tuple(_numbers(element, "size", (0.0, 0.0, 0.0)).tolist())
            surface = box_mesh(size)
        else:
            size = (float(element.get("radius", "0")), float(element.get("length", "0")))
            surface = round_mesh(kind, *size)
        colour = _colour(visual, colours)
        return [Shape(link, kind, size, mesh, _origin(visual), colour, surface)]
    return []


def _named_colours(robot: Xml.Element) -> dict[str, tuple[float, float, float]]:
    """The colours of materials that have a name, wherever they are defined."""
    return {one.get("name", ""): rgb for one in robot.iter("material") if (rgb := _rgb(one))}


def _colour(
    visual: Xml.Element, named: dict[str, tuple[float, float, float]]
) -> tuple[float, float, float]:
    material = visual.find("material")
    if material is None:
        return UNPAINTED
    return _rgb(material) or named.get(material.get("name", ""), UNPAINTED)


def _rgb(material: Xml.Element) -> tuple[float, float, float] | None:
    colour = material.find("color")
    if colour is None:
        return None
    r, g, b, *_ = _numbers(colour, "rgba", (*UNPAINTED, 1.0)).tolist()
    return r, g, b


def _origin(element: Xml.Element) -> Floats:
    """The pose (8,) of an element's origin."""
    origin = element.find("origin")
    place, turn = (_numbers(origin, word, (0.0, 0.0, 0.0)) for word in ("xyz", "rpy"))
    mount = Mount(at_m=tuple(place.tolist()), rpy_deg=tuple(np.degrees(turn).tolist()))
    return mount.pose


def _numbers(element: Xml.Element | None, word: str, without: tuple[float, ...]) -> Floats:
    text = None if element is None else element.get(word)
    return np.array(without if text is None else text.split(), dtype=np.float64)
