"""Names, blocks, calls and colours of a text: also of one that is half written."""

import pytest

from dqpaint.core import example_names, examples_folder
from dqpaint.editors import swatches, symbols
from dqpaint.language import parse
from dqpaint.program import colours

TEXT = """# two lines
# of comment
let r = 10 mm
let f(x) = 2*x + r
frame leaf at (r, 0) turned 45 deg
def petal(r, n)
  let s1 = f(r)
  repeat i from 1 to 3
    line by (s1*i, r) light hsv(i*20 deg)
  end
end
with frame leaf
  petal(r, 2)
  curve (r*cos(t), r*sin(t)) for t from 0 to 90 deg in 1 s
end
arc radius r to (2*r, 0) left
let radius = 3 mm
line by (radius, 0)
"""


def named(text, word, nth=0):
    """The name of the n-th place of a word, and the lines and columns where it is written."""
    found = symbols.outline(text)
    at = -1
    for _ in range(nth + 1):
        at = text.index(word, at + 1)
    name = found.meant(at)
    return name, [text.count("\n", 0, span.start) + 1 for span in found.occurrences(name)]


@pytest.mark.parametrize(
    ("word", "nth", "kind", "lines"),
    [
        ("r = 10", 0, "let", [3, 4, 5, 13, 14, 14, 16, 16]),
        ("r, n", 0, "parameter", [6, 7, 9]),
        ("x)", 0, "parameter", [4, 4]),
        ("f(x)", 0, "function", [4, 7]),
        ("leaf", 0, "frame", [5, 12]),
        ("petal", 1, "def", [6, 13]),
        ("i from", 0, "counter", [8, 9, 9]),
        ("t from", 0, "parameter", [14, 14, 14]),
        ("s1 = f", 0, "let", [7, 9]),
        ("radius =", 0, "let", [17, 18]),
    ],
)
def test_names_are_found_where_they_mean_the_same(word, nth, kind, lines):
    name, seen = named(TEXT, word, nth)
    assert name.kind == kind
    assert seen == lines


@pytest.mark.parametrize("name", example_names())
def test_renaming_every_name_of_an_example_changes_nothing(name):
    """The compiled drawing is an independent witness: all uses are found, and no word besides."""
    path = examples_folder() / f"{name}.traj"
    text = path.read_text("utf-8")
    found = symbols.outline(text)
    edits = {}
    for k, one in enumerate(found.names):
        for span in found.occurrences(one):
            assert edits.setdefault(span.start, (span, f"renamed_{k}"))[1] == f"renamed_{k}"
    made = text
    for _, (span, word) in sorted(edits.items(), reverse=True):
        made = made[: span.start] + word + made[span.end :]
    assert not found.names or made != text
    before, after = (parse(one, str(path), path) for one in (text, made))
    assert len(before.segments) == len(after.segments)
    for one, other in zip(before.segments, after.segments, strict=True):
        assert type(one) is type(other)
        assert repr(one.light) == repr(other.light)


def test_a_drawing_with_every_kind_of_name_can_be_renamed():
    found = symbols.outline(TEXT)
    edits = sorted(
        {(s.start, s.end, k) for k, n in enumerate(found.names) for s in found.occurrences(n)},
        reverse=True,
    )
    made = TEXT
    for start, end, k in edits:
        made = f"{made[:start]}n{k}{made[end:]}"
    for word in ("petal", "leaf", "radius, 0", "f(", "(x)"):
        assert word not in made
    assert len(parse(made).segments) == len(parse(TEXT).segments)


def test_blocks_and_comments_fold():
    assert symbols.folds(TEXT) == [(0, 1, True), (5, 10, False), (7, 9, False), (11, 14, False)]
    root = symbols.outline(TEXT).root
    assert [block.head for block in root.blocks] == ["def petal(r, n)", "with frame leaf"]
    assert [block.head for block in root.blocks[0].blocks] == ["repeat i from 1 to 3"]


@pytest.mark.parametrize("cut", range(0, len(TEXT), 7))
def test_half_a_text_is_no_fault(cut):
    found = symbols.outline(TEXT[:cut])
    assert found.root.span.end == cut
    symbols.folds(TEXT[:cut])
    list(swatches.swatches(TEXT[:cut]))


@pytest.mark.parametrize(
    ("written", "call"),
    [
        ("line to polar(", ("polar", 0)),
        ("line to polar(20 mm, ", ("polar", 1)),
        ("line to polar(2*(3, ", None),
        ("line to polar(max(1, 2), ", ("polar", 1)),
        ("line to (", None),
        ("line to polar(1 mm, 2 deg)", None),
        ("let a = f(1)\nline to g(", ("g", 0)),
    ],
)
def test_the_call_that_is_being_written(written, call):
    assert symbols.call_at(written, len(written)) == call


@pytest.mark.parametrize(
    "written",
    ["red", "rebeccapurple", '"#ff8800"', '"#f80"', "hsv(100 deg)", "hsv(250 deg, 0.5, 0.8)"],
)
def test_colours_are_those_that_shine(written):
    """The language's own colour, which is linear light, is the witness."""
    text = f"line by (1, 0) mm light {written}"
    ((span, colour),) = swatches.swatches(text)
    assert text[span.start : span.end] == written
    (segment,) = parse(text).segments
    linear = [colours.linear(part) for part in colour]
    assert linear == pytest.approx(segment.light.first, abs=1e-12)


@pytest.mark.parametrize(
    "text",
    ["let red1 = 3", "# red", 'text "red" height 9 mm', "hold 1 s light hsv(a*2 deg)",
     "hsv(10 deg, 2, 1)", "hsv(10)"],
)  # fmt: skip
def test_what_is_no_colour(text):
    assert not list(swatches.swatches(text))


def test_a_picked_colour_comes_back():
    assert swatches.written((1.0, 0.0, 0.0)) == ["red", '"#ff0000"']
    assert swatches.written((0.5, 0.25, 0.125)) == ['"#804020"']
    for written in swatches.written((1.0, 0.5333333, 0.0)):
        ((_, colour),) = swatches.swatches(f"line by (1, 0) mm light {written}")
        assert colour == pytest.approx((1.0, 0.5333333, 0.0), abs=1 / 500)
