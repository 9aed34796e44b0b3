"""Slowness of a drawing's clock -> retimed samples, so that an arm's limits hold.

The slowness dt/ds is at least 1 and linear from sample to sample of the planned motion, s being the
drawing's own time. Then t(s) is known in closed form, and so are s(t) and its derivatives

    s_dot = 1 / slowness,    s_ddot = - (d slowness / ds) / slowness^3

by which pose, twist and acceleration are re-timed: xi -> s_dot xi, xi_dot -> s_dot^2 xi_dot +
s_ddot xi.
"""

import math
from dataclasses import dataclass

import numpy as np

from dqpaint.dq import Floats

AHEAD = 0.2  # [s] of the drawing's time: how early it slows down, and speeds up again


@dataclass(frozen=True)
class Ticks:
    """The samples of one stroke.

    Attributes:
        tau: fractions (M,) of the stroke's own time, from 0 to 1.
        rate: s_dot (M,); None without retiming.
        slope: s_ddot (M,) [1/s], likewise.
    """

    tau: Floats
    rate: Floats | None = None
    slope: Floats | None = None

    @property
    def count(self) -> int:
        """The new samples of the stroke."""
        return len(self.tau) - 1

    @property
    def end_rates(self) -> tuple[float, float]:
        """s_dot at the first and at the last sample."""
        return (1.0, 1.0) if self.rate is None else (float(self.rate[0]), float(self.rate[-1]))


@dataclass(frozen=True)
class TimeScaling:
    """The slowness of the clock.

    Attributes:
        slowness: dt/ds (N,) at the samples of the planned motion, 1 or more.
        period: between these samples, and between those that come out [s].
    """

    slowness: Floats
    period: float

    def ticks(self, first: int, count: int) -> Ticks:
        """The samples of a stroke of `count` periods from sample `first` on.

        Its end is a sample, as every corner is: what that takes is spread smoothly over the stroke.
        """
        slow = self.slowness[first : first + count + 1]
        if (slow == 1).all():
            return Ticks(np.arange(count + 1) / count)
        wanted = 0.5 * (slow[1:] + slow[:-1]).sum()  # periods
        whole = math.ceil(wanted - 1e-9)
        place = np.arange(count + 1) / count
        bump = 1 - np.cos(2 * np.pi * place) if count > 1 else np.ones(2)
        slow = slow + (whole - wanted) / count * bump
        return self._sampled(slow, whole)

    def _sampled(self, slow: Floats, whole: int) -> Ticks:
        count = len(slow) - 1
        ends = np.concatenate([[0.0], np.cumsum(0.5 * (slow[1:] + slow[:-1]))])  # periods
        at = np.arange(whole + 1) * (ends[-1] / whole)
        before = np.clip(np.searchsorted(ends, at, side="right") - 1, 0, count - 1)
        rest, begin = at - ends[before], slow[before]
        grow = slow[before + 1] - begin  # a period
        way = 2 * rest / (begin + np.sqrt(np.maximum(begin**2 + 2 * grow * rest, 0.0)))
        now = begin + grow * way
        tau = np.clip((before + way) / count, 0.0, 1.0)
        tau[[0, -1]] = 0.0, 1.0
        return Ticks(tau, 1 / now, -grow / (now**3 * self.period))


def smooth(slowness: Floats, period: float) -> Floats:
    """A smooth slowness (N,), nowhere below the given one.

    The largest within `AHEAD` on either side, averaged by a Hann window as wide: each value that is
    averaged is at least the one in the middle.
    """
    reach = max(1, round(AHEAD / period))
    window = np.hanning(2 * reach + 3)[1:-1]
    largest = np.pad(_largest(slowness - 1, reach), len(window) // 2, mode="edge")
    return 1 + np.convolve(largest, window / window.sum(), mode="valid")


def _largest(values: Floats, reach: int) -> Floats:
    """The largest value within `reach` neighbours on either side of each value."""
    padded = np.pad(values, reach, mode="edge")
    return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1).max(axis=1))
