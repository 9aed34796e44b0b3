# ruff: noqa: E501  the table is a table
"""What beginners write, and the advice that helps them on."""

from pathlib import Path

import pytest

from dqpaint.language import ScriptError, parse, read
from dqpaint.language.diagnostics import Span, place
from dqpaint.robots.choose import card_for

# The text (~ ends a line), the code, line:column, the advice or its beginning.
ADVICE = """
repeat 5 times~line by (1, 0) mm~end|E112|1:10|write: repeat 5, or: repeat i from 1 to 5
def star r~line by (r, 0)~end|E112|1:10|the names it is handed stand in brackets: def star(r)
line to (9, 0) mm line to (0, 0)|E110|1:19|one statement per line
hold 1 s repeat 3|E110|1:10|one statement per line
line to (9, 0) mm // a comment|E105|1:20|a comment begins with #
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
law b|E205|1:5|the laws are: constant
hold 1 h|E110|1:8|its parts are: light, brush, strobe
line to (9, 0) mm light red blue|E110|1:29|a colour stands behind 'light', two of them as: light red to blue
repeat 3 {~line by (1, 0) mm~end|E101|1:10|no { is needed: a block ends with a line 'end'
line to {1, 0} mm|E101|1:9|write (
forward 100|E120|1:1|did you mean 'line by'?
write "Ada" height 9 mm|E120|1:1|did you mean 'text'?
"""


@pytest.mark.parametrize("case", ADVICE.strip().split("\n"))
def test_advice(case: str) -> None:
    written, code, at, advice = case.split("|")
    text = written.replace("~", "\n")
    with pytest.raises(ScriptError) as caught:
        parse(text)
    (finding,) = caught.value.diagnostics
    assert finding.span is not None
    where = place(text, finding.span.start)
    assert (finding.code, f"{where.line}:{where.column}") == (code, at)
    assert finding.help.startswith(advice)


def test_a_block_without_its_with_is_one_mistake() -> None:
    with pytest.raises(ScriptError) as caught:
        parse("rotate 30 deg\n  line by (1, 0) mm\nend\nlin by (1, 0) mm\n")
    assert [finding.code for finding in caught.value.diagnostics] == ["E120", "E120"]


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
