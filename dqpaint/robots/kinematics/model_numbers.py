"""An arm's model -> the numbers that say it: screws, masses, friction, limits, all at q = 0."""

from typing import TYPE_CHECKING

import numpy as np
from typing_extensions import TypedDict

from dqpaint.core import PINOCCHIO, Library
from dqpaint.robots.kinematics.kinematics import Kinematics

if TYPE_CHECKING:
    import pinocchio
else:
    pinocchio = Library("pinocchio", PINOCCHIO)


class ModelNumbers(TypedDict):
    """A chain of joints that turn, in the base frame with all joints at zero; SI units.

    The pose at joint angles q is exp(q_1 s_1 / 2) ... exp(q_n s_n / 2) home.

    Attributes:
        screws: s_i, the unit twist of each joint (n, 6), angular part first.
        home: the tool's pose (8,).
        mass_kg: of what each joint carries up to the next one (n,).
        centre_m: its centre of mass (n, 3).
        inertia_kg_m2: about that centre, along the base's axes (n, 3, 3).
        friction_Nm_s_rad: viscous, of each joint (n,).
        gravity_m_s2: (3,).
        lower_rad: limits of the joints (n,).
        upper_rad: likewise.
        speed_rad_s: likewise.
        torque_Nm: likewise, of their motors.
    """

    screws: list[list[float]]
    home: list[float]
    mass_kg: list[float]
    centre_m: list[list[float]]
    inertia_kg_m2: list[list[list[float]]]
    friction_Nm_s_rad: list[float]
    gravity_m_s2: list[float]
    lower_rad: list[float]
    upper_rad: list[float]
    speed_rad_s: list[float]
    torque_Nm: list[float]


def model_numbers(kinematics: Kinematics) -> ModelNumbers:
    """The numbers of a model, such as a law's; see `ModelNumbers`."""
    model, card = kinematics.model, kinematics.card
    data = model.createData()
    pinocchio.forwardKinematics(model, data, np.zeros(model.nq))
    screws = kinematics.screws()
    bodies = [data.oMi[i] * model.inertias[i] for i in range(1, model.njoints)]
    return {
        "screws": screws.axes.tolist(),
        "home": screws.home.tolist(),
        "mass_kg": [float(body.mass) for body in bodies],
        "centre_m": [body.lever.tolist() for body in bodies],
        "inertia_kg_m2": [body.inertia.tolist() for body in bodies],
        "friction_Nm_s_rad": model.damping.tolist(),
        "gravity_m_s2": model.gravity.linear.tolist(),
        "lower_rad": card.lower.tolist(),
        "upper_rad": card.upper.tolist(),
        "speed_rad_s": card.speed.tolist(),
        "torque_Nm": card.effort.tolist(),
    }
