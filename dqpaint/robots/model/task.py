"""The name of a task -> which part of the tool's pose is controlled: rows of its twist."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.errors import UnknownNameError

Rows = Callable[[Floats], Floats | None]
"""From poses (..., 8) the rows (..., m, 6) of [w; the tool point's velocity], None for all six."""


@dataclass(frozen=True)
class Part:
    """What is controlled together.

    Attributes:
        rows: of the tool's twist that count.
        near: of a reference pose and the pose (..., 8), the pose nearest to it among all that are
            as good as the reference: what is left free is no error.
    """

    rows: Rows
    near: Callable[[Floats, Floats], Floats]


@dataclass(frozen=True)
class Task:
    """Which part of the tool's pose a run controls.

    Attributes:
        name: by which it is chosen.
        about: in one line.
        parts: what is controlled, the most important first; each later one as well as can be
            without a change to those before it (Siciliano and Slotine 1991).
    """

    name: str
    about: str
    parts: tuple[Part, ...]

    def rows(self, pose: Floats) -> Floats | None:
        """The rows (..., m, 6) of the part that must be reached."""
        return self.parts[0].rows(pose)

    def near(self, reference: Floats, pose: Floats) -> Floats:
        """The reference (..., 8) that is nearest to a pose within what is left free."""
        return self.parts[0].near(reference, pose)

    @property
    def dimensions(self) -> int:
        """How many numbers must be reached, 3 to 6."""
        rows = self.rows(dq.IDENTITY)
        return 6 if rows is None else len(rows)

    @property
    def is_whole(self) -> bool:
        """Whether it is the whole pose."""
        return self.dimensions == 6


def _all_rows(_pose: Floats) -> None:
    return None


def _point_rows(pose: Floats) -> Floats:
    return np.broadcast_to(np.eye(6)[3:], (*pose.shape[:-1], 3, 6))


def _beam_rows(pose: Floats) -> Floats:
    """The turns about the tool's own x and y axes, not z, and the point's velocity."""
    rows = np.zeros((*pose.shape[:-1], 5, 6))
    axes = dq.matrix_from_quaternion(dq.rotation(pose))
    rows[..., :2, :3] = axes.mT[..., :2, :]
    rows[..., 2:, 3:] = np.eye(3)
    return rows


def _turn_rows(pose: Floats) -> Floats:
    return np.broadcast_to(np.eye(6)[:3], (*pose.shape[:-1], 3, 6))


def _same(reference: Floats, _pose: Floats) -> Floats:
    return reference


def _as_it_is_held(reference: Floats, pose: Floats) -> Floats:
    """The reference position with the orientation of the pose."""
    wanted, held = np.broadcast_arrays(reference, pose)
    return dq.pose_from(dq.translation(wanted), dq.rotation(held))


def _about_its_beam(reference: Floats, pose: Floats) -> Floats:
    """The reference, turned about its own z axis to be nearest to the pose (swing and twist)."""
    between = dq.quaternion_mul(_conjugate(dq.rotation(reference)), dq.rotation(pose))
    twist = between * [1.0, 0.0, 0.0, 1.0]
    size = np.sqrt((twist * twist).sum(axis=-1, keepdims=True))
    straight = np.array([1.0, 0.0, 0.0, 0.0])  # half a turn away no twist is nearer than another
    twist = np.where(size > 1e-9, twist / np.maximum(size, 1e-9), straight)
    still = np.zeros((*twist.shape[:-1], 3))
    return dq.mul(reference, dq.pose_from(still, twist))


def _conjugate(quaternion: Floats) -> Floats:
    return quaternion * [1.0, -1.0, -1.0, -1.0]


_PLACE = Part(_point_rows, _as_it_is_held)
POSE = Task("pose", "position and orientation: 6 numbers", (Part(_all_rows, _same),))
TASKS = {
    task.name: task
    for task in (
        POSE,
        Task(
            "beam",
            "position, and where the tool's z axis points: 5 numbers; the turn about it is free",
            (Part(_beam_rows, _about_its_beam),),
        ),
        Task("point", "position: 3 numbers; the orientation is free", (_PLACE,)),
        Task(
            "place-first",
            "position first, and the orientation as well as it can be held beside it",
            (_PLACE, Part(_turn_rows, _same)),
        ),
    )
}


def find_task(name: str) -> Task:
    """The task of a name.

    Raises:
        UnknownNameError: there is none.
    """
    if name not in TASKS:
        raise UnknownNameError("task", name, list(TASKS))
    return TASKS[name]
