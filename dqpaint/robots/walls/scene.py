"""Walls of a drawing and an arm -> how far each is, and what joint rates change of it."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError
from dqpaint.motion import Motion
from dqpaint.program import Wall, walls
from dqpaint.robots.kinematics import Kinematics, collision_shapes, read_mesh
from dqpaint.robots.urdf.meshes import MeshError, check_mesh
from dqpaint.robots.walls import distances
from dqpaint.robots.walls.distances import Contacts

if TYPE_CHECKING:
    from scipy.spatial import ConvexHull

BEAM_LENGTH = 2.0  # [m] of the light's beam, along the tool's z axis
LEAST_JOINTS_BETWEEN = 2  # joints between two links that are kept apart: neighbours touch by design
METRES, RADIANS = "m", "rad"  # units of distances


class WallRows(NamedTuple):
    """The distances at a posture, several a wall: d_dot = gradient q_dot + drift.

    Attributes:
        distance: (m,) [m]; of a cone 2 (cos of the angle - cos of the largest).
        gradient: (m, n).
        drift: (m,) [m/s], as far as the walls themselves move.
        wall: the number of the wall (m,).
    """

    distance: Floats
    gradient: Floats
    drift: Floats
    wall: NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class WallsOfRun:
    """How a run went among its walls.

    Attributes:
        walls: of the drawing.
        units: of the distance of each wall: m, or rad of a cone.
        distance: the least to each wall at the true postures (N, W).
        active: whether a wall held the arm back in a row (N, W); none where nothing held it.
        lost: how much of the tool's velocity that cost (N,) [m/s].
    """

    walls: tuple[Wall, ...]
    units: tuple[str, ...]
    distance: Floats
    active: NDArray[np.bool_]
    lost: Floats


class _Held(NamedTuple):
    """Segments of the arm with a radius, and up to which joint each moves."""

    start: Floats
    end: Floats
    radius: Floats
    joint: NDArray[np.intp]


class Walls:
    """The walls of a drawing where they stand in front of an arm.

    Args:
        kinematics: of the arm.
        given: the walls of the drawing.
        frame: pose (8,) of the drawing in the base frame.

    Raises:
        DqpaintError: a mesh cannot be read.
    """

    def __init__(self, kinematics: Kinematics, given: tuple[Wall, ...], frame: Floats) -> None:
        self.given, self._arm = given, kinematics
        self.units = tuple(
            RADIANS if isinstance(wall.shape, walls.Cone) else METRES for wall in given
        )
        joints = np.arange(kinematics.card.joints)
        self._moved = joints[None] < np.arange(len(joints) + 1)[:, None]  # by joint k: those before
        capsules = collision_shapes(kinematics).capsules() if self._needs_links else ()
        self._joint = np.array([one.joint for one in capsules], dtype=np.intp)
        self._ends = np.array([[one.start, one.end] for one in capsules]).reshape(-1, 2, 3)
        self._radius = np.array([one.radius for one in capsules])
        R, origin = dq.matrix_from_quaternion(dq.rotation(frame)), dq.translation(frame)
        still = (np.eye(3), np.zeros(3))
        self._frames = [still if wall.base else (R, origin) for wall in given]
        self._hulls = {
            wall.shape: _hull(wall.shape) for wall in given if isinstance(wall.shape, walls.Hull)
        }
        self._pairs = self._apart_pairs() if len(capsules) else np.zeros((0, 2), dtype=np.intp)

    @property
    def _needs_links(self) -> bool:
        return any(
            isinstance(wall.shape, walls.Apart)
            or (wall.holder == "arm" and not isinstance(wall.shape, walls.Cone))
            for wall in self.given
        )

    def rows(self, posture: Floats, pose: Floats, jacobian: Floats, time: float) -> WallRows:
        """The distances at a posture (n,), the tool's pose (8,), J_w (6, n) and a time [s]."""
        held = self._held(posture, pose)
        found = []
        for number, wall in enumerate(self.given):
            distance, rows, drift = self._of_wall(wall, number, held, pose, jacobian, time)
            found.append(WallRows(distance, rows, drift, np.full(len(distance), number)))
        return WallRows(*(np.concatenate(parts) for parts in zip(*found, strict=True)))

    def least(self, postures: Floats, times: Floats) -> Floats:
        """The least distance to each wall (N, W) at postures (N, n) and times (N,).

        Of a cone it is the angle that is left [rad].
        """
        found = np.full((len(postures), len(self.given)), np.inf)
        for k, (posture, time) in enumerate(zip(postures, times.tolist(), strict=True)):
            pose, J = self._arm.pose_and_jacobian(posture)
            rows = self.rows(posture, pose, J, time)
            np.minimum.at(found[k], rows.wall, rows.distance)
        for number, wall in enumerate(self.given):
            if isinstance(wall.shape, walls.Cone):
                cosine = np.clip(0.5 * found[:, number] + np.cos(wall.shape.angle), -1, 1)
                found[:, number] = wall.shape.angle - np.arccos(cosine)
        return found

    def _held(self, posture: Floats, pose: Floats) -> dict[str, _Held]:
        """What of the arm is kept, by the holders of walls."""
        tool, n = dq.translation(pose), np.array([len(posture)])
        z = dq.matrix_from_quaternion(dq.rotation(pose))[:, 2]
        point = _Held(tool[None], tool[None], np.zeros(1), n)
        held = {"tool": point, "beam": point._replace(end=(tool + BEAM_LENGTH * z)[None])}
        if len(self._joint):
            R, p = self._arm.joint_frames(posture)
            ends = np.einsum("cij,cej->cei", R[self._joint], self._ends) + p[self._joint][:, None]
            held["links"] = _Held(ends[:, 0], ends[:, 1], self._radius, self._joint)
            free = self._joint > 0  # the base does not move: no wall keeps it
            held["arm"] = _Held(
                np.concatenate([ends[free, 0], tool[None]]),
                np.concatenate([ends[free, 1], tool[None]]),
                np.append(self._radius[free], 0.0),
                np.append(self._joint[free], n),
            )
        return held

    def _of_wall(
        self,
        wall: Wall,
        number: int,
        held: dict[str, _Held],
        pose: Floats,
        jacobian: Floats,
        time: float,
    ) -> tuple[Floats, Floats, Floats]:
        """Distances (m,), gradients (m, n) and drifts (m,) of one wall."""
        R, origin = self._frames[number]
        if isinstance(wall.shape, walls.Cone):
            z = dq.matrix_from_quaternion(dq.rotation(pose))[:, 2]
            wanted = R @ np.array(wall.shape.axis)
            inside, row = distances.cone_row(z, wanted, wall.shape.angle)
            return np.array([inside]), (row @ jacobian)[None], np.zeros(1)
        if isinstance(wall.shape, walls.Apart):
            return self._between_links(wall.shape.distance, held["links"], jacobian)
        mine = held[wall.holder]
        share = min(1.0, time / wall.seconds) if wall.seconds else 0.0
        gone = origin + R @ (share * np.array(wall.shift))
        start, end = (mine.start - gone) @ R, (mine.end - gone) @ R
        contacts = self._contacts(wall.shape, start, end)
        contacts = contacts._replace(
            normal=contacts.normal @ R.T, point=contacts.point @ R.T + gone
        )
        moved = self._moved[mine.joint[contacts.which]]
        gradient = (distances.twist_rows(contacts) @ jacobian) * moved
        speed = np.array(wall.shift) / wall.seconds if wall.seconds and share < 1.0 else np.zeros(3)
        drift = -contacts.normal @ (R @ speed)
        return contacts.distance - mine.radius[contacts.which], gradient, drift

    def _contacts(self, shape: walls.WallShape, start: Floats, end: Floats) -> Contacts:
        """Of segments (m, 3) in the wall's frame."""
        match shape:
            case walls.HalfSpace(normal, offset):
                return distances.from_half_space(start, end, np.array(normal), offset)
            case walls.Room(low, high):
                sides = [
                    distances.from_half_space(start, end, sign * axis, sign * float(corner @ axis))
                    for corner, sign in ((np.array(low), 1.0), (np.array(high), -1.0))
                    for axis in np.eye(3)
                ]
                return Contacts(*(np.concatenate(parts) for parts in zip(*sides, strict=True)))
            case walls.Block(low, high):
                return distances.from_box(start, end, np.array(low), np.array(high))
            case walls.Ball(centre, radius):
                found = distances.from_point(start, end, np.array(centre))
            case walls.Rod(first, last, radius):
                ends = np.array(first), np.array(last)
                found = distances.from_segments(start, end, *ends)[0]
            case walls.Pillar(point, axis, radius):
                found = distances.from_line(start, end, np.array(point), np.array(axis))
            case walls.Hull():
                return distances.from_hull(start, end, self._hulls[shape])
            case _:
                raise TypeError(f"no distance from a {type(shape).__name__}")
        return found._replace(distance=found.distance - radius)

    def _between_links(
        self, least: float, links: _Held, jacobian: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Of pairs of links, each against the other."""
        one, other = self._pairs.T
        contacts, points = distances.from_segments(
            links.start[one], links.end[one], links.start[other], links.end[other]
        )
        far = contacts.distance - links.radius[one] - links.radius[other] - least
        mine = (distances.twist_rows(contacts) @ jacobian) * self._moved[links.joint[one]]
        its = distances.twist_rows(contacts._replace(point=points)) @ jacobian
        its *= self._moved[links.joint[other]]
        return far, mine - its, np.zeros(len(far))

    def _apart_pairs(self) -> NDArray[np.intp]:
        """The pairs of capsules (P, 2) that are kept apart: those that are so at home."""
        n = len(self._joint)
        pairs = np.array([
            (i, j) for i in range(n) for j in range(i + 1, n)
            if self._joint[j] - self._joint[i] >= LEAST_JOINTS_BETWEEN
        ], dtype=np.intp).reshape(-1, 2)  # fmt: skip
        if not len(pairs):
            return pairs
        home = self._arm.card.home
        links = self._held(home, self._arm.pose(home))["links"]
        one, other = pairs.T
        contacts, _ = distances.from_segments(
            links.start[one], links.end[one], links.start[other], links.end[other]
        )
        return pairs[contacts.distance > links.radius[one] + links.radius[other]]


def walls_of(motion: Motion, kinematics: Kinematics) -> Walls | None:
    """The walls of a motion's drawing; None where it has none.

    Raises:
        DqpaintError: a mesh cannot be read.
    """
    given = motion.program.walls
    return Walls(kinematics, given, motion.canvas) if given else None


def among_walls(
    motion: Motion,
    kinematics: Kinematics,
    postures: Floats,
    active: NDArray[np.bool_] | None = None,
    lost: Floats | None = None,
) -> WallsOfRun | None:
    """How a run went among the walls of its drawing; None where it has none, or no joints.

    Args:
        motion: that was asked.
        kinematics: of the true arm.
        postures: true (N, n) [rad].
        active: whether a wall held the arm back in a row (N, W); None where nothing held it.
        lost: the tool's velocity that this cost (N,) [m/s].
    """
    walls = walls_of(motion, kinematics)
    if walls is None or not postures.shape[1]:
        return None
    count = len(walls.given)
    return WallsOfRun(
        walls.given,
        walls.units,
        walls.least(postures, motion.t),
        np.zeros((len(postures), count), dtype=bool) if active is None else active,
        np.zeros(len(postures)) if lost is None else lost,
    )


def _hull(shape: walls.Hull) -> "ConvexHull":
    from scipy.spatial import ConvexHull  # slow to import, and few drawings have a mesh

    try:
        check_mesh(shape.file)
        points, _ = read_mesh(str(shape.file), [shape.scale] * 3)
        return ConvexHull(points + np.array(shape.at))
    except (MeshError, ValueError) as problem:
        raise DqpaintError(f"mesh '{shape.file.name}' {problem}") from None
