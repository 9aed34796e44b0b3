"""Many steps of light -> a few lamps that light a scene."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from dqpaint.dq import Floats

MOST_LAMPS = 128
"""Largest number of lamps for a painting."""


@dataclass(frozen=True, eq=False)
class Lamps:
    """Points that shine in all directions.

    Attributes:
        position: (K, 3) base frame [m].
        energy: (K, 3) linear RGB [lamp s].
    """

    position: Floats
    energy: Floats

    @property
    def total(self) -> Floats:
        """Energy (3,) of all lamps [lamp s]."""
        return np.asarray(self.energy.sum(axis=0))

    @property
    def middle(self) -> Floats:
        """The approximate median position (3,) of the light [m]."""
        weight = self.energy.sum(axis=1)
        return np.asarray((weight[:, None] * self.position).sum(axis=0) / weight.sum())


def gather_lamps(lights: Iterable[tuple[Floats, Floats]], most: int = MOST_LAMPS) -> Lamps:
    """A few lamps that light a scene as many steps do, with the same energy and position.

    Args:
        lights: of each light its points (N, 3) [m] and the energy (N-1, 3) of the steps between.
        most: lamps there may be.
    """
    pairs = list(lights)
    place = np.concatenate([0.5 * (points[1:] + points[:-1]) for points, _ in pairs])
    energy = np.concatenate([energy for _, energy in pairs])
    weight = energy.sum(axis=1)
    lit = weight > 0.0
    place, energy, weight = place[lit], energy[lit], weight[lit]
    if len(weight) == 0:
        return Lamps(np.zeros((0, 3)), np.zeros((0, 3)))
    done = np.cumsum(weight)
    group = np.minimum((done - 0.5 * weight) / done[-1] * most, most - 1).astype(np.int64)
    begins = np.flatnonzero(np.diff(group, prepend=-1))
    mass = np.add.reduceat(weight, begins)
    moment = np.add.reduceat(weight[:, None] * place, begins, axis=0)
    return Lamps(moment / mass[:, None], np.add.reduceat(energy, begins, axis=0))
