# ruff: noqa: E501  the table is a table
"""Edits that mend: applied, the message is gone, and what was meant is what is drawn."""

import pytest

from dqpaint.diagnostics.catalogue import explanations
from dqpaint.language import ScriptError, parse
from tests.support.wrong_drawings import ENTRIES

# The text (~ ends a line), the text mended.
MENDED = """
line to (10, 0) mm;|line to (10, 0) mm
line to (10; 0) mm|line to (10, 0) mm
line to (10 0) mm|line to (10, 0) mm
line to (−10, 0) mm|line to (-10, 0) mm
curve (t, 0) for t from 0 to π*mm|curve (t, 0) for t from 0 to pi*mm
line to [10, 0) mm|line to (10, 0) mm
repeat 2:~line by (1, 0) mm~end|repeat 2~line by (1, 0) mm~end
hold 1sec|hold 1 s
hold 1 seconds|hold 1 s
line to (1, 0) mm speed 4 mm/sec|line to (1, 0) mm speed 4 mm/s
line to (10, 0)) mm|line to (10, 0) mm
light #ff8800~hold 1 s|light "#ff8800"~hold 1 s
hold 1 s light #f80|hold 1 s light "#f80"
move to (9, 0) mm~arc center (0, 0) angel 90 deg|move to (9, 0) mm~arc center (0, 0) angle 90 deg
move to (9, 0) mm~arc about (0, 0) angle 90 deg|move to (9, 0) mm~arc centre (0, 0) angle 90 deg
repeat i from 1 5~line by (i, 0) mm~end|repeat i from 1 to 5~line by (i, 0) mm~end
repeat i from 1 (5)~line by (i, 0) mm~end|repeat i from 1 to (5)~line by (i, 0) mm~end
lin to (10, 0) mm|line to (10, 0) mm
wait 1 s|hold 1 s
lineto (10, 0) mm|line to (10, 0) mm
r = 3 mm~line to (r, 0)|let r = 3 mm~line to (r, 0)
line to (0,5, 1,0) cm|line to (0.5, 1.0) cm
line to (0,5, 1,0, 2,25) cm|line to (0.5, 1.0, 2.25) cm
line to (12,003,000, 7) mm|line to (12003,000, 7) mm
line to (2,000, 7) mm|line to (2000, 7) mm
line to (0,05, 3) cm|line to (0.05, 3) cm
line to (-1,005.5, 3) mm|line to (-1005.5, 3) mm
hold 007 s|hold 7 s
line to (10 mm, 20)|line to (10, 20) mm
line to (1.50, 20cm, 3)|line to (1.50, 20, 3) cm
let r = 3 mm~line to (radius, 0)|let r = 3 mm~line to (r, 0)
hold 1 s light rde|hold 1 s light red
line to (3 mm*sinn(30 deg), 0)|line to (3 mm*sin(30 deg), 0)
let r = 3 mm~line to (r + 5, 0)|let r = 3 mm~line to (r + 5 mm, 0)
hold 1 s light "rde"|hold 1 s light "red"
line to (10, 20)|line to (10, 20) mm
let a = 3~line to (a*2, 1 mm)|let a = 3~line to (a*2, 1 mm)
hold 1|hold 1 s
line to (10, 0) mm speed 40 mm|line to (10, 0) mm speed 40 mm/s
screw about (0, 0) along z angle 9 deg pitch 5 mm|screw about (0, 0) along z angle 9 deg pitch 5 mm/turn
hold 1 s light ‘red’|hold 1 s light "red"
text “Ada” height 3 mm|text "Ada" height 3 mm
text Ada height 3 mm|text "Ada" height 3 mm
let café = 3 mm~line to (café, 0)|let cafe = 3 mm~line to (café, 0)
hold 1 s light even|hold 1 s light white even
LET r = 3 mm~line to (r, 0)|let r = 3 mm~line to (r, 0)
light rgb(255, 0, 0)~hold 1 s|light rgb(255/255, 0/255, 0/255)~hold 1 s
light RGB(255, 0, 0)~hold 1 s|light "#ff0000"~hold 1 s
light RGB(0.2, 1, 0)~hold 1 s|light "#33ff00"~hold 1 s
line to 100, 0|line to (100, 0) mm
line to -10 cm, 2.5 cm, 3 cm in 2 s|line to (-10, 2.5, 3) cm in 2 s
move to (9, 0) mm~arc centre (0, 0) 360 deg|move to (9, 0) mm~arc centre (0, 0) angle 360 deg
speed 10 cm per second~line to (9, 0) mm|speed 10 cm/s~line to (9, 0) mm
hold until 3 s|hold 3 s
svg logo.svg height 9 mm|svg "logo.svg" height 9 mm
path ../my-points/a.b.csv unit mm|path "../my-points/a.b.csv" unit mm
curve (t*mm, 0) for t in 0..10|curve (t*mm, 0) for t from 0 to 10
repeat i in 1..3~line by (i*mm, 0)~end|repeat i from 1 to 3~line by (i*mm, 0)~end
"""
PAIRS = [line.split("|") for line in MENDED.strip().split("\n")]
NO_FIX = {"let a = 3~line to (a*2, 1 mm)"}  # which unit is missing can't be said for sure

# Numbers in inches are others in millimetres, and some words have several meanings.
NEVER = ["line to (1, 0) inch", "hold 2 min", "G1 X10", "circle (0, 0)", "lineto to (1, 0) mm",
         "line (10, 0) mm", "let a = sin(30)", "let m = 5", "repeat i from 1 bogus"]  # fmt: skip


def findings(text):
    try:
        return parse(text).notes
    except ScriptError as problem:
        return problem.diagnostics


def applied(fix, text):
    return text[: fix.span.start] + fix.text + text[fix.span.end :]


@pytest.mark.parametrize(("wrong", "right"), PAIRS, ids=[wrong for wrong, _ in PAIRS])
def test_mended(wrong, right):
    wrong, right = wrong.replace("~", "\n"), right.replace("~", "\n")
    fixes = [found.fix for found in findings(wrong) if found.fix is not None]
    if wrong.replace("\n", "~") in NO_FIX:
        assert fixes == []
        return
    assert applied(fixes[0], wrong) == right
    assert fixes[0].title.split()[0] in ("write", "put", "take")


@pytest.mark.parametrize("text", NEVER)
def test_nothing_is_mended_by_guess(text):
    assert [found.fix for found in findings(text)] in ([None], [None, None])


TEXTS = {entry[0].replace("~", "\n") for entry in ENTRIES}
TEXTS |= {entry.wrong for entry in explanations().values() if entry.wrong}


@pytest.mark.slow
def test_every_fix_of_the_catalogue_takes_its_message_away():
    codes = set()
    for text in sorted(TEXTS):
        for found in findings(text):
            if found.fix is None:
                continue
            codes.add(found.code)
            left = findings(applied(found.fix, text))
            same = [d for d in left if (d.code, d.message, d.span) == found_key(found)]
            assert not same, text
    assert len(codes) >= 14, codes


def found_key(found):
    return found.code, found.message, found.span
