"""An <svg> within an SVG drawing -> a group that stands where it would.

The library reads them wrongly: it forgets their place where they have no viewBox, hands
an inner one the size of the outer, and measures percentages behind one by its sides. How a view box
lies in a viewport is told in section 8.2 of SVG 2.
"""

import math
from typing import NamedTuple
from xml.etree.ElementTree import Element

from dqpaint.language.imports.svg.style_sheets import tag_of

UNKNOWN = 1000.0  # [px] the side of a drawing that does not say it, as the library has it
_ACROSS = frozenset(("x", "x1", "x2", "cx", "rx", "width"))
_DOWN = frozenset(("y", "y1", "y2", "cy", "ry", "height"))
_ALIGNS = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}


class View(NamedTuple):
    """What percentages are of [px]."""

    width: float
    height: float


def flatten(root: Element) -> None:
    """Makes groups of the <svg> within a drawing, and then numbers of its percentages.

    Args:
        root: its attributes written plainly, with a size wherever it has an <svg>.
    """
    for name in ("x", "y"):  # of the whole it has none
        root.attrib.pop(name, None)
    inner = (element for element in root.iter() if tag_of(element) == "svg")
    if sum(1 for _ in inner) > 1:
        box = _box(root)
        _flatten(root, View(*box[2:]) if box else _sides(root, View(UNKNOWN, UNKNOWN)))


def _flatten(parent: Element, view: View) -> None:
    for child in parent:
        for name, text in child.attrib.items():
            if text.endswith("%") and (name in _ACROSS or name in _DOWN or name == "r"):
                child.attrib[name] = repr(_length(name, text, view))
        _flatten(child, _group(child, view) if tag_of(child) == "svg" else view)


def _group(element: Element, outside: View) -> View:
    """An <svg> becomes a group; returns what percentages in it are of."""
    has, sides = element.attrib, _sides(element, outside)
    x, y = (float(has.get(name, "0")) for name in ("x", "y"))
    box = _box(element)
    sx, sy, left, top = 1.0, 1.0, 0.0, 0.0
    if box:
        sx, sy, left, top = _fitted(box, sides, has.get("preserveAspectRatio", ""))
    placed = f"matrix({sx!r}, 0, 0, {sy!r}, {x + left!r}, {y + top!r})"
    has["transform"] = f"{has.get('transform', '')} {placed}".strip()
    for name in ("x", "y", "width", "height", "viewBox", "preserveAspectRatio"):
        has.pop(name, None)
    element.tag = str(element.tag).removesuffix("svg") + "g"
    return View(*box[2:]) if box else sides


def _box(element: Element) -> list[float]:
    return [float(number) for number in element.attrib.get("viewBox", "").split()]


def _sides(element: Element, outside: View) -> View:
    return View(
        *(_length(name, element.attrib.get(name, "100%"), outside) for name in ("width", "height"))
    )


def _length(name: str, text: str, view: View) -> float:
    if not text.endswith("%"):
        return float(text)
    whole = math.hypot(*view) / math.sqrt(2.0)
    if name != "r":
        whole = view.width if name in _ACROSS else view.height
    return float(text[:-1]) / 100.0 * whole


def _fitted(box: list[float], sides: View, ratio: str) -> tuple[float, float, float, float]:
    """The scales of a view box in its viewport, and where its origin comes to lie."""
    words = [word for word in ratio.split() if word != "defer"] or ["xMidYMid"]
    sx, sy = sides.width / box[2], sides.height / box[3]
    align = words[0]
    if align == "none":
        return sx, sy, -sx * box[0], -sy * box[1]
    scale = max(sx, sy) if "slice" in words else min(sx, sy)
    free = sides.width - scale * box[2], sides.height - scale * box[3]
    across, down = (_ALIGNS.get(part, 0.5) for part in (align[1:4], align[5:8]))
    return scale, scale, across * free[0] - scale * box[0], down * free[1] - scale * box[1]
