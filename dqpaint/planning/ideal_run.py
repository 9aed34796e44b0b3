"""Motion x arm -> the start posture, and the postures of a run without tracking error.

Limits and laws play no part. Singularities are handled as in a run, through the same
resolver and with the same wish in its null space.
"""

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.motion import Motion
from dqpaint.robots.kinematics import (
    DEFAULT_OBJECTIVE,
    PATH_TOLERANCE,
    Kinematics,
    NoPosture,
    SecondaryTask,
    StartPosture,
    find_start,
    make_batched_task,
    make_secondary_task,
    return_to_start,
    solve_posture,
    waypoints,
)
from dqpaint.robots.resolvers import (
    DEFAULT_RESOLVER,
    State,
    planning_resolver,
)

MOST_ROWS = 1500  # that are gone along to see whether an arm can draw something
JOINT_TOLERANCE = np.radians(0.05)  # of a joint's end count as its end


def find_start_posture(
    motion: Motion, kinematics: Kinematics, null: str = DEFAULT_OBJECTIVE
) -> StartPosture | NoPosture:
    """The start posture with the most joint margin over a drawing, or the pose that is not reached.

    Args:
        motion: what is asked.
        kinematics: of the arm.
        null: what the arm does with its freedom.
    """
    rows = waypoints(motion.stroke)
    pull = return_to_start if null == DEFAULT_OBJECTIVE else make_batched_task(null, kinematics)
    return find_start(kinematics, motion.pose[rows], motion.t[rows], pull)


def can_draw(motion: Motion, kinematics: Kinematics, null: str = DEFAULT_OBJECTIVE) -> bool:
    """Whether an arm can draw a motion within its joint limits and 1 mm of the path.

    Arguments as those of `find_start_posture`.
    """
    start = find_start_posture(motion, kinematics, null)
    if isinstance(start, NoPosture) or start.margin < 0:
        return False
    rows = np.arange(0, len(motion.t), -(-len(motion.t) // MOST_ROWS))
    wish = make_secondary_task(null, kinematics.card, start.posture)
    postures, points, _ = follow(motion, kinematics, start.posture, rows, wish)
    card = kinematics.card
    inside = (postures >= card.lower - JOINT_TOLERANCE) & (postures <= card.upper + JOINT_TOLERANCE)
    off = np.linalg.norm(points - motion.points[rows], axis=1)
    return bool(inside.all() and off.max() < PATH_TOLERANCE)


def jumps_between(motion: Motion, rows: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Whether the set point jumps between each of some rows (N,) and the next."""
    return np.asarray(np.add.reduceat(motion.jump, rows) > 0)


def follow(
    motion: Motion,
    kinematics: Kinematics,
    start: Floats,
    rows: NDArray[np.intp],
    wish: SecondaryTask,
    resolver: str = DEFAULT_RESOLVER,
) -> tuple[Floats, Floats, Floats]:
    """Along some rows (N,) of a motion, evenly spread; one Newton step leads to each.

    Returns:
        Postures (N, n), places (N, 3) and Jacobians (N, 6, n).
    """
    period = motion.period * (rows[1] - rows[0] if len(rows) > 1 else 1)
    postures, jacobians = np.empty((len(rows), len(start))), np.empty((len(rows), 6, len(start)))
    points = np.empty((len(rows), 3))
    task = kinematics.task
    solver = planning_resolver(resolver, kinematics, period)
    still, jump = np.zeros((1, len(start))), jumps_between(motion, rows)
    q = solve_posture(kinematics, motion.pose[0], start[None], still, PATH_TOLERANCE)[0][0]
    for k in range(len(rows)):
        x, J = kinematics.pose_and_jacobian(q)
        p = dq.translation(x)
        postures[k], jacobians[k], points[k] = q, J, p
        if k + 1 == len(rows):
            break
        ahead, drawn = motion.pose[rows[k + 1]], wish.displacement(period, q, J, p)
        if jump[k]:
            q = solve_posture(kinematics, ahead, q[None], drawn[None], PATH_TOLERANCE)[0][0]
        else:
            ways = [
                2 / period * dq.log(dq.mul(dq.nearest(part.near(ahead, x), x), dq.conj(x)))
                for part in task.parts
            ]
            q = q + period * solver.rates(State(x, J, q), ways, drawn / period)
    return postures, points, jacobians
