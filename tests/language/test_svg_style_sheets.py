"""Style sheets of SVG: which rule holds, which are not followed; the attributes made of them."""

import pytest

from dqpaint.language.imports.svg import attributes, style_sheets
from dqpaint.language.imports.svg.attributes import STYLED, Node, Notes
from dqpaint.language.imports.svg.guard import guard
from dqpaint.language.imports.svg.nested_svg import paper
from dqpaint.language.imports.svg.reader import _colour, _paints, _shapes

OPEN = '<svg xmlns="http://www.w3.org/2000/svg">'


def stroke(sheet: str, attributes: str) -> tuple[str | None, list[str]]:
    root = guard(f"<svg><style>{sheet}</style><path {attributes}/></svg>".encode())
    told: list[str] = []
    style_sheets.inline(root, STYLED, lambda _, text: told.append(text))
    return root.children[1].has.get("stroke"), told


@pytest.mark.parametrize(
    ("sheet", "attributes", "wanted"),
    [
        ("path{stroke:red}", 'stroke="blue"', "red"),
        ("path{stroke:red}", 'style="stroke:blue"', "blue"),
        ("path{stroke:red!important}", 'stroke="blue"', "red"),
        ("path{stroke:blue!important;stroke:red} .a{stroke:red}", 'class="a"', "blue"),
        ("path{stroke:blue ! important}", 'style="stroke:red"', "blue"),
        ("path{stroke:red!important}", 'style="stroke:blue!important"', "blue"),
        ("*{stroke:red} path{stroke:blue}", "", "blue"),
        ("path{stroke:blue} *{stroke:red}", "", "blue"),
        (".a{stroke:blue} path{stroke:red}", 'class="b a"', "blue"),
        ("#i{stroke:blue} .a.b{stroke:red}", 'id="i" class="a b"', "blue"),
        (".a{stroke:red} .a.b{stroke:blue} .b{stroke:red}", 'class="a b"', "blue"),
        (".a{stroke:red} .a{stroke:blue}", 'class="a"', "blue"),
        ("rect,path{stroke:blue}", "", "blue"),
        ("rect{stroke:red} .a.c{stroke:red}", 'class="a"', None),
        ("/* path{stroke:red} */ path{fill:red;stroke : blue ;}", "", "blue"),
        ("@font-face{src:x} path{stroke:blue}", "", "blue"),
        ("path{stroke:red;stroke:blue}", "", "blue"),
        ("path:hover{stroke:red}", "", None),
        ("path{stroke:red", "", None),
    ],
)
def test_which_rule_holds(sheet: str, attributes: str, wanted: str | None) -> None:
    assert stroke(sheet, attributes) == (wanted, [])


@pytest.mark.parametrize(
    ("sheet", "told"),
    [
        ("g > path{stroke:red}", "the style of 'g > path' is not followed"),
        ("@media print{path{stroke:red}}", "its @media is not followed"),
        ("@import url(a.css);", "its @import is not followed"),
    ],
)
def test_what_is_not_followed_is_told(sheet: str, told: str) -> None:
    sheet = sheet.replace(">", "&gt;")
    assert stroke(f"{sheet} .a{{stroke:blue}}", 'class="a"') == ("blue", [told])


def read(body: str, root: str = "") -> tuple[Node, Notes]:
    return attributes.read(guard(f"{OPEN[:-1]} {root}>{body}</svg>".encode()))


def paints(body: str, root: str = "") -> list[tuple[str | None, ...]]:
    """The stroke and the filling of each shape, in hexadecimal digits."""
    node, _ = read(body, root)
    seen = [_paints(state.style) for _, state in _shapes(node, paper(node))]
    return [tuple(one and one.hex() for one in both) for both in seen]


@pytest.mark.slow
def test_too_many_rules_for_too_many_elements() -> None:
    with pytest.raises(Exception, match="style"):
        read(f"<style>{'*{stroke:red}' * 3000}</style>{'<g/>' * 3000}")


def test_opacities_multiply() -> None:
    body = (
        '<g opacity="0.5" stroke-opacity="50%"><path id="p" stroke="#ff000080" opacity=".5"/></g>'
    )
    alpha = round(128 * 0.5**3)
    assert paints(body) == [(f"ff0000{alpha:02x}", f"000000{round(255 / 4):02x}")]
    used = (
        f'<defs>{body}</defs><use href="#p" opacity="0.3" fill-opacity="0.2" stroke-opacity="0"/>'
    )
    assert paints(used) == [(None, f"000000{round(255 * 0.5 * 0.3 * 0.2):02x}")]
    assert paints('<g stroke="#0f08"><path opacity="0.5" fill="none"/></g>') == [("00ff0044", None)]
    assert paints('<path stroke="red" fill="lime" fill-opacity="0.001"/>') == [("ff0000ff", None)]


@pytest.mark.parametrize(
    ("around", "own", "wanted"),
    [
        ('stroke="red" fill="lime"', "", ("ff0000ff", "00ff00ff")),
        ('stroke="red"', 'stroke="inherit"', ("ff0000ff", "000000ff")),
        ('stroke="red"', 'stroke="none"', (None, "000000ff")),
        ('stroke="red"', 'stroke="blu"', ("ff0000ff", "000000ff")),
        ('stroke="red"', 'stroke="url(#no)"', (None, "000000ff")),
        ('stroke="red"', 'stroke="context-stroke" fill="none"', ("ff0000ff", None)),
        # the keyword is inherited, not the colour it stands for (CSS Color 4, section 4.4)
        ('stroke="currentColor" color="red"', 'color="blue"', ("0000ffff", "000000ff")),
        ('fill="currentColor" color="red"', 'color="currentColor"', (None, "ff0000ff")),
        ('fill="currentColor"', 'color="transparent"', (None, None)),
        ('visibility="hidden"', 'visibility="visible"', (None, "000000ff")),
        ('visibility="hidden"', 'visibility="inherit"', (None, None)),
        ('visibility="hidden"', 'visibility="sometimes"', (None, None)),
        ('class="a"', "", ("0000ffff", "000000ff")),
        ('style="stroke:red"', 'class="a" stroke="lime"', ("0000ffff", "000000ff")),
    ],
)
def test_what_comes_from_the_elements_around(
    around: str, own: str, wanted: tuple[str | None, str | None]
) -> None:
    sheet = "<style>.a{stroke:blue}</style>"
    for body in (
        f"<g {around}><g><path {own}/></g></g>",
        f'<defs><path id="p" {own}/></defs><g {around}><use href="#p"/></g>',
        f'<symbol id="s"><path {own}/></symbol><use href="#s" {around}/>',
    ):
        assert paints(f"{sheet}{body}") == [wanted], body
    assert paints(f"{sheet}<path {own}/>", around) == [wanted]


def test_no_length_comes_from_the_elements_around() -> None:
    root, _ = read(
        '<svg x="9" width="9" height="9" rx="2"><rect y="3" width="5" height="5"/></svg>'
    )
    (inner,) = root.children
    (rectangle,) = inner.children
    assert rectangle.lengths == {"y": (3.0, 0.0), "width": (5.0, 0.0), "height": (5.0, 0.0)}


def test_gradients_become_their_mean() -> None:
    body = (
        '<linearGradient id="a"><stop stop-color="red"/><stop style="stop-color:blue"/>'
        '</linearGradient><radialGradient id="b" href="#a"/><pattern id="p"/>'
    )
    for id_ in "ab":
        assert paints(f'{body}<path stroke="url(#{id_})"/>') == [("800080ff", "000000ff")]
    assert paints(f'{body}<path stroke="url(#none) lime"/>') == [("00ff00ff", "000000ff")]
    _, notes = read(f'{body}\n<path stroke="url(#p)"/><path stroke="url(#c)"/>')
    assert notes.otherwise == {"pattern": [2]}
    assert notes.passed_over == ["line 2: stroke: there is no 'c' in the file"]
    circle = '<linearGradient id="a" href="#b"/><linearGradient id="b" href="#a"/>'
    assert paints(f'{circle}<path fill="url(#a)"/>') == [(None, "000000ff")]


def test_the_light_of_a_paint() -> None:
    assert _colour(b"\xff\0\0\x80") == (128 / 255, 0, 0)
    assert _colour(b"\x11\x11\x11\xff") is None


def test_notes_of_other_programs_are_no_shapes() -> None:
    body = '<x:path xmlns:x="http://example.org" d="nan"/><path d="M0 0"/>'
    root, _ = read(body)
    assert [one.outline for one in root.children] == [[("M", [0.0, 0.0])]]


def test_what_is_no_line_is_left_out_and_told() -> None:
    body = (
        '<text>a<tspan>b</tspan></text><g><text>c</text><image href="file:///etc/passwd"/></g>'
        '<g display="none"><text/><path d="M1 1"/></g><path style="fill:red; display : none"/>'
        "<script>alert()</script>"
    )
    root, notes = read(body)
    assert notes.left_out == {"text": [1, 1], "image": [1]}
    (group,) = root.children
    assert (group.tag, group.children) == ("g", [])


def tags(node: Node) -> list[str]:
    return [shape.tag for shape, _ in _shapes(node, paper(node))]


@pytest.mark.parametrize("tag", ["defs", "symbol", "mask", "clipPath", "pattern", "marker"])
def test_what_is_shown_by_reference_alone(tag: str) -> None:
    body = f'<{tag} id="a"><path d="nan" id="p"/></{tag}>'
    with pytest.raises(Exception, match="line 1: d of a <path>"):
        read(body)
    body = body.replace("nan", "M0 0")
    assert tags(read(body)[0]) == []
    assert tags(read(f'{body}<use href="#p"/><path/>')[0]) == ["path", "path"]
    # of these a symbol alone is shown by a `use`
    assert tags(read(f'<use href="#a"/>{body}')[0]) == ["path"] * (tag == "symbol")


@pytest.mark.parametrize(
    ("body", "shown"),
    [
        ('<g display="none"><path id="p"/></g><use href="#p"/>', ["path"]),
        ('<g display="none"><g display="none" id="p"><path/></g></g><use href="#p"/>', []),
        ('<switch><text/><rect id="q" width="1" height="1"/><path id="p"/></switch>', ["rect"]),
        ('<switch><path/><circle id="p" r="1"/></switch><use href="#p"/>', ["path", "circle"]),
        ('<path id="p"><circle r="1"/></path>', ["path"]),
        ('<use href="#p"><circle r="1"/></use><path id="p"/>', ["path", "path"]),
        ('<unheard><path/></unheard><a href="#x"><path/></a>', ["path", "path"]),
        ('<use href="p"/><defs><path id="p"/></defs>', []),
        ('<use href="" xlink:href="#p"/><defs><path id="p"/></defs>', []),
        ('<use xlink:href="#p"/><defs><path id="p"/></defs>', ["path"]),
        ('<text id="p"/><linearGradient id="g"/><use href="#p"/><use href="#g"/>', []),
        ('<use href="#b"/><defs><g id="b"><use href="#c"/></g><path id="c"/></defs>', ["path"]),
    ],
)
def test_what_is_shown(body: str, shown: list[str]) -> None:
    node, _ = read(body, 'xmlns:xlink="http://www.w3.org/1999/xlink"')
    assert tags(node) == shown


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ('<rect width="3"/>', "a <rect> without a size"),
        ('<rect width="0%" height="3"/>', "a <rect> without a size"),
        ("<circle/>", "a <circle> without a size"),
        ('<ellipse rx="0" ry="auto"/>', "an <ellipse> without a size"),
        ('<svg viewBox="0 0 3 0"><path/></svg>', "an <svg> without a size"),
        ('<svg height="0"><path/></svg>', "an <svg> without a size"),
        ('<path transform="scale(0 1)"/>', "a transform that leaves nothing to see"),
        (
            '<g transform="matrix(1 1 1 1 0 0)"><path/></g>',
            "a transform that leaves nothing to see",
        ),
        ('<use href="#s" height="0"/><symbol id="s"><path/></symbol>', "a <use> without a size"),
        ('<use href="file.svg#s"/>', "a <use> of another file"),
        ("<use/>", "a <use> of nothing"),
        ('<use href="#s"/>', "there is no 's' to be used"),
    ],
)
def test_what_shows_nothing_is_told(body: str, told: str) -> None:
    node, notes = read(body)
    assert notes.passed_over == [f"line 1: {told}"]
    assert tags(node) == []


def test_a_use_of_a_shape_has_no_size() -> None:
    """Its width and height are of a viewport that it shows."""
    node, notes = read('<path id="p"/><use href="#p" width="0"/><ellipse ry="2"/>')
    assert tags(node) == ["path", "path", "ellipse"]
    assert not notes.passed_over
