"""Surface points and lamps -> reflected light: a diffuse body under a coat of lacquer."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dqpaint.dq import Floats
from dqpaint.render.geometry_buffer import Numbers
from dqpaint.render.lamps import Lamps

COAT_REFLECTANCE = 0.04
"""Reflectance of the lacquer at normal incidence; Schlick's approximation gives the rest."""
BATCH, BATCH_LAMPS = 512, 128
"""Points in one batch with this many lamps, so that they fit the cache on every machine; with fewer
lamps a batch has more points."""
NEAREST_LAMP = 0.05
"""Below this distance a lamp gets no brighter, as it represents a length of path [m]."""
THREADS = 2


@dataclass(frozen=True, eq=False)
class Points:
    """Surface points as an eye sees them.

    Attributes:
        position: (P, 3) base frame [m].
        normal: (P, 3) unit.
        to_eye: (P, 3) unit, to the eye.
    """

    position: Numbers
    normal: Numbers
    to_eye: Numbers

    @cached_property
    def cosine_to_eye(self) -> Numbers:
        """Cosine (P,) of the angle between normal and eye, 0 to 1."""
        return np.asarray(np.clip((self.normal * self.to_eye).sum(axis=1), 0.0, 1.0), np.float32)

    @cached_property
    def mirrored_to_eye(self) -> Numbers:
        """The direction (P, 3) to the eye, mirrored about the normal."""
        return np.asarray(2.0 * self.cosine_to_eye[:, None] * self.normal - self.to_eye, np.float32)


def points_seen_from(eye: Floats, place: Numbers, normal: Numbers) -> Points:
    """Points (P, 3) with unit normals, as an eye (3,) sees them."""
    toward = eye.astype(np.float32) - place
    toward /= np.sqrt((toward * toward).sum(axis=1))[:, None]
    return Points(place, normal, toward)


def fresnel(facing: Numbers) -> Numbers:
    """Reflectance (P,) of the coat: F = F_0 + (1 - F_0) (1 - cos)^5 (Schlick 1994)."""
    return np.asarray(COAT_REFLECTANCE + (1.0 - COAT_REFLECTANCE) * (1.0 - facing) ** 5, np.float32)


def shade_by_lamps(points: Points, lamps: Lamps, sharpness: int) -> tuple[Numbers, Numbers]:
    """Diffuse and specular light of points, from lamps.

        dull   = 1/pi sum_k E_k max(n.l_k, 0) / d_k^2
        glossy = (m + 2) / 2 pi sum_k E_k max(r.l_k, 0)^m / d_k^2     (modified Phong)

    with l_k the unit vector to lamp k, d_k its distance, and r the way to the eye, mirrored.

    Args:
        points: P of them.
        lamps: K of them.
        sharpness: m, a power of two.

    Returns:
        (P, 3) each, to be multiplied by albedo and by what the coat reflects [lamp s / m^2].
    """
    dull = np.zeros((len(points.position), 3), np.float32)
    glossy = np.zeros_like(dull)
    mirrored = points.mirrored_to_eye
    at, energy = lamps.position.astype(np.float32), lamps.energy.astype(np.float32)
    batch = BATCH * max(1, BATCH_LAMPS // max(1, len(at)))

    def work(first: int) -> None:
        rows = slice(first, first + batch)
        place, normal = points.position[rows], points.normal[rows]
        inverse, cosine = _geometry(place, normal, at)
        lobe = np.maximum(_along(mirrored[rows], place, at), 0.0)
        lobe *= np.sqrt(inverse)
        for _ in range(sharpness.bit_length() - 1):
            lobe *= lobe
        lobe *= inverse
        lobe *= cosine > 0.0
        cosine *= inverse
        cosine *= np.sqrt(inverse)
        dull[rows], glossy[rows] = cosine @ energy, lobe @ energy

    with ThreadPoolExecutor(THREADS) as pool:  # each batch is by itself: order changes nothing
        list(pool.map(work, range(0, len(dull), batch)))
    dull /= np.float32(np.pi)
    glossy *= np.float32((sharpness + 2) / (2.0 * np.pi))
    return dull, glossy


def shade_by_direction(points: Points, way: Floats, sharpness: int) -> tuple[Numbers, Numbers]:
    """Diffuse max(n.l, 0) and specular max(r.l, 0)^m, (P, 1) each, from a distant lamp.

    Args:
        points: P of them.
        way: (3,) to the lamp, of any length.
        sharpness: m.
    """
    x, y, z = (way / np.linalg.norm(way)).astype(np.float32)
    cosines = (
        v[:, :1] * x + v[:, 1:2] * y + v[:, 2:] * z for v in (points.normal, points.mirrored_to_eye)
    )
    dull, lobe = (np.maximum(cosine, 0.0) for cosine in cosines)
    return dull, lobe**sharpness


def _along(vectors: Numbers, place: Numbers, at: Numbers) -> Numbers:
    """Dot products v . (p_k - x), (B, K)."""
    return np.asarray(vectors @ at.T - (vectors * place).sum(axis=1)[:, None])


def _geometry(place: Numbers, normal: Numbers, at: Numbers) -> tuple[Numbers, Numbers]:
    """1 / d^2 (B, K) with d at least `NEAREST_LAMP`, and d max(n.l, 0)."""
    squared = place @ (-2.0 * at.T)
    squared += (place * place).sum(axis=1)[:, None]
    squared += (at * at).sum(axis=1)
    np.maximum(squared, 0.0, out=squared)
    squared += np.float32(NEAREST_LAMP**2)
    cosine = _along(normal, place, at)
    return np.reciprocal(squared, out=squared), np.maximum(cosine, 0.0, out=cosine)
