"""Strobe or PWM frequency and duty -> the exact times within steps at which a lamp switches.

A strobe shuts the whole lamp off for a part of each period. Pulse-width modulation (PWM) is how LED
drivers dim: each channel is fully on for the share of a period that equals its colour value. A lamp
that moves fast leaves dashes, and those of red, green and blue differ in length. Both run by the
clock of the run, and the time at which they switch is where a step is cut.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dqpaint.light.arrays import Floats

Cuts = tuple[NDArray[np.int64], Floats]
"""Steps and the positions within them, 0 to 1, of the cuts."""


def most_cuts(period: float, frequency: Floats) -> NDArray[np.int64]:
    """Largest number of cuts in each step (M,) of one period, for budgets."""
    span = period * frequency
    return np.where(span > 0.0, 2.0 * np.ceil(span) + 2.0, 0.0).astype(np.int64)


def switch_cuts(begin: Floats, end: Floats, frequency: Floats, duty: Floats) -> Cuts:
    """The positions within steps at which a strobe switches.

    It is on from m / f until (m + duty) / f for every whole m.

    Args:
        begin: (M,) time at which each step begins [s].
        end: (M,) and ends.
        frequency: (M,) of the gate during the step; 0 is steady [Hz].
        duty: (M,) part of a period it is on, 0 to 1.
    """
    flashing = (frequency > 0.0) & (duty > 0.0) & (duty < 1.0)
    rate = np.where(flashing, frequency, 0.0)
    on = integer_crossings(begin * rate, end * rate)
    off = integer_crossings(begin * rate - duty, end * rate - duty)
    return np.concatenate([on[0], off[0]]), np.concatenate([on[1], off[1]])


def integer_crossings(low: Floats, high: Floats) -> Cuts:
    """The positions at which values that rise evenly from low (M,) to high (M,) are integers."""
    first = np.floor(low).astype(np.int64) + 1
    last = np.ceil(high).astype(np.int64) - 1
    count = np.maximum(last - first + 1, 0)
    step = np.repeat(np.arange(len(low)), count)
    nth = np.arange(len(step)) - np.repeat(np.cumsum(count) - count, count)
    part = (first[step] + nth - low[step]) / (high - low)[step]
    inside = (part > 0.0) & (part < 1.0)
    return step[inside], part[inside]


def is_on(middle: Floats, frequency: Floats, duty: Floats) -> NDArray[np.bool_]:
    """Whether a strobe is on at the middle times of pieces (M,) that do not contain a switch.

    A steady one is always on.
    """
    phase = middle * frequency
    return np.asarray((frequency <= 0.0) | (phase - np.floor(phase) < duty))
