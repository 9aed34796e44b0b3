"""Track -> numbers: the columns of the CSV and the figures of the summary.

The measures are the ones of Pereira 2016, 5.2 (integrals over the run of the norms of error,
command, effort, speed and acceleration) and of Chandra 2020 (root mean square and standard
deviation of position and orientation error).
"""

from dataclasses import dataclass

import numpy as np

from dqpaint import dq
from dqpaint.controllers.base import invariant_error
from dqpaint.dq import Floats
from dqpaint.motion import Motion
from dqpaint.simulation import Track

Table = dict[str, Floats]  # columns (N,) by their header, unit in the name


@dataclass(frozen=True, repr=False)
class Metrics:
    """What came out of a run: columns (N,) and single figures."""

    table: Table
    figures: dict[str, float]


def measure(track: Track) -> Metrics:
    """Columns and figures of a run."""
    table = {**asked_columns(track.motion), **_reached_columns(track)}
    return Metrics(table, _figures(table, track))


def asked_columns(motion: Motion) -> Table:
    """Time, source line, light, and the asked pose in the base frame."""
    file = motion.source.file
    return {
        "t_s": motion.t,
        "line": motion.source.line.astype(np.float64),
        **({"file": file.astype(np.float64)} if file.any() else {}),
        "lit": motion.lit.astype(np.float64),
        **_pose_columns("desired_", motion.points, motion.pose),
    }


def motion_columns(motion: Motion) -> Table:
    """What was asked, with spatial twist and its derivative: the file of `--save motion`."""
    twist = dict(zip(_TWIST, motion.twist.T, strict=True))
    slope = dict(zip(_ACCELERATION, motion.acceleration.T, strict=True))
    light = dict(zip(("light_r", "light_g", "light_b"), motion.light.T, strict=True))
    return {**asked_columns(motion), **twist, **slope, **light}


_TWIST = [
    f"desired_{n}" for n in ("wx_rad_s", "wy_rad_s", "wz_rad_s", "vx_m_s", "vy_m_s", "vz_m_s")
]
_ACCELERATION = [
    f"desired_{n}"
    for n in (
        *("wx_dot_rad_s2", "wy_dot_rad_s2", "wz_dot_rad_s2"),
        *("vx_dot_m_s2", "vy_dot_m_s2", "vz_dot_m_s2"),
    )
]


def _pose_columns(prefix: str, points: Floats, pose: Floats) -> Table:
    places = dict(zip((f"{prefix}{c}_m" for c in "xyz"), points.T, strict=True))
    turns = dict(zip((f"{prefix}q{c}" for c in "wxyz"), pose[:, :4].T, strict=True))
    return {**places, **turns}


def _reached_columns(track: Track) -> Table:
    motion = track.motion
    points = track.points
    turned = dq.log(dq.mul(track.pose, dq.conj(motion.pose)))[:, :3]
    velocity = _velocity(points, motion.period)
    acceleration = _acceleration(points, motion.period)
    known = track.posture.shape[1] > 0  # a recording may have poses alone
    moved = np.diff(track.posture, axis=0, append=track.posture[-1:])
    joints = range(track.posture.shape[1])
    return {
        **_pose_columns("", points, track.pose),
        "position_error_m": _norm(points - motion.points),
        "orientation_error_rad": 2 * _norm(turned),
        "invariant_error": _norm(invariant_error(track.pose, motion.pose)),
        "speed_m_s": _norm(velocity),
        "acceleration_m_s2": _norm(acceleration),
        **({"effort_rad": _norm(moved), "manipulability": track.manipulability} if known else {}),
        **{f"q{j + 1}_rad": track.posture[:, j] for j in joints},
        **{_command_column(track, j + 1): track.command[:, j] for j in joints},
        **_told_columns(track),
        **({} if motion.clock is motion.t else {"drawing_time_s": motion.clock}),
    }


def _told_columns(track: Track) -> Table:
    """What the law was told, where it was not the truth: angles read, and the pose they mean."""
    told: Table = {}
    if (track.read != track.posture).any():
        told |= {f"read{j + 1}_rad": track.read[:, j] for j in range(track.read.shape[1])}
    if (track.believed != track.pose).any():
        told |= _pose_columns("believed_", dq.translation(track.believed), track.believed)
    return told


def _command_column(track: Track, joint: int) -> str:
    return f"torque{joint}_Nm" if track.torques else f"command{joint}_rad_s"


def _velocity(points: Floats, period: float) -> Floats:
    """Forward differences (N, 3) [m/s] of where it truly was; the last row repeats."""
    if len(points) < 2:
        return np.zeros_like(points)
    rates = np.diff(points, axis=0) / period
    return np.concatenate([rates, rates[-1:]])


def _acceleration(points: Floats, period: float) -> Floats:
    """Second differences (N, 3) [m/s^2] about each row; the first and last row repeat."""
    if len(points) < 3:
        return np.zeros_like(points)
    inside = np.diff(points, n=2, axis=0) / period**2
    return np.concatenate([inside[:1], inside, inside[-1:]])


def _norm(values: Floats) -> Floats:
    return np.asarray(np.sqrt((values * values).sum(axis=-1)))


def _figures(table: Table, track: Track) -> dict[str, float]:
    period = track.motion.period

    def integral(values: Floats) -> float:
        """Over the N - 1 steps of the run; the last row's command is not carried out."""
        return float(values[:-1].sum() * period)

    figures = {"error_integral": integral(table["invariant_error"])}
    if "effort_rad" in table:
        given = "torque_integral_Nm_s" if track.torques else "command_integral_rad"
        figures[given] = integral(_norm(track.command))
        figures["effort_integral"] = integral(table["effort_rad"])
    figures["speed_integral_m"] = integral(table["speed_m_s"])
    figures["acceleration_integral"] = integral(table["acceleration_m_s2"])
    errors = ("position_error", "m"), ("orientation_error", "rad")
    for name, unit in errors:
        values = table[f"{name}_{unit}"]
        figures[f"{name}_rms_{unit}"] = float(np.sqrt((values**2).mean()))
        figures[f"{name}_std_{unit}"] = float(values.std())
        figures[f"{name}_max_{unit}"] = float(values.max())
    return figures
