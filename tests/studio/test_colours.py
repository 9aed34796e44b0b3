"""The marks over a text: where they begin and end, and the numbers in it."""

from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dqpaint.core import example_names, find_drawing
from dqpaint.studio.page import colours
from dqpaint.studio.work.messages import Finding

TEXT = """# a star
speed 60 mm/s
let r = 80 mm
line to polar(r, -90.50 deg) light hsv(i*72 deg)  # end
text "a b" height 12 mm
"""


def classes(text, word):
    start = text.index(word)
    found = [m for m in colours.marks(text, 1, text.count("\n") + 1) if m["from"] == start]
    return [mark["class"] for mark in found]


@pytest.mark.parametrize(
    ("word", "name"),
    [("# a star", "t-comment"), ("speed", "t-statement"), ("60", "t-number"), ("mm/s", "t-unit"),
     ("let", "t-statement"), ("r = 80", "t-own"), ("line", "t-statement"), ("to ", "t-part"),
     ("polar", "t-function"), ("light", "t-part"), ("hsv", "t-function"), ('"a b"', "t-text")],
)  # fmt: skip
def test_words_have_their_kind(word, name):
    assert classes(TEXT, word) == [name]


@pytest.mark.parametrize("name", example_names())
def test_marks_lie_in_the_text_one_after_the_other(name):
    text = find_drawing(name).read_text()
    found = list(colours.marks(text, 1, text.count("\n") + 1))

    assert found
    assert all(a["to"] <= b["from"] for a, b in pairwise(found))
    assert all(0 <= m["from"] < m["to"] <= len(text) and "\n" not in text[m["from"]:m["to"]]
               for m in found)  # fmt: skip


@settings(deadline=None)
@given(st.text(max_size=200))
def test_any_text_can_be_marked(text):
    for one in colours.marks(text, 1, text.count("\n") + 1):
        assert 0 <= one["from"] < one["to"] <= len(text)
    for number in colours.numbers(text):
        assert float(number.span.text_in(text)) == number.value


def test_only_the_lines_that_were_asked_for():
    found = list(colours.marks(TEXT, 3, 3))

    assert {TEXT.count("\n", 0, one["from"]) + 1 for one in found} == {3}


def test_numbers_with_units_and_names():
    found = {one.span.text_in(TEXT): one for one in colours.numbers(TEXT)}

    assert (found["80"].name, found["80"].unit, found["80"].value) == ("r", "mm", 80.0)
    assert (found["60"].name, found["60"].unit) == ("", "mm/s" if "mm/s" in found else "mm")
    assert found["90.50"].unit == "deg"
    assert colours.number_at(TEXT, TEXT.index("90.50") + 2) == found["90.50"]
    assert colours.number_at(TEXT, TEXT.index("polar")) is None


def test_a_number_keeps_its_decimals():
    assert colours.spelled(12.3456, "1.00") == "12.35"
    assert colours.spelled(12.6, "5") == "13"
    assert colours.step_of("80") == 1.0
    assert colours.step_of("0.25") == pytest.approx(0.01)
    assert colours.step_of("12000") == pytest.approx(100.0)


def test_underlines_have_something_to_underline():
    def finding(start, end, here=True):
        return Finding("E1", True, 1, start, end, "wrong", "", None, here)

    text = "line to"
    given = [finding(0, 4), finding(7, 7), finding(0, 900), finding(3, 5, here=False)]
    spans = [(one["from"], one["to"]) for one in colours.underlines(given, text)]

    assert spans == [(0, 4), (6, 7), (0, 7)]
