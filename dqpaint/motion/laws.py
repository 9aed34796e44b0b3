"""Time laws: how far along its path a stroke is at a time, with the two derivatives.

A law runs over the fraction tau in [0, 1] of a stroke's time and gives the fraction of its path.
`PEAK` is the largest rate d progress / d tau of a law from rest to rest: a stroke of length L that
never exceeds a speed V takes PEAK L / V.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from dqpaint.dq import Floats
from dqpaint.registry import Registry


class Progress(NamedTuple):
    """The fraction of the path (N,), and its first and second derivative."""

    value: Floats
    rate: Floats
    slope: Floats


Rates = tuple[float, ...]  # boundary rates and accelerations, in fractions of path per tau
TimeLaw = Callable[[Floats, Rates], Progress]

LAWS: Registry[TimeLaw] = Registry("time law")
RAMP = 0.2  # of a trapezoid's time, at each end


@LAWS.add("constant")
def constant(tau: Floats, _rates: Rates = ()) -> Progress:
    """One speed throughout; corners are velocity jumps."""
    return Progress(tau, np.ones_like(tau), np.zeros_like(tau))


@LAWS.add("trapezoid")
def trapezoid(tau: Floats, _rates: Rates = ()) -> Progress:
    """Constant acceleration over the first fifth of the time, braking over the last.

    At the two inner breakpoints the acceleration is the one of the part that begins there.
    """
    peak = 1.0 / (1.0 - RAMP)
    gain = peak / RAMP
    left = 1.0 - tau
    start, end = tau < RAMP, tau >= 1.0 - RAMP
    value = np.where(start, 0.5 * gain * tau**2, peak * (tau - 0.5 * RAMP))
    value = np.where(end, 1.0 - 0.5 * gain * left**2, value)
    rate = np.where(start, gain * tau, np.where(end, gain * left, peak))
    slope = np.where(start, gain, np.where(end, -gain, 0.0))
    return Progress(value, rate, slope)


@LAWS.add("cubic")
def cubic(tau: Floats, rates: Rates = ()) -> Progress:
    """The polynomial of degree 3 with the given rates (v0, v1) at its ends."""
    return _polynomial(cubic_coefficients(rates), tau)


@LAWS.add("quintic")
def quintic(tau: Floats, rates: Rates = ()) -> Progress:
    """The polynomial of degree 5 with the given rates and accelerations (v0, v1, a0, a1)."""
    return _polynomial(quintic_coefficients(rates), tau)


def cubic_coefficients(rates: Rates) -> Floats:
    """Of 1, tau, ... tau^3: 0 at 0, 1 at 1, slopes v0 and v1."""
    v0, v1 = rates or (0.0, 0.0)
    return np.array([0.0, v0, 3 - 2 * v0 - v1, v0 + v1 - 2])


def quintic_coefficients(rates: Rates) -> Floats:
    """Of 1, tau, ... tau^5: 0 at 0, 1 at 1, slopes v0, v1 and second derivatives a0, a1."""
    v0, v1, a0, a1 = rates or (0.0, 0.0, 0.0, 0.0)
    c3 = 10 - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1
    c4 = -15 + 8 * v0 + 7 * v1 + 1.5 * a0 - a1
    c5 = 6 - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1
    return np.array([0.0, v0, 0.5 * a0, c3, c4, c5])


def _polynomial(coefficients: Floats, tau: Floats) -> Progress:
    p = np.polynomial.Polynomial(coefficients)
    return Progress(p(tau), p.deriv(1)(tau), p.deriv(2)(tau))


PEAK = {"constant": 1.0, "trapezoid": 1.0 / (1.0 - RAMP), "cubic": 1.5, "quintic": 1.875}


def peak_rate(name: str, rates: Rates) -> float:
    """The largest |d progress / d tau| of a law with boundary rates."""
    if not any(rates):
        return PEAK[name]
    coefficients = cubic_coefficients(rates) if name == "cubic" else quintic_coefficients(rates)
    slope = np.polynomial.Polynomial(coefficients).deriv()
    turning = slope.deriv().roots()
    inside = turning.real[(abs(turning.imag) < 1e-9) & (turning.real > 0) & (turning.real < 1)]
    return float(np.abs(slope(np.concatenate([[0.0, 1.0], inside]))).max())


def cruise_time(name: str, end_rates: Rates, least: float) -> float | None:
    """The shortest time [s] in which a law with boundary rates never exceeds the cruising speed.

    `least` is the path over the cruising speed [s]; `end_rates` are fractions of path per second
    (v0, v1) and per second squared (a0, a1). None where no time is long enough: an end is faster
    than the cruising speed.
    """

    def too_fast(time: float) -> bool:
        scaled = scale_rates(end_rates, time)
        return peak_rate(name, scaled) > time / least * (1 + 1e-12)

    if not any(end_rates):
        return PEAK[name] * least
    long = least
    while too_fast(long):
        long *= 1.25
        if long > 1e3 * least:
            return None
    short = long / 1.25
    for _ in range(60):
        middle = 0.5 * (short + long)
        short, long = (middle, long) if too_fast(middle) else (short, middle)
    return long


def scale_rates(end_rates: Rates, time: float) -> Rates:
    """Rates per second as rates per tau, for a stroke that takes `time` [s]."""
    v, a = end_rates[:2], end_rates[2:]
    return (*(x * time for x in v), *(x * time**2 for x in a))
