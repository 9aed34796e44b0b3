"""SVG drawings -> chains with their colours, in metres, x to the right and y up.

The only door to the SVG library, which is an extra: `pip install "dqpaint[svg]"`. Arcs stay arcs
and Bezier curves Bezier curves, whatever transforms they stand under.
"""

import io
from array import array
from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from dqpaint.diagnostics import Problem, problem
from dqpaint.language.imports import stroke_order
from dqpaint.language.imports.file_access import contents
from dqpaint.language.imports.svg import paths
from dqpaint.language.imports.svg.attributes import NUMBER
from dqpaint.language.imports.svg.guard import MOST_BYTES, GuardedFile, Lines, guard
from dqpaint.language.imports.svg.paths import Pieces
from dqpaint.language.imports.svg.values import LARGEST, SvgError
from dqpaint.language.pen.pen import Pen
from dqpaint.language.syntax.tree import Quoted
from dqpaint.program import Chain, Colour, Floats, colours, piecewise

PIXEL = 0.0254 / 96.0  # [m] as CSS has it
DARKEST = 0.02  # of linear light: what is darker is ink, not a colour of light
MOST_SAID = 3  # of what was passed over
_WHOLE = "what a clip or a mask would hide is drawn, too"
_OTHERWISE = {
    "stroke-dasharray": "dashes are drawn as whole lines",
    "gradient": "a gradient is drawn in its mean colour",
    "pattern": "a pattern is drawn in the light that holds",
    "opacity": "the opacity of a 'use' is not followed",
    "transform-origin": "transforms are about the origin: write the place into the transform",
    "symbol": "a symbol is drawn in its own size, whatever its viewBox",
}


class Line(NamedTuple):
    """What is drawn without lifting the pen; no colour for what was drawn in black."""

    chain: Chain
    colour: Colour | None


class Drawing(NamedTuple):
    """The lines of a file, in an order with short ways, and what was left out of it."""

    lines: list[Line]
    guarded: GuardedFile


def read(node: Quoted, pen: Pen) -> list[Line]:
    """The lines of a drawing, in an order with short ways between them."""
    data = contents(node, pen, MOST_BYTES)
    try:
        lines, guarded = _read(data)
    except SvgError as fault:
        message = f"can't draw {node.text}: {fault.message}"
        raise problem("E298", message, node.span, "", fault.cure) from None
    except ImportError:
        raise _no_library(node) from None
    _warn(guarded, node, pen)
    return lines


def _warn(guarded: GuardedFile, node: Quoted, pen: Pen) -> None:
    """Says what of the file is not drawn, or not as it stands there."""
    if guarded.left_out:
        message = f"left out of {node.text}: {_counted(guarded.left_out)}"
        pen.warn("W420", message, node.span, "", _said(guarded))
    if guarded.passed_over:
        some = "; ".join(guarded.passed_over[:MOST_SAID])
        more = len(guarded.passed_over) - MOST_SAID
        message = f"passed over in {node.text}, as SVG says: {some}"
        label = f"and {more} more" if more > 0 else ""
        cure = "mend it in the file, or leave it: browsers draw it so, too"
        pen.warn("W421", message, node.span, label, cure)
    if guarded.otherwise:
        names = sorted(guarded.otherwise)
        message = f"drawn otherwise than in {node.text}: {_counted(guarded.otherwise)}"
        cure = "; ".join(dict.fromkeys(_OTHERWISE.get(name, _WHOLE) for name in names))
        pen.warn("W422", message, node.span, "", cure)


def _counted(found: Lines) -> str:
    """`2 text (from line 3)`, of each kind."""
    return ", ".join(
        f"{len(at)} {name} ({'from ' if len(at) > 1 else ''}line {at[0]})"
        for name, at in sorted(found.items())
    )


@lru_cache(maxsize=4)  # as in a `repeat`
def _read(data: bytes) -> Drawing:
    guarded = guard(data)
    lines = list(_lines(guarded))
    if not lines:
        raise SvgError("there are no lines in it", _said(guarded))
    ordered = [Line(chain, colour) for chain, colour in stroke_order.in_order(lines)]
    return Drawing(ordered, replace(guarded, xml=b"", paths=[]))


def _said(guarded: GuardedFile) -> str:
    cures = []
    if set(guarded.left_out) - {"image"}:
        cures.append("in the program it was made with, convert texts to paths")
    if "image" in guarded.left_out:
        cures.append("trace an image to paths, or draw without it")
    return "; ".join(cures) or "only paths and shapes are drawn"


def _no_library(node: Quoted) -> Problem:
    message = "reading SVG needs the package svgelements, which is not installed"
    return problem("E297", message, node.span, "", 'pip install "dqpaint[svg]"')


def _lines(guarded: GuardedFile) -> Iterator[tuple[Chain, Colour | None]]:
    import svgelements

    pieces, transforms, lights = paths.Pieces(), array("d"), []
    try:
        drawing = svgelements.SVG.parse(io.BytesIO(guarded.xml), reify=False, ppi=96.0)
        paper = float(drawing.width), float(drawing.height)
        for shape in drawing.elements():
            if not isinstance(shape, svgelements.Shape):
                continue
            if _is_seen(shape) and not _is_paper(shape, paper):
                pieces.begin()
                if isinstance(shape, svgelements.Path):
                    paths.draw_path(pieces, guarded.paths[int(shape.values[NUMBER])])
                else:
                    _DRAW[type(shape).__name__](pieces, shape)
                m = shape.transform
                transforms.extend((m.a, m.b, m.c, m.d, m.e, m.f))
                lights.append(_colour(shape))
    except SvgError:
        raise
    except Exception as fault:  # of many kinds: the library takes much on trust
        raise SvgError("the SVG library can't read it", "save it as plain SVG") from fault
    found = list(pieces.lines(*_in_metres(np.array(transforms).reshape(-1, 3, 2))))
    if found and not piecewise.farthest([chain for _, chain in found]) <= LARGEST * PIXEL:
        raise SvgError("a place in it is not finite, or far too large")
    return ((chain, lights[number]) for number, chain in found)


def _in_metres(transforms: Floats) -> tuple[Floats, Floats]:
    """The matrices (K, 3, 3) and shifts (K, 3) of transforms (K, 3, 2), y up and in metres."""
    matrices, shifts = np.zeros((len(transforms), 3, 3)), np.zeros((len(transforms), 3))
    flipped = PIXEL * np.array([1.0, -1.0])
    with np.errstate(over="ignore", invalid="ignore"):  # looked for where it is drawn
        matrices[:, :2, :2] = transforms[:, :2].transpose(0, 2, 1) * flipped[:, None]
        shifts[:, :2] = transforms[:, 2] * flipped
    return matrices, shifts


# Colours.


def _is_seen(shape: Any) -> bool:
    if shape.values.get("visibility") in ("hidden", "collapse"):
        return False
    return any(paint.value is not None and paint.alpha for paint in (shape.stroke, shape.fill))


def _colour(shape: Any) -> Colour | None:
    """The stroke's colour, else the filling's; None for black, which can't shine."""
    paint = shape.stroke if shape.stroke.value is not None else shape.fill
    red, green, blue = (colours.linear(c / 255) for c in (paint.red, paint.green, paint.blue))
    if max(red, green, blue) < DARKEST:
        return None
    return colours.dimmed((red, green, blue), paint.alpha / 255)


def _is_paper(shape: Any, paper: tuple[float, float]) -> bool:
    """Whether it is a filled rectangle as large as the drawing, to draw upon."""
    if type(shape).__name__ != "Rect" or shape.stroke.value is not None:
        return False
    box = [float(side) for side in shape.bbox()]
    slack = 0.01 * max(paper)
    return (
        max(box[0], box[1]) <= slack and box[2] >= paper[0] - slack and box[3] >= paper[1] - slack
    )


# Shapes.


def _draw_line(pieces: Pieces, shape: Any) -> None:
    paths.draw_line(pieces, (shape.x1, shape.y1), (shape.x2, shape.y2))


def _draw_ellipse(pieces: Pieces, shape: Any) -> None:
    paths.draw_ellipse(pieces, (shape.cx, shape.cy), shape.rx, shape.ry)


def _draw_rectangle(pieces: Pieces, shape: Any) -> None:
    size = shape.width, shape.height
    paths.draw_rectangle(pieces, shape.x, shape.y, size, shape.rx, shape.ry)


_DRAW = {
    "SimpleLine": _draw_line,
    "Circle": _draw_ellipse,
    "Ellipse": _draw_ellipse,
    "Rect": _draw_rectangle,
}
