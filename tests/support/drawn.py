"""What the tests of the language share: an independent way to turn a vector."""

import numpy as np
from numpy.typing import NDArray

from dqpaint.language import Program, parse
from dqpaint.program.program import Segment


def matrix(q: tuple[float, ...]) -> NDArray[np.float64]:
    """The rotation matrix of a unit quaternion, by the textbook formula."""
    w, x, y, z = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def rotation(axis: tuple[float, ...], degrees: float) -> NDArray[np.float64]:
    """The rotation matrix by Rodrigues' formula."""
    n = np.array(axis) / np.linalg.norm(axis)
    a = np.radians(degrees)
    k = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return np.eye(3) + np.sin(a) * k + (1 - np.cos(a)) * k @ k


def drawn(text: str) -> Program:
    program = parse(text, "test.traj")
    at = program.start
    for segment in program.segments:  # a drawing has no gaps
        assert segment.start == at
        at = segment.end
    return program


def only(text: str) -> Segment:
    (segment,) = drawn(text).segments
    return segment


def last(text: str) -> Segment:
    return drawn(text).segments[-1]
