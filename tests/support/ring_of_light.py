"""A ring of light before the arm, and the camera that looks at both."""

import numpy as np

from dqpaint.light.camera.camera import View, frame_points


def ring(colour=(1.0, 0.2, 0.1), n=200):
    angle = np.linspace(0, 2 * np.pi, n + 1)
    points = np.stack([0.2 * np.cos(angle), np.full(n + 1, -0.3), 0.5 + 0.2 * np.sin(angle)], 1)
    return points, np.tile(np.array(colour) / n, (n, 1))


def seen(fill=0.3, size=(240, 180)):
    front = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    return frame_points(ring()[0], front, View(15, 20), size, fill)
