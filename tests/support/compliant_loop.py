"""The compliant arm beside half a circle, under a law -> its error, and how restless it is."""

from functools import cache

import numpy as np

from dqpaint.controllers import CONTROLLERS
from dqpaint.language import parse
from dqpaint.motion import plan
from dqpaint.planning.reachability import reachable_start_posture
from dqpaint.plants import choose_plant
from dqpaint.robots.kinematics.kinematics import Kinematics
from dqpaint.robots.model.card import read_card
from dqpaint.simulation.closed_loop import track

TEXT = "period 8 ms\nstart at (60, 0) mm\narc centre (0, 0) angle 180 deg in 3 s profile constant\n"
ASIDE = 0.05  # [rad] in every joint, where it begins

ARMS = ("iiwa", "meka-a2")


@cache
def beside_its_circle(name):
    kinematics = Kinematics(read_card(name))
    motion = plan(parse(TEXT, "t.traj"), kinematics.card.canvas.pose)
    return kinematics, motion, reachable_start_posture(motion, kinematics).posture + ASIDE


def error(arm, values, law="pff", k=20.0):
    return _error(arm, values, law, k)


@cache
def _error(arm, values, law, k):
    """The rms position error [mm] after a second, and the rms change of the commands [rad/s]."""
    kinematics, motion, start = beside_its_circle(arm)
    chosen = CONTROLLERS[law]
    plant = choose_plant(f"compliant:{values}", "rates")
    run = track(motion, kinematics, start, plant, chosen, chosen.read_gains({"k": k}))
    late = motion.t > 1
    far = np.linalg.norm(run.points - motion.points, axis=1)[late]
    restless = np.linalg.norm(np.diff(run.command, axis=0), axis=1)[late[1:]]
    return 1e3 * np.sqrt((far**2).mean()), np.sqrt((restless**2).mean())
