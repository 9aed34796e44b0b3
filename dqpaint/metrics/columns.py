"""A motion and a run -> the columns of their tables, one row a control step."""

import numpy as np

from dqpaint import dq
from dqpaint.controllers.base import invariant_error, spatial_error
from dqpaint.dq import Floats
from dqpaint.metrics.registry import Values, column, motion_column
from dqpaint.motion import Motion
from dqpaint.simulation import Track

# The reference.


@motion_column("t_s", "s", "time", "time", coloured=False, study="kept", equation="t_k = k T")
def _time(motion: Motion) -> Floats:
    return motion.t


@motion_column("line", "", "line of the drawing",
               "the line of the drawing that the row belongs to",
               equation='line_k = "the line that row k is drawn by"')  # fmt: skip
def _line(motion: Motion) -> Values:
    return motion.source.line


@motion_column("file", "", "file of the drawing",
               "which file `line` is of, where the drawing includes others: 0 is the main one",
               coloured=False,
               equation='file_k = "the file that this line is in"')  # fmt: skip
def _file(motion: Motion) -> Values | None:
    file = motion.source.file
    return file if file.any() else None


@motion_column(
    "lit",
    "",
    "light",
    "1 while the light shines until the next row",
    coloured=False,
    equation='lit_k = 1 "while the light shines between" t_k "and" t_k + T, 0 "else"',
)
def _lit(motion: Motion) -> Values:
    return motion.lit


@motion_column("desired_x_m desired_y_m desired_z_m", "m", "reference position",
               "reference position",
               equation="t_d = 2 d_d r_d^*, x_d = r_d + eps d_d")  # fmt: skip
def _reference_position(motion: Motion) -> Floats:
    return motion.points


@motion_column("desired_qw desired_qx desired_qy desired_qz", "", "reference orientation",
               "reference orientation, scalar first",
               equation='r_d "of" x_d = r_d + eps 1/2 t_d r_d')  # fmt: skip
def _reference_orientation(motion: Motion) -> Floats:
    return dq.rotation(motion.pose)


@motion_column("desired_wx_rad_s desired_wy_rad_s desired_wz_rad_s", "rad/s",
               "reference angular velocity",
               "reference angular velocity: the first half of the spatial twist",
               equation='w_d "of" xi_d = w_d + eps v_d, x_d_dot = 1/2 xi_d x_d')  # fmt: skip
def _reference_angular_velocity(motion: Motion) -> Floats:
    return motion.twist[:, :3]


@motion_column("desired_vx_m_s desired_vy_m_s desired_vz_m_s", "m/s", "reference velocity",
               "reference velocity at the base's origin: the second half of the spatial twist",
               equation="v_d = t_d_dot + t_d cross w_d")  # fmt: skip
def _reference_velocity(motion: Motion) -> Floats:
    return motion.twist[:, 3:]


@motion_column("desired_wx_dot_rad_s2 desired_wy_dot_rad_s2 desired_wz_dot_rad_s2", "rad/s^2",
               "reference angular acceleration", "plain derivative of the twist's first half",
               equation='w_d_dot "of" xi_d_dot = w_d_dot + eps v_d_dot')  # fmt: skip
def _reference_angular_acceleration(motion: Motion) -> Floats:
    return motion.acceleration[:, :3]


@motion_column("desired_vx_dot_m_s2 desired_vy_dot_m_s2 desired_vz_dot_m_s2", "m/s^2",
               "reference acceleration", "plain derivative of the twist's second half",
               equation="v_d_dot = t_d_ddot + t_d_dot cross w_d + t_d cross w_d_dot")  # fmt: skip
def _reference_acceleration(motion: Motion) -> Floats:
    return motion.acceleration[:, 3:]


@motion_column("light_r light_g light_b", "", "colour",
               "linear red, green and blue of the light until the next row",
               motion_only=True,
               equation="c = (c_r, c_g, c_b), c_i >= 0")  # fmt: skip
def _colour(motion: Motion) -> Floats:
    return motion.light


# The run.


@column(
    "x_m y_m z_m",
    "m",
    "position",
    "true position of the light",
    equation="t = 2 d r^*, x = r + eps d",
)
def _position(track: Track) -> Floats:
    return track.points


@column("qw qx qy qz", "", "orientation", "true orientation", equation='r "of" x = r + eps 1/2 t r')
def _orientation(track: Track) -> Floats:
    return dq.rotation(track.pose)


@column("position_error_m", "m", "position error", "distance from the reference position",
        display_unit="mm", from_zero=True, study="drawn",
        equation="|t - t_d|")  # fmt: skip
def _position_error(track: Track) -> Floats:
    return _norm(track.points - track.motion.points)


@column("orientation_error_rad", "rad", "orientation error", "angle from the reference orientation",
        display_unit="deg", from_zero=True, study="drawn",
        equation="|theta|, 2 log(x x_d^*) = theta + eps s")  # fmt: skip
def _orientation_error(track: Track) -> Floats:
    return 2 * _norm(dq.log(dq.mul(track.pose, dq.conj(track.motion.pose)))[:, :3])


@column("invariant_error", "", "invariant error", "norm of 1 - x* x_d",
        from_zero=True, study="kept",
        equation="|vec(1 - x^* x_d)|")  # fmt: skip
def _invariant_error(track: Track) -> Floats:
    return _norm(invariant_error(track.pose, track.motion.pose))


def _reference_speed(motion: Motion) -> Floats:
    return _norm(_velocity(motion.points, motion.period))


@column("speed_m_s", "m/s", "speed", "speed of the light until the next row",
        display_unit="mm/s", from_zero=True, reference=_reference_speed,
        equation="|t_(k+1) - t_k| / T")  # fmt: skip
def _speed(track: Track) -> Floats:
    return _norm(_velocity(track.points, track.motion.period))


@column(
    "acceleration_m_s2",
    "m/s^2",
    "acceleration",
    "acceleration of the light",
    from_zero=True,
    equation="|t_(k+1) - 2 t_k + t_(k-1)| / T^2",
)
def _acceleration(track: Track) -> Floats:
    """Second differences about each row; the first and last row repeat."""
    points = track.points
    if len(points) < 3:
        return np.zeros(len(points))
    inside = np.diff(points, n=2, axis=0) / track.motion.period**2
    return _norm(np.concatenate([inside[:1], inside, inside[-1:]]))


@column("effort_rad", "rad", "effort", "norm of the joint displacements until the next row",
        from_zero=True,
        equation="|q_(k+1) - q_k|")  # fmt: skip
def _effort(track: Track) -> Floats | None:
    moved = np.diff(track.posture, axis=0, append=track.posture[-1:])
    return _norm(moved) if _has_joints(track) else None


@column(
    "manipulability",
    "",
    "manipulability",
    "square root of det(J J')",
    equation="sqrt(det(J_w J_w'))",
)
def _manipulability(track: Track) -> Floats | None:
    return track.manipulability if _has_joints(track) else None


@column("q{joint}_rad", "rad", "joint angles", "true joint angles", equation="q")
def _angles(track: Track) -> Floats:
    return track.posture


@column(
    "command{joint}_rad_s",
    "rad/s",
    "joint rates",
    "commanded joint rates",
    equation="q_dot = clip(J_w^+ u + (I - J_w^+ J_w) z)",
)
def _rates(track: Track) -> Floats | None:
    return None if track.torques else track.command


@column("torque{joint}_Nm", "Nm", "torques",
        "commanded torques, of a law that commands these instead of rates",
        equation="tau = clip(H q_ddot + C q_dot + G)")  # fmt: skip
def _torques(track: Track) -> Floats | None:
    return track.command if track.torques else None


@column("disturbance_wx_rad_s disturbance_wy_rad_s disturbance_wz_rad_s", "rad/s",
        "angular disturbance",
        "first half of the spatial twist that carries the tool until the next row besides the "
        "arm, where one does; along the base's axes",
        equation='v_w "of" x_dot = 1/2 (xi + v_w + eps v_t) x')  # fmt: skip
def _angular_disturbance(track: Track) -> Floats | None:
    return track.disturbance[:, :3] if track.disturbance.any() else None


@column("disturbance_vx_m_s disturbance_vy_m_s disturbance_vz_m_s", "m/s", "linear disturbance",
        "its second half, at the base's origin",
        equation='v_t "of" x_dot = 1/2 (xi + v_w + eps v_t) x')  # fmt: skip
def _linear_disturbance(track: Track) -> Floats | None:
    return track.disturbance[:, 3:] if track.disturbance.any() else None


@column("offset_wx_rad_s offset_wy_rad_s offset_wz_rad_s", "rad/s", "angular offset rate",
        "first half of the spatial twist by which the tool's displacement changes until the next "
        "row, where it is displaced: v_c of Pereira 2016, (3.17)",
        equation='w_c "of" v_c = Ad(x) v, c_dot = 1/2 c v')  # fmt: skip
def _angular_offset_rate(track: Track) -> Floats | None:
    return track.pose_disturbance[:, :3] if track.pose_disturbance.any() else None


@column("offset_vx_m_s offset_vy_m_s offset_vz_m_s", "m/s", "linear offset rate",
        "its second half, at the base's origin",
        equation='v_c = Ad(x) v, c_dot = 1/2 c v')  # fmt: skip
def _linear_offset_rate(track: Track) -> Floats | None:
    return track.pose_disturbance[:, 3:] if track.pose_disturbance.any() else None


@column("unclipped{joint}_rad_s", "rad/s", "joint rates before limits",
        "commanded joint rates before limits clipped them, where any did",
        equation="q_dot = J_w^+ u + (I - J_w^+ J_w) z")  # fmt: skip
def _unclipped_rates(track: Track) -> Floats | None:
    return None if track.torques else _unclipped(track)


@column("unclipped{joint}_Nm", "Nm", "torques before limits",
        "commanded torques before limits clipped them, where any did",
        equation="tau = H q_ddot + C q_dot + G")  # fmt: skip
def _unclipped_torques(track: Track) -> Floats | None:
    return _unclipped(track) if track.torques else None


@column("clipped_joints", "", "clipped joints",
        "how many joints a limit clips until the next row, where any is",
        from_zero=True, equation="sum_i (u_i != clip(u_i))")  # fmt: skip
def _clipped_joints(track: Track) -> Floats | None:
    if not track.clipped:
        return None
    clipped = np.zeros(track.command.shape, bool)
    for where in track.clipped.values():
        clipped |= where
    return np.asarray(clipped.sum(axis=1), np.float64)


@column("motor{joint}_Nm", "Nm", "motor torques",
        "torques that the motors gave, the largest of the period before the row; where the plant "
        "has motors",
        equation="max |tau_m(t)|, t_(k-1) < t <= t_k")  # fmt: skip
def _motor_torques(track: Track) -> Floats | None:
    return track.effort if track.effort.any() else None


@column("rate{joint}_rad_s", "rad/s", "measured rates",
        "joint rates as the encoders measure them; not in a recorded run",
        equation='q_dot "as the encoders read it"')  # fmt: skip
def _measured_rates(track: Track) -> Floats:
    return track.measured_rates


@column("twist_error_wx_rad_s twist_error_wy_rad_s twist_error_wz_rad_s", "rad/s",
        "angular twist error",
        "first half of Ad(x x_d*) xi_d - xi: the reference twist, carried from the reference pose "
        "to the measured one, less the measured twist; along the base's axes; not in a recorded "
        "run",
        equation='w_e "of" xi_e = Ad(x x_d^*) xi_d - xi')  # fmt: skip
def _angular_twist_error(track: Track) -> Floats | None:
    error = _twist_error(track)
    return None if error is None else error[:, :3]


@column("twist_error_vx_m_s twist_error_vy_m_s twist_error_vz_m_s", "m/s", "linear twist error",
        "its second half, at the base's origin",
        equation='v_e "of" xi_e = Ad(x x_d^*) xi_d - xi')  # fmt: skip
def _linear_twist_error(track: Track) -> Floats | None:
    error = _twist_error(track)
    return None if error is None else error[:, 3:]


@column("read{joint}_rad", "rad", "measured angles",
        "joint angles that the encoders measure, where these have errors",
        equation='round(q + n), n "of the encoders"')  # fmt: skip
def _measured_angles(track: Track) -> Floats | None:
    return track.measured_posture if (track.measured_posture != track.posture).any() else None


@column("believed_x_m believed_y_m believed_z_m", "m", "measured position",
        "position of the light as the law measures it, where that is not the true one",
        equation="t \"of\" x(q + n) \"by the law's model\"")  # fmt: skip
def _measured_position(track: Track) -> Floats | None:
    return dq.translation(track.measured_pose) if _has_measurement_errors(track) else None


@column("believed_qw believed_qx believed_qy believed_qz", "", "measured orientation",
        "orientation of the tool as the law measures it, likewise",
        equation="r \"of\" x(q + n) \"by the law's model\"")  # fmt: skip
def _measured_orientation(track: Track) -> Floats | None:
    return dq.rotation(track.measured_pose) if _has_measurement_errors(track) else None


@column("drawing_time_s", "s", "time of the drawing",
        "the drawing's own time, where it was slowed down", coloured=False,
        equation="s(t), 0 < s_dot <= 1")  # fmt: skip
def _clock(track: Track) -> Floats | None:
    return None if track.motion.clock is track.motion.t else track.motion.clock


def _unclipped(track: Track) -> Floats | None:
    """Commands (N, n) before limits clipped them; None where none did."""
    return track.unclipped if (track.unclipped != track.command).any() else None


def _twist_error(track: Track) -> Floats | None:
    """Ad(x x_d*) xi_d - xi (N, 6), of the measured pose and twist; None of a recording."""
    if not track.measured_twist.size:
        return None
    apart = spatial_error(track.measured_pose, track.motion.pose)
    return dq.adjoint(apart, track.motion.twist) - track.measured_twist


def _has_joints(track: Track) -> bool:
    """A recording may have poses alone."""
    return bool(track.posture.shape[1] > 0)


def _has_measurement_errors(track: Track) -> bool:
    """Whether the law measured another pose than the true one."""
    return bool((track.measured_pose != track.pose).any())


def _velocity(points: Floats, period: float) -> Floats:
    """Forward differences (N, 3) [m/s]; the last row repeats."""
    if len(points) < 2:
        return np.zeros_like(points)
    rates = np.diff(points, axis=0) / period
    return np.concatenate([rates, rates[-1:]])


def _norm(values: Floats) -> Floats:
    return np.asarray(np.sqrt((values * values).sum(axis=-1)))
