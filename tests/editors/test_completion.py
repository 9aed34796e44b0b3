"""What a word means at its place, and what may follow there."""

import pytest

from dqpaint.editors import completion
from dqpaint.editors.analysis import analyse
from dqpaint.language.vocabulary.words import PARTS, STATEMENTS

MARK = "|"


def cursor(text):
    at = text.index(MARK)
    return text.replace(MARK, "", 1), at


@pytest.mark.parametrize(("text", "word", "kind"), [
    ("li|ght red", "light", "statement"),
    ("line to (1, 0) mm |light red", "light", "part"),
    ("line to (1, 0) mm light red|", "red", "colour"),
    ("line |to (1, 0) mm", "to", "part"),
    ("let r = sin|(3 deg)", "sin", "function"),
    ("line to (1, 0) m|m", "mm", "unit"),
    ("  re|peat 3", "repeat", "statement"),
    ("arc centre (0, 0) angle 90|° tool keep", "°", "unit"),
])  # fmt: skip
def test_meanings(text, word, kind):
    text, at = cursor(text)
    entry, span = completion.meaning_at(text, at)
    assert (entry.word, entry.kind, span.text_in(text)) == (word, kind, word)


@pytest.mark.parametrize(
    "text", ["# li|ne", 'light "re|d"', "line to (1|, 0)", "let my_s|ize = 3", "|"]
)
def test_no_meaning(text):
    assert completion.meaning_at(*cursor(text)) is None


@pytest.mark.parametrize(("text", "some", "none"), [
    ("|", {"line", "end"}, {"to", "mm", "red"}),
    ("  ar|", {"arc"}, {"centre"}),
    ("arc |", {"centre", "via", "light"}, {"line", "about"}),
    ("arc centre (0, 0) |", {"mm", "angle"}, {"centre"}),
    ("arc centre (0, 0) an|", {"angle"}, {"centre"}),
    ("line to (1, 0) mm |", {"to", "speed"}, {"about"}),
    ("profile |", {"cubic"}, {"red", "mm"}),
    ("line to (1, 0) mm light |", {"red", "off", "hsv"}, {"mm", "speed"}),
    ("light red to b|", {"blue"}, {"to"}),
    ("light |", {"rainbow"}, {"hue"}),
    ("light red to blue |", {"hue", "even"}, {"rainbow"}),
    ("hold 3 |", {"s", "ms"}, {"light", "red"}),
    ("place |", {"auto", "at"}, {"red", "keep"}),
    ("tool |", {"keep", "look", "rpy"}, {"red"}),
    ("let size = 3 mm\nline to (si|", {"size", "sin"}, {"line"}),
    ("# |", set(), {"line"}),
    ('light "r|', set(), {"red"}),
])  # fmt: skip
def test_completions(text, some, none):
    words = {entry.word for entry in completion.completions(*cursor(text))}
    assert some <= words
    assert not none & words
    assert some or not words


def test_every_statement_and_part_is_completed():
    assert {e.word for e in completion.completions("", 0)} == set(STATEMENTS)
    for known in STATEMENTS.values():
        text = f"{known.word} "
        if known.parts and known.word not in ("light", "profile", "tool"):
            words = {e.word for e in completion.completions(text, len(text)) if e.word in PARTS}
            assert set(known.parts) <= words


def test_figures_of_lines():
    text = (
        "period 10 ms\nmove to (30, 0) mm\nrepeat 3\narc centre (0, 0) angle 120 deg in 1 s\nend\n"
        "step to (0, 0)\nhold 2 s light off\nline to (0, 40) mm speed 20 mm/s profile constant"
    )
    figures = analyse(text, "a", planned=True).figures
    assert set(figures) == {4, 6, 7, 8}
    assert figures[4].length == pytest.approx(0.03 * 6.283185, rel=1e-3)
    assert (figures[4].seconds, figures[7].seconds) == pytest.approx((3.0, 2.0))
    assert figures[8].fastest == pytest.approx(0.02, rel=1e-9)
    assert figures[6].length == 0
    assert str(figures[7]) == "0 mm in 2 s, at most 0 mm/s, in the dark"
    assert str(figures[8]) == "40 mm in 2 s, at most 20 mm/s"


def test_what_cannot_be_planned_has_messages_and_no_figures():
    for text, code in [("lin", "E120"), ("robot nix\nhold 1 s", "E311"), ("hold 9e8 s", "E302")]:
        found = analyse(text, "a", planned=True)
        assert [d.code for d in found.diagnostics] == [code]
        assert found.figures == {}
    assert analyse("hold 9e8 s", "a", planned=False).diagnostics == ()
