"""SVG elements -> tree of drawable nodes with all attributes parsed.

A number, a path or a transform that can't be read is an error with its line: another shape than
was meant is worse than none. What SVG itself ignores (an invalid colour, a `use` without a target)
is ignored as well, and reported.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from dqpaint.language.imports.svg import values
from dqpaint.language.imports.svg.guard import LESS, SHAPES, Element, by_ids
from dqpaint.language.imports.svg.style_sheets import TooManyRulesError, inline
from dqpaint.language.imports.svg.values import (
    Commands,
    Length,
    Matrix,
    Paint,
    SvgError,
    UnreadableError,
)

Lines = dict[str, list[int]]  # line numbers in the file, by name

VIEWPORTS = ("svg", "symbol")
PLACED = ("use", *VIEWPORTS)
_LENGTHS: Mapping[str, Callable[[str], Any]] = {
    **dict.fromkeys(("x", "y", "x1", "y1", "x2", "y2", "cx", "cy"), values.length),
    **dict.fromkeys(("width", "height", "rx", "ry"), values.size_or_auto),
    "r": values.size,
}
_READERS: Mapping[str, Callable[[str], Any]] = {
    **_LENGTHS,
    "d": values.path,
    "points": values.points,
    "viewBox": values.view_box,
    "transform": values.transform,
}
_READ = {  # the attributes that are read, of all elements the transform
    "path": ("d",),
    **dict.fromkeys(("polyline", "polygon"), ("points",)),
    "line": ("x1", "y1", "x2", "y2"),
    "rect": ("x", "y", "width", "height", "rx", "ry"),
    "circle": ("cx", "cy", "r"),
    "ellipse": ("cx", "cy", "rx", "ry"),
    "use": ("x", "y", "width", "height"),
    **dict.fromkeys(VIEWPORTS, ("x", "y", "width", "height", "viewBox")),
}
_SIDES = {"rect": 2, "circle": 1, "ellipse": 1, **dict.fromkeys(VIEWPORTS, 0)}  # required sizes
_NOWHERE = ("defs", "clipPath", "mask", "pattern", "marker")  # nor is a symbol in its own position
_MISSED = ("text", "image", "foreignObject", "flowRoot")
_NO_LINES = (
    *(*_MISSED, "linearGradient", "radialGradient"),
    *("style", "script", "video", "audio", "canvas"),
)
_PAINTS = ("stroke", "fill", "color")
_OPACITIES = ("stroke-opacity", "fill-opacity", "opacity")
_INHERITED = ("inherit", "context-stroke", "context-fill", "")
_HIDDEN = {"hidden": True, "collapse": True, "visible": False}
_CURE = "mend it, or save the drawing as plain SVG in the program it was made with"
_NOT_FOLLOWED = ("clip-path", "mask", "stroke-dasharray", "transform-origin")
STYLED = frozenset((
    *(*_PAINTS, *_OPACITIES, *_NOT_FOLLOWED, *_LENGTHS),
    *("stop-color", "transform", "display", "visibility"),
))  # fmt: skip


class Style(NamedTuple):
    """The inherited style of an element; opacities multiply."""

    color: Paint = values.BLACK
    stroke: Paint = None
    fill: Paint = values.BLACK
    stroke_opacity: float = 1.0
    fill_opacity: float = 1.0
    opacity: float = 1.0
    hidden: bool = False


@dataclass(eq=False, slots=True)
class Node:
    """A drawable element.

    Attributes:
        tag: without its namespace.
        transform: its own.
        outline: of a path or a polygon.
        box: its view box; empty without one.
        ratio: alignment of the view box in its viewport.
        lengths: its position and its size, as far as given.
        own_style: its own style attributes.
        shown: whether it is visible.
        children: its visible children, or the target of a `use`.
    """

    tag: str
    transform: Matrix
    outline: Commands
    box: list[float]
    ratio: str
    lengths: dict[str, Length]
    own_style: dict[str, Any]
    shown: bool = True
    children: list["Node"] = field(default_factory=list)


@dataclass
class Notes:
    """The parts of a drawing that are ignored or drawn differently.

    Attributes:
        left_out: ignored texts, images ..., with their lines.
        otherwise: elements drawn differently from SVG, with their lines.
        passed_over: what SVG itself ignores, each with its line.
    """

    left_out: Lines = field(default_factory=dict)
    otherwise: Lines = field(default_factory=dict)
    passed_over: list[str] = field(default_factory=list)


def read(root: Element) -> tuple[Node, Notes]:
    """A drawing with all its attributes, and its ignored parts.

    Raises:
        SvgError: an attribute can't be read, or the drawing has no size.
    """
    reader = _Reader(root)
    try:
        inline(root, STYLED, reader.remark)
    except TooManyRulesError:
        raise SvgError("its style has too many rules for so many elements", LESS) from None
    made = reader.tree(root)
    if not _has_size(made, "svg"):
        help = "give its viewBox the width and height of what it shows, or take it away"
        raise SvgError(f"line {root.line}: it has no size, so SVG shows nothing of it", help)
    return made, reader.notes


def _is_hidden(element: Element) -> bool:
    return "}" in element.tag or element.has.get("display", "").strip() == "none"


def _has_size(node: Node, tag: str) -> bool:
    """Whether a shape or a viewport has a non-zero size; SVG shows nothing of one without."""
    names = ("rx", "ry") if tag == "ellipse" else ("width", "height", "r")
    sides = [node.lengths[name] for name in names if name in node.lengths]
    return tag not in _SIDES or (
        len(sides) >= _SIDES[tag] and all(map(any, sides)) and all(node.box[2:])
    )


class _Reader:
    """Reads the elements of a drawing."""

    def __init__(self, root: Element) -> None:
        self._by_id = by_ids(root)
        self._nodes: dict[Element, Node] = {}
        self._uses: list[tuple[Node, Element]] = []
        self.notes = Notes()

    def remark(self, element: Element, text: str) -> None:
        """Records an attribute that is ignored, as SVG demands."""
        self.notes.passed_over.append(f"line {element.line}: {text}")

    def tree(self, root: Element) -> Node:
        """An element and its visible descendants, with style sheets resolved to attributes.

        Raises:
            SvgError: an attribute can't be read.
        """
        made = self._node(root)
        for use, target in self._uses:  # their content is not visible in its own position
            if not _is_hidden(target) and target.tag not in (*_NO_LINES, *_NOWHERE):
                use.children.append(self._nodes.get(target) or self._node(target))
        return made

    def _node(self, element: Element) -> Node:
        """An element and its visible descendants."""
        tag, has = element.tag, element.has
        names = [name for name in (*_READ.get(tag, ()), "transform") if name in has]
        read = {name: self._read(element, name) for name in names}
        node = self._nodes[element] = Node(
            tag,
            read.pop("transform", values.IDENTITY),
            read.pop("d", None) or read.pop("points", []),
            read.pop("viewBox", []),
            has.get("preserveAspectRatio", ""),
            {name: length for name, length in read.items() if length is not None},
            self._style(element),
        )
        for name in _NOT_FOLLOWED:
            if has.get(name, "none").strip() not in ("none", "", "0"):
                self._not_followed(element, name)
        if tag == "use":
            self._follow(element, node)
        elif tag not in SHAPES:
            self._enter(element, node)
        self._show(element, node)
        return node

    def _read(self, element: Element, name: str) -> Any:
        try:
            return _READERS[name](element.has[name])
        except UnreadableError as fault:
            where = f"line {element.line}: {name} of a <{element.tag}>"
            raise SvgError(f"{where}: {fault}", _CURE) from None

    def _style(self, element: Element) -> dict[str, Any]:
        """The fields of Style set by an element, and its own opacity."""
        made: dict[str, Any] = {}
        for name in (*_PAINTS, *_OPACITIES):
            text = element.has.get(name, "inherit").strip()
            try:
                if name in _OPACITIES and name in element.has:
                    made[name.replace("-", "_")] = values.opacity(text)
                elif text not in _INHERITED and (name, text.lower()) != ("color", "currentcolor"):
                    made[name] = self._paint(element, name, text)
            except UnreadableError as fault:
                self.remark(element, f"{name}: {fault}")
        visibility = element.has.get("visibility", "").strip()
        if visibility in _HIDDEN:
            made["hidden"] = _HIDDEN[visibility]
        return made

    def _paint(self, element: Element, name: str, text: str) -> Paint:
        """A gradient becomes its mean colour; patterns and missing references are ignored."""
        link = values.reference(text)
        if link is None:
            return values.paint(text)
        id_, instead = link
        target = self._by_id.get(f"#{id_}")
        if target is None:
            self.remark(element, f"{name}: there is no '{id_[:24]}' in the file")
            return values.paint(instead) if instead.strip() else None
        stops = self._stops(target, 0)
        self._not_followed(element, "gradient" if stops else target.tag)
        return values.mean(stops)

    def _stops(self, gradient: Element, depth: int) -> list[Paint]:
        """The colours of a gradient, or of the gradient it refers to."""
        stops = [stop for stop in gradient.children if stop.tag == "stop"]
        other = self._by_id.get(gradient.link)
        if not stops and depth < 8 and other is not None:
            return self._stops(other, depth + 1)
        made = []
        for stop in stops:
            try:
                made.append(values.paint(stop.has.get("stop-color", "black")))
            except UnreadableError as fault:
                self.remark(stop, f"stop-color: {fault}")
        return made

    def _show(self, element: Element, node: Node) -> None:
        """Determines whether an element or its children are visible."""
        a, b, c, d, _, _ = node.transform
        target = self._by_id.get(element.link)
        used = node.tag == "use" and target is not None and target.tag in VIEWPORTS
        if not _has_size(node, "svg" if used else node.tag):
            article = "an" if node.tag in ("ellipse", "svg") else "a"
            self.remark(element, f"{article} <{node.tag}> without a size")
            node.shown = False
        elif a * d == b * c:
            self.remark(element, "a transform that leaves nothing to see")
            node.shown = False

    def _follow(self, use: Element, node: Node) -> None:
        """Resolves a `use`; SVG draws nothing where its target does not exist."""
        link, target = use.link, self._by_id.get(use.link)
        if target is not None:
            self._uses.append((node, target))
        elif not link:
            self.remark(use, "a <use> of nothing")
        elif not link.startswith("#"):
            self.remark(use, "a <use> of another file")
        else:
            self.remark(use, f"there is no {values.shown(link[1:])} to be used")

    def _enter(self, element: Element, node: Node) -> None:
        """Reads the children of an element."""
        for child in element.children:
            tag = child.tag
            if _is_hidden(child):
                continue
            if tag in _MISSED:
                self.notes.left_out.setdefault(tag, []).append(child.line)
            if tag not in _NO_LINES:
                made = self._node(child)
                if tag not in (*_NOWHERE, "symbol"):
                    node.children.append(made)
                if node.tag == "switch":
                    return

    def _not_followed(self, element: Element, name: str) -> None:
        self.notes.otherwise.setdefault(name, []).append(element.line)
