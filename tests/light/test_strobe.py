"""Flashing lamps against sums over fine time, and dashes where the clock puts them."""

import numpy as np
import pytest

from dqpaint import dq
from dqpaint.brushes import Emitters
from dqpaint.light.film.film import PAD, expose
from dqpaint.light.sources import strobe as gates
from dqpaint.light.sources.sweep import Sweep
from tests.support.film_scene import at_pixels, flat_camera

CAMERA = flat_camera(480, 120)
SPEED = 400.0  # px/s


def across(samples, period, colour=(1.0, 1.0, 1.0), **how):
    """A lamp that goes evenly from left to right; the tool does not turn."""
    x = 40.0 + SPEED * period * np.arange(samples)
    points = at_pixels(np.column_stack([x, np.full(samples, 60.0)]), CAMERA)
    pose = dq.pose_from(points, np.tile([1.0, 0, 0, 0], (samples, 1)))
    return Sweep(period, pose, np.tile(colour, (samples - 1, 1)), Emitters(), **how)


def columns(sweep, channel=0):
    return expose(sweep, CAMERA).planes[channel].sum(axis=0)[PAD:-PAD]


@pytest.mark.parametrize("frequency", [3.7, 10.0, 50.0])
@pytest.mark.parametrize("duty", [0.1, 0.5, 0.85])
@pytest.mark.parametrize("period", [0.001, 0.008, 0.25])
def test_a_strobe_leaves_dashes_where_its_clock_says(frequency, duty, period):
    """Against the integral of the gate over each column of the picture."""
    samples = round(1.0 / period) + 1
    strobe = np.tile([frequency, duty], (samples - 1, 1))
    sweep = across(samples, period, strobe=strobe)
    times = (np.arange(200_000) + 0.5) / 200_000 * sweep.time[-1]
    on = (times * frequency) % 1.0 < duty
    edges = (np.arange(0, 481) - 0.5 - 40.0) / SPEED
    truth = np.histogram(times, edges, weights=on * (sweep.time[-1] / 200_000))[0]
    film = expose(sweep, CAMERA)
    flashes = np.arange(0, np.ceil(sweep.time[-1] * frequency))
    exact = np.clip((flashes + duty) / frequency, 0, sweep.time[-1]) - flashes / frequency
    np.testing.assert_allclose(film.emitted, exact.sum(), rtol=1e-9)
    np.testing.assert_allclose(film.on_film + film.lost, film.emitted, rtol=1e-9)
    # each deposit is spread by a spline three pixels wide: compare running sums
    got = film.planes[0].sum(axis=0)[PAD:-PAD]
    difference = np.abs(np.cumsum(got) - np.cumsum(truth))
    assert difference.max() < 1.1 / SPEED


def test_how_a_path_is_sampled_does_not_move_a_flash():
    strobe = (23.0, 0.4)
    few, many = (columns(across(n + 1, 1.0 / n, strobe=np.tile(strobe, (n, 1)))) for n in (4, 1000))
    np.testing.assert_allclose(np.cumsum(few), np.cumsum(many), atol=2e-4)


def test_pulses_have_the_length_of_their_colour_channel_by_channel():
    colour = (0.8, 0.25, 0.0)
    sweep = across(251, 0.004, colour, pwm=20.0)
    film = expose(sweep, CAMERA)
    np.testing.assert_allclose(film.emitted, np.array(colour) * 1.0, rtol=1e-9)
    for channel, duty in enumerate(colour):
        got = film.planes[channel].sum(axis=0)[PAD:-PAD] * SPEED
        lit = (got > 0.5)[40:440]
        assert lit.mean() == pytest.approx(duty, abs=0.06)
        if 0 < duty < 1:
            assert np.count_nonzero(np.diff(lit.astype(int)) == 1) in (19, 20)
            assert got.max() == pytest.approx(1.0, abs=0.05)  # at full power, not at its mean


def test_fast_pulses_are_what_even_dimming_is():
    even, pulsed = (across(251, 0.004, (0.3, 0.7, 1.0), pwm=f) for f in (0.0, 20_000.0))
    a, b = (expose(sweep, CAMERA).planes for sweep in (even, pulsed))
    assert np.abs(a - b).max() < 0.01 * a.max()


def test_brighter_than_full_is_full_all_the_time():
    sweep = across(101, 0.01, (3.0, 1.0, 0.5), pwm=50.0)
    np.testing.assert_allclose(expose(sweep, CAMERA).emitted, [3.0, 1.0, 0.5], rtol=1e-9)


def test_a_strobe_shuts_the_pulses_off_with_the_lamp():
    strobe = np.tile([5.0, 0.5], (100, 1))
    sweep = across(101, 0.01, (0.5, 1.0, 0.25), pwm=500.0, strobe=strobe)
    np.testing.assert_allclose(expose(sweep, CAMERA).emitted, [0.25, 0.5, 0.125], rtol=1e-9)


def test_dark_strokes_stay_dark_and_steady_ones_steady():
    strobe = np.zeros((100, 2))
    strobe[50:] = [10.0, 0.5]
    sweep = across(101, 0.01, strobe=strobe)
    got = columns(sweep) * SPEED
    np.testing.assert_allclose(got[45:235], 1.0, rtol=1e-6)
    assert (got[245:435] < 0.1).sum() > 60
    dark = Sweep(0.01, sweep.pose, np.zeros((100, 3)), Emitters(), strobe, 100.0)
    assert not expose(dark, CAMERA).emitted.any()


def test_crossings_are_found_once_each():
    rng = np.random.default_rng(2)
    ends = np.cumsum(rng.uniform(0, 3, 200))
    step, part = gates.integer_crossings(ends[:-1], ends[1:])
    values = ends[step] + part * np.diff(ends)[step]
    np.testing.assert_allclose(np.sort(values), np.arange(np.ceil(ends[0]), ends[-1]), atol=1e-9)
