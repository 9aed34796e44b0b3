"""SVG shapes -> piecewise curves of a whole drawing, computed at once.

A drawing may have a hundred thousand pieces: each is read with plain arithmetic, and arrays are
made of all of them together. The data of paths come as `svgvalues.path` reads them.
"""

import math
from array import array
from collections.abc import Iterator, Sequence

import numpy as np

from dqpaint.language.imports.svg.values import COUNTS, Commands
from dqpaint.program import Floats, PiecewiseCurve, piecewise

NO_LENGTH = 1e-12  # of the coordinates: what is smaller is no piece
STRAIGHT = 1e-8  # chord of an arc, in diameters: it bends by half of that
ARC = 8  # numbers: centre, u, v, start, turn; of lines and curves 2 for each of 2 to 4 points

Spot = tuple[float, float]


class Pieces:
    """The pieces of all lines, each in the coordinates of its shape."""

    def __init__(self) -> None:
        self._numbers = {count: array("d") for count in (4, 6, 8)}  # of lines and curves
        self._arcs = array("d")
        self._at: dict[int, list[int]] = {4: [], 6: [], 8: []}
        self._arcs_at: list[int] = []
        self._size = 0
        self._starts: list[int] = []  # the first piece of each line
        self._shapes: list[int] = []  # and its shape
        self._shape, self._lifted = -1, True
        self.at: Spot = (0.0, 0.0)

    def begin(self) -> None:
        """A new shape; they are numbered from 0."""
        self._shape += 1
        self.move((0.0, 0.0))

    def move(self, to: Spot) -> None:
        """Moves the pen without drawing."""
        self.at, self._lifted = to, True

    def curve(self, *points: Spot) -> None:
        """A straight line to one point, or a Bezier curve by one or two handles and its end."""
        numbers = [*self.at, *(number for point in points for number in point)]
        self._at[len(numbers)].append(self._next())
        self._numbers[len(numbers)].extend(numbers)
        self.at = points[-1]

    def arc(self, centre: Spot, u: Spot, v: Spot, start: float, turn: float, end: Spot) -> None:
        """An arc as in `program.PiecewiseCurve`, to its end."""
        self._arcs_at.append(self._next())
        self._arcs.extend((*centre, *u, *v, start, turn))
        self.at = end

    def _next(self) -> int:
        """The number of a new piece."""
        if self._lifted:
            self._starts.append(self._size)
            self._shapes.append(self._shape)
            self._lifted = False
        self._size += 1
        return self._size - 1

    def lines(self, matrices: Floats, shifts: Floats) -> Iterator[tuple[int, PiecewiseCurve]]:
        """Each line under its shape's transform, with the number of the shape.

        Within a line each piece begins at the end of the one before; empty pieces are left out.

        Args:
            matrices: of all shapes (K, 3, 3).
            shifts: (K, 3).
        """
        whole, long = self._arrays()
        line = np.searchsorted(self._starts, np.arange(self._size), side="right") - 1
        shape = np.array(self._shapes, dtype=np.intp)[line]
        with np.errstate(over="ignore", invalid="ignore"):  # which is looked for afterwards
            turned = matrices[shape].transpose(0, 2, 1)
            cubic, ellipse = whole.cubic @ turned, whole.ellipse @ turned
            cubic[:, 0] += shifts[shape]
            long &= cubic[:, 1:].any(axis=(1, 2)) | ellipse.any(axis=(1, 2))
            if not long.any():
                return
            starts = np.flatnonzero(np.diff(line[long], prepend=-1))
            whole = PiecewiseCurve(cubic[long], ellipse[long], whole.angles[long])
            piecewise.link_pieces(whole, starts)
        yield from zip(shape[long][starts].tolist(), piecewise.split(whole, starts), strict=True)

    def _arrays(self) -> tuple[PiecewiseCurve, np.ndarray[tuple[int], np.dtype[np.bool_]]]:
        """All pieces in their shapes' coordinates, and whether they have a length."""
        cubic, ellipse = np.zeros((self._size, 4, 3)), np.zeros((self._size, 2, 3))
        angles, long = np.zeros((self._size, 2)), np.ones(self._size, dtype=bool)
        for count, numbers in self._numbers.items():
            at = np.array(self._at[count], dtype=np.intp)
            points = np.array(numbers).reshape(-1, count // 2, 2)
            size = np.abs(points - points[:, :1]).max(axis=(1, 2), initial=0.0)
            far = np.abs(points).max(axis=(1, 2), initial=1.0)
            long[at] = size > NO_LENGTH * far
            cubic[at, :, :2] = piecewise.coefficients(points)
        arcs = np.array(self._arcs).reshape(-1, ARC)
        cubic[self._arcs_at, 0, :2] = arcs[:, :2]
        ellipse[self._arcs_at, :, :2] = arcs[:, 2:6].reshape(-1, 2, 2)
        angles[self._arcs_at] = arcs[:, 6:]
        return PiecewiseCurve(cubic, ellipse, angles), long


# Shapes.


def draw_line(pieces: Pieces, *corners: Spot) -> None:
    """A polyline."""
    pieces.move(corners[0])
    for corner in corners[1:]:
        pieces.curve(corner)


def draw_ellipse(pieces: Pieces, centre: Spot, rx: float, ry: float) -> None:
    """A full ellipse that begins at its right, as in SVG."""
    start = centre[0] + rx, centre[1]
    pieces.move(start)
    pieces.arc(centre, (rx, 0.0), (0.0, ry), 0.0, math.tau, start)


def draw_rectangle(pieces: Pieces, x: float, y: float, size: Spot, rx: float, ry: float) -> None:
    """A rectangle, with rounded corners if rx > 0, that begins at its upper left, as in SVG."""
    right, low = x + size[0], y + size[1]
    if not (rx and ry):
        draw_line(pieces, (x, y), (right, y), (right, low), (x, low), (x, y))
        return
    rx, ry = min(rx, size[0] / 2), min(ry, size[1] / 2)
    pieces.move((x + rx, y))
    for corner, before, after in (
        ((right - rx, y + ry), (right - rx, y), (right, y + ry)),
        ((right - rx, low - ry), (right, low - ry), (right - rx, low)),
        ((x + rx, low - ry), (x + rx, low), (x, low - ry)),
        ((x + rx, y + ry), (x, y + ry), (x + rx, y)),
    ):
        pieces.curve(before)
        start = math.atan2((before[1] - corner[1]) / ry, (before[0] - corner[0]) / rx)
        pieces.arc(corner, (rx, 0.0), (0.0, ry), start, math.pi / 2, after)


def draw_path(pieces: Pieces, data: Commands) -> None:
    """A path from its commands and their numbers."""
    outline = _Outline(pieces)
    for letter, numbers in data:
        outline.follow(letter, numbers)


class _Outline:
    """Executes the commands of a path."""

    def __init__(self, pieces: Pieces) -> None:
        self._pieces = pieces
        self._first: Spot = (0.0, 0.0)  # of this line
        self._handle: Spot | None = None  # the last of the curve before
        self._handles = 0  # and how many it has

    def follow(self, letter: str, numbers: Sequence[float]) -> None:
        """Executes a command with numbers for one or more repetitions."""
        kind, pieces = letter.upper(), self._pieces
        if kind == "Z":
            pieces.curve(self._first)
            pieces.move(self._first)
            self._handle = None
            return
        count = COUNTS[kind.lower()]
        for begin in range(0, len(numbers), count):
            x, y = pieces.at if letter.islower() else (0.0, 0.0)
            own = numbers[begin : begin + count]
            if kind == "M" and not begin:
                self._first = x + own[0], y + own[1]
                pieces.move(self._first)
            elif kind == "A":
                _arc_to(pieces, own, (x + own[5], y + own[6]))
            elif kind == "H":
                pieces.curve((x + own[0], pieces.at[1]))
            elif kind == "V":
                pieces.curve((pieces.at[0], y + own[0]))
            else:
                self._points(
                    kind, [(x + a, y + b) for a, b in zip(own[::2], own[1::2], strict=True)]
                )
                continue
            self._handle = None

    def _points(self, kind: str, points: list[Spot]) -> None:
        """A line or a curve by points; S and T mirror the handle of a curve of their own kind."""
        if kind in "ST":
            (x, y), handle = self._pieces.at, self._handle
            if handle is None or len(points) != self._handles:
                handle = x, y
            points = [(2 * x - handle[0], 2 * y - handle[1]), *points]
        self._pieces.curve(*points)
        self._handle = points[-2] if len(points) > 1 else None
        self._handles = len(points) - 1


def _arc_to(pieces: Pieces, numbers: Sequence[float], end: Spot) -> None:
    """An arc by its end points; its centre by appendix B.2 of the SVG 2 specification."""
    rx, ry, turned, large, sweep, *_ = numbers
    (x0, y0), (x1, y1) = start, _ = pieces.at, end
    if start == end:
        return
    if not (rx and ry):
        pieces.curve(end)
        return
    rx, ry, angle = abs(rx), abs(ry), math.radians(turned)
    c, s = math.cos(angle), math.sin(angle)
    dx, dy = (x0 - x1) / 2, (y0 - y1) / 2
    # in units of the radii and along them, where the ellipse is a circle of radius 1
    half = (c * dx + s * dy) / rx, (c * dy - s * dx) / ry
    size = math.hypot(*half)
    if not size or (size < STRAIGHT and not large):
        pieces.curve(end)
        return
    if size > 1.0:  # radii that do not reach are made larger
        rx, ry, half, size = rx * size, ry * size, (half[0] / size, half[1] / size), 1.0
    root = math.sqrt((1.0 - size) * (1.0 + size))
    far = root / size * (-1 if large == sweep else 1)
    middle = far * half[1], -far * half[0]
    first = math.atan2(half[1] - middle[1], half[0] - middle[0])
    # by the chord, not between two directions, which are the same where it is short
    turn = 2.0 * math.atan2(size, root)
    turn = (math.tau - turn if large else turn) * (1 if sweep else -1)
    u, v = (rx * c, rx * s), (-ry * s, ry * c)
    centre = tuple(
        (a + b) / 2 + middle[0] * p + middle[1] * q
        for a, b, p, q in zip(start, end, u, v, strict=True)
    )
    pieces.arc((centre[0], centre[1]), u, v, first, turn, end)
