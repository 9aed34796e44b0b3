"""Sampled poses -> a smooth path between them, with corners where the samples have corners.

A fast lamp leaves chords between its samples. Place goes along a cubic whose tangents come from the
neighbouring samples, orientation along the short arc (slerp). Nothing is rounded where the way
turns sharply from one step to the next.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dqpaint.light.arrays import Floats

CORNER_COSINE = float(np.cos(np.radians(35.0)))
"""Cosine of the angle between two steps at which the path has a corner; no tangent crosses it."""
MOST_PARTS = 64
"""Largest number of parts of one step."""


def tangents(points: Floats) -> tuple[Floats, Floats]:
    """Unit tangents (N-1, 3) at the beginning and at the end of each step.

    Inside a smooth run it is the tangent of the parabola through three neighbours, over the length
    of the chords; at a corner, a stop or an end it is the chord's own direction.
    """
    way = np.diff(points, axis=0)
    length = np.sqrt((way * way).sum(axis=1))
    unit = way / np.where(length > 0.0, length, 1.0)[:, None]
    begin, end = unit.copy(), unit.copy()
    before, after = unit[:-1], unit[1:]
    smooth = (before * after).sum(axis=1) > CORNER_COSINE
    weight = length[:-1] / np.where(smooth, length[:-1] + length[1:], 1.0)
    mean = (1.0 - weight)[:, None] * before + weight[:, None] * after
    size = np.sqrt((mean * mean).sum(axis=1))
    mean /= np.where(size > 0.0, size, 1.0)[:, None]
    begin[1:][smooth] = mean[smooth]
    end[:-1][smooth] = mean[smooth]
    return begin, end


def chord_deviation(points: Floats, tangent: tuple[Floats, Floats]) -> Floats:
    """Deviation (N-1,) of the cubic from the chord in the middle of each step [m]."""
    way = np.diff(points, axis=0)
    length = np.sqrt((way * way).sum(axis=1))
    turn = tangent[0] - tangent[1]
    return np.asarray(length * np.sqrt((turn * turn).sum(axis=1)) / 8.0)


def rotation_deviation(rotation: Floats, reach: float) -> Floats:
    """Deviation (N-1,) from its chord of a lamp at `reach` from the tool, due to rotation [m]."""
    dot = np.abs((rotation[1:] * rotation[:-1]).sum(axis=1))
    angle = 2.0 * np.arccos(np.minimum(dot, 1.0))
    return np.asarray(reach * angle * angle / 8.0)


def part_counts(bulges: Floats, tolerance: float) -> NDArray[np.int64]:
    """The number (M,) of equal parts of each step that keeps deviations within `tolerance`."""
    count = np.ceil(np.sqrt(bulges / tolerance))
    return np.clip(count, 1, MOST_PARTS).astype(np.int64)


def position_at(
    points: Floats, tangent: tuple[Floats, Floats], step: NDArray[np.int64], part: Floats
) -> Floats:
    """Positions (M, 3) within steps, on a Hermite cubic with tangents as long as the chord."""
    p, q = points[step], points[step + 1]
    way = q - p
    length = np.sqrt((way * way).sum(axis=1))[:, None]
    s = part[:, None]
    t = 1.0 - s
    straight = p + s * way
    leave = tangent[0][step] * length - way
    arrive = tangent[1][step] * length - way
    return np.asarray(straight + s * t * (t * leave - s * arrive))


def rotation_at(rotation: Floats, step: NDArray[np.int64], part: Floats) -> Floats:
    """Orientations (M, 4) within steps, at a constant rate the short way (Shoemake 1985)."""
    a, b = rotation[step], rotation[step + 1]
    dot = (a * b).sum(axis=1)
    b = np.where(dot[:, None] < 0.0, -b, b)
    angle = np.arccos(np.minimum(np.abs(dot), 1.0))
    small = angle < 1e-6
    size = np.where(small, 1.0, np.sin(angle))
    left = np.where(small, 1.0 - part, np.sin((1.0 - part) * angle) / size)
    right = np.where(small, part, np.sin(part * angle) / size)
    turned = left[:, None] * a + right[:, None] * b
    return np.asarray(turned / np.sqrt((turned * turned).sum(axis=1))[:, None])
