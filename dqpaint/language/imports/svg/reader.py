"""SVG drawing -> coloured curves in metres, x to the right and y up.

Arcs stay arcs and Bezier curves Bezier curves, whatever transforms they stand under.
"""

from array import array
from collections import defaultdict
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from dqpaint.diagnostics import problem
from dqpaint.language.imports import stroke_order
from dqpaint.language.imports.file_access import contents
from dqpaint.language.imports.stroke_order import ColouredCurve
from dqpaint.language.imports.svg import attributes, nested_svg, paths, values
from dqpaint.language.imports.svg.attributes import PLACED, Lines, Node, Notes, Style
from dqpaint.language.imports.svg.guard import MOST_BYTES, SHAPES, guard
from dqpaint.language.imports.svg.nested_svg import View
from dqpaint.language.imports.svg.paths import Pieces
from dqpaint.language.imports.svg.values import LARGEST, Commands, Length, Matrix, Paint, SvgError
from dqpaint.language.pen.pen import Pen
from dqpaint.language.syntax.tree import Quoted
from dqpaint.program import Colour, Floats, colours, piecewise

PIXEL = 0.0254 / 96.0  # [m] as CSS has it
DARKEST = 0.02  # of linear light: what is darker is ink, not a colour of light
MOST_SAID = 3  # of what was passed over
_WHOLE = "what a clip or a mask would hide is drawn, too"
_OTHERWISE = {
    "stroke-dasharray": "dashes are drawn as whole lines",
    "gradient": "a gradient is drawn in its mean colour",
    "pattern": "a pattern is drawn in the light that holds",
    "transform-origin": "transforms are about the origin: write the place into the transform",
}


class State(NamedTuple):
    """What a shape inherits from its ancestors."""

    matrix: Matrix
    view: View
    style: Style
    sizes: dict[str, Length]  # of the `use` that shows it, which go before its own


class Drawing(NamedTuple):
    """Lines, and by how much the dark ways between them are shorter than as drawn [m]."""

    lines: list[ColouredCurve]
    saved: float


def read(node: Quoted, pen: Pen, as_drawn: bool = False) -> Drawing:
    """The lines of a drawing, ordered for short moves between them, or as they are drawn."""
    data = contents(node, pen, MOST_BYTES)
    try:
        drawing, notes = _read(data, as_drawn)
    except SvgError as fault:
        message = f"can't draw {node.text}: {fault.message}"
        raise problem("E298", message, node.span, "", fault.help) from None
    _warn(notes, node, pen)
    return drawing


def _warn(notes: Notes, node: Quoted, pen: Pen) -> None:
    """Warns of parts of the file that are ignored or drawn differently."""
    if notes.left_out:
        message = f"left out of {node.text}: {_counted(notes.left_out)}"
        pen.warn("W420", message, node.span, "", _fix(notes))
    if notes.passed_over:
        some = "; ".join(notes.passed_over[:MOST_SAID])
        more = len(notes.passed_over) - MOST_SAID
        message = f"passed over in {node.text}, as SVG says: {some}"
        label = f"and {more} more" if more > 0 else ""
        help = "mend it in the file, or leave it: browsers draw it so, too"
        pen.warn("W421", message, node.span, label, help)
    if notes.otherwise:
        names = sorted(notes.otherwise)
        message = f"drawn otherwise than in {node.text}: {_counted(notes.otherwise)}"
        help = "; ".join(dict.fromkeys(_OTHERWISE.get(name, _WHOLE) for name in names))
        pen.warn("W422", message, node.span, "", help)


def _counted(found: Lines) -> str:
    """`2 text (from line 3)`, of each kind."""
    return ", ".join(
        f"{len(at)} {name} ({'from ' if len(at) > 1 else ''}line {at[0]})"
        for name, at in sorted(found.items())
    )


@lru_cache(maxsize=4)  # as in a `repeat`
def _read(data: bytes, as_drawn: bool) -> tuple[Drawing, Notes]:
    root, notes = attributes.read(guard(data))
    lines = list(_lines(root))
    if not lines:
        raise SvgError("there are no lines in it", _fix(notes))
    drawn = stroke_order.as_drawn(lines)
    ordered = drawn if as_drawn else stroke_order.order_lines(lines)
    return Drawing(ordered.lines, drawn.dark - ordered.dark), notes


def _fix(notes: Notes) -> str:
    cures = []
    if set(notes.left_out) - {"image"}:
        cures.append("in the program it was made with, convert texts to paths")
    if "image" in notes.left_out:
        cures.append("trace an image to paths, or draw without it")
    return "; ".join(cures) or "only paths and shapes are drawn"


def _lines(root: Node) -> Iterator[ColouredCurve]:
    pieces, transforms, lights = Pieces(), array("d"), []
    paper = nested_svg.paper(root)
    for node, state in _shapes(root, paper):
        at = _measured(node, state.view)
        stroke, fill = _paints(state.style)
        paint = stroke or (None if _is_paper(at, state.matrix, paper) else fill)
        if paint:
            pieces.begin()
            _draw(pieces, node, at)
            transforms.extend(state.matrix)
            lights.append(_colour(paint))
    found = list(pieces.lines(*_in_metres(np.array(transforms).reshape(-1, 3, 2))))
    if found and not piecewise.largest_coordinate([curve for _, curve in found]) <= LARGEST * PIXEL:
        raise SvgError("a place in it is not finite, or far too large")
    return ((curve, lights[number]) for number, curve in found)


def _shapes(root: Node, paper: View) -> Iterator[tuple[Node, State]]:
    """The shapes of a drawing in document order, those of a `use` at each of its positions."""
    whole = {"x": 0.0, "y": 0.0, **paper._asdict()}
    sizes = {name: Length(pixels) for name, pixels in whole.items()}
    todo = [(root, State(values.IDENTITY, paper, Style(), sizes))]
    while todo:
        node, around = todo.pop()
        if node.shown:
            state = _inside(node, around)
            if node.tag in SHAPES:
                yield node, state
            todo.extend((child, state) for child in reversed(node.children))


def _inside(node: Node, around: State) -> State:
    """The state of a node and its descendants."""
    matrix, view, style, sizes = around
    matrix = values.times(matrix, node.transform)
    if node.own_style:
        opacity = node.own_style.get("opacity", 1.0) * style.opacity
        style = style._replace(**{**node.own_style, "opacity": opacity})
    if node.tag in PLACED:
        placed, within = nested_svg.placed(node, view, sizes)
        matrix = values.times(matrix, placed)
        view = view if node.tag == "use" else within
    names = View._fields if node.tag == "use" else ()
    sizes = {name: node.lengths[name] for name in names if name in node.lengths}
    return State(matrix, view, style, sizes)


def _in_metres(transforms: Floats) -> tuple[Floats, Floats]:
    """The matrices (K, 3, 3) and shifts (K, 3) of transforms (K, 3, 2), y up and in metres."""
    matrices, shifts = np.zeros((len(transforms), 3, 3)), np.zeros((len(transforms), 3))
    flipped = PIXEL * np.array([1.0, -1.0])
    with np.errstate(over="ignore", invalid="ignore"):  # looked for where it is drawn
        matrices[:, :2, :2] = transforms[:, :2].transpose(0, 2, 1) * flipped[:, None]
        shifts[:, :2] = transforms[:, 2] * flipped
    return matrices, shifts


# Colours.


def _paints(style: Style) -> tuple[Paint, Paint]:
    """The visible stroke and fill colours, with all opacities."""
    if style.hidden:
        return None, None
    stroke = _visible_colour(style.stroke, style.stroke_opacity, style)
    return stroke, _visible_colour(style.fill, style.fill_opacity, style)


def _visible_colour(paint: Paint, own: float, style: Style) -> Paint:
    paint = style.color if paint == values.CURRENT else paint
    alpha = round(255 * (own * style.opacity * (paint[3] / 255))) if paint else 0
    return paint[:3] + bytes([alpha]) if paint and alpha else None


def _colour(paint: bytes) -> Colour | None:
    """The colour of light; None for black, which can't shine."""
    red, green, blue = (colours.linear(channel / 255) for channel in paint[:3])
    if max(red, green, blue) < DARKEST:
        return None
    return colours.dim((red, green, blue), paint[3] / 255)


def _is_paper(at: Mapping[str, float], matrix: Matrix, paper: View) -> bool:
    """Whether a shape is a background: a rectangle as large as the drawing, below all else."""
    a, b, c, d, e, f = matrix
    sides = ((at["x"], at["x"] + at["width"]), (at["y"], at["y"] + at["height"]))
    corners = [(a * x + c * y + e, b * x + d * y + f) for x in sides[0] for y in sides[1]]
    least, most = (tuple(map(of, zip(*corners, strict=True))) for of in (min, max))
    slack = 0.01 * max(paper)
    far = all(side >= whole - slack for side, whole in zip(most, paper, strict=True))
    return far and max(least) <= slack


# Shapes.


def _draw(pieces: Pieces, node: Node, at: Mapping[str, float]) -> None:
    if node.tag == "line":
        paths.draw_line(pieces, (at["x1"], at["y1"]), (at["x2"], at["y2"]))
    elif node.tag == "rect":
        size = at["width"], at["height"]
        paths.draw_rectangle(pieces, at["x"], at["y"], size, at["rx"], at["ry"])
    elif node.tag in ("circle", "ellipse"):
        paths.draw_ellipse(pieces, (at["cx"], at["cy"]), at["rx"], at["ry"])
    else:
        closed: Commands = [("Z", [])] if node.tag == "polygon" and node.outline else []
        paths.draw_path(pieces, node.outline + closed)


def _measured(node: Node, view: View) -> Mapping[str, float]:
    """The lengths of a shape [px]; 0 for missing ones."""
    at = defaultdict(float, {n: view.pixels(n, length) for n, length in node.lengths.items()})
    at["rx"] = at.get("rx", at.get("ry", at["r"]))
    at["ry"] = at.get("ry", at["rx"])
    return at
