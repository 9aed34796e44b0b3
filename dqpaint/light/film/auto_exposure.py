"""Light sent to a camera -> the exposure factor that gives its lines white cores."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np

from dqpaint.light.arrays import Floats
from dqpaint.light.camera.camera import NEAREST_DEPTH, Camera
from dqpaint.light.film.point_spread import PointSpread
from dqpaint.light.film.projection import cut_into_bins, project_light
from dqpaint.light.sources.emission import Emission, Light
from dqpaint.light.sources.sweep import Steps, Sweep

CORE_EXPOSURE = 12.0
"""Exposure of the core of the median stroke; 1 saturates the sensor. Photographers' usual settings
give 10 to 20 for a small LED."""
SURFACE_EXPOSURE = 0.9
"""Exposure of a surface swept by a bar: as bright as a line it would be all white."""
SURFACE_WIDTH = 8.0
"""A stroke this many line widths wide is exposed as a surface; a narrower one is exposed between
line and surface."""
METERED_PARTS = 8
"""Number of parts of a bar that are metered separately."""
METERED_SHARE = 0.02
"""Share of a bar's brightest part: dimmer parts are background and are not metered."""


def automatic_exposure(
    light: Emission | Iterable[Emission], camera: Camera, psf: PointSpread
) -> float:
    """The exposure factor from lamp s / px^2 to sensor saturation that suits `light`.

    A stroke of energy lambda per pixel has a ridge of lambda psf.line_peak. In its strongest
    channel, the median over the lit path length on the picture is put at `CORE_EXPOSURE`.

    A lamp that does not move has no path length. Its peak is energy x psf.point_peak, that of
    a line when the energy is laid out over line_peak / point_peak, about the width of the core; so
    path is measured in pieces of this length, and a shorter stroke counts as one whole piece.

    What is wider than a line is as bright as its light over its area, counts by its area, and is
    put the nearer to `SURFACE_EXPOSURE` the wider it is. What an image leaves dark does not count.

    Args:
        light: The reference light, so that an arm's errors do not change the exposure.
        camera: Where it is seen from.
        psf: How points are spread.

    Returns:
        The factor; 1 if nothing is lit on the picture, as any picture of nothing is black.
    """
    values, lengths = [np.empty(0)], [np.empty(0)]
    for emission in light if isinstance(light, Iterable) else (light,):
        for value, length in _metered(emission, camera, psf):
            values.append(value)
            lengths.append(length)
    ridge = _weighted_median(np.concatenate(values), np.concatenate(lengths))
    return CORE_EXPOSURE / ridge if ridge > 0.0 else 1.0


def _metered(
    emission: Emission, camera: Camera, psf: PointSpread
) -> Iterator[tuple[Floats, Floats]]:
    """Brightness (M,) of the parts of a light, each treated as a line, and their lengths (M,)."""
    piece = psf.line_peak / psf.point_peak
    if isinstance(emission, Sweep) and len(emission.emitters.positions) > 1:
        for steps in emission.steps(emission.chord_tolerance(camera)):
            yield _surface(emission, steps, camera, psf)
        return
    for light in emission.emission_to(camera):
        assert isinstance(light, Light)
        lower = _disc_share(light, camera, psf)
        for trail in project_light(light, camera, margin=0.0):
            for part in cut_into_bins(trail, piece):
                length = np.where(part.alone, piece, part.length)
                value = part.energy.max(axis=0) / length * psf.line_peak
                yield (value * lower if light.size else value), length


def _disc_share(light: Light, camera: Camera, psf: PointSpread) -> float:
    """Brightness of a line of discs relative to a line of points: wider, with a lower target."""
    _, depth = camera.project(light.lit_points)
    seen = depth[depth > NEAREST_DEPTH]
    if light.size == 0.0 or len(seen) == 0:
        return 1.0
    diameter = light.size * camera.focal / float(np.median(seen))
    width = math.hypot(1.0 / psf.line_peak, math.pi / 4.0 * diameter)  # its ridge by its chord
    return (
        CORE_EXPOSURE
        / float(_target_exposure(np.array(width * psf.line_peak)))
        / (width * psf.line_peak)
    )


def _target_exposure(widths: Floats) -> Floats:
    """Target exposure of strokes with the given widths, in line widths."""
    filled = np.clip((widths - 1.0) / (SURFACE_WIDTH - 1.0), 0.0, 1.0)
    return np.asarray(CORE_EXPOSURE ** (1.0 - filled) * SURFACE_EXPOSURE**filled)


def _surface(sweep: Sweep, steps: Steps, camera: Camera, psf: PointSpread) -> tuple[Floats, Floats]:
    """Brightness and length of the parts of a swept surface, each treated as a line."""
    e = sweep.emitters
    line = 1.0 / psf.line_peak  # width of a line [px]
    piece = psf.line_peak / psf.point_peak
    u = np.linspace(0.0, 1.0, METERED_PARTS + 1)
    first, last = e.extent
    across = first + u[:, None] * (last - first)
    pixels, depth = camera.project(
        sweep.base_positions(steps.position, steps.rotation, across).reshape(-1, 3)
    )
    pixels = np.where(depth > NEAREST_DEPTH, pixels.T, 0.0).T.reshape(-1, METERED_PARTS + 1, 2)
    seen = (depth > NEAREST_DEPTH).reshape(-1, METERED_PARTS + 1).all(axis=1)
    inside = np.all((pixels >= 0.0) & (pixels < [camera.width, camera.height]), axis=2)
    seen &= inside.any(axis=1)
    used = seen[1:] & seen[:-1] & steps.energy.any(axis=1)
    if not used.any():
        return np.empty(0), np.empty(0)

    middle = 0.5 * (pixels[:, 1:] + pixels[:, :-1])
    moved = np.diff(middle, axis=0)
    width = np.diff(0.5 * (pixels[1:] + pixels[:-1]), axis=1)
    length = np.sqrt((moved**2).sum(axis=2))
    area = np.abs(moved[..., 0] * width[..., 1] - moved[..., 1] * width[..., 0])
    if not e.straight:  # a bundle is as wide as it is from every side
        area = length * np.sqrt((width**2).sum(axis=2))
    shares = _shares(e.tints)[steps.row]  # (M, PARTS, 3)
    energy = (steps.energy[:, None, :] * shares).max(axis=2)
    given = steps.energy.max(axis=1, keepdims=True)

    walked = np.cumsum(length.max(axis=1))
    group = np.floor(walked / piece)[used]
    begins = np.flatnonzero(np.append(True, np.diff(group) > 0.0))
    length, area, energy, given = (
        np.add.reduceat(values[used], begins, axis=0) for values in (length, area, energy, given)
    )
    lit = energy > METERED_SHARE * given * (energy / given).max()
    path = np.maximum(length, piece)
    wide = area / path * METERED_PARTS  # of the whole brush, as seen [px]
    threads = np.inf if e.joined > 0.2 else len(e.positions)
    covered = np.clip(wide, line, max(line, min(threads * line, 1e9)))
    value = energy * METERED_PARTS / (path * covered)
    aim = _target_exposure(covered / line)
    return (value * CORE_EXPOSURE / aim)[lit], (path * covered / line / METERED_PARTS)[lit]


def _shares(tints: Floats) -> Floats:
    """Tints (R, K, 3) summed over equal parts of the line of lamps: (R, METERED_PARTS, 3)."""
    sums = np.concatenate([np.zeros((len(tints), 1, 3)), np.cumsum(tints, axis=1)], axis=1)
    at = np.linspace(0.0, tints.shape[1], METERED_PARTS + 1)
    below = np.minimum(at.astype(np.int64), tints.shape[1] - 1)
    part = (at - below)[None, :, None]
    return np.diff((1.0 - part) * sums[:, below] + part * sums[:, below + 1], axis=1)


def _weighted_median(values: Floats, weights: Floats) -> float:
    """The value with half of the weight at or below it; 0 for no values."""
    if len(values) == 0:
        return 0.0
    order = np.argsort(values, kind="stable")
    below = np.cumsum(weights[order])
    return float(values[order[np.searchsorted(below, 0.5 * below[-1])]])
