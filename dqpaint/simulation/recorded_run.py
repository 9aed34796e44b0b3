"""A CSV or a bag of a real arm's joints or poses -> Track, on the drawing's own clock.

Between two rows a joint goes along a monotone cubic (Fritsch and Butland 1984): smooth, through
every row, and never beyond the two it lies between. A pose goes along the one screw from row to row
(ScLERP). Before the first row and after the last the arm is at rest. All assumptions are reported
as notes.
"""

import hashlib
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from dqpaint import dq
from dqpaint.controllers import Controller, Gains, Seen
from dqpaint.core import NumberTable, read_regular
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.motion import Motion
from dqpaint.robots.kinematics import Kinematics, manipulability
from dqpaint.robots.walls import among_walls
from dqpaint.simulation.closed_loop import Track

POSE = ("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")
NORM_TOLERANCE = 1e-3  # a quaternion's norm may be off 1 by this: it was printed with few digits
LONG_GAP = 0.05  # [s] between two rows that is worth a word, if it is several periods
SAME_TIME = 1e-9  # [s]
BAG_ENDING = ".mcap"
LARGEST_BAG = 500_000_000  # bytes of a file


@dataclass(frozen=True, repr=False)
class Recording:
    """The run of an arm as a file records it; times strictly increase.

    Attributes:
        name: of the file.
        sha256: of its bytes.
        t: times (M,) [s] since the drawing began.
        postures: joint angles (M, n) [rad]; None where the file has poses instead.
        poses: of the light (M, 8) in the base frame, signs continuous; None where it has joints.
        commands: of the joints at each row (M, n): rates [rad/s] or torques [Nm]; None where the
            file has none.
        torques: whether the commands are torques.
        remarks: what was assumed when it was read, one sentence each.
    """

    name: str
    sha256: str
    t: Floats
    postures: Floats | None
    poses: Floats | None
    commands: Floats | None
    torques: bool
    remarks: tuple[str, ...] = ()

    @property
    def as_json(self) -> dict[str, Any]:
        """For a summary."""
        return {
            "file": self.name,
            "sha256": self.sha256,
            "rows": len(self.t),
            "start_s": float(self.t[0]),
            "end_s": float(self.t[-1]),
            "of": "joints" if self.poses is None else "poses",
        }

    def notes(self, motion: Motion) -> tuple[str, ...]:
        """The assumptions that bring it onto a drawing's clock, one sentence each."""
        way = "joints on monotone cubics" if self.poses is None else "poses on screws"
        found = [*self.remarks, f"{self.name}: {len(self.t)} rows, between them {way}"]
        end = float(motion.t[-1])
        for held, when in (
            (self.t[0], "before the first row"),
            (end - self.t[-1], "after its end"),
        ):
            if held > motion.period:
                found.append(f"{self.name} lacks {held:.3g} s {when}: the arm stands still there")
        if self.t[-1] - end > motion.period:
            found.append(
                f"{self.name} goes on for {self.t[-1] - end:.3g} s after the drawing's end"
            )
        gaps = np.diff(self.t)
        if len(gaps) and gaps.max() > max(LONG_GAP, 3 * motion.period):
            at = int(gaps.argmax())
            found.append(f"{self.name} has a gap of {gaps[at]:.3g} s, at {self.t[at]:.3f} s")
        return tuple(found)


def _refuse_to_command(_seen: Seen, _gains: Gains) -> Floats:
    """The law is not known: the arm was driven elsewhere."""
    raise UsageError("a recorded run has no law")


RECORDED: Controller[Gains] = Controller(
    "recorded", "a recorded run", Gains, _refuse_to_command, "rates"
)


def read_recording(path: str, names: Sequence[str]) -> Recording:
    """The run in a CSV file, or in a bag: an MCAP file, see `recorded_bag`.

    Of a CSV the first row that is not empty and does not begin with # names the columns: `t_s`, and
    all of `q1_rad ...` (or `q1_deg ...`) or all of `x_m y_m z_m qw qx qy qz`; joints are taken
    where it has both. `command1_rad_s ...` or `torque1_Nm ...` are taken too; other columns are
    left alone.

    Args:
        path: of the file.
        names: of the arm's joints; a bag has joints by these.

    Raises:
        UsageError: the file cannot be read.
        DqpaintError: it is not such a table; file, row and column are named.
    """
    if Path(path).suffix == BAG_ENDING:
        return _from_bag(path, names)
    joints = len(names)
    table = NumberTable(path, "recorded run")
    t = table.times()
    postures = _joints(table, joints)
    poses = None if postures is not None else _poses(table)
    commands, torques = _commands(table, joints) if postures is not None else (None, False)
    return Recording(table.name, table.sha256, t, postures, poses, commands, torques)


def _from_bag(path: str, names: Sequence[str]) -> Recording:
    """The run in an MCAP file."""
    from dqpaint.simulation.recorded_bag import read_bag

    name = Path(path).name
    try:
        data = read_regular(path, LARGEST_BAG)
    except OSError as problem:
        raise UsageError(f"recorded run '{path}' cannot be read: {problem.strerror}") from None
    found = read_bag(name, data, names)
    digest = hashlib.sha256(data).hexdigest()
    return Recording(
        name, digest, found.t, found.postures, None, found.commands, found.torques, found.remarks
    )


def _joints(table: NumberTable, joints: int) -> Floats | None:
    """Joint angles (M, n) [rad], where the file has them."""
    found = [name for name in table.names if re.fullmatch(r"q\d+_(rad|deg)", name)]
    if not found:
        return None
    units = {name.rpartition("_")[2] for name in found}
    if len(units) > 1:
        raise DqpaintError(f"{table.name} has joints in rad and in deg: use one of them")
    if len(found) != joints:
        raise DqpaintError(
            f"{table.name} has {len(found)} joints ({found[0]} ... {found[-1]}), "
            f"but this arm has {joints}; choose another with --robot"
        )
    unit = units.pop()
    angles = table.columns([f"q{i + 1}_{unit}" for i in range(joints)])
    return np.radians(angles) if unit == "deg" else angles


def _poses(table: NumberTable) -> Floats:
    """Poses (M, 8) of the light."""
    if not any(name in table.names for name in POSE):
        raise DqpaintError(
            f"{table.name} has neither joints (q1_rad ... or q1_deg ...) nor poses "
            f"({', '.join(POSE)})"
        )
    values = table.columns(POSE)
    length = np.linalg.norm(values[:, 3:], axis=1)
    off = np.flatnonzero(np.abs(length - 1) > NORM_TOLERANCE)
    if len(off):
        text = f"the quaternion has the length {length[off[0]]:.6g}, not 1"
        raise table.fault(table.rows[int(off[0])], "qw", text)
    return dq.continuous(dq.pose_from(values[:, :3], values[:, 3:] / length[:, None]))


def _commands(table: NumberTable, joints: int) -> tuple[Floats | None, bool]:
    """The commands (M, n) where the file has those of all joints; whether they are torques."""
    for form, torques in (("command{}_rad_s", False), ("torque{}_Nm", True)):
        names = [form.format(i + 1) for i in range(joints)]
        if all(name in table.names for name in names):
            return table.columns(names), torques
    return None, False


def replay(recording: Recording, motion: Motion, kinematics: Kinematics) -> Track:
    """A recorded run as a track of the drawing, measured like a simulated one.

    A recording of poses has no joints: the track's arrays of joints then have none.

    Raises:
        DqpaintError: it has nothing of the drawing's time.
    """
    t, end = recording.t, float(motion.t[-1])
    if t[0] > end or t[-1] < 0:
        raise DqpaintError(
            f"{recording.name} goes from {t[0]:.9g} s to {t[-1]:.9g} s, but the drawing from 0 s "
            f"to {end:.6g} s: t_s counts from the drawing's beginning"
        )
    now = np.clip(motion.t, t[0], t[-1])
    n = len(motion.t)
    if recording.postures is None:
        assert recording.poses is not None
        posture = command = np.zeros((n, 0))
        pose, measure = along_screws(t, recording.poses, now), np.zeros(n)
    else:
        posture = along_cubics(t, recording.postures, now)
        pose, J = kinematics.poses_and_jacobians(posture)
        measure = manipulability(J)
        command = _recorded_commands(recording, posture, motion)
    pose[0] = dq.nearest(pose[0], motion.pose[0])
    pose = dq.continuous(pose)
    return Track(
        motion=motion,
        posture=posture,
        pose=pose,
        measured_posture=posture,
        measured_pose=pose,
        measured_rates=np.zeros((n, 0)),
        measured_twist=np.zeros((n, 0)),
        manipulability=measure,
        command=command,
        unclipped=command,
        torques=recording.torques,
        effort=np.zeros_like(posture),
        clamps=(),
        clipped=None,
        walls=among_walls(motion, kinematics, posture),
        disturbance=np.zeros((n, 6)),
        pose_disturbance=np.zeros((n, 6)),
    )


def _recorded_commands(recording: Recording, posture: Floats, motion: Motion) -> Floats:
    """The commands at each row (N, n): those recorded, else the joint rates."""
    if recording.commands is None:
        rates = np.diff(posture, axis=0, append=posture[-1:]) / motion.period
        return np.asarray(rates)
    row = np.searchsorted(recording.t, motion.t + SAME_TIME, side="right") - 1
    return np.asarray(recording.commands[np.clip(row, 0, len(recording.t) - 1)])


def along_cubics(t: Floats, values: Floats, at: Floats) -> Floats:
    """Values (K, n) at times (K,) between rows (M, n), by monotone cubics.

    Slopes are the weighted harmonic means of the neighbouring secants, and zero where these have
    different signs: Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5 (1984). At both ends they are
    the secants.
    """
    if len(t) == 1:
        return np.repeat(values, len(at), axis=0)
    from scipy.interpolate import CubicHermiteSpline, PchipInterpolator  # slow to import

    slope = PchipInterpolator(t, values)(t, 1)
    slope[[0, -1]] = (np.diff(values, axis=0) / np.diff(t)[:, None])[[0, -1]]
    return np.asarray(CubicHermiteSpline(t, values, slope)(at))


def along_screws(t: Floats, poses: Floats, at: Floats) -> Floats:
    """Poses (K, 8) at times (K,) between rows (M, 8), along the screw from each to the next."""
    if len(t) == 1:
        return np.repeat(poses, len(at), axis=0)
    k = np.clip(np.searchsorted(t, at, side="right") - 1, 0, len(t) - 2)
    return dq.sclerp(poses[k], poses[k + 1], (at - t[k]) / (t[k + 1] - t[k]))
