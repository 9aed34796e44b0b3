"""The interface of disturbances, and their names and values -> checked disturbances."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import numpy as np
from pydantic import BaseModel, ConfigDict

from dqpaint.core import Folder, Registry, Values, make_choice, subclass
from dqpaint.dq import Floats
from dqpaint.plants import Trait, World
from dqpaint.robots.kinematics import Kinematics


@dataclass(frozen=True)
class Encoder:
    """Measurement errors of joint angles.

    Attributes:
        errors: added at each row (N, n) [rad]; of many runs (N, B, n).
        step: to which a reading is rounded [rad]; 0 is not at all.
    """

    errors: Floats
    step: float

    def read(self, row: int, angles: Floats) -> Floats:
        """The measured angles at a row, from true angles (n,) or (B, n) [rad]."""
        found = angles + self.errors[row]
        return np.asarray(self.step * np.round(found / self.step) if self.step else found)


class Disturbance(BaseModel):
    """One disturbance; its fields are values in SI units, each description has the unit.

    A value that is given without a name is the first field's. A disturbance overrides the hooks of
    what it disturbs; at size zero each of them changes nothing. Random numbers come from `rng`
    alone.

    Attributes:
        needs: what a plant must have for the disturbance to show.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    needs: ClassVar[Trait | None] = None

    def twist(self, t: Floats, period: float, rng: "np.random.Generator") -> Floats:
        """Twist (N, 6) added to the tool's motion.

        From each time (N,) [s] to the next; angular first [rad/s], then of the tool's own point
        [m/s], along the axes of the base.

        Raises:
            UsageError: a value that does not go with the period.
        """
        return np.zeros((len(t), 6))

    def check(self, t: Floats) -> None:
        """Check that the disturbance has an effect in a run with times (N,) [s].

        Raises:
            UsageError: it cannot.
        """

    def encoder(self, rows: int, joints: int, rng: "np.random.Generator") -> Encoder | None:
        """The encoder's errors in a number of rows; None for exact measurement."""
        return None

    @property
    def delay(self) -> int:
        """Delay of commands on their way to the motors, in periods."""
        return 0

    def world(self, world: World) -> World:
        """The true state of the arm and its surroundings."""
        return world

    def law_model(self, kinematics: Kinematics, rng: "np.random.Generator") -> Kinematics:
        """The law's model of the arm."""
        return kinematics


DISTURBANCES: Registry[type[Disturbance]] = Folder(
    "disturbance", "dqpaint.disturbances", "dqpaint.disturbances", partial(subclass, Disturbance)
)


def make_disturbances(given: Mapping[str, Values]) -> dict[str, Disturbance]:
    """Make disturbances from their names and values.

    Raises:
        UsageError: an unknown disturbance, an unknown value, or one outside its range.
    """
    return {
        name: make_choice("disturbance", name, DISTURBANCES[name], values)
        for name, values in given.items()
    }
