"""A motion and a run -> the columns of their tables, one row a control step."""

import numpy as np

from dqpaint import dq
from dqpaint.controllers.base import invariant_error
from dqpaint.dq import Floats
from dqpaint.metrics.registry import Values, column, motion_column
from dqpaint.motion import Motion
from dqpaint.simulation import Track

XYZ = ("x_m", "y_m", "z_m")
QUATERNION = ("qw", "qx", "qy", "qz")


def _desired(names: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(f"desired_{name}" for name in names)


# What was asked.


@motion_column("t_s", unit="s", title="time", meaning="time", coloured=False, study="kept")
def _time(motion: Motion) -> Floats:
    return motion.t


@motion_column(
    "line", unit="", title="line of the drawing",
    meaning="the line of the drawing that asks for what follows",
)  # fmt: skip
def _line(motion: Motion) -> Values:
    return motion.source.line


@motion_column(
    "file", unit="", title="file of the drawing", coloured=False,
    meaning="which file `line` is of, where the drawing includes others: 0 is the main one",
)  # fmt: skip
def _file(motion: Motion) -> Values | None:
    file = motion.source.file
    return file if file.any() else None


@motion_column(
    "lit", unit="", title="light", coloured=False,
    meaning="1 while the light shines until the next row",
)  # fmt: skip
def _lit(motion: Motion) -> Values:
    return motion.lit


@motion_column(*_desired(XYZ), unit="m", title="asked place", meaning="asked place")
def _asked_place(motion: Motion) -> Floats:
    return motion.points


@motion_column(
    *_desired(QUATERNION), unit="", title="asked orientation",
    meaning="asked orientation, scalar first",
)  # fmt: skip
def _asked_orientation(motion: Motion) -> Floats:
    return dq.rotation(motion.pose)


@motion_column(
    *_desired(("wx_rad_s", "wy_rad_s", "wz_rad_s")), unit="rad/s", title="asked angular velocity",
    meaning="asked angular velocity: the first half of the spatial twist", extra=True,
)  # fmt: skip
def _asked_rotation(motion: Motion) -> Floats:
    return motion.twist[:, :3]


@motion_column(
    *_desired(("vx_m_s", "vy_m_s", "vz_m_s")), unit="m/s", title="asked velocity",
    meaning="asked velocity at the base's origin: the second half of the spatial twist", extra=True,
)  # fmt: skip
def _asked_translation(motion: Motion) -> Floats:
    return motion.twist[:, 3:]


@motion_column(
    *_desired(("wx_dot_rad_s2", "wy_dot_rad_s2", "wz_dot_rad_s2")), unit="rad/s^2",
    title="asked angular acceleration", meaning="and its plain derivative", extra=True,
)  # fmt: skip
def _asked_rotation_rate(motion: Motion) -> Floats:
    return motion.acceleration[:, :3]


@motion_column(
    *_desired(("vx_dot_m_s2", "vy_dot_m_s2", "vz_dot_m_s2")), unit="m/s^2",
    title="asked acceleration", meaning="and its plain derivative", extra=True,
)  # fmt: skip
def _asked_translation_rate(motion: Motion) -> Floats:
    return motion.acceleration[:, 3:]


@motion_column(
    "light_r", "light_g", "light_b", unit="", title="colour",
    meaning="linear red, green and blue of the light until the next row", extra=True,
)  # fmt: skip
def _colour(motion: Motion) -> Floats:
    return motion.light


# What was reached.


@column(*XYZ, unit="m", title="place", meaning="place of the light, the true one")
def _place(track: Track) -> Floats:
    return track.points


@column(*QUATERNION, unit="", title="orientation", meaning="true orientation")
def _orientation(track: Track) -> Floats:
    return dq.rotation(track.pose)


@column(
    "position_error_m", unit="m", shown="mm", title="position error", from_zero=True,
    study="drawn", meaning="distance from the asked place",
)  # fmt: skip
def _position_error(track: Track) -> Floats:
    return _norm(track.points - track.motion.points)


@column(
    "orientation_error_rad", unit="rad", shown="deg", title="orientation error", from_zero=True,
    study="drawn", meaning="angle from the asked orientation",
)  # fmt: skip
def _orientation_error(track: Track) -> Floats:
    turned = dq.log(dq.mul(track.pose, dq.conj(track.motion.pose)))[:, :3]
    return 2 * _norm(turned)


@column(
    "invariant_error", unit="", title="invariant error", from_zero=True, study="kept",
    meaning="norm of 1 - x* x_d",
)  # fmt: skip
def _invariant_error(track: Track) -> Floats:
    return _norm(invariant_error(track.pose, track.motion.pose))


def _asked_speed(motion: Motion) -> Floats:
    return _norm(_velocity(motion.points, motion.period))


@column(
    "speed_m_s", unit="m/s", shown="mm/s", title="speed", from_zero=True, asked=_asked_speed,
    meaning="of the light, until the next row",
)  # fmt: skip
def _speed(track: Track) -> Floats:
    return _norm(_velocity(track.points, track.motion.period))


@column(
    "acceleration_m_s2", unit="m/s^2", title="acceleration", from_zero=True, meaning="of the light"
)
def _acceleration(track: Track) -> Floats:
    """Second differences about each row; the first and last row repeat."""
    points = track.points
    if len(points) < 3:
        return np.zeros(len(points))
    inside = np.diff(points, n=2, axis=0) / track.motion.period**2
    return _norm(np.concatenate([inside[:1], inside, inside[-1:]]))


@column(
    "effort_rad", unit="rad", title="effort", from_zero=True,
    meaning="how far the joints move until the next row",
)  # fmt: skip
def _effort(track: Track) -> Floats | None:
    if not _has_joints(track):
        return None
    return _norm(np.diff(track.posture, axis=0, append=track.posture[-1:]))


@column(
    "manipulability", unit="", title="manipulability", meaning="square root of det(J J')",
)  # fmt: skip
def _manipulability(track: Track) -> Floats | None:
    return track.manipulability if _has_joints(track) else None


@column("q{joint}_rad", unit="rad", title="joint angles", meaning="joint angles, the true ones")
def _angles(track: Track) -> Floats:
    return track.posture


@column(
    "command{joint}_rad_s", unit="rad/s", title="joint rates",
    meaning="joint rates the arm is given",
)  # fmt: skip
def _rates(track: Track) -> Floats | None:
    return None if track.torques else track.command


@column(
    "torque{joint}_Nm", unit="Nm", title="torques",
    meaning="in place of rates: torques, by a law that commands them",
)  # fmt: skip
def _torques(track: Track) -> Floats | None:
    return track.command if track.torques else None


@column(
    "read{joint}_rad", unit="rad", title="angles read",
    meaning="joint angles as the encoders read them, where these err",
)  # fmt: skip
def _readings(track: Track) -> Floats | None:
    return track.read if (track.read != track.posture).any() else None


@column(
    *(f"believed_{name}" for name in XYZ), unit="m", title="believed place",
    meaning="where the law's model has the light at these angles, if that is elsewhere",
)  # fmt: skip
def _believed_place(track: Track) -> Floats | None:
    return dq.translation(track.believed) if _errs(track) else None


@column(
    *(f"believed_{name}" for name in QUATERNION), unit="", title="believed orientation",
    meaning="and its orientation there",
)  # fmt: skip
def _believed_orientation(track: Track) -> Floats | None:
    return dq.rotation(track.believed) if _errs(track) else None


@column(
    "drawing_time_s", unit="s", title="time of the drawing", coloured=False,
    meaning="the drawing's own time, where it was slowed down",
)  # fmt: skip
def _clock(track: Track) -> Floats | None:
    motion = track.motion
    return None if motion.clock is motion.t else motion.clock


def _has_joints(track: Track) -> bool:
    """A recording may have poses alone."""
    return bool(track.posture.shape[1] > 0)


def _errs(track: Track) -> bool:
    """Whether the law was told another pose than the true one."""
    return bool((track.believed != track.pose).any())


def _velocity(points: Floats, period: float) -> Floats:
    """Forward differences (N, 3) [m/s]; the last row repeats."""
    if len(points) < 2:
        return np.zeros_like(points)
    rates = np.diff(points, axis=0) / period
    return np.concatenate([rates, rates[-1:]])


def _norm(values: Floats) -> Floats:
    return np.asarray(np.sqrt((values * values).sum(axis=-1)))
