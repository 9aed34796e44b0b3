"""Joint-rate commands -> PyBullet's rigid bodies under velocity motors."""

from typing import ClassVar

import numpy as np

from dqpaint.dq import Floats
from dqpaint.plants.bullet_arm import RigidArm
from dqpaint.plants.plant import PLANTS, Takes, Trait
from dqpaint.plants.world import UNDISTURBED, World
from dqpaint.robots.bullet import bullet
from dqpaint.robots.model import Card


@PLANTS.add("stiff")
class Stiff(RigidArm):
    """Velocity motors within the card's torques, gravity on, physics steps of at most 1 ms."""

    takes: ClassVar[Takes] = "rates"
    traits: ClassVar[frozenset[Trait]] = frozenset({"masses", "sudden motors"})

    def __init__(
        self,
        card: Card,
        posture: Floats,
        period: float,
        world: World = UNDISTURBED,
        options: None = None,
    ) -> None:
        super().__init__(card, posture, period, world)
        self._limits = card.effort.tolist()

    def run(self, command: Floats, drift: Floats | None = None) -> None:
        """One period at joint rates (n,) [rad/s], as far as the motors' torques go."""
        bullet.setJointMotorControlArray(
            self.body,
            self.joints,
            bullet.VELOCITY_CONTROL,
            targetVelocities=(command if drift is None else command + drift).tolist(),
            forces=self._limits,
            physicsClientId=self.client,
        )
        # a new command needs the largest motor torques in the first step
        self.advance()
        first = bullet.getJointStates(self.body, self.joints, self.client)
        for _ in range(self.steps - 1):
            self.advance()
        last = self.read_joints()
        torques = ((a[3], b[3]) for a, b in zip(first, last, strict=True))
        self.effort = np.array([a if abs(a) >= abs(b) else b for a, b in torques])
