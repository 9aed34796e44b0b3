"""Measured state and reference at a control step -> the input of a law, with a window ahead."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dqpaint import dq
from dqpaint.controllers.base.arm import NO_LIMITS, JointLimits
from dqpaint.dq import Floats
from dqpaint.motion import Motion

NOTHING: Floats = np.zeros(0)


class Window(NamedTuple):
    """The reference over some rows, the present one first; views of the motion, read-only.

    Attributes:
        time: (m,) [s].
        pose: desired poses (m, 8), signs continuous.
        twist: desired spatial twists (m, 6) [rad/s, m/s].
        acceleration: their plain derivatives (m, 6) [rad/s^2, m/s^2].
    """

    time: Floats
    pose: Floats
    twist: Floats
    acceleration: Floats


class Seen(NamedTuple):
    """The input of a law at one control step; arrays of any leading shape.

    Attributes:
        pose: measured pose (..., 8), its sign arbitrary.
        pose_d: desired pose (..., 8).
        twist_d: desired spatial twist (..., 6) [rad/s, m/s].
        acceleration_d: its plain derivative (..., 6) [rad/s^2, m/s^2].
        jacobian: J_w (..., 6, n), xi = J_w q_dot.
        posture: measured joint angles (..., n) [rad].
        time: since the drawing began [s].
        period: of the control [s].
        rates: measured joint rates (..., n) [rad/s].
        row: the number of this step, from 0: the row of the reference motion.
        limits: of the arm's joints.
        motion: the whole reference motion; see `ahead`.
        inertia: H(q) (..., n, n) [kg m^2], for laws that command torques; empty for others.
        bias: C(q, q_dot) q_dot + G(q) and the joints' friction (..., n) [Nm], likewise.
        signed: whether the sign of `pose_d` was chosen by a rule (`--sign`), and is to be kept.
        light: where a camera sees the light (..., 3) [m], in the frame that the law takes for the
            base's; not a number while it is dark. For laws that sense it; empty for others.
        push: the force at the light (..., 3) [N], as a sensor there measures it, likewise.
        clipped: whether a limit clipped the command before this one (...,).
    """

    pose: Floats
    pose_d: Floats
    twist_d: Floats
    acceleration_d: Floats
    jacobian: Floats
    posture: Floats
    time: float
    period: float
    rates: Floats = NOTHING
    row: int = 0
    limits: JointLimits = NO_LIMITS
    motion: Motion | None = None
    inertia: Floats = NOTHING
    bias: Floats = NOTHING
    light: Floats = NOTHING
    push: Floats = NOTHING
    signed: bool = False
    clipped: NDArray[np.bool_] | bool = False

    @property
    def goal(self) -> Floats:
        """The desired pose (..., 8) on the side of the double cover to which the law is to go."""
        return self.pose_d if self.signed else dq.nearest(self.pose_d, self.pose)

    @property
    def twist(self) -> Floats:
        """Measured spatial twist J_w q_dot (..., 6) [rad/s, m/s]."""
        return np.asarray(np.matvec(self.jacobian, self.rates))

    def ahead(self, rows: int) -> Window:
        """The reference at this step and over the next rows, fewer where the motion ends.

        Args:
            rows: how many after this one; the window has rows + 1, or what is left of them.

        Raises:
            ValueError: rows is negative, or there is no motion to look at.
        """
        if rows < 0:
            raise ValueError(f"a window of {rows} rows ahead; it is 0 or more")
        if self.motion is None:
            raise ValueError("there is no motion to look ahead at")
        motion, here = self.motion, slice(self.row, self.row + rows + 1)
        return Window(
            motion.t[here], motion.pose[here], motion.twist[here], motion.acceleration[here]
        )
