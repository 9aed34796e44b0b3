"""Sizes and a seed -> another place of a drawing and another start posture.

A source of spread beside noise: what would differ if someone set the experiment up again. It
follows from the seed alone, so that runs of all laws with one seed have one set-up.
"""

from dataclasses import replace

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.errors import DqpaintError, UsageError
from dqpaint.program import Pose, Program
from dqpaint.robots.kinematics import Kinematics, solve_posture

ARRIVED = 1e-5  # [rad, m] from the pose where the arm begins
EXACT = 1e-9
OF_PLACE, OF_POSTURE = 1, 2  # streams of random numbers, apart from those of disturbances


def displaced(program: Program, canvas: Floats, size: float, seed: int) -> Program:
    """The drawing moved by a normal length along each axis.

    Args:
        program: whose place is known.
        canvas: pose (8,) of the robot's canvas, where it lies if it has no place.
        size: standard deviation along each axis of the base [m].
        seed: of the run.
    """
    moved = np.random.default_rng([seed, OF_PLACE]).normal(0.0, size, 3)
    placed = program.placement
    if not isinstance(placed, Pose):
        x, turn = dq.translation(canvas).tolist(), dq.rotation(canvas).tolist()
        placed = Pose(position=tuple(x), orientation=tuple(turn))
    position = tuple((np.array(placed.position) + moved).tolist())
    return replace(program, placement=placed._replace(position=position))


def other_posture(
    kinematics: Kinematics, start: Floats, pose: Floats | None, size: float, seed: int
) -> Floats:
    """A start posture (n,) [rad] near another.

    Args:
        kinematics: of the arm.
        start: posture (n,) [rad].
        pose: at which the tool begins all the same (8,); None is anywhere.
        size: standard deviation of each joint [rad], before the tool is led back.
        seed: of the run.

    Raises:
        UsageError: the arm has no freedom to begin otherwise.
        DqpaintError: no posture is found there.
    """
    card = kinematics.card
    if pose is not None and card.joints <= kinematics.task.dimensions:
        raise UsageError(
            f"spread posture: an arm of {card.joints} joints has no other posture near for the "
            "pose where it begins; take place, or an arm with more joints"
        )
    rng = np.random.default_rng([seed, OF_POSTURE])
    q = np.clip(start + rng.normal(0.0, size, card.joints), card.lower, card.upper)
    if pose is None:
        return q
    still, inside = np.zeros((1, card.joints)), (card.lower, card.upper)
    found, off = solve_posture(kinematics, pose, q[None], still, EXACT, inside)
    if off[0] > ARRIVED:
        raise DqpaintError(
            f"spread posture: with seed {seed} the arm does not come back to where the drawing "
            "begins; a smaller one, such as posture=2, does"
        )
    return np.asarray(found[0])
