"""The guard before an SVG drawing is read: each refusal, before anything is expanded."""

import pytest

from dqpaint.language.imports.svg.guard import DEEPEST, MOST_ELEMENTS, SvgError, guard
from tests.support.svg import OPEN, nested_uses
from tests.support.work import Calls


def refused(text: str) -> str:
    with Calls(3_000_000), pytest.raises(SvgError) as caught:
        guard(text.encode())
    return caught.value.message


def test_nested_uses() -> None:
    assert refused(nested_uses(30)).startswith("with every 'use' it has about 10^9 elements")
    assert refused(nested_uses(90)).startswith("with every 'use' it has about 10^27 elements")
    assert len(nested_uses(30)) < 2_500


@pytest.mark.slow
def test_uses_are_counted_exactly() -> None:
    """A file with as many instances as allowed passes, with one more it does not."""
    # svg, g, uses: each use counts itself and its g
    uses = (MOST_ELEMENTS - 2) // 2
    text = f'{OPEN}<g id="p"/>{{}}<use href="#p"/></svg>'
    assert guard(text.format('<use href="#p"/>' * (uses - 1)).encode())
    assert refused(text.format('<use href="#p"/>' * uses)).startswith(
        "with every 'use' it has 100,"
    )


def test_shapes_are_counted_with_uses() -> None:
    uses = '<use href="#p"/>' * 25_000
    message = refused(f'{OPEN}<circle id="p"/>{uses}</svg>')
    assert message == "it has 25,001 shapes, more than 25,000"


def test_numbers_are_counted_with_uses() -> None:
    path = f'<path id="p" d="M{"1 1 " * 600}"/>'
    uses = '<use href="#p"/>' * 900
    message = refused(f"{OPEN}{path}{uses}</svg>")
    assert message == "with every 'use' its paths have 1,081,200 numbers"


@pytest.mark.parametrize(
    "body",
    [
        '<use id="a" href="#a"/>',
        '<g id="a"><use href="#a"/></g>',
        '<g id="a"><use href="#b"/></g><g id="b"><g><use href="#a"/></g></g>',
    ],
)
def test_circles(body: str) -> None:
    assert refused(f"{OPEN}{body}</svg>") in ("'a' uses itself", "'b' uses itself")


def test_depth() -> None:
    deep = DEEPEST - 2
    assert guard(f"{OPEN}{'<g>' * deep}<path/>{'</g>' * deep}</svg>".encode())
    for count in (DEEPEST, 9999):
        message = refused(f"{OPEN}{'<g>' * count}{'</g>' * count}</svg>")
        assert message == "more than 200 elements within each other"
    curve = "".join(f'<g id="a{i}"><use href="#a{i + 1}"/></g>' for i in range(5000))
    wanted = "more than 200 elements within each other by 'use'"
    assert refused(f"{OPEN}{curve}</svg>") == wanted
    back = "".join(f'<g id="a{i}"><use href="#a{i - 1}"/></g>' for i in range(1, 5000))
    assert refused(f'{OPEN}<g id="a0"/>{back}</svg>') == wanted


@pytest.mark.slow
def test_size() -> None:
    assert refused(f"{OPEN}{'<g/>' * MOST_ELEMENTS}</svg>") == "more than 100,000 elements"


def test_entities() -> None:
    head = '<!DOCTYPE svg [<!ENTITY a "aaaa">]>'
    assert refused(f"{head}{OPEN}&a;</svg>").startswith("it declares entities of its own")
    outside = '<!DOCTYPE svg [<!ENTITY a SYSTEM "file:///etc/passwd">]>'
    assert refused(f"{outside}{OPEN}&a;</svg>").startswith("it declares entities of its own")
    parameter = '<!DOCTYPE svg [<!ENTITY % a SYSTEM "http://example.org/x">%a;]>'
    assert refused(f"{parameter}{OPEN}</svg>").startswith("it declares entities of its own")
    doctype = '<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/svg11.dtd">'
    assert guard(f"{doctype}{OPEN}</svg>".encode())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "line 1: no element found"),
        ("hello", "line 1: syntax error"),
        (f"{OPEN}<g>", "line 1: no element found"),
        (f"{OPEN}\n<g></svg>", "line 2: mismatched tag"),
        ("<html/>", "this is no SVG: it begins with <html>"),
        ("<svg>&nbsp;</svg>", "line 1: undefined entity"),
        ('<?xml version="1.0" encoding="none"?><svg/>', "unknown encoding: none"),
    ],
)
def test_no_svg(text: str, message: str) -> None:
    assert refused(text) == message


def test_elements_are_as_they_are_written() -> None:
    body = '<g\nid="a">b<x:path xmlns:x="http://example.org" x:d="1"/>c\n<use xlink:href="#b"/></g>'
    root, group, note, use = guard(f"{OPEN}{body}</svg>".encode())
    assert [one.tag for one in (root, group, note, use)] == [
        *("svg", "g", "{http://example.org}path", "use")
    ]
    assert (root.line, group.line, note.line, use.line) == (1, 1, 2, 3)
    assert "".join(group.text) == "bc\n"
    assert group.children == [note, use]
    assert use.link == "#b"
