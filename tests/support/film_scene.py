"""A camera for which one millimetre of the plane z = 0 is one pixel, and light drawn in pixels."""

import numpy as np

from dqpaint.light.camera.camera import Camera
from dqpaint.light.sources.emission import Light

WIDTH, HEIGHT = 240, 180


def flat_camera(width=WIDTH, height=HEIGHT):
    centre = [(width - 1) / 2, (height - 1) / 2]
    return Camera([0, 0, 1], np.eye(3), 1000.0, centre, width, height)


def at_pixels(pixels, camera):
    """(N, 3) points seen at pixels (N, 2)."""
    offset = (np.asarray(pixels, float) - camera.centre) / camera.focal
    return np.column_stack([offset[:, 0], -offset[:, 1], np.zeros(len(offset))])


def drawn(pixels, energy, camera):
    return Light(at_pixels(pixels, camera), np.asarray(energy, float))


def line(a, b, density, camera, steps=1):
    """Light along a straight line of `density` per pixel."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    u = np.linspace(0, 1, steps + 1)[:, None]
    share = np.linalg.norm(b - a) / steps
    return drawn(a + u * (b - a), np.tile(np.multiply(density, share), (steps, 1)), camera)


def sampled(image, points, reach=8):
    """Values between pixels by a windowed sinc: what band-limited pixels stand for."""
    base = np.floor(points).astype(int)
    offsets = np.arange(1 - reach, reach + 1)
    weights = []
    for axis in (0, 1):
        t = (points[:, axis] - base[:, axis])[:, None] - offsets
        window = np.i0(9 * np.sqrt(np.clip(1 - (t / reach) ** 2, 0, 1)))
        w = np.sinc(t) * window
        weights.append(w / w.sum(axis=1, keepdims=True))
    patch = image[base[:, 1, None, None] + offsets[:, None], base[:, 0, None, None] + offsets]
    return np.einsum("nij,ni,nj->n", patch, weights[1], weights[0])
