"""Velocity profile, time -> progress along a path, with its first two derivatives.

A profile runs over the fraction tau in [0, 1] of a stroke's time and gives the fraction of its
path. `PEAK` is the largest rate d progress / d tau of a profile from rest to rest: a stroke of
length L that never exceeds a speed V takes PEAK L / V.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dqpaint.core import Registry
from dqpaint.dq import Floats


class Progress(NamedTuple):
    """The fraction of the path (N,), and its first and second derivative."""

    value: Floats
    rate: Floats
    slope: Floats


# Boundary rates and accelerations, in fractions of path per tau: one number each, or one a row.
Rates = tuple[float | Floats, ...]
ProfileFunction = Callable[[Floats, Rates], Progress]

PROFILES: Registry[ProfileFunction] = Registry("profile")
HALVINGS = 26  # of an interval that contains a stationary point of the rate
BACKWARDS = 1e-9  # a smaller backward rate is rounding noise of zero
RAMP = 0.2  # of a trapezoid's time, at each end


@PROFILES.add("constant")
def constant(tau: Floats, _rates: Rates = ()) -> Progress:
    """One speed throughout; corners are velocity jumps.

    Equation:
        s(tau) = tau, max s_dot = 1
    Idea:
        The stroke begins and ends at full speed: the line is equally bright, and no joint can
        follow the jumps.
    Try:
        dqpaint draw circle --colour-by speed
    """
    return Progress(tau, np.ones_like(tau), np.zeros_like(tau))


@PROFILES.add("trapezoid")
def trapezoid(tau: Floats, _rates: Rates = ()) -> Progress:
    """Constant acceleration over the first fifth of the time, braking over the last.

    Equation:
        s(tau) = tau^2 / (2 a (1 - a)), tau <= a
        s(tau) = (tau - a / 2) / (1 - a), a <= tau <= 1 - a
        s(tau) = 1 - s(1 - tau), tau >= 1 - a
        a = 1 / 5, max s_dot = 1 / (1 - a) = 1.25
    Idea:
        Up to speed, along at one speed, down again, from rest to rest. At the two inner
        breakpoints the acceleration is the one of the part that begins there.
    Try:
        dqpaint draw star --colour-by speed
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


@PROFILES.add("cubic")
def cubic(tau: Floats, rates: Rates = ()) -> Progress:
    """The polynomial of degree 3 with the given rates (v0, v1) at its ends.

    Equation:
        s(tau) = v_0 tau + (3 - 2 v_0 - v_1) tau^2 + (v_0 + v_1 - 2) tau^3
        v_0 = v_1 = 0: s = 3 tau^2 - 2 tau^3, max s_dot = 1.5
    Idea:
        The smoothest way, by the integral of the squared acceleration, between given velocities.
        The acceleration jumps at both ends.
    Try:
        dqpaint draw quarter-turn --controller accel --colour-by speed
    """
    return _polynomial(cubic_coefficients(rates), tau)


@PROFILES.add("quintic")
def quintic(tau: Floats, rates: Rates = ()) -> Progress:
    """The polynomial of degree 5 with the given rates and accelerations (v0, v1, a0, a1).

    Equation:
        s(tau) = v_0 tau + 1/2 a_0 tau^2 + c_3 tau^3 + c_4 tau^4 + c_5 tau^5
        c_3 = 10 - 6 v_0 - 4 v_1 - 1.5 a_0 + 1/2 a_1
        c_4 = -15 + 8 v_0 + 7 v_1 + 1.5 a_0 - a_1
        c_5 = 6 - 3 v_0 - 3 v_1 - 1/2 a_0 + 1/2 a_1
        "from rest to rest:" s = 10 tau^3 - 15 tau^4 + 6 tau^5, max s_dot = 1.875
    Idea:
        The least jerk, by the integral of its square. It begins and ends without a jump of the
        acceleration, and takes the longest for it.
    Try:
        echo "line to (80, 0) mm profile quintic" > q.traj
        dqpaint draw q.traj --colour-by acceleration
    """
    return _polynomial(quintic_coefficients(rates), tau)


def cubic_coefficients(rates: Rates) -> Rates:
    """Coefficients of 1, tau, ... tau^3: 0 at 0, 1 at 1, slopes v0 and v1."""
    v0, v1 = rates or (0.0, 0.0)
    return 0.0, v0, 3 - 2 * v0 - v1, v0 + v1 - 2


def quintic_coefficients(rates: Rates) -> Rates:
    """Coefficients of 1, tau, ... tau^5 that also meet second derivatives a0 and a1."""
    v0, v1, a0, a1 = rates or (0.0, 0.0, 0.0, 0.0)
    c3 = 10 - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1
    c4 = -15 + 8 * v0 + 7 * v1 + 1.5 * a0 - a1
    c5 = 6 - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1
    return 0.0, v0, 0.5 * a0, c3, c4, c5


def _polynomial(coefficients: Rates, tau: Floats) -> Progress:
    rate = derivative(coefficients)
    return Progress(*(horner(c, tau) for c in (coefficients, rate, derivative(rate))))


def derivative(coefficients: Rates) -> Rates:
    """The coefficients of a polynomial's derivative, from that of 1 on."""
    return tuple(power * c for power, c in enumerate(coefficients[1:], start=1))


def horner(coefficients: Rates, tau: Floats) -> Floats:
    """A polynomial's values (N,)."""
    value: Floats = coefficients[-1] + 0.0 * tau
    for c in reversed(coefficients[:-1]):
        value = c + value * tau
    return value


@PROFILES.add("smooth")
def smooth(tau: Floats, _rates: Rates = ()) -> Progress:
    """An S-curve within an acceleration of 2 m/s2 and a jerk of 20 m/s3, or what is given.

    Equation:
        s_dot <= v, abs(s_ddot) <= a, abs(d s_ddot / dt) <= j
        "where it cruises:" T = L / v + v / a + a / j, a^2 <= j v
        "on the spot:" s(tau) = 16/3 tau^3, tau <= 1/4
        s(tau) = 2 tau - 1/2 + s(1/2 - tau), 1/4 <= tau <= 1/2
        s(tau) = 1 - s(1 - tau), tau >= 1/2, max s_dot = 2
    Idea:
        Real arms refuse motion whose acceleration jumps. Here it grows with the jerk, stays, and
        goes down again. A stroke takes as long as its speed, acceleration and jerk need; a bend of
        radius r is taken at sqrt(a r) at the most, and where bends change the speed the
        acceleration is zero in between. A turn on the spot takes its time in four parts of equal
        jerk.
    Try:
        echo "line to (80, 0) mm profile smooth" > s.traj
        dqpaint draw s.traj --colour-by acceleration
    """
    first = tau < 0.5
    t = np.where(first, tau, 1.0 - tau)
    early, rest = t < 0.25, 0.5 - t
    value = np.where(early, 16 / 3 * t**3, 2 * t - 0.5 + 16 / 3 * rest**3)
    rate = np.where(early, 16 * t**2, 2 - 16 * rest**2)
    slope = np.where(early, 32 * t, 32 * rest)
    return Progress(np.where(first, value, 1.0 - value), rate, np.where(first, slope, -slope))


PEAK = {
    "constant": 1.0,
    "trapezoid": 1.0 / (1.0 - RAMP),
    "cubic": 1.5,
    "quintic": 1.875,
    "smooth": 2.0,
}


def peak_rate(name: str, rates: Rates) -> Floats:
    """The largest |d progress / d tau| with boundary rates; of many strokes, one a row (K,)."""
    if not rates:
        return np.array(PEAK[name])
    coefficients = cubic_coefficients(rates) if name == "cubic" else quintic_coefficients(rates)
    slope = derivative(coefficients)
    return np.asarray(np.abs(horner(slope, _stationary(slope))).max(axis=0))


def turns_back(name: str, rates: Rates) -> NDArray[np.bool_]:
    """Whether a profile with boundary rates reverses; of many, one a row (K,)."""
    if not rates:
        return np.zeros((), dtype=bool)
    coefficients = cubic_coefficients(rates) if name == "cubic" else quintic_coefficients(rates)
    slope = derivative(coefficients)
    return np.asarray(horner(slope, _stationary(slope)).min(axis=0) < -BACKWARDS)


def rate_at(name: str, rates: Rates, fraction: float) -> Floats:
    """The rate of a monotonic profile where its progress is `fraction`; of many (K,)."""
    lower = np.zeros(np.shape(rates[0]) if rates else ())
    upper = np.ones_like(lower)
    for _ in range(60):
        middle = 0.5 * (lower + upper)
        beyond = PROFILES[name](middle, rates).value > fraction
        lower, upper = np.where(beyond, lower, middle), np.where(beyond, middle, upper)
    return PROFILES[name](lower, rates).rate


def _stationary(slope: Rates) -> Floats:
    """0, 1, and the zeros of a polynomial's derivative between them (R, K).

    It has degree 1, or 3: then it goes one way from one of its turning points to the next, and
    bisection finds the zero, if there is one.
    """
    bend = derivative(slope)
    edges = np.stack(np.broadcast_arrays(0.0 * sum(bend), 1.0))
    if len(bend) == 2:
        return np.concatenate([edges, _inside(-bend[0], bend[1])[None]])
    c, b, a = derivative(bend)
    t = -0.5 * (b + np.copysign(np.sqrt(np.maximum(b**2 - 4 * a * c, 0.0)), b))
    edges = np.sort(np.stack([*edges, _inside(t, a), _inside(c, t)]), axis=0)
    lower, upper = edges[:-1], edges[1:]
    rising = horner(bend, upper) > horner(bend, lower)
    for _ in range(HALVINGS):
        middle = 0.5 * (lower + upper)
        beyond = (horner(bend, middle) > 0.0) == rising
        lower, upper = np.where(beyond, lower, middle), np.where(beyond, middle, upper)
    return np.concatenate([edges, lower])


def _inside(a: float | Floats, b: float | Floats) -> Floats:
    """Quotients a / b within 0 ... 1; any other is replaced by a bound."""
    a, b = np.broadcast_arrays(np.asarray(a, np.float64), b)
    return np.clip(np.divide(a, b, out=np.zeros(a.shape), where=b != 0.0), 0.0, 1.0)


def cruise_time(name: str, end_rates: Rates, least: Floats) -> Floats:
    """The shortest times (K,) [s] in which a profile with boundary rates never exceeds its speed.

    `least` (K,) is the path over the cruising speed [s]; `end_rates` are fractions of path per
    second (v0, v1) and per second squared (a0, a1), each (K,). Not a number where no time is long
    enough: an end is faster than the cruising speed.
    """

    def too_fast(time: Floats) -> NDArray[np.bool_]:
        peak = peak_rate(name, scale_rates(end_rates, time))
        return np.asarray(peak > time / least * (1 + 1e-12))

    if not end_rates:
        return np.asarray(PEAK[name] * least)
    long = np.array(least, dtype=np.float64)
    while (still := too_fast(long) & (long <= 1e3 * least)).any():
        long[still] *= 1.25
    short = long / 1.25
    for _ in range(60):
        middle = 0.5 * (short + long)
        fast = too_fast(middle)
        short, long = np.where(fast, middle, short), np.where(fast, long, middle)
    return np.where(long > 1e3 * least, np.nan, long)


def scale_rates(end_rates: Rates, time: float | Floats) -> Rates:
    """Rates per second as rates per tau, for a stroke that takes `time` [s]."""
    v, a = end_rates[:2], end_rates[2:]
    return (*(x * time for x in v), *(x * time**2 for x in a))
