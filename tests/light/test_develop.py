import cv2
import numpy as np
import pytest

from dqpaint.errors import DqpaintError
from dqpaint.light.film.develop import LEAK, SPILL, TOE, develop


def ramp(colour, steps=2000):
    """(1, steps, 3) from 1e-6 to 1e4 in even stops."""
    return (np.logspace(-6, 4, steps)[None, :, None] * np.asarray(colour)).astype(np.float32)


def flat(value, shape=(64, 64)):
    return np.broadcast_to(np.float32(value), (*shape, 3)).copy()


def test_black_stays_black():
    assert not develop(np.zeros((100, 70, 3), np.float32), 5.0, 3.0).any()


def test_grey_follows_the_curve_to_half_a_level():
    """The mean over the dither is the level itself; for grey the leak changes nothing."""
    for value in (0.003, 0.03, 0.2, 0.8, 2.0):
        x = value + 2 * SPILL * (value - 1 + np.exp(-value))
        y = 1 - np.exp(-x)
        z = y * y * (1 + TOE) / (y + TOE)
        level = 255 * (12.92 * z if z <= 0.0031308 else 1.055 * z ** (1 / 2.4) - 0.055)
        mean = develop(flat(value), 1.0).mean(axis=(0, 1))
        np.testing.assert_allclose(mean + 1 / 512, level, atol=0.05)


@pytest.mark.parametrize("colour", [[1, 0, 0], [0, 0.3, 1], [1, 1, 1], [0.2, 1, 0.01]])
def test_more_light_is_never_darker(colour):
    image = np.tile(ramp(colour), (64, 1, 1))
    mean = develop(image, 1.0).astype(int)
    brighter = develop(image, 1.0, 0.1).astype(int)
    assert (brighter >= mean).all()
    along = develop(np.repeat(ramp(colour).transpose(1, 0, 2), 64, axis=0), 1.0)
    levels = along.reshape(-1, 64, 3).mean(axis=1)
    assert (np.diff(levels, axis=0) > -0.05).all()


@pytest.mark.parametrize("channel", [0, 1, 2])
def test_a_pure_colour_has_a_white_core_and_a_coloured_halo(channel):
    colour = np.eye(3)[channel]
    core, halo = (develop(flat(k * colour), 1.0).mean(axis=(0, 1)) for k in (40.0, 0.3))
    assert core.min() > 250
    others = np.delete(halo, channel)
    assert others.max() < 0.2 * halo[channel]
    at_twelve = develop(flat(12 * colour), 1.0).mean(axis=(0, 1))
    assert at_twelve.min() > 200


def test_what_leaks_is_taken_from_its_channel():
    faint = 1e-2 * np.eye(3, dtype=np.float32)[None, :, :]
    total = develop(np.tile(faint, (64, 64, 1)), 30.0).reshape(64, 64, 3, 3).mean(axis=(0, 1))
    np.testing.assert_allclose(total, total.T, atol=1.0)
    assert 0 < LEAK < 0.05


def test_stops_are_powers_of_two():
    rng = np.random.default_rng(0)
    image = rng.uniform(0, 2, (80, 50, 3)).astype(np.float32)
    assert np.array_equal(develop(image, 1.0, 2.0), develop(image, 4.0, 0.0))


def test_a_gradient_has_no_bands():
    """Means over 16 columns follow a slope of 3 levels in 1024 px; undithered they are stairs."""
    x = np.linspace(0.004, 0.008, 1024, dtype=np.float32)
    image = np.broadcast_to(x[None, :, None], (64, 1024, 3)).copy()
    picture = develop(image, 1.0)
    means = picture.reshape(64, 64, 16, 3).mean(axis=(0, 2))
    assert np.ptp(picture) >= 2
    steps = np.diff(means, axis=0)
    assert (steps > -0.03).all()
    assert steps.max() < 4 * steps.mean()


def test_strips_do_not_show():
    """From row to row the dither takes the same step, also from strip to strip."""
    picture = develop(flat(0.0102, (256, 256)), 1.0)
    assert np.ptp(picture) == 1
    same = (picture[1:] == picture[:-1]).mean(axis=(1, 2))
    assert np.ptp(same) < 0.03


def test_runs_and_threads_change_nothing():
    rng = np.random.default_rng(0)
    image = rng.exponential(0.3, (300, 200, 3)).astype(np.float32)
    reference = develop(image, 1.3)
    before = cv2.getNumThreads()
    try:
        for threads in (1, 2):
            cv2.setNumThreads(threads)
            assert np.array_equal(develop(image, 1.3), reference)
    finally:
        cv2.setNumThreads(before)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_what_is_no_number_is_refused(bad):
    image = flat(0.1)
    with pytest.raises(DqpaintError, match="exposure"):
        develop(image, bad)
    image[3, 4, 1] = bad
    with pytest.raises(DqpaintError, match="not finite"):
        develop(image, 1.0)
    with pytest.raises(DqpaintError, match="exposure 0"):
        develop(flat(0.1), 0.0)
