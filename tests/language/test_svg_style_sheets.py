"""Style sheets of SVG: which rule holds, which are not followed; the attributes made of them."""

from xml.etree import ElementTree

import pytest

from dqpaint.language.imports.svg import style_sheets
from dqpaint.language.imports.svg.attributes import STYLED
from dqpaint.language.imports.svg.guard import guard

OPEN = '<svg xmlns="http://www.w3.org/2000/svg">'


def stroke(sheet: str, attributes: str) -> tuple[str | None, list[str]]:
    root = ElementTree.fromstring(f"<svg><style>{sheet}</style><path {attributes}/></svg>")
    told: list[str] = []
    style_sheets.inline(root, STYLED, lambda _, text: told.append(text))
    return root[1].attrib.get("stroke"), told


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


def test_too_many_rules_for_too_many_elements() -> None:
    text = f"{OPEN}<style>{'*{stroke:red}' * 3000}</style>{'<g/>' * 3000}</svg>"
    with pytest.raises(Exception, match="its style has too many rules for so many elements"):
        guard(text.encode())


def attributes(body: str, name: str = "path") -> dict[str, str]:
    root = ElementTree.fromstring(guard(f"{OPEN}{body}</svg>".encode()).xml)
    return next(e.attrib for e in root.iter() if str(e.tag).endswith(name))


def test_opacities_multiply() -> None:
    body = '<g opacity="0.5" stroke-opacity="50%"><path d="" stroke="#ff000080" opacity=".5"/></g>'
    found = attributes(body)
    assert float(found["stroke-opacity"]) == pytest.approx(0.5**3 * 128 / 255)
    assert float(found["fill-opacity"]) == 0.25


def test_nothing_comes_from_the_elements_around() -> None:
    body = '<svg x="9" width="9" height="9"><rect height="5"/></svg>'
    assert attributes(body, "rect") == dict.fromkeys(("x", "y", "rx", "ry", "width"), "0") | {
        "height": "5.0"
    }
    assert attributes('<rect width="9" height="9" rx="2"/>', "rect")["ry"] == "2.0"


def test_gradients_become_their_mean() -> None:
    body = (
        '<linearGradient id="a"><stop stop-color="red"/><stop style="stop-color:blue"/>'
        '</linearGradient><radialGradient id="b" href="#a"/><pattern id="p"/>'
    )
    for id_ in "ab":
        assert attributes(f'{body}<path d="" stroke="url(#{id_})"/>')["stroke"] == "#800080ff"
    assert attributes(f'{body}<path d="" stroke="url(#none) lime"/>')["stroke"] == "#00ff00ff"
    out = guard(f'{OPEN}{body}\n<path stroke="url(#p)"/><path stroke="url(#c)"/></svg>'.encode())
    assert out.otherwise == {"pattern": [2]}
    assert out.passed_over == ["line 2: stroke: there is no 'c' in the file"]
    circle = '<linearGradient id="a" href="#b"/><linearGradient id="b" href="#a"/>'
    assert attributes(f'{circle}<path d="" fill="url(#a)"/>')["fill"] == "#000000ff"


def test_notes_of_other_programs_are_no_shapes() -> None:
    body = '<x:path xmlns:x="http://example.org" d="nan"/><path d="M0 0"/>'
    out = guard(f"{OPEN}{body}</svg>".encode())
    assert out.paths == [[("M", [0.0, 0.0])]]
