"""What the plants of PyBullet share: the arm as rigid bodies on joints with mechanical stops."""

import math
from typing import Any

import numpy as np

from dqpaint.dq import Floats
from dqpaint.plants.bullet import bullet, joint_indices, quiet
from dqpaint.robots.card import Card
from dqpaint.robots.urdf import urdf_file

LONGEST_STEP = 1e-3  # [s] of physics
STOP = 0.02  # [rad] of the mechanical stop beyond a joint's limit: commands end at the limit
GRAVITY = -9.81  # [m/s^2]


class RigidArm:
    """The bodies of a card's arm, at rest in a posture, in a world of their own.

    Masses and inertias are the file's own. Shapes are left out: nothing touches anything in a
    light painting, and loading their meshes costs twenty times the rest. Physics steps are the
    period divided into equal parts of at most 1 ms. The Dantzig solver comes 45 times closer to
    commanded rates than the default one, and is faster.
    """

    def __init__(self, card: Card, posture: Floats, period: float) -> None:
        self.card = card
        self.steps = max(1, math.ceil(period / LONGEST_STEP - 1e-9))
        self.step = period / self.steps  # [s]
        with quiet():
            self.client = bullet.connect(bullet.DIRECT)
            self.body = self._build(card)
        self.joints = joint_indices(self.body, self.client)
        for joint, angle, lower, upper in zip(
            self.joints, posture.tolist(), card.lower.tolist(), card.upper.tolist(), strict=True
        ):
            bullet.changeDynamics(
                self.body,
                joint,
                jointLowerLimit=lower - STOP,
                jointUpperLimit=upper + STOP,
                physicsClientId=self.client,
            )
            bullet.resetJointState(self.body, joint, angle, 0.0, self.client)
        self.posture = posture.copy()
        self.rates = np.zeros(card.joints)
        self.effort = np.zeros(card.joints)

    def _build(self, card: Card) -> int:
        here = {"physicsClientId": self.client}
        solver = bullet.CONSTRAINT_SOLVER_LCP_DANTZIG
        bullet.setPhysicsEngineParameter(
            fixedTimeStep=self.step, constraintSolverType=solver, **here
        )
        bullet.setGravity(0, 0, GRAVITY, **here)
        flags = (
            bullet.URDF_USE_INERTIA_FROM_FILE
            | bullet.URDF_IGNORE_VISUAL_SHAPES
            | bullet.URDF_IGNORE_COLLISION_SHAPES
        )
        with urdf_file(card) as path:
            body: int = bullet.loadURDF(path, useFixedBase=True, flags=flags, **here)
        return body

    def measure(self) -> Any:
        """Read the joints; of each its angle [rad], rate, forces, motor torque [Nm]."""
        states = bullet.getJointStates(self.body, self.joints, self.client)
        self.posture = np.array([state[0] for state in states])
        self.rates = np.array([state[1] for state in states])
        return states

    def close(self) -> None:
        """End the simulation."""
        bullet.disconnect(self.client)
