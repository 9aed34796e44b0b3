"""Brushes turn a tool's movement into light: positions and colours in, `Light` out.

A brush is a function that returns one `Light` for each lamp it carries. There is one so far, the
point of a single LED.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from dqpaint.errors import DqpaintError
from dqpaint.light.arrays import Floats, kept


@dataclass(frozen=True, eq=False)
class Light:
    """What one lamp emitted on its way through N instants.

    Between two instants the lamp moves straight and evenly. Arrays are copied and read-only.

    Attributes:
        points: (N, 3) where the lamp is at each instant, base frame [m].
        energy: (N-1, 3) what it emits from one instant to the next, linear RGB [lamp s]: a lamp
            of colour 1 that burns for a second emits 1.
    """

    points: Floats
    energy: Floats

    def __post_init__(self) -> None:
        points = kept("lamp position", self.points, (None, 3))
        if len(points) == 0:
            raise ValueError("lamp position has no instant; at least one is needed")
        energy = kept("lamp energy", self.energy, (len(points) - 1, 3))
        if energy.min(initial=0.0) < 0.0:
            raise DqpaintError(f"lamp energy {energy.min()} is negative")
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "energy", energy)

    @property
    def lit_points(self) -> Floats:
        """(K, 3) the points at either end of a step in which the lamp burns [m]."""
        burning = self.energy.any(axis=1)
        lit = np.zeros(len(self.points), dtype=bool)
        lit[:-1] |= burning
        lit[1:] |= burning
        return self.points[lit]


def shine(positions: ArrayLike, colours: ArrayLike, period: float) -> Light:
    """The light of one LED at the tool's tip.

    Args:
        positions: (N, 3) of the tip at instants a period apart, base frame [m].
        colours: (N, 3) linear RGB, not negative; row k is the mean from instant k to k+1, and
            zero is dark. The last row has no such interval and is not used.
        period: Time from one instant to the next [s].
    """
    if not (np.isfinite(period) and period > 0.0):
        raise DqpaintError(f"period {period} s must be positive")
    points = kept("lamp position", positions, (None, 3))
    rgb = kept("lamp colour", colours, (len(points), 3))
    return Light(points, rgb[:-1] * period)
