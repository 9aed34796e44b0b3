"""The guard before the SVG library: what it may be given, and what it would draw by mistake.

A drawing of 2 kB can ask for 10^30 circles by `use` within `use`; such files, and those that nest
too deep, go in circles or declare entities, are refused before anything is expanded. What SVG does
not show where it stands (symbols, masks, markers ...) is put into `defs`, what is no line is left
out and counted.
"""

from dataclasses import dataclass, field
from xml.etree import ElementTree
from xml.parsers import expat

from dqpaint.language.imports.svg.attributes import LINK, SHAPES, STYLED, Attributes
from dqpaint.language.imports.svg.nested_svg import flatten
from dqpaint.language.imports.svg.style_sheets import Remark, TooManyRulesError, inline, tag_of
from dqpaint.language.imports.svg.values import NUMBER, Commands, SvgError

MOST_BYTES = 10_000_000
MOST_ELEMENTS = 100_000  # as they are written, and as they come by `use`
MOSTNUMBERS = 1_000_000  # of paths and polygons, as they come by `use`
MOSTSHAPES = 25_000  # each of them a stroke, and a way to it
DEEPEST = 200  # elements and uses within each other

_HIDDEN = ("clipPath", "mask", "pattern", "marker", "symbol")  # shown only by reference, if at all
_NO_LINES = (
    "text",
    "image",
    "foreignObject",
    "flowRoot",
    "style",
    "script",
    "video",
    "audio",
    "canvas",
)
_SAID = ("text", "image", "foreignObject", "flowRoot")  # of these a person misses the loss
_LESS = "draw a part of it, or make it simpler"

_TRACE = "trace it to paths in a drawing program, and save them as plain SVG"
_SAVE = "save it as plain SVG in the program it was made with"
OTHERS = (  # how files of other kinds begin, what they are, what helps
    (b"\x1f\x8b", "compressed (.svgz)", f"unpack it, or {_SAVE}"),
    (b"\x89PNG", "a PNG picture", _TRACE),
    (b"\xff\xd8\xff", "a JPEG picture", _TRACE),
    (b"GIF8", "a GIF picture", _TRACE),
    (b"%PDF", "a PDF", _SAVE),
    (b"%!PS", "PostScript", _SAVE),
    (b"PK\x03\x04", "a packed file", _SAVE),
)

Element = ElementTree.Element
Lines = dict[str, list[int]]  # of a file, where something stands
Counts = tuple[int, int, int, int]  # elements, shapes, numbers, depth


@dataclass
class GuardedFile:
    """A drawing that may be read, and what of it is not drawn as it stands there.

    Attributes:
        xml: its text.
        left_out: texts, images ..., and the lines they stand on.
        otherwise: what is drawn, but not as SVG says, and the lines.
        passed_over: what SVG itself passes over, each with its line.
        paths: the data of its paths and polygons, which name them by their numbers.
    """

    xml: bytes
    left_out: Lines = field(default_factory=dict)
    otherwise: Lines = field(default_factory=dict)
    passed_over: list[str] = field(default_factory=list)
    paths: list[Commands] = field(default_factory=list)


def guard(data: bytes) -> GuardedFile:
    """A drawing without what does not belong to its lines, its attributes written plainly.

    Raises:
        SvgError: it is no SVG, or too much of it, or a part of it can't be read.
    """
    for begins, what, cure in OTHERS:
        if data.startswith(begins):
            raise SvgError(f"it is {what}, not a plain SVG", cure)
    root, lines = _tree(data)
    if tag_of(root) != "svg" or _is_foreign(root):
        raise SvgError(f"this is no SVG: it begins with <{str(root.tag)[:60]}>")
    _Count(root).check()
    out = GuardedFile(b"")

    def remark(element: Element, text: str) -> None:
        out.passed_over.append(f"line {lines[element]}: {text}")

    def otherwise(element: Element, name: str) -> None:
        out.otherwise.setdefault(name, []).append(lines[element])

    try:
        inline(root, STYLED, remark)
    except TooManyRulesError:
        raise SvgError("its style has too many rules for so many elements", _LESS) from None
    attributes = Attributes(root, lines, remark, otherwise)
    _clean(root, lines, out.left_out)
    attributes.write(root)
    if _has_no_size(root):
        cure = "give its viewBox the width and height of what it shows, or take it away"
        raise SvgError(f"line {lines[root]}: it has no size, so SVG shows nothing of it", cure)
    _leave_out_empty(root, remark)
    _size(root)
    flatten(root)
    out.paths = attributes.paths
    out.xml = ElementTree.tostring(root, encoding="utf-8")
    return out


def _tree(data: bytes) -> tuple[Element, dict[Element, int]]:
    """The elements of a file and the line of each; stops at the first that is too many."""
    builder = ElementTree.TreeBuilder()
    parser = expat.ParserCreate(namespace_separator="}")
    depth = count = 0
    lines: dict[Element, int] = {}

    def tag(name: str) -> str:
        return f"{{{name}" if "}" in name else name

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if depth > DEEPEST:
            raise SvgError(f"more than {DEEPEST} elements within each other")
        if count > MOST_ELEMENTS:
            raise SvgError(f"more than {MOST_ELEMENTS:,} elements", _LESS)
        made = builder.start(tag(name), {tag(key): value for key, value in attributes.items()})
        lines[made] = parser.CurrentLineNumber

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
    return builder.close(), lines


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
        if shapes > MOSTSHAPES:
            raise SvgError(f"it has {shapes:,} shapes, more than {MOSTSHAPES:,}", _LESS)
        if numbers > MOSTNUMBERS:
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
        if tag_of(element) == "use":
            links = [element.attrib[key] for key in LINK if key in element.attrib]
            below += [self._by_id[k[1:]] for k in links[:1] if k[1:] in self._by_id]
        paths = element.attrib.get("d", ""), element.attrib.get("points", "")
        elements, shapes, deepest = 1, int(tag_of(element) in SHAPES), 0
        numbers = sum(len(NUMBER.findall(path)) for path in paths)
        for other in below:
            *more, deep = self._of(other, depth + 1)
            elements, shapes, numbers = elements + more[0], shapes + more[1], numbers + more[2]
            deepest = max(deepest, deep)
        return elements, shapes, numbers, deepest + 1


def _shown(count: int) -> str:
    return f"{count:,}" if count < 10**9 else f"about 10^{len(str(count)) - 1}"


def _is_foreign(element: Element) -> bool:
    """Whether an element belongs to another language than SVG, as an editor's own notes do."""
    space = str(element.tag).rpartition("}")[0]
    return space not in ("", "{http://www.w3.org/2000/svg")


def _clean(parent: Element, lines: dict[Element, int], left_out: Lines) -> None:
    """Takes away what is not drawn, and hides what is drawn only by reference."""
    kept: list[Element] = []
    for child in parent:
        name, hidden = tag_of(child), child.attrib.get("display", "").strip() == "none"
        if _is_foreign(child):
            continue
        if name in _NO_LINES or hidden:
            if name in _SAID and not hidden:
                left_out.setdefault(name, []).append(lines[child])
            continue
        _clean(child, lines, left_out)
        if name in _HIDDEN and tag_of(parent) != "defs":
            shelf = Element(str(child.tag).replace(name, "defs"))
            shelf.append(child)
            child = shelf
        kept.append(child)
    if tag_of(parent) == "switch":
        del kept[1:]
    parent[:] = kept


def _has_no_size(element: Element) -> bool:
    """Whether an <svg> has a width or a height of 0, in its view box or outside."""
    sides = [element.attrib.get(key, "1") for key in ("width", "height")]
    sides += element.attrib.get("viewBox", "").split()[2:]
    return any(float(side.rstrip("%")) == 0.0 for side in sides)


def _leave_out_empty(parent: Element, remark: Remark) -> None:
    """Takes away what SVG does not show within a drawing; the library would end there."""
    for child in list(parent):
        if tag_of(child) == "svg" and _has_no_size(child):
            remark(child, "an <svg> without a size")
            parent.remove(child)
        else:
            _leave_out_empty(child, remark)


def _size(root: Element) -> None:
    """A width or a height that is not said follows from the view box, as browsers have it."""
    sizes = {key: root.attrib.get(key, "%") for key in ("width", "height")}
    said = {key: float(value) for key, value in sizes.items() if "%" not in value}
    box = [float(number) for number in root.attrib.get("viewBox", "").split()]
    if len(box) != 4 or min(box[2:]) <= 0.0 or len(said) == 2:
        return
    for key, side, other in (("width", box[2], box[3]), ("height", box[3], box[2])):
        if key not in said:
            given = next(iter(said.values()), other)
            root.attrib[key] = repr(given * side / other)
