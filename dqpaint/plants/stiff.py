"""The stiff arm: PyBullet's rigid bodies under velocity motors."""

import math
from typing import Any

import numpy as np

from dqpaint.dq import Floats
from dqpaint.plants.bullet import bullet, joint_indices, quiet
from dqpaint.plants.plant import PLANTS
from dqpaint.robots.card import Card
from dqpaint.robots.urdf import urdf_file

LONGEST_STEP = 1e-3  # [s] of physics
STOP = 0.02  # [rad] of the mechanical stop beyond a joint's limit: commands end at the limit
GRAVITY = -9.81  # [m/s^2]


@PLANTS.add("stiff")
class Stiff:
    """Velocity motors within the card's torques, gravity on, physics steps of at most 1 ms.

    Masses and inertias are the file's own. Shapes are left out: nothing touches anything in a
    light painting, and loading their meshes costs twenty times the rest. The Dantzig solver comes
    45 times closer to the commanded rates than the default one, and is faster.
    """

    def __init__(self, card: Card, posture: Floats, period: float) -> None:
        self._steps = max(1, math.ceil(period / LONGEST_STEP - 1e-9))
        self._effort_limits = card.effort.tolist()
        with quiet():
            self._client = bullet.connect(bullet.DIRECT)
            self._body = self._build(card, period / self._steps)
        self._joints = joint_indices(self._body, self._client)
        for joint, angle, lower, upper in zip(
            self._joints, posture.tolist(), card.lower.tolist(), card.upper.tolist(), strict=True
        ):
            bullet.changeDynamics(
                self._body,
                joint,
                jointLowerLimit=lower - STOP,
                jointUpperLimit=upper + STOP,
                physicsClientId=self._client,
            )
            bullet.resetJointState(self._body, joint, angle, 0.0, self._client)
        self.posture = posture.copy()
        self.effort = np.zeros(card.joints)

    def _build(self, card: Card, step: float) -> int:
        here = {"physicsClientId": self._client}
        solver = bullet.CONSTRAINT_SOLVER_LCP_DANTZIG
        bullet.setPhysicsEngineParameter(fixedTimeStep=step, constraintSolverType=solver, **here)
        bullet.setGravity(0, 0, GRAVITY, **here)
        flags = (
            bullet.URDF_USE_INERTIA_FROM_FILE
            | bullet.URDF_IGNORE_VISUAL_SHAPES
            | bullet.URDF_IGNORE_COLLISION_SHAPES
        )
        with urdf_file(card) as path:
            body: int = bullet.loadURDF(path, useFixedBase=True, flags=flags, **here)
        return body

    def run(self, rates: Floats) -> None:
        """One period at the commanded rates (n,) [rad/s], as far as the motors' torques go."""
        bullet.setJointMotorControlArray(
            self._body,
            self._joints,
            bullet.VELOCITY_CONTROL,
            targetVelocities=rates.tolist(),
            forces=self._effort_limits,
            physicsClientId=self._client,
        )
        # what a new command asks of the motors is most in the first step
        bullet.stepSimulation(self._client)
        first = self._states()
        for _ in range(self._steps - 1):
            bullet.stepSimulation(self._client)
        last = self._states()
        self.posture = np.array([state[0] for state in last])
        self.effort = np.array([max(a[3], b[3], key=abs) for a, b in zip(first, last, strict=True)])

    def close(self) -> None:
        """End the simulation."""
        bullet.disconnect(self._client)

    def _states(self) -> Any:
        """Of each joint: angle [rad], rate, forces, motor torque [Nm]."""
        return bullet.getJointStates(self._body, self._joints, self._client)
