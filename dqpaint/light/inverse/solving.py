"""A wanted picture and the map of a path's energies -> the energies whose developed picture it is.

    min 1/2 sum |D(A w) - Y|^2,  0 <= w <= most

with A of `exposing` and D of `developing`. First Richardson and Lucy's iteration towards the light
F = D^-1(Y), which keeps its sign and is close after a few steps; then accelerated projected
gradients on the developed picture (Beck and Teboulle, FISTA, 2009) with a step for each energy
(separable quadratic surrogates, Erdogan and Fessler, 1999), and a restart where the cost would rise
(O'Donoghue and Candes, 2015).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from dqpaint.light.arrays import Floats
from dqpaint.light.inverse.developing import developed, light_for, own_slope, slope_back
from dqpaint.light.inverse.exposing import Exposing

WHITE = 0.9
"""Display light of the photograph's white: at 1 the film would have to be burnt out."""
FIRST_STEPS = 12
RENEWED = 10
"""Iterations after which the size of the steps is worked out again."""
SETTLED = 2e-4
"""Relative fall of the cost over `RENEWED` iterations at which it ends."""
MOST_STEPS = 150
HALVINGS = 12
LEAST_RENEWED = 0.3
"""Share of its size that a renewed step may fall to at once."""


@dataclass(frozen=True, eq=False)
class Solution:
    """Energies and how they were found.

    Attributes:
        energy: (K, 3) of each step, in exposures: 1 on a pixel saturates it.
        costs: after each iteration, never rising.
        picture: (H, W, 3) what they develop to, sRGB from 0 to 1.
    """

    energy: Floats
    costs: tuple[float, ...]
    picture: Floats


def solve(
    exposing: Exposing,
    picture: Floats,
    first: Floats,
    most: Floats,
    colour: Floats | None = None,
    background: Floats | None = None,
    progress: Callable[[float], None] = lambda _done: None,
    steps: int = MOST_STEPS,
) -> Solution:
    """The energies along a path whose developed picture is nearest to `picture`.

    Args:
        exposing: of the path's K steps.
        picture: (H, W, 3) sRGB from 0 to 1.
        first: (K,) energies to begin with, in any unit; steps with 0 stay dark.
        most: (K,) the largest energy of each step, in exposures.
        colour: (3,) of the lamp, if it can only be dimmed; None: three lamps.
        background: (H, W, 3) light that is there already, in exposures.
        progress: called with the share done, 0 to 1.
        steps: at most.
    """
    kind = exposing.dtype
    target = light_for(picture.astype(kind), WHITE).astype(kind)
    problem = _Problem(exposing, developed(target)[0], colour, background, kind)
    bound = np.repeat(most[:, None], problem.lamps, axis=1).astype(kind)
    w = problem.start(target, first.astype(kind), bound)
    for _ in range(FIRST_STEPS):
        w = problem.richardson_lucy(w, target, bound)
    at = problem.at(w)
    costs, ahead, scale = [at.cost], 1.0, problem.scale(at)
    for step in range(steps):
        if step and step % RENEWED == 0:
            if costs[-RENEWED - 1] - costs[-1] < SETTLED * costs[-1]:
                break
            scale = np.maximum(problem.scale(at), LEAST_RENEWED * scale)
        new = np.clip(at.energy - at.slope / scale, 0.0, bound)
        longer = 0.5 * (1.0 + np.sqrt(1.0 + 4.0 * ahead * ahead))
        there = problem.at(np.clip(new + (ahead - 1.0) / longer * (new - w), 0.0, bound))
        if there.cost > at.cost:
            longer = 1.0
            there, scale = problem.careful(at, scale, bound)
            new = there.energy
        w, at, ahead = new, there, longer
        costs.append(at.cost)
        progress((step + 1) / steps)
    progress(1.0)
    return Solution(problem.energy(at.energy), tuple(costs), at.picture)


@dataclass(frozen=True, eq=False)
class _At:
    """Lamp energies (K, L) with their cost, its slope, and what they develop to."""

    energy: Floats
    cost: float
    slope: Floats
    picture: Floats
    slopes: tuple[Floats, Floats]


@dataclass(frozen=True, eq=False)
class _Problem:
    """The cost of lamp energies (K, L), its gradient and the steps that suit it."""

    exposing: Exposing
    aim: Floats
    colour: Floats | None
    background: Floats | None
    kind: type[np.floating]

    @property
    def lamps(self) -> int:
        return 3 if self.colour is None else 1

    def energy(self, w: Floats) -> Floats:
        """The energies (K, 3) in red, green and blue."""
        return w if self.colour is None else w * self.colour.astype(w.dtype)

    def exposed(self, w: Floats) -> Floats:
        """The light (H, W, 3) of the lamps; of one colour, one channel is spread, then coloured."""
        light = self.exposing.expose(w)
        return light if self.colour is None else light * self.colour.astype(light.dtype)

    def back(self, image: Floats) -> Floats:
        """The transpose of `exposed`: what an image (H, W, 3) means for each lamp energy (K, L)."""
        if self.colour is not None:
            image = (image @ self.colour.astype(image.dtype))[..., None]
        return self.exposing.back(image)

    def light(self, w: Floats) -> Floats:
        light = self.exposed(w)
        return light if self.background is None else light + self.background.astype(light.dtype)

    def start(self, target: Floats, first: Floats, bound: Floats) -> Floats:
        """Energies in proportion to the light wanted at their places, at the best scale."""
        near = self.back(target) / np.maximum(self.back(np.ones_like(target)), 1e-12)
        w = near * first[:, None]
        light = self.exposed(w)
        scale = float((light * target).sum()) / max(float((light * light).sum()), 1e-30)
        return np.minimum(np.maximum(w * self.kind(scale), 0.0), bound)

    def richardson_lucy(self, w: Floats, target: Floats, bound: Floats) -> Floats:
        ratio = target / np.maximum(self.light(w), 1e-6)
        one = self.back(np.ones_like(target))
        factor = self.back(ratio) / np.maximum(one, 1e-12)
        return np.minimum(w * np.clip(factor, 0.1, 10.0), bound)

    def at(self, w: Floats) -> _At:
        """The cost of energies and its slope."""
        picture, slopes = developed(self.light(w))
        error = picture - self.aim
        cost = 0.5 * float(np.vdot(error, error))
        slope = self.back(slope_back(slopes, error))
        return _At(w, cost, slope, picture, slopes)

    def scale(self, at: _At) -> Floats:
        """The curvature of each energy's surrogate: A' (W A 1)."""
        all_on = self.exposed(np.ones_like(at.energy))
        found = self.back(own_slope(at.slopes) * all_on)
        return np.maximum(found, 1e-3 * float(found.max()))

    def careful(self, at: _At, scale: Floats, bound: Floats) -> tuple[_At, Floats]:
        """A step along the gradient that does not raise the cost; none if there is no such step."""
        for _ in range(HALVINGS):
            there = self.at(np.clip(at.energy - at.slope / scale, 0.0, bound))
            if there.cost <= at.cost:
                return there, scale
            scale = 2.0 * scale
        return at, scale
