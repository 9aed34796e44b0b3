"""A card -> rigid bodies on joints with mechanical stops, the base of all PyBullet plants."""

import math
from collections.abc import Callable
from functools import partial
from typing import Any, ClassVar

import numpy as np

from dqpaint.dq import Floats
from dqpaint.plants.bullet_loads import TimedPush, check_pushes, with_payloads
from dqpaint.plants.plant import Options, Trait
from dqpaint.plants.world import UNDISTURBED, World
from dqpaint.robots.bullet import Client, bullet, joint_indices, quiet
from dqpaint.robots.model import Card
from dqpaint.robots.urdf import urdf_file

LONGEST_STEP = 1e-3  # [s] of physics
NO_SPEED_LIMIT = 1e9  # [rad/s]
STOP_DISTANCE = 0.02  # [rad] from a joint's limit to its mechanical stop; commands end at the limit
SAMPLE_COUNT, SEED = 64, 1988  # random postures that represent the arm's range


def sample_postures(card: Card) -> Floats:
    """Postures (65, n) [rad]: home, and others across the arm's range."""
    rng = np.random.default_rng(SEED)
    others = rng.uniform(card.lower, card.upper, (SAMPLE_COUNT, card.joints))
    return np.vstack([card.home, others])


class RigidArm(Client):
    """The bodies of a card's arm, at rest in a posture, in a PyBullet world of their own.

    Masses and inertias are the file's own. Shapes are left out: nothing touches anything in a
    light painting, and loading their meshes costs twenty times the rest. Physics steps are the
    period divided into equal parts of at most 1 ms. The Dantzig solver comes 45 times closer to
    commanded rates than the default one, and is faster.

    Attributes:
        steps: of physics in a period.
        step: the length of one [s].
        advance: makes one of them.
        posture: as in `Plant`, likewise `rates` and `effort`.

    Raises:
        UsageError: a push on a link the arm does not have.
    """

    traits: ClassVar[frozenset[Trait]] = frozenset({"masses"})
    options: ClassVar[Options] = None

    def __init__(
        self,
        card: Card,
        posture: Floats,
        period: float,
        world: World = UNDISTURBED,
        longest: float = LONGEST_STEP,
    ) -> None:
        check_pushes(world, card)
        self.card = card
        self.steps = max(1, math.ceil(period / longest - 1e-9))
        self.step = period / self.steps  # [s]
        super().__init__()
        with quiet():
            self.body = self._build(card, world)
        self.joints = joint_indices(self.body, self.client)
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
        self.posture = posture.copy()
        self.rates = np.zeros(card.joints)
        self.effort = np.zeros(card.joints)
        self.advance: Callable[[], object] = partial(bullet.stepSimulation, self.client)
        if world.pushes:
            self.advance = TimedPush(self, world)

    @property
    def encoder(self) -> Floats:
        """Joint angles (n,) [rad]."""
        return self.posture

    @property
    def encoder_rates(self) -> Floats:
        """Joint rates (n,) [rad/s]."""
        return self.rates

    def _build(self, card: Card, world: World) -> int:
        here = {"physicsClientId": self.client}
        solver = bullet.CONSTRAINT_SOLVER_LCP_DANTZIG
        bullet.setPhysicsEngineParameter(
            fixedTimeStep=self.step, constraintSolverType=solver, **here
        )
        bullet.setGravity(*world.gravity.tolist(), **here)
        flags = (
            bullet.URDF_USE_INERTIA_FROM_FILE
            | bullet.URDF_IGNORE_VISUAL_SHAPES
            | bullet.URDF_IGNORE_COLLISION_SHAPES
        )
        with urdf_file(card, partial(with_payloads, card=card, payloads=world.payloads)) as path:
            body: int = bullet.loadURDF(path, useFixedBase=True, flags=flags, **here)
        return body

    def read_joints(self) -> Any:
        """Read angle [rad], rate, forces and motor torque [Nm] of each joint."""
        states = bullet.getJointStates(self.body, self.joints, self.client)
        self.posture = np.array([state[0] for state in states])
        self.rates = np.array([state[1] for state in states])
        return states

    def disable_motors(self) -> None:
        """Switch off motors and damping, except for the file's own friction."""
        here = {"physicsClientId": self.client}
        for link in range(-1, bullet.getNumJoints(self.body, **here)):
            bullet.changeDynamics(self.body, link, linearDamping=0, angularDamping=0, **here)
        for joint in self.joints:  # PyBullet would end every rate at 100 rad/s
            bullet.changeDynamics(self.body, joint, maxJointVelocity=NO_SPEED_LIMIT, **here)
        idle = [0.0] * len(self.joints)
        bullet.setJointMotorControlArray(
            self.body, self.joints, bullet.VELOCITY_CONTROL, forces=idle, **here
        )

    def true_weight(self, posture: Floats) -> Floats:
        """Gravity torques (n,) [Nm] of the arm and its load in a posture (n,) [rad]."""
        still = [0.0] * len(posture)
        needed = bullet.calculateInverseDynamics(
            self.body, posture.tolist(), still, still, physicsClientId=self.client
        )
        return np.array(needed)

    def displace(self, angles: Floats) -> None:
        """Add angles (n,) [rad] to the joints; their rates stay the same."""
        self.read_joints()
        moved = (self.posture + angles).tolist()
        for joint, angle, rate in zip(self.joints, moved, self.rates.tolist(), strict=True):
            bullet.resetJointState(self.body, joint, angle, rate, self.client)
