"""Transpose law on the difference of dual quaternions, after Pham."""

import numpy as np
from pydantic import Field

from dqpaint.controllers.base.controller import controller
from dqpaint.controllers.base.gains import Gain, Gains
from dqpaint.controllers.base.pose_errors import difference_error
from dqpaint.controllers.base.seen import Seen
from dqpaint.dq import Floats
from dqpaint.robots.kinematics import pose_map


class TransposeGains(Gains):
    """One gain; the rates that follow from it depend on the arm and its posture.

    On the iiwa s^2 is at most 1.45 in any posture: 60 is stable up to a period of 20 ms, with room,
    and does not even overshoot at 8 ms. The weakest mode before the canvas then has 0.5 1/s.
    """

    k: Gain = Field(
        60.0,
        description="1/s, a small error decays at k s^2 in the mode with singular value s of J8",
    )


@controller(
    "pham-t", source="Pham 2010, transpose [29]", gains=TransposeGains, commands="rates",
    leaves_null=True,
)  # fmt: skip
def pham_t(seen: Seen, gains: TransposeGains) -> Floats:
    """Transposed Jacobian: needs no inverse and fears no singularity; slow in its weak modes.

    q_dot = J8' k e, with e = vec(x_d - x) and vec(x_dot) = J8 q_dot.

    At a set point d|e|^2/dt = -2 k |J8' e|^2, so |e| never grows; a mode with singular value s of
    J8 decays at k s^2. Held for a period T the fastest one is stable for k s^2 T < 2.
    J8' e has nothing in the null space; what `--null` adds there is projected by an inverse, and
    `--null none` is the paper's law.
    """
    error = difference_error(seen.pose, seen.pose_d)
    along = np.vecmat(gains.k * error, pose_map(seen.pose))  # J8' = J_w' M'
    return np.asarray(np.vecmat(along, seen.jacobian))
