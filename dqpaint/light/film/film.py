"""Light sent to a camera -> film: energy accumulated in linear RGB, with its balance."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from dqpaint.light.arrays import Floats, sum_rows
from dqpaint.light.camera.camera import Camera
from dqpaint.light.film import discs
from dqpaint.light.film.projection import cut_into_bins, project_light
from dqpaint.light.sources import sheet
from dqpaint.light.sources.emission import Emission, Light
from dqpaint.light.sources.sheet import Sheet

PAD = 64
"""Guard band around the picture [px]: light just outside still blooms into it, and the border
effects of the spreading stay out of the picture."""
DEPOSIT_SPACING = 1.0
"""Distance between deposits along a path [px]; on a diagonal it leaves a ripple of 1 % from pixel
to pixel, which the spreading removes."""
SPLINE_VARIANCE = 0.25
"""Variance of a deposit along each axis [px^2], for any position between pixels."""


@dataclass(frozen=True, eq=False)
class Film:
    """The energy on the film and the energy that missed it, linear RGB [lamp s].

    Attributes:
        planes: (3, H + 2 PAD, W + 2 PAD) energy in each pixel, with the guard band.
        emitted: (3,) what the light gave off.
        lost: (3,) the part that missed the film.
    """

    planes: Floats
    emitted: Floats
    lost: Floats

    @property
    def on_film(self) -> Floats:
        """The energy (3,) on the film, from its pixels: emitted = on_film + lost."""
        return np.asarray(self.planes.sum(axis=(1, 2)))


def expose(light: Emission | Iterable[Emission], camera: Camera, falloff: bool = False) -> Film:
    """Expose a film of the camera's size, plus the guard band, to all of `light`.

    A deposit is spread over 3x3 pixels by the quadratic B-spline. That is the smoothest weight of
    its size, and unlike the bilinear one it has the same variance between pixels as on them, so
    that a slanted line is not beaded.

    Args:
        light: What shines; several add up.
        camera: Where it is seen from.
        falloff: Whether light is divided by its distance squared [lamp s / m^2].
    """
    exposing = FilmAccumulator(camera)
    for emission in light if isinstance(light, Iterable) else (light,):
        for piece in emission.emission_to(camera, falloff):
            exposing.add(piece)
    return exposing.film()


class FilmAccumulator:
    """A film under exposure: light is added piece by piece; the film can be read at any time.

    Args:
        camera: Where the light is seen from.
    """

    def __init__(self, camera: Camera) -> None:
        self.camera = camera
        self._shape = (3, camera.height + 2 * PAD, camera.width + 2 * PAD)
        self._planes = np.zeros(self._shape)
        self._discs: dict[int, Floats] = {}
        self._emitted, self._lost = np.zeros(3), np.zeros(3)

    def add(self, piece: Light | Sheet) -> None:
        """Expose the film to one piece of light."""
        margin = PAD - 1.0  # a spline needs a pixel on either side
        if isinstance(piece, Sheet):
            self._emitted += piece.emitted
            for part in sheet.sheet_cells(piece, self.camera, margin):
                self._lost += part.lost
                _deposit(self._planes, part.position + PAD, part.energy)
            return
        self._emitted += sum_rows(piece.energy)
        for planes, light in self._layers(piece):
            for trail in project_light(light, self.camera, margin):
                self._lost += trail.lost
                for bit in cut_into_bins(trail, DEPOSIT_SPACING):
                    _deposit(planes, bit.position + PAD, bit.energy)

    def _layers(self, light: Light) -> Iterator[tuple[Floats, Light]]:
        """The layers for a light: one per diameter if its lamps appear as discs."""
        if light.size == 0.0:
            yield self._planes, light
            return
        for layer, share in discs.disc_layers(light, self.camera):
            planes = self._planes
            if layer is not None:
                planes = self._discs.setdefault(layer, np.zeros(self._shape))
            yield planes, Light(light.points, light.energy * share[:, None])

    def film(self) -> Film:
        """The film so far."""
        planes, lost = self._planes.copy() if self._discs else self._planes, self._lost.copy()
        for layer, points in sorted(self._discs.items()):
            spread = discs.spread_discs(points, layer)
            lost += points.sum(axis=(1, 2)) - spread.sum(axis=(1, 2))
            planes += spread
        film = Film(planes.view(), self._emitted.copy(), np.maximum(lost, 0.0))
        for array in (film.planes, film.emitted, film.lost):
            array.setflags(write=False)
        return film


def _deposit(planes: Floats, position: Floats, energy: Floats) -> None:
    """Add energy (3, B) at film positions (2, B) (x, y) to the planes."""
    width = planes.shape[2]
    x, y = np.rint(position)
    across, down = spline_weights(position[0] - x), spline_weights(position[1] - y)
    pixel = (y * width + x).astype(np.int64)
    around = np.array([[-1], [0], [1]])
    index = (pixel + width * around[:, None] + around[None, :]).ravel()
    weight = down[:, None] * across[None, :]
    for plane, colour in zip(planes.reshape(3, -1), energy, strict=True):
        # unlike a bincount it touches only the pixels that are lit, and it adds in order
        np.add.at(plane, index, (weight * colour).ravel())


def spline_weights(t: Floats) -> Floats:
    """Weights (3, B) of the pixels -1, 0 and 1 for a deposit at t, -1/2 <= t <= 1/2.

    The quadratic B-spline; Unser, Splines: a perfect fit for signal processing, IEEE SPM 1999.
    """
    return np.stack([0.5 * (0.5 - t) ** 2, 0.75 - t * t, 0.5 * (0.5 + t) ** 2])
