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
    """Velocity motors of infinite bandwidth within the card's torques: up to these no load shows.

    Equation:
        H q_ddot + C q_dot + G = tau_m
        q_dot(t + h) = q_dot_c, |tau_m| <= "effort"
    Idea:
        Each motor holds the rate it is given, whatever torque that needs, as long as it has it:
        a servo of infinite bandwidth. It differs from ideal where torques run out.
    Stable:
        As ideal, while no torque is at its limit.
    Fails:
        To show what real servos do: a push within the torques moves nothing. For friction, springs
        and bandwidth there are other plants.
    Try:
        dqpaint draw star --plant stiff --disturb payload=5
    """

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
