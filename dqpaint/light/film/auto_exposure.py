"""Light sent to a camera -> the exposure factor that suits its lines and its filled areas."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from dqpaint.light.arrays import Floats
from dqpaint.light.camera.camera import NEAREST_DEPTH, Camera
from dqpaint.light.film.film import PAD, expose
from dqpaint.light.film.point_spread import REFERENCE_HEIGHT, PointSpread, point_spread
from dqpaint.light.film.projection import cut_into_bins, project_light
from dqpaint.light.sources.emission import Emission, Light
from dqpaint.light.sources.sheet import Sheet, sheet_cells
from dqpaint.light.sources.sweep import Sweep

CORE_EXPOSURE = 14.0
"""Exposure of the core of the median stroke; 1 saturates the sensor. Photographers' usual settings
give 10 to 20 for a small LED."""
AREA_EXPOSURE = 1.6
"""Largest mean exposure of a bright area: it stays below white, and a colour keeps its hue."""
AREA_SIZE = 32
"""Side of the areas [px of the reference picture]. A single stroke through one has a little less
than `AREA_EXPOSURE` when its core has `CORE_EXPOSURE`: only what lies closer together is limited.
"""
BRIGHT_SHARE = 0.8
"""Share of the lit path length whose areas stay within `AREA_EXPOSURE`."""
LARGEST_CONTRAST = 6.0
"""Brightness of bright areas over that of the median, at most: else dim lines would be lost."""
METERED_SHARE = 0.02
"""Share of an image's brightest part; dimmer parts are background and are not metered."""
WIDEST_REFERENCE = 16_384
"""Columns of the reference picture at most, for pictures that are very wide."""
SHORTEST_PIECE = 0.1
"""Path length that a lamp counts that does not move, in sides of an area."""
METERED_LAMPS = 4
"""Number of lamps of a bar whose lines are metered."""
LAMP_GROUPS = 32
"""Groups into which the lamps of a brush are put for its areas. A brush of more lamps has no lines
of its own: they lie closer together than `AREA_SIZE`."""


def automatic_exposure(
    light: Emission | Iterable[Emission], camera: Camera, level: float | None = None
) -> float:
    """The exposure factor from lamp s / px^2 to sensor saturation that suits `light`.

    It is the smaller of two: one puts the core of the median stroke at `CORE_EXPOSURE`, see
    `line_exposure`; the other keeps areas within `AREA_EXPOSURE`, see `_area_exposure`, so that
    hatchings, dense drawings and surfaces keep their tones.

    Both are metered on a picture of `REFERENCE_HEIGHT` rows. So the light that falls on the film
    for a given drawing does not depend on how many pixels the picture has.

    Args:
        light: The reference light, so that an arm's errors do not change the exposure.
        camera: Where it is seen from.
        level: Exposure of lines and areas alike, for a picture whose colours are to be read;
            lines are metered at the picture's own size then, so that they can be read in any.

    Returns:
        The factor; 1 if nothing is lit on the picture, as any picture of nothing is black.
    """
    lights = tuple(light) if isinstance(light, Iterable) else (light,)
    scale = min(REFERENCE_HEIGHT / camera.height, WIDEST_REFERENCE / camera.width)
    reference = camera.scaled(scale)
    area = _area_exposure(lights, reference) / scale**2
    if level is None:
        line = line_exposure(lights, reference, point_spread(reference.height)) / scale**2
        limits = CORE_EXPOSURE * line, AREA_EXPOSURE * area
    else:
        limits = level * line_exposure(lights, camera, point_spread(camera.height)), level * area
    return min((limit for limit in limits if limit > 0.0), default=1.0)


def line_exposure(light: Iterable[Emission], camera: Camera, psf: PointSpread) -> float:
    """The exposure factor that saturates the core of the median stroke; 0 if nothing is lit.

    A stroke of energy lambda per pixel has a ridge of lambda psf.line_peak. In its strongest
    channel, the median over the lit path length on the picture is put at 1.

    A lamp that does not move has no path length. Its peak is energy x psf.point_peak, that of
    a line when the energy is laid out over line_peak / point_peak, about the width of the core; so
    path is measured in pieces of this length, and a shorter stroke counts as one whole piece.

    Args:
        light: What is metered.
        camera: Where it is seen from.
        psf: How points are spread.
    """
    values, lengths = [np.empty(0)], [np.empty(0)]
    for emission in light:
        few = _few_lamps(emission)
        for value, length in _lines(few, camera, psf) if few is not None else ():
            values.append(value)
            lengths.append(length)
    ridge = _weighted_quantile(np.concatenate(values), np.concatenate(lengths), 0.5)
    return 1.0 / ridge if ridge > 0.0 else 0.0


def _lines(emission: Emission, camera: Camera, psf: PointSpread) -> Iterator[tuple[Floats, Floats]]:
    """Brightness (M,) of the ridge of the parts of a light's lines, and their lengths (M,)."""
    piece = psf.line_peak / psf.point_peak
    for light in emission.emission_to(camera):
        if not isinstance(light, Light):
            continue  # a sheet has no lines
        width = _width(light, camera, psf)
        for trail in project_light(light, camera, margin=0.0):
            for part in cut_into_bins(trail, piece):
                length = np.where(part.alone, piece, part.length)
                yield part.energy.max(axis=0) / (length * width), length


def _few_lamps(emission: Emission) -> Emission | None:
    """The light of at most `METERED_LAMPS` lamps of a brush; None if they draw no lines."""
    if not isinstance(emission, Sweep) or len(emission.emitters.positions) <= METERED_LAMPS:
        return emission
    e = emission.emitters
    if e.joined == 1.0 or len(e.positions) > LAMP_GROUPS:
        return None
    kept = np.linspace(0, len(e.positions) - 1, METERED_LAMPS).round().astype(np.int64)
    few = replace(e, positions=e.positions[kept], tints=e.tints[:, kept])
    return replace(emission, emitters=few)


def _grouped_lamps(emission: Emission) -> Emission:
    """The same light from at most `LAMP_GROUPS` lamps of a brush: enough for areas."""
    if not isinstance(emission, Sweep) or len(emission.emitters.positions) <= LAMP_GROUPS:
        return emission
    e = emission.emitters
    edges = np.linspace(0, len(e.positions), LAMP_GROUPS + 1).astype(np.int64)
    first, count = edges[:-1], np.diff(edges)
    few = replace(
        e,
        positions=np.add.reduceat(e.positions, first, axis=0) / count[:, None],
        tints=np.add.reduceat(e.tints, first, axis=1),
    )
    return replace(emission, emitters=few)


def _width(light: Light, camera: Camera, psf: PointSpread) -> float:
    """Width of the line of a lamp [px]: its energy by its ridge. A disc adds its mean chord."""
    line = 1.0 / psf.line_peak
    _, depth = camera.project(light.lit_points)
    seen = depth[depth > NEAREST_DEPTH]
    if light.size == 0.0 or len(seen) == 0:
        return line
    diameter = light.size * camera.focal / float(np.median(seen))
    return math.hypot(line, math.pi / 4.0 * diameter)


def _area_exposure(lights: tuple[Emission, ...], camera: Camera) -> float:
    """The exposure factor that saturates the brighter areas; 0 if nothing is lit.

    Each part of the lit path has the mean brightness of the area around it, of all light there, in
    its strongest channel. As a photographer meters the brighter part of a picture,
    `BRIGHT_SHARE` of the path is at most as bright as saturates. A lamp that does not move counts
    as a short piece of path, so a hold does not darken a drawing.
    """
    coarse = camera.scaled(1.0 / AREA_SIZE)
    few = tuple(map(_grouped_lamps, lights))
    areas = expose(few, coarse).planes[:, PAD:-PAD, PAD:-PAD].max(axis=0) / AREA_SIZE**2
    values, weights = [np.empty(0)], [np.empty(0)]
    for emission in few:
        for position, energy, weight in _parts(emission, coarse):
            x, y = np.rint(position).astype(np.int64)
            inside = (x >= 0) & (x < coarse.width) & (y >= 0) & (y < coarse.height)
            lit = inside & (energy > _darkest(emission, energy))
            values.append(areas[y[lit], x[lit]])
            weights.append(weight[lit])
    value, weight = np.concatenate(values), np.concatenate(weights)
    bright = _weighted_quantile(value, weight, BRIGHT_SHARE)
    bright = min(bright, LARGEST_CONTRAST * _weighted_quantile(value, weight, 0.5))
    return 1.0 / bright if bright > 0.0 else 0.0


def _darkest(emission: Emission, energy: Floats) -> float:
    """The energy from which on parts (M,) are metered: the dark ground of an image is not."""
    image = isinstance(emission, Sweep) and len(emission.emitters.tints) > 1
    return METERED_SHARE * float(energy.max(initial=0.0)) if image else 0.0


def _parts(emission: Emission, camera: Camera) -> Iterator[tuple[Floats, Floats, Floats]]:
    """Positions (2, M) [px], strongest energies (M,) by path length, and path lengths (M,) [px]."""
    for piece in emission.emission_to(camera):
        if isinstance(piece, Sheet):
            for cells in sheet_cells(piece, camera, 0.0):
                yield cells.position, cells.energy.max(axis=0), np.ones(cells.position.shape[1])
            continue
        for trail in project_light(piece, camera, margin=0.0):
            for part in cut_into_bins(trail, 1.0):
                length = np.where(part.alone, SHORTEST_PIECE, part.length)
                yield part.position, part.energy.max(axis=0) / length, length


def _weighted_quantile(values: Floats, weights: Floats, share: float) -> float:
    """The value with a share of the weight at or below it; 0 for no values."""
    if len(values) == 0:
        return 0.0
    order = np.argsort(values, kind="stable")
    below = np.cumsum(weights[order])
    return float(values[order[np.searchsorted(below, share * below[-1])]])
