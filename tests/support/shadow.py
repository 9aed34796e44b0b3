"""A wall before a camera, whose shadow is known in closed form."""

import numpy as np

EYE = np.array([0.0, 0.0, 1.0])


class Wall:
    """Stands at z = 1/2 from x = low to x = high, moved by the posture along x."""

    def __init__(self, low, high):
        self.low, self.high, self.stood = low, high, []

    def blocked(self, postures, start, end):
        self.stood += postures[:, 0].tolist()
        u = (0.5 - start[..., 2]) / (end[..., 2] - start[..., 2])
        x = start[..., 0] + u * (end[..., 0] - start[..., 0]) - postures[:, :1]
        return (x > self.low) & (x < self.high)
