"""Colour maps and legends: equal steps, rising lightness, and what is written is in the picture."""

import cv2
import numpy as np
import pytest

from dqpaint.light.film.looks import LOOKS
from dqpaint.light.images.colour_maps import categorical_colours, sequential_colours, sequential_map
from dqpaint.light.images.legend import Legend, text_length, with_legend, write_text


def oklab(rgb):
    """By the matrices of the definition (linear sRGB to LMS, cube root, to Lab)."""
    lms = np.cbrt(rgb @ np.array([
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]).T)  # fmt: skip
    return lms @ np.array([
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]).T  # fmt: skip


def test_equal_steps_of_value_look_equally_different():
    lab = oklab(sequential_map())
    steps = np.linalg.norm(np.diff(lab, axis=0), axis=1)
    assert np.ptp(steps) < 0.05 * steps.mean()
    assert (np.diff(lab[:, 0]) > 0).all()
    assert lab[0, 0] == pytest.approx(0.48, abs=0.01)
    assert lab[-1, 0] == pytest.approx(0.95, abs=0.01)


def test_values_find_their_colours():
    table = sequential_map()
    np.testing.assert_allclose(sequential_colours(np.array([0.0, 1.0])), table[[0, -1]])
    np.testing.assert_allclose(sequential_colours(np.array([-3.0, 7.0])), table[[0, -1]])
    np.testing.assert_allclose(sequential_colours(np.array(0.5 / 255)), table[:2].mean(axis=0))


def test_kinds_are_far_apart_and_equally_light():
    lab = oklab(categorical_colours(6))
    np.testing.assert_allclose(lab[:, 0], 0.76, atol=0.01)
    apart = np.linalg.norm(lab[:, None] - lab[None], axis=2)[np.triu_indices(6, 1)]
    assert apart.min() > 0.04


SCALE = Legend("speed [mm/s]", ("0", "20"), tuple(map(tuple, sequential_map())), True)


@pytest.mark.parametrize("size", [(1280, 720), (640, 360), (1920, 1080)])
@pytest.mark.parametrize("plain", [False, True])
def test_a_legend_stands_in_its_corner_alone(size, plain, monkeypatch):
    if plain and hasattr(cv2, "FontFace"):
        monkeypatch.delattr(cv2, "FontFace")
    picture = np.zeros((size[1], size[0], 3), np.uint8)
    shown = with_legend(picture, SCALE, "film")
    assert not picture.any()
    rows, columns = np.nonzero(shown.any(axis=2))
    assert rows.min() > 0.8 * size[1]
    assert columns.max() < 0.5 * size[0]
    assert columns.min() > 8
    assert size[1] - rows.max() > 6
    strip = max((row for row in shown), key=lambda row: int(row.any(axis=1).sum()))
    lit = strip[strip.any(axis=1)].astype(int)
    assert lit[2, 2] > lit[2, 1]  # blue at its beginning
    assert lit[-3, 0] > lit[-3, 2]  # yellow at its end


def test_a_legend_that_does_not_fit_is_left_out():
    picture = np.full((36, 64, 3), 7, np.uint8)
    assert np.array_equal(with_legend(picture, SCALE, "film"), picture)


@pytest.mark.parametrize("look", LOOKS)
def test_kinds_are_named_one_below_the_other(look):
    labels = tuple(f"{i}  line" for i in range(11))
    legend = Legend(
        "line of the drawing", labels, tuple(map(tuple, categorical_colours(11))), False
    )
    shown = with_legend(np.zeros((720, 1280, 3), np.uint8), legend, look)
    swatches = shown[:, 30].astype(int)
    runs = np.flatnonzero(np.diff((swatches.max(axis=1) > 0).astype(int)) == 1)
    assert len(runs) >= 8


def test_a_kind_is_a_short_line_with_its_name_beside_it():
    legend = Legend("kinds", ("a", "b"), ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)), False)
    shown = with_legend(np.zeros((720, 1280, 3), np.uint8), legend, "clip").astype(int)
    for channel in (0, 1):
        ink = (shown[..., channel] > 150) & (np.delete(shown, channel, axis=2).max(axis=2) < 60)
        columns = np.flatnonzero(ink.any(axis=0))
        assert 20 < np.ptp(columns) < 100
        row = int(np.flatnonzero(ink.any(axis=1)).mean())
        label = shown[row - 12 : row + 12, columns.max() + 5 : columns.max() + 60].min(axis=2)
        assert (label > 100).any()
        assert not shown[row, columns.max() + 60 :].any()


@pytest.mark.parametrize("size", [12, 24])
def test_a_text_is_as_high_and_long_as_it_is_said_to_be(size):
    picture = np.zeros((200, 600, 3), np.uint8)
    write_text(picture, "Hxg 0123", 50, 100, size)
    rows, columns = np.nonzero(picture.max(axis=2) > 60)
    assert 0.6 * size < np.ptp(rows) < 1.7 * size
    assert 90 < rows.max() < 100 + size
    assert abs(np.ptp(columns) - text_length("Hxg 0123", size)) < 0.35 * size
    assert abs(columns.min() - 50) < 0.5 * size
