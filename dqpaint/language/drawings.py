"""SVG drawings -> chains with their colours, in metres, x to the right and y up.

The only door to the SVG library, which is an extra: `pip install "dqpaint[svg]"`. Arcs stay arcs
and Bezier curves Bezier curves, whatever transforms they stand under.
"""

import io
import math
from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from dqpaint.language import chains, colours, routes
from dqpaint.language.beside import contents
from dqpaint.language.diagnostics import Problem, problem
from dqpaint.language.pen import Pen
from dqpaint.language.program import Chain, Colour
from dqpaint.language.svgtree import MOST_BYTES, Guarded, Lines, guard
from dqpaint.language.svgvalues import LARGEST, SvgError
from dqpaint.language.syntax import Quoted
from dqpaint.language.taylor import Floats

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
    guarded: Guarded


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


def _warn(guarded: Guarded, node: Quoted, pen: Pen) -> None:
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
    ordered = [Line(chain, colour) for chain, colour in routes.in_order(lines)]
    return Drawing(ordered, replace(guarded, xml=b""))


def _said(guarded: Guarded) -> str:
    cures = []
    if set(guarded.left_out) - {"image"}:
        cures.append("in the program it was made with, convert texts to paths")
    if "image" in guarded.left_out:
        cures.append("trace an image to paths, or draw without it")
    return "; ".join(cures) or "only paths and shapes are drawn"


def _no_library(node: Quoted) -> Problem:
    message = "reading SVG needs the package svgelements, which is not installed"
    return problem("E297", message, node.span, "", 'pip install "dqpaint[svg]"')


def _lines(guarded: Guarded) -> Iterator[tuple[Chain, Colour | None]]:
    import svgelements

    try:
        drawing = svgelements.SVG.parse(io.BytesIO(guarded.xml), reify=False, ppi=96.0)
        paper = float(drawing.width), float(drawing.height)
        for shape in drawing.elements():
            if not isinstance(shape, svgelements.Shape):
                continue
            if _is_seen(shape) and not _is_paper(shape, paper):
                yield from ((chain, _colour(shape)) for chain in _chains(shape))
    except SvgError:
        raise
    except Exception as fault:  # of many kinds: the library takes much on trust
        raise SvgError("the SVG library can't read it", "save it as plain SVG") from fault


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


# Lines.


def _chains(shape: Any) -> Iterator[Chain]:
    """The parts of a shape that are drawn without lifting the pen."""
    m = shape.transform
    matrix = np.array([[m.a, m.c, 0.0], [m.b, m.d, 0.0], [0.0, 0.0, 1.0]], dtype=np.float64)
    shift = np.array([m.e, m.f, 0.0], dtype=np.float64)
    to_metres = PIXEL * np.diag([1.0, -1.0, 1.0])
    for pieces in _parts(shape):
        chain = chains.mapped(chains.joined(pieces), to_metres @ matrix, to_metres @ shift)
        if not chains.farthest([chain]) <= LARGEST * PIXEL:
            raise SvgError("a place in it is not finite, or far too large")
        if chain.cubic[:, 1:].any() or chain.ellipse.any():
            yield chain


def _parts(shape: Any) -> Iterator[list[Chain]]:
    pieces: list[Chain] = []
    for segment in shape.segments(transformed=False):
        kind = type(segment).__name__
        if kind == "Move":
            if pieces:
                yield pieces
            pieces = []
            continue
        made = _piece(kind, segment)
        if made is not None:
            pieces.append(made)
    if pieces:
        yield pieces


def _piece(kind: str, segment: Any) -> Chain | None:
    """One segment of a path; None for what has no length."""
    names = {
        "QuadraticBezier": ("start", "control", "end"),
        "CubicBezier": ("start", "control1", "control2", "end"),
    }.get(kind, ("start", "end"))
    if segment.start is None or segment.end is None:
        return None
    points = np.array([_point(getattr(segment, name)) for name in names])
    size = float(np.abs(points - points[0]).max())
    if kind == "Arc":
        made = _arc(segment, points)
        if made is not None:
            return made
    if not size > 1e-12 * max(1.0, float(np.abs(points).max())):
        return None if math.isfinite(size) else chains.straight(points)
    return chains.bezier(points) if len(points) > 2 else chains.straight(points)


def _point(point: Any) -> tuple[float, float, float]:
    return float(point.x), float(point.y), 0.0


def _arc(segment: Any, points: Floats) -> Chain | None:
    """An arc of an ellipse; None for one without radii, which SVG draws straight."""
    rx, ry, sweep = float(segment.rx), float(segment.ry), float(segment.sweep)
    if not (rx > 0.0 and ry > 0.0 and sweep):
        return None
    turn = segment.get_rotation().as_radians
    c, s = math.cos(turn), math.sin(turn)
    u, v = np.array([rx * c, rx * s, 0.0]), np.array([-ry * s, ry * c, 0.0])
    centre = np.array(_point(segment.center))
    arm = points[0] - centre
    start = math.atan2(float(arm @ v) / ry**2, float(arm @ u) / rx**2)
    return chains.arc(centre, u, v, start, sweep)
