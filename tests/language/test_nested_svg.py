"""<svg> within <svg>, against where Chromium puts the ends of a line (getScreenCTM)."""

from itertools import chain

import numpy as np
import pytest

from dqpaint.language.imports.svg import reader
from dqpaint.program import piecewise
from tests.support.svg import WITH

INCH = 0.0254


def ends(attributes: str, within: str) -> list[list[float]]:
    """Of each line of a drawing: its left and its right end [px], y down."""
    made = []
    for line in reader._read(f"{WITH.format(attributes)}{within}</svg>".encode()).lines:
        last = len(line.chain.cubic) - 1
        at = piecewise.derivatives(line.chain, np.array([0, last]), np.array([0.0, 1.0]))[0]
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
    ],
)
def test_an_inner_drawing_stands_where_browsers_put_it(
    attributes: str, within: str, wanted: list[list[float]]
) -> None:
    np.testing.assert_allclose(ends(attributes, within), wanted, atol=1e-3)
