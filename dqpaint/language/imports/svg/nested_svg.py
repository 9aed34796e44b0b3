"""SVG viewports (<svg>, <symbol>) -> transform and percentage base of their content.

SVG 2 defines the position of a view box in a viewport in section 8.2, percentages in 8.9.
"""

import math
from collections.abc import Mapping
from typing import NamedTuple

from dqpaint.language.imports.svg.attributes import Node
from dqpaint.language.imports.svg.values import Length, Matrix

UNKNOWN = 1000.0  # [px] the default side of a drawing
_ACROSS = frozenset(("x", "x1", "x2", "cx", "rx", "width"))
_ALIGNS = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}


class View(NamedTuple):
    """The base of percentages [px]."""

    width: float
    height: float

    def pixels(self, name: str, length: Length) -> float:
        """An attribute's length [px]."""
        if not length.percent:
            return length.pixels
        whole = self.width if name in _ACROSS else self.height
        if name == "r":
            whole = math.hypot(*self) / math.sqrt(2.0)
        return length.percent / 100.0 * whole


_WHOLE = {**dict.fromkeys("xy", Length()), **dict.fromkeys(View._fields, Length(percent=100.0))}


def paper(root: Node) -> View:
    """The size of a whole drawing; missing sizes follow from its view box, as in browsers.

    Args:
        root: not without a size.
    """
    if not root.box:
        return placed(root, View(UNKNOWN, UNKNOWN), {})[1]
    _, _, across, down = root.box
    width, height = (root.lengths.get(name, Length()).pixels for name in View._fields)
    if not (width or height):
        return View(across, down)
    return View(width or height * across / down, height or width * down / across)


def placed(node: Node, around: View, sizes: Mapping[str, Length]) -> tuple[Matrix, View]:
    """The transform and the percentage base of the content of a viewport or a `use`.

    Args:
        node: a viewport, or a `use`, whose percentages are those around.
        around: what its own percentages are of.
        sizes: what goes before its own lengths.
    """
    lengths = {**_WHOLE, **node.lengths, **sizes}
    x, y, *sides = (around.pixels(name, lengths[name]) for name in _WHOLE)
    if not node.box:
        return (1.0, 0.0, 0.0, 1.0, x, y), View(*sides)
    left, top, width, height = node.box
    sx, sy, align = sides[0] / width, sides[1] / height, "xMinYMin"
    words = [word for word in node.ratio.split() if word != "defer"] or ["xMidYMid"]
    if words[0] != "none":
        sx = sy = max(sx, sy) if "slice" in words else min(sx, sy)
        align = words[0]
    across, down = (_ALIGNS.get(part, 0.5) for part in (align[1:4], align[5:8]))
    x += across * (sides[0] - sx * width) - sx * left
    y += down * (sides[1] - sy * height) - sy * top
    return (sx, 0.0, 0.0, sy, x, y), View(width, height)
