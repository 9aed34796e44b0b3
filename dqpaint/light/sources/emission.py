"""Lamps along their paths -> emission: the straight steps of light sent to a camera."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from dqpaint.errors import DqpaintError
from dqpaint.light.arrays import Floats, checked_array
from dqpaint.light.camera.camera import Camera
from dqpaint.light.sources.sheet import Sheet


class Emission(Protocol):
    """Anything that shines: it returns the light that it sends to a given camera."""

    def emission_to(self, camera: Camera, falloff: bool = False) -> Iterator[Light | Sheet]:
        """Yield the light sent to the camera, piece by piece in the order of time.

        Args:
            camera: Who is looking.
            falloff: Whether energies are divided by the square of the distance [m^2], for an
                exposure by a camera's real settings.
        """
        ...


@dataclass(frozen=True, eq=False)
class Light:
    """The light that one lamp emits along its path through N instants.

    Between two instants the lamp moves straight and evenly. Arrays are copied and read-only.

    Attributes:
        points: (N, 3) where the lamp is at each instant, base frame [m].
        energy: (N-1, 3) energy emitted from one instant to the next, linear RGB [lamp s]: a lamp
            of colour 1 that burns for a second emits 1.
        size: Diameter of the lamp, which looks like an even disc from everywhere; 0 is a point [m].
    """

    points: Floats
    energy: Floats
    size: float = 0.0

    def __post_init__(self) -> None:
        points = checked_array("lamp position", self.points, (None, 3))
        if len(points) == 0:
            raise ValueError("the lamp has no positions; it needs at least one")
        energy = checked_array("lamp energy", self.energy, (len(points) - 1, 3))
        if energy.min(initial=0.0) < 0.0:
            raise DqpaintError(f"lamp energy {energy.min()} is negative")
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "energy", energy)

    @property
    def lit_points(self) -> Floats:
        """The points (K, 3) at both ends of every step in which the lamp is on [m]."""
        return self.points[lit_instants(self.energy)]

    def emission_to(self, camera: Camera, falloff: bool = False) -> Iterator[Light | Sheet]:
        """See `Emission`."""
        if not falloff:
            yield self
            return
        middle = 0.5 * (self.points[1:] + self.points[:-1])
        yield Light(self.points, self.energy * inverse_square(middle, camera)[:, None], self.size)


def lit_instants(energy: Floats) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Whether each of N instants is an end of a lit step, for step energies (N-1, 3)."""
    burning = energy.any(axis=1)
    lit = np.zeros(len(energy) + 1, dtype=bool)
    lit[:-1] |= burning
    lit[1:] |= burning
    return lit


def inverse_square(points: Floats, camera: Camera) -> Floats:
    """1 / r^2 (...) for points (..., 3) and a camera [1/m^2], with r at least 1 mm."""
    away = points - camera.position
    return np.asarray(1.0 / np.maximum((away * away).sum(axis=-1), 1e-6))
