"""Charts are pictures of the asked size in which every line and the bound can be found."""

from itertools import combinations

import cv2
import numpy as np
import pytest

from dqpaint.light.images.contact_sheet import hues
from dqpaint.studies.report.charts import COLOURS, HeatMap, Line, Panel, chart, heat_map
from dqpaint.studies.report.pictures import on_paper

X = np.linspace(1, 10, 50)


def drawn(panels, **size):
    return cv2.imdecode(np.frombuffer(chart(panels, **size), np.uint8), cv2.IMREAD_COLOR)[..., ::-1]


def has(image, colour):
    rgb = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)])
    return (np.abs(image.astype(int) - rgb).max(axis=2) < 8).sum() > 50


def test_lines_have_their_colours_and_panels_stand_side_by_side():
    one = Panel("a", "x [m]", "y [s]", [Line(X, X, "one"), Line(X, X**2, "two")], bound=3.0)
    image = drawn([one, Panel("b", "x", "y", [Line(X, -X, "three")])], width=8, height=3)
    assert image.shape == (360, 960, 3)
    left, right = image[:, :480], image[:, 480:]
    assert has(left, COLOURS[0])
    assert has(left, COLOURS[1])
    assert has(right, COLOURS[0])
    assert not has(right, COLOURS[1])


def test_two_charts_of_the_same_numbers_are_the_same_file():
    panels = [Panel("a", "x", "y", [Line(X, X, "one")], log_x=True, log_y=True)]
    assert chart(panels) == chart(panels)


@pytest.mark.parametrize("log", [True, False])
def test_axes_may_be_logarithmic(log):
    image = drawn([Panel("a", "x", "y", [Line(X, 10**X, "one")], log_y=log)])
    column = image[:, image.shape[1] // 2]
    middle = np.flatnonzero(np.abs(column.astype(int) - [0x00, 0x6A, 0xA8]).max(axis=1) < 60)
    assert (middle.min() < 0.6 * len(column)) == log  # a straight line, or one that hugs the floor


def test_names_are_no_formulas_and_not_longer_than_a_chart():
    """As a formula `$x_$` is a fault, and a chart with a long name has no room for its curves."""
    for name in ("$x_$", "a $ b $", "long " * 40, "two\nlines"):
        line = Line(np.arange(3.0), np.arange(3.0), name)
        assert chart([Panel(name, name, name, [line], ticks=(name, "b", "c"))])
        values, marked = np.ones((1, 1)), np.zeros((1, 1), dtype=bool)
        assert heat_map(HeatMap(name, name, name, (name,), (name,), values, marked))


# What is left of linear RGB for those who lack a kind of cone: Machado, Oliveira and Fernandes
# 2009, severity 1.0.
LACKING = {
    "nothing": np.eye(3),
    "red": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998]],
    "green": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
              [-0.011820, 0.042940, 0.968881]],
    "blue": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602],
             [0.004733, 0.691367, 0.303900]],
}  # fmt: skip
TOLD_APART = 15.0  # CIE76; 2.3 is what is just noticed side by side


def linear(colour):
    coded = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255
    return np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)


def lab(rgb):
    pixel = np.clip(rgb, 0, 1).astype(np.float32).reshape(1, 1, 3)
    coded = np.where(pixel <= 0.0031308, 12.92 * pixel, 1.055 * pixel ** (1 / 2.4) - 0.055)
    return cv2.cvtColor(coded.astype(np.float32), cv2.COLOR_RGB2LAB)[0, 0]


def closest(colours, lack):
    seen = [lab(np.array(LACKING[lack]) @ colour) for colour in colours]
    return min(float(np.linalg.norm(a - b)) for a, b in combinations(seen, 2))


@pytest.mark.parametrize("lack", LACKING)
def test_everybody_can_tell_the_colours_apart(lack):
    assert closest([linear(colour) for colour in COLOURS], lack) > TOLD_APART
    for count in range(2, 7):
        assert closest(hues(count), lack) > TOLD_APART, count
        assert closest([linear(on_paper(hue)) for hue in hues(count)], lack) > TOLD_APART, count


def test_colours_of_lines_are_seen_on_white_paper():
    for colour in COLOURS:
        bright = np.array([0.2126, 0.7152, 0.0722]) @ linear(colour)
        assert 1.05 / (bright + 0.05) >= 2.95  # of 3 that WCAG 2.2, 1.4.11 asks


@pytest.mark.slow
def test_many_panels_stand_in_rows_under_one_legend():
    lines = [Line(X, X, "one"), Line(X, X**2, "two")]
    panels = [Panel(f"panel {i}", "x", "y", lines, span=(0, 100)) for i in range(5)]
    image = drawn(panels, width=15, height=3, shared=True)
    assert image.shape == (2 * 360, 15 * 120, 3)
    for i in range(6):
        part = image[(i // 3) * 360 + 90 : (i // 3 + 1) * 360, (i % 3) * 600 : (i % 3 + 1) * 600]
        assert has(part, COLOURS[0]) == (i < 5)
    assert has(image[:60], COLOURS[0])  # the legend, above all
    apart = drawn(panels, width=15, height=3)
    assert not has(apart[:40], COLOURS[0])


def test_a_line_leaves_out_what_is_marked_and_a_bound_is_named():
    y = np.array([1.0, 1.0, 9.0])
    line = Line(np.array([1.0, 2.0, 3.0]), y, "one", marks=np.array([False, False, True]))
    image = drawn([Panel("a", "x", "y", [line], bound=5.0, limit="most allowed")], width=6)
    blue = np.abs(image.astype(int) - [0x00, 0x6A, 0xA8]).max(axis=2) < 30
    rows = np.flatnonzero(blue.any(axis=1))
    gaps = np.diff(rows)
    assert gaps.max() > 100  # nothing between the line and the unstable point


def test_the_ends_of_an_axis_can_be_asked_for():
    """A level line is as high in its chart as its value is between the ends."""
    line = Line(X, np.full(50, 2.0), "one")
    heights = []
    for ends in ((0.0, 4.0), (0.0, 20.0)):
        image = drawn([Panel("a", "x", "y", [line], span=ends)], width=5)
        blue = np.abs(image.astype(int) - [0x00, 0x6A, 0xA8]).max(axis=2) < 30
        heights.append(np.flatnonzero(blue.any(axis=1)).mean())
    assert heights[1] - heights[0] > 100
