"""Motion -> shifted, scaled or straightened motion; only its poses are computed.

That is enough to check whether an arm reaches them; twists and times are unchanged.
"""

from dataclasses import replace

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.motion import Motion
from dqpaint.program import Screw, ScrewTo

TURNED = np.radians(1.0)  # a tool rotated by less is straight


def moved(motion: Motion, origin: Floats) -> Motion:
    """The motion with its drawing frame at an origin (3,) [m] in the base frame, not rotated."""
    shift = origin - dq.translation(motion.canvas)
    move = dq.pose_from(shift, np.array([1.0, 0, 0, 0]))
    return replace(motion, pose=dq.mul(move, motion.pose), canvas=dq.mul(move, motion.canvas))


def scaled(motion: Motion, scale: float) -> Motion:
    """The motion under `with scale` round the whole drawing."""
    local = dq.mul(dq.conj(motion.canvas), motion.pose)
    smaller = dq.pose_from(scale * dq.translation(local), dq.rotation(local))
    return replace(motion, pose=dq.mul(motion.canvas, smaller))


def straight(motion: Motion) -> Motion | None:
    """The motion without 'tool' in the drawing; None if it is that already, or a screw turns it."""
    if any(isinstance(segment.path, Screw | ScrewTo) for segment in motion.program.segments):
        return None
    still = np.tile(dq.rotation(motion.canvas), (len(motion.t), 1))
    held = dq.pose_from(motion.points, still)
    turns = 2 * dq.log(dq.mul(dq.nearest(held, motion.pose), dq.conj(motion.pose)))[:, :3]
    return replace(motion, pose=held) if np.linalg.norm(turns, axis=1).max() > TURNED else None
