"""Base pose, payloads and pushes of an arm: the surroundings in which a plant simulates it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from dqpaint import dq
from dqpaint.dq import Floats

GRAVITY = -9.81  # [m/s^2]


@dataclass(frozen=True)
class Payload:
    """A ball at the light's position, with a mass [kg] and a radius [m]."""

    mass: float
    radius: float


@dataclass(frozen=True)
class Push:
    """A force for a limited time.

    Attributes:
        force: (3,) [N], along the axes of the base the law believes in.
        link: which link, from 1, at its centre of mass; 0 is the tool, at the light.
        start: from when [s].
        seconds: for how long.
    """

    force: tuple[float, float, float]
    link: int
    start: float
    seconds: float


@dataclass(frozen=True)
class ForceCourse:
    """A force that changes in time.

    Attributes:
        forces: times (N,) [s] -> forces (N, 3) [N], along the axes of the base the law believes in.
        link: as of a `Push`.
    """

    forces: Callable[[Floats], Floats]
    link: int


@dataclass(frozen=True)
class World:
    """The true surroundings of an arm, which no law knows.

    Attributes:
        base: pose (8,) of the arm's true base in the frame the law takes for it.
        payloads: carried by the arm.
        pushes: what pushes it.
        model_gravity: the gravity of the arm's own model, as a part of the true one.
    """

    base: Floats = field(default_factory=dq.IDENTITY.copy)
    payloads: tuple[Payload, ...] = ()
    pushes: tuple[Push | ForceCourse, ...] = ()
    model_gravity: float = 1.0

    @cached_property
    def is_displaced(self) -> bool:
        """Whether the base differs from its assumed pose."""
        return bool((self.base != dq.IDENTITY).any())

    @property
    def gravity(self) -> Floats:
        """Gravity (3,) [m/s^2] in the axes of the arm's true base."""
        return self.in_base(np.array([0.0, 0.0, GRAVITY]))

    def in_base(self, vector: Floats) -> Floats:
        """A vector (3,) of the assumed base in the axes of the true base."""
        if not self.is_displaced:
            return vector
        R = dq.matrix_from_quaternion(dq.rotation(self.base))
        return np.asarray(R.T @ vector)


def pushes_at(world: World, t: Floats) -> Floats:
    """The force (N, 3) [N] on the tool at times (N,) [s], all pushes on it together."""
    found = np.zeros((len(t), 3))
    for push in world.pushes:
        if push.link:
            continue
        if isinstance(push, ForceCourse):
            found += push.forces(t)
        else:
            during = (t >= push.start) & (t < push.start + push.seconds)
            found += during[:, None] * np.array(push.force)
    return found


UNDISTURBED = World()
