"""Bytes of an XML file -> its elements, within limits of their number and nesting."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

DEEPEST = 100  # elements within each other
MOST_ELEMENTS = 200_000


def parse_xml(data: bytes) -> "Element":
    """The elements of a file; one that declares entities is refused.

    Raises:
        ValueError: it is not well-formed, or too much; the message says where.
    """
    from xml.etree import ElementTree as Xml  # slow, and most commands read none

    _guard(data)
    try:
        return Xml.fromstring(data)
    except (Xml.ParseError, LookupError) as problem:
        raise ValueError(str(problem)[:200]) from None


def _guard(data: bytes) -> None:
    """Go through the file without keeping anything."""
    from xml.parsers import expat

    parser = expat.ParserCreate()
    depth = count = 0

    def start(name: str, _attributes: dict[str, str]) -> None:
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if depth > DEEPEST:
            raise ValueError(
                f"line {parser.CurrentLineNumber}: more than {DEEPEST} elements within each other"
            )
        if count > MOST_ELEMENTS:
            raise ValueError(f"it has more than {MOST_ELEMENTS:,} elements")

    def end(_name: str) -> None:
        nonlocal depth
        depth -= 1

    def entity(*_details: object) -> None:
        raise ValueError("it declares entities of its own, which is refused")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.EntityDeclHandler = entity
    parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
    try:
        parser.Parse(data, True)
    except (expat.ExpatError, LookupError) as problem:
        raise ValueError(str(problem)[:200]) from None
