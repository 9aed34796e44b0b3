"""Bytes of an SVG drawing -> its elements, or an error where it is too large.

A drawing of 2 kB can ask for 10^30 circles by `use` within `use`; such files, and those that nest
too deep, go in circles or declare entities, are refused before anything is expanded.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from xml.parsers import expat

from dqpaint.language.imports.svg.values import NUMBER, SvgError

MOST_BYTES = 10_000_000
MOST_ELEMENTS = 100_000  # as they are written, and as they come by `use`
MOSTNUMBERS = 1_000_000  # of paths and polygons, as they come by `use`
MOSTSHAPES = 25_000  # each of them a stroke, and a way to it
DEEPEST = 200  # elements and uses within each other
SHAPES = ("path", "line", "polyline", "polygon", "rect", "circle", "ellipse")
LESS = "draw a part of it, or make it simpler"

_TRACE = "trace it to paths in a drawing program, and save them as plain SVG"
_SAVE = "save it as plain SVG in the program it was made with"
OTHERS = (  # first bytes of other file types, their names, fixes
    (b"\x1f\x8b", "compressed (.svgz)", f"unpack it, or {_SAVE}"),
    (b"\x89PNG", "a PNG picture", _TRACE),
    (b"\xff\xd8\xff", "a JPEG picture", _TRACE),
    (b"GIF8", "a GIF picture", _TRACE),
    (b"%PDF", "a PDF", _SAVE),
    (b"%!PS", "PostScript", _SAVE),
    (b"PK\x03\x04", "a packed file", _SAVE),
)

_SPACES = ("", "http://www.w3.org/2000/svg")
_XLINK = "http://www.w3.org/1999/xlink}href"
Counts = tuple[int, int, int, int]  # elements, shapes, numbers, depth


@dataclass(eq=False, slots=True)
class Element:
    """An element with its tag, attributes and children.

    Attributes:
        tag: its name; that of another language than SVG, as an editor's own notes are, has a }.
        has: its attributes.
        line: of the file, where it begins.
        children: the elements in it.
        text: its text content.
    """

    tag: str
    has: dict[str, str]
    line: int
    children: list["Element"] = field(default_factory=list)
    text: list[str] = field(default_factory=list)

    def __iter__(self) -> Iterator["Element"]:
        """The element and its descendants in document order."""
        todo = [self]
        while todo:
            yield (element := todo.pop())
            todo.extend(reversed(element.children))

    @property
    def link(self) -> str:
        """The target of its reference."""
        return self.has.get("href", self.has.get(_XLINK, ""))


def guard(data: bytes) -> Element:
    """The elements of a drawing.

    Raises:
        SvgError: it is no SVG, or too much of it.
    """
    for begins, what, help in OTHERS:
        if data.startswith(begins):
            raise SvgError(f"it is {what}, not a plain SVG", help)
    root = _tree(data)
    if root.tag != "svg":
        raise SvgError(f"this is no SVG: it begins with <{root.tag[:60]}>")
    _Count(by_ids(root)).check(root)
    return root


def by_ids(root: Element) -> dict[str, Element]:
    """The elements that can be referenced, by `#` and their ids."""
    return {f"#{element.has['id']}": element for element in root if "id" in element.has}


def _tree(data: bytes) -> Element:
    """The elements of a file; stops at the first beyond the limit."""
    parser = expat.ParserCreate(namespace_separator="}")
    within = [Element("", {}, 0)]  # each in the one before
    count = 0

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal count
        count += 1
        if len(within) > DEEPEST:
            raise SvgError(f"more than {DEEPEST} elements within each other")
        if count > MOST_ELEMENTS:
            raise SvgError(f"more than {MOST_ELEMENTS:,} elements", LESS)
        space, _, tag = name.rpartition("}")
        made = Element(
            tag if space in _SPACES else f"{{{name}", attributes, parser.CurrentLineNumber
        )
        within[-1].children.append(made)
        within.append(made)

    def entity(*_details: object) -> None:
        raise SvgError("it declares entities of its own, which is refused", _SAVE)

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda name: within.pop()
    parser.CharacterDataHandler = lambda text: within[-1].text.append(text)
    parser.EntityDeclHandler = entity
    parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
    try:
        parser.Parse(data, True)
    except expat.ExpatError as fault:
        what = expat.errors.messages.get(fault.code, "")
        reason = what or str(fault)
        raise SvgError(f"line {fault.lineno}: {reason}", "it is not well-formed XML") from None
    except (ValueError, LookupError) as fault:  # an unknown encoding
        raise SvgError(str(fault)[:80]) from None
    return within[0].children[0]


class _Count:
    """The size of a drawing with every `use` expanded, computed without expanding one."""

    def __init__(self, by_id: Mapping[str, Element]) -> None:
        self._by_id = by_id
        self._known: dict[Element, Counts] = {}
        self._open: set[Element] = set()

    def check(self, root: Element) -> None:
        """Raises if the drawing is too large."""
        elements, shapes, numbers, _ = self._of(root, 1)
        if elements > MOST_ELEMENTS:
            raise SvgError(f"with every 'use' it has {_shown(elements)} elements", LESS)
        if shapes > MOSTSHAPES:
            raise SvgError(f"it has {shapes:,} shapes, more than {MOSTSHAPES:,}", LESS)
        if numbers > MOSTNUMBERS:
            raise SvgError(f"with every 'use' its paths have {_shown(numbers)} numbers", LESS)

    def _of(self, element: Element, depth: int) -> Counts:
        """The size of an element with its descendants."""
        known = self._known.get(element)
        if known is None:
            if element in self._open:
                raise SvgError(f"'{element.has.get('id', '')[:40]}' uses itself")
            if depth > DEEPEST:
                raise SvgError(f"more than {DEEPEST} elements within each other by 'use'")
            self._open.add(element)
            known = self._known[element] = self._counted(element, depth)
            self._open.discard(element)
        if depth + known[3] > DEEPEST + 1:
            raise SvgError(f"more than {DEEPEST} elements within each other by 'use'")
        return known

    def _counted(self, element: Element, depth: int) -> Counts:
        used = self._by_id.get(element.link) if element.tag == "use" else None
        elements, shapes, deepest = 1, int(element.tag in SHAPES), 0
        numbers = sum(len(NUMBER.findall(element.has.get(name, ""))) for name in ("d", "points"))
        for other in (*element.children, used):
            if other is not None:
                *more, deep = self._of(other, depth + 1)
                elements, shapes, numbers = elements + more[0], shapes + more[1], numbers + more[2]
                deepest = max(deepest, deep)
        return elements, shapes, numbers, deepest + 1


def _shown(count: int) -> str:
    return f"{count:,}" if count < 10**9 else f"about 10^{len(str(count)) - 1}"
