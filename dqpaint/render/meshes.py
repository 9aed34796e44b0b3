"""Spheres, cylinders and capsules -> fine meshes; the renderer's own have a dozen sides."""

import xml.etree.ElementTree as Xml
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

SIDES = 40
"""Number of sides of round shapes."""
RINGS = 10
"""Number of rings from the equator of a sphere to its pole."""


class Ring(NamedTuple):
    """A circle about z: radius, height, and the normal's components outwards and along z."""

    radius: float
    height: float
    out: float
    up: float


Strips = Sequence[Sequence[Ring]]
"""Connected rings from bottom to top; there is an edge between two strips."""


def with_fine_meshes(description: bytes) -> dict[str, bytes] | None:
    """The files of the description with fine meshes; None if it has its own meshes.

    Args:
        description: a URDF.

    Returns:
        The bytes of each by its name; the description is `arm.urdf`.
    """
    tree = Xml.fromstring(description)
    if tree.find(".//mesh") is not None:
        return None
    files: dict[str, bytes] = {}
    for geometry in tree.iterfind("link/visual/geometry"):
        for element in list(geometry):
            if element.tag not in SHAPES:
                continue
            sizes = tuple(float(element.get(word, "nan")) for word in ("radius", "length"))
            name = f"{len(files)}.obj"
            files[name] = revolution_mesh(SHAPES[element.tag](*sizes))
            geometry.remove(element)
            Xml.SubElement(geometry, "mesh", filename=name)
    files["arm.urdf"] = Xml.tostring(tree)
    return files


def _ball(radius: float, _length: float = 0.0) -> Strips:
    return [_cap(radius, 0.0, -1)[:-1] + _cap(radius, 0.0, 1)]


def _cylinder(radius: float, length: float) -> Strips:
    z = 0.5 * length
    return [
        [Ring(0.0, -z, 0.0, -1.0), Ring(radius, -z, 0.0, -1.0)],
        [Ring(radius, -z, 1.0, 0.0), Ring(radius, z, 1.0, 0.0)],
        [Ring(radius, z, 0.0, 1.0), Ring(0.0, z, 0.0, 1.0)],
    ]


def _capsule(radius: float, length: float) -> Strips:
    return [_cap(radius, -0.5 * length, -1) + _cap(radius, 0.5 * length, 1)]


def _cap(radius: float, z: float, side: int) -> list[Ring]:
    """Half a sphere about (0, 0, z), with its pole above or below."""
    angles = np.linspace(0.0, 0.5 * np.pi, RINGS + 1)[::side]
    return [
        Ring(float(radius * c), float(z + side * radius * s), float(c), float(side * s))
        for c, s in zip(np.cos(angles), np.sin(angles), strict=True)
    ]


SHAPES: dict[str, Callable[[float, float], Strips]] = {
    "sphere": _ball, "cylinder": _cylinder, "capsule": _capsule,
}  # fmt: skip


def revolution_mesh(strips: Strips) -> bytes:
    """A surface of revolution about z as Wavefront OBJ, with smooth normals on each strip."""
    turn = 2.0 * np.pi * np.arange(SIDES) / SIDES
    x, y = np.cos(turn), np.sin(turn)
    points, normals, faces = [], [], []
    first = 1  # OBJ counts from 1
    for strip in strips:
        for ring in strip:
            points.append(np.stack([ring.radius * x, ring.radius * y, 0 * x + ring.height], 1))
            normals.append(np.stack([ring.out * x, ring.out * y, 0 * x + ring.up], 1))
        for k in range(len(strip) - 1):
            here = first + k * SIDES + np.arange(SIDES)
            beside = first + k * SIDES + (np.arange(SIDES) + 1) % SIDES
            faces.append(np.stack([here, beside, beside + SIDES], 1))
            faces.append(np.stack([here, beside + SIDES, here + SIDES], 1))
        first += len(strip) * SIDES
    lines = [f"v {a:.7g} {b:.7g} {c:.7g}" for a, b, c in np.concatenate(points).tolist()]
    lines += [f"vn {a:.7g} {b:.7g} {c:.7g}" for a, b, c in np.concatenate(normals).tolist()]
    lines += [f"f {a}//{a} {b}//{b} {c}//{c}" for a, b, c in np.concatenate(faces).tolist()]
    return "\n".join([*lines, ""]).encode()
