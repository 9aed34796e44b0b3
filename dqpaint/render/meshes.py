"""Boxes, round shapes and mesh files -> triangles with a normal at each corner."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats
from dqpaint.robots.kinematics import read_mesh

SIDES = 40
"""Number of sides of round shapes."""
RINGS = 10
"""Number of rings from the equator of a sphere to its pole."""
CREASE = float(np.cos(np.radians(30.0)))
"""Cosine of the angle between facets above which the edge between them is a sharp one."""
SAME_PLACE = 1e-7
"""Corners nearer than this, as a part of the mesh's size, are one."""


class MeshFileError(Exception):
    """A mesh file, named by its path, that is not there or cannot be read."""


class Triangles(NamedTuple):
    """Triangles: corners (T, 3, 3) [m] and the unit normals (T, 3, 3) of the surface there."""

    corners: Floats
    normals: Floats


class Ring(NamedTuple):
    """A circle about z: radius, height, and the normal's components outwards and along z."""

    radius: float
    height: float
    out: float
    up: float


Strips = Sequence[Sequence[Ring]]
"""Connected rings from bottom to top; there is an edge between two strips."""


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


def round_mesh(kind: str, radius: float, length: float = 0.0) -> Triangles:
    """A sphere, cylinder or capsule about z, smooth but for the edges of a cylinder."""
    turn = 2.0 * np.pi * np.arange(SIDES) / SIDES
    x, y = np.cos(turn), np.sin(turn)
    points, normals, faces = [], [], []
    first = 0
    for strip in SHAPES[kind](radius, length):
        for ring in strip:
            points.append(np.stack([ring.radius * x, ring.radius * y, 0 * x + ring.height], 1))
            normals.append(np.stack([ring.out * x, ring.out * y, 0 * x + ring.up], 1))
        for k in range(len(strip) - 1):
            here = first + k * SIDES + np.arange(SIDES)
            beside = first + k * SIDES + (np.arange(SIDES) + 1) % SIDES
            faces.append(np.stack([here, beside, beside + SIDES], 1))
            faces.append(np.stack([here, beside + SIDES, here + SIDES], 1))
        first += len(strip) * SIDES
    corner = np.concatenate(faces)
    return Triangles(np.concatenate(points)[corner], np.concatenate(normals)[corner])


def box_mesh(sides: Sequence[float]) -> Triangles:
    """A box about the origin."""
    square = np.array([[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], dtype=np.float64)
    corners, normals = [], []
    for axis in range(3):
        for way in (1.0, -1.0):
            face = np.roll(square * [way, 1.0, way], axis + 1, axis=1)
            corners.append(face[[[0, 1, 2], [0, 2, 3]]])
            normals.append(np.broadcast_to(way * np.eye(3)[axis], (2, 3, 3)))
    half = 0.5 * np.asarray(sides, dtype=np.float64)
    return Triangles(np.concatenate(corners) * half, np.concatenate(normals))


def read_mesh_file(path: str, scale: Sequence[float]) -> Triangles:
    """The triangles of a mesh file, scaled; an OBJ's own normals, else smooth between edges.

    Raises:
        MeshFileError: it is not there, or cannot be read.
    """
    try:
        own = _read_obj(Path(path)) if path.lower().endswith(".obj") else None
        if own is None:
            points, faces = read_mesh(path, (1.0, 1.0, 1.0))
            own = points[faces], np.zeros((0, 3, 3))
    except (OSError, ValueError, IndexError) as problem:
        raise MeshFileError(path) from problem
    factor = np.asarray(scale, dtype=np.float64)
    corners, normals = own[0] * factor, own[1] / factor
    if not len(normals):
        return Triangles(corners, crease_normals(corners))
    return Triangles(corners, unit(normals))


def unit(vectors: Floats) -> Floats:
    """Vectors (..., 3) of length one; zero stays zero."""
    length = np.sqrt(np.einsum("...i,...i->...", vectors, vectors))[..., None]
    return np.asarray(vectors / np.maximum(length, 1e-300))


def _read_obj(path: Path) -> tuple[Floats, Floats]:
    """Corners and normals (T, 3, 3) of a Wavefront OBJ; no normals (0, 3, 3) where some have none.

    Raises:
        ValueError: a number or a reference is none.
    """
    rows: dict[bytes, list[list[bytes]]] = {b"v": [], b"vn": []}
    triples: list[bytes] = []
    for line in path.read_bytes().splitlines():
        word, *rest = line.split() or [b""]
        if word in rows:
            rows[word].append(rest[:3])
        elif word == b"f":
            for k in range(1, len(rest) - 1):  # a fan about its first corner
                triples += rest[0], rest[k], rest[k + 1]
    points, normals = (np.array(found, "S").astype(np.float64) for found in rows.values())
    if not triples:
        raise ValueError("no faces")
    parts = [corner.split(b"/") for corner in triples]
    at = _indices([part[0] for part in parts], len(points))
    if not all(len(part) == 3 and part[2] for part in parts):
        return points[at], np.zeros((0, 3, 3))
    return points[at], normals[_indices([part[2] for part in parts], len(normals))]


def _indices(words: list[bytes], count: int) -> NDArray[np.int64]:
    """Rows (T, 3) that start from 0; the file's start from 1, or from the end with a minus."""
    numbers = np.array(words, "S").astype(np.int64)
    if len(numbers) and (np.abs(numbers).max() > count or not np.abs(numbers).min()):
        raise ValueError("a corner that is not there")
    return np.where(numbers > 0, numbers - 1, count + numbers).reshape(-1, 3)


def crease_normals(corners: Floats) -> Floats:
    """Normals (T, 3, 3) at the corners of facets (T, 3, 3): smooth, but flat at sharp edges.

    At each corner those facets count, by their areas, that meet there and lean less than the crease
    from its own.
    """
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facets = unit(areas)
    size = max(float(np.ptp(corners)), 1e-12) if len(corners) else 1.0
    grid = np.round(corners.reshape(-1, 3) / (SAME_PLACE * size)).astype(np.int64)
    _, place = np.unique(grid, axis=0, return_inverse=True)
    order = np.argsort(place.ravel(), kind="stable")
    place, owner = place.ravel()[order], order // 3
    found = areas[owner].copy()
    left, step = np.arange(len(order)), 1
    while True:
        left = left[left + step < len(order)]
        left = left[place[left] == place[left + step]]
        if not len(left):
            break
        one, other = owner[left], owner[left + step]
        near = (facets[one] * facets[other]).sum(axis=1) > CREASE
        found[left[near]] += areas[other[near]]
        found[left[near] + step] += areas[one[near]]
        step += 1
    normals = np.empty_like(found)
    normals[order] = unit(found)
    return normals.reshape(-1, 3, 3)
