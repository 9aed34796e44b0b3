"""Words of earlier versions: read as before, without a word about it; `fmt` writes today's."""

import pytest

from dqpaint.language import ScriptError, parse
from dqpaint.language.vocabulary.words import PARTS, RENAMED, STATEMENTS
from dqpaint.language.writing.builder import Drawing
from dqpaint.language.writing.formatter import formatted

OLD = """let p = (10, 0) mm
law constant
line to p law quintic # the law of old
stroke law cubic
  line by (3, 4) mm
end
with law trapezoid
  arc centre (30, 0) mm angle 90 deg in 2 s law cubic(5 mm/s, 0 mm/s)
end
text "law" height 9 mm law constant
"""
NEW = OLD.replace("law ", "profile ").replace("the profile of old", "the law of old")


def shapes(text):
    program = parse(text, "a.traj")
    return [(s.path, s.profile, s.timing, s.start, s.end, s.line) for s in program.segments]


def test_they_mean_the_same():
    assert shapes(OLD) == shapes(NEW)
    assert parse(OLD, "a.traj").notes == ()


def test_fmt_writes_todays_words_but_not_in_texts_and_comments():
    assert formatted(OLD) == NEW.replace(" # ", "  # ")
    assert formatted(NEW) == NEW.replace(" # ", "  # ")


def test_an_open_bracket_ends_before_one():
    """A line that begins with such a word begins a statement: the bracket was forgotten."""
    with pytest.raises(ScriptError) as caught:
        parse("line to (1, 2 mm\nprofile constant\nline by (3, 4) mm", "a.traj")
    assert [d.code for d in caught.value.diagnostics] == ["E103"]


@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        ("let law = 3", "E114", "law"),
        ("line to (1, 2) mm in law", "E105", "law"),
        ("step to (1, 2) mm law constant", "E110", "law"),
        ("law fancy", "E205", "fancy"),
        ("line to (1, 0) mm law cubic law cubic", "E113", "law"),
    ],
)
def test_messages_point_at_what_was_written(text, code, words):
    with pytest.raises(ScriptError) as caught:
        parse(text, "a.traj")
    (found,) = (d for d in caught.value.diagnostics if d.code != "E140")
    assert (found.code, found.span.text_in(text)) == (code, words)


def test_calls_from_python_too():
    old, new = Drawing(), Drawing()
    old.law("constant")
    new.profile("constant")
    old.line(to=(0.1, 0), law="cubic")
    new.line(to=(0.1, 0), profile="cubic")
    assert old.source() == new.source() == "profile constant\nline to (0.1, 0) m profile cubic\n"
    assert "law" not in dir(old)


def test_they_stand_for_words_that_are_there():
    assert set(RENAMED.values()) <= set(PARTS) & set(STATEMENTS)
    assert not set(RENAMED) & (set(PARTS) | set(STATEMENTS))
