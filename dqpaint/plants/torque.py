"""The torque-driven arm: PyBullet's rigid bodies, the joint motors off."""

from typing import ClassVar

import numpy as np

from dqpaint.dq import Floats
from dqpaint.plants.bullet import bullet
from dqpaint.plants.plant import PLANTS, Takes
from dqpaint.plants.rigid import RigidArm
from dqpaint.robots.card import Card

UNBOUND = 1e9  # [rad/s]


@PLANTS.add("torque")
class Torque(RigidArm):
    """Torques held for a period on rigid bodies with the file's friction, gravity on.

    The dynamics are those of the file: its inertias, the viscous friction of its joints, and none
    of the damping that PyBullet gives every body unasked. Its integration is semi-implicit Euler.
    """

    takes: ClassVar[Takes] = "torque"

    def __init__(self, card: Card, posture: Floats, period: float) -> None:
        super().__init__(card, posture, period)
        here = {"physicsClientId": self.client}
        for link in range(-1, bullet.getNumJoints(self.body, **here)):
            bullet.changeDynamics(self.body, link, linearDamping=0, angularDamping=0, **here)
        for joint in self.joints:  # PyBullet would end every rate at 100 rad/s
            bullet.changeDynamics(self.body, joint, maxJointVelocity=UNBOUND, **here)
        idle = [0.0] * len(self.joints)
        bullet.setJointMotorControlArray(
            self.body, self.joints, bullet.VELOCITY_CONTROL, forces=idle, **here
        )

    def run(self, command: Floats, drift: Floats | None = None) -> None:
        """One period at joint torques (n,) [Nm]."""
        torques = command.tolist()
        for _ in range(self.steps):  # each physics step clears the torques
            bullet.setJointMotorControlArray(
                self.body,
                self.joints,
                bullet.TORQUE_CONTROL,
                forces=torques,
                physicsClientId=self.client,
            )
            bullet.stepSimulation(self.client)
            if drift is not None:
                self._displace(drift)
        self.measure()
        self.effort = command

    def _displace(self, drift: Floats) -> None:
        """Carry the joints along for a physics step, their own rates kept."""
        self.measure()
        moved = (self.posture + self.step * np.asarray(drift)).tolist()
        for joint, angle, rate in zip(self.joints, moved, self.rates.tolist(), strict=True):
            bullet.resetJointState(self.body, joint, angle, rate, self.client)
