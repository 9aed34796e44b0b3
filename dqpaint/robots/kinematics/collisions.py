"""Postures and an arm's solid shapes -> distances between links, and occlusion of a light.

What may collide are the collision shapes of the arm's description; what hides light are the visual
ones, as in a picture. Both use Coal, which comes with pinocchio and shares its model.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from functools import cache, lru_cache
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeAlias
from xml.etree import ElementTree as Xml

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.core import PINOCCHIO, Library
from dqpaint.dq import Floats
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import Card
from dqpaint.robots.urdf.prepare import prepare

if TYPE_CHECKING:
    import coal
    import pinocchio
else:
    coal, pinocchio = (Library(name, PINOCCHIO) for name in ("coal", "pinocchio"))

LEAST_JOINTS_BETWEEN = 2  # joints between two links that may collide: neighbours touch by design
TRIAL_POSTURES, SEED = 32, 1988
TOUCHING_SHARE = 0.5  # links that touch in more of the trial postures are not checked
SIGHT_RADIUS = 1e-5  # [m] half the width of a line of sight, as thin as a ray
CORNERS = 16  # of what stands for a circle, from outside
ROUNDING = 1e-9  # [m]
Z = np.array([0.0, 0.0, 1.0])
LAMP_CLEARANCE = 0.010  # [m] around the light that occludes nothing: the holder of the lamp


class Nearest(NamedTuple):
    """The least distances between links, one row per posture.

    Attributes:
        distance: of the nearest two (N,) [m]; negative where they collide, zero where only the
            hulls of their meshes do.
        pair: the names of these two links, N of them.
    """

    distance: Floats
    pair: list[tuple[str, str]]


class LinkCapsule(NamedTuple):
    """A rod with round ends that has a body of the arm inside.

    Attributes:
        joint: the joint that moves the body, from 1; 0 is the base.
        start: of its axis, in the joint's frame (3,) [m].
        end: likewise.
        radius: [m].
        name: of a link of the body.
    """

    joint: int
    start: Floats
    end: Floats
    radius: float
    name: str


@lru_cache(maxsize=1)
def collision_shapes(kinematics: Kinematics) -> CollisionShapes:
    """The shapes of an arm; those of the latest arm are cached."""
    return CollisionShapes(kinematics)


class CollisionShapes:
    """The solid shapes of an arm.

    For distances a mesh counts as its convex hull, which is a hundred times faster.

    Links that touch in the home posture, or in most postures, are not checked: their shapes are
    coarser than the arm itself.

    Attributes:
        notes: the parts of the arm that are left out, one sentence each.
    """

    def __init__(self, kinematics: Kinematics) -> None:
        self._model, self._data = kinematics.model, kinematics.model.createData()
        self._text, unread = prepare(kinematics.card).text, dict[str, None]()
        self._shapes = self._read(pinocchio.GeometryType.COLLISION, unread)
        self._visual = self._read(pinocchio.GeometryType.VISUAL, unread)
        self.notes = tuple(
            f"mesh '{Path(mesh).name}' cannot be read: collisions and occlusion ignore it"
            for mesh in unread
        )
        self._solids = [shape.geometry for shape in self._shapes.geometryObjects]
        for shape in self._shapes.geometryObjects:
            if isinstance(shape.geometry, coal.BVHModelBase):
                with suppress(ValueError):  # a flat one has no hull, and stays as it is
                    shape.geometry.buildConvexHull(True, "Qt")
                    shape.geometry = shape.geometry.convex
        self._names = [
            self._model.frames[shape.parentFrame].name for shape in self._shapes.geometryObjects
        ]
        self._choose_pairs(kinematics.card)

    def _read(
        self, kind: pinocchio.GeometryType, unread: dict[str, None]
    ) -> pinocchio.GeometryModel:
        """The shapes of one kind, without unreadable meshes; their names are recorded."""
        try:
            return pinocchio.buildGeomFromUrdfString(self._model, self._text, kind)
        except ValueError:
            self._text = without_broken_meshes(self._text, unread)
        return pinocchio.buildGeomFromUrdfString(self._model, self._text, kind)

    def nearest(self, postures: Floats) -> Nearest:
        """The nearest links at postures (N, n) [rad]; infinity if no pair can collide."""
        known = self._shapes.createData()
        distance = np.full(len(postures), np.inf)
        pair = [("", "")] * len(postures)
        for k, posture in enumerate(postures):
            pinocchio.computeDistances(self._model, self._data, self._shapes, known, posture)
            far = [result.min_distance for result in known.distanceResults]
            for i, hulls in enumerate(far):
                if hulls <= 0 and not self._exactly_collide(i, known.oMg):
                    far[i] = 0.0
            if far:
                closest = int(np.argmin(far))
                distance[k], pair[k] = far[closest], self._pair_names(closest)
        return Nearest(distance, pair)

    def capsules(self) -> tuple[LinkCapsule, ...]:
        """A capsule round each body that moves, and round the base: all of its shapes are inside.

        Its axis is that of the largest spread of the shapes' points.
        """
        balls: dict[int, list[Floats]] = {}
        for shape in self._shapes.geometryObjects:
            where = shape.placement
            points, radius = _balls(shape.geometry)
            placed = points @ where.rotation.T + where.translation
            rows = np.column_stack([placed, np.full(len(placed), radius)])
            balls.setdefault(shape.parentJoint, []).append(rows)
        names: dict[int, str] = {}
        for shape, name in zip(self._shapes.geometryObjects, self._names, strict=True):
            names.setdefault(shape.parentJoint, name)
        return tuple(
            LinkCapsule(joint, *_enclosing(np.concatenate(rows)), names[joint])
            for joint, rows in sorted(balls.items())
        )

    def occludes(self, postures: Floats, points: Floats, eye: Floats) -> NDArray[np.bool_]:
        """Whether the arm is between an eye and a light (N,).

        Args:
            postures: of the arm (N, n) [rad].
            points: the light in each (N, 3) [m].
            eye: the position of the eye (3,) [m].
        """
        known = self._visual.createData()
        hidden = np.zeros(len(postures), dtype=bool)
        for k, (posture, point) in enumerate(zip(postures, points, strict=True)):
            pinocchio.updateGeometryPlacements(
                self._model, self._data, self._visual, known, posture
            )
            sight = _line_of_sight(point, eye)
            hidden[k] = any(
                _blocks(shape.geometry, _transform(where), *sight)
                for shape, where in zip(self._visual.geometryObjects, known.oMg, strict=True)
            )
        return hidden

    def _choose_pairs(self, card: Card) -> None:
        """Choose the pairs of links to check: not adjacent, and apart in most trial postures."""
        joints = [shape.parentJoint for shape in self._shapes.geometryObjects]
        apart = [
            (i, j)
            for i, first in enumerate(joints)
            for j in range(i + 1, len(joints))
            if abs(first - joints[j]) >= LEAST_JOINTS_BETWEEN
        ]
        for i, j in apart:
            self._shapes.addCollisionPair(pinocchio.CollisionPair(i, j))
        trials = np.random.default_rng(SEED).uniform(
            card.lower, card.upper, (TRIAL_POSTURES, card.joints)
        )
        at_home = self._touching(card.home[None])[0]
        often = self._touching(trials).mean(axis=0) > TOUCHING_SHARE
        touching = {
            (joints[i], joints[j])
            for (i, j), touch in zip(apart, at_home | often, strict=True)
            if touch
        }
        self._shapes.removeAllCollisionPairs()
        for i, j in apart:
            if (joints[i], joints[j]) not in touching:
                self._shapes.addCollisionPair(pinocchio.CollisionPair(i, j))

    def _touching(self, postures: Floats) -> NDArray[np.bool_]:
        """Whether pairs touch, (N, pairs)."""
        known = self._shapes.createData()
        touch = np.zeros((len(postures), len(known.distanceResults)), dtype=bool)
        for k, posture in enumerate(postures):
            pinocchio.computeDistances(self._model, self._data, self._shapes, known, posture)
            touch[k] = [result.min_distance <= 0 for result in known.distanceResults]
        return touch

    def _exactly_collide(self, index: int, places: Sequence[pinocchio.SE3]) -> bool:
        """Whether the original shapes of a pair collide, not only their convex hulls."""
        pair = self._shapes.collisionPairs[index]
        one, other = pair.first, pair.second
        return _intersect(
            self._solids[one], _transform(places[one]), self._solids[other],
            _transform(places[other]),
        )  # fmt: skip

    def _pair_names(self, index: int) -> tuple[str, str]:
        pair = self._shapes.collisionPairs[index]
        return self._names[pair.first], self._names[pair.second]


def _balls(solid: coal.CollisionGeometry) -> tuple[Floats, float]:
    """Points (m, 3) and a radius, so that a solid is inside the hull of the balls round them."""
    match solid:
        case coal.Sphere():
            return np.zeros((1, 3)), solid.radius
        case coal.Capsule():
            return np.array([[0, 0, solid.halfLength], [0, 0, -solid.halfLength]]), solid.radius
        case coal.Cylinder():
            turn = np.linspace(0, 2 * np.pi, CORNERS, endpoint=False)
            ring = (
                solid.radius / np.cos(np.pi / CORNERS) * np.stack([np.cos(turn), np.sin(turn)], 1)
            )
            ends = [np.column_stack([ring, np.full(CORNERS, side * solid.halfLength)])
                    for side in (1, -1)]  # fmt: skip
            return np.concatenate(ends), 0.0
        case coal.Box():
            signs = np.array(list(product((1, -1), repeat=3)))
            return signs * solid.halfSide, 0.0
        case coal.ConvexBase():
            return np.array(solid.points()).reshape(-1, 3), 0.0
        case coal.BVHModelBase():
            return np.array(solid.vertices()).reshape(-1, 3), 0.0
    raise TypeError(f"no points of a {type(solid).__name__}")


def _enclosing(balls: Floats) -> tuple[Floats, Floats, float]:
    """Axis and radius of a capsule round balls (m, 4)."""
    points, sizes = balls[:, :3], balls[:, 3]
    middle = 0.5 * (points.max(axis=0) + points.min(axis=0))
    axis = np.linalg.svd(points - middle, full_matrices=False)[2][0] if len(points) > 1 else Z
    along = (points - middle) @ axis
    off = np.linalg.norm(points - middle - np.outer(along, axis), axis=1)
    radius = float((off + sizes).max()) + ROUNDING
    reach = np.sqrt(np.maximum((radius - sizes) ** 2 - off**2, 0.0))
    low, high = float((along + reach).min()), float((along - reach).max())
    if low > high:
        low = high = 0.5 * (low + high)
    return middle + low * axis, middle + high * axis, radius


class Solid:
    """A shape that may be in the way of light; a mesh as it is, not its hull.

    Attributes:
        geometry: Coal's.
        holds: whether a ray that begins inside is not blocked: in a primitive it is the lamp's.
    """

    def __init__(self, geometry: coal.CollisionGeometry) -> None:
        self.geometry = geometry
        self.holds = not isinstance(geometry, coal.BVHModelBase)
        geometry.computeLocalAABB()
        self._centre, self._radius = geometry.aabb_center, geometry.aabb_radius

    @classmethod
    def of(cls, kind: str, size: Sequence[float], mesh: str) -> Solid | None:
        """A box, sphere, cylinder, capsule or mesh; None where the file cannot be read.

        Args:
            kind: of a URDF's shapes.
            size: sides of a box [m], scale of a mesh, else radius and length [m].
            mesh: the file, if any.
        """
        if kind == "mesh":
            try:
                return cls(coal.MeshLoader().load(mesh, np.array(size, dtype=np.float64)))
            except ValueError:
                return None
        if kind == "box":
            return cls(coal.Box(*size))
        if kind == "sphere":
            return cls(coal.Sphere(size[0]))
        return cls({"cylinder": coal.Cylinder, "capsule": coal.Capsule}[kind](*size))

    def blocks(
        self, poses: Floats, start: Floats, end: Floats, asked: NDArray[np.bool_]
    ) -> NDArray[np.bool_]:
        """Whether the solid is in the way of rays (M, K).

        Args:
            poses: of the solid (M, 8).
            start: of the rays (M, K, 3) [m].
            end: likewise.
            asked: which of them are asked about (M, K).
        """
        R, t = dq.matrix_from_quaternion(dq.rotation(poses)), dq.translation(poses)
        centre = (R @ self._centre + t)[:, None]
        way = end - start
        length2 = np.maximum((way * way).sum(axis=-1), 1e-300)
        at = np.clip(((centre - start) * way).sum(axis=-1) / length2, 0.0, 1.0)
        gap = start + at[..., None] * way - centre
        near = asked & ((gap * gap).sum(axis=-1) <= (self._radius + SIGHT_RADIUS) ** 2)
        found = np.zeros(near.shape, dtype=bool)
        for m in np.flatnonzero(near.any(axis=1)).tolist():
            where = coal.Transform3s(R[m], t[m])
            for k in np.flatnonzero(near[m]).tolist():
                found[m, k] = self._is_met(where, start[m, k], way[m, k])
        return found

    def _is_met(self, where: coal.Transform3s, start: Floats, way: Floats) -> bool:
        length = float(np.sqrt(way @ way))
        turn = _rotation_to(way / length)
        line = coal.Capsule(SIGHT_RADIUS, length)
        place = coal.Transform3s(turn, start + 0.5 * way)
        if not _intersect(line, place, self.geometry, where):
            return False
        return not self.holds or not _intersect(
            _sight_end(), coal.Transform3s(turn, start), self.geometry, where
        )


def _rotation_to(along: Floats) -> Floats:
    """A rotation (3, 3) with a unit vector as its z axis, after Duff 2017."""
    x, y, z = along.tolist()
    sign = 1.0 if z >= 0 else -1.0
    a = -1.0 / (sign + z)
    b = x * y * a
    return np.array([
        [1.0 + sign * x * x * a, b, x],
        [sign * b, sign + y * y * a, y],
        [-sign * x, -y, z],
    ])  # fmt: skip


Sight: TypeAlias = "tuple[coal.Capsule, coal.Transform3s, coal.Transform3s]"


@cache
def _sight_end() -> coal.CollisionGeometry:
    return coal.Sphere(SIGHT_RADIUS)


def _line_of_sight(point: Floats, eye: Floats) -> Sight:
    """A thin capsule from the eye to the lamp's surface, its pose, and the pose of its end."""
    way = point - eye
    length = float(np.linalg.norm(way))
    along = way / length
    rotation = _rotation_to(along)
    seen = max(length - LAMP_CLEARANCE, SIGHT_RADIUS)
    middle, end = (eye + part * seen * along for part in (0.5, 1.0))
    place = coal.Transform3s(rotation, middle)
    return coal.Capsule(SIGHT_RADIUS, seen), place, coal.Transform3s(rotation, end)


def _blocks(
    solid: coal.CollisionGeometry,
    where: coal.Transform3s,
    line: coal.Capsule,
    place: coal.Transform3s,
    end: coal.Transform3s,
) -> bool:
    """Whether a shape blocks the line of sight; a primitive around the lamp does not."""
    if not _intersect(line, place, solid, where):
        return False
    return isinstance(solid, coal.BVHModelBase) or not _intersect(_sight_end(), end, solid, where)


def without_broken_meshes(text: str, broken: dict[str, None]) -> str:
    """A description without shapes whose meshes cannot be read; their files are recorded."""
    robot = Xml.fromstring(text)
    loader = coal.MeshLoader()
    for link in robot.iter("link"):
        for shape in [*link.findall("visual"), *link.findall("collision")]:
            mesh = shape.find("geometry/mesh")
            if mesh is None:
                continue
            name = mesh.get("filename", "")
            try:
                loader.load(name, np.ones(3))
            except ValueError:
                link.remove(shape)
                broken[name] = None
    return Xml.tostring(robot, encoding="unicode")


def read_mesh(path: str, scale: Sequence[float]) -> tuple[Floats, NDArray[np.int64]]:
    """The vertices (V, 3) [m] and triangles (T, 3) of a mesh file.

    Raises:
        ValueError: it cannot be read.
    """
    mesh = coal.MeshLoader().load(path, np.array(scale, dtype=np.float64))
    corners = [mesh.tri_indices(i) for i in range(mesh.num_tris)]
    triangles = np.array([[one[0], one[1], one[2]] for one in corners], dtype=np.int64)
    return np.array(mesh.vertices()), triangles.reshape(-1, 3)


def _transform(placement: pinocchio.SE3) -> coal.Transform3s:
    return coal.Transform3s(placement.rotation, placement.translation)


def _intersect(
    one: coal.CollisionGeometry,
    here: coal.Transform3s,
    other: coal.CollisionGeometry,
    there: coal.Transform3s,
) -> bool:
    result = coal.CollisionResult()
    return bool(coal.collide(one, here, other, there, coal.CollisionRequest(), result))
