"""A card -> an arm of rigid bodies in a physics engine, the base of all plants with masses."""

import math
from typing import ClassVar

import numpy as np

from dqpaint.dq import Floats
from dqpaint.plants.engines import choose_engine
from dqpaint.plants.plant import Options, Trait
from dqpaint.plants.world import UNDISTURBED, World
from dqpaint.robots.model import Card

LONGEST_STEP = 1e-3  # [s] of physics
SAMPLE_COUNT, SEED = 64, 1988  # random postures that represent the arm's range


def sample_postures(card: Card) -> Floats:
    """Postures (65, n) [rad]: home, and others across the arm's range."""
    rng = np.random.default_rng(SEED)
    others = rng.uniform(card.lower, card.upper, (SAMPLE_COUNT, card.joints))
    return np.vstack([card.home, others])


class RigidArm:
    """The bodies of a card's arm, at rest in a posture, in a physics engine.

    Physics steps are the period divided into equal parts of at most 1 ms.

    Attributes:
        steps: of physics in a period.
        step: the length of one [s].
        bodies: what the engine simulates.
        posture: as in `Plant`, likewise `rates` and `effort`.

    Raises:
        UsageError: a push on a link the arm does not have, or an engine that is not installed.
    """

    traits: ClassVar[frozenset[Trait]] = frozenset({"masses", "an engine"})
    options: ClassVar[Options] = None
    driven: ClassVar[bool] = False
    """Whether its motors are the engine's velocity motors."""

    def __init__(
        self,
        card: Card,
        posture: Floats,
        period: float,
        world: World = UNDISTURBED,
        options: None = None,
        engine: str | None = None,
        longest: float | None = None,
    ) -> None:
        self.card = card
        longest = self.longest_step(card) if longest is None else longest
        self.steps = max(1, math.ceil(period / longest - 1e-9))
        self.step = period / self.steps  # [s]
        build = choose_engine(engine).load()
        self.bodies = build(card, posture, self.step, world, self.driven)
        self.posture = posture.copy()
        self.rates = np.zeros(card.joints)
        self.effort = np.zeros(card.joints)

    @staticmethod
    def longest_step(_card: Card) -> float:
        """The longest physics step [s] that its motors allow, where its values do not say so."""
        return LONGEST_STEP

    @property
    def encoder(self) -> Floats:
        """Joint angles (n,) [rad]."""
        return self.posture

    @property
    def encoder_rates(self) -> Floats:
        """Joint rates (n,) [rad/s]."""
        return self.rates

    def read_joints(self) -> None:
        """Read angles [rad] and rates of the joints."""
        angles, rates = self.bodies.state()
        self.posture, self.rates = np.array(angles), np.array(rates)

    def displace(self, angles: Floats) -> None:
        """Add angles (n,) [rad] to the joints; their rates stay the same."""
        self.read_joints()
        self.bodies.place(self.posture + angles, self.rates)

    def close(self) -> None:
        """Release the bodies."""
        self.bodies.close()
