"""The data of everything that shines: lamps and their tints in the tool frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from dqpaint.core.arrays import Floats, checked_array
from dqpaint.errors import DqpaintError

ORIGIN = ((0.0, 0.0, 0.0),)
WHITE_TINT = (((1.0, 1.0, 1.0),),)


@dataclass(frozen=True, eq=False)
class Emitters:
    """K lamps on a tool. Arrays are copied and read-only.

    In a time dt the colour c of a stroke makes lamp k give off c dt tints[r, k], so a plain brush,
    whose tints add up to 1, gives as much light as a single lamp.

    Attributes:
        positions: (K, 3) of the lamps, tool frame [m].
        tints: (R, K, 3) share of the brush's light each lamp gives, linear RGB. R rows follow each
            other along the way: an image drawn by a moving bar. A brush of one look has R = 1.
        size: Diameter of each lamp, seen as an even disc [m].
        joined: Share of the light that a diffuser spreads evenly along the straight line of lamps,
            from 0, single lamps, to 1, a ribbon.
        normal: (3,) unit vector, tool frame, towards which the lamps shine.
        lobe: m of the intensity cos^m(angle to the normal), dark behind; 0 shines everywhere.
    """

    positions: Floats = ORIGIN  # type: ignore[assignment]  # it is an array from __post_init__ on
    tints: Floats = WHITE_TINT  # type: ignore[assignment]
    size: float = 0.0
    joined: float = 0.0
    normal: Floats = (0.0, 0.0, 1.0)  # type: ignore[assignment]
    lobe: float = 0.0

    def __post_init__(self) -> None:
        places = checked_array("lamp place", self.positions, (None, 3))
        tints = checked_array("lamp tint", self.tints, (None, len(places), 3))
        if len(places) == 0 or len(tints) == 0:
            raise ValueError("a brush has no lamp")
        if tints.min() < 0.0:
            raise DqpaintError(f"lamp tint {tints.min()} is negative")
        if self.joined > 0.0 and len(places) < 2:
            raise ValueError("a line of lamps needs at least two lamps")
        object.__setattr__(self, "positions", places)
        object.__setattr__(self, "tints", tints)
        object.__setattr__(self, "normal", checked_array("lamp normal", self.normal, (3,)))

    @property
    def single(self) -> bool:
        """Whether this is one lamp at the tool's origin, so that rotation has no effect."""
        return len(self.positions) == 1 and not self.positions.any() and self.lobe == 0.0

    @property
    def straight(self) -> bool:
        """Whether the lamps are on one straight line."""
        away = self.positions - self.positions[0]
        axis = away[-1]
        off = away * (axis @ axis) - np.outer(away @ axis, axis)
        return bool(np.abs(off).max() <= 1e-9 * max(1e-30, np.abs(away).max() ** 3))

    @property
    def extent(self) -> Floats:
        """The ends (2, 3) of a line of lamps, half a gap beyond the outer lamps [m].

        Of a bundle it is a width that bears as much light, whichever way the tool moves.
        """
        if not self.straight:
            width = np.array([[-0.4, -0.4, 0.0], [0.4, 0.4, 0.0]])
            return np.asarray(width * self.reach * np.sqrt(2.0))
        first, last = self.positions[0], self.positions[-1]
        half = 0.5 * (last - first) / max(len(self.positions) - 1, 1)
        return np.stack([first - half, last + half])

    def positions_along(self, spacing: float) -> Floats:
        """Positions (P, 3) from end to end, at most `spacing` [m] apart; or the centre."""
        first, last = self.extent
        if len(self.positions) == 1 or not self.straight:
            return np.asarray(self.positions.mean(axis=0, keepdims=True))
        gaps = max(1, int(np.ceil(np.linalg.norm(last - first) / spacing)))
        return np.asarray(first + np.linspace(0.0, 1.0, gaps + 1)[:, None] * (last - first))

    @property
    def outermost(self) -> Floats:
        """Positions (E, 3) that enclose everything that shines [m]."""
        return self.extent if self.straight else np.asarray(self.positions)

    @property
    def reach(self) -> float:
        """Distance of the outermost lamp from the tool's origin [m]."""
        away = self.positions if not self.straight else self.extent
        return float(np.sqrt((away**2).sum(axis=-1)).max())


POINT = Emitters()
"""A single LED at the tool's tip."""
