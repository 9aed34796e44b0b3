"""Drawings that an arm cannot follow as they are."""

import numpy as np

from dqpaint import dq
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card

FAST = """period 8 ms
start at (-100, 0) mm
line to (100, 60) mm speed 1500 mm/s
line to (100, -60) mm speed 100 mm/s
arc centre (0, -60) mm angle 180 deg speed 1500 mm/s
hold 0.5 s
"""


BEYOND = "period 8 ms\nhold 0.2 s\nline to (0, 0) mm tool rot(z, 150 deg)\n"  # joint 7 ends at 175


def past_a_singularity():
    """Past the wrist's singularity of the xArm 6, 1 degree beside it, at 300 mm/s."""
    arm = Kinematics(read_card("xarm6"))
    q = arm.card.home
    q[4] = np.radians(1.0)
    x = arm.pose(q)
    at = ", ".join(f"{c:.4f}" for c in dq.translation(x) * 1e3)
    turn = ", ".join(f"{c:.9f}" for c in dq.rotation(x))
    return (
        f"period 8 ms\nrobot xarm6\nplace at ({at}) mm turned quat({turn})\n"
        "start at (0, -80) mm\nline to (0, 80) mm speed 300 mm/s\n"
    )


def far_out():
    """0.7 m in front of the iiwa's shoulder, and sideways to 110 % of its reach."""
    card = read_card("iiwa")
    reach = 0.42 + 0.4 + 0.081 + 0.08  # upper arm, forearm, wrist to flange face, lamp
    far = np.sqrt((1.1 * reach) ** 2 - card.canvas.at_m[0] ** 2 - (0.5 - 0.36) ** 2)
    return f"period 8 ms\nline to ({far * 1e3:.0f}, 0) mm\n"
