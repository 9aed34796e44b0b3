"""The screw axes of an arm -> poses and Jacobians: product of exponentials, dual quaternions.

After Ozgur and Mezouar, "Kinematic modeling and control of a robot arm using unit dual quaternions"
(2016) [18]: everything is expressed in one frame, the base, at one posture, q = 0.
"""

from dataclasses import dataclass

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats


@dataclass(frozen=True)
class Screws:
    """A chain of revolute joints.

    Attributes:
        axes: the unit twists s_i0 (n, 6) of the joints at q = 0, in the base frame.
        home: the pose x(0) (8,) of the chain's last frame at q = 0.
    """

    axes: Floats
    home: Floats

    def pose(self, posture: Floats) -> Floats:
        """x(q) = exp(q_1 s_10 / 2) ... exp(q_n s_n0 / 2) x(0), (..., 8), at postures (..., n)."""
        return dq.mul(self._carried(posture)[-1], self.home)

    def jacobian(self, posture: Floats) -> Floats:
        """J_w (..., 6, n): column i is Ad(exp(q_1 s_10 / 2) ... exp(q_(i-1) s_(i-1)0 / 2)) s_i0."""
        return self.pose_and_jacobian(posture)[1]

    def pose_and_jacobian(self, posture: Floats) -> tuple[Floats, Floats]:
        """Both at once."""
        carried = self._carried(posture)
        J = np.stack(
            [dq.adjoint(x, s) for x, s in zip(carried[:-1], self.axes, strict=True)], axis=-1
        )
        return dq.mul(carried[-1], self.home), J

    def _carried(self, posture: Floats) -> list[Floats]:
        """The displacement of the first i joints, for i from 0 to n."""
        done = [np.broadcast_to(dq.IDENTITY, (*posture.shape[:-1], 8))]
        for turn in np.moveaxis(dq.exp(0.5 * posture[..., None] * self.axes), -2, 0):
            done.append(dq.mul(done[-1], turn))
        return done
