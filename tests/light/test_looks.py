import cv2
import numpy as np
import pytest

from dqpaint.errors import DqpaintError
from dqpaint.light.film.develop import develop
from dqpaint.light.film.looks import LOOKS, with_noise
from dqpaint.light.film.starburst import RAY_ENERGY, with_starburst


def flat(value, shape=(64, 64)):
    return np.broadcast_to(np.float32(value), (*shape, 3)).copy()


@pytest.mark.parametrize("name", LOOKS)
def test_every_look(name):
    """Black is black, more light is never darker, grey is grey, stops are powers of two."""
    look = LOOKS[name]
    assert not look(np.zeros((70, 50, 3), np.float32), 5.0, 3.0).any()
    ramp = np.tile(np.logspace(-4, 3, 400, dtype=np.float32)[:, None, None], (1, 64, 3))
    levels = look(ramp, 1.0, 0.0).mean(axis=1)
    assert (np.diff(levels.mean(axis=1)) > -0.3).all()
    assert np.ptp(levels, axis=1).max() < 3
    assert levels[-1].min() > 250
    assert levels[0].max() < 3
    rng = np.random.default_rng(0)
    image = rng.uniform(0, 2, (80, 50, 3)).astype(np.float32)
    assert np.array_equal(look(image, 1.0, 2.0), look(image, 4.0, 0.0))
    for bad in (np.nan, np.inf, 0.0):
        with pytest.raises(DqpaintError, match="exposure"):
            look(image, bad, 0.0)
    with pytest.raises(DqpaintError, match="not finite"):
        look(flat(np.nan), 1.0, 0.0)


def test_film_is_the_same_to_the_bit():
    image = np.random.default_rng(1).uniform(0, 3, (90, 70, 3)).astype(np.float32)
    assert np.array_equal(LOOKS["film"](image, 2.0, 0.5), develop(image, 2.0, 0.5))


def test_clip_is_srgb():
    for value in (0.02, 0.18, 0.5, 0.9):
        mean = LOOKS["clip"](flat(value), 1.0, 0.0).mean()
        truth = 255 * (1.055 * value ** (1 / 2.4) - 0.055)
        assert mean + 1 / 512 == pytest.approx(truth, abs=0.6)
    pure = LOOKS["clip"](flat([0.0, 0.0, 50.0]), 1.0, 0.0)
    assert (pure[..., 2].min(), pure[..., :2].max()) == (255, 0)


def test_aces_is_the_published_fit():
    """Values of the same formula worked out by hand in float64, and its known anchor."""
    x = np.array([0.3, 0.05, 0.8])
    into = np.array(
        [[0.59719, 0.35458, 0.04823], [0.076, 0.90834, 0.01566], [0.0284, 0.13383, 0.83777]]
    )
    out = np.array(
        [
            [1.60475, -0.53108, -0.07367],
            [-0.10208, 1.10813, -0.00605],
            [-0.00327, -0.07276, 1.07602],
        ]
    )
    v = into @ x
    v = out @ ((v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.432951) + 0.238081))
    truth = 255 * (1.055 * np.clip(v, 0, 1) ** (1 / 2.4) - 0.055)
    got = LOOKS["aces"](flat(x), 1.0, 0.0).mean(axis=(0, 1))
    np.testing.assert_allclose(got, truth, atol=0.8)


def test_bright_pure_colours_whiten_on_agx_and_on_clip_they_do_not():
    blue = flat([0.0, 0.1, 30.0])
    assert LOOKS["agx"](blue, 1.0, 0.0).mean(axis=(0, 1))[0] > 90
    assert LOOKS["clip"](blue, 1.0, 0.0).mean(axis=(0, 1))[0] == 0


def test_noise_has_the_variance_of_its_electrons_and_its_seed():
    image = flat(0.2, (300, 300))
    noisy = with_noise(image, 1.0, 7)
    assert np.array_equal(noisy, with_noise(image, 1.0, 7))
    assert not np.array_equal(noisy, with_noise(image, 1.0, 8))
    assert noisy.mean() == pytest.approx(0.2, rel=1e-3)
    assert noisy.std() == pytest.approx(np.sqrt(0.2 * 50_000 + 9) / 50_000, rel=0.02)
    twice = with_noise(image / 2, 2.0, 7)
    np.testing.assert_allclose(twice * 2, noisy, rtol=1e-5)
    assert (with_noise(flat(0.0), 1.0, 1) >= 0).all()


@pytest.mark.parametrize(("blades", "rays"), [(5, 10), (6, 6), (8, 8)])
def test_an_aperture_draws_its_rays_and_keeps_its_light(blades, rays):
    image = np.zeros((360, 480, 3), np.float32)
    image[180:182, 240:242] = [25.0, 50.0, 0.0]
    shown = with_starburst(image, blades)
    np.testing.assert_allclose(shown.sum(axis=(0, 1)), [100, 200, 0], rtol=1e-3, atol=1e-3)
    turn = np.linspace(0, 2 * np.pi, 720, endpoint=False)
    ring = np.stack([240.5 + 30 * np.cos(turn), 180.5 + 30 * np.sin(turn)]).astype(np.float32)
    values = cv2.remap(shown[..., 1], ring[0][None], ring[1][None], cv2.INTER_LINEAR)[0]
    high = values > 0.5 * values.max()
    assert np.count_nonzero(high & ~np.roll(high, 1)) == rays
    assert shown[180, 240, 1] > (1 - RAY_ENERGY) * 50 - 1e-3


def test_rays_of_an_even_field_do_not_show():
    image = flat(1.0, (300, 400))
    inner = with_starburst(image, 6)[100:200, 150:250]
    np.testing.assert_allclose(inner, 1.0, rtol=1e-3)
