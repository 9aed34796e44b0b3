# ruff: noqa: E501  the table is a table
"""What beginners write, and the advice that helps them on."""

from pathlib import Path

import pytest

from dqpaint.diagnostics.collector import DiagnosticCollector
from dqpaint.diagnostics.diagnostic import Span, locate
from dqpaint.language import ScriptError, parse, read
from dqpaint.language.syntax.parser import parse_statements
from dqpaint.language.vocabulary.aliases import FOREIGN
from dqpaint.language.vocabulary.words import PARTS, STATEMENTS
from dqpaint.robots.loading.lookup import card_for

# The text (~ ends a line), the code, line:column, the advice or its beginning.
ADVICE = """
repeat 5 times~line by (1, 0) mm~end|E112|1:10|write: repeat 5, or: repeat i from 1 to 5
def star r~line by (r, 0)~end|E112|1:10|the names it is handed stand in brackets: def star(r)
line to (9, 0) mm line to (0, 0)|E110|1:19|one statement per line
hold 1 s repeat 3|E110|1:10|one statement per line
line to (9, 0) mm // a comment|E105|1:20|a comment begins with #
let a = 4 /* four */|E105|1:12|a comment begins with #
light red -5%|E112|1:13|only the brightness of a light is written in %, and it is no less than 0%
even|E120|1:1|it belongs to a light: light white even
path "points.csv" unit s|E109|1:24|for example: unit mm
repeat i from 1 to 9 step 2~line by (1, 0) mm~end|E112|1:22|it counts by 1: repeat i from 0 to 5, and write 2*i
line to (1 000, 5) mm|E102|1:12|a large number has no blanks in it: 1000
line to (1_000, 5) mm|E102|1:10|write 1000
line to (9, 0) mm tool look|E105|1:24|for example: tool look (0, 0, 300) mm
line to (9, 0) mm tool look line|E105|1:29|for example: tool look (0, 0, 300) mm
line to (9, 0) mm tool down|E205|1:24|name it first: let down = …, or write an orientation: rot(x
line to (9, 0) mm tool folow|E205|1:24|did you mean 'follow'?
line to (1/2 mm, 0)|E218|1:9|a unit belongs to the number before it: half of it is (1/2) mm
line to (9, 0) mm in 1/2 s|E218|1:22|a unit belongs to the number before it
line to (9, 0) mm in 10 Hz|E218|1:22|for example: in 2 s
line to (9, 0) mm + 5 mm|E208|1:21|a point goes with a point: (5, 0) mm
speed 100 mm/min|E206|1:14|write: min(VALUE, VALUE); a minute is 60 s
hold 2 min|E102|1:8|1 min is 60 s; units are mm
line to (５, 0) mm|E101|1:10|write the plain digit 5
line to (9, 0) mm tool look (9, 0, 50) mm up z|E252|1:1|say another direction: tool look POINT up y
let a = b|E205|1:9|name it first: let b = …
profile b|E205|1:9|the profiles are: constant
hold 1 h|E110|1:8|its parts are: light, brush, strobe
line to (9, 0) mm light red blue|E110|1:29|a colour stands behind 'light', two of them as: light red to blue
repeat 3 {~line by (1, 0) mm~end|E101|1:10|no { is needed: a block ends with a line 'end'
line to {1, 0} mm|E101|1:9|write (
forward 100|E120|1:1|did you mean 'line by'?
write "Ada" height 9 mm|E120|1:1|did you mean 'text'?
print("Ada")|E120|1:1|did you mean 'text'?
right 90|E120|1:1|'right' belongs to a statement and stands on its line: arc radius 20 mm
for i in range(5):~  line to (i, 0)|E121|1:1|write: repeat i from 1 to 5
for i = 1 to 5~line to (i, 0) mm~end|E121|1:1|write: repeat i from 1 to 5
repeat 5~line by (1, 0) mm~end repeat|E112|3:5|write: end
repeat i = 1 to 10~line by (i*mm, 0)~end|E112|1:10|write: repeat i from 1 to 5
let r = 5 mm, s = 3 mm|E112|1:13|each value has a 'let' and a line of its own
let a = 3 mm~let b = 2 a|E112|2:11|a product is written 2*a
let a = (1, 2) mm~line by (a.x, 0)|E101|2:11|a point has no parts with names
light dark blue|E112|1:12|did you mean 'darkblue'?
light 0.5 red|E112|1:11|the brightness follows the colour: light red 50%
line by (1, 0) mm light 40 red|E110|1:28|a colour stands behind 'light'
strobe 50% 10 Hz|E112|1:10|the frequency comes first: strobe 10 Hz 30%
text "Ada" 20 mm|E112|1:12|say what the number is: height 20 mm
text "Ada" size 20 mm|E110|1:12|did you mean 'height'?
text Ada Lovelace height 9 mm|E109|1:6|put it in quotes: text "Ada Lovelace"
place at 0.5 0 0.3 m|E112|1:14|a point stands in brackets, with commas
line from (0, 0) to (9, 0) mm|E110|1:6|a line begins where the tool is; write before it: move to
line to (9, 0) mm with light red|E110|1:19|parts stand there without 'with'
line to (9, 0) mm speed 10 mm per s|E110|1:31|a rate is written with a slash: mm/s
line to <9, 0> mm|E101|1:9|a point stands in round brackets: (10, 0)
curve (t, t) for 0 < t < 9 mm|E101|1:20|write: for t from 0 to 360 deg
curve (t, t**2) for t from 0 to 9 mm|E105|1:13|a power is written with ^, as in t^2
curve (t, abs t) for t from 0 to 9 mm|E109|1:15|write: abs(VALUE)
def leaf(r)~line by (r, 0)~end~leaf 5 mm|E120|4:1|to draw what a 'def' names, write: leaf(5 mm)
def leaf(r)~line by (r, 0)~end~call leaf(5 mm)|E120|4:1|to draw what a 'def' names, write: leaf(5 mm)
def leaf~line by (9, 0) mm~end~leaf|E120|4:1|to draw what a 'def' names, write: leaf()
let r = 3 mm~LET r = 3 mm|E120|2:1|did you mean 'let'?
repeat i from -2 to -5~line by (i*mm, 0)~end|E222|1:21|write: repeat i from -5 to -2, and count down with -7 - i
repeat i from 2 to -2~line by (i*mm, 0)~end|E222|1:20|write: repeat i from -2 to 2, and count down with -i
rect (10, 20) mm|E111|1:6|for example: rect width 60 mm height 30 mm at (0, 0)
square 20 mm|E120|1:1|a square is a rectangle: rect width 20 mm height 20 mm
triangle 20 mm|E120|1:1|of equal sides: polygon 3 radius 20 mm
pen up|E120|1:1|to go there dark, write: move to (10, 0) mm; or for the lines after: light off
pen down|E120|1:1|a line shines: line to (10, 0) mm; or for the lines after: light white
line to (10 inch, 0)|E102|1:13|1 inch is 25.4 mm; units are mm, cm, m
line to r, 5|E112|1:10|parts of a line need no commas
curve (a*mm, 0) for a from 0 to 9 step 1|E110|1:35|a curve is smooth and takes no step
"""


@pytest.mark.parametrize("case", ADVICE.strip().split("\n"))
def test_advice(case: str) -> None:
    written, code, at, advice = case.split("|")
    text = written.replace("~", "\n")
    with pytest.raises(ScriptError) as caught:
        parse(text)
    (finding,) = caught.value.diagnostics
    assert finding.span is not None
    where = locate(text, finding.span.start)
    assert (finding.code, f"{where.line}:{where.column}") == (code, at)
    assert finding.help.startswith(advice)


@pytest.mark.parametrize("part", sorted(set(PARTS) - set(STATEMENTS) - set(FOREIGN)))
def test_a_part_s_example_is_one(part: str) -> None:
    """What a line that begins with a part is shown instead has no mistake of its own."""
    with pytest.raises(ScriptError) as caught:
        parse(f"{part} 5")
    example = caught.value.diagnostics[0].help.partition("stands on its line: ")[2]
    assert example
    findings = DiagnosticCollector()
    end = "\nend" if STATEMENTS[example.split()[0]].block else ""
    parse_statements(example + end, findings)
    assert not findings.ordered(), example


def test_a_block_without_its_with_is_one_mistake() -> None:
    with pytest.raises(ScriptError) as caught:
        parse("rotate 30 deg\n  line by (1, 0) mm\nend\nlin by (1, 0) mm\n")
    assert [finding.code for finding in caught.value.diagnostics] == ["E120", "E120"]


@pytest.mark.parametrize(
    "error", ["speed 10 cm per second", "start (9, 0) mm", "light rgb(2, 0, 0)", "let a = b"]
)
def test_no_length_of_zero_follows_from_an_error_above(error: str) -> None:
    with pytest.raises(ScriptError) as caught:
        parse(f"{error}\nline to (0, 0) mm\n")
    assert not [one for one in caught.value.diagnostics if one.code == "W401"]
    with pytest.raises(ScriptError) as caught:
        parse(f"line to (0, 0) mm\n{error}\n")
    assert "W401" in [one.code for one in caught.value.diagnostics]


def test_a_digit_of_another_script_is_mended() -> None:
    with pytest.raises(ScriptError) as caught:
        parse("line by (٣, 0) mm")
    fix = caught.value.diagnostics[0].fix
    assert fix is not None
    assert (fix.text, fix.span) == ("3", Span(9, 10))


def test_a_robot_by_nearly_its_name() -> None:
    with pytest.raises(ScriptError) as caught:
        card_for(parse("robot iwia\nline by (1, 0) mm"), None)
    assert caught.value.diagnostics[0].help.startswith("did you mean 'iiwa'? known: ")


def test_a_file_by_nearly_its_name(tmp_path: Path) -> None:
    (tmp_path / "star.traj").write_text("line by (9, 0) mm\n", "utf-8")
    main = tmp_path / "main.traj"
    main.write_text('include "str.traj"\n', "utf-8")
    with pytest.raises(ScriptError) as caught:
        read(main)
    assert caught.value.diagnostics[0].help == "did you mean 'star.traj'?"
