"""A short drawing, an arm and what leads it -> the run that the checks look at."""

from collections.abc import Mapping
from functools import cache

import numpy as np

from dqpaint.controllers import CONTROLLERS
from dqpaint.disturbances import Disturbance
from dqpaint.dq import Floats
from dqpaint.language import parse
from dqpaint.motion import Motion, plan
from dqpaint.plants import PlantMaker
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.model import read_card
from dqpaint.simulation import Track, track

ROBOT = "iiwa"
DRAWING = """period 10 ms
start at (40, 0) mm
arc centre (0, 0) angle 90 deg in 0.6 s
line by (-10, 20, 5) mm tool rot(y, 20 deg) in 0.4 s
hold 0.2 s
"""
AWAY = (0.1, -0.1, 0.15, 0.1, -0.2, 0.1, 0.3)  # [rad] from home: nothing is special there


@cache
def arm() -> Kinematics:
    """The arm that the checks run on."""
    return Kinematics(read_card(ROBOT))


@cache
def motion() -> Motion:
    """The drawing that the checks run."""
    return plan(parse(DRAWING, "check.traj"), arm().card.canvas.pose)


def start() -> Floats:
    """The posture (7,) [rad] in which runs begin."""
    return np.asarray(arm().card.home + np.array(AWAY))


def run(
    plant: PlantMaker, disturbances: Mapping[str, Disturbance] | None = None, seed: int = 0
) -> Track:
    """The drawing on a plant, led by a law that suits it."""
    law = CONTROLLERS["hinf" if plant.takes == "rates" else "accel"]
    return track(
        motion(), arm(), start(), plant, law, law.read_gains({}),
        disturbances=disturbances or {}, seed=seed,
    )  # fmt: skip


def require(kept: bool, promise: str) -> None:
    """Raise an AssertionError with the promise that is not kept."""
    if not kept:
        raise AssertionError(promise)
