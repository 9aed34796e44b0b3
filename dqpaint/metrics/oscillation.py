"""Deviation of a tool's velocity and what excites it -> the oscillation that nothing asked for.

A loop that oscillates shows a narrow line in the spectrum of the deviation from the reference: a
frequency at which the tool moves several times as much as the reference, unmodelled twists and
sensor noise together do, and which lasts. An answer to any of these is none, whatever its form: a
loop's gain from them to the deviation has a peak of 1 to 2 where it is well damped. Ringing after
a corner dies away and is none either.
"""

from dataclasses import dataclass

import numpy as np

from dqpaint.dq import Floats

AMPLIFIED = 4.0  # times what excites it, in amplitude: no loop that is damped does that
CONCENTRATED = 0.4  # share of the excess that lies in the band
PROMINENT = 5.0  # times the power about it, by width: a line, not the top of a hill
LEAST_CYCLES = 6  # of an oscillation in the judged rows
BAND, LEAST_BINS = 0.1, 2  # half the width of the band: part of its frequency, and at least
WIDER = 1.5  # the band in which the amplitude is followed, from f / 1.5 to 1.5 f
BLOCKS = 6  # in each of which the amplitude is taken
KEPT = 0.5  # of the amplitude, from one block to the next and from the first to the last
LEAST_ROWS = 48  # in which a line can be told from noise


@dataclass(frozen=True)
class Oscillation:
    """A sustained oscillation.

    Attributes:
        frequency: [Hz].
        speed: rms of its velocity [m/s] or [rad/s].
        row: where it is largest, among the judged rows.
    """

    frequency: float
    speed: float
    row: int

    @property
    def amplitude(self) -> float:
        """The amplitude of a sine of this frequency and speed [m] or [rad]."""
        return float(np.sqrt(2) * self.speed / (2 * np.pi * self.frequency))


def find_oscillation(
    deviation: Floats, excitation: Floats, period: float, least: float
) -> Oscillation | None:
    """The oscillation in a deviation of velocity, or None.

    Args:
        deviation: of the velocity from the reference (N, 3), in units of `least`.
        excitation: velocities (N, M) that may explain it: of reference, disturbance and sensors.
        period: from row to row [s].
        least: the rms speed of the smallest oscillation that counts.
    """
    rows = len(deviation)
    if rows < LEAST_ROWS:
        return None
    frequencies = np.fft.rfftfreq(rows, period)
    explained = np.convolve(_spectrum(excitation), np.ones(2 * LEAST_BINS + 1), "same")
    excess = np.maximum(_spectrum(deviation) - AMPLIFIED**2 * explained, 0.0)
    peak = LEAST_CYCLES + int(np.argmax(excess[LEAST_CYCLES:]))
    middle = float(frequencies[peak])
    width = max(BAND * middle, LEAST_BINS * float(frequencies[1]))
    inside = np.abs(frequencies - middle) <= 1.001 * width
    about = ~inside & (frequencies > middle / 2) & (frequencies < 2 * middle)
    power, beside = float(excess[inside].sum()), float(excess[about].mean())
    if power < max(least**2, CONCENTRATED * float(excess.sum()), PROMINENT * inside.sum() * beside):
        return None
    amplitude = _amplitude(deviation, period, middle)
    blocks = np.array(
        [float(np.sqrt((part**2).mean())) for part in np.array_split(amplitude, BLOCKS)]
    )
    if (blocks[1:] < KEPT * blocks[:-1]).any() or blocks[-1] < KEPT * blocks[0]:
        return None
    return Oscillation(middle, float(np.sqrt(power)), int(np.argmax(amplitude)))


def _spectrum(signal: Floats) -> Floats:
    """Mean square by frequency (F,) of signals (N, M), together; its sum is the variance."""
    window = np.hanning(len(signal))[:, None]
    found = np.fft.rfft((signal - signal.mean(axis=0)) * window, axis=0)
    power = 2 * (np.abs(found) ** 2).sum(axis=1) / (len(signal) * float((window**2).sum()))
    power[0] = 0.0
    return np.asarray(power)


def _amplitude(signal: Floats, period: float, frequency: float) -> Floats:
    """The size (N,) of the part of signals (N, M) about a frequency [Hz].

    They are reflected at their ends, or the end of one that grows would be seen at its beginning.
    """
    rows = len(signal)
    whole = np.pad(signal - signal.mean(axis=0), ((rows // 2, rows // 2), (0, 0)), "reflect")
    found = np.fft.rfft(whole, axis=0)
    frequencies = np.fft.rfftfreq(len(whole), period)
    found[(frequencies < frequency / WIDER) | (frequencies > WIDER * frequency)] = 0.0
    part = np.fft.irfft(found, len(whole), axis=0)[rows // 2 :][:rows]
    return np.asarray(np.linalg.norm(part, axis=1))
