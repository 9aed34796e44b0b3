"""Columns and figures of a run against plain arithmetic."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.controllers import CONTROLLERS
from dqpaint.language import parse
from dqpaint.metrics import measure, motion_columns
from dqpaint.motion import plan
from dqpaint.plants import PLANTS
from dqpaint.robots.kinematics.kinematics import Kinematics, manipulability
from dqpaint.robots.model.card import read_card
from dqpaint.simulation.closed_loop import track

CARD = read_card("iiwa")
ARM = Kinematics(CARD)
TEXT = """period 10 ms
start at (20, 10, 5) mm
line to (60, -20, 30) mm tool rot(x, 20 deg) in 1 s
hold 0.2 s light off
"""


@pytest.fixture(scope="module")
def run():
    motion = plan(parse(TEXT, "test.traj"), CARD.canvas.pose)
    controller = CONTROLLERS["p"]
    return track(motion, ARM, CARD.home, PLANTS["ideal"], controller, controller.read_gains({}))


@pytest.fixture(scope="module")
def metrics(run):
    return measure(run)


HALVES = (("w", "rad_s"), ("v", "m_s"))


def test_columns_are_the_promised_ones(metrics):
    expected = [
        *("t_s", "line", "lit"),
        *("desired_x_m", "desired_y_m", "desired_z_m"),
        *("desired_qw", "desired_qx", "desired_qy", "desired_qz"),
        *(f"desired_{half}{x}_{unit}" for half, unit in HALVES for x in "xyz"),
        *(f"desired_{half}{x}_dot_{unit}2" for half, unit in HALVES for x in "xyz"),
        *("x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"),
        *("position_error_m", "orientation_error_rad", "invariant_error"),
        *("speed_m_s", "acceleration_m_s2", "effort_rad", "manipulability"),
    ]
    for name in ("q{}_rad", "command{}_rad_s", "rate{}_rad_s"):
        expected += [name.format(i) for i in range(1, 8)]
    expected += [f"twist_error_{half}{x}_{unit}" for half, unit in HALVES for x in "xyz"]
    assert list(metrics.table) == expected
    assert {len(column) for column in metrics.table.values()} == {121}


def test_error_columns_by_homogeneous_matrices(run, metrics):
    T, T_d = dq.matrix_from_pose(run.pose), dq.matrix_from_pose(run.motion.pose)
    gap = np.linalg.norm(T[:, :3, 3] - T_d[:, :3, 3], axis=1)
    np.testing.assert_allclose(metrics.table["position_error_m"], gap, atol=1e-15)
    trace = np.trace(T[:, :3, :3] @ T_d[:, :3, :3].swapaxes(1, 2), axis1=1, axis2=2)
    angle = np.arccos(np.clip((trace - 1) / 2, -1, 1))
    np.testing.assert_allclose(metrics.table["orientation_error_rad"], angle, atol=1e-7)
    # |1 - x* x_d|^2 = |1 - r* r_d|^2 + |d|^2: 2 sin(angle / 4), and half the distance
    wanted = np.sqrt((2 * np.sin(angle / 4)) ** 2 + (gap / 2) ** 2)
    np.testing.assert_allclose(metrics.table["invariant_error"], wanted, atol=1e-7)


def test_rates_are_those_of_what_was_measured(run, metrics):
    points = dq.matrix_from_pose(run.pose)[:, :3, 3]
    np.testing.assert_allclose(
        metrics.table["speed_m_s"][:-1] * 0.01,
        np.linalg.norm(np.diff(points, axis=0), axis=1),
        atol=1e-12,
    )
    moved = np.linalg.norm(np.diff(run.posture, axis=0), axis=1)
    np.testing.assert_allclose(metrics.table["effort_rad"], [*moved, 0.0], atol=1e-12)


def test_figures_are_integrals_and_spreads_of_the_columns(run, metrics):
    figures, table = metrics.figures, metrics.table
    e = table["position_error_m"]
    assert figures["position_error_rms_m"] == pytest.approx(np.sqrt(e.var() + e.mean() ** 2))
    assert figures["position_error_std_m"] == pytest.approx(e.std())
    assert figures["position_error_max_m"] == e.max()
    assert figures["command_integral_rad"] == pytest.approx(
        0.01 * np.linalg.norm(run.command[:-1], axis=1).sum()
    )
    assert figures["error_integral"] == pytest.approx(0.01 * table["invariant_error"][:-1].sum())
    path = np.linalg.norm(np.diff(run.points, axis=0), axis=1).sum()
    assert figures["speed_integral_m"] == pytest.approx(path, rel=1e-12)  # the way that was gone
    second = run.points[2:] - 2 * run.points[1:-1] + run.points[:-2]
    np.testing.assert_allclose(
        table["acceleration_m_s2"][1:-1], np.linalg.norm(second, axis=1) / 0.01**2, atol=1e-9
    )
    assert figures["acceleration_integral"] == pytest.approx(
        0.01 * table["acceleration_m_s2"][:-1].sum()
    )
    turned = table["orientation_error_rad"]
    assert figures["orientation_error_rms_rad"] == pytest.approx(np.sqrt((turned**2).mean()))
    assert table["acceleration_m_s2"][-1] == table["acceleration_m_s2"][-2]


def test_manipulability_is_that_of_the_measured_posture(run, metrics):
    for k in (0, 57, 120):
        J = ARM.pose_and_jacobian(run.posture[k])[1]
        assert metrics.table["manipulability"][k] == pytest.approx(manipulability(J), rel=1e-10)


def test_light_and_lines_follow_the_text(metrics):
    np.testing.assert_array_equal(metrics.table["lit"], [1] * 100 + [0] * 21)
    np.testing.assert_array_equal(metrics.table["line"], [3] * 100 + [4] * 21)


def test_the_motion_file_has_twist_and_acceleration_that_agree_with_its_poses(run):
    table = motion_columns(run.motion)
    points = np.stack([table[f"desired_{c}_m"] for c in "xyz"], axis=1)
    w = np.stack([table[f"desired_w{c}_rad_s"] for c in "xyz"], axis=1)
    v0 = np.stack([table[f"desired_v{c}_m_s"] for c in "xyz"], axis=1)
    inside = slice(30, 70)
    velocity = (points[31:71] - points[29:69]) / 0.02
    np.testing.assert_allclose((v0 + np.cross(w, points))[inside], velocity, atol=1e-6)
    v0_dot = np.stack([table[f"desired_v{c}_dot_m_s2"] for c in "xyz"], axis=1)
    np.testing.assert_allclose(v0_dot[inside], (v0[31:71] - v0[29:69]) / 0.02, atol=1e-5)


def test_a_single_row_has_finite_columns():
    motion = plan(parse("period 10 ms\nhold 10 ms\n", "t"), CARD.canvas.pose)
    controller = CONTROLLERS["p"]
    result = track(motion, ARM, CARD.home, PLANTS["ideal"], controller, controller.read_gains({}))
    for name, column in measure(result).table.items():
        assert np.isfinite(column).all(), name
