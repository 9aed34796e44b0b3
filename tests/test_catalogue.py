"""Every message is explained, and the explanations are true."""

import re
from pathlib import Path

import pytest

import dqpaint
from dqpaint.catalogue import STAGES, explanation, explanations, listed, told
from dqpaint.checking import check
from dqpaint.errors import UsageError
from dqpaint.language import ScriptError, parse
from dqpaint.language.layout import formatted
from dqpaint.motion import plan
from dqpaint.robots.card import read_card

ALL = explanations()
SHOWN = {code: entry for code, entry in ALL.items() if entry.wrong}
CANVAS = read_card("iiwa").canvas.pose


def codes(entry, text, tmp_path):
    """The codes of what is said about a text, by the stage that is to find it."""
    if entry.stage == "arm":
        (tmp_path / "a.traj").write_text(text)
        return [finding.code for finding in check(str(tmp_path / "a.traj"), None).findings]
    try:
        program = parse(text + "\n", "a.traj")
        found = program.notes if entry.stage == "text" else plan(program, CANVAS).notes
    except ScriptError as problem:
        found = problem.diagnostics
    return [finding.code for finding in found]


@pytest.mark.parametrize("code", SHOWN)
def test_the_wrong_example_leads_to_this_very_message(code, tmp_path):
    assert codes(ALL[code], ALL[code].wrong, tmp_path) == [code]


@pytest.mark.parametrize("code", SHOWN)
def test_the_right_example_leads_to_none(code, tmp_path):
    (tmp_path / "right.traj").write_text(ALL[code].right)
    result = check(str(tmp_path / "right.traj"), None)
    assert (result.findings, result.fault) == ((), "")
    assert formatted(ALL[code].right) == ALL[code].right + "\n"


def test_every_code_in_use_is_explained_and_no_other():
    folder = Path(dqpaint.__file__).parent
    source = "".join(path.read_text("utf-8") for path in folder.rglob("*.py"))
    assert set(ALL) == set(re.findall(r'"([EW]\d{3})"', source))


def test_entries_are_of_the_house():
    for entry in ALL.values():
        assert entry.stage in STAGES
        assert bool(entry.wrong) == bool(entry.right) == (entry.stage != "other")
        assert entry.title[0].islower() or entry.title[0] in "'"
        assert not entry.title.endswith(".")
        assert entry.says.endswith(".")
        assert max(map(len, entry.says.splitlines())) <= 110
    assert {code for code in ALL if code not in SHOWN} == {
        "E001", "E305", "E306", "E307", "E324", "E999"
    }  # fmt: skip


def test_told():
    text = told(explanation("e245"))
    assert text.startswith("E245: an arc through three points that ends where it starts\n\n")
    assert "\n\nwrong:\n\n  arc via (80, 10) mm to (0, 0)\n\nright:\n\n  arc centre" in text
    assert "wrong" not in told(explanation("E001"))
    assert listed().count("\n") + 1 == len(ALL)


@pytest.mark.parametrize(("wrong", "near"), [("E2445", "E244"), ("", ""), ("x" * 999, "")])
def test_unknown_codes(wrong, near):
    with pytest.raises(UsageError, match=f"no message has the code .*{near}.*dqpaint explain$"):
        explanation(wrong)
