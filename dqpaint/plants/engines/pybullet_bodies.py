"""A card -> rigid bodies in a PyBullet world of their own."""

from functools import partial
from typing import Any

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats
from dqpaint.plants.engines.bodies import STOP_DISTANCE
from dqpaint.plants.engines.loads import Pushes, with_payloads
from dqpaint.plants.engines.pybullet_client import Client, bullet, joint_indices, quiet
from dqpaint.plants.world import World
from dqpaint.robots.model import Card
from dqpaint.robots.urdf import urdf_file

NO_SPEED_LIMIT = 1e9  # [rad/s]


class PyBulletBodies(Client):
    """Bodies as `Bodies` has them; its velocity motors are constraints of the solver.

    The Dantzig solver comes 45 times closer to commanded rates than the default one, and is faster.
    """

    def __init__(
        self, card: Card, posture: Floats, step: float, world: World, driven: bool
    ) -> None:
        self._pushes = Pushes(world, card, step)
        super().__init__()
        with quiet():
            self.body = self._build(card, step, world)
        self.joints = joint_indices(self.body, self.client)
        self._limits = card.effort.tolist()
        for joint, angle, lower, upper in zip(
            self.joints, posture.tolist(), card.lower.tolist(), card.upper.tolist(), strict=True
        ):
            bullet.changeDynamics(
                self.body,
                joint,
                jointLowerLimit=lower - STOP_DISTANCE,
                jointUpperLimit=upper + STOP_DISTANCE,
                physicsClientId=self.client,
            )
            bullet.resetJointState(self.body, joint, angle, 0.0, self.client)
        if self._pushes:
            self._flange = self._link_named(card.link)
            self._tool = card.tool.pose
        if not driven:
            self._disable_motors()

    def _build(self, card: Card, step: float, world: World) -> int:
        here = {"physicsClientId": self.client}
        solver = bullet.CONSTRAINT_SOLVER_LCP_DANTZIG
        bullet.setPhysicsEngineParameter(fixedTimeStep=step, constraintSolverType=solver, **here)
        bullet.setGravity(*world.gravity.tolist(), **here)
        flags = (
            bullet.URDF_USE_INERTIA_FROM_FILE
            | bullet.URDF_IGNORE_VISUAL_SHAPES
            | bullet.URDF_IGNORE_COLLISION_SHAPES
        )
        with urdf_file(card, partial(with_payloads, card=card, payloads=world.payloads)) as path:
            body: int = bullet.loadURDF(path, useFixedBase=True, flags=flags, **here)
        return body

    def _disable_motors(self) -> None:
        """Switch off motors and the damping that PyBullet gives every body unasked."""
        here = {"physicsClientId": self.client}
        for link in range(-1, bullet.getNumJoints(self.body, **here)):
            bullet.changeDynamics(self.body, link, linearDamping=0, angularDamping=0, **here)
        for joint in self.joints:  # PyBullet would end every rate at 100 rad/s
            bullet.changeDynamics(self.body, joint, maxJointVelocity=NO_SPEED_LIMIT, **here)
        idle = [0.0] * len(self.joints)
        bullet.setJointMotorControlArray(
            self.body, self.joints, bullet.VELOCITY_CONTROL, forces=idle, **here
        )

    def state(self) -> tuple[list[float], list[float]]:
        """Angles [rad] and rates [rad/s] of the joints."""
        states = bullet.getJointStates(self.body, self.joints, self.client)
        return [one[0] for one in states], [one[1] for one in states]

    def place(self, angles: Floats, rates: Floats) -> None:
        """Put the joints at angles (n,) [rad], moving at rates (n,) [rad/s]."""
        for joint, angle, rate in zip(self.joints, angles.tolist(), rates.tolist(), strict=True):
            bullet.resetJointState(self.body, joint, angle, rate, self.client)

    def turn(self, rates: Floats, steps: int) -> Floats:
        """Steps under velocity motors, see `Bodies.turn`."""
        bullet.setJointMotorControlArray(
            self.body,
            self.joints,
            bullet.VELOCITY_CONTROL,
            targetVelocities=rates.tolist(),
            forces=self._limits,
            physicsClientId=self.client,
        )
        # a new command needs the largest motor torques in the first step
        self._advance()
        first = last = self._torques()
        for _ in range(steps - 1):
            self._advance()
        if steps > 1:
            last = self._torques()
        return np.array([a if abs(a) >= abs(b) else b for a, b in zip(first, last, strict=True)])

    def apply(self, torques: list[float]) -> None:
        """One physics step at joint torques [Nm], which PyBullet clears after each."""
        bullet.setJointMotorControlArray(
            self.body,
            self.joints,
            bullet.TORQUE_CONTROL,
            forces=torques,
            physicsClientId=self.client,
        )
        self._advance()

    def weight(self, posture: Floats) -> Floats:
        """Gravity torques (n,) [Nm] of the arm and its load in a posture (n,) [rad]."""
        still = [0.0] * len(posture)
        needed = bullet.calculateInverseDynamics(
            self.body, posture.tolist(), still, still, physicsClientId=self.client
        )
        return np.array(needed)

    def _torques(self) -> list[float]:
        states = bullet.getJointStates(self.body, self.joints, self.client)
        return [one[3] for one in states]

    def _advance(self) -> None:
        """One step; PyBullet clears forces after each."""
        if self._pushes:
            for link, force in self._pushes.of_next_step():
                self._push(link, force.tolist())
        bullet.stepSimulation(self.client)

    def _push(self, number: int, force: list[float]) -> None:
        link = self.joints[number - 1] if number else self._flange
        state: Any = bullet.getLinkState(
            self.body, link, computeForwardKinematics=True, physicsClientId=self.client
        )
        point = state[0]  # the centre of mass
        if not number:
            x, y, z, w = state[5]
            flange = dq.pose_from(state[4], np.array([w, x, y, z]))
            point = dq.translation(dq.mul(flange, self._tool)).tolist()
        bullet.applyExternalForce(
            self.body, link, force, point, bullet.WORLD_FRAME, physicsClientId=self.client
        )

    def _link_named(self, name: str) -> int:
        count = bullet.getNumJoints(self.body, physicsClientId=self.client)
        names = [
            bullet.getJointInfo(self.body, i, physicsClientId=self.client)[12].decode()
            for i in range(count)
        ]
        return names.index(name)
