"""Denavit-Hartenberg rows -> poses and Jacobians of an arm, in dual quaternions.

After Pham, Perdereau, Adorno and Fraisse, "Position and orientation control of robot manipulators
using dual quaternion feedback" (2010) [30, 31, 35].
"""

from dataclasses import dataclass, field

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.robots.model.screws import Screws

_Z = np.array([0.0, 0, 0, 1, 0, 0, 0, 0])  # the axis every joint turns about, in its own frame


@dataclass(frozen=True)
class DenavitHartenberg:
    """A chain of revolute joints, one row per joint.

    Attributes:
        theta, d, a, alpha: (n,), the joint's offset [rad], the two lengths [m], the twist [rad].
        modified: False for the standard rows Rot_z(theta) Trans_z(d) Trans_x(a) Rot_x(alpha) of
            Pham [30]; True for Craig's Rot_x(alpha) Trans_x(a) Rot_z(theta) Trans_z(d).
        base: the pose (8,) of the first row's frame in the base frame.
        flange: the pose (8,) of the chain's last frame in that of the last row.
    """

    theta: Floats
    d: Floats
    a: Floats
    alpha: Floats
    modified: bool = False
    base: Floats = field(default_factory=dq.IDENTITY.copy)
    flange: Floats = field(default_factory=dq.IDENTITY.copy)

    def pose(self, posture: Floats) -> Floats:
        """The product of all rows (..., 8) [31] at postures (..., n) [rad]."""
        return self._frames(posture)[1]

    def jacobian(self, posture: Floats) -> Floats:
        """J_w (..., 6, n): column i is the z axis of joint i's frame, as a line of the base."""
        frames, _ = self._frames(posture)
        z = dq.vector(_Z)
        return np.stack([dq.adjoint(x, z) for x in frames], axis=-1)

    def jacobian8(self, posture: Floats) -> Floats:
        """J8 (..., 8, n) [35]: column i is the derivative of the product with respect to q_i.

        Only the row of joint i depends on q_i: what stands before it, times k/2, times the rest.
        """
        frames, end = self._frames(posture)
        return np.stack(
            [dq.mul(dq.mul(x, 0.5 * _Z), dq.mul(dq.conj(x), end)) for x in frames], axis=-1
        )

    def screws(self) -> Screws:
        """The same arm as screw axes: the axes and the last pose at q = 0."""
        zero = np.zeros(len(self.d))
        return Screws(self.jacobian(zero).T, self.pose(zero))

    def _frames(self, posture: Floats) -> tuple[list[Floats], Floats]:
        """The frame of each joint's z axis, after its own rotation (..., 8), and the last frame."""
        turns = _turn(posture + self.theta, _Z[:4])
        lean = dq.mul(_shift(self.a, 0), _turn(self.alpha, np.array([0.0, 1, 0, 0])))
        rise = _shift(self.d, 2)
        x = np.broadcast_to(self.base, (*posture.shape[:-1], 8))
        frames = []
        for i in range(len(self.d)):
            x = dq.mul(dq.mul(x, lean[i]) if self.modified else x, turns[..., i, :])
            frames.append(x)
            x = dq.mul(x, rise[i] if self.modified else dq.mul(rise[i], lean[i]))
        return frames, dq.mul(x, self.flange)


def _turn(angle: Floats, axis: Floats) -> Floats:
    """Pure rotations (..., 8) by angles (...,) about a coordinate axis, given as a quaternion."""
    half = 0.5 * angle[..., None]
    rotation = np.cos(half) * np.array([1.0, 0, 0, 0]) + np.sin(half) * axis
    return np.concatenate([rotation, np.zeros_like(rotation)], axis=-1)


def _shift(length: Floats, axis: int) -> Floats:
    """Pure translations 1 + eps t / 2 (..., 8) along coordinate axis 0, 1 or 2."""
    out = np.zeros((*length.shape, 8))
    out[..., 0] = 1.0
    out[..., 5 + axis] = 0.5 * length
    return out
