"""The text of a lamp -> what powers it can have, and the powers of a path rounded to them.

A new lamp is an entry of `LAMPS`; from then on `--lamp NAME:KEY=VALUE` takes it.
"""

from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from dqpaint.core import Registry, make_choice, read_choice
from dqpaint.core.arrays import Floats

MOST_BITS = 16


class Lamp(BaseModel):
    """The powers that a lamp can have, as shares of its largest."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    bits: Annotated[int, Field(ge=0, le=MOST_BITS, description="steps of its power; 0: any")] = 0
    gamma: Annotated[
        float, Field(gt=0, le=5, description="power is the value to this; 1: evenly spaced")
    ] = 1.0
    least: Annotated[
        float, Field(ge=0, lt=1, description="share of its power below which it is off")
    ] = 0.0

    @property
    def levels(self) -> Floats | None:
        """Its powers (L,), rising from 0 to 1; None: any from `least` on."""
        if not self.bits:
            return None
        most = (1 << self.bits) - 1
        powers = (np.arange(most + 1) / most) ** self.gamma
        return np.asarray(powers[(powers >= self.least) | (np.arange(most + 1) == 0)])

    def rounded(self, powers: Floats, weights: Floats, joined: Floats) -> Floats:
        """Powers (K, 3) that it can have, near those wanted along a path.

        What is lost in one step is given to the next, so that the light of a stretch of path is
        kept: the film cannot tell one step from the next.

        Args:
            powers: wanted, 0 to 1.
            weights: (K,) seconds of each step.
            joined: (K,) whether a step goes on from the one before.
        """
        levels = self.levels
        if levels is None and self.least == 0.0:
            return powers
        if levels is None:
            levels = np.concatenate([[0.0], np.linspace(self.least, 1.0, 1 << MOST_BITS)])
        edges = 0.5 * (levels[1:] + levels[:-1])
        found, owed = np.empty_like(powers), np.zeros(powers.shape[1])
        for k, (power, weight, on) in enumerate(zip(powers, weights, joined, strict=True)):
            wanted = power + (owed / weight if on else 0.0)
            found[k] = levels[np.searchsorted(edges, wanted)]
            found[k][power == 0.0] = 0.0
            owed = np.where(power > 0.0, (wanted - found[k]) * weight, 0.0)
        return found


LAMPS: Registry[Lamp] = Registry("lamp")
LAMPS.add("ideal")(Lamp())
LAMPS.add("dimmed")(Lamp(bits=8, gamma=2.2))
LAMPS.add("switched")(Lamp(bits=1))


def read_lamp(text: str) -> Lamp:
    """The lamp of a text `NAME[:KEY=VALUE,...]`, such as `dimmed:bits=5,gamma=2.2`.

    Raises:
        UsageError: an unknown lamp or key, or a value outside its range.
    """
    name, values = read_choice("lamp", text, "dimmed:bits=8")
    given = LAMPS[name].model_dump(exclude_defaults=True) | values
    return make_choice("lamp", name, Lamp, given)
