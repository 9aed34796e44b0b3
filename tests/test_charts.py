"""Charts are pictures of the asked size in which every line and the bound can be found."""

import cv2
import numpy as np
import pytest

from dqpaint.charts import COLOURS, HeatMap, Line, Panel, chart, heat_map

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
    middle = np.flatnonzero(np.abs(column.astype(int) - [0x0B, 0x6F, 0xA4]).max(axis=1) < 60)
    assert (middle.min() < 0.6 * len(column)) == log  # a straight line, or one that hugs the floor


def test_names_are_no_formulas_and_not_longer_than_a_chart():
    """As a formula `$x_$` is a fault, and a chart with a long name has no room for its curves."""
    for name in ("$x_$", "a $ b $", "long " * 40, "two\nlines"):
        line = Line(np.arange(3.0), np.arange(3.0), name)
        assert chart([Panel(name, name, name, [line], ticks=(name, "b", "c"))])
        values, marked = np.ones((1, 1)), np.zeros((1, 1), dtype=bool)
        assert heat_map(HeatMap(name, name, name, (name,), (name,), values, marked))
