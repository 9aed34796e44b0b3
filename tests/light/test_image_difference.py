"""Differences of pictures against their definitions, written out, and files that come back."""

from itertools import combinations

import numpy as np
import pytest

from dqpaint.light.film import LOOKS
from dqpaint.light.images.contact_sheet import (
    encode_png,
    hues,
    lit_window,
    message_picture,
    mixed_colours,
    overlay,
    sheet,
    with_key,
)
from dqpaint.light.images.image_difference import (
    decode_picture,
    decode_planes,
    difference_picture,
    encode_planes,
    measure_difference,
    structural_similarity,
)
from dqpaint.light.images.legend import LEGEND_EXPOSURE, look_colours


def noisy(rng, height=40, width=60):
    return rng.integers(0, 256, (height, width, 3)).astype(np.uint8)


def test_similarity_is_its_formula_at_a_window(rng):
    one, other = noisy(rng), noisy(rng)
    got = structural_similarity(one, other)[20, 30]
    grey = np.array([0.299, 0.587, 0.114])
    a, b = (np.rint(p[15:26, 25:36] @ grey) for p in (one, other))
    x = np.arange(-5, 6)
    window = np.exp(-(x[:, None] ** 2 + x**2) / (2 * 1.5**2))
    window /= window.sum()
    m, n = (a * window).sum(), (b * window).sum()
    va, vb = ((a - m) ** 2 * window).sum(), ((b - n) ** 2 * window).sum()
    vab = ((a - m) * (b - n) * window).sum()
    c1, c2 = 6.5025, 58.5225
    truth = (2 * m * n + c1) * (2 * vab + c2) / ((m * m + n * n + c1) * (va + vb + c2))
    assert got == pytest.approx(truth, abs=1e-6)


def test_each_number_is_what_it_says(rng):
    light = rng.uniform(0, 2, (40, 60, 3)).astype(np.float32)
    shown = noisy(rng)
    same = measure_difference(light, light, shown, shown)
    assert (same.film_max, same.film_l1, same.energy, same.u8_max) == (0, 0, 0, 0)
    assert same.ssim_min == pytest.approx(1.0)
    other, new = light.copy(), shown.copy()
    other[3, 4, 1] += 0.5
    other[5, 6, 2] -= 0.25
    shown[7, 8], new[7, 8] = 10, 250  # where 8 bits would wrap round
    got = measure_difference(light, other, shown, new)
    assert got.film_max == pytest.approx(0.5 / light.max(), rel=1e-6)
    assert got.film_l1 == pytest.approx(0.75 / light.sum(dtype=float), rel=1e-6)
    assert got.energy == pytest.approx(0.25 / light.sum(dtype=float), rel=1e-6)
    assert got.u8_max == 240
    gap, factor = difference_picture(light, other)
    assert gap[3, 4, 1] == 255
    assert gap[5, 6, 2] == int(255 * 0.5 ** (1 / 2.2))
    assert np.count_nonzero(gap) == 2
    assert factor == pytest.approx(light.max() / 0.5)
    assert not difference_picture(light, light)[0].any()


def test_files_come_back_bit_for_bit(rng):
    planes = rng.normal(size=(3, 20, 30)).astype(np.float32)
    np.testing.assert_array_equal(decode_planes(encode_planes(planes)), planes)
    picture = noisy(rng)
    np.testing.assert_array_equal(decode_picture(encode_png(picture)), picture)
    for wrong in (b"", b"text", encode_png(picture)[:50]):
        with pytest.raises(ValueError, match=r"no picture|three channels"):
            decode_planes(wrong)
    with pytest.raises(ValueError, match="three channels"):
        decode_picture(encode_planes(planes))


@pytest.mark.parametrize("count", [1, 2, 3, 4, 7, 12])
def test_what_all_drew_alike_is_white(count, rng):
    colours = np.array(hues(count))
    assert len(np.unique(colours.round(6), axis=0)) == count
    if count > 1:
        np.testing.assert_allclose(colours.sum(axis=0), colours.sum() / 3, rtol=0.05)
    light = rng.uniform(0, 1, (6, 8, 3)).astype(np.float32)
    dark = [np.zeros_like(light)] * (count - 1)
    alone = overlay([light, *dark], 0.5)
    half = 0.5 * light.max(axis=2)[..., None] * colours[0]
    np.testing.assert_allclose(alone, half, rtol=1e-6)
    burnt = overlay([light + 1, *dark], 3.0)
    np.testing.assert_allclose(burnt, np.broadcast_to(colours[0], light.shape), rtol=1e-6)


@pytest.mark.parametrize("count", [2, 3, 5])
@pytest.mark.parametrize("look", ["film", "aces", "clip"])
def test_the_key_of_an_overlay_has_the_colours_that_are_in_it(count, look):
    """Lines that burn out in a photograph, by themselves, over others, and all over each other."""
    names = [f"law {i}" for i in range(count)]
    named = dict(zip(names, hues(count), strict=True))
    lights = np.zeros((count, 40, 60, 3), np.float32)
    for i in range(count):
        lights[i, 6 * i + 1 : 6 * i + 4] = 5.0  # alone
        lights[i, 35:38] = 9.0  # all
    key = mixed_colours(named)
    pairs = list(combinations(range(count), 2)) if count == 3 else []
    for row, pair in enumerate(pairs):
        for i in pair:
            lights[i, 20 + 4 * row : 22 + 4 * row] = 7.0
    shown = LOOKS[look](overlay(list(lights), 1.0), LEGEND_EXPOSURE, 0.0)
    places = [*(6 * i + 2 for i in range(count)), *(20 + 4 * k for k in range(len(pairs))), 36]
    assert len(key) == len(places)
    drawn = look_colours([colour for _, colour in key], look)
    np.testing.assert_allclose(shown[places, 30].astype(int), drawn.astype(int), atol=2)
    red, green, blue = drawn[-1].astype(int)
    assert max(red, green, blue) - min(red, green, blue) < 25  # white
    assert "alike" in key[-1][0]


def test_a_sheet_shows_every_picture_whole_above_its_caption(rng):
    pictures = [noisy(rng, 90, 160) for _ in range(5)]
    labels = ["one", "two", "a label much longer than the picture is wide " * 4, "", "five"]
    whole = sheet(pictures, labels)
    places = []
    for picture in pictures:
        hits = [
            (y, x)
            for y in range(whole.shape[0] - 89)
            for x in range(whole.shape[1] - 159)
            if whole[y, x, 0] == picture[0, 0, 0]
            and np.array_equal(whole[y : y + 90, x : x + 160], picture)
        ]
        places += hits
    assert len(places) == 5
    assert [len({y for y, _ in places}), len({x for _, x in places})] == [2, 3]
    last = max(y for y, _ in places)
    assert whole[last + 90 :].max() > 150  # a caption is written
    more = sheet(pictures, ["one\nk = 20\nrms 3 mm", *labels[1:]])
    assert more.shape[0] > whole.shape[0] + 2 * 2 * 11  # on all rows, each line 11 px or more
    assert sheet(pictures[:3], labels[:3], columns=3).shape[1] > sheet(pictures[:1], ["a"]).shape[1]


def test_a_note_is_readable_and_fits():
    picture = message_picture("failed: " + "word " * 60 + "x" * 300, 120, 200)
    assert picture.shape == (120, 200, 3)
    assert picture.max() > 150
    assert not picture[:, -3:].any()


def test_a_window_holds_all_that_is_lit_in_any_picture():
    pictures = [np.zeros((100, 200, 3), np.uint8) for _ in range(2)]
    pictures[0][40:44, 90:100] = 200
    pictures[1][60:64, 120:150, 2] = 90
    rows, columns = lit_window(pictures)
    assert rows.start < 40
    assert 64 < rows.stop < 90
    assert columns.start < 90
    assert 150 < columns.stop < 180
    pictures[1][:, 0] = 255
    assert lit_window(pictures)[0] == slice(0, 100)
    assert lit_window([np.zeros((100, 200, 3), np.uint8)]) == (slice(0, 100), slice(0, 200))


def test_a_key_names_every_colour_on_as_many_lines_as_it_takes():
    picture = np.full((50, 300, 3), 7, np.uint8)
    named = [(f"a long name {i}", hue) for i, hue in enumerate(hues(4))]
    whole = with_key(picture, named, "clip")
    np.testing.assert_array_equal(whole[:50], picture)
    assert whole.shape[1] == 300
    below = whole[50:].astype(int)
    for hue in hues(4):
        strong, weak = int(np.argmax(hue)), int(np.argmin(hue))
        assert (below[..., strong] - below[..., weak] > 100).any()
    assert len(with_key(picture, named[:1], "clip")) < len(whole)


def test_a_name_of_a_key_stands_beside_its_colour():
    named = [(f"name {i}", hue) for i, hue in enumerate(hues(3))]
    strip = with_key(np.zeros((10, 400, 3), np.uint8), named, "clip")[10:].astype(int)
    inks = [strip[y, x] for y, x in np.argwhere(np.ptp(strip, axis=2) > 100)]
    for hue in hues(3):
        ink = max(inks, key=lambda one, hue=hue: one @ np.array(hue))
        rows, columns = np.nonzero((strip == ink).all(axis=2))
        patch = strip[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
        assert (patch == ink).all()  # nothing is written over it
        size = rows.max() + 1 - rows.min()
        beside = strip[rows.min() - size // 2 : rows.max() + size, columns.max() + 1 :][
            :, : 4 * size
        ]
        assert (np.ptp(beside, axis=2) < 30)[beside.max(axis=2) > 100].any()
