"""A wall before a camera, whose shadow is known in closed form."""

import numpy as np

EYE = np.array([0.0, 0.0, 1.0])


class Wall:
    """Stands at z = 1/2 from x = low to x = high, moved by the posture along x."""

    def __init__(self, low, high):
        self.low, self.high, self.at, self.stood = low, high, 0.0, []

    def each_posture(self, postures):
        for row, posture in enumerate(postures):
            self.at = posture[0]
            self.stood.append(posture[0])
            yield row

    def blocked(self, start, end):
        u = (0.5 - start[:, 2]) / (end[:, 2] - start[:, 2])
        x = start[:, 0] + u * (end[:, 0] - start[:, 0]) - self.at
        return (x > self.low) & (x < self.high)
