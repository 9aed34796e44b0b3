"""The guard before the SVG library: what it may be given, and what it would draw by mistake.

A drawing of 2 kB can ask for 10^30 circles by `use` within `use`; such files, and those that nest
too deep, go in circles or declare entities, are refused before anything is expanded. What SVG does
not show where it stands (symbols, masks, markers ...) is put into `defs`, what is no line is left
out and counted.
"""

import re
from collections import Counter
from dataclasses import dataclass, field
from xml.etree import ElementTree
from xml.parsers import expat

MOST_BYTES = 10_000_000
MOST_ELEMENTS = 100_000  # as they are written, and as they come by `use`
MOST_NUMBERS = 1_000_000  # of paths and polygons, as they come by `use`
MOST_SHAPES = 25_000  # each of them a stroke, and a way to it
DEEPEST = 200  # elements and uses within each other

_HIDDEN = ("clipPath", "mask", "pattern", "marker", "symbol")  # shown only by reference, if at all
_NO_LINES = ("text", "image", "foreignObject", "flowRoot", "script", "video", "audio", "canvas")
_SAID = ("text", "image", "foreignObject", "flowRoot")  # of these a person misses the loss
_LINK = ("href", "{http://www.w3.org/1999/xlink}href")
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_LENGTH = re.compile(rf"({_NUMBER.pattern})\s*([a-zA-Z]*)")
_DISPLAY = re.compile(r"(?:^|;)\s*display\s*:\s*none\s*(?:;|$|!)")

_LESS = "draw a part of it, or make it simpler"

_SHAPES = ("path", "line", "polyline", "polygon", "rect", "circle", "ellipse")

Element = ElementTree.Element
Counts = tuple[int, int, int, int]  # elements, shapes, numbers, depth


class SvgError(Exception):
    """Why a drawing is not drawn, and what would help."""

    def __init__(self, message: str, cure: str = "") -> None:
        super().__init__(message)
        self.message, self.cure = message, cure


@dataclass
class Guarded:
    """A drawing that may be read: its text, and how many texts and images were left out."""

    xml: bytes
    left_out: Counter[str] = field(default_factory=Counter)


def guard(data: bytes) -> Guarded:
    """A drawing without what does not belong to its lines.

    Raises:
        SvgError: it is no SVG, or too much of it.
    """
    root = _tree(data)
    if _name(root) != "svg":
        raise SvgError(f"this is no SVG: it begins with <{_name(root)[:40]}>")
    _Count(root).check()
    out = Guarded(b"")
    _size(root)
    _clean(root, out.left_out)
    out.xml = ElementTree.tostring(root, encoding="utf-8")
    return out


def _name(element: Element) -> str:
    """The tag without its namespace."""
    return str(element.tag).rpartition("}")[2]


def _tree(data: bytes) -> Element:
    """The elements of a file; stops at the first that is too many."""
    builder = ElementTree.TreeBuilder()
    parser = expat.ParserCreate(namespace_separator="}")
    depth = count = 0

    def tag(name: str) -> str:
        return f"{{{name}" if "}" in name else name

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if depth > DEEPEST:
            raise SvgError(f"more than {DEEPEST} elements within each other")
        if count > MOST_ELEMENTS:
            raise SvgError(f"more than {MOST_ELEMENTS:,} elements", _LESS)
        builder.start(tag(name), {tag(key): value for key, value in attributes.items()})

    def end(name: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(tag(name))

    def entity(*_details: object) -> None:
        raise SvgError(
            "it declares entities of its own, which is refused",
            "save it as plain SVG in the program it was made with",
        )

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = builder.data
    parser.EntityDeclHandler = entity
    parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
    try:
        parser.Parse(data, True)
    except expat.ExpatError as fault:
        what = expat.errors.messages.get(fault.code, "")
        reason = what or str(fault)
        raise SvgError(f"line {fault.lineno}: {reason}", "it is not well-formed XML") from None
    except (ValueError, LookupError) as fault:  # of an encoding that is none
        raise SvgError(str(fault)[:80]) from None
    return builder.close()


class _Count:
    """How much a drawing is once every `use` is expanded, without expanding one."""

    def __init__(self, root: Element) -> None:
        self._root = root
        self._by_id = {e.attrib["id"]: e for e in root.iter() if "id" in e.attrib}
        self._known: dict[Element, Counts] = {}
        self._open: set[Element] = set()

    def check(self) -> None:
        """Raises if it is too much."""
        elements, shapes, numbers, _ = self._of(self._root, 1)
        if elements > MOST_ELEMENTS:
            raise SvgError(f"with every 'use' it has {_shown(elements)} elements", _LESS)
        if shapes > MOST_SHAPES:
            raise SvgError(f"it has {shapes:,} shapes, more than {MOST_SHAPES:,}", _LESS)
        if numbers > MOST_NUMBERS:
            raise SvgError(f"with every 'use' its paths have {_shown(numbers)} numbers", _LESS)

    def _of(self, element: Element, depth: int) -> Counts:
        """Of an element with all below it."""
        known = self._known.get(element)
        if known is None:
            if element in self._open:
                name = element.attrib.get("id", "")[:40]
                raise SvgError(f"'{name}' uses itself")
            if depth > DEEPEST:
                raise SvgError(f"more than {DEEPEST} elements within each other by 'use'")
            self._open.add(element)
            known = self._counted(element, depth)
            self._open.discard(element)
            self._known[element] = known
        if depth + known[3] > DEEPEST + 1:
            raise SvgError(f"more than {DEEPEST} elements within each other by 'use'")
        return known

    def _counted(self, element: Element, depth: int) -> Counts:
        below = list(element)
        if _name(element) == "use":
            links = [element.attrib[key] for key in _LINK if key in element.attrib]
            below += [self._by_id[k[1:]] for k in links[:1] if k[1:] in self._by_id]
        paths = element.attrib.get("d", ""), element.attrib.get("points", "")
        elements, shapes, deepest = 1, int(_name(element) in _SHAPES), 0
        numbers = sum(len(_NUMBER.findall(path)) for path in paths)
        for other in below:
            *more, deep = self._of(other, depth + 1)
            elements, shapes, numbers = elements + more[0], shapes + more[1], numbers + more[2]
            deepest = max(deepest, deep)
        return elements, shapes, numbers, deepest + 1


def _shown(count: int) -> str:
    return f"{count:,}" if count < 10**9 else f"about 10^{len(str(count)) - 1}"


def _clean(parent: Element, left_out: Counter[str]) -> None:
    """Takes away what is not drawn, and hides what is drawn only by reference."""
    kept: list[Element] = []
    for child in parent:
        name, hidden = _name(child), _is_hidden(child)
        if name in _NO_LINES or hidden:
            left_out.update([name] if name in _SAID and not hidden else [])
            continue
        _clean(child, left_out)
        if name in _HIDDEN and _name(parent) != "defs":
            shelf = Element(str(child.tag).replace(name, "defs"))
            shelf.append(child)
            child = shelf
        kept.append(child)
    if _name(parent) == "switch":
        del kept[1:]
    parent[:] = kept


def _size(root: Element) -> None:
    """A width or a height that is not said follows from the view box, as browsers have it."""
    said = {key: root.attrib[key] for key in ("width", "height") if key in root.attrib}
    said = {key: value for key, value in said.items() if "%" not in value}
    box = [float(number) for number in _NUMBER.findall(root.attrib.get("viewBox", ""))]
    if len(box) != 4 or not all(0.0 < side < 1e9 for side in box[2:]) or len(said) == 2:
        return
    for key, side, other in (("width", box[2], box[3]), ("height", box[3], box[2])):
        if key in said:
            continue
        root.attrib[key] = repr(side)
        for value in said.values():  # the other one, with its unit
            if match := _LENGTH.fullmatch(value.strip()):
                root.attrib[key] = f"{float(match[1]) * side / other!r}{match[2]}"


def _is_hidden(element: Element) -> bool:
    if element.attrib.get("display", "").strip() == "none":
        return True
    return bool(_DISPLAY.search(element.attrib.get("style", "")))
