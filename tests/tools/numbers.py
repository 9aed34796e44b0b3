"""The file of an installed arm -> the table [numbers] of its card, as TOML.

python -m tests.tools.numbers NAME RADIUS ...     radii of the base and of each link [m]
"""

import sys

import numpy as np
import pinocchio

from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.robots.urdf import roll_pitch_yaw

DIGITS = 12


def main(name, *radii):
    card = read_card(name)
    model = Kinematics(card).model
    print("\n[numbers]  # the arm where its package is not installed: masses and chain of its file")
    print(f"radius_m = {row([float(r) for r in radii])}")
    flange = model.frames[model.getFrameId(card.link, pinocchio.FrameType.BODY)].placement
    if not flange.isIdentity():
        print(f"flange = {{ {place(flange)} }}")
    for i in range(1, model.njoints):
        assert model.joints[i].shortname() == "JointModelRZ"
        body = model.inertias[i]
        print("\n[[numbers.links]]")
        print(place(model.jointPlacements[i], "\n"))
        print(f"mass_kg = {number(body.mass)}")
        print(f"centre_m = {row(body.lever)}")
        print(f"inertia_kg_m2 = {row(body.inertia[np.triu_indices(3)])}")
        if model.damping[i - 1]:
            print(f"friction_Nm_s = {number(model.damping[i - 1])}")


def place(pose, between=", "):
    parts = [f"at_m = {row(pose.translation)}"]
    turn = np.degrees(roll_pitch_yaw(pose.rotation))
    if np.abs(turn).max() > 1e-9:
        parts.append(f"rpy_deg = {row(np.round(turn, 9))}")
    return between.join(parts)


def row(values):
    return f"[{', '.join(map(number, values))}]"


def number(value):
    rounded = float(f"{value:.{DIGITS}g}")
    return (
        f"{0.0 if abs(rounded) < 1e-15 else rounded:g}"
        if rounded == float(f"{rounded:g}")
        else repr(rounded)
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
