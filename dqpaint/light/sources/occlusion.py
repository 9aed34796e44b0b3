"""A sweep, an occluder and a camera -> the share of the light that reaches the camera."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from dqpaint.light.arrays import Floats

if TYPE_CHECKING:
    from dqpaint.light.sources.sweep import Sweep

SAMPLE_SPACING = 0.007
"""Largest distance between sampled positions along a brush: the spacing of a dense LED strip. With
a larger one, edges of shadow have scallops [m]."""


class Occluder(Protocol):
    """A moving body that may occlude a light."""

    def visible(self, time: Floats, places: Floats, lit: NDArray[np.bool_], eye: Floats) -> Floats:
        """The share (M, K) of the light at `places` (M, K, 3) that reaches an eye (3,), 0 to 1.

        Args:
            time: (M,) in order [s].
            places: Of the light then, base frame [m].
            lit: (M,) when there is any.
            eye: Of the camera [m].
        """
        ...


class Occlusion:
    """Shares of one sweep's light that reach one camera, and the balance of occluded light.

    It is computed once, for each step between two samples at some positions along the brush, and
    interpolated between them. So it does not depend on how steps are cut and batched.

    Args:
        period: From sample to sample [s].
        share: (N-1, P) in each step, at even distances from one end of the brush to the other.

    Attributes:
        emitted: (N-1, 3) light emitted so far, in the film's unit.
        hidden: (N-1, 3) the part of it that was occluded.
    """

    def __init__(self, period: float, share: Floats) -> None:
        self._period = period
        self._share = share
        self._whole: NDArray[np.bool_] = np.asarray((share >= 1.0).all(axis=1))
        self.emitted, self.hidden = np.zeros((len(share), 3)), np.zeros((len(share), 3))

    @property
    def share(self) -> Floats:
        """The shares (N-1, P) as given."""
        return self._share

    def attenuate_lamps(self, time: Floats, energy: Floats) -> Floats:
        """Attenuate and count the energy (M, K, 3) of lamps on a line, or of lamps close together.

        Args:
            time: (M+1,) at which the steps begin and end [s].
            energy: (M, K, 3) of each lamp.
        """
        of = self._samples(time)
        seen = energy * self._along(of, energy.shape[1])[..., None]
        self._count(of, energy.sum(axis=1), seen.sum(axis=1))
        return np.asarray(seen)

    def attenuate_line(
        self, time: Floats, energy: Floats, tints: Floats, row: NDArray[np.int64]
    ) -> tuple[Floats, NDArray[np.int64]]:
        """Tints and rows of a partly occluded line; its energy is counted.

        Args:
            time: (M+1,) at which the steps begin and end [s].
            energy: (M, 3) of each step.
            tints: (R, C, 3) share of it in each of C equal parts of the line.
            row: (M,) which of them holds.

        Returns:
            Tints (R', C', 3) and rows (M,): a step with something hidden has a row of its own.
        """
        of = self._samples(time)
        dim = np.flatnonzero(~self._whole[of])
        finer = -(-self._share.shape[1] // tints.shape[1])
        parts = np.repeat(tints, finer, axis=1) / finer
        own = parts[row[dim]] * self._along(of[dim], parts.shape[1])[..., None]
        seen = parts.sum(axis=1)[row]
        sent = energy * seen
        seen[dim] = own.sum(axis=1)
        self._count(of, sent, energy * seen)
        rows = row.copy()
        rows[dim] = len(parts) + np.arange(len(dim))
        return np.concatenate([parts, own]), rows

    def _samples(self, time: Floats) -> NDArray[np.int64]:
        """The step (M,) between samples that contains each step."""
        middle = 0.5 * (time[1:] + time[:-1])
        return np.clip((middle / self._period).astype(np.int64), 0, len(self._share) - 1)

    def _along(self, of: NDArray[np.int64], count: int) -> Floats:
        """Shares (M, count) at the middles of `count` equal parts of the brush."""
        known = self._share.shape[1]
        if known == 1:
            return np.broadcast_to(self._share[of], (len(of), count))
        at = (np.arange(count) + 0.5) / count * (known - 1)
        below = np.minimum(at.astype(np.int64), known - 2)
        part = at - below
        share = self._share[of]
        return np.asarray((1.0 - part) * share[:, below] + part * share[:, below + 1])

    def _count(self, of: NDArray[np.int64], sent: Floats, seen: Floats) -> None:
        np.add.at(self.emitted, of, sent)
        np.add.at(self.hidden, of, sent - seen)


def occlusion_by(sweep: Sweep, body: Occluder, eye: Floats) -> Occlusion:
    """The occlusion of a sweep by a body for an eye (3,), computed once."""
    local = sweep.emitters.positions_along(SAMPLE_SPACING)
    places = sweep.base_positions(sweep.positions, sweep.rotations, local)
    middle = 0.5 * (places[1:] + places[:-1])
    time = sweep.time[:-1] + 0.5 * sweep.period
    lit = np.asarray(sweep.colours.any(axis=1))
    return Occlusion(sweep.period, body.visible(time, middle, lit, eye))
