"""Postures -> poses and Jacobians of an arm's tool, by pinocchio, in the conventions of `dq`.

Pinocchio puts the linear part of a twist first; its WORLD frame is about the base origin. Here, and
nowhere else, the halves change places.
"""

from copy import copy
from typing import TYPE_CHECKING, Self

import numpy as np

from dqpaint import dq
from dqpaint.core import PINOCCHIO, Library
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError
from dqpaint.robots.kinematics.differential_ik import CHARACTERISTIC_LENGTH, tool_jacobian_map
from dqpaint.robots.model.card import Card
from dqpaint.robots.model.screws import Screws
from dqpaint.robots.model.task import POSE, Task
from dqpaint.robots.urdf.prepare import prepare

if TYPE_CHECKING:
    import pinocchio
else:
    pinocchio = Library("pinocchio", PINOCCHIO)

_UNSCALED = np.diag([1.0] * 3 + [CHARACTERISTIC_LENGTH] * 3)


def manipulability(jacobian: Floats) -> Floats:
    """Yoshikawa's sqrt(det(J J')) (...,) at the tool of Jacobians (..., m, n), rad and m mixed.

    Moving the reference point from the base origin to the tool is a shear: same determinant for
    all six rows. Of a task of fewer it is that of `Kinematics.task_jacobian`.
    """
    squared: Floats = np.linalg.det(jacobian @ jacobian.swapaxes(-1, -2))
    return np.asarray(np.sqrt(np.maximum(squared, 0.0)))


class Kinematics:
    """Forward kinematics of a card's tool.

    Attributes:
        card: of the arm.
        model: pinocchio's, of the joints that move.
        notes: assumptions where the arm's description has no data.
        task: which part of the tool's pose it is for.
    """

    def __init__(self, card: Card, task: Task = POSE) -> None:
        self.card, self.task = card, task
        prepared = prepare(card)
        self.notes = (*card.notes, *prepared.notes)
        try:
            self.model = pinocchio.buildModelFromXML(prepared.text)
        except ValueError as problem:
            raise DqpaintError(f"pinocchio cannot read {card.name}: {problem}") from None
        self._data = self.model.createData()
        frame = self.model.frames[self.model.getFrameId(card.link, pinocchio.FrameType.BODY)]
        self._joint = frame.parentJoint
        tool = pinocchio.SE3(dq.matrix_from_pose(card.tool.pose))
        self._tool = frame.placement * tool

    def with_model_error(
        self, lengths: Floats | None = None, gravity: float = 1.0, masses: Floats | None = None
    ) -> Self:
        """The same arm with other link lengths, gravity or masses, as a wrong model has them.

        Args:
            lengths: offsets added to each joint's position on the link before it, and to the tool's
                place on the last joint (n + 1, 3) [m].
            gravity: as a part of the true one.
            masses: of the links, as parts of the true ones (n,); inertias likewise.
        """
        other = copy(self)
        vars(other).pop("_chain", None)  # screws of lengths before
        other.model = pinocchio.Model(self.model)
        other.model.gravity.linear = gravity * self.model.gravity.linear
        if lengths is not None:
            for joint, way in enumerate(lengths[:-1], start=1):
                other.model.jointPlacements[joint].translation += way
            other._tool = pinocchio.SE3(self._tool.rotation, self._tool.translation + lengths[-1])
        if masses is not None:
            for body, part in zip(list(other.model.inertias)[1:], masses.tolist(), strict=True):
                body.mass, body.inertia = part * body.mass, part * body.inertia
        other._data = other.model.createData()
        return other

    @property
    def lengths(self) -> Floats:
        """Each joint's position on the link before it, then the tool's on the last (n+1, 3)."""
        places = [self.model.jointPlacements[i + 1].translation for i in range(self.model.nv)]
        return np.array([*places, self._tool.translation])

    def pose(self, posture: Floats) -> Floats:
        """The tool's pose (8,) in the base frame at a posture (n,) [rad]; its sign is arbitrary."""
        pinocchio.forwardKinematics(self.model, self._data, posture)
        return self._read_pose()

    def poses(self, postures: Floats) -> Floats:
        """The tool's poses (N, 8) at postures (N, n), signs continuous along the rows."""
        return dq.continuous(np.array([self.pose(q) for q in postures]))

    def pose_and_jacobian(self, posture: Floats) -> tuple[Floats, Floats]:
        """Pose (8,) and the Jacobian J_w (6, n), xi = J_w q_dot, at a posture (n,) [rad]."""
        world = pinocchio.computeJointJacobians(self.model, self._data, posture)
        J: Floats = np.empty((6, self.model.nv))
        J[:3], J[3:] = world[3:], world[:3]
        return self._read_pose(), J

    def poses_and_jacobians(self, postures: Floats) -> tuple[Floats, Floats]:
        """`pose_and_jacobian` of many postures (N, n): poses (N, 8), Jacobians (N, 6, n)."""
        pairs = [self.pose_and_jacobian(q) for q in postures]
        return np.array([x for x, _ in pairs]), np.array([J for _, J in pairs])

    def task_map(self, pose: Floats) -> Floats | None:
        """From a spatial twist to what of it the task controls (..., m, 6); None for all of it."""
        rows = self.task.rows(pose)
        if rows is None:
            return None
        return np.asarray(rows @ (_UNSCALED @ tool_jacobian_map(dq.translation(pose))))

    def task_jacobian(self, pose: Floats, jacobian: Floats) -> Floats:
        """The rows (..., m, n) of J_w that the task controls, at the tool's point."""
        controlled = self.task_map(pose)
        return jacobian if controlled is None else controlled @ jacobian

    def joint_frames(self, posture: Floats) -> tuple[Floats, Floats]:
        """Rotations (n + 1, 3, 3) and positions (n + 1, 3) [m] of base and joints at a posture."""
        pinocchio.forwardKinematics(self.model, self._data, posture)
        frames = self._data.oMi.tolist()
        return np.array([f.rotation for f in frames]), np.array([f.translation for f in frames])

    def link_axes(self, posture: Floats) -> Floats:
        """The axes (n + 1, 3, 3), as columns, of what each joint sits on, then of the last link.

        Offsets as of `with_model_error` are along these; those of joints that do not carry the tool
        are zero.
        """
        pinocchio.forwardKinematics(self.model, self._data, posture)
        found = np.zeros((self.model.nv + 1, 3, 3))
        for joint in list(self.model.supports[self._joint])[1:]:
            found[joint - 1] = self._data.oMi[self.model.parents[joint]].rotation
        found[-1] = self._data.oMi[self._joint].rotation
        return found

    def screws(self) -> Screws:
        """The arm as screw axes, up to the tool."""
        home, axes = self.pose_and_jacobian(np.zeros(self.card.joints))
        return Screws(axes.T, home)

    def _read_pose(self) -> Floats:
        placement = self._data.oMi[self._joint] * self._tool
        x, y, z, qx, qy, qz, qw = pinocchio.SE3ToXYZQUATtuple(placement)
        return np.array([
            qw, qx, qy, qz,
            0.5 * (-x * qx - y * qy - z * qz),
            0.5 * (x * qw + y * qz - z * qy),
            0.5 * (y * qw + z * qx - x * qz),
            0.5 * (z * qw + x * qy - y * qx),
        ])  # fmt: skip
