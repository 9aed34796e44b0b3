"""Motion x robot x plant x law -> Track: what the arm did."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from dqpaint import dq
from dqpaint.controllers import Controller, Schedule, Seen
from dqpaint.dq import Floats
from dqpaint.driving import make_drive
from dqpaint.errors import DqpaintError
from dqpaint.motion import Motion
from dqpaint.plants.plant import PlantMaker
from dqpaint.robots.kinematics import Kinematics, manipulability
from dqpaint.robots.limits import Clamp, clamps

REPORT_EVERY = 50  # rows
BLOCK = 512  # rows whose Jacobians are kept


@dataclass(frozen=True)
class Track:
    """A run, one row a control step; the arrays are read-only.

    A row is a time t_k, what was asked at t_k (in `motion`), what was measured at t_k, and the
    command then given.

    Attributes:
        motion: what was asked.
        posture: measured joint angles (N, n) [rad].
        pose: measured tool poses (N, 8) in the base frame, signs continuous.
        manipulability: sqrt(det(J J')) (N,) at the measured postures.
        command: what the arm was given (N, n): joint rates [rad/s], or torques [Nm].
        torques: whether the commands are torques.
        effort: motor torques (N, n) [Nm], the largest seen in the period before the row.
        clamps: limits that held a joint back.
    """

    motion: Motion
    posture: Floats
    pose: Floats
    manipulability: Floats
    command: Floats
    torques: bool
    effort: Floats
    clamps: tuple[Clamp, ...]

    def __post_init__(self) -> None:
        for array in (self.posture, self.pose, self.manipulability, self.command, self.effort):
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
    gains: Schedule[Any],
    progress: Callable[[float], None] = lambda _done: None,
) -> Track:
    """Drive the arm along a motion.

    Args:
        motion: what is asked.
        kinematics: of the arm, and its card.
        start: posture (n,) [rad] to begin from, at rest.
        make_plant: how the arm answers.
        controller: the law.
        gains: of the law, over the drawing.
        progress: called now and then with the part done, 0 to 1.

    Raises:
        DqpaintError: the simulation left the numbers.
    """
    card = kinematics.card
    n, joints = len(motion.t), card.joints
    posture, effort = np.empty((n, joints)), np.zeros((n, joints))
    wanted, command = np.empty((n, joints)), np.empty((n, joints))
    pose, measures = np.empty((n, 8)), np.empty(n)
    jacobian = np.empty((BLOCK, 6, joints))
    parts = motion.t / motion.t[-1] if len(motion.t) > 1 else motion.t
    ahead = controller.prepare(motion, gains) if controller.prepare else np.zeros((n, 0))
    drive = make_drive(controller, kinematics, start, motion.period)
    plant = make_plant(card, start, motion.period)
    asked = zip(
        motion.pose, motion.twist, motion.acceleration, motion.t.tolist(), ahead,
        gains.over(parts), strict=True,
    )  # fmt: skip
    try:
        for k, (pose_d, twist_d, acceleration_d, t, known, now) in enumerate(asked):
            q = plant.posture
            x, J = kinematics.pose_and_jacobian(q)
            seen = Seen(
                x, pose_d, twist_d, acceleration_d, J, q, t, motion.period, plant.rates, known
            )
            asked_for = drive.ask(seen, now)
            given = drive.within(asked_for, q)
            posture[k], effort[k], pose[k], jacobian[k % BLOCK] = q, plant.effort, x, J
            wanted[k], command[k] = asked_for, given
            if k % REPORT_EVERY == 0:
                progress(k / n)
            if k % BLOCK == BLOCK - 1 or k == n - 1:  # many at once cost less than one by one
                first = k - k % BLOCK
                measures[first : k + 1] = manipulability(jacobian[: k + 1 - first])
            if k < n - 1:
                plant.run(given)
    except np.linalg.LinAlgError:  # a posture that is no number any more has no singular values
        raise _lost(t) from None
    finally:
        plant.close()
    if not (np.isfinite(posture).all() and np.isfinite(command).all()):
        raise _lost(float(motion.t[-1]))
    torques = controller.drives_torque
    held = clamps(card, motion.t, motion.line, posture, wanted, command, effort, torques)
    pose[0] = dq.nearest(pose[0], motion.pose[0])
    return Track(motion, posture, dq.continuous(pose), measures, command, torques, effort, held)


def _lost(time: float) -> DqpaintError:
    return DqpaintError(
        f"the run left the numbers before {time:.3f} s: the loop is unstable; "
        "lower the gains or shorten the period"
    )
