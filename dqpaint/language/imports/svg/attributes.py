"""Every attribute of an SVG drawing that matters, read by SVG's own grammar and written plainly.

A number, a path or a transform that can't be read is an error with its line: another shape than
was meant is worse than none. What SVG itself says to pass over (a colour that is none, a `use` of
nothing) is passed over so, and told.
"""

from collections.abc import Callable, Mapping
from typing import NamedTuple, TypeVar
from xml.etree.ElementTree import Element

from dqpaint.language.imports.svg import values
from dqpaint.language.imports.svg.style_sheets import Remark, tag_of
from dqpaint.language.imports.svg.values import Commands, SvgError, UnreadableError

NUMBER = "data-number"  # of a path in `Attributes.paths`: the library need not read it
LINK = ("href", "{http://www.w3.org/1999/xlink}href")
Read = TypeVar("Read")
Reader = Callable[[str], str]

_PLACE: Mapping[str, Reader] = {"x": values.length, "y": values.length}
_SIZE: Mapping[str, Reader] = dict.fromkeys(("width", "height"), values.size_or_auto)
_ROUND: Mapping[str, Reader] = {"rx": values.size_or_auto, "ry": values.size_or_auto}
_CENTRE: Mapping[str, Reader] = {"cx": values.length, "cy": values.length}
GEOMETRY: Mapping[str, Mapping[str, Reader]] = {
    "line": dict.fromkeys(("x1", "y1", "x2", "y2"), values.length),
    "rect": {**_PLACE, **_SIZE, **_ROUND},
    "circle": {**_CENTRE, "r": values.size},
    "ellipse": {**_CENTRE, **_ROUND},
    "use": {**_PLACE, **_SIZE},
    "svg": {**_PLACE, **_SIZE, "viewBox": values.view_box},
}
SHAPES = ("path", "line", "polyline", "polygon", "rect", "circle", "ellipse")
OUTLINES: Mapping[str, tuple[str, Callable[[str], Commands]]] = {
    "path": ("d", values.path),
    "polyline": ("points", values.points),
    "polygon": ("points", values.closed),
}
_PAINTS = ("stroke", "fill", "color")
_OPACITIES = ("stroke-opacity", "fill-opacity", "opacity")
_SIZES = {"rect": ("width", "height"), "circle": ("r",), "ellipse": ("rx", "ry")}
_CURE = "mend it, or save the drawing as plain SVG in the program it was made with"
_KEPT = ("id", "visibility", "preserveAspectRatio", *LINK)
NOT_FOLLOWED = ("clip-path", "mask", "stroke-dasharray", "transform-origin")
STYLED = frozenset((
    *(*_PAINTS, *_OPACITIES, *NOT_FOLLOWED, "stop-color", "transform", "display", "visibility"),
    *(name for readers in GEOMETRY.values() for name in readers),
)) - {"points", "viewBox", "d"}  # fmt: skip


class Opacities(NamedTuple):
    """Of strokes and of fillings, which are inherited, and of all that stands around."""

    stroke: float
    fill: float
    whole: float


OPAQUE = Opacities(1.0, 1.0, 1.0)


class Attributes:
    """Reads the attributes of a drawing's elements.

    Args:
        root: with the styles in the attributes.
        lines: of the file, where each element begins.
        remark: takes what is passed over as SVG says.
        not_followed: takes what is drawn otherwise than SVG says.
    """

    def __init__(
        self, root: Element, lines: Mapping[Element, int], remark: Remark, not_followed: Remark
    ) -> None:
        self._by_id = {e.attrib["id"]: e for e in root.iter() if "id" in e.attrib}
        self._lines, self._remark, self._not_followed = lines, remark, not_followed
        self.paths: list[Commands] = []

    def write(self, element: Element, light: Opacities = OPAQUE) -> None:
        """Writes the attributes of an element and of all in it anew.

        Raises:
            SvgError: one of them can't be read.
        """
        tag, has = tag_of(element), element.attrib
        if tag in ("linearGradient", "radialGradient"):
            return
        made = {name: has[name] for name in _KEPT if name in has}
        for name, reader in {**GEOMETRY.get(tag, {}), "transform": values.transform}.items():
            if name in has:
                made[name] = self._read(element, name, reader)
        if tag in OUTLINES:
            name, letters = OUTLINES[tag]
            self.paths.append(self._read(element, name, letters) if name in has else [])
        paints = self._paints(element)
        light = self._opacities(element, light)
        for name in NOT_FOLLOWED:
            if has.get(name, "none").strip() not in ("none", "", "0"):
                self._not_followed(element, name)
        if tag == "symbol" and "viewBox" in has:
            self._not_followed(element, "symbol")
        if tag == "use":
            self._check_link(element)
            if light.whole < 1.0:
                self._not_followed(element, "opacity")
        has.clear()
        has.update({name: value for name, value in made.items() if value}, **paints)
        if tag in SHAPES:
            _shade(has, light)
        self._complete(element, tag)
        if tag in OUTLINES:
            has.update({"d": "", NUMBER: str(len(self.paths) - 1)})
            element.tag = str(element.tag).replace(tag, "path")
        for child in element:
            self.write(child, light)

    def _read(self, element: Element, name: str, reader: Callable[[str], Read]) -> Read:
        try:
            return reader(element.attrib[name])
        except UnreadableError as fault:
            where = f"line {self._lines.get(element, 0)}: {name} of a <{tag_of(element)}>"
            raise SvgError(f"{where}: {fault}", _CURE) from None

    def _opacities(self, element: Element, outside: Opacities) -> Opacities:
        """Of strokes and fillings: said here, else outside; and of all there is."""
        found = []
        for name, otherwise in zip(_OPACITIES, (outside.stroke, outside.fill, 1.0), strict=True):
            found.append(otherwise)
            if name in element.attrib:
                try:
                    found[-1] = values.opacity(element.attrib[name])
                except UnreadableError as fault:
                    self._remark(element, f"{name}: {fault}")
        stroke, fill, own = found
        return Opacities(stroke, fill, own * outside.whole)

    def _paints(self, element: Element) -> dict[str, str]:
        """The paints that are some; the others are inherited, as SVG has it."""
        made: dict[str, str] = {}
        for name in _PAINTS:
            text = element.attrib.get(name, "inherit").strip()
            if text in ("inherit", "context-stroke", "context-fill", ""):
                continue
            try:
                link = values.reference(text)
                made[name] = self._linked(element, name, *link) if link else values.paint(text)
            except UnreadableError as fault:
                self._remark(element, f"{name}: {fault}")
        return made

    def _check_link(self, use: Element) -> None:
        """SVG draws nothing for a `use` of nothing."""
        link = next((use.attrib[key] for key in LINK if key in use.attrib), "")
        if not link:
            self._remark(use, "a <use> of nothing")
        elif not link.startswith("#"):
            self._remark(use, "a <use> of another file")
        elif link[1:] not in self._by_id:
            self._remark(use, f"there is no {values.shown(link[1:])} to be used")

    def _linked(self, element: Element, name: str, id_: str, instead: str) -> str:
        """A gradient as its mean colour; a pattern is no light, and what is not there no paint."""
        target = self._by_id.get(id_)
        if target is None:
            self._remark(element, f"{name}: there is no '{id_[:24]}' in the file")
            return values.paint(instead) if instead.strip() else "none"
        stops = self._stops(target, 0)
        if not stops:
            self._not_followed(element, tag_of(target))
            return "#000000ff"
        self._not_followed(element, "gradient")
        return values.mean(stops)

    def _stops(self, gradient: Element, depth: int) -> list[str]:
        """The colours of a gradient, or of the one it takes them from."""
        stops = [stop for stop in gradient if tag_of(stop) == "stop"]
        link = next((gradient.attrib[key] for key in LINK if key in gradient.attrib), "")
        if not stops and depth < 8 and link[1:] in self._by_id:
            return self._stops(self._by_id[link[1:]], depth + 1)
        made = []
        for stop in stops:
            try:
                made.append(values.paint(stop.attrib.get("stop-color", "black")))
            except UnreadableError as fault:
                self._remark(stop, f"stop-color: {fault}")
        return made

    def _complete(self, element: Element, tag: str) -> None:
        """Writes what is not said, which the library would take from the elements around."""
        has = element.attrib
        if tag in ("rect", "ellipse"):
            for one, other in (("rx", "ry"), ("ry", "rx")):
                if one not in has and other in has:
                    has[one] = has[other]
        for name in GEOMETRY.get(tag, {}) if tag in SHAPES else ():
            has.setdefault(name, "0")
        if any(float(has[name].rstrip("%")) == 0.0 for name in _SIZES.get(tag, ())):
            self._remark(element, f"a <{tag}> without a size")


def _shade(has: dict[str, str], light: Opacities) -> None:
    """Writes the opacities of a shape, with those of its colours in them."""
    for paint, own in (("stroke", light.stroke), ("fill", light.fill)):
        alpha = int(has[paint][7:], 16) / 255 if has.get(paint, "").startswith("#") else 1.0
        if own * light.whole * alpha < 1.0:
            has[f"{paint}-opacity"] = repr(own * light.whole * alpha)
