"""Motion x robot x plant x law -> Track: what the arm did."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from dqpaint import dq
from dqpaint.controllers import Controller, Gains, Seen
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError
from dqpaint.motion import Motion
from dqpaint.plants.plant import PlantMaker
from dqpaint.robots.kinematics import Kinematics
from dqpaint.robots.limits import Bounds, Clamp, clamps
from dqpaint.robots.resolver import PULL, resolve

REPORT_EVERY = 50  # rows


@dataclass(frozen=True)
class Track:
    """A run, one row a control step; the arrays are read-only.

    A row is a time t_k, what was asked at t_k (in `motion`), what was measured at t_k, and the
    command then given.

    Attributes:
        motion: what was asked.
        posture: measured joint angles (N, n) [rad].
        pose: measured tool poses (N, 8) in the base frame, each on the side of the asked one.
        command: joint rates (N, n) [rad/s] the arm was given.
        effort: motor torques (N, n) [Nm] at the end of the period before the row.
        clamps: limits that held a joint back.
    """

    motion: Motion
    posture: Floats
    pose: Floats
    command: Floats
    effort: Floats
    clamps: tuple[Clamp, ...]

    def __post_init__(self) -> None:
        for array in (self.posture, self.pose, self.command, self.effort):
            array.setflags(write=False)

    @property
    def points(self) -> Floats:
        """The reached places of the light (N, 3) [m]."""
        return dq.translation(self.pose)


def track(
    motion: Motion,
    kinematics: Kinematics,
    start: Floats,
    make_plant: PlantMaker,
    controller: Controller[Any],
    gains: Gains,
    progress: Callable[[float], None] = lambda _done: None,
) -> Track:
    """Drive the arm along a motion.

    Args:
        motion: what is asked.
        kinematics: of the arm, and its card.
        start: posture (n,) [rad] to begin from, at rest.
        make_plant: how the arm answers.
        controller: the law.
        gains: of the law.
        progress: called now and then with the part done, 0 to 1.

    Raises:
        DqpaintError: the simulation left the numbers.
    """
    card = kinematics.card
    n = len(motion.t)
    posture, effort = np.empty((n, card.joints)), np.zeros((n, card.joints))
    wanted, command = np.empty((n, card.joints)), np.empty((n, card.joints))
    pose = np.empty((n, 8))
    bounds = Bounds(card, motion.period)
    plant = make_plant(card, start, motion.period)
    try:
        for k in range(n):
            q = plant.posture
            posture[k], effort[k] = q, plant.effort
            pose[k], J = kinematics.pose_and_jacobian(q)
            twist = controller.law(_see(motion, k, pose[k], J, q), gains)
            wanted[k] = resolve(J, dq.translation(pose[k]), twist, PULL * (start - q))
            command[k] = bounds.clip(wanted[k], q)
            if k % REPORT_EVERY == 0:
                progress(k / n)
                _stop_if_lost(q, wanted[k], float(motion.t[k]))
            if k < n - 1:
                plant.run(command[k])
    finally:
        plant.close()
    _stop_if_lost(posture, wanted, float(motion.t[-1]))
    held = clamps(card, motion.t, motion.line, posture, wanted, command, effort)
    return Track(motion, posture, dq.nearest(pose, motion.pose), command, effort, held)


def _see(motion: Motion, k: int, pose: Floats, jacobian: Floats, posture: Floats) -> Seen:
    return Seen(
        pose=pose,
        pose_d=motion.pose[k],
        twist_d=motion.twist[k],
        acceleration_d=motion.acceleration[k],
        jacobian=jacobian,
        posture=posture,
        time=k * motion.period,
        period=motion.period,
    )


def _stop_if_lost(posture: Floats, rates: Floats, time: float) -> None:
    if not (np.isfinite(posture).all() and np.isfinite(rates).all()):
        raise DqpaintError(
            f"the run left the numbers before {time:.3f} s: the loop is unstable; "
            "lower the gains or shorten the period"
        )
