"""Piecewise curves -> positions and derivatives over the fraction of the whole length.

A curve has no parameter of its own that could be slow or fast somewhere, so the point runs evenly:
speed over the fraction is the length of the curve, everywhere. Each piece is integrated by
Gauss-Legendre quadrature on panels that are halved until halving changes nothing, which also
closes in on the tip of a cusp; from a length back to the piece's parameter leads Newton's method,
kept within a bracket.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from dqpaint.dq import Floats
from dqpaint.program import (
    Indices,
    PiecewiseCurve,
    concatenate,
    derivatives,
    is_nonuniform,
    parameters_at,
    stretch_lengths,
)

HALVING_TOLERANCE = 1e-14  # of the length of the curve: what halving a panel may change
MOST_HALVINGS = 30
REST_SPEED = 1e-6  # share of a piece's mean speed: below it the piece is at rest
REST_OFFSET = 1e-4  # of the way to the middle of a piece: where a direction is taken instead


def piecewise_positions(paths: Sequence[PiecewiseCurve]) -> "Pieces":
    """The positions of piecewise curves over the fraction of their length."""
    whole, first, _ = concatenate(paths)
    curve = np.repeat(np.arange(len(paths)), np.diff(np.append(first, len(whole.cubic))))
    return Pieces(whole, _measure(whole, curve), np.arange(len(paths)))


@dataclass(frozen=True)
class Pieces:
    """Position and derivatives over the fraction of the length, by the chain rule.

    With s the length and p(g) a piece: ds/dg = |p'|, and the inverse's derivatives are
    g1 = 1 / |p'|, g2 = -(p'.p'') g1^4, g3 = -(p''.p'' + p'.p''') g1^5 + 4 (p'.p'')^2 g1^7.
    Beyond its ends a curve goes on straight.

    Attributes:
        path: the pieces of all curves.
        panels: their lengths.
        curve: which of the curves each row is.
    """

    path: PiecewiseCurve
    panels: "_Panels"
    curve: Indices
    uniform: ClassVar[bool] = True

    def select(self, rows: Indices | int) -> Self:
        """The same pieces with other rows."""
        return replace(self, curve=np.asarray(self.curve[rows]))

    @property
    def lengths(self) -> Floats:
        """The length of each row (N,) [m]."""
        return self.panels.total[self.curve]

    def panels_of_rows(self) -> tuple[Indices, Indices]:
        """The rows (Q,) of its panels in order, and which panels they are (Q,)."""
        first, last = self.panels.first[self.curve], self.panels.last[self.curve]
        count = last - first + 1
        row = np.repeat(np.arange(len(count)), count)
        return row, np.arange(len(row)) + (first - np.cumsum(count) + count)[row]

    def by_length(self, piece: Indices, g: Floats) -> Floats:
        """Positions (4, N, 3) and derivatives over the length [m] of pieces (N,) at g (N,)."""
        return _by_length(self.path, piece, g, self.panels.mean_speed[piece])

    def lengths_between(self, piece: Indices, lower: Floats, upper: Floats) -> Floats:
        """The lengths (N,) [m] of pieces (N,) between two parameters (N,)."""
        return stretch_lengths(self.path, self.panels.bent, piece, lower, upper)

    def largest_parameter(self) -> Floats:
        """Infinite: its values have no bound."""
        return np.full(1, np.inf)

    def point(self, f: Floats) -> Floats:
        """The position."""
        return np.asarray(self(f)[0])

    def velocity(self, f: Floats) -> Floats:
        """The first derivative."""
        return np.asarray(self(f)[1])

    def __call__(self, f: Floats) -> Floats:
        """The position and its derivatives."""
        panels = self.panels
        curve = np.broadcast_to(self.curve, f.shape)
        total = panels.total[curve]
        distance = f * total
        inside = np.clip(distance, 0.0, total)
        piece, g = _parameter(self.path, panels, curve, inside)
        out = self.by_length(piece, g)
        beyond = distance - inside
        out[0] += beyond[:, None] * out[1]
        out[2:, beyond != 0] = 0.0
        for order in (1, 2, 3):
            out[order] *= total[:, None] ** order
        return out


def _by_length(path: PiecewiseCurve, piece: Indices, g: Floats, mean_speed: Floats) -> Floats:
    """Position and derivatives over the length (4, N, 3).

    Where a piece's formula stands still, as at the end of a Bezier curve whose handle has no
    length, the direction is the one next to it; the curvature may have no bound there and is left
    out, as the jump of the direction is at a vertex.
    """
    p = derivatives(path, piece, g)
    rest = np.linalg.norm(p[1], axis=1) <= REST_SPEED * mean_speed
    if rest.any():
        beside = g[rest] + REST_OFFSET * (0.5 - g[rest])
        p[1, rest] = derivatives(path, piece[rest], beside)[1]
        p[2:, rest] = 0.0
    g1 = 1.0 / np.linalg.norm(p[1], axis=1)[:, None]
    p12 = (p[1] * p[2]).sum(1)[:, None]
    p22_13 = (p[2] ** 2 + p[1] * p[3]).sum(1)[:, None]
    g2 = -p12 * g1**4
    g3 = -p22_13 * g1**5 + 4.0 * p12**2 * g1**7
    first, second = p[1] * g1, p[2] * g1**2 + p[1] * g2
    third = p[3] * g1**3 + 3.0 * p[2] * g1 * g2 + p[1] * g3
    return np.stack([p[0], first, second, third])


@dataclass(frozen=True)
class _Panels:
    """Consecutive stretches of pieces.

    Attributes:
        piece: the piece of each (P,).
        lower: its parameter where the panel begins (P,).
        upper: and where it ends (P,).
        begin: from the start of its curve to where each begins [m] (P,).
        end: and to where it ends [m] (P,).
        first: of each curve (K,).
        last: of each curve (K,).
        before: all curves before each, end to end [m] (K,).
        total: the length of each curve [m] (K,).
        mean_speed: of each piece (M,): its length [m].
        bent: whether it does not run at one speed (M,).
    """

    piece: Indices
    lower: Floats
    upper: Floats
    begin: Floats
    end: Floats
    first: Indices
    last: Indices
    before: Floats
    total: Floats
    mean_speed: Floats
    bent: NDArray[np.bool_]

    def at(self, curve: Indices, distance: Floats) -> Indices:
        """The panels at distances (N,) along curves (N,); at a joint the following panel."""
        every = self.before[np.repeat(np.arange(len(self.first)), self.last - self.first + 1)]
        near = np.searchsorted(every + self.begin, self.before[curve] + distance, side="right") - 1
        first, last = self.first[curve], self.last[curve]
        panel = np.clip(near, first, last)
        # all curves in a row have more digits before the point than one by itself
        panel = np.clip(panel - (distance < self.begin[panel]), first, last)
        return np.clip(panel + (distance >= self.end[panel]), first, last)


def _measure(path: PiecewiseCurve, curve: Indices) -> _Panels:
    """The panels of pieces, each of a curve (M,)."""
    bent = is_nonuniform(path)
    piece = np.arange(len(path.cubic))
    lower, upper = np.zeros(len(piece)), np.ones(len(piece))
    size = stretch_lengths(path, bent, piece, lower, upper)
    close = HALVING_TOLERANCE * np.bincount(curve, weights=size)
    done: list[tuple[Indices, Floats, Floats, Floats]] = []
    for halving in range(MOST_HALVINGS):
        middle = 0.5 * (lower + upper)
        first = stretch_lengths(path, bent, piece, lower, middle)
        second = stretch_lengths(path, bent, piece, middle, upper)
        good = np.abs(first + second - size) <= close[curve[piece]]
        good |= halving == MOST_HALVINGS - 1
        done.append((piece[good], lower[good], upper[good], (first + second)[good]))
        left = ~good
        piece = np.concatenate([piece[left], piece[left]])
        lower, upper = (
            np.concatenate([lower[left], middle[left]]),
            np.concatenate([middle[left], upper[left]]),
        )
        size = np.concatenate([first[left], second[left]])
        if not left.any():
            break
    piece, lower, upper, size = (np.concatenate(part) for part in zip(*done, strict=True))
    order = np.lexsort((lower, piece))
    piece, lower, upper, size = piece[order], lower[order], upper[order], size[order]
    starts = np.searchsorted(curve[piece], np.arange(curve[-1] + 2))
    end = np.concatenate([np.cumsum(own) for own in np.split(size, starts[1:-1])])
    begin = np.concatenate([[0.0], end[:-1]])
    begin[starts[:-1]] = 0.0
    total = end[starts[1:] - 1]
    mean_speed = np.bincount(piece, weights=size).astype(np.float64)
    return _Panels(
        *(piece, lower, upper, begin, end, starts[:-1], starts[1:] - 1),
        *(np.cumsum(total) - total, total, mean_speed, bent),
    )


def _parameter(
    path: PiecewiseCurve, panels: _Panels, curve: Indices, distance: Floats
) -> tuple[Indices, Floats]:
    """The piece (N,) and its parameter (N,) at distances (N,) along curves (N,).

    At a joint it is the piece that begins there.
    """
    panel = panels.at(curve, distance)
    piece, lower, upper = panels.piece[panel], panels.lower[panel], panels.upper[panel]
    wanted = distance - panels.begin[panel]
    size = panels.end[panel] - panels.begin[panel]
    g = np.clip(lower + (upper - lower) * wanted / size, lower, upper)
    return piece, parameters_at(path, panels.bent, piece, (lower, upper), g, wanted)
