"""Viewports, against where Chromium puts the ends of a line (getScreenCTM, and boxes of `use`)."""

from itertools import chain

import numpy as np
import pytest

from dqpaint.language.imports.svg import nested_svg, reader
from dqpaint.language.imports.svg.reader import _measured, _shapes
from dqpaint.program import piecewise
from tests.support.svg import WITH, tree

INCH = 0.0254


def ends(attributes: str, within: str) -> list[list[float]]:
    """Of each line of a drawing: its left and its right end [px], y down."""
    made = []
    drawing, _ = reader._read(f"{WITH.format(attributes)}{within}</svg>".encode(), as_drawn=True)
    for line, _ in drawing.lines:
        last = len(line.cubic) - 1
        at = piecewise.derivatives(line, np.array([0, last]), np.array([0.0, 1.0]))[0]
        made.append([*chain.from_iterable(sorted((at[:, :2] / INCH * [96, -96]).tolist()))])
    return sorted(made)


@pytest.mark.parametrize(
    ("attributes", "within", "wanted"),
    [
        (
            'viewBox="0 0 1000 1000" width="1000" height="1000"',
            '<svg x="10%" y="20%" width="30%" height="60%" viewBox="0 0 10 10"'
            ' preserveAspectRatio="none"><path d="M0 1L10 10"/>'
            '<svg x="5" y="5" width="5" height="5" viewBox="0 0 100 50"'
            ' preserveAspectRatio="xMaxYMax slice"><path d="M0 0L100 40"/></svg></svg>',
            [[100, 260, 400, 800], [100, 500, 400, 740]],
        ),
        (  # without a view box; turned
            'viewBox="10 20 500 1000" width="400" height="300"',
            '<g transform="rotate(20)"><svg x="10" y="20" width="50%" height="100">'
            '<path d="M0 0L10 10"/></svg></g>',
            [[122.767, 0.664, 124.56, 4.509]],
        ),
        (  # without a place and a size: not those of the drawing around
            'viewBox="10 20 500 1000" width="400" height="300" x="7"'
            ' preserveAspectRatio="xMinYMax slice"',
            '<svg viewBox="0 0 7 9"><path d="M0 0L7 9"/></svg>',
            [[-8, -373.143, 392, 141.143]],
        ),
        (
            'width="400" height="300"',
            '<svg x="5" y="6" width="20mm" height="1in" viewBox="-1 -1 2 2"'
            ' preserveAspectRatio="xMidYMin meet"><path d="M0 0L1 1"/></svg>',
            [[42.795, 43.795, 80.591, 81.591]],
        ),
        (
            'width="400" height="300"',
            '<svg transform="translate(50 50)" x="5" width="100" height="100">'
            '<path d="M0 0L10 40"/></svg>',
            [[55, 50, 65, 90]],
        ),
        (  # percentages before, in and behind
            'viewBox="0 0 10 10" width="100" height="100" stroke="red"',
            '<line x2="10%" y2=".5"/><svg width="2" height="3" viewBox="0 0 50 75">'
            '<line x1="50%" y1="25" x2="100%" y2="100%"/></svg>'
            '<line x1="50%" y1="4" x2="6" y2="9"/>',
            [[0, 0, 10, 5], [10, 10, 20, 30], [50, 40, 60, 90]],
        ),
        (  # the size of a `use` goes before that of the symbol or the drawing that it shows
            'width="1000" height="1000"',
            '<symbol id="s" viewBox="0 0 10 5" preserveAspectRatio="xMinYMax meet">'
            '<line x2="10" y2="50%"/></symbol>'
            '<use href="#s" x="10" y="20" width="30%" height="300"/>'
            '<use href="#s" x="10" y="20" width="100"/><use href="#s" width="0" height="9"/>'
            '<svg id="n" x="5" y="5" width="20" height="20" viewBox="0 0 40 40">'
            '<line x2="50%" y2="40"/></svg>'
            '<use href="#n" x="100" y="20" width="200" height="100"/>',
            [[5, 5, 15, 25], [10, 170, 310, 245], [10, 970, 110, 995], [155, 25, 205, 125]],
        ),
        (  # percentages are of where it is shown
            'width="1000" height="1000" viewBox="0 0 1000 1000"',
            '<symbol id="s" width="50%" height="30" x="3" y="4">'
            '<line x2="100%" y2="100%"/></symbol>'
            '<line id="l" x2="50%" y2="10%"/><svg x="500" y="500" width="100" height="200">'
            '<use href="#l"/><use href="#s"/></svg>',
            [[0, 0, 500, 100], [500, 500, 550, 520], [503, 504, 553, 534]],
        ),
        (  # a ratio that is none is the usual one
            'viewBox="0 0 20 10" preserveAspectRatio="xmaxymax"',
            '<svg width="10" height="10" viewBox="0 0 5 1" preserveAspectRatio="else">'
            '<path d="M0 0L5 1"/></svg>',
            [[0, 4, 10, 6]],
        ),
        (  # in a group that is not displayed, and turned
            'width="1000" height="1000"',
            '<g display="none"><line id="l" x2="10" y2="10"/></g>'
            '<use href="#l" x="5" y="6" transform="translate(100 0) rotate(90)"/>',
            [[84, 15, 94, 5]],
        ),
    ],
)
def test_what_is_in_a_viewport_stands_where_browsers_put_it(
    attributes: str, within: str, wanted: list[list[float]]
) -> None:
    np.testing.assert_allclose(ends(attributes, within), wanted, atol=1e-3)


@pytest.mark.parametrize(
    ("attributes", "size"),
    [
        ("", (1000, 1000)),
        ('width="30" height="40mm"', (30, 40 / 25.4 * 96)),
        ('width="30%"', (300, 1000)),
        ('viewBox="1 2 30 40"', (30, 40)),
        ('viewBox="1 2 30 40" width="50%" height="100%"', (30, 40)),
        ('viewBox="1 2 30 40" width="60"', (60, 80)),
        ('viewBox="1 2 30 40" height="60" width="auto"', (45, 60)),
        ('viewBox="1 2 30 40" height="60" width="7"', (7, 60)),
    ],
)
def test_the_size_of_a_whole_drawing(attributes: str, size: tuple[float, float]) -> None:
    assert nested_svg.paper(tree(f"{WITH.format(attributes)}</svg>")) == pytest.approx(size)


def test_radii_in_percent() -> None:
    """Of both sides, of the one side, or as long as the other radius."""
    body = '<circle r="10%"/><ellipse rx="10%"/><rect width="60" height="40" ry="5%"/>'
    root = tree(WITH.format('width="100" height="700"') + body + "</svg>")
    radii = [
        tuple(_measured(node, state.view)[name] for name in ("rx", "ry"))
        for node, state in _shapes(root, nested_svg.paper(root))
    ]
    assert radii == [(pytest.approx(50), pytest.approx(50)), (10, 10), (35, 35)]
